// The ray roof's record: it replays the rays that were traced, all of them and nothing else, within its memory.

#include "bench/lab/ray_roof.h"
#include "bench/lab/report.h"
#include "scenes/readers.h"
#include "tests/expect_error.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace penumbra {
namespace {

/// A sphere and a small light over a floor: rays meet, miss and are occluded.
constexpr char kScene[] = R"(
LookAt 0 1 -5  0 0.5 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 40 "integer yresolution" 24
Sampler "independent" "integer pixelsamples" 4
Integrator "path" "integer maxdepth" 4
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [6 5 4]
  Translate 0 3 0
  Shape "sphere" "float radius" 0.3
AttributeEnd
Material "diffuse" "rgb reflectance" [0.6 0.5 0.3]
Shape "sphere" "float radius" 1
Translate 0 -1 0
Rotate 90 1 0 0
Shape "disk" "float radius" 4
)";

RenderJob jobOf(const RenderOptions& options = {}) {
    Warnings warnings;
    return RenderJob(readSceneText(kScene, "test.pbrt", ".", warnings), options, warnings);
}

/// Eight rays beside each other along z, from z = -5; lane k has x = k - 3.5.
RayPacket parallelRays() {
    RayPacket p{};
    for (int k = 0; k < kPacketWidth; ++k) {
        p.originX[k] = float(k) - 3.5f;
        p.originZ[k] = -5;
        p.directionZ[k] = 1;
        p.far[k] = kInfinity;
        p.mask[k] = 0xFFFFFFFFu;
    }
    return p;
}

TEST(LabRayRecord, FindsTheHitsOfLiveLanesAlone) {
    const RenderJob job = jobOf();
    RayStore store(RayStore::kBlockBytes);
    RayRecord record(store);
    RayHitPacket rays{parallelRays(), {}};
    record.nearest(rays, 0xFFu, Coherence::Coherent);           // the sphere is met by x = -0.5 and 0.5: lanes 3 and 4
    record.nearest(rays, 0b0000'1111u, Coherence::Incoherent);  // lane 3
    RayPacket shadows = parallelRays();
    shadows.far[3] = 3;             // ends before the sphere
    record.shadow(shadows, 0xFFu);  // lane 4
    record.shadow(shadows, 0b0000'1111u);
    for (const ReplayMode mode : {ReplayMode::Packets, ReplayMode::Singly})
        for (int repeat = 0; repeat < 2; ++repeat) {  // a replay leaves the record as it was
            const ReplayCounts counts = record.replay(job.scene().accelerator, mode);
            EXPECT_EQ(counts.packets, 4u);
            EXPECT_EQ(counts.rays, 12u);
            EXPECT_EQ(counts.hits, 3u);
            EXPECT_EQ(counts.shadowRays, 12u);
            EXPECT_EQ(counts.occluded, 1u);
        }
}

TEST(LabRayRecord, SaysWhereTheMemoryWasTooSmall) {
    constexpr std::uint64_t kHeld = 2 * std::uint64_t(RayStore::Block::kPackets);
    const RenderJob job = jobOf();
    RayStore store(2 * RayStore::kBlockBytes + RayStore::kBlockBytes / 2);
    RayRecord record(store);
    for (std::uint64_t i = 0; i < kHeld; ++i)
        record.shadow(parallelRays(), 1);
    EXPECT_TRUE(record.isComplete());
    record.shadow(parallelRays(), 1);
    EXPECT_FALSE(record.isComplete());
    EXPECT_TRUE(store.isExhausted());
    EXPECT_EQ(record.replay(job.scene().accelerator, ReplayMode::Packets).shadowRays, kHeld);
}

TEST(LabRayRoof, TracesWhatTheRenderTraces) {
    RenderJob job = jobOf();
    const RayRoof roof = measureRayRoof(job, {.memoryBytes = std::size_t(16) << 20, .rounds = 2});
    EXPECT_EQ(roof.tiles, 6u);
    EXPECT_EQ(roof.tilesOfPicture, 6u);
    EXPECT_EQ(roof.samples, 40u * 24u * 4u);
    job.run();
    EXPECT_EQ(roof.rays.rays, job.counts().rays);
    EXPECT_EQ(roof.rays.hits, job.counts().liveLanes);
    EXPECT_EQ(roof.rays.shadowRays, job.counts().shadowRays);
    EXPECT_GT(roof.rays.occluded, 0u);
    EXPECT_LT(roof.rays.occluded, roof.rays.shadowRays);
    for (const Spread& s : {roof.render, roof.packets, roof.singly, roof.fraction}) {
        EXPECT_GT(s.min, 0);
        EXPECT_LE(s.min, s.median);
        EXPECT_LE(s.median, s.max);
    }
    EXPECT_EQ(roof.packetsAreRoof, roof.packets.median >= roof.singly.median);
}

TEST(LabRayRoof, MeasuresTheTilesThatFit) {
    RenderOptions options;
    options.build.samplesOverride = 64;
    const RenderJob job = jobOf(options);
    const RayRoof roof = measureRayRoof(job, {.memoryBytes = std::size_t(4) << 20, .rounds = 1});
    EXPECT_GT(roof.tiles, 0u);
    EXPECT_LT(roof.tiles, 6u);
    EXPECT_EQ(roof.tilesOfPicture, 6u);
    const auto withOneBlock = [&] { measureRayRoof(job, {.memoryBytes = RayStore::kBlockBytes, .rounds = 1}); };
    EXPECT_NE(messageOf(withOneBlock, ErrorKind::Usage).find("do not hold the rays of one tile"), std::string::npos);
}

TEST(LabReport, OfTheRayRoofKeepsItsSchema) {
    const RenderJob job = jobOf();
    const RayRoof roof = measureRayRoof(job, {.memoryBytes = std::size_t(16) << 20, .rounds = 1});
    const auto json = nlohmann::json::parse(rayRoofJson(roof, job));
    EXPECT_EQ(json.at("schema"), 1);
    EXPECT_EQ(json.at("benchmark"), "ray_roof");
    EXPECT_EQ(json.at("recipe").at("sampler"), "independent");
    EXPECT_EQ(json.at("samples"), 40 * 24 * 4);
    EXPECT_EQ(json.at("nearest_rays").at("hit"), roof.rays.hits);
    EXPECT_EQ(json.at("shadow_rays").at("occluded"), roof.rays.occluded);
    EXPECT_EQ(json.at("fraction_of_roof").at("median"), roof.fraction.median);
    for (const char* who : {"render", "packets", "singly"})
        for (const char* what : {"min", "median", "max"})
            EXPECT_TRUE(json.at("samples_per_second").at(who).at(what).is_number()) << who << ' ' << what;
}

}  // namespace
}  // namespace penumbra
