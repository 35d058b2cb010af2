// RenderJob as a library: options that no command line could give.

#include "app/batch/render_job.h"

#include "scenes/readers.h"
#include "tests/expect_error.h"

namespace penumbra {
namespace {

TEST(RenderJobOptions, AreChecked) {
    const auto refused = [](const auto& change) {
        RenderOptions options;
        change(options);
        return messageOf(
            [&] {
                Warnings warnings;
                RenderJob(readSceneText("WorldBegin", "s.pbrt", "", warnings), options, warnings);
            },
            ErrorKind::Usage);
    };
    for (const int bad : {0, -1, 1 << 30}) {
        const std::string number = std::to_string(bad);
        EXPECT_EQ(refused([=](RenderOptions& o) { o.tileSize = bad; }),
                  "tileSize is " + number + ", outside the allowed range, 1 to 16384");
        EXPECT_EQ(refused([=](RenderOptions& o) { o.controls.batchSize = bad; }),
                  "batchSize is " + number + ", outside the allowed range, 1 to 4096");
        EXPECT_EQ(refused([=](RenderOptions& o) { o.controls.lanes = bad; }),
                  "lanes are " + number + "; there may be 1 or 8");
    }
    for (const int bad : {0, -1})
        EXPECT_TRUE(refused([=](RenderOptions& o) { o.replicates = bad; }).starts_with("replicates is "));
    EXPECT_TRUE(refused([](RenderOptions& o) { o.build.samplesOverride = -1; }).starts_with("samplesOverride is -1"));
    EXPECT_TRUE(refused([](RenderOptions& o) { o.build.width = -1; }).starts_with("width is -1"));
    EXPECT_TRUE(refused([](RenderOptions& o) { o.build.height = -1; }).starts_with("height is -1"));
}

}  // namespace
}  // namespace penumbra
