// Tensor files: what they hold is found, what they claim and do not hold is refused.
#include "core/base/error.h"
#include "core/base/tensor_file.h"
#include "core/math/hash.h"
#include "tests/measured_file.h"

#include <gtest/gtest.h>

#include <limits>

namespace penumbra::test {
namespace {

std::vector<char> smallFile() {
    TensorFileMaker maker;
    maker.text("description", "two arrays");
    maker.floats("a", {2, 3}, {1, 2, 3, 4, 5, 6});
    maker.floats("b", {1}, {7});
    return maker.bytes();
}

std::string messageOf(const std::function<void()>& f) {
    try {
        f();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::BadData);
        return error.what();
    }
    return "";
}

TEST(TensorFile, HoldsItsFields) {
    const TensorFile file(smallFile());
    EXPECT_EQ(file.fields().size(), 3u);
    EXPECT_EQ(file.floats("a", 2), (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(file.shape("a"), (std::vector<std::size_t>{2, 3}));
    EXPECT_EQ(file.floats("b", 1), (std::vector<float>{7}));
}

TEST(TensorFile, SaysWhatIsWrong) {
    const TensorFile file(smallFile());
    EXPECT_NE(messageOf([&] { file.floats("c", 1); }).find("'c' is missing"), std::string::npos);
    EXPECT_NE(messageOf([&] { file.floats("a", 3); }).find("2 dimensions in place of 3"), std::string::npos);
    EXPECT_NE(messageOf([&] { file.floats("description", 1); }).find("does not hold floats"), std::string::npos);
    EXPECT_NE(messageOf([] { TensorFile(std::vector<char>{'x'}); }).find("does not begin as one"), std::string::npos);
    TensorFileMaker nan;
    nan.floats("a", {1}, {std::numeric_limits<float>::quiet_NaN()});
    EXPECT_NE(messageOf([&] { TensorFile(nan.bytes()).floats("a", 1); }).find("not finite"), std::string::npos);
    TensorFileMaker huge;
    huge.floats("a", {1ull << 40, 1ull << 40}, {1});
    EXPECT_NE(messageOf([&] { TensorFile(huge.bytes()); }).find("does not fit"), std::string::npos);
    TensorFileMaker empty;
    empty.floats("a", {0}, {});
    EXPECT_NE(messageOf([&] { TensorFile(empty.bytes()); }).find("is empty"), std::string::npos);
}

/// Cut anywhere: refused, but where only elements that nobody claims are missing.
TEST(TensorFile, RefusesWhatIsCutShort) {
    const std::vector<char> whole = smallFile();
    for (std::size_t n = 0; n < whole.size(); ++n)
        EXPECT_THROW(TensorFile(std::vector<char>(whole.begin(), whole.begin() + std::ptrdiff_t(n))), Error) << n;
}

/// Bytes changed at random: an Error or a file, whose fields can then be read.
TEST(TensorFile, SurvivesMutants) {
    const std::vector<char> whole = smallFile();
    for (std::uint32_t i = 0; i < 20000; ++i) {
        std::vector<char> mutant = whole;
        for (std::uint32_t k = 0; k < 1 + i % 3; ++k)
            mutant[mixBits(3 * i + k) % mutant.size()] = char(mixBits(mixBits(i) + k));
        try {
            const TensorFile file(std::move(mutant));
            for (const auto& [name, field] : file.fields())
                if (field.type == TensorFile::Field::Type::Float32) {
                    EXPECT_EQ(file.floats(name, field.shape.size()).size(), field.count);
                }
        } catch (const Error&) {
        }
    }
}

}  // namespace
}  // namespace penumbra::test
