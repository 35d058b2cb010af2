// Light selection by place: the tree's probabilities against what it picks, and against what lights contribute.
#include "lights/light_sampler.h"
#include "tests/lights_cases.h"

#include <gtest/gtest.h>

#include <random>

namespace penumbra::test {
namespace {

const Spectrum<float> kOne = {1.f, 1.f, 1.f};

class Randoms {
public:
    explicit Randoms(unsigned seed) : generator_(seed) {}
    double operator()(double low, double high) { return low + (high - low) * (generator_() * 0x1p-32); }
    Vec3d within(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
    Vec3d direction() {
        Vec3d w = within(1);
        while (length(w) > 1 || length(w) < 0.1)
            w = within(1);
        return normalized(w);
    }

private:
    std::mt19937 generator_;
};

/// Lights of every kind that has a place, in a cube of half width 3; their sizes and strengths differ by powers of ten.
LightTable manyLights(int count, unsigned seed) {
    LightTable table;
    Randoms random(seed);
    for (int i = 0; i < count; ++i) {
        const Vec3d at = random.within(3), w = random.direction();
        const double size = std::pow(10, random(-3, 0));
        const Spectrum<float> strength = kOne * float(std::pow(10, random(-2, 2)));
        const Vec3<float> normal = rounded(w);
        Vec3<float> x, y;
        orthonormalBasis(normal, x, y);
        x = x * float(size), y = y * float(size);
        const std::uint32_t flags = i % 3 ? 0u : kLightTwoSided;
        switch (i % 6) {
            case 0:
                table.add(RectangleLight::make(rounded(at), x, y, normal, strength, flags));
                break;
            case 1:
                table.add(TriangleLight::make(rounded(at), rounded(at) + x, rounded(at) + y, normal, strength, flags));
                break;
            case 2:
                table.add(DiskLight::make(rounded(at), x, y, 0.2f, 4.f, normal, strength, flags));
                break;
            case 3: {
                SphereLight sphere;
                EXPECT_TRUE(SphereLight::make(translation(at.x, at.y, at.z) * scaling(size, size / 2, size), 1, -1, 1,
                                              7, strength, flags, sphere));
                table.add(sphere);
                break;
            }
            case 4:
                table.add(PointLight{rounded(at), strength});
                break;
            default:
                table.add(
                    SpotLight::make(translation(at.x, at.y, at.z), {}, w, random(0, 60), random(60, 170), strength));
        }
    }
    return table;
}

struct Tree {
    std::vector<LightBounds> bounds;
    std::vector<std::uint32_t> ids;
    LightTree tree;
    Tree(const LightTable& lights, std::uint32_t units) {
        for (std::uint32_t id = 0; id < lights.size(); ++id) {
            bounds.push_back(*lights.bounds(id));
            ids.push_back(id);
        }
        tree = LightTree(bounds, ids, lights.size(), units);
    }
};

LitPoint<float> somewhere(Randoms& random, double size) {
    return {rounded(random.within(size)), rounded(random.direction())};
}

/// Every number is tried: what is told must be what happens, to the unit.
TEST(LightTree, UnitsAreTheNumbersThatPickALight) {
    constexpr std::uint32_t kUnits = 4096;
    Randoms random(1);
    for (const int count : {1, 2, 3, 10, 100, 1000}) {
        const LightTable lights = manyLights(count, 7);
        const Tree t(lights, kUnits);
        for (int round = 0; round < 5; ++round) {
            const LitPoint<float> at = somewhere(random, round < 3 ? 3 : 100);
            std::vector<std::uint32_t> counts(lights.size(), 0u);
            for (std::uint32_t number = 0; number < kUnits; ++number) {
                std::uint32_t light, units;
                t.tree.pick<float>(at, number, true, light, units);
                if (units == 0) continue;
                ++counts[light];
                ASSERT_EQ(units, t.tree.unitsOf<float>(at, light));
            }
            for (const std::uint32_t id : t.ids)
                EXPECT_EQ(counts[id], t.tree.unitsOf<float>(at, id)) << count << " lights, " << id;
        }
    }
}

/// Where every light shines in all directions, no number is lost.
TEST(LightTree, UnitsAddUpToAllThereAre) {
    Randoms random(2);
    LightTable lights;
    for (int i = 0; i < 3000; ++i)
        lights.add(PointLight{rounded(random.within(2)), kOne * float(std::pow(10, random(-20, 20)))});
    const Tree t(lights, LightTree::kUnits);
    for (int round = 0; round < 20; ++round) {
        const LitPoint<float> at = somewhere(random, 3);
        std::uint64_t sum = 0;
        for (const std::uint32_t id : t.ids)
            sum += t.tree.unitsOf<float>(at, id);
        EXPECT_EQ(sum, LightTree::kUnits);
    }
}

/// Over places near, far, on the lights themselves: what light sampling can get light from, the tree can pick.
TEST(LightTree, LightsThatShineCanBePicked) {
    for (const double scale : {1e-5, 1.0, 1e7}) {
        Randoms random(3);
        const LightTable lights = manyLights(300, 5);
        Tree t(lights, LightTree::kUnits);
        for (LightBounds& b : t.bounds) {
            b.lower = b.lower * scale;
            b.upper = b.upper * scale;
        }
        t.tree = LightTree(t.bounds, t.ids, lights.size(), LightTree::kUnits);
        int shining = 0, dark = 0;
        for (int round = 0; round < 200; ++round) {
            LitPoint<float> at = somewhere(random, round % 3 == 0 ? 3 : round % 3 == 1 ? 30 : 3e4);
            if (round % 5 == 0)  // on a light
                at.p = sampleLight<float>(lights, std::uint32_t(round) % 300, {}, {0.5f, 0.5f}).wi * 1e-3f +
                       rounded({t.bounds[std::size_t(round) % 300].center().x / scale,
                                t.bounds[std::size_t(round) % 300].center().y / scale,
                                t.bounds[std::size_t(round) % 300].center().z / scale});
            const LitPoint<float> scaled = {at.p * float(scale), at.n};
            for (const std::uint32_t id : t.ids) {
                bool shines = false;
                for (const float u : {0.01f, 0.3f, 0.6f, 0.99f})
                    shines = shines || sampleLight<float>(lights, id, at.p, {u, 1 - u}).valid;
                const std::uint32_t units = t.tree.unitsOf<float>(scaled, id);
                EXPECT_TRUE(!shines || units > 0) << id << " of kind " << id % 6 << " at scale " << scale;
                ++(shines ? shining : dark);
            }
        }
        EXPECT_GT(shining, 10000);
        EXPECT_GT(dark, 10000);
    }
}

/// Of every registered light that has a place: its points lie in its box, and their light goes where the bounds say.
TEST(LightTree, BoundsHoldWhatLightsSample) {
    for (const double scale : {1e-4, 1.0, 1e6}) {
        for (const LightCase& c : allLightCases(scale)) {
            const std::optional<LightBounds> b = c.lights.bounds(0);
            if (!b) continue;
            const double slack = 1e-5 * (std::sqrt(b->radiusSquared()) + double(length(c.from)) + scale);
            Randoms random(8);
            for (int i = 0; i < 500; ++i) {
                const auto s =
                    sampleLight<float>(c.lights, 0, c.from, {float(random(0, 0.9999)), float(random(0, 0.9999))});
                if (!s.valid) continue;
                const Vec3d p = widened(c.from) + widened(s.wi) * double(s.distance);
                // (A portal's point is infinitely far behind it.)
                EXPECT_TRUE(s.distance == kInfinity ||
                            (p.x > b->lower.x - slack && p.x < b->upper.x + slack && p.y > b->lower.y - slack &&
                             p.y < b->upper.y + slack && p.z > b->lower.z - slack && p.z < b->upper.z + slack))
                    << c.name << " at scale " << scale;
                const double angle =
                    std::acos(std::clamp(-dot(widened(s.wi), {b->axis.x, b->axis.y, b->axis.z}), -1., 1.));
                const double nearest = b->isTwoSided ? std::min(angle, std::numbers::pi - angle) : angle;
                EXPECT_LT(nearest, b->spread + b->falloff + 1e-3) << c.name;
            }
        }
    }
}

TEST(LightTree, EightLanesGiveTheBitsOfOne) {
    const LightTable lights = manyLights(500, 11);
    const Tree t(lights, LightTree::kUnits);
    Randoms random(4);
    for (int round = 0; round < 2000; ++round) {
        LitPoint<Lanes8f> at;
        Lanes8u number, wanted, light, units;
        Mask8 active;
        std::array<LitPoint<float>, 8> each;
        for (int i = 0; i < 8; ++i) {
            each[std::size_t(i)] = somewhere(random, 5);
            const auto& [p, n] = each[std::size_t(i)];
            setLane(at.p.x, i, p.x), setLane(at.p.y, i, p.y), setLane(at.p.z, i, p.z);
            setLane(at.n.x, i, n.x), setLane(at.n.y, i, n.y), setLane(at.n.z, i, n.z);
            setLane(number, i, std::uint32_t(random(0, LightTree::kUnits)));
            setLane(wanted, i, std::uint32_t(random(0, 500)));
            setLane(active, i, random(0, 1) < 0.8);
        }
        t.tree.pick(at, number, active, light, units);
        const Lanes8u of = t.tree.unitsOf(at, wanted);
        for (int i = 0; i < 8; ++i) {
            std::uint32_t oneLight, oneUnits;
            t.tree.pick<float>(each[std::size_t(i)], lane(number, i), lane(active, i), oneLight, oneUnits);
            EXPECT_EQ(lane(units, i), oneUnits);
            EXPECT_TRUE(oneUnits == 0 || lane(light, i) == oneLight);
            EXPECT_EQ(lane(of, i), t.tree.unitsOf<float>(each[std::size_t(i)], lane(wanted, i)));
        }
    }
}

/// Lights that halve their distance, and lights in one place, would make chains of nodes longer than a trail has bits.
TEST(LightTree, StaysShallowWhereLightsCrowd) {
    LightTable lights;
    for (int i = 0; i < 2000; ++i)
        lights.add(PointLight{{float(std::pow(0.98, i)), 0, 0}, kOne});
    for (int i = 0; i < 2000; ++i)
        lights.add(PointLight{{0, 1, 0}, kOne * float(i + 1)});
    const Tree t(lights, LightTree::kUnits);
    const LitPoint<float> at = {{0, 0.5f, 0.5f}, {0, 0, 1}};
    std::uint64_t sum = 0;
    for (const std::uint32_t id : t.ids) {
        EXPECT_GT(t.tree.unitsOf<float>(at, id), 0u) << id;
        sum += t.tree.unitsOf<float>(at, id);
    }
    EXPECT_EQ(sum, LightTree::kUnits);
}

/// The relative variance of one sample of the light at a place: the sum of contribution^2 / probability over the square
/// of the sum of contributions, less 1.
double relativeVariance(const LightTable& lights, const LightSampler& sampler, const LitPoint<float>& at) {
    double sum = 0, squares = 0;
    for (std::uint32_t id = 0; id < lights.size(); ++id) {
        const auto s = sampleLight<float>(lights, id, at.p, {0.5f, 0.5f});
        const double f = double(s.L.r) * std::max(0.f, dot(s.wi, at.n));
        if (!(f > 0)) continue;
        sum += f;
        squares += f * f / sampler.probability<float>(at, id);
    }
    return squares / (sum * sum) - 1;
}

TEST(LightTree, VariesLittleHoweverManyLightsThereAre) {
    LightTable lights;
    Randoms random(6);
    for (int i = 0; i < 20000; ++i)
        lights.add(PointLight{rounded({random(-10, 10), random(-10, 10), random(0.3, 2)}), kOne});
    const LightSampler byPlace(LightSelection::Bvh, lights, false), byPower(LightSelection::Power, lights, false);
    double place = 0, power = 0;
    for (int round = 0; round < 50; ++round) {
        const LitPoint<float> at = {rounded({random(-9, 9), random(-9, 9), 0}), {0, 0, 1}};
        place += relativeVariance(lights, byPlace, at);
        power += relativeVariance(lights, byPower, at);
    }
    EXPECT_LT(place / 50, 0.5);
    EXPECT_GT(power / place, 50);
}

/// Ids: 0 distant, 1 rectangle, 2 constant sky, 3 point, 4 black point, 5 distant of three times the first's flux.
LightTable lightsBeside() {
    LightTable lights;
    lights.add(DistantLight{{0, 0, 1}, kOne});
    lights.add(RectangleLight::make({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, kOne, 0));
    lights.add(ConstantInfiniteLight{kOne});
    lights.add(PointLight{{5, 5, 5}, kOne});
    lights.add(PointLight{{1, 1, 1}, kOne * 0.f});
    lights.add(DistantLight{{0, 1, 0}, kOne * 3.f});
    return lights;
}

TEST(LightSelectionByPlace, DistantLightsStandBesideTheTree) {
    const LightTable lights = lightsBeside();
    const LightSampler sampler(LightSelection::Bvh, lights, false);
    EXPECT_TRUE(sampler.isByPlace());
    const LitPoint<float> below = {{0.5f, 0.5f, 0}, {0, 0, 1}}, above = {{0.5f, 0.5f, 2}, {0, 0, 1}};
    EXPECT_NEAR(sampler.probability<float>(below, 0), 2. / 3 / 4, 1e-6);
    EXPECT_NEAR(sampler.probability<float>(below, 5), 2. / 3 * 3 / 4, 1e-6);
    EXPECT_EQ(sampler.probability<float>(below, 2), 0.f);
    EXPECT_EQ(sampler.probability<float>(below, 4), 0.f);
    EXPECT_NEAR(sampler.probability<float>(below, 1) + sampler.probability<float>(below, 3), 1. / 3, 1e-6);
    EXPECT_GT(sampler.probability<float>(below, 1), 0.3f);
    EXPECT_EQ(sampler.probability<float>(above, 1), 0.f) << "it shines down";
    EXPECT_NEAR(sampler.probability<float>(above, 3), 1. / 3, 1e-6);

    for (const LitPoint<float>& at : {below, above}) {
        constexpr int kPicks = 30000;
        std::vector<int> counts(6, 0);
        for (int i = 0; i < kPicks; ++i) {
            std::uint32_t id;
            float probability;
            sampler.pick<float>(at, (float(i) + 0.5f) / kPicks, id, probability);
            EXPECT_EQ(probability, sampler.probability<float>(at, id));
            ++counts[id];
        }
        for (std::uint32_t id = 0; id < 6; ++id)
            EXPECT_NEAR(counts[id], kPicks * double(sampler.probability<float>(at, id)), 1.01) << id;
    }
    EXPECT_GT(LightSampler(LightSelection::Bvh, lights, true).probability<float>(below, 2), 0.f);
}

TEST(LightSelectionByPlace, IsByPowerWhereNothingHasAPlace) {
    LightTable lights;
    lights.add(DistantLight{{0, 0, 1}, kOne});
    lights.add(DistantLight{{0, 1, 0}, kOne * 3.f});
    const LightSampler sampler(LightSelection::Bvh, lights, false);
    EXPECT_FALSE(sampler.isByPlace());
    EXPECT_NEAR(sampler.probability<float>({}, 1), 0.75, 1e-6);

    lights.add(PointLight{{1, 2, 3}, kOne * 0.f});
    EXPECT_FALSE(LightSampler(LightSelection::Bvh, lights, false).isByPlace());
    LightTable one;
    one.add(PointLight{{1, 2, 3}, kOne});
    EXPECT_TRUE(LightSampler(LightSelection::Bvh, one, false).isSingle());
}

TEST(LightSelectionByPlace, TellsWhenNoLightCanShine) {
    LightTable lights;
    for (int i = 0; i < 2; ++i)
        lights.add(RectangleLight::make({float(i), 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, kOne, 0));
    const LightSampler sampler(LightSelection::Bvh, lights, false);
    std::uint32_t id;
    float probability;
    sampler.pick<float>({{0.5f, 0.5f, 2}, {0, 0, 1}}, 0.3f, id, probability);
    EXPECT_EQ(probability, 0.f);
    EXPECT_LT(id, 2u);
}

}  // namespace
}  // namespace penumbra::test
