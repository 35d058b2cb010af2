// Micro-benchmark of every registered sampler, with one lane and with eight, through the dispatch that integrators draw
// with: one number (get1) and two (get2) alone, and all that a path draws where it meets a surface (vertex). per_lane
// is the time that one lane costs. Addresses come from a small table, so that they cost a load: eight samples of a
// pixel side by side, as a render has them.
#include "samplers/registry.h"

#include <benchmark/benchmark.h>

#include <vector>

namespace penumbra {
namespace {

constexpr std::uint32_t kGroups = 1024, kSamplesPerPixel = 64, kVertices = 8;

template <class F>
std::vector<SampleAddress<F>> addresses() {
    std::vector<SampleAddress<F>> result;
    for (std::uint32_t g = 0; g < kGroups; ++g) {
        const std::uint32_t first = g * std::uint32_t(kLanes<F>);
        const UInt<F> sample = UInt<F>(first % kSamplesPerPixel) + laneIndices<F>();
        result.push_back(addressOf<F>(UInt<F>(first / kSamplesPerPixel), sample, 1, 0));
    }
    return result;
}

template <class F, class Draw>
void run(benchmark::State& state, const std::string& name, Draw draw) {
    const ParameterSet none;
    SamplerInput input{none, int(kSamplesPerPixel)};
    Sampler sampler;
    makeSampler(name, input, sampler);
    const std::vector<SampleAddress<F>> at = addresses<F>();
    std::uint32_t group = 0;
    for (auto _ : state) {
        draw(sampler.at<F>(at[group % kGroups], group % kVertices));
        ++group;
    }
    state.counters["per_lane"] = benchmark::Counter(double(state.iterations()) * kLanes<F>,
                                                    benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <class F>
void keep(F number) {
    benchmark::DoNotOptimize(number);
}

template <class F>
void registerSampler(const std::string& name) {
    const auto add = [&](const std::string& operation, auto draw) {
        const std::string lanes = kLanes<F> == 1 ? "/one_lane" : "/eight_lanes";
        benchmark::RegisterBenchmark((name + operation + lanes).c_str(),
                                     [name, draw](benchmark::State& state) { run<F>(state, name, draw); });
    };
    add("/get1", [](const Sampler::Numbers<F>& numbers) { keep(numbers.get1(Dim::Lobe)); });
    add("/get2", [](const Sampler::Numbers<F>& numbers) {
        const Vec2<F> u = numbers.get2(Dim::Direction);
        keep(u.x + u.y);
    });
    add("/vertex", [](const Sampler::Numbers<F>& numbers) {
        const Vec2<F> u = numbers.get2(Dim::LightPosition), v = numbers.get2(Dim::Direction);
        keep(numbers.get1(Dim::LightPick) + numbers.get1(Dim::Lobe) + u.x + u.y + v.x + v.y);
    });
}

}  // namespace
}  // namespace penumbra

int main(int argc, char** argv) {
    for (const std::string& name : penumbra::pluginNames(penumbra::SamplerTypes{})) {
        penumbra::registerSampler<float>(name);
        penumbra::registerSampler<penumbra::Lanes8f>(name);
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 64;
    benchmark::RunSpecifiedBenchmarks();
}
