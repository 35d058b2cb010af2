// Damaged EXR files of every kind that OpenEXR writes: an image or an Error of bad data, nothing worse. Sanitizers watch.

#include "core/base/error.h"
#include "core/image/exr.h"
#include "tests/temporary_folder.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <random>

namespace penumbra {
namespace {

constexpr int kSize = 40;

/// Three channels of noise, and the header that asks for them.
struct Picture {
    std::vector<float> values;
    Imf::Header header{kSize, kSize};
    Imf::FrameBuffer frame;

    Picture() : values(3 * kSize * kSize) {
        std::mt19937 random(3);
        for (float& v : values)
            v = float(random() >> 8) * 0x1p-24f;
        for (int c = 0; c < 3; ++c) {
            const char name[] = {"RGB"[c], 0};
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            frame.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data() + c * kSize * kSize, header.dataWindow()));
        }
    }
};

std::string scanlines(Imf::Compression compression) {
    const TemporaryFolder folder;
    Picture picture;
    picture.header.compression() = compression;
    {
        Imf::OutputFile file(folder.path("a.exr").c_str(), picture.header, 0);
        file.setFrameBuffer(picture.frame);
        file.writePixels(kSize);
    }
    return readBytes(folder.path("a.exr"));
}

std::string tiles(Imf::LevelMode mode) {
    const TemporaryFolder folder;
    Picture picture;
    picture.header.setTileDescription(Imf::TileDescription(16, 16, mode));
    {
        Imf::TiledOutputFile file(folder.path("a.exr").c_str(), picture.header, 0);
        for (int y = 0; y < file.numYLevels(); ++y)
            for (int x = 0; x < file.numXLevels(); ++x) {
                if (!file.isValidLevel(x, y)) continue;
                file.setFrameBuffer(picture.frame);
                file.writeTiles(0, file.numXTiles(x) - 1, 0, file.numYTiles(y) - 1, x, y);
            }
    }
    return readBytes(folder.path("a.exr"));
}

std::string twoParts() {
    const TemporaryFolder folder;
    Picture picture;
    std::vector<Imf::Header> headers(2, picture.header);
    for (int i = 0; i < 2; ++i) {
        headers[std::size_t(i)].setName(i ? "second" : "first");
        headers[std::size_t(i)].setType("scanlineimage");
    }
    {
        Imf::MultiPartOutputFile file(folder.path("a.exr").c_str(), headers.data(), 2);
        for (int i = 0; i < 2; ++i) {
            Imf::OutputPart part(file, i);
            part.setFrameBuffer(picture.frame);
            part.writePixels(kSize);
        }
    }
    return readBytes(folder.path("a.exr"));
}

struct Kind {
    const char* name;
    std::string bytes;
};

std::vector<Kind> everyKind() {
    return {{"none", scanlines(Imf::NO_COMPRESSION)}, {"rle", scanlines(Imf::RLE_COMPRESSION)},
            {"zips", scanlines(Imf::ZIPS_COMPRESSION)}, {"zip", scanlines(Imf::ZIP_COMPRESSION)},
            {"piz", scanlines(Imf::PIZ_COMPRESSION)}, {"pxr24", scanlines(Imf::PXR24_COMPRESSION)},
            {"b44", scanlines(Imf::B44_COMPRESSION)}, {"b44a", scanlines(Imf::B44A_COMPRESSION)},
            {"dwaa", scanlines(Imf::DWAA_COMPRESSION)}, {"dwab", scanlines(Imf::DWAB_COMPRESSION)},
            {"tiled", tiles(Imf::ONE_LEVEL)}, {"mip", tiles(Imf::MIPMAP_LEVELS)},
            {"rip", tiles(Imf::RIPMAP_LEVELS)}, {"two parts", twoParts()}};
}

/// Whether the bytes are an image; an Error must be of bad data and say which file.
bool isImage(const TemporaryFolder& folder, std::string_view bytes) {
    const std::string path = folder.file("a.exr", bytes);
    try {
        return !readExrImage(path).isEmpty();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::BadData) << e.what();
        EXPECT_TRUE(std::string_view(e.what()).starts_with(path + ": ")) << e.what();
        return false;
    }
}

/// One to eight bytes changed, half of the time near the header.
std::string mutant(const std::string& bytes, std::mt19937& random) {
    std::string changed = bytes;
    const std::size_t range = random() % 2 ? std::min<std::size_t>(bytes.size(), 500) : bytes.size();
    for (unsigned edits = 1 + random() % 8; edits > 0; --edits)
        changed[random() % range] = char(random());
    return changed;
}

void expectOnlyErrors(int mutants, int percentStep) {
    const TemporaryFolder folder;
    std::mt19937 random(5);
    for (const Kind& kind : everyKind()) {
        SCOPED_TRACE(kind.name);
        EXPECT_TRUE(isImage(folder, kind.bytes));
        int refused = 0;
        for (int i = 0; i < mutants; ++i)
            refused += !isImage(folder, mutant(kind.bytes, random));
        EXPECT_GT(refused, mutants / 10);
        for (int percent = 0; percent < 100; percent += percentStep)
            isImage(folder, std::string_view(kind.bytes).substr(0, kind.bytes.size() * std::size_t(percent) / 100));
    }
}

TEST(ExrMutants, AreReadOrRefused) {
    expectOnlyErrors(50, 10);
}

TEST(LongExrMutants, AreReadOrRefused) {
    expectOnlyErrors(1500, 1);
}

}  // namespace
}  // namespace penumbra
