// What the tests of materials share: a MaterialInput without a scene, the settings under which every registered
// material is tested, and integrals of closures over the sphere.
//
// A material with no entry in settingsOf() is tested with its default parameters.
#pragma once

#include "core/math/hash.h"
#include "core/statistics/hypothesis_tests.h"
#include "materials/registry.h"
#include "tests/measured_file.h"

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace penumbra::test {

/// Parameters as "type name" and numbers.
struct Setting {
    std::string type, name;
    std::vector<float> numbers;
    std::string text{};
};
using Settings = std::vector<Setting>;

inline std::string describe(std::string_view material, const Settings& settings) {
    std::string text(material);
    for (const Setting& s : settings) {
        text += " " + s.name + "=";
        text += s.text;
        for (const float x : s.numbers)
            text += std::to_string(x).substr(0, 6) + " ";
    }
    return text;
}

class PlainMaterialInput final : public MaterialInput {
public:
    PlainMaterialInput(const Settings& settings, MaterialTables& tables) : tables_(tables) {
        for (const Setting& s : settings) {
            Parameter p;
            p.type = s.type;
            p.name = s.name;
            if (s.type == "integer") {
                p.values = std::vector<std::int32_t>(s.numbers.begin(), s.numbers.end());
            } else if (s.type == "string") {
                p.values = std::vector<std::string>{s.text};
            } else if (s.type == "bool") {
                p.values = std::vector<std::uint8_t>(s.numbers.begin(), s.numbers.end());
            } else {
                p.values = s.numbers;
            }
            parameters_.add(std::move(p));
        }
    }
    /// The parameter `name` comes from this texture instead.
    void useTexture(std::string_view name, std::uint32_t texture) { textures_[std::string(name)] = texture; }

    SpectrumInput albedo(std::string_view name, Rgb otherwise) override {
        const Rgb c = clamp(rgb(name, otherwise), 0.f, 1.f);
        return {{c.r, c.g, c.b}, textureOf(name, kNoTexture)};
    }
    SpectrumInput coefficient(std::string_view name, Rgb otherwise) override {
        const Rgb c = rgb(name, otherwise);
        return {{c.r, c.g, c.b}, textureOf(name, kNoTexture)};
    }
    ScalarInput scalar(std::string_view name, float otherwise) override {
        return {parameters_.number(name, otherwise), textureOf(name, kNoTexture)};
    }
    ScalarInput scalar(std::string_view name, const ScalarInput& otherwise) override {
        return {parameters_.number(name, otherwise.constant), textureOf(name, otherwise.texture)};
    }
    float dielectricIndex(std::string_view name, float otherwise) override {
        return parameters_.number(name, otherwise);
    }
    ConductorIndex conductorIndex(std::string_view eta, std::string_view k) override {  // copper
        return {rgb(eta, {0.1684f, 0.9765f, 1.2113f}), rgb(k, {3.6390f, 2.6211f, 2.3663f})};
    }
    /// A measurement of a made-up metal instead: tests/measured_file.h.
    std::vector<char> file(std::string_view, std::uint64_t) override {
        MeasuredMetal metal;
        metal.alphaX = parameters_.number("metal.ax", metal.alphaX);
        metal.alphaY = parameters_.number("metal.ay", metal.alphaX);
        metal.nodes = int(parameters_.number("metal.nodes", float(metal.nodes)));
        return measuredFile(metal);
    }
    const ChannelWeights& channelWeights() const override {
        return penumbra::channelWeights(srgbColorSpace());
    }
    const ParameterSet& parameters() const override { return parameters_; }
    void warn(const std::string& text) override { warnings.push_back(text); }
    [[noreturn]] void fail(const std::string& text) override { throw Error(ErrorKind::BadData, text); }
    MaterialTables& tables() override { return tables_; }

    std::vector<std::string> warnings;

private:
    Rgb rgb(std::string_view name, Rgb otherwise) const {
        const std::vector<float>& v = parameters_.numbers("rgb", name);
        return v.empty() ? otherwise : Rgb{v[0], v[1], v[2]};
    }
    std::uint32_t textureOf(std::string_view name, std::uint32_t otherwise) const {
        const auto found = textures_.find(name);
        return found == textures_.end() ? otherwise : found->second;
    }

    ParameterSet parameters_;
    MaterialTables& tables_;
    std::map<std::string, std::uint32_t, std::less<>> textures_;
};

inline Setting number(std::string name, float x) {
    return {"float", std::move(name), {x}};
}
inline Setting color(std::string name, float r, float g, float b) {
    return {"rgb", std::move(name), {r, g, b}};
}
inline Setting integer(std::string name, int i) {
    return {"integer", std::move(name), {float(i)}};
}
/// Roughness given as alpha.
inline Setting plainAlpha() {
    return {"bool", "remaproughness", {0.f}};
}

inline Setting schlick() {
    return {"string", "fresnel", {}, "schlick"};
}
inline Setting multiscatter() {
    return {"bool", "multiscatter", {1.f}};
}

/// Everything a material is tested with: always its defaults, then what matters of its parameters.
inline std::vector<Settings> settingsOf(std::string_view material) {
    std::vector<Settings> list{{}};
    const auto add = [&](Settings s) { list.push_back(std::move(s)); };
    if (material == "diffuse") {
        add({color("reflectance", 1, 1, 1)});
        add({color("reflectance", 0, 0.3f, 0.9f)});
    } else if (material == "conductor") {
        add({color("reflectance", 0.9f, 0.5f, 0)});
        add({color("reflectance", 1, 0.5f, 0), number("roughness", 0.3f)});
        add({color("eta", 0, 0, 0), color("k", 1, 1, 1), number("roughness", 0.05f), plainAlpha()});
        add({color("eta", 0, 0, 0), color("k", 1, 1, 1), number("roughness", 1)});
        add({number("roughness", 0.09f)});
        add({number("uroughness", 0.05f), number("vroughness", 0.4f), plainAlpha()});
        add({number("uroughness", 0.9f), number("vroughness", 0.1f), plainAlpha()});
        add({schlick()});
        add({schlick(), color("reflectance", 0.8f, 0.4f, 0), number("roughness", 0.2f)});
        add({multiscatter()});
        add({multiscatter(), number("roughness", 0.3f)});
        add({multiscatter(), color("reflectance", 1, 0.5f, 0), number("roughness", 1)});
        add({multiscatter(), schlick(), number("uroughness", 0.2f), number("vroughness", 0.7f), plainAlpha()});
    } else if (material == "dielectric") {
        add({number("eta", 0.75f)});
        add({number("eta", 1)});
        add({number("eta", 1), number("roughness", 0.5f)});
        add({number("roughness", 0.05f), plainAlpha()});
        add({number("roughness", 0.09f)});
        add({number("roughness", 1)});
        add({number("eta", 1.33f), number("roughness", 0.2f)});
        add({number("eta", 0.6f), number("roughness", 0.2f)});
        add({number("eta", 2.4f), number("uroughness", 0.1f), number("vroughness", 0.5f), plainAlpha()});
        add({schlick()});
        add({schlick(), number("roughness", 0.2f)});
        add({multiscatter(), number("roughness", 0.3f)});
        add({multiscatter(), number("eta", 0.6f), number("roughness", 1)});
        add({multiscatter(), schlick(), number("uroughness", 0.2f), number("vroughness", 0.7f), plainAlpha()});
    } else if (material == "thindielectric") {
        add({number("eta", 1)});
        add({number("eta", 0.7f)});
        add({number("eta", 2.4f)});
    } else if (material == "diffusetransmission") {
        add({color("reflectance", 0.3f, 0.6f, 0), color("transmittance", 0.7f, 0.4f, 1)});
        add({color("reflectance", 0, 0, 0), color("transmittance", 0.2f, 0.5f, 0.9f)});
        add({color("reflectance", 0.8f, 0.5f, 0.1f), color("transmittance", 0, 0, 0)});
        add({color("reflectance", 0.5f, 0.25f, 0.1f), color("transmittance", 0.4f, 0.3f, 0.1f), number("scale", 0.5f)});
    } else if (material == "phong" || material == "blinn") {
        add({color("kd", 0, 0, 0), color("ks", 1, 1, 1), number("exponent", 1)});
        add({color("kd", 0, 0, 0), color("ks", 1, 0.5f, 0), number("exponent", 2.5f)});
        add({color("kd", 0.9f, 0, 0.3f), color("ks", 0, 0, 0)});
        add({color("kd", 0, 0, 0), color("ks", 0, 0, 0)});
        add({color("kd", 0.7f, 0.2f, 0.3f), color("ks", 0.9f, 0.1f, 0.7f), number("exponent", 400)});
    } else if (material == "coateddiffuse") {
        add({color("reflectance", 1, 1, 1)});
        add({color("reflectance", 0, 0, 0), number("roughness", 0.1f)});
        add({color("reflectance", 0.1f, 0.5f, 0.9f), number("roughness", 0.05f), plainAlpha()});
        add({number("roughness", 0.3f)});
        add({number("uroughness", 0.6f), number("vroughness", 0.06f), plainAlpha()});
        add({number("eta", 2), color("reflectance", 1, 1, 1), number("roughness", 1)});
        add({number("eta", 0.8f), number("roughness", 0.1f)});
        add({number("eta", 1), number("thickness", 0.5f)});
        add({number("thickness", 1), integer("maxdepth", 1)});
        add({number("thickness", 0), integer("maxdepth", 1000), color("reflectance", 1, 1, 1)});
    } else if (material == "coatedconductor") {
        add({number("conductor.roughness", 0.3f)});
        add({number("interface.roughness", 0.1f)});
        add({number("interface.roughness", 0.02f), number("conductor.roughness", 0.002f), integer("nsamples", 3)});
        add({color("reflectance", 0.9f, 0.5f, 0), number("conductor.uroughness", 0.05f),
             number("conductor.vroughness", 0.4f), plainAlpha()});
        add({color("reflectance", 1, 1, 1), number("interface.uroughness", 0.6f), number("interface.vroughness", 0.06f),
             number("conductor.roughness", 1), number("thickness", 0), integer("maxdepth", 1000), plainAlpha()});
        add({number("interface.eta", 0.8f), number("interface.roughness", 0.1f), number("conductor.roughness", 0.1f)});
        add({number("interface.eta", 1), number("conductor.roughness", 0.2f), integer("maxdepth", 1)});
        add({number("interface.eta", 2.4f), number("thickness", 1), number("interface.roughness", 1)});
    } else if (material == "hair") {
        add({color("sigma_a", 0, 0, 0)});
        add({color("sigma_a", 0, 0.1f, 30), number("beta_m", 1), number("beta_n", 1)});
        add({color("reflectance", 0.7f, 0.4f, 0.2f), number("beta_m", 0.15f), number("beta_n", 0.2f), number("alpha", 5)});
        add({number("eumelanin", 0.1f), number("pheomelanin", 0.6f), number("beta_n", 0.6f), number("alpha", 0)});
        add({number("eta", 1), number("alpha", -30)});
        add({number("eta", 0.8f)});
    } else if (material == "measured") {
        add({number("metal.ax", 0.6f)});
        add({number("metal.ax", 0.25f), number("metal.ay", 0.5f)});
    }
    return list;
}

/// One material of type M for every setting, in a table.
template <class M>
struct MaterialsUnderTest {
    MaterialTable table;
    std::vector<Settings> settings = settingsOf(M::kInfo.name);
    Textures textures;

    MaterialsUnderTest() {
        for (const Settings& s : settings) {
            PlainMaterialInput input(s, table.tables());
            table.add(M::kInfo.name, input);
        }
    }
    explicit MaterialsUnderTest(const Settings& only) : settings{only} {
        PlainMaterialInput input(only, table.tables());
        table.add(M::kInfo.name, input);
    }
    std::string name(std::size_t i) const { return describe(M::kInfo.name, settings[i]); }

    template <class F>
    typename M::template Bsdf<F> closure(const UInt<F>& index, F chance = F(0.3f)) const {
        const UInt<F> id = index + UInt<F>(table.firstId(kTagOf<M, MaterialTypes>));
        const F zero(0.f);
        const ShadingContext<F> context{
            textures, table.tableData(), {{F(0.3f), F(0.7f)}, zero, {zero, zero, zero}, {zero, zero, F(1.f)}, zero}, chance};
        return M::bsdf(table.records<M, F>(id), context);
    }
    /// The one material, for lanes.
    typename M::template Bsdf<Lanes8f> wide(std::size_t i = 0, Lanes8f chance = Lanes8f(0.3f)) const {
        return closure<Lanes8f>(Lanes8u(std::uint32_t(i)), chance);
    }
};

inline Vec3<float> directionOf(double cosTheta, double phi) {
    const double sinTheta = std::sqrt(std::max(0.0, 1 - cosTheta * cosTheta));
    return {float(sinTheta * std::cos(phi)), float(sinTheta * std::sin(phi)), float(cosTheta)};
}

/// Uniform numbers, by position: eight at a time.
struct Uniforms {
    std::uint32_t seed;
    Lanes8f operator()(std::uint32_t group, std::uint32_t dimension) const {
        const Lanes8u position = Lanes8u(group * 8u) + laneIndices<Lanes8f>();
        return unitFloat<Lanes8f>(combineBits(combineBits(Lanes8u(mixBits(seed)), position), Lanes8u(dimension)));
    }
};

/// {pdf, f cos in r, g, b}
using Integral = std::array<double, 4>;

/// Integrals of a closure over parts of the sphere, for one wo: adaptive Gauss-Legendre in cos theta and phi.
template <class Bsdf>
class SphereIntegrator {
public:
    SphereIntegrator(const Bsdf& bsdf, const Vec3<float>& wo) : bsdf_(bsdf), wo_(broadcast<Lanes8f>(wo)) {}

    Integral cell(double z0, double z1, double phi0, double phi1) const {
        return refine(z0, z1, phi0, phi1, panel(z0, z1, phi0, phi1), 0);
    }
    Integral hemisphere(bool upper) const {
        Integral sum{};
        for (int i = 0; i < 16; ++i) {
            for (int j = 0; j < 16; ++j) {
                const double z = i / 16.0, step = 1 / 16.0, phi = 2 * kPi * j / 16.0;
                const Integral part =
                    upper ? cell(z, z + step, phi, phi + 2 * kPi / 16) : cell(-z - step, -z, phi, phi + 2 * kPi / 16);
                for (int k = 0; k < 4; ++k)
                    sum[k] += part[k];
            }
        }
        return sum;
    }

private:
    static constexpr double kPi = 3.14159265358979323846;

    Integral panel(double z0, double z1, double phi0, double phi1) const {
        static constexpr double node[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                           0.93056815579702629};
        static constexpr double weight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                             0.17392742256872693};
        Integral sum{};
        for (int half = 0; half < 2; ++half) {
            Vec3<Lanes8f> wi{Lanes8f(0.f), Lanes8f(0.f), Lanes8f(0.f)};
            for (int k = 0; k < 8; ++k) {
                const Vec3<float> w =
                    directionOf(z0 + (z1 - z0) * node[2 * half + k / 4], phi0 + (phi1 - phi0) * node[k % 4]);
                setLane(wi.x, k, w.x);
                setLane(wi.y, k, w.y);
                setLane(wi.z, k, w.z);
            }
            const BsdfEval<Lanes8f> e = bsdf_.evaluate(wo_, wi);
            for (int k = 0; k < 8; ++k) {
                const double w = weight[2 * half + k / 4] * weight[k % 4] * (z1 - z0) * (phi1 - phi0);
                sum[0] += w * lane(e.pdf, k);
                sum[1] += w * lane(e.fCos.r, k);
                sum[2] += w * lane(e.fCos.g, k);
                sum[3] += w * lane(e.fCos.b, k);
            }
        }
        return sum;
    }
    Integral refine(double z0, double z1, double phi0, double phi1, const Integral& whole, int depth) const {
        // Cut off the middle: at an edge in the middle whole and parts would agree on the same wrong value.
        const double z = z0 + 0.4 * (z1 - z0), phi = phi0 + 0.6 * (phi1 - phi0);
        const std::array<Integral, 4> part = {panel(z0, z, phi0, phi), panel(z0, z, phi, phi1), panel(z, z1, phi0, phi),
                                              panel(z, z1, phi, phi1)};
        Integral sum{};
        for (const Integral& p : part)
            for (int k = 0; k < 4; ++k)
                sum[k] += p[k];
        const bool agrees = std::abs(sum[0] - whole[0]) < 1e-7 && std::abs(sum[1] - whole[1]) < 1e-7;
        if (depth >= 9 || (depth >= 1 && agrees)) return sum;
        sum = {};
        for (int i = 0; i < 4; ++i) {
            const bool highZ = i >= 2, highPhi = i % 2 == 1;
            const Integral fine =
                refine(highZ ? z : z0, highZ ? z1 : z, highPhi ? phi : phi0, highPhi ? phi1 : phi, part[i], depth + 1);
            for (int k = 0; k < 4; ++k)
                sum[k] += fine[k];
        }
        return sum;
    }

    const Bsdf& bsdf_;
    Vec3<Lanes8f> wo_;
};

/// Mean of weight * eta^2, the fraction of energy that goes on, over samples jittered in a grid of steps^2 cells.
template <class Bsdf>
double sampledAlbedo(const Bsdf& bsdf, const Vec3<float>& wo, int steps) {
    using F = Lanes8f;
    constexpr int kLobes = 16;
    const Uniforms u{3};
    std::uint32_t group = 0;
    double sum = 0;
    for (int lobe = 0; lobe < kLobes; ++lobe) {
        for (int j = 0; j < steps; ++j) {
            for (int i = 0; i < steps; i += 8, ++group) {
                const F x = (toFloat<F>(laneIndices<F>()) + F(float(i)) + u(group, 0)) * F(1.f / float(steps));
                const F y = (F(float(j)) + u(group, 1)) * F(1.f / float(steps));
                const F uLobe = (F(float(lobe)) + u(group, 2)) * F(1.f / kLobes);
                const BsdfSample<F> s =
                    bsdf.sample(broadcast<F>(wo), uLobe, {min(x, F(kOneMinusEpsilon)), min(y, F(kOneMinusEpsilon))});
                const F value = select(s.valid, s.weight.r * s.eta * s.eta, F(0.f));
                for (int k = 0; k < 8; ++k)
                    sum += lane(value, k);
            }
        }
    }
    return sum / (double(kLobes) * steps * steps);
}

}  // namespace penumbra::test
