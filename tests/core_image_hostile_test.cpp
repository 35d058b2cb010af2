// Damaged, hostile and mislabelled image files: an Error of the right kind, quickly, without printing or much memory.

#include "core/image/image_io.h"

#include "core/base/error.h"
#include "tests/image_files.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <random>

namespace penumbra {
namespace {

constexpr int kSize = 48;

std::vector<float> noise() {
    std::mt19937 random(7);
    std::vector<float> rgb(kSize * kSize * 3);
    for (float& v : rgb)
        v = float(random() >> 8) * 0x1p-24f;
    return rgb;
}

void writeSmallExr(const std::string& path) {
    ExrHeader header;
    header.dataWindow = header.displayWindow = {0, 0, kSize, kSize};
    header.channels = {{"R"}, {"G"}, {"B"}};
    const std::vector<float> rgb = noise();
    writeExr(path, header, [&](const ExrBlock& block) {
        for (int c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < block.floats[c].size(); ++i)
                block.floats[c][i] = rgb[(std::size_t(block.firstRow) * kSize + i) * 3 + c];
    });
}

class HostileImage : public testing::Test {
protected:
    std::string sound(const std::string& extension) {
        const std::string path = folder.path("sound." + extension);
        if (extension == "exr")
            writeSmallExr(path);
        else
            writeImage(path, kSize, kSize, noise());
        return readBytes(path);
    }

    /// Reads bytes as a file of that name: true where an image came, false where an Error of bad data did.
    bool reads(const std::string& name, std::string_view bytes) {
        try {
            return !readImage(folder.file(name, bytes)).isEmpty();
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::BadData) << e.what();
            EXPECT_EQ(std::string(e.what()).find(folder.path(name) + ": "), 0u) << e.what();
            EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
            message = e.what();
            return false;
        }
    }

    TemporaryFolder folder;
    std::string message;
};

constexpr const char* kExtensions[] = {"exr", "png", "jpg", "hdr", "tif", "pfm"};

TEST_F(HostileImage, TruncatedFilesAreErrors) {
    for (const std::string extension : kExtensions) {
        const std::string bytes = sound(extension);
        ASSERT_TRUE(reads("whole." + extension, bytes));
        for (int percent = 0; percent < 100; percent += 3) {
            const std::size_t length = bytes.size() * percent / 100;
            EXPECT_FALSE(reads("cut." + extension, std::string_view(bytes).substr(0, length)))
                << extension << " " << percent;
        }
    }
}

TEST_F(HostileImage, DamagedFilesNeverDoWorseThanAnError) {
    std::mt19937 random(11);
    testing::internal::CaptureStderr();
    for (const std::string extension : kExtensions) {
        const std::string bytes = sound(extension);
        for (int mutant = 0; mutant < 100; ++mutant) {
            std::string changed = bytes;
            const std::size_t range = mutant % 2 ? std::min<std::size_t>(bytes.size(), 400) : bytes.size();
            for (unsigned edit = 0; edit <= random() % 6; ++edit)
                changed[random() % range] = char(random());
            reads("mutant." + extension, changed);
        }
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(HostileImage, EveryHeaderByteOfAnExrMayBe255) {
    const std::string bytes = sound("exr");
    for (std::size_t i = 0; i < 400; ++i) {
        std::string changed = bytes;
        changed[i] = char(0xff);
        reads("a.exr", changed);
    }
}

TEST_F(HostileImage, UnknownFormatsAreRefused) {
    for (const std::string_view bytes :
         {std::string_view(""), std::string_view("\0\0\0\0", 4), std::string_view("BM\x36\0\0\0"),
          std::string_view("GIF89a\1\0\1\0"), std::string_view("FOR4\0\0\1\0CIMG"), std::string_view("SDPX\0\0\1\0"),
          std::string_view("RIFF\1\0\0\0WEBP"), std::string_view("8BPS\0\1"), std::string_view("P6\n1 1\n255\nabc")})
        for (const char* name : {"a.png", "a.exr", "a.tga", "a.bmp"})
            EXPECT_FALSE(reads(name, bytes)) << name;
    EXPECT_FALSE(reads("a.tga", std::string(100, char(0xff))));
    EXPECT_FALSE(reads("a.png", "\x89PNG\r\n\x1a\n"));
    EXPECT_FALSE(reads("a.exr", "\x76\x2f\x31\x01"));
}

TEST_F(HostileImage, PathsThatAreNoFilesAreMissing) {
    const auto kindOf = [](const std::string& path) {
        try {
            readImage(path);
        } catch (const Error& e) {
            return e.kind();
        }
        return ErrorKind::Internal;
    };
    EXPECT_EQ(kindOf(folder.path("none.png")), ErrorKind::MissingInput);
    EXPECT_EQ(kindOf(folder.path("")), ErrorKind::MissingInput);
    EXPECT_EQ(kindOf(""), ErrorKind::MissingInput);
    EXPECT_EQ(kindOf("/dev/zero"), ErrorKind::MissingInput);
    EXPECT_EQ(kindOf(folder.path(std::string(100000, 'a'))), ErrorKind::MissingInput);
    EXPECT_EQ(kindOf(std::string("a\0.png", 6)), ErrorKind::MissingInput);
}

// --- sizes that only the header claims -------------------------------------------------------------------------------

TEST_F(HostileImage, PngBombsAreRefusedByTheirSize) {
    for (const std::uint32_t side : {16384u, 65535u, 0x7fffffffu}) {
        EXPECT_FALSE(reads("a.png", PngFile{side, side, 8, PngFile::Rgba, {{0}}}.encoded()));
        EXPECT_FALSE(message.empty());
    }
}

TEST_F(HostileImage, JpegTiffHdrPfmAndTgaBombsAreRefused) {
    std::string jpeg = sound("jpg");
    const std::size_t frame = jpeg.find("\xff\xc0");
    ASSERT_NE(frame, std::string::npos);
    jpeg.replace(frame + 5, 4, "\xff\xff\xff\xff");  // height and width of the frame
    EXPECT_FALSE(reads("a.jpg", jpeg));
    jpeg[frame + 1] = char(0xc2);  // progressive
    jpeg.replace(frame + 5, 4, "\x40\0\x40\0", 4);
    EXPECT_FALSE(reads("a.jpg", jpeg));
    EXPECT_NE(message.find("16384 x 16384"), std::string::npos) << message;
    EXPECT_FALSE(reads("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n\2\2\xff\xff"));
    EXPECT_FALSE(reads("a.pfm", "PF\n16384 16384\n-1\n1234"));
    EXPECT_FALSE(reads("a.pfm", "PF\n2000000000 2000000000\n-1\n1234"));
    EXPECT_FALSE(reads("a.pfm", "PF\n-5 5\n-1\n1234"));
    EXPECT_FALSE(reads("a.pfm", "PF\n1 1\nnan\n123456789012"));
    EXPECT_FALSE(reads("a.pfm", "PF " + std::string(1 << 20, ' ')));
    std::string tga(18, '\0');
    tga[2] = 10;  // colour, run-length coded
    tga[12] = tga[13] = tga[14] = tga[15] = char(0xff);
    tga[16] = 32;
    EXPECT_FALSE(reads("a.tga", tga));
}

/// The little-endian box that names the data window of an EXR, replaced.
std::string withDataWindow(std::string bytes, std::array<std::int32_t, 4> box) {
    const std::string name("dataWindow\0box2i\0", 17);
    const std::size_t at = bytes.find(name) + name.size() + 4;
    bytes.replace(at, sizeof box, reinterpret_cast<const char*>(box.data()), sizeof box);
    return bytes;
}

TEST_F(HostileImage, ExrWindowsThatCannotBeAreRefused) {
    const std::string bytes = sound("exr");
    ASSERT_TRUE(reads("a.exr", withDataWindow(bytes, {0, 0, kSize - 1, kSize - 1})));
    constexpr std::int32_t kMost = 0x7fffffff;
    for (const std::array<std::int32_t, 4> box :
         {std::array{0, 0, kMost, kMost}, std::array{-kMost - 1, -kMost - 1, kMost, kMost},
          std::array{0, 0, 100000000, 0}, std::array{0, 0, 0, 100000000}, std::array{0, 0, 16383, 16383},
          std::array{5, 5, 4, 4}, std::array{0, 0, -1, 5}})
        EXPECT_FALSE(reads("a.exr", withDataWindow(bytes, box))) << box[2] << " " << box[3];
}

TEST_F(HostileImage, LimitsAreTheCallersToSet) {
    const std::string path = folder.file("a.png", sound("png"));
    ReadImageOptions options;
    options.limits.pixels = kSize * kSize - 1;
    EXPECT_THROW(readImage(path, options), Error);
    options.limits.pixels = kSize * kSize;
    EXPECT_EQ(readImage(path, options).width(), kSize);
    options.limits.bytes = 1000;
    EXPECT_THROW(readImage(path, options), Error);
    const std::string exr = folder.file("a.exr", sound("exr"));
    EXPECT_THROW(readImage(exr, options), Error);
    EXPECT_THROW(readExr(exr, options.limits), Error);
}

}  // namespace
}  // namespace penumbra
