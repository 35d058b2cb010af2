// penumbra convert: colours, layers and formats.

#include "core/image/image_io.h"
#include "tests/run_program.h"

#include <gtest/gtest.h>

#include <cmath>

namespace penumbra {
namespace {

class ConvertCommand : public testing::Test {
protected:
    const TemporaryFolder folder;
    const std::string exr = folder.path("a.exr");

    /// Four pixels: black, a middle grey, a colour, and one beyond white; a layer SE and a channel of counts.
    void SetUp() override {
        const float planes[6][4] = {{0, 0.18f, 0.5f, 4}, {0, 0.18f, 0.25f, 4}, {0, 0.18f, 0.125f, 4},
                                    {1, 0, 0, 0},        {0, 1, 0, 0},         {0, 0, 1, 0}};
        ExrHeader header;
        header.dataWindow = header.displayWindow = {0, 0, 4, 1};
        header.channels = {{"R"}, {"G"}, {"B"}, {"SE.R"}, {"SE.G"}, {"SE.B"}, {"samples", ExrChannel::Type::Uint}};
        header.colorSpace = &srgbColorSpace();
        writeExr(exr, header, [&](const ExrBlock& block) {
            for (std::size_t c = 0; c < 6; ++c)
                std::copy(planes[c], planes[c] + 4, block.floats[c].begin());
            for (std::uint32_t x = 0; x < 4; ++x)
                block.uints[6][x] = x;
        });
    }

    Image convert(const std::string& name, std::vector<std::string> options = {}) const {
        std::vector<std::string> arguments{"convert", exr, folder.path(name), "--quiet"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProgramRun run = runProgram(arguments);
        EXPECT_EQ(run.code, 0) << run.err;
        EXPECT_EQ(run.err, "");
        return readImage(folder.path(name));
    }
    /// Reading a PNG decodes the sRGB curve, which is all that the default view applies.
    static void expectPixel(const Image& image, int x, Rgb expected, float tolerance) {
        const Rgb c = image.rgb(x, 0);
        EXPECT_NEAR(c.r, expected.r, tolerance);
        EXPECT_NEAR(c.g, expected.g, tolerance);
        EXPECT_NEAR(c.b, expected.b, tolerance);
    }
};

TEST_F(ConvertCommand, TheDefaultViewIsTheSrgbCurve) {
    const Image image = convert("a.png", {"--bits", "16"});
    expectPixel(image, 0, {0, 0, 0}, 1e-4f);
    expectPixel(image, 1, {0.18f, 0.18f, 0.18f}, 1e-4f);
    expectPixel(image, 2, {0.5f, 0.25f, 0.125f}, 1e-4f);
    expectPixel(image, 3, {1, 1, 1}, 1e-4f);
}

TEST_F(ConvertCommand, ExposureCountsInStopsForScreensAndLinearFilesAlike) {
    expectPixel(convert("a.png", {"--exposure", "-2", "--bits", "16"}), 3, {1, 1, 1}, 1e-4f);
    expectPixel(convert("b.png", {"--exposure", "-3", "--bits", "16"}), 3, {0.5f, 0.5f, 0.5f}, 1e-4f);
    expectPixel(convert("a.pfm", {"--exposure", "1"}), 2, {1, 0.5f, 0.25f}, 0);
    expectPixel(convert("a.tif", {"--exposure", "1", "--bits", "32"}), 2, {1, 0.5f, 0.25f}, 0);
}

TEST_F(ConvertCommand, ShowsLayersAndSingleChannels) {
    const Image error = convert("a.pfm", {"--layer", "SE"});
    expectPixel(error, 0, {1, 0, 0}, 0);
    expectPixel(error, 2, {0, 0, 1}, 0);
    expectPixel(convert("b.pfm", {"--layer", "samples"}), 3, {3, 3, 3}, 0);
    const ProgramRun wrong = runProgram({"convert", exr, folder.path("c.pfm"), "--layer", "sample"});
    EXPECT_EQ(wrong.code, 64);
    EXPECT_NE(wrong.err.find("did you mean 'samples'?"), std::string::npos) << wrong.err;
}

TEST_F(ConvertCommand, ViewsOfTheBuiltInConfiguration) {
    const ProgramRun views = runProgram({"convert", "--list-views"});
    EXPECT_EQ(views.code, 0);
    EXPECT_EQ(views.out, "sRGB: Standard, ACES, Raw\n");
    expectPixel(
        convert("a.png", {"--view", "Raw", "--bits", "16"}), 2,
        [] {
            const TransferFunction curve = TransferFunction::srgb();
            return Rgb{curve.decode(0.5f), curve.decode(0.25f), curve.decode(0.125f)};
        }(),
        1e-4f);
    EXPECT_EQ(runProgram({"convert", exr, folder.path("b.png"), "--view", "Nope"}).code, 64);
    EXPECT_EQ(runProgram({"convert", exr, folder.path("b.png"), "--ocio", folder.path("no.ocio")}).code, 66);
}

TEST_F(ConvertCommand, NeverWritesOverItsInputAndNoExr) {
    const std::string before = readBytes(exr);
    EXPECT_EQ(runProgram({"convert", exr, exr}).code, 64);
    convert("a.png");
    EXPECT_EQ(runProgram({"convert", folder.path("a.png"), folder.path("a.png")}).code, 73);
    EXPECT_EQ(readBytes(exr), before);
}

}  // namespace
}  // namespace penumbra
