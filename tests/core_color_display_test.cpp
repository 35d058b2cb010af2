// The way to the screen through OpenColorIO.

#include "core/color/display.h"

#include "core/color/transfer.h"
#include "tests/expect_error.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace penumbra {
namespace {

/// $OCIO for the length of a test; null takes it away.
class Environment {
public:
    explicit Environment(const char* value) {
        if (const char* old = std::getenv("OCIO")) old_ = old;
        value ? ::setenv("OCIO", value, 1) : ::unsetenv("OCIO");
    }
    ~Environment() { old_.empty() ? ::unsetenv("OCIO") : ::setenv("OCIO", old_.c_str(), 1); }

private:
    std::string old_;
};

std::vector<float> throughView(const std::string& view, std::vector<float> rgb,
                               const ColorSpace& film = srgbColorSpace(), float exposure = 0) {
    DisplayOptions options;
    options.view = view;
    options.exposure = exposure;
    DisplayTransform(options, film).apply(rgb);
    return rgb;
}

class Display : public testing::Test {
protected:
    Environment none{nullptr};
    TemporaryFolder folder;
};

TEST_F(Display, BuiltInConfigurationHasItsViews) {
    const std::vector<DisplayList> list = listDisplays("");
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].display, "sRGB");
    EXPECT_EQ(list[0].views, (std::vector<std::string>{"Standard", "ACES", "Raw"}));
    const DisplayTransform transform({}, srgbColorSpace());
    EXPECT_EQ(transform.display(), "sRGB");
    EXPECT_EQ(transform.view(), "Standard");
    EXPECT_EQ(transform.configuration(), "built in");
}

TEST_F(Display, StandardIsTheSrgbCurve) {
    std::vector<float> ramp;
    for (int i = 0; i <= 3000; ++i)
        ramp.push_back(float(i) / 3000);
    const std::vector<float> out = throughView("", ramp);
    for (std::size_t i = 0; i < ramp.size(); ++i)
        EXPECT_NEAR(out[i], srgbFromLinear(ramp[i]), 1e-4f) << ramp[i];
}

TEST_F(Display, WhiteOfEveryFilmIsWhite) {
    for (const std::string& name : colorSpaceNames())
        for (const float v : throughView("standard", {1, 1, 1}, *findColorSpace(name)))
            EXPECT_NEAR(v, 1, 1e-4f) << name;
    const std::vector<float> red = throughView("Standard", {1, 0, 0}, *findColorSpace("rec2020"));
    EXPECT_GT(red[0], 1.2f);  // outside of sRGB, and not clamped here
    EXPECT_LT(red[1], 0);
}

TEST_F(Display, ExposureIsInStops) {
    const std::vector<float> out = throughView("Standard", {0.1f, 0.2f, 0.05f}, srgbColorSpace(), 2);
    EXPECT_NEAR(out[0], srgbFromLinear(0.4f), 1e-4f);
    EXPECT_NEAR(out[1], srgbFromLinear(0.8f), 1e-4f);
    EXPECT_NEAR(out[2], srgbFromLinear(0.2f), 1e-4f);
}

TEST_F(Display, RawShowsTheNumbers) {
    EXPECT_EQ(throughView("Raw", {0.1f, 0.5f, 3}, *findColorSpace("rec2020")), (std::vector<float>{0.1f, 0.5f, 3}));
}

TEST_F(Display, AcesRollsHighlightsOff) {
    const std::vector<float> out = throughView("ACES", {0.18f, 0.18f, 0.18f, 1, 1, 1, 100, 100, 100});
    EXPECT_NEAR(out[0], out[1], 1e-3f);
    EXPECT_NEAR(out[0], 0.356f, 2e-3f);  // 18 % grey at the 10 nits of the ACES 1.0 curve (out of 100)
    EXPECT_LT(out[3], 0.9f);
    EXPECT_GT(out[6], 0.97f);
    EXPECT_LE(out[6], 1.03f);  // its white, that of D60, is a little red on this screen
}

TEST_F(Display, NotFinitePixelsBecomeBlack) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    for (const char* view : {"Standard", "ACES"})
        for (const float v : throughView(view, {nan, infinity, -infinity}))
            EXPECT_NEAR(v, 0, 1e-3f) << view;
    EXPECT_TRUE(throughView("Standard", {}).empty());
}

TEST_F(Display, UnknownNamesListWhatThereIs) {
    DisplayOptions options;
    options.view = "Filmic";
    EXPECT_NE(
        messageOf([&] { DisplayTransform(options, srgbColorSpace()); }, ErrorKind::Usage).find("Standard, ACES, Raw"),
        std::string::npos);
    options = {};
    options.display = "P3";
    EXPECT_NE(messageOf([&] { DisplayTransform(options, srgbColorSpace()); }, ErrorKind::Usage).find("are: sRGB"),
              std::string::npos);
    options = {};
    options.inputSpace = "camera";
    EXPECT_NE(messageOf([&] { DisplayTransform(options, srgbColorSpace()); }, ErrorKind::Usage).find("ACES2065-1"),
              std::string::npos);
}

constexpr const char* kSmallConfig = R"(ocio_profile_version: 1
search_path: luts
roles:
  default: lin
  scene_linear: lin
displays:
  Projector:
    - !<View> {name: Plain, colorspace: lin}
    - !<View> {name: Half, colorspace: half}
colorspaces:
  - !<ColorSpace>
    name: lin
  - !<ColorSpace>
    name: half
    from_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
)";

TEST_F(Display, ConfigurationByPathAndByEnvironment) {
    const std::string path = folder.file("config.ocio", kSmallConfig);
    DisplayOptions options;
    options.config = path;
    options.view = "half";
    std::vector<float> rgb{0.2f, 0.4f, 0.8f};
    const DisplayTransform byPath(options, srgbColorSpace());
    byPath.apply(rgb);
    EXPECT_NEAR(rgb[0], 0.1f, 1e-6f);
    EXPECT_NEAR(rgb[2], 0.4f, 1e-6f);
    EXPECT_EQ(byPath.configuration(), path);

    const Environment environment(path.c_str());
    const DisplayTransform byEnvironment({}, srgbColorSpace());
    EXPECT_EQ(byEnvironment.configuration(), "$OCIO " + path);
    EXPECT_EQ(byEnvironment.display(), "Projector");
    EXPECT_EQ(byEnvironment.view(), "Plain");
}

TEST_F(Display, BadConfigurationsAreErrors) {
    DisplayOptions options;
    options.config = folder.path("missing.ocio");
    messageOf([&] { DisplayTransform(options, srgbColorSpace()); }, ErrorKind::MissingInput);
    options.config = folder.path("");
    messageOf([&] { DisplayTransform(options, srgbColorSpace()); }, ErrorKind::MissingInput);
    for (const char* text : {"", "hello", "ocio_profile_version: 99\n", "ocio_profile_version: 1\n",
                             "ocio_profile_version: 1\nroles:\n  scene_linear: nowhere\n", "\x76\x2f\x31\x01"}) {
        options.config = folder.file("bad.ocio", text);
        EXPECT_NE(
            messageOf([&] { DisplayTransform(options, srgbColorSpace()); }, ErrorKind::Configuration).find("bad.ocio"),
            std::string::npos);
    }
}

}  // namespace
}  // namespace penumbra
