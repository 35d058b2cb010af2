// Bad images, each the texture of a small scene. tests/core_image_hostile_test.cpp tests the readers alone, with many
// more variations of each kind.
#pragma once

#include "core/image/exr.h"
#include "tests/bad_input/bad_input.h"
#include "tests/image_files.h"
#include "tests/temporary_folder.h"

#include <cstring>
#include <limits>

namespace penumbra::bad_input {

/// A scene with a sphere whose texture is that image.
inline Files texture(const std::string& name, Content bytes) {
    return world("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" + name + "\"\n" +
                     "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"",
                 {{name, std::move(bytes)}});
}

inline std::string littleEndian(std::uint32_t v) {
    return {char(v), char(v >> 8), char(v >> 16), char(v >> 24)};
}

/// An EXR of 8 x 8 pixels, all of that value.
inline std::string exr(float value = 0.5f, PixelWindow window = {0, 0, 8, 8}, const char* red = "R") {
    const TemporaryFolder folder;
    ExrHeader header;
    header.dataWindow = window;
    header.displayWindow = {0, 0, 8, 8};
    header.channels = {{red}, {"G"}, {"B"}};
    writeExr(folder.path("a.exr"), header, [&](const ExrBlock& block) {
        for (const auto& plane : block.floats)
            std::fill(plane.begin(), plane.end(), value);
    });
    return readBytes(folder.path("a.exr"));
}

/// The same with the data window that its header claims replaced.
inline std::string exrClaiming(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
    std::string bytes = exr();
    const std::string name("dataWindow\0box2i\0", 17);
    std::string box;
    for (const std::int32_t edge : {x0, y0, x1, y1})
        box += littleEndian(std::uint32_t(edge));
    return bytes.replace(bytes.find(name) + name.size() + 4, box.size(), box);
}

/// The same with a bit of the version field set: 0x800 deep, 0x1000 of several parts.
inline std::string exrOfKind(std::uint32_t flag) {
    std::string bytes = exr();
    return bytes.replace(4, 4, littleEndian(2 | flag));
}

/// The same with the offsets of its blocks replaced.
inline std::string exrWithOffset(std::uint32_t offset) {
    std::string bytes = exr();
    // The header ends with two NULs after the last attribute, 8 rows are one block: one offset of eight bytes.
    std::uint64_t tableEnd = 0;
    for (std::size_t at = 8; at + 8 < bytes.size(); ++at) {
        std::uint64_t value;
        std::memcpy(&value, &bytes[at], sizeof value);
        if (value == at + 8) tableEnd = at;
    }
    return bytes.replace(tableEnd, 8, littleEndian(offset) + std::string(4, '\0'));
}

inline std::string png(std::uint32_t side) {
    return PngFile{side, side, 8, PngFile::Grey, {{0}}}.encoded();
}

inline std::string tga(std::uint16_t side) {
    std::string bytes(18, '\0');
    bytes[2] = 2;  // colour
    bytes[12] = bytes[14] = char(side);
    bytes[13] = bytes[15] = char(side >> 8);
    bytes[16] = 24;
    return bytes;
}

inline std::vector<Case> textureCases() {
    using namespace std::string_literals;
    constexpr std::int32_t kMost = 0x7fffffff;
    const auto error = [](const std::string& name) { return "error: scene.pbrt:2:1: texture 't': " + name + ": "; };
    const std::string unknown = "its first bytes are of no known image format; known are EXR, PNG, JPEG, HDR, TIFF";
    return {
        {"image is missing", world("LightSource \"infinite\" \"string filename\" \"none.exr\""), 66,
         "error: scene.pbrt:2:1: light 'infinite': none.exr: cannot be opened: No such file"},
        {"image is a folder", world("LightSource \"infinite\" \"string filename\" \"a.exr\"", {{"a.exr/", ""}}), 66,
         "error: scene.pbrt:2:1: light 'infinite': a.exr: cannot be opened"},
        {"image is a device", world("LightSource \"infinite\" \"string filename\" \"/dev/zero\""), 66,
         "error: scene.pbrt:2:1: light 'infinite': /dev/zero: cannot be opened: it is no regular file"},
        {"empty image", texture("t.exr", ""), 65, error("t.exr") + "the file is empty"},
        {"sound EXR", texture("t.exr", exr()), 0, ""},
        {"EXR of four bytes", texture("t.exr", "\x76\x2f\x31\x01"), 65, error("t.exr") + "the EXR header is cut short"},
        {"EXR cut in the header", texture("t.exr", exr().substr(0, 100)), 65, error("t.exr") + "a name in the EXR header has no end"},
        {"EXR cut in the pixels", texture("t.exr", exr().substr(0, exr().size() - 5)), 65, error("t.exr")},
        {"EXR window of 2^31", texture("t.exr", exrClaiming(0, 0, kMost, kMost)), 65,
         error("t.exr") + "an image of 2147483648 x 2147483648 pixels"},
        {"EXR window inverted", texture("t.exr", exrClaiming(5, 5, 0, 0)), 65, error("t.exr") + "an image of -4 x -4 pixels is empty"},
        {"EXR window of 60000 x 60000", texture("t.exr", exrClaiming(0, 0, 59999, 59999)), 65,
         error("t.exr") + "an image of 60000 x 60000 pixels is larger than the limit of 268435456 pixels"},
        {"EXR window with a negative origin", texture("t.exr", exr(0.5f, {-3, -2, 5, 6})), 0, ""},
        {"EXR window outside the display window", texture("t.exr", exr(0.5f, {100, 100, 108, 108})), 0, ""},
        {"EXR without colours", texture("t.exr", exr(0.5f, {0, 0, 8, 8}, "Q")), 65,
         error("t.exr") + "among its 3 channels are neither R, G and B nor Y"},
        {"EXR all NaN", texture("t.exr", exr(std::numeric_limits<float>::quiet_NaN())), 0,
         "warning: scene.pbrt:2:1: texture 't': "},
        {"EXR all infinite", texture("t.exr", exr(std::numeric_limits<float>::infinity())), 0,
         "warning: scene.pbrt:2:1: texture 't': "},
        {"normal map all NaN",
         world("Material \"diffuse\" \"string normalmap\" \"t.exr\" Shape \"sphere\"",
               {{"t.exr", exr(std::numeric_limits<float>::quiet_NaN())}}),
         0, "warning: scene.pbrt:2:1: material 'diffuse': "},
        {"normal map is missing", world("Material \"diffuse\" \"string normalmap\" \"none.png\" Shape \"sphere\""), 66,
         "error: scene.pbrt:2:1: material 'diffuse': none.png: cannot be opened"},
        {"displacement of infinities",
         world("Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"t.exr\" \"float scale\" 1e38\n"
               "Material \"diffuse\" \"texture displacement\" \"t\" Shape \"sphere\"",
               {{"t.exr", exr(65504)}}),
         0, ""},
        {"EXR all denormal", texture("t.exr", exr(1e-40f)), 0, ""},
        {"EXR all 65504", texture("t.exr", exr(65504)), 0, ""},
        {"EXR all negative", texture("t.exr", exr(-1)), 0, ""},
        {"deep EXR", texture("t.exr", exrOfKind(0x800)), 65, error("t.exr") + "deep EXR files are not supported"},
        {"EXR that claims several parts", texture("t.exr", exrOfKind(0x1000)), 65, error("t.exr")},
        {"EXR with offset 0, which says that its writer was killed", texture("t.exr", exrWithOffset(0)), 0, ""},
        {"EXR with an offset into its header", texture("t.exr", exrWithOffset(8)), 65, error("t.exr")},
        {"IFF named PNG", texture("t.png", "FOR4\0\0\1\0CIMG"s), 65, error("t.png") + unknown},
        {"DPX named EXR", texture("t.exr", "SDPX\0\0\1\0"s), 65, error("t.exr") + unknown},
        {"PSD named PNG", texture("t.png", "8BPS\0\1"s), 65, error("t.png") + unknown},
        {"ICO named PNG", texture("t.png", "\0\0\1\0\1\0"s), 65, error("t.png") + unknown},
        {"GIF", texture("t.gif", "GIF89a\1\0\1\0"s), 65, error("t.gif") + unknown},
        {"PNG named EXR", texture("t.exr", png(1)), 0, ""},
        {"PNG of eight bytes", texture("t.png", "\x89PNG\r\n\x1a\n"), 65, error("t.png")},
        {"PNG bomb", texture("t.png", png(65535)), 65, error("t.png") + "an image of 65535 x 65535 pixels"},
        {"PNG of 0 x 0", texture("t.png", png(0)), 65, error("t.png")},
        {"TIFF of eight bytes", texture("t.tif", "II*\0\x08\0\0\0"s), 65, error("t.tif")},
        {"JPEG of three bytes", texture("t.jpg", "\xff\xd8\xff"), 65, error("t.jpg")},
        {"HDR bomb", texture("t.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n\2\2\xff\xff"), 65,
         error("t.hdr") + "an image of 60000 x 60000 pixels"},
        {"PFM bomb", texture("t.pfm", "PF\n16384 16384\n-1\n1234"), 65, error("t.pfm") + "an image of 16384 x 16384 pixels"},
        {"PFM of negative width", texture("t.pfm", "PF\n-5 5\n-1\n1234"), 65, error("t.pfm") + "an image of -5 x 5 pixels"},
        {"PFM with the scale nan", texture("t.pfm", "PF\n1 1\nnan\n123456789012"), 65, error("t.pfm") + "the scale"},
        {"TGA bomb", texture("t.tga", tga(65535)), 65, error("t.tga") + "an image of 65535 x 65535 pixels"},
        {"TGA without pixels", texture("t.tga", tga(1)), 65, error("t.tga")},
        {"TGA header under another name", texture("t.png", tga(1)), 65, error("t.png") + unknown},
        {"light image that is not square",
         world("LightSource \"infinite\" \"string filename\" \"a.exr\"", {{"a.exr", exr(1, {0, 0, 8, 5})}}), 65,
         "error: scene.pbrt:2:1: light 'infinite': the image 'a.exr' has 8 x 5 pixels; it has to be square"},
        {"light image all NaN",
         world("LightSource \"infinite\" \"string filename\" \"a.exr\"",
               {{"a.exr", exr(std::numeric_limits<float>::quiet_NaN())}}),
         0, "warning: scene.pbrt:2:1: light 'infinite': 64 pixels of the image are not finite"},
        {"light image all negative",
         world("LightSource \"infinite\" \"string filename\" \"a.exr\"", {{"a.exr", exr(-1)}}), 0, ""},
    };
}

}  // namespace penumbra::bad_input
