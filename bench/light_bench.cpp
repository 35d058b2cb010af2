// Sampling and evaluating each type of light, with one lane and with eight, and a group of mixed types. Time is per
// group; items are lanes. `--benchmark_filter=rectangle` and the like select.
#include "lights/light_sampler.h"

#include <benchmark/benchmark.h>

#include <random>

namespace penumbra {
namespace {

constexpr std::size_t kGroups = 256;
const Spectrum<float> kRadiance = {2.f, 1.f, 0.5f};

/// Points below the lights and sample numbers, the same for one lane and for eight.
template <class F>
struct Inputs {
    std::vector<Vec3<F>> from;
    std::vector<Vec2<F>> u;
    Inputs() : from(kGroups), u(kGroups) {
        std::mt19937 generator(1);
        const auto next = [&] { return float(generator() >> 8) * 0x1p-24f; };
        for (std::size_t g = 0; g < kGroups; ++g) {
            for (int i = 0; i < kLanes<F>; ++i) {
                setLane(from[g].x, i, next() * 4.f - 2.f);
                setLane(from[g].y, i, next() * 4.f - 2.f);
                setLane(from[g].z, i, next() * 0.9f);
                setLane(u[g].x, i, next());
                setLane(u[g].y, i, next());
            }
        }
    }
};

template <class F>
void sample(benchmark::State& state, const LightTable& lights, const UInt<F>& id) {
    const Inputs<F> inputs;
    std::size_t g = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(sampleLight<F>(lights, id, inputs.from[g], inputs.u[g]));
        g = (g + 1) % kGroups;
    }
    state.SetItemsProcessed(state.iterations() * kLanes<F>);
}

template <class F>
void evaluate(benchmark::State& state, const LightTable& lights, const UInt<F>& id) {
    const Inputs<F> inputs;
    std::vector<LightHit<F>> hits;
    for (std::size_t g = 0; g < kGroups; ++g) {
        const LightSample<F> s = sampleLight<F>(lights, id, inputs.from[g], inputs.u[g]);
        hits.push_back({inputs.from[g], inputs.from[g] + s.wi * min(s.distance, F(1e6f)), s.wi});
    }
    std::size_t g = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(evaluateLight<F>(lights, id, hits[g]));
        g = (g + 1) % kGroups;
    }
    state.SetItemsProcessed(state.iterations() * kLanes<F>);
}

struct Named {
    std::string name;
    std::uint32_t id;
};

std::vector<Named> fill(LightTable& lights) {
    const Vec3<float> corner = {-0.5f, -0.5f, 1.f}, x = {1, 0, 0}, y = {0, 1, 0}, down = {0, 0, -1};
    std::vector<Named> names;
    const auto add = [&](const char* name, const auto& light) { names.push_back({name, lights.add(light)}); };
    add("rectangle", RectangleLight::make(corner, x, y, down, kRadiance, 0));
    add("triangle", TriangleLight::make(corner, corner + x, corner + y, down, kRadiance, 0));
    SphereLight sphere;
    SphereLight::make(translation(0, 0, 2), 0.5, -1, 1, 7, kRadiance, 0, sphere);
    add("sphere", sphere);
    add("disk", DiskLight::make({0, 0, 1}, x, y, 0.f, kTwoPi, down, kRadiance, 0));
    add("point", PointLight{{0, 0, 2}, kRadiance});
    add("distant", DistantLight{{0, 0, 1}, kRadiance});
    add("infinite constant", ConstantInfiniteLight{kRadiance});
    std::vector<float> rgb(3 * 1024 * 1024);
    std::mt19937 generator(2);
    for (float& v : rgb)
        v = float(generator() >> 8) * 0x1p-24f;
    add("infinite image", ImageInfiniteLight::make(SkyMap::EqualArea, rgb, 1024, 1024, kRadiance, Matrix4{}, lights.tables));
    return names;
}

void registerBenchmarks(const LightTable& lights, const std::vector<Named>& names) {
    for (const Named& n : names) {
        const auto add = [&](const char* what, auto function, auto id) {
            benchmark::RegisterBenchmark((n.name + what).c_str(),
                                         [&lights, function, id](benchmark::State& s) { function(s, lights, id); });
        };
        add("/sample/1", sample<float>, n.id);
        add("/sample/8", sample<Lanes8f>, Lanes8u(n.id));
        add("/evaluate/1", evaluate<float>, n.id);
        add("/evaluate/8", evaluate<Lanes8f>, Lanes8u(n.id));
    }
    benchmark::RegisterBenchmark("all types in one group/sample/8", [&lights](benchmark::State& s) {
        sample<Lanes8f>(s, lights, laneIndices<Lanes8f>());
    });
}

}  // namespace
}  // namespace penumbra

int main(int argc, char** argv) {
    penumbra::LightTable lights;
    penumbra::registerBenchmarks(lights, penumbra::fill(lights));
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 64;
    benchmark::RunSpecifiedBenchmarks();
}
