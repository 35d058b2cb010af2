// Places, quotes and suggestions in messages; warnings that are said once.
#include "core/base/error.h"

#include "core/base/warnings.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

const std::vector<std::string> kFiles{"a.pbrt", "odd\n.pbrt"};
const std::vector<std::string> kMaterials{"diffuse", "conductor", "dielectric", "interface", "coateddiffuse"};

TEST(CoreError, FormatsPlaces) {
    EXPECT_EQ(formatPosition(kFiles, {0, 3, 7}), "a.pbrt:3:7");
    EXPECT_EQ(formatPosition(kFiles, {0, 0, 0}), "a.pbrt");
    EXPECT_EQ(formatPosition(kFiles, {1, 1, 1}), "odd\\x0a.pbrt:1:1");
    EXPECT_EQ(formatPosition(kFiles, {9, 1, 2}), "(unknown file):1:2");
}

TEST(CoreError, ErrorAtTakesItsPlaceLater) {
    const ErrorAt at({0, 2, 5}, "the message", ErrorKind::MissingInput);
    EXPECT_STREQ(at.what(), "the message");
    const Error placed = at.placed(kFiles);
    EXPECT_STREQ(placed.what(), "a.pbrt:2:5: the message");
    EXPECT_EQ(placed.kind(), ErrorKind::MissingInput);
}

TEST(CoreError, QuotesAreShortAndPrintable) {
    EXPECT_EQ(quote("plain"), "'plain'");
    EXPECT_EQ(quote(std::string_view("\x1b[31m\0", 6)), "'\\x1b[31m\\x00'");
    EXPECT_EQ(quote("abcdef", 4), "'abcd...'");
    EXPECT_EQ(quote("abcdef", 6), "'abcdef'");
    EXPECT_EQ(quote("ab\xc3\xa9z", 3), "'ab...'") << "a character of two bytes is not cut in half";
    EXPECT_EQ(quote(std::string(100000, 'x')).size(), 65u);
}

TEST(CoreError, NearestNames) {
    struct Case {
        std::string name;
        std::vector<std::string> expected;
    };
    const std::vector<Case> cases{
        {"difuse", {"diffuse"}},
        {"Diffuse", {"diffuse"}},
        {"idffuse", {"diffuse"}},
        {"dielectrc", {"dielectric"}},
        {"coatedconductor", {}},
        {"glass", {}},
        {"", {}},
        {std::string(1000000, 'd'), {}},
    };
    for (const Case& c : cases)
        EXPECT_EQ(nearestNames(c.name, kMaterials), c.expected) << quote(c.name);
}

TEST(CoreError, NearestNamesAreOrderedAndLimited) {
    const std::vector<std::string> known{"radiux", "radius", "radios", "radius"};
    EXPECT_EQ(nearestNames("radius", known), (std::vector<std::string>{"radius", "radiux"}));
    EXPECT_EQ(nearestNames("radius", known, 9), (std::vector<std::string>{"radius", "radiux", "radios"}));
}

TEST(CoreError, Suggestions) {
    EXPECT_EQ(suggestion("difuse", kMaterials), "; did you mean 'diffuse'?");
    EXPECT_EQ(suggestion("bat", std::vector<std::string>{"cat", "bar"}), "; did you mean 'cat' or 'bar'?");
    EXPECT_EQ(suggestion("glass", std::vector<std::string>{"a", "b"}), "; known: a, b");
    EXPECT_EQ(suggestion("glass", {}), "");
    const std::string many = suggestion("glass", std::vector<std::string>(1000, "n"));
    EXPECT_TRUE(many.ends_with("n, n, ...")) << many;
    EXPECT_LT(many.size(), 200u);
}

TEST(CoreWarnings, EqualTextsAreKeptOnceAndTheirNumberIsLimited) {
    Warnings warnings;
    warnings.add("one");
    warnings.add("two");
    warnings.add("one");
    EXPECT_EQ(warnings.all(), (std::vector<std::string>{"one", "two"}));
    for (std::size_t i = 0; i < 2 * Warnings::kMost; ++i)
        warnings.add(std::to_string(i));
    EXPECT_EQ(warnings.all().size(), Warnings::kMost + 1);
    EXPECT_NE(warnings.all().back().find("more warnings"), std::string::npos);
}

TEST(CoreWarnings, StrictMakesThemErrors) {
    Warnings warnings(true);
    try {
        warnings.add("a.pbrt:1:2: odd");
        FAIL() << "no error";
    } catch (const Error& e) {
        EXPECT_STREQ(e.what(), "a.pbrt:1:2: odd");
        EXPECT_EQ(e.kind(), ErrorKind::BadData);
    }
}

}  // namespace
}  // namespace penumbra
