// Properties that every registered material must have, under every setting of materials_fixture.h: a fold over
// MaterialTypes, so that a new material is tested once it is named there.
#include "core/statistics/multiple_comparisons.h"
#include "tests/materials_fixture.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

namespace penumbra::test {
namespace {

using F = Lanes8f;
constexpr double kPiD = 3.14159265358979323846;

/// Directions that light comes from in these tests: perpendicular to grazing, from both sides.
const std::vector<Vec3<float>>& viewDirections() {
    static const std::vector<Vec3<float>> list = {directionOf(1, 0), directionOf(0.8, 0.7), directionOf(0.45, 2.5),
                                                  directionOf(0.1, 4.0), directionOf(-0.6, 1.1)};
    return list;
}

template <class M>
class MaterialProperties : public testing::Test {
protected:
    MaterialsUnderTest<M> materials;

    /// function(closure over lanes, text that names the material)
    template <class Function>
    void forEachMaterial(Function&& function) {
        for (std::size_t i = 0; i < materials.settings.size(); ++i)
            function(materials.wide(i), materials.name(i));
    }
};

template <class List>
struct TestTypes;
template <class... Ms>
struct TestTypes<TypeList<Ms...>> {
    using type = testing::Types<Ms...>;
};
struct MaterialNames {
    template <class M>
    static std::string GetName(int) {
        return std::string(M::kInfo.name);
    }
};
TYPED_TEST_SUITE(MaterialProperties, TestTypes<MaterialTypes>::type, MaterialNames);

// ------------------------------------------------------------------------------------------------ sampling and density

/// Counts of sampled directions in cells of theta and phi against the integral of pdf over each; delta lobes are cells
/// of their own (expected: the probability they report), and so is what is absorbed.
template <class Bsdf>
class SamplingTest {
public:
    /// `halvings`: how often a cell's integral may be cut in two where that still changes it. Many samples need it: at the
    /// critical angle a density has a pole.
    SamplingTest(const Bsdf& bsdf, const Vec3<float>& wo, int halvings = 0) : bsdf_(bsdf), wo_(wo) {
        const SphereIntegrator<Bsdf> integrator(bsdf, wo);
        for (int i = 0; i < kThetas; ++i) {
            const double z1 = std::cos(kPiD * i / kThetas), z0 = std::cos(kPiD * (i + 1) / kThetas);
            for (int j = 0; j < kPhis; ++j) {
                const double phi0 = 2 * kPiD * j / kPhis, phi1 = 2 * kPiD * (j + 1) / kPhis;
                const auto strip = [&](double from, double to) { return integrator.cell(from, to, phi0, phi1)[0]; };
                probability_[std::size_t(i) * kPhis + j] = refined(strip, z0, z1, strip(z0, z1), halvings);
            }
        }
    }

    double pValue(std::uint32_t samples, std::uint32_t seed) const {
        std::vector<double> observed(kCells + 3), expected = probability_;
        count(samples, seed, observed, expected);
        double rest = 1;
        for (double& e : expected) {
            rest -= e;
            e *= samples;
        }
        EXPECT_GT(rest, -2e-4) << "the density integrates to more than one";
        expected[kAbsorbed] = std::max(rest, 0.0) * samples;
        // Nothing expected is what rounding leaves of it: then a handful is no evidence.
        if (rest < 1e-5 && observed[kAbsorbed] <= 1e-5 * samples) expected[kAbsorbed] = observed[kAbsorbed];
        return chiSquareTest(observed, expected, 10).pValue;
    }

private:
    static constexpr int kThetas = 24, kPhis = 32;  // over the whole sphere
    static constexpr std::size_t kCells = std::size_t(kThetas) * kPhis, kReflectedDelta = kCells,
                                 kRefractedDelta = kCells + 1, kAbsorbed = kCells + 2;

    template <class Strip>
    static double refined(const Strip& strip, double from, double to, double whole, int halvings) {
        constexpr double kEnough = 1e-6;
        if (halvings == 0) return whole;
        const double middle = (from + to) / 2, lower = strip(from, middle), upper = strip(middle, to);
        if (std::abs(lower + upper - whole) < kEnough) return lower + upper;
        return refined(strip, from, middle, lower, halvings - 1) + refined(strip, middle, to, upper, halvings - 1);
    }

    /// Tallies the samples; the probabilities of the delta lobes are those that their samples report.
    void count(std::uint32_t samples, std::uint32_t seed, std::vector<double>& observed,
               std::vector<double>& expected) const {
        const Uniforms u{seed};
        for (std::uint32_t group = 0; group < samples / 8; ++group) {
            const BsdfSample<F> s = bsdf_.sample(broadcast<F>(wo_), u(group, 0), {u(group, 1), u(group, 2)});
            for (int k = 0; k < 8; ++k) {
                const Vec3<float> wi = lane(s.wi, k);
                if (!lane(s.valid, k)) {
                    ++observed[kAbsorbed];
                } else if (lane(s.delta, k)) {
                    const std::size_t cell = wi.z * wo_.z > 0 ? kReflectedDelta : kRefractedDelta;
                    ++observed[cell];
                    expected[cell] = lane(s.pdf, k);
                } else {
                    ++observed[cellOf(wi)];
                }
            }
        }
    }
    static std::size_t cellOf(const Vec3<float>& wi) {
        const double theta = std::acos(std::clamp(double(wi.z), -1.0, 1.0));
        double phi = std::atan2(double(wi.y), double(wi.x));
        if (phi < 0) phi += 2 * kPiD;
        const int i = std::min(int(theta / kPiD * kThetas), kThetas - 1),
                  j = std::min(int(phi / (2 * kPiD) * kPhis), kPhis - 1);
        return std::size_t(i) * kPhis + j;
    }

    const Bsdf& bsdf_;
    Vec3<float> wo_;
    std::vector<double> probability_ = std::vector<double>(kCells + 3);
};

std::size_t sizeOfFamily() {
    std::size_t count = 0;
    forEachType(MaterialTypes{},
                [&]<class M>() { count += settingsOf(M::kInfo.name).size() * viewDirections().size(); });
    return count;
}

/// The whole family of tests has a false-alarm rate of 1e-3 (Sidak).
TYPED_TEST(MaterialProperties, SamplesFollowTheirDensity) {
    const double level = sidakLevel(1e-3, sizeOfFamily());
    std::uint32_t seed = 1;
    this->forEachMaterial([&](const auto& bsdf, const std::string& name) {
        for (const Vec3<float>& wo : viewDirections()) {
            const double p = SamplingTest(bsdf, wo).pValue(1u << 17, ++seed);
            EXPECT_GT(p, level) << name << ", wo.z = " << wo.z;
        }
    });
}

/// A density that is ten percent wrong at most, to see that the test above can fail.
struct SkewedDiffuse : DiffuseBsdf<F> {
    BsdfSample<F> sample(const Vec3<F>& wo, F uLobe, const Vec2<F>& u) const {
        return DiffuseBsdf<F>::sample(wo, uLobe, {u.x, u.y * (F(0.9f) + F(0.1f) * u.y)});
    }
};
TEST(MaterialSampling, SeesADensityThatIsSlightlyWrong) {
    const DiffuseBsdf<F> right{Spectrum<F>::constant(F(0.5f))};
    const SkewedDiffuse wrong{right};
    EXPECT_LT(SamplingTest(wrong, directionOf(0.8, 0.7)).pValue(1u << 17, 5), 1e-6);
    EXPECT_GT(SamplingTest(right, directionOf(0.8, 0.7)).pValue(1u << 17, 5), 1e-3);
}

/// A million samples, twenty seeds: the bar the project holds itself to. The family has a false-alarm rate of 1e-3.
TEST(LongMaterialSampling, SamplesFollowTheirDensity) {
    constexpr std::uint32_t kSeeds = 20;
    const double level = sidakLevel(1e-3, sizeOfFamily() * kSeeds);
    forEachType(MaterialTypes{}, [&]<class M>() {
        const MaterialsUnderTest<M> materials;
        for (std::size_t i = 0; i < materials.settings.size(); ++i) {
            const auto bsdf = materials.wide(i);
            for (const Vec3<float>& wo : viewDirections()) {
                const SamplingTest test(bsdf, wo, 8);
                for (std::uint32_t seed = 0; seed < kSeeds; ++seed)
                    EXPECT_GT(test.pValue(1u << 20, 1000 + seed), level) << materials.name(i) << ", wo.z = " << wo.z;
            }
        }
    });
}

/// Every sample's weight is f cos / pdf, and both agree with evaluate().
TYPED_TEST(MaterialProperties, WeightIsValueOverDensity) {
    this->forEachMaterial([&](const auto& bsdf, const std::string& name) {
        for (const Vec3<float>& wo : viewDirections()) {
            const Uniforms u{7};
            for (std::uint32_t group = 0; group < 500; ++group) {
                const BsdfSample<F> s = bsdf.sample(broadcast<F>(wo), u(group, 0), {u(group, 1), u(group, 2)});
                const BsdfEval<F> e = bsdf.evaluate(broadcast<F>(wo), s.wi);
                for (int k = 0; k < 8; ++k) {
                    if (!lane(s.valid, k)) continue;
                    const double pdf = lane(s.pdf, k), reported = lane(e.pdf, k);
                    const Spectrum<float> weight = lane(s.weight, k), f = lane(e.fCos, k);
                    EXPECT_GT(pdf, 0) << name;
                    if (lane(s.delta, k) || std::abs(lane(s.wi.z, k)) < 1e-3f) continue;
                    ASSERT_NEAR(reported / pdf, 1, 2e-3)
                        << name << ", wo.z = " << wo.z << ", wi.z = " << lane(s.wi.z, k);
                    ASSERT_NEAR(weight.r * pdf, f.r, 2e-3 * f.r + 1e-6) << name;
                    ASSERT_NEAR(weight.g * pdf, f.g, 2e-3 * f.g + 1e-6) << name;
                    ASSERT_NEAR(weight.b * pdf, f.b, 2e-3 * f.b + 1e-6) << name;
                }
            }
        }
    });
}

// ------------------------------------------------------------------------------------------------ physics

/// f(wo, wi) eta^2 = f(wi, wo), with eta the index on wi's side over that on wo's.
TYPED_TEST(MaterialProperties, IsReciprocal) {
    if (!kIsReciprocal<TypeParam>) GTEST_SKIP() << "the model is not";
    if (kIsEstimate<TypeParam>) GTEST_SKIP() << "only the mean of many estimates is: tests of the material's own";
    this->forEachMaterial([&](const auto& bsdf, const std::string& name) {
        for (const Vec3<float>& wo : viewDirections()) {
            const Uniforms u{11};
            for (std::uint32_t group = 0; group < 200; ++group) {
                const BsdfSample<F> s = bsdf.sample(broadcast<F>(wo), u(group, 0), {u(group, 1), u(group, 2)});
                const BsdfEval<F> there = bsdf.evaluate(broadcast<F>(wo), s.wi),
                                  back = bsdf.evaluate(s.wi, broadcast<F>(wo));
                for (int k = 0; k < 8; ++k) {
                    const double cosine = std::abs(lane(s.wi.z, k)), eta = lane(s.eta, k);
                    if (!lane(s.valid, k) || lane(s.delta, k) || cosine < 1e-2) continue;
                    const Spectrum<float> a = lane(there.fCos, k), b = lane(back.fCos, k);
                    const double scale = eta * eta / cosine, backScale = 1 / std::abs(wo.z);
                    ASSERT_NEAR(a.r * scale, b.r * backScale, 2e-3 * b.r * backScale + 1e-6)
                        << name << ", wo.z = " << wo.z;
                    ASSERT_NEAR(a.g * scale, b.g * backScale, 2e-3 * b.g * backScale + 1e-6) << name;
                    ASSERT_NEAR(a.b * scale, b.b * backScale, 2e-3 * b.b * backScale + 1e-6) << name;
                }
            }
        }
    });
}

/// No more energy leaves than came; the albedo for the picture's channels is a reflectance.
TYPED_TEST(MaterialProperties, GainsNoEnergy) {
    this->forEachMaterial([&](const auto& bsdf, const std::string& name) {
        for (const double cosine : {1.0, 0.7, 0.3, 0.05, -0.5}) {
            const Vec3<float> wo = directionOf(cosine, 0.4);
            if (!kIsEstimate<TypeParam>) {  // else only the mean of many
                EXPECT_LT(sampledAlbedo(bsdf, wo, 64), 1 + 1e-3) << name << " at " << cosine;
            }
            const Spectrum<float> albedo = lane(bsdf.albedo(broadcast<F>(wo)), 0);
            for (const float a : {albedo.r, albedo.g, albedo.b}) {
                EXPECT_GE(a, 0) << name;
                EXPECT_LE(a, 1 + 1e-4) << name;
            }
        }
    });
}

// ------------------------------------------------------------------------------------------------ robustness

/// Unit vectors that formulas dislike: along the axes, in the surface, a hair above or below it.
std::vector<Vec3<float>> awkwardDirections() {
    std::vector<Vec3<float>> list = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    for (const float z : {1e-38f, 1e-30f, 1e-20f, 1e-10f, 1e-7f, 1e-4f}) {
        for (const float sign : {1.f, -1.f}) {
            list.push_back({1, 0, sign * z});
            list.push_back({-1, 0, sign * z});
            list.push_back({0, -1, sign * z});
            list.push_back({0.70710678f, 0.70710678f, sign * z});
            list.push_back({sign * z, z, std::copysign(1.f, sign)});
        }
    }
    for (const double z : {0.9999999, 0.5, 0.745355992, 0.6})
        for (const double sign : {1.0, -1.0})
            list.push_back(directionOf(sign * z, 1));
    return list;
}

void expectSane(const BsdfEval<float>& e, const std::string& text) {
    for (const float x : {e.fCos.r, e.fCos.g, e.fCos.b, e.pdf}) {
        ASSERT_TRUE(std::isfinite(x)) << text;
        ASSERT_GE(x, 0) << text;
    }
}
void expectSane(const BsdfSample<float>& s, const std::string& text) {
    for (const float x : {s.weight.r, s.weight.g, s.weight.b, s.pdf, s.wi.x, s.wi.y, s.wi.z, s.eta})
        ASSERT_TRUE(std::isfinite(x)) << text;
    if (!s.valid) return;
    for (const float x : {s.weight.r, s.weight.g, s.weight.b})
        ASSERT_GE(x, 0) << text;
    ASSERT_GT(s.pdf, 0) << text;
    ASSERT_NEAR(length(s.wi), 1, 1e-5) << text;
}

TYPED_TEST(MaterialProperties, StaysFiniteWhateverTheDirections) {
    const std::vector<Vec3<float>> directions = awkwardDirections();
    const std::vector<float> numbers = {0.f, 0x1p-24f, 0.25f, 0.5f, 0.75f, kOneMinusEpsilon};
    for (std::size_t i = 0; i < this->materials.settings.size(); ++i) {
        const auto bsdf = this->materials.template closure<float>(std::uint32_t(i));
        for (const Vec3<float>& wo : directions) {
            const std::string text = this->materials.name(i) + ", wo.z = " + std::to_string(wo.z);
            for (const Vec3<float>& wi : directions)
                expectSane(bsdf.evaluate(wo, wi), text);
            for (const float uLobe : {0.f, 0.5f, kOneMinusEpsilon})
                for (const float x : numbers)
                    for (const float y : numbers)
                        expectSane(bsdf.sample(wo, uLobe, {x, y}), text);
            const Spectrum<float> albedo = bsdf.albedo(wo);
            for (const float x : {albedo.r, albedo.g, albedo.b})
                ASSERT_TRUE(std::isfinite(x) && x >= 0) << text;
        }
    }
}

// ------------------------------------------------------------------------------------------------ one lane and eight

/// The words of a result, NaN made equal to NaN.
template <class T>
std::array<std::uint32_t, sizeof(T) / 4> words(const T& x) {
    std::array<std::uint32_t, sizeof(T) / 4> result;
    std::memcpy(result.data(), &x, sizeof(T));
    for (std::uint32_t& w : result)
        if ((w & 0x7FFFFFFFu) > 0x7F800000u) w = 0x7FC00000u;
    return result;
}
struct Results {
    float numbers[15];
    std::uint32_t masks;
};
template <class T>
Results resultsOf(const BsdfEval<T>& e, const BsdfSample<T>& s, const Spectrum<T>& albedo, const Mask<T>& smooth,
                  int k) {
    const auto l = [&](const auto& x) { return lane(x, k); };
    return {{l(e.fCos.r), l(e.fCos.g), l(e.fCos.b), l(e.pdf), l(s.wi.x), l(s.wi.y), l(s.wi.z), l(s.weight.r),
             l(s.weight.g), l(s.weight.b), l(s.pdf), l(s.eta), l(albedo.r), l(albedo.g), l(albedo.b)},
            (l(s.delta) ? 1u : 0u) | (l(s.valid) ? 2u : 0u) | (l(smooth) ? 4u : 0u)};
}

/// Eight different materials of the type in one group must give what each gives alone.
TYPED_TEST(MaterialProperties, OneLaneAndEightGiveTheSameBits) {
    const Uniforms u{23};
    const std::uint32_t count = std::uint32_t(this->materials.settings.size());
    const std::vector<Vec3<float>> awkward = awkwardDirections();
    const auto directions = [&](std::uint32_t group, std::uint32_t dimension) {
        Vec3<F> w = uniformSphere(Vec2<F>{u(group, dimension), u(group, dimension + 1)});
        if (group % 8 == 7) {  // some groups of directions that are hard
            for (int k = 0; k < 8; ++k) {
                const Vec3<float>& a = awkward[std::size_t(lane(u(group, dimension), k) * float(awkward.size()))];
                setLane(w.x, k, a.x);
                setLane(w.y, k, a.y);
                setLane(w.z, k, a.z);
            }
        }
        return w;
    };
    for (std::uint32_t group = 0; group < 100000 / 8; ++group) {
        const Lanes8u mixed = toUInt(u(group, 9) * F(float(count)));
        const Lanes8u index = group % 2 ? mixed : Lanes8u(lane(mixed, 0));
        const F chance = u(group, 7);
        const auto wide = this->materials.template closure<F>(index, chance);
        const Vec3<F> wo = directions(group, 0), wi = directions(group, 2);
        const F uLobe = u(group, 4);
        const Vec2<F> uv{u(group, 5), u(group, 6)};
        const BsdfEval<F> e = wide.evaluate(wo, wi);
        const BsdfSample<F> s = wide.sample(wo, uLobe, uv);
        const Spectrum<F> albedo = wide.albedo(wo);
        const Mask<F> smooth = wide.smoothOnly();
        for (int k = 0; k < 8; ++k) {
            const auto one = this->materials.template closure<float>(lane(index, k), lane(chance, k));
            const Vec3<float> o = lane(wo, k), i = lane(wi, k);
            const Results expected =
                resultsOf<float>(one.evaluate(o, i), one.sample(o, lane(uLobe, k), {lane(uv.x, k), lane(uv.y, k)}),
                                 one.albedo(o), one.smoothOnly(), 0);
            ASSERT_EQ(words(expected), words(resultsOf<F>(e, s, albedo, smooth, k)))
                << this->materials.name(lane(index, k)) << ", wo = " << o.x << " " << o.y << " " << o.z;
        }
    }
}

// ------------------------------------------------------------------------------------------------ the registry

TEST(MaterialTable, NumbersMaterialsOfOneTypeConsecutively) {
    MaterialTable table;
    std::vector<MaterialHandle> handles;
    std::vector<std::string> types;
    for (int round = 0; round < 3; ++round) {
        for (const std::string& type : pluginNames(MaterialTypes{})) {
            PlainMaterialInput input({}, table.tables());
            handles.push_back(table.add(type, input).value());
            types.push_back(type);
        }
    }
    ASSERT_EQ(table.size(), handles.size());
    std::vector<bool> seen(table.size());
    for (std::size_t i = 0; i < handles.size(); ++i) {
        const std::uint32_t id = table.id(handles[i]);
        ASSERT_LT(id, table.size());
        EXPECT_FALSE(seen[id]);
        seen[id] = true;
        EXPECT_EQ(pluginNames(MaterialTypes{})[table.tag(id)], types[i]);
        EXPECT_EQ(id - table.firstId(table.tag(id)), handles[i].row);
    }
    EXPECT_TRUE(MaterialTable::isPassThrough(kTagOf<InterfaceMaterial, MaterialTypes>));
    EXPECT_FALSE(MaterialTable::isPassThrough(kTagOf<DiffuseMaterial, MaterialTypes>));
}

TEST(MaterialTable, KnowsNoMaterialOfAnotherName) {
    MaterialTable table;
    PlainMaterialInput input({}, table.tables());
    EXPECT_FALSE(table.add("difuse", input).has_value());
    EXPECT_EQ(table.size(), 0u);
}

TEST(MaterialTable, SharesTheTablesOfEqualCoats) {
    MaterialTable table;
    const auto add = [&](float roughness, float reflectance) {
        PlainMaterialInput input({number("roughness", roughness), color("reflectance", reflectance, 0, 0)},
                                 table.tables());
        table.add("coateddiffuse", input);
        return table.tables().size();
    };
    const std::size_t first = add(0.1f, 0.2f);
    EXPECT_EQ(add(0.1f, 0.7f), first);
    EXPECT_GT(add(0.2f, 0.7f), first);
}

}  // namespace
}  // namespace penumbra::test
