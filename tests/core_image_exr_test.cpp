// EXR files: planes in blocks come back as they were.

#include "core/image/exr.h"

#include "tests/expect_error.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace penumbra {
namespace {

constexpr ExrChannel::Type kFloat = ExrChannel::Type::Float, kUint = ExrChannel::Type::Uint;

/// A value for every place that no rounding to half would keep.
float valueAt(std::size_t channel, int x, int y) {
    return 1e-3f * float(channel + 1) + float(x) * 1.0001f - float(y) * 7.77f;
}
std::uint32_t countAt(int x, int y) {
    return 0xfffffff0u - std::uint32_t(x * 31 + y);
}

ExrHeader smallHeader() {
    ExrHeader header;
    header.displayWindow = {0, 0, 64, 80};
    header.dataWindow = {5, 20, 42, 61};  // 37 x 41: the last block is part of one
    header.channels = {{"R", kFloat}, {"G", kFloat}, {"B", kFloat}, {"samples", kUint}, {"SE.R", kFloat}};
    header.colorSpace = findColorSpace("rec2020");
    header.attributes = {
        {"seed", 17},
        {"command", std::string("render \"x\"\n\u00e9")},
        {"seconds", 1.5f},
        {"worldToCamera", std::array<float, 16>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}}};
    return header;
}

void fillBlock(const ExrHeader& header, const ExrBlock& block) {
    const int width = header.dataWindow.width();
    for (int row = 0; row < block.rows; ++row)
        for (int x = 0; x < width; ++x)
            for (std::size_t c = 0; c < header.channels.size(); ++c) {
                const int y = block.firstRow + row, at = row * width + x;
                if (header.channels[c].type == kUint)
                    block.uints[c][at] = countAt(x, y);
                else
                    block.floats[c][at] = valueAt(c, x, y);
            }
}

void writeSmall(const std::string& path, const ExrHeader& header) {
    writeExr(path, header, [&](const ExrBlock& block) { fillBlock(header, block); });
}

TEST(Exr, ComesBackBitForBit) {
    const TemporaryFolder folder;
    const ExrHeader header = smallHeader();
    int nextRow = header.dataWindow.y0;
    writeExr(folder.path("a.exr"), header, [&](const ExrBlock& block) {
        EXPECT_EQ(block.firstRow, nextRow);
        nextRow += block.rows;
        ASSERT_EQ(block.floats.size(), header.channels.size());
        EXPECT_EQ(block.floats[0].size(), std::size_t(block.rows) * 37);
        EXPECT_TRUE(block.floats[3].empty() && block.uints[0].empty());
        fillBlock(header, block);
    });
    EXPECT_EQ(nextRow, header.dataWindow.y1);

    const ExrFile file = readExr(folder.path("a.exr"));
    EXPECT_EQ(file.header.dataWindow.x0, 5);
    EXPECT_EQ(file.header.dataWindow.y1, 61);
    EXPECT_EQ(file.header.displayWindow.x1, 64);
    EXPECT_EQ(file.header.colorSpace, findColorSpace("rec2020"));
    for (const auto& attribute : header.attributes)
        EXPECT_NE(std::find(file.header.attributes.begin(), file.header.attributes.end(), attribute),
                  file.header.attributes.end())
            << attribute.first;
    for (std::size_t c = 0; c < header.channels.size(); ++c) {
        const auto in = std::find_if(file.header.channels.begin(), file.header.channels.end(),
                                     [&](const ExrChannel& other) { return other.name == header.channels[c].name; });
        ASSERT_NE(in, file.header.channels.end());
        EXPECT_EQ(in->type, header.channels[c].type);
        const std::size_t at = std::size_t(in - file.header.channels.begin());
        for (int y = 20; y < 61; ++y)
            for (int x = 0; x < 37; ++x) {
                const std::size_t i = std::size_t(y - 20) * 37 + x;
                if (in->type == kUint)
                    ASSERT_EQ(file.uints[at][i], countAt(x, y));
                else
                    ASSERT_EQ(file.floats[at][i], valueAt(c, x, y));
            }
    }
    EXPECT_EQ(file.find("samples"), nullptr);
    ASSERT_NE(file.find("SE.R"), nullptr);
    EXPECT_EQ((*file.find("SE.R"))[1], valueAt(4, 1, 20));
}

TEST(Exr, KeepsEveryKindOfFloat) {
    const TemporaryFolder folder;
    ExrHeader header;
    header.dataWindow = header.displayWindow = {0, 0, 6, 1};
    header.channels = {{"Y", kFloat}};
    const float values[] = {-0.f,
                            std::numeric_limits<float>::denorm_min(),
                            std::numeric_limits<float>::max(),
                            std::numeric_limits<float>::infinity(),
                            std::numeric_limits<float>::quiet_NaN(),
                            -3e38f};
    writeExr(folder.path("a.exr"), header,
             [&](const ExrBlock& b) { std::copy(std::begin(values), std::end(values), b.floats[0].begin()); });
    const Image image = readExrImage(folder.path("a.exr"));
    EXPECT_EQ(image.channels(), 1);
    EXPECT_EQ(std::memcmp(image.floats().data(), values, sizeof values), 0);
}

TEST(Exr, TheSameInputGivesTheSameBytes) {
    const TemporaryFolder folder;
    writeSmall(folder.path("a.exr"), smallHeader());
    writeSmall(folder.path("b.exr"), smallHeader());
    EXPECT_EQ(readBytes(folder.path("a.exr")), readBytes(folder.path("b.exr")));
}

TEST(Exr, IsReadAsAPicture) {
    const TemporaryFolder folder;
    writeSmall(folder.path("a.exr"), smallHeader());
    const Image image = readExrImage(folder.path("a.exr"));
    ASSERT_EQ(image.channels(), 3);
    EXPECT_EQ(&image.colorSpace(), findColorSpace("rec2020"));
    EXPECT_EQ(image.width(), 37);
    EXPECT_EQ(image.rgb(3, 2), (Rgb{valueAt(0, 3, 22), valueAt(1, 3, 22), valueAt(2, 3, 22)}));
}

TEST(Exr, ChannelsOfAPictureMayBeInALayer) {
    const TemporaryFolder folder;
    ExrHeader header = smallHeader();
    header.channels = {
        {"depth.Z", kFloat}, {"view.R", kFloat}, {"view.G", kFloat}, {"view.B", kFloat}, {"view.A", kFloat}};
    header.colorSpace = nullptr;
    writeSmall(folder.path("a.exr"), header);
    const Image image = readExrImage(folder.path("a.exr"));
    ASSERT_EQ(image.channels(), 4);
    EXPECT_EQ(image.value(1, 1, 3), valueAt(4, 1, 21));
    EXPECT_EQ(&image.colorSpace(), &srgbColorSpace());

    header.channels = {{"P.X", kFloat}, {"P.Y", kFloat}};
    writeSmall(folder.path("b.exr"), header);
    EXPECT_THROW(readExrImage(folder.path("b.exr")), Error);
}

TEST(Exr, WhatCannotBeWrittenLeavesNothing) {
    const TemporaryFolder folder;
    const ExrHeader header = smallHeader();
    messageOf([&] { writeSmall("/dev/full", header); }, ErrorKind::CannotWrite);
    messageOf([&] { writeSmall(folder.path("none/a.exr"), header); }, ErrorKind::CannotCreate);
    const std::string old = folder.file("a.exr", "old");
    struct Stop {};
    int blocks = 0;
    EXPECT_THROW(writeExr(old, header,
                          [&](const ExrBlock& block) {
                              fillBlock(header, block);
                              if (++blocks == 2) throw Stop();
                          }),
                 Stop);
    EXPECT_EQ(readBytes(old), "old");
    ExrHeader empty = header;
    empty.dataWindow = {0, 0, 0, 0};
    messageOf([&] { writeSmall(old, empty); }, ErrorKind::CannotWrite);
    EXPECT_EQ(readBytes(old), "old");
    EXPECT_EQ(folder.fileCount(), 1u);
}

}  // namespace
}  // namespace penumbra
