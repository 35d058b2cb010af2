// The module around OpenImageIO, penumbra_oiio.so. oiio_module.cpp, the only file that knows OpenImageIO, is all of it.
//
// Why a module: a distribution's OpenImageIO is linked with readers for everything, 260 libraries in Debian 12. They
// cost a process 120 MB and a large part of a second before main() is reached, a scene without a picture file as well.
// core/image/image_io.cpp loads it with the first file that needs it (core/base/module.h).
//
// Interface: module and program are built together, with one compiler and these headers; a module of another version
// gives no interface. It shares no code with the program. No exception leaves it: what failed is returned.
//
// Thread safety: the module may be used from several threads, a reader from one at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

struct OiioFailure {
    std::string reason;  ///< as the library says it; may be empty
    bool isMemory = false;
};
using OiioResult = std::optional<OiioFailure>;  ///< nothing: it went well

/// A file to be read. The format is named, never found by the path: the library would try other readers, whatever we
/// have found the file to be.
struct OiioFile {
    const char* format;  ///< the library's name for it
    const char* path;
    std::string_view bytes;  ///< the contents; where empty they are read from the path. Must outlive the reader.
};

enum class OiioValues { Bytes, Words, Floats };  ///< 8 bits; other integers, as a picture to be written 16; 32 bits

struct OiioSpec {
    int width, height, channels;
    bool isFlat;  ///< neither deep nor a volume
    OiioValues values;
    std::size_t bytesPerPixel;
};

/// An open file.
class OiioReader {
public:
    virtual ~OiioReader() = default;
    virtual OiioSpec spec() const noexcept = 0;
    /// The first channels of all pixels, colours as stored, not multiplied by alpha. `to` holds width * height *
    /// channels values: std::uint8_t for Bytes, float (from [0, 1] for integers) for Floats.
    virtual OiioResult read(int channels, OiioValues type, void* to) noexcept = 0;
};

/// A picture of three interleaved channels.
struct OiioPicture {
    const char* format;
    const char* path;  ///< for the library's messages; nothing is written there
    int width, height;
    OiioValues type;
    const void* values;
    std::string compression;  ///< as the library's attribute "Compression" has it
};

class OiioModule {
public:
    virtual ~OiioModule() = default;
    /// "2.4.7", of the library at run time.
    virtual std::string version() const = 0;
    virtual OiioResult open(const OiioFile& file, std::unique_ptr<OiioReader>& reader) const noexcept = 0;
    virtual OiioResult encode(const OiioPicture& picture, std::vector<unsigned char>& bytes) const noexcept = 0;
};

inline constexpr char kOiioModuleFile[] = "penumbra_oiio.so";
inline constexpr char kOiioModuleFunction[] = "penumbraOiioModule";
/// The one function that the module exports, under that name: its interface, or null where the program's version is not
/// the module's.
using OiioModuleFunction = const OiioModule*(const char* programVersion);

}  // namespace penumbra
