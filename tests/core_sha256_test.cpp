// SHA-256 against the examples of FIPS 180-4.

#include "core/base/sha256.h"

#include "core/base/error.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace penumbra {
namespace {

constexpr char kAbc[] = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
constexpr char kEmpty[] = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
constexpr char kMillionTimesA[] = "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";

TEST(Sha256, GivesThePublishedDigests) {
    EXPECT_EQ(sha256OfBytes("abc"), kAbc);
    EXPECT_EQ(sha256OfBytes(""), kEmpty);
}

TEST(Sha256, DoesNotDependOnHowBytesAreCut) {
    Sha256 digest;
    std::size_t left = 1000000;
    for (std::size_t i = 0; left > 0; ++i) {
        const std::size_t size = std::min(left, i % 7 * 100 + i % 64);  // 0 among them
        digest.add(std::string(size, 'a'));
        left -= size;
    }
    EXPECT_EQ(digest.hex(), kMillionTimesA);
}

TEST(Sha256, ReadsFilesAndNamesThoseItCannotRead) {
    const TemporaryFolder folder;
    EXPECT_EQ(sha256OfFile(folder.file("abc", "abc")), kAbc);
    EXPECT_EQ(sha256OfFile(folder.file("million", std::string(1000000, 'a'))), kMillionTimesA);
    try {
        sha256OfFile(folder.path("nothing"));
        ADD_FAILURE() << "no error";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::MissingInput);
        EXPECT_NE(std::string(e.what()).find("nothing"), std::string::npos);
    }
}

}  // namespace
}  // namespace penumbra
