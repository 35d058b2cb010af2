// Image files: what is written comes back, and every file is read as its format has it.

#include "core/image/image_io.h"

#include "tests/expect_error.h"
#include "tests/image_files.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>

namespace penumbra {
namespace {

constexpr int kWidth = 23, kHeight = 11;  // no multiple of anything

/// A smooth picture that tells rows, columns and channels apart.
std::vector<float> picture(float scale = 1) {
    std::vector<float> rgb;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (const float v : {float(x) / kWidth, float(y) / kHeight, float(x + y) / (kWidth + kHeight)})
                rgb.push_back(scale * v);
    return rgb;
}

/// Whether "2001:02:03", as TIFF and Exif write dates, stands somewhere.
bool holdsDate(const std::string& bytes) {
    constexpr std::string_view kForm = "dddd:dd:dd";
    const auto matches = [&](std::size_t at) {
        for (std::size_t i = 0; i < kForm.size(); ++i)
            if (kForm[i] == 'd' ? !std::isdigit(static_cast<unsigned char>(bytes[at + i])) : bytes[at + i] != ':')
                return false;
        return true;
    };
    for (std::size_t at = 0; at + kForm.size() <= bytes.size(); ++at)
        if (matches(at)) return true;
    return false;
}

class ImageFile : public testing::Test {
protected:
    Image written(const std::string& name, const std::vector<float>& rgb, const WriteImageOptions& options = {},
                  const ReadImageOptions& reading = {}) {
        writeImage(folder.path(name), kWidth, kHeight, rgb, options);
        return readImage(folder.path(name), reading);
    }
    TemporaryFolder folder;
};

TEST_F(ImageFile, PngOfEightBitsStaysBytes) {
    const std::vector<float> rgb = picture();
    const Image image = written("a.png", rgb);
    ASSERT_TRUE(image.isByte());
    EXPECT_EQ(image.width(), kWidth);
    EXPECT_EQ(image.height(), kHeight);
    EXPECT_EQ(image.channels(), 3);
    for (std::size_t i = 0; i < rgb.size(); ++i)
        EXPECT_EQ(image.bytes()[i], std::floor(rgb[i] * 255 + 0.5f));
    EXPECT_EQ(image.rgb(5, 3).g, linearFromSrgb(image.bytes()[(3 * kWidth + 5) * 3 + 1] / 255.f));
}

TEST_F(ImageFile, PngObeysItsEncoding) {
    ReadImageOptions linear, gamma;
    linear.pngEncoding = TransferFunction::linear();
    gamma.pngEncoding = TransferFunction::gamma(2.2f);
    const float encoded = std::floor(picture()[3 * 7] * 255 + 0.5f) / 255;
    EXPECT_NEAR(written("a.png", picture(), {}, linear).rgb(7, 0).r, encoded, 1e-7f);
    EXPECT_NEAR(written("a.png", picture(), {}, gamma).rgb(7, 0).r, std::pow(encoded, 2.2f), 1e-7f);
    WriteImageOptions deep;
    deep.bits = 16;
    const Image image = written("a.png", picture(), deep, gamma);
    EXPECT_FALSE(image.isByte());
    const float deepValue = std::floor(picture()[3 * 7] * 65535 + 0.5f) / 65535;
    EXPECT_NEAR(image.rgb(7, 0).r, std::pow(deepValue, 2.2f), 1e-6f);
}

TEST_F(ImageFile, OtherIntegerFormatsAreAlwaysSrgb) {
    ReadImageOptions linear;
    linear.pngEncoding = TransferFunction::linear();
    for (const char* name : {"a.jpg", "a.tif"}) {
        const Image image = written(name, picture(), {}, linear);
        ASSERT_TRUE(image.isByte()) << name;
        EXPECT_EQ(image.encoding(), TransferFunction::srgb()) << name;
    }
    WriteImageOptions deep;
    deep.bits = 16;
    EXPECT_NEAR(written("a.tiff", picture(), deep, linear).rgb(7, 0).r, linearFromSrgb(picture()[3 * 7]), 1e-4f);
}

TEST_F(ImageFile, JpegIsNearAndItsQualityCounts) {
    WriteImageOptions coarse;
    coarse.jpegQuality = 10;
    const Image fine = written("fine.jpeg", picture()), rough = written("rough.jpeg", picture(), coarse);
    for (std::size_t i = 0; i < fine.bytes().size(); ++i)
        EXPECT_NEAR(fine.bytes()[i] / 255.f, picture()[i], 0.02f);
    EXPECT_LT(std::filesystem::file_size(folder.path("rough.jpeg")),
              std::filesystem::file_size(folder.path("fine.jpeg")));
}

TEST_F(ImageFile, FloatFormatsAreLinear) {
    std::vector<float> rgb = picture(100);
    rgb[0] = -5;
    rgb[1] = 1e-7f;
    WriteImageOptions deep;
    deep.bits = 32;
    for (const char* name : {"a.pfm", "a.tif"}) {
        const Image image = written(name, rgb, deep);
        ASSERT_EQ(image.floats().size(), rgb.size());
        EXPECT_EQ(std::memcmp(image.floats().data(), rgb.data(), rgb.size() * sizeof(float)), 0) << name;
    }
    const Image hdr = written("a.hdr", rgb);
    ASSERT_EQ(hdr.floats().size(), rgb.size());
    EXPECT_EQ(hdr.floats()[0], 0);                     // no negative values
    for (std::size_t i = 3; i < rgb.size(); i += 3) {  // one exponent for the three
        const float largest = std::max({rgb[i], rgb[i + 1], rgb[i + 2]});
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(hdr.floats()[i + c], rgb[i + c], largest / 100) << i;
    }
}

TEST_F(ImageFile, ValuesOutOfRangeAreClampedAndNanIsBlack) {
    std::vector<float> rgb = picture();
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const float odd[] = {-1, 2, nan, infinity, -infinity, 1};
    std::copy(std::begin(odd), std::end(odd), rgb.begin());
    const Image image = written("a.png", rgb);
    const std::uint8_t expected[] = {0, 255, 0, 255, 0, 255};
    EXPECT_TRUE(std::equal(std::begin(expected), std::end(expected), image.bytes().begin()));
    const Image hdr = written("a.hdr", rgb);
    for (const float v : hdr.floats())
        EXPECT_TRUE(std::isfinite(v));
}

TEST_F(ImageFile, TheSameInputGivesTheSameBytes) {
    for (const char* extension : {"png", "jpg", "hdr", "pfm", "tif"}) {
        const std::string a = folder.path(std::string("a.") + extension),
                          b = folder.path(std::string("b.") + extension);
        writeImage(a, kWidth, kHeight, picture());
        writeImage(b, kWidth, kHeight, picture());
        EXPECT_EQ(readBytes(a), readBytes(b)) << extension;
        EXPECT_FALSE(holdsDate(readBytes(a))) << extension;
    }
}

TEST_F(ImageFile, FormatIsToldByTheFirstBytes) {
    writeImage(folder.path("a.png"), kWidth, kHeight, picture());
    std::filesystem::rename(folder.path("a.png"), folder.path("b.exr"));
    EXPECT_EQ(readImage(folder.path("b.exr")).channels(), 3);
    EXPECT_EQ(imageFileKind("a/b.c/x.PNG"), ImageFileKind::DisplayEncoded);
    EXPECT_EQ(imageFileKind("x.hdr"), ImageFileKind::Linear);
    EXPECT_EQ(imageFileKind("x.tif"), ImageFileKind::DisplayEncoded);
    EXPECT_EQ(imageFileKind("x.bmp"), ImageFileKind::Unknown);
    EXPECT_EQ(imageFileKind("png"), ImageFileKind::Unknown);
}

TEST_F(ImageFile, UnknownExtensionsAndPathsAreErrorsAndLeaveNothing) {
    const std::vector<float> rgb = picture();
    const auto attempt = [&](const std::string& path, ErrorKind kind) {
        return messageOf([&] { writeImage(path, kWidth, kHeight, rgb); }, kind);
    };
    EXPECT_NE(attempt(folder.path("a.bmp"), ErrorKind::Usage).find("known: png"), std::string::npos);
    attempt(folder.path("a"), ErrorKind::Usage);
    WriteImageOptions odd;
    odd.bits = 32;
    messageOf([&] { writeImage(folder.path("a.png"), kWidth, kHeight, rgb, odd); }, ErrorKind::Usage);
    odd.bits = 12;
    messageOf([&] { writeImage(folder.path("a.tif"), kWidth, kHeight, rgb, odd); }, ErrorKind::Usage);
    attempt(folder.path("none/a.png"), ErrorKind::CannotCreate);
    attempt("/dev/null/a.png", ErrorKind::CannotCreate);
    EXPECT_EQ(folder.fileCount(), 0u);
}

// --- kinds of PNG ----------------------------------------------------------------------------------------------------

TEST_F(ImageFile, PngOfEveryKind) {
    const auto read = [&](const PngFile& png) { return readImage(folder.file("a.png", png.encoded())); };
    const Image grey = read({2, 1, 8, PngFile::Grey, {{10, 200}}});
    EXPECT_EQ(grey.channels(), 1);
    EXPECT_EQ(grey.bytes()[1], 200);
    EXPECT_EQ(grey.rgb(0, 0).r, grey.rgb(0, 0).b);

    const Image greyAlpha = read({2, 1, 8, PngFile::GreyAlpha, {{10, 128, 200, 0}}});  // as pbrt: the grey alone
    EXPECT_EQ(greyAlpha.channels(), 1);
    EXPECT_EQ(greyAlpha.bytes()[1], 200);

    const Image rgba = read({2, 1, 8, PngFile::Rgba, {{10, 20, 30, 128, 200, 100, 50, 0}}});
    ASSERT_EQ(rgba.channels(), 4);
    const std::uint8_t expected[] = {10, 20, 30, 128, 200, 100, 50, 0};  // not multiplied by alpha
    EXPECT_TRUE(std::equal(std::begin(expected), std::end(expected), rgba.bytes().begin()));
    EXPECT_NEAR(rgba.value(0, 0, 3), linearFromSrgb(128 / 255.f), 1e-7f);  // alpha is decoded too

    const Image bits = read({8, 1, 1, PngFile::Grey, {{0xa5}}});
    EXPECT_EQ(bits.bytes()[0], 255);
    EXPECT_EQ(bits.bytes()[1], 0);
    const Image deep = read({1, 1, 16, PngFile::Rgb, {{0xff, 0xff, 0x80, 0x00, 0, 0}}});
    EXPECT_FALSE(deep.isByte());
    EXPECT_NEAR(deep.rgb(0, 0).g, linearFromSrgb(32768 / 65535.f), 1e-6f);
    const Image palette = read({2, 1, 8, PngFile::Palette, {{1, 0}}, {1, 2, 3, 40, 50, 60}});
    EXPECT_EQ(palette.channels(), 3);
    EXPECT_EQ(palette.bytes()[0], 40);
    EXPECT_EQ(palette.bytes()[5], 3);
}

TEST_F(ImageFile, TgaIsReadTopRowFirst) {
    for (const bool topDown : {false, true}) {
        std::string tga(18, '\0');
        tga[2] = 2;             // colour, uncompressed
        tga[12] = tga[14] = 2;  // 2 x 2
        tga[16] = 24;
        tga[17] = topDown ? 0x20 : 0;
        const std::string top("\x01\x02\x03\x04\x05\x06", 6), bottom("\x07\x08\x09\x0a\x0b\x0c", 6);  // blue first
        tga += topDown ? top + bottom : bottom + top;
        const Image image = readImage(folder.file("a.TGA", tga));
        ASSERT_EQ(image.channels(), 3);
        EXPECT_EQ(image.bytes()[0], 3);
        EXPECT_EQ(image.bytes()[11], 10);
        EXPECT_EQ(image.encoding(), TransferFunction::srgb());
        EXPECT_NE(
            messageOf([&] { readImage(folder.file("a.tgb", tga)); }, ErrorKind::BadData).find("no known image format"),
            std::string::npos);
    }
}

TEST_F(ImageFile, PfmOfBothByteOrdersAndScales) {
    const auto floats = [](std::initializer_list<float> values, bool big) {
        std::string out;
        for (const float v : values) {
            std::string bytes(reinterpret_cast<const char*>(&v), 4);
            out += big ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
        }
        return out;
    };
    const Image grey = readImage(folder.file("a.pfm", "Pf\n1 2\n-1.0\n" + floats({1.5f, -2}, false)));
    EXPECT_EQ(grey.channels(), 1);
    EXPECT_EQ(grey.value(0, 0, 0), -2);  // the last row of the file is the top
    EXPECT_EQ(grey.value(0, 1, 0), 1.5f);
    const Image color = readImage(folder.file("a.pfm", "PF 1 1 2.0\n" + floats({1, 2, 3}, true)));
    EXPECT_EQ(color.rgb(0, 0), (Rgb{2, 4, 6}));
}

}  // namespace
}  // namespace penumbra
