// PNG files of every kind, depth, filter and order of rows, against the samples that they were made of; and files that
// are damaged beneath their checksums, which core_image_hostile_test.cpp does not get past.
#include "core/image/image_io.h"

#include "core/base/error.h"
#include "tests/image_files.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <random>

namespace penumbra {
namespace {

constexpr int kCycled = 5;  // a filter of its own for each row

/// A picture as its samples, from which a file is made.
struct Samples {
    int width = 0, height = 0, bits = 8;
    PngFile::Kind kind = PngFile::Grey;
    std::string palette{}, transparency{};
    std::vector<unsigned> values{};

    int perPixel() const {
        return kind == PngFile::Rgb ? 3 : kind == PngFile::GreyAlpha ? 2 : kind == PngFile::Rgba ? 4 : 1;
    }
    unsigned at(int x, int y, int c) const { return values[std::size_t((y * width + x) * perPixel() + c)]; }

    /// The rows of a pass (the picture's pixels at x0 + i dx, y0 + j dy), filtered, each after its filter's number.
    std::string rows(int x0, int y0, int dx, int dy, int filter) const {
        std::string out, above;
        for (int y = y0, j = 0; y < height; y += dy, ++j) {
            std::string row;
            int filled = 8;
            for (int x = x0; x < width; x += dx)
                for (int c = 0; c < perPixel(); ++c) {
                    if (bits == 16) row.push_back(char(at(x, y, c) >> 8));
                    if (bits >= 8) {
                        row.push_back(char(at(x, y, c)));
                        continue;
                    }
                    if (filled == 8) row.push_back(filled = 0);
                    row.back() = char(row.back() | at(x, y, c) << (8 - bits - filled));
                    filled += bits;
                }
            if (row.empty()) return "";
            above.resize(row.size());
            const int kind = filter == kCycled ? j % 5 : filter;
            const std::size_t step = std::size_t(std::max(1, perPixel() * bits / 8));
            out.push_back(char(kind));
            for (std::size_t i = 0; i < row.size(); ++i) {
                const auto byte = [](char v) { return int(static_cast<unsigned char>(v)); };
                const int a = i < step ? 0 : byte(row[i - step]), b = byte(above[i]), c = i < step ? 0 : byte(above[i - step]);
                const int p = a + b - c, toA = std::abs(p - a), toB = std::abs(p - b), toC = std::abs(p - c);
                const int paeth = toA <= toB && toA <= toC ? a : toB <= toC ? b : c;
                const int predicted[] = {0, a, b, (a + b) / 2, paeth};
                out.push_back(char(byte(row[i]) - predicted[kind]));
            }
            above = row;
        }
        return out;
    }

    std::string header(bool interlaced) const {
        return PngFile::bigEndian(std::uint32_t(width)) + PngFile::bigEndian(std::uint32_t(height)) +
               std::string{char(bits), char(kind), 0, 0, char(interlaced)};
    }

    /// A file of these unpacked data, in pieces.
    std::string file(const std::string& raw, bool interlaced = false) const {
        std::string packed(compressBound(raw.size()), 0);
        uLongf size = packed.size();
        compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(raw.data()), raw.size());
        packed.resize(size);
        std::string out = "\x89PNG\r\n\x1a\n" + PngFile::chunk("IHDR", header(interlaced));
        if (!palette.empty()) out += PngFile::chunk("PLTE", palette);
        if (!transparency.empty()) out += PngFile::chunk("tRNS", transparency);
        for (std::size_t i = 0; i < packed.size(); i += 7)
            out += PngFile::chunk("IDAT", packed.substr(i, 7));
        return out + PngFile::chunk("IEND", "");
    }
    std::string file(int filter, bool interlaced) const {
        if (!interlaced) return file(rows(0, 0, 1, 1, filter));
        return file(rows(0, 0, 8, 8, filter) + rows(4, 0, 8, 8, filter) + rows(0, 4, 4, 8, filter) + rows(2, 0, 4, 4, filter) +
                        rows(0, 2, 2, 4, filter) + rows(1, 0, 2, 2, filter) + rows(0, 1, 1, 2, filter),
                    true);
    }
};

Samples random(int width, int height, int bits, PngFile::Kind kind, std::mt19937& generator) {
    Samples s{width, height, bits, kind};
    if (kind == PngFile::Palette) {
        for (int i = 0; i < 3 << bits; ++i)
            s.palette.push_back(char(generator()));
        s.transparency = std::string{char(10), char(200)};
    }
    if (kind == PngFile::Rgb) s.transparency = std::string("\0\1\0\2\0\3", 6);
    for (int i = 0; i < width * height * s.perPixel(); ++i)
        s.values.push_back(generator() & ((1u << bits) - 1));
    if (kind == PngFile::Rgb) std::copy_n(std::array{1u, 2u, 3u}.begin(), 3, s.values.begin());
    return s;
}

/// What a channel of the picture has to be, from 0 to 1.
double expected(const Samples& s, int x, int y, int channel) {
    const double largest = (1 << s.bits) - 1;
    if (s.kind == PngFile::Palette) {
        const unsigned entry = s.at(x, y, 0);
        if (channel == 3) return entry < 2 ? (entry == 0 ? 10 : 200) / 255. : 1;
        return static_cast<unsigned char>(s.palette[3 * entry + unsigned(channel)]) / 255.;
    }
    if (s.kind == PngFile::Rgb && channel == 3)
        return s.at(x, y, 0) == 1 && s.at(x, y, 1) == 2 && s.at(x, y, 2) == 3 ? 0 : 1;
    return s.at(x, y, channel) / largest;
}

TEST(Png, EveryKindDepthFilterAndOrder) {
    const TemporaryFolder folder;
    std::mt19937 generator(5);
    ReadImageOptions linear;
    linear.pngEncoding = TransferFunction::linear();
    const std::pair<PngFile::Kind, std::vector<int>> kinds[] = {{PngFile::Grey, {1, 2, 4, 8, 16}},
                                                                {PngFile::Rgb, {8, 16}},
                                                                {PngFile::Palette, {1, 2, 4, 8}},
                                                                {PngFile::GreyAlpha, {8, 16}},
                                                                {PngFile::Rgba, {8, 16}}};
    for (const auto& [kind, depths] : kinds)
        for (const int bits : depths)
            for (const auto& [width, height] : {std::pair{1, 1}, {3, 2}, {13, 11}, {33, 20}})
                for (const bool interlaced : {false, true})
                    for (int filter = 0; filter <= kCycled; ++filter) {
                        const Samples s = random(width, height, bits, kind, generator);
                        const Image image = readImage(folder.file("a.png", s.file(filter, interlaced)), linear);
                        const bool grey = kind == PngFile::Grey || kind == PngFile::GreyAlpha;
                        ASSERT_EQ(image.width(), width);
                        ASSERT_EQ(image.height(), height);
                        ASSERT_EQ(image.channels(), grey ? 1 : 4);
                        ASSERT_EQ(image.isByte(), bits <= 8);
                        for (int y = 0; y < height; ++y)
                            for (int x = 0; x < width; ++x)
                                for (int c = 0; c < image.channels(); ++c)
                                    ASSERT_NEAR(image.value(x, y, c), expected(s, x, y, c), 1e-6)
                                        << "kind " << kind << ", " << bits << " bits, filter " << filter << ", interlaced "
                                        << interlaced << ", " << width << " x " << height << ": " << x << " " << y << " " << c;
                    }
}

class DamagedPng : public testing::Test {
protected:
    std::string messageOf(const std::string& bytes) {
        try {
            readImage(folder.file("a.png", bytes));
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::BadData);
            return e.what();
        }
        return "";
    }
    void expectRefused(const std::string& bytes) {
        EXPECT_NE(messageOf(bytes).find("the PNG is damaged: "), std::string::npos);
    }

    TemporaryFolder folder;
    std::mt19937 generator{6};
};

/// The reasons are libpng's, in its own words.
TEST_F(DamagedPng, WhatItsChecksumsDoNotShowIsRefused) {
    const Samples s = random(9, 7, 8, PngFile::Rgba, generator);
    const std::string raw = s.rows(0, 0, 1, 1, 4);
    EXPECT_EQ(messageOf(s.file(raw)), "");
    EXPECT_EQ(messageOf(s.file(raw + "more")), "");  // as other readers have it
    for (const std::size_t length : {std::size_t(0), std::size_t(1), raw.size() - 1})
        expectRefused(s.file(raw.substr(0, length)));
    std::string odd = raw;
    odd[0] = 5;
    expectRefused(s.file(odd));

    Samples p = random(9, 7, 4, PngFile::Palette, generator);
    const std::string rows = p.rows(0, 0, 1, 1, 0);
    p.palette.resize(3);
    p.transparency = "xy";
    expectRefused(p.file(rows));
    for (const std::size_t size : {0, 4}) {
        p.palette.resize(size);
        expectRefused(p.file(rows));
    }
    Samples c = random(9, 7, 8, PngFile::Rgb, generator);
    c.transparency = "odd";
    expectRefused(c.file(0, false));
}

TEST_F(DamagedPng, ColoursThatThePaletteLacksAreBlack) {
    Samples p = random(9, 7, 4, PngFile::Palette, generator);
    p.palette.resize(3);
    p.transparency.clear();
    p.values.assign(p.values.size(), 0);
    p.values.back() = 7;
    const Image image = readImage(folder.file("a.png", p.file(0, false)));
    EXPECT_EQ(image.value(0, 0, 0), image.value(3, 3, 0));
    for (int c = 0; c < 3; ++c)
        EXPECT_EQ(image.value(8, 6, c), 0.f);
}

TEST_F(DamagedPng, DataThatDoNotInflateNeverDoWorseThanAnError) {
    testing::internal::CaptureStderr();
    const PngFile::Kind kinds[] = {PngFile::Grey, PngFile::Rgb, PngFile::Palette, PngFile::GreyAlpha, PngFile::Rgba};
    for (int mutant = 0; mutant < 2000; ++mutant) {
        const Samples s = random(1 + int(generator() % 20), 1 + int(generator() % 20), 8, kinds[generator() % 5], generator);
        std::string bytes = s.file(kCycled, generator() % 2);
        // Any byte of any chunk's data, whose checksum is put right again.
        for (unsigned edit = 0; edit <= generator() % 4; ++edit) {
            std::size_t at = 8;
            std::vector<std::size_t> chunks;
            for (; at < bytes.size(); at += 12 + (std::size_t(static_cast<unsigned char>(bytes[at + 2])) << 8 |
                                                  static_cast<unsigned char>(bytes[at + 3])))
                chunks.push_back(at);
            const std::size_t chunk = chunks[generator() % (chunks.size() - 1)];
            const std::size_t size = std::size_t(static_cast<unsigned char>(bytes[chunk + 2])) << 8 |
                                     static_cast<unsigned char>(bytes[chunk + 3]);
            std::string data = bytes.substr(chunk + 8, size);
            data[generator() % size] = char(generator());
            bytes.replace(chunk, size + 12, PngFile::chunk(bytes.substr(chunk + 4, 4), data));
        }
        messageOf(bytes);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace penumbra
