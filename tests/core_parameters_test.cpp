// Look-ups in a ParameterSet, and what it says of parameters that nobody looked up.
#include "core/base/parameters.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

const std::vector<std::string> kFiles{"s.pbrt"};

template <class T>
Parameter make(std::string type, std::string name, std::vector<T> values, std::uint32_t line = 1) {
    Parameter p;
    p.type = std::move(type);
    p.name = std::move(name);
    p.where = {0, line, 5};
    p.values = std::move(values);
    return p;
}

ParameterSet sample() {
    ParameterSet set;
    set.add(make<float>("float", "radius", {2.5f}));
    set.add(make<std::int32_t>("integer", "count", {7}));
    set.add(make<std::uint8_t>("bool", "twosided", {1}));
    set.add(make<std::string>("string", "filename", {"a.png"}));
    set.add(make<float>("point3", "P", {1, 2, 3, 4, 5, 6}));
    set.add(make<std::int32_t>("integer", "indices", {0, 1, 2}));
    return set;
}

std::vector<std::string> unusedOf(const ParameterSet& set) {
    Warnings warnings;
    set.warnUnused(kFiles, "shape 'sphere'", warnings);
    return warnings.all();
}

TEST(CoreParameters, LookUpsFindTheirTypeOrSayOtherwise) {
    const ParameterSet set = sample();
    EXPECT_EQ(set.number("radius", 1), 2.5f);
    EXPECT_EQ(set.number("height", 4), 4.f);
    EXPECT_EQ(set.integer("count", 1), 7);
    EXPECT_EQ(set.integer("radius", 3), 3) << "a float is not an integer";
    EXPECT_TRUE(set.boolean("twosided", false));
    EXPECT_TRUE(set.boolean("absent", true));
    EXPECT_EQ(set.text("filename", ""), "a.png");
    EXPECT_EQ(set.text("absent", "x"), "x");
    EXPECT_EQ(set.numbers("point3", "P"), (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_TRUE(set.numbers("vector3", "P").empty());
    EXPECT_EQ(set.integers("indices"), (std::vector<std::int32_t>{0, 1, 2}));
    EXPECT_TRUE(set.integers("absent").empty());
    EXPECT_EQ(set.findAny("P")->type, "point3");
    EXPECT_EQ(set.findAny("Q"), nullptr);
}

TEST(CoreParameters, TheLastOfANameWins) {
    ParameterSet set = sample();
    set.add(make<float>("float", "radius", {9}));
    EXPECT_EQ(set.number("radius", 1), 9.f);
    EXPECT_EQ(unusedOf(set).size(), 5u) << "the first radius is shadowed, not unused";
}

TEST(CoreParameters, SeveralValuesWhereOneIsMeant) {
    ParameterSet set;
    set.add(make<float>("float", "radius", {1, 2}, 8));
    set.add(make<std::string>("string", "empty", {}, 9));
    try {
        set.number("radius", 1);
        FAIL() << "no error";
    } catch (const ErrorAt& e) {
        EXPECT_STREQ(e.placed(kFiles).what(), "s.pbrt:8:5: 'float radius' must be one value, but 2 are given");
    }
    EXPECT_THROW(set.text("empty", ""), ErrorAt);
}

TEST(CoreParameters, UnusedParametersAreReportedWithTheNearestNameAskedFor) {
    ParameterSet set;
    set.add(make<float>("float", "radios", {1}, 3));
    set.add(make<std::int32_t>("integer", "zmin", {1}, 4));
    Parameter inherited = make<float>("float", "alpha", {1}, 5);
    inherited.inherited = true;
    set.add(inherited);
    set.number("radius", 1);
    set.number("zmin", 1);
    EXPECT_EQ(unusedOf(set),
              (std::vector<std::string>{
                  "s.pbrt:3:5: parameter 'float radios' of shape 'sphere' is unknown; did you mean 'radius'?",
                  "s.pbrt:4:5: parameter 'integer zmin' of shape 'sphere' is ignored: it has to be of type float"}));
    set.markAllUsed();
    EXPECT_TRUE(unusedOf(set).empty());
}

/// What the error says that f() ends with, with its exit code before.
template <class Function>
std::string usageErrorOf(Function&& f) {
    try {
        f();
    } catch (const ErrorAt& e) {
        return std::to_string(int(e.kind())) + " " + e.placed(kFiles).what();
    }
    return "";
}

TEST(CoreParameters, OverridesTakeTheTypeThatIsAskedFor) {
    const SourcePosition where{0, 3, 5};
    ParameterSet set;
    set.add(make<float>("float", "iso", {100}, 2));
    for (const auto& [name, text] : {std::pair{"iso", "2e2"}, {"count", "-7"}, {"on", "true"}, {"window", "0,.5 0,1"},
                                     {"name", "a, b"}, {"bad", "2x"}, {"whole", "1.5"}, {"list", "1,"}, {"far", "inf"}})
        set.override(name, text, where);
    EXPECT_EQ(set.number("iso", 0), 200) << "in the place of the file's";
    EXPECT_EQ(set.integer("count", 0), -7);
    EXPECT_TRUE(set.boolean("on", false));
    EXPECT_EQ(set.numbers("float", "window"), (std::vector<float>{0, 0.5f, 0, 1}));
    EXPECT_EQ(set.text("name", ""), "a, b");
    EXPECT_EQ(usageErrorOf([&] { set.number("bad", 0); }), "64 s.pbrt:3:5: '2x' is not a number");
    EXPECT_EQ(usageErrorOf([&] { set.integer("whole", 0); }), "64 s.pbrt:3:5: '1.5' is not a whole number");
    EXPECT_EQ(usageErrorOf([&] { set.numbers("float", "list"); }), "64 s.pbrt:3:5: '' is not a number");
    EXPECT_EQ(usageErrorOf([&] { set.number("far", 0); }), "64 s.pbrt:3:5: 'inf' is not a number");
}

TEST(CoreParameters, AnOverrideThatNothingAsksForIsAnError) {
    ParameterSet set;
    set.override("isoo", "200", {0, 3, 5});
    set.number("iso", 100);
    EXPECT_EQ(usageErrorOf([&] { unusedOf(set); }),
              "64 s.pbrt:3:5: shape 'sphere' has no parameter 'isoo'; did you mean 'iso'?");
}

TEST(CoreParameters, UnusedIsAnErrorWhereStrict) {
    ParameterSet set;
    set.add(make<float>("float", "radios", {1}));
    Warnings strict(true);
    EXPECT_THROW(set.warnUnused(kFiles, "shape 'sphere'", strict), Error);
}

}  // namespace
}  // namespace penumbra
