// The stream of a file's bytes: the window, skipping, and the bound of what is left. (gzip:
// core_geometry_ply_test.cpp.)

#include "core/base/byte_reader.h"

#include <gtest/gtest.h>

#include <string>

namespace penumbra {
namespace {

std::string numbered(std::size_t size) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i)
        bytes[i] = static_cast<char>(i * 7 + i / 256);
    return bytes;
}

TEST(ByteReader, WindowsOfAnySizeShowEveryByteOnce) {
    const std::string bytes = numbered(3 * ByteReader::kBlockSize + 17);
    for (const std::size_t window :
         {std::size_t{1}, std::size_t{1000}, ByteReader::kBlockSize - 1, ByteReader::kBlockSize}) {
        ByteReader reader = ByteReader::overMemory(bytes, "bytes");
        std::string seen;
        while (reader.fill(window)) {
            EXPECT_EQ(reader.mostBytesLeft(), bytes.size() - seen.size());
            seen.append(reader.data(), window);
            reader.consume(window);
        }
        EXPECT_LT(reader.available(), window);
        seen.append(reader.data(), reader.available());
        EXPECT_TRUE(seen == bytes) << window;
    }
}

TEST(ByteReader, SkipsAcrossBlocks) {
    const std::string bytes = numbered(3 * ByteReader::kBlockSize);
    for (const std::size_t distance :
         {std::size_t{0}, std::size_t{5}, ByteReader::kBlockSize, 2 * ByteReader::kBlockSize + 1}) {
        ByteReader reader = ByteReader::overMemory(bytes, "bytes");
        ASSERT_TRUE(reader.fill(3));
        reader.consume(3);
        ASSERT_TRUE(reader.skip(distance));
        ASSERT_TRUE(reader.fill(1));
        EXPECT_EQ(*reader.data(), bytes[3 + distance]);
        EXPECT_TRUE(reader.skip(bytes.size() - 3 - distance));
        EXPECT_FALSE(reader.fill(1));
        EXPECT_FALSE(reader.skip(1));
        EXPECT_TRUE(reader.skip(0));
    }
    EXPECT_FALSE(ByteReader::overMemory(bytes, "bytes").skip(~std::uint64_t{0}));
}

TEST(ByteReader, KeepsItsPlaceWhenMoved) {
    ByteReader reader = ByteReader::overMemory("abcdef", "bytes");
    ASSERT_TRUE(reader.fill(1));
    reader.consume(1);
    ByteReader moved = std::move(reader);
    ASSERT_TRUE(moved.fill(5));
    EXPECT_EQ(std::string(moved.data(), 5), "bcdef");
    EXPECT_EQ(moved.name(), "bytes");
}

}  // namespace
}  // namespace penumbra
