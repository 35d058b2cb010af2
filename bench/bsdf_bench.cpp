// Micro-benchmark of every registered material: building its closure, evaluating it, sampling it, with one lane and
// with eight. Reported per lane: time a lane. Directions and random numbers come from small tables, so that they cost a
// load.
#include "core/math/hash.h"
#include "core/math/warps.h"
#include "materials/registry.h"

#include <benchmark/benchmark.h>

#include <array>

namespace penumbra {
namespace {

constexpr std::uint32_t kInputs = 1024;  // groups of eight

/// One material with rough default-like parameters.
class BenchInput final : public MaterialInput {
public:
    BenchInput(float roughness, MaterialTables& tables) : roughness_(roughness), tables_(tables) {}
    SpectrumInput albedo(std::string_view, Rgb c) override { return {{c.r, c.g, c.b}, kNoTexture}; }
    SpectrumInput coefficient(std::string_view, Rgb c) override { return {{c.r, c.g, c.b}, kNoTexture}; }
    ScalarInput scalar(std::string_view name, float otherwise) override {
        return {name == "roughness" ? roughness_ : otherwise, kNoTexture};
    }
    ScalarInput scalar(std::string_view, const ScalarInput& otherwise) override { return otherwise; }
    float dielectricIndex(std::string_view, float otherwise) override { return otherwise; }
    ConductorIndex conductorIndex(std::string_view, std::string_view) override {
        return {{0.1684f, 0.9765f, 1.2113f}, {3.6390f, 2.6211f, 2.3663f}};
    }
    std::vector<char> file(std::string_view name, std::uint64_t) override { fail(std::string(name) + ": no file"); }
    const ChannelWeights& channelWeights() const override { return penumbra::channelWeights(srgbColorSpace()); }
    const ParameterSet& parameters() const override { return parameters_; }
    void warn(const std::string&) override {}
    [[noreturn]] void fail(const std::string& text) override { throw Error(ErrorKind::BadData, text); }
    MaterialTables& tables() override { return tables_; }

private:
    float roughness_;
    MaterialTables& tables_;
    ParameterSet parameters_;
};

/// Numbers in [0, 1) and directions about the normal, kInputs groups of each.
struct Inputs {
    std::vector<float> numbers = std::vector<float>(std::size_t(kInputs) * 8 * 3);
    std::vector<float> x = std::vector<float>(std::size_t(kInputs) * 8), y = x, z = x;
    Inputs() {
        for (std::uint32_t i = 0; i < numbers.size(); ++i)
            numbers[i] = unitFloat<float>(mixBits(i + 1));
        for (std::uint32_t i = 0; i < x.size(); ++i) {
            const Vec3<float> w = cosineHemisphere(Vec2<float>{numbers[3 * i], numbers[3 * i + 1]});
            x[i] = w.x, y[i] = w.y, z[i] = w.z;
        }
    }
    template <class F>
    Vec3<F> direction(std::uint32_t group) const {
        const std::size_t at = std::size_t(group % kInputs) * kLanes<F>;
        return {load<F>(&x[at]), load<F>(&y[at]), load<F>(&z[at])};
    }
    template <class F>
    F number(std::uint32_t group, std::uint32_t dimension) const {
        return load<F>(&numbers[(std::size_t(dimension) * kInputs + group % kInputs) * kLanes<F>]);
    }
};

template <class F>
void keep(const Spectrum<F>& s, F pdf) {
    F sum = s.r + s.g + s.b + pdf;
    benchmark::DoNotOptimize(sum);
}

template <class M, class F, class Step>
void run(benchmark::State& state, float roughness, Step&& step) {
    MaterialTable table;
    BenchInput input(roughness, table.tables());
    table.add(M::make(input));
    const Textures textures;
    const ShadingContext<F> context{textures, table.tableData(), TextureContext<F>{}};
    const UInt<F> id(table.firstId(kTagOf<M, MaterialTypes>));
    const Inputs inputs;
    std::uint32_t group = 0;
    for (auto _ : state) {
        step(M::bsdf(table.records<M, F>(id), context), inputs, group);
        ++group;
    }
    state.counters["per_lane"] = benchmark::Counter(double(state.iterations()) * kLanes<F>,
                                                    benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <class M, class F>
void registerMaterial(const std::string& name, float roughness) {
    const std::string lanes = kLanes<F> == 1 ? "/one_lane" : "/eight_lanes";
    benchmark::RegisterBenchmark((name + "/evaluate" + lanes).c_str(), [roughness](benchmark::State& state) {
        run<M, F>(state, roughness, [](const auto& bsdf, const Inputs& in, std::uint32_t i) {
            const auto e = bsdf.evaluate(in.direction<F>(i), in.direction<F>(i + 517));
            keep(e.fCos, e.pdf);
        });
    });
    benchmark::RegisterBenchmark((name + "/sample" + lanes).c_str(), [roughness](benchmark::State& state) {
        run<M, F>(state, roughness, [](const auto& bsdf, const Inputs& in, std::uint32_t i) {
            const auto s =
                bsdf.sample(in.direction<F>(i), in.number<F>(i, 0), {in.number<F>(i, 1), in.number<F>(i, 2)});
            keep(s.weight, s.pdf + s.wi.x + s.wi.y + s.wi.z);
        });
    });
}

void registerAll() {
    forEachType(MaterialTypes{}, [&]<class M>() {
        if constexpr (std::is_same_v<M, MeasuredMaterial>) return;  // nothing without a measurement
        for (const float roughness : {0.f, 0.1f}) {
            const bool takesRoughness = std::is_base_of_v<RoughnessInputs, M>;
            if (roughness > 0 && !takesRoughness) continue;
            const std::string name = std::string(M::kInfo.name) + (!takesRoughness ? ""
                                                                   : roughness > 0 ? "/rough"
                                                                                   : "/smooth");
            registerMaterial<M, float>(name, roughness);
            registerMaterial<M, Lanes8f>(name, roughness);
        }
    });
}

}  // namespace
}  // namespace penumbra

int main(int argc, char** argv) {
    penumbra::registerAll();
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
