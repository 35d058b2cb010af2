// The scenes that come with Penumbra: each reads without a warning, renders without an invalid sample, and is
// described.
#include "app/batch/render_job.h"
#include "core/statistics/hypothesis_tests.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

const fs::path kGallery = fs::path(PENUMBRA_SOURCE_DIR) / "scenes/gallery";

/// Names without the extension, sorted.
std::vector<std::string> galleryScenes() {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(kGallery))
        if (entry.path().extension() == ".pbrt") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

RenderJob strictJob(const std::string& name, int width, int height, int samples) {
    RenderOptions options;
    options.scene = (kGallery / (name + ".pbrt")).string();
    options.build.width = width;
    options.build.height = height;
    options.build.samplesOverride = samples;
    Warnings warnings(true);
    return RenderJob(options, warnings);
}

class Gallery : public testing::TestWithParam<std::string> {};

TEST_P(Gallery, RendersWithoutWarningOrInvalidSample) {
    RenderJob job = strictJob(GetParam(), 32, 18, 4);
    ASSERT_TRUE(job.run());
    EXPECT_EQ(job.counts().paths, 32u * 18u * 4u);
    EXPECT_EQ(job.counts().invalid, 0u);
    double sum = 0;
    for (std::size_t i = 0; i < job.film().pixelCount(); ++i)
        for (const double channel : job.film().estimate(i).mean)
            sum += channel;
    EXPECT_GT(sum, 0);
}

TEST_P(Gallery, IsDescribedWithItsPicture) {
    EXPECT_NE(readBytes((kGallery / "README.md").string()).find("`" + GetParam() + ".pbrt`"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Gallery, testing::ValuesIn(galleryScenes()),
                         [](const testing::TestParamInfo<std::string>& info) { return info.param; });

TEST(GalleryFolder, HoldsADozenScenesInAMegabyte) {
    EXPECT_GE(galleryScenes().size(), 12u);
    std::uintmax_t bytes = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kGallery))
        if (entry.is_regular_file()) bytes += entry.file_size();
    EXPECT_LT(bytes, 1'000'000u);
}

// Whatever loses no light is invisible in a closed furnace: the mean of every block of pixels is 1/2. Pixels are
// independent of one another. Family-wise false alarm 1e-6 (Bonferroni), at a fixed seed.
TEST(GalleryFurnace, IsFlat) {
    constexpr int kWidth = 64, kHeight = 36, kBlock = 4;
    constexpr double kFalseAlarm = 1e-6;
    RenderJob job = strictJob("furnace", kWidth, kHeight, 64);
    ASSERT_TRUE(job.run());
    constexpr int kBlocks = kWidth / kBlock * (kHeight / kBlock);
    for (int by = 0; by < kHeight; by += kBlock)
        for (int bx = 0; bx < kWidth; bx += kBlock) {
            std::vector<double> values;
            for (int y = by; y < by + kBlock; ++y)
                for (int x = bx; x < bx + kBlock; ++x)
                    values.push_back(job.film().estimate(std::size_t(y * kWidth + x)).mean[1]);
            const TestResult result = studentTest(momentsOf(values), 0.5);
            EXPECT_GT(result.pValue, kFalseAlarm / kBlocks)
                << "block at " << bx << "," << by << ", t = " << result.statistic;
        }
}

}  // namespace
}  // namespace penumbra
