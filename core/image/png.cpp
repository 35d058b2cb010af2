#include "core/image/png.h"

#include "core/image/file_bytes.h"

#include <png.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>

namespace penumbra {
namespace {

/// What libpng's callbacks see.
struct Source {
    std::string_view left;    ///< not read yet
    char message[128] = "";   ///< of the error that ended the reading
};

// libpng leaves by longjmp, over frames of C alone: nothing of C++ with a destructor lives where it may pass.

[[noreturn]] void onError(png_structp png, png_const_charp message) {
    auto& source = *static_cast<Source*>(png_get_error_ptr(png));
    std::strncpy(source.message, message, sizeof source.message - 1);
    png_longjmp(png, 1);
}
void onWarning(png_structp, png_const_charp) {}
void onRead(png_structp png, png_bytep out, std::size_t n) {
    auto& source = *static_cast<Source*>(png_get_io_ptr(png));
    if (n > source.left.size()) png_error(png, "it is cut short");
    std::memcpy(out, source.left.data(), n);
    source.left.remove_prefix(n);
}

/// libpng's two structures, freed together.
class Reader {
public:
    Reader(const std::string& path, std::string_view bytes) : path_(path), source_{bytes} {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source_, onError, onWarning);
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
        if (!info_) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png_, &source_, onRead);
    }
    ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    /// The header, and how the rows are to come out.
    void readHeader() {
        if (setjmp(png_jmpbuf(png_))) fail();
        // Nothing but the picture: no chunk that packs data of its own is unpacked.
        png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER,
                                    reinterpret_cast<png_const_bytep>("iCCP\0zTXt\0iTXt\0tEXt\0eXIf\0sPLT\0hIST\0pCAL\0sCAL"), 9);
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);   // ours are kinder
        png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
        png_set_benign_errors(png_, 0);
        png_read_info(png_, info_);
    }
    std::uint32_t width() const { return png_get_image_width(png_, info_); }
    std::uint32_t height() const { return png_get_image_height(png_, info_); }
    int bits() const { return std::max(8, int(png_get_bit_depth(png_, info_))); }
    int channels() const {
        const int type = png_get_color_type(png_, info_);
        if (!(type & PNG_COLOR_MASK_COLOR)) return 1;
        return type & PNG_COLOR_MASK_ALPHA || png_get_valid(png_, info_, PNG_INFO_tRNS) ? 4 : 3;
    }

    /// Interleaved, rows from the top; words in the machine's order. REQUIRES: all of the picture fits in there.
    void readPixels(png_byte** rows) {
        if (setjmp(png_jmpbuf(png_))) fail();
        if (channels() == 1) png_set_strip_alpha(png_);
        if (png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png_);
        if (channels() == 1) png_set_expand_gray_1_2_4_to_8(png_);
        else if (png_get_valid(png_, info_, PNG_INFO_tRNS)) png_set_tRNS_to_alpha(png_);
        if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
        png_set_interlace_handling(png_);
        png_set_benign_errors(png_, 1);   // such as packed data that go on behind the picture
        png_read_update_info(png_, info_);
        png_read_image(png_, rows);
        png_read_end(png_, nullptr);
    }

private:
    [[noreturn]] void fail() const { failImage(path_, std::string("the PNG is damaged: ") + source_.message); }

    const std::string& path_;
    Source source_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

template <class T>
std::vector<T> readPixels(Reader& reader) {
    const std::size_t perRow = std::size_t(reader.width()) * std::size_t(reader.channels());
    std::vector<T> pixels(perRow * reader.height());
    std::vector<png_byte*> rows(reader.height());
    for (std::size_t y = 0; y < rows.size(); ++y)
        rows[y] = reinterpret_cast<png_byte*>(pixels.data() + y * perRow);
    reader.readPixels(rows.data());
    return pixels;
}

}  // namespace

Image readPng(const std::string& path, TransferFunction encoding, const ImageLimits& limits) {
    const std::string bytes = readWholeImageFile(path);
    Reader reader(path, bytes);
    reader.readHeader();
    const int channels = reader.channels();
    const bool isWide = reader.bits() == 16;
    checkImageSize(path, reader.width(), reader.height(), std::uint64_t(channels) * (isWide ? sizeof(float) : 1), bytes.size(), limits);
    const int width = int(reader.width()), height = int(reader.height());
    if (!isWide) return Image(width, height, channels, readPixels<std::uint8_t>(reader), encoding);

    const std::vector<std::uint16_t> words = readPixels<std::uint16_t>(reader);
    std::vector<float> floats(words.size());
    std::transform(words.begin(), words.end(), floats.begin(), [&](std::uint16_t w) { return encoding.decode(float(w) / 65535.f); });
    return Image(width, height, channels, std::move(floats));
}

}  // namespace penumbra
