// Every registered light, in every configuration of lights_cases.h: what sample() draws has the density that it and
// evaluate() name. Seeds are fixed; the family of chi-square tests rejects right code with probability 1e-3 in all.
#include "core/statistics/hypothesis_tests.h"
#include "core/statistics/multiple_comparisons.h"
#include "tests/lights_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

namespace penumbra::test {
namespace {

constexpr int kRows = 16, kColumns = 24;  // cells of the directions
constexpr int kCoarse = 20, kFine = 56;    // pairs of evaluations along a cell's side: of a smooth density, and across an edge
constexpr int kSamples = 1 << 18;

Vec2<Lanes8f> randomPair(std::mt19937& generator) {
    Vec2<Lanes8f> u;
    for (int i = 0; i < 8; ++i) {
        setLane(u.x, i, float(generator() >> 8) * 0x1p-24f);
        setLane(u.y, i, float(generator() >> 8) * 0x1p-24f);
    }
    return u;
}

/// Directions in a cone, in cells of equal solid angle.
class DirectionCells {
public:
    /// A cone around the given directions, somewhat wider.
    explicit DirectionCells(const std::vector<Vec3d>& directions) {
        Vec3d sum;
        for (const Vec3d& w : directions)
            sum = sum + w;
        axis_ = length(sum) > 0 ? sum * (1 / length(sum)) : Vec3d{0, 0, 1};
        for (const Vec3d& w : directions)
            versine_ = std::max(versine_, versine(w));
        versine_ = std::min(2.0, 1.2 * versine_);
        x_ = std::abs(axis_.x) > 0.9 ? cross(axis_, {0, 1, 0}) : cross(axis_, {1, 0, 0});
        x_ = x_ * (1 / length(x_));
        y_ = cross(axis_, x_);
    }
    double solidAngle() const { return 2 * std::numbers::pi * versine_; }
    /// -1 outside of the cone.
    int indexOf(const Vec3d& w) const {
        const double v = versine(w) / versine_, phi = std::atan2(dot(w, y_), dot(w, x_)) / (2 * std::numbers::pi);
        if (v >= 1) return -1;
        return int(v * kRows) * kColumns + int((phi < 0 ? phi + 1 : phi) * kColumns) % kColumns;
    }
    Vec3d direction(double row, double column) const {
        const double v = row / kRows * versine_, phi = 2 * std::numbers::pi * column / kColumns;
        const double s = std::sqrt(v * (2 - v));
        return axis_ * (1 - v) + x_ * (s * std::cos(phi)) + y_ * (s * std::sin(phi));
    }

private:
    double versine(const Vec3d& w) const { return 0.5 * dot(w - axis_, w - axis_); }
    Vec3d axis_, x_, y_;
    double versine_ = 0;
};

double density(const LightCase& c, const Vec3d& w) {
    double sum = 0;
    for (const LightHit<float>& hit : c.meet(w))
        sum += evaluateLight<float>(c.lights, 0, hit).pdf;
    return sum;
}

/// The density over one cell, by a jittered grid (the edges of lights may run along a grid), and how uncertain that is: where a
/// round light is seen edge-on, its density by area has a pole, of which any grid catches now more, now less.
struct CellIntegral {
    double probability = 0, variance = 0;
    double covered = 0;  ///< share of the cell with a density
    bool smooth = true;
};
CellIntegral integrate(const LightCase& c, const DirectionCells& cells, int row, int column, int side,
                       std::mt19937& generator) {
    double sum = 0, squares = 0, smallest = 1e300, largest = 0;
    int positive = 0;
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            double pair[2];
            for (double& d : pair) {
                const double x = (i + generator() * 0x1p-32) / side, y = (j + generator() * 0x1p-32) / side;
                d = density(c, cells.direction(row + x, column + y));
                smallest = std::min(smallest, d);
                largest = std::max(largest, d);
                positive += d > 0;
            }
            sum += pair[0] + pair[1];
            squares += (pair[0] - pair[1]) * (pair[0] - pair[1]);
        }
    }
    const double count = 2.0 * side * side, share = cells.solidAngle() / (kRows * kColumns) / count;
    return {sum * share, squares * share * share, positive / count, smallest >= 0.8 * largest};
}

struct Comparison {
    double integral;    ///< of the density
    double validShare;  ///< of the samples
    double pValue;
};

std::vector<Vec3d> sampledDirections(const LightCase& c, std::mt19937& generator) {
    const Vec3<Lanes8f> from = broadcast<Lanes8f>(c.from);
    std::vector<Vec3d> directions;
    for (int i = 0; i < kSamples / 8; ++i) {
        const auto s = sampleLight<Lanes8f>(c.lights, Lanes8u(0u), from, randomPair(generator));
        for (int k = 0; k < 8; ++k) {
            if (!lane(s.valid, k)) continue;
            const Vec3d w = widened(lane(s.wi, k));
            directions.push_back(w * (1 / length(w)));
        }
    }
    return directions;
}

/// An observed count drawn towards the expected one, by as much as that is itself uncertain: its term of the chi-square statistic
/// becomes difference^2 / (expected + variance).
double discounted(double observed, double expected, double variance) {
    return expected > 0 ? expected + (observed - expected) * std::sqrt(expected / (expected + variance)) : observed;
}

Comparison compare(const LightCase& c, unsigned seed) {
    std::mt19937 generator(seed);
    const std::vector<Vec3d> directions = sampledDirections(c, generator);
    const DirectionCells cells(directions);
    std::vector<double> observed(kRows * kColumns, 0.0), expected(observed);
    double edgeObserved = 0, edgeExpected = 0, edgeVariance = 0, integral = 0;
    for (const Vec3d& w : directions) {
        const int cell = cells.indexOf(w);
        ++(cell < 0 ? edgeObserved : observed[std::size_t(cell)]);
    }
    for (int cell = 0; cell < kRows * kColumns; ++cell) {
        CellIntegral part = integrate(c, cells, cell / kColumns, cell % kColumns, kCoarse, generator);
        const bool missed = part.probability == 0 && observed[std::size_t(cell)] > 0;
        if (!part.smooth || missed) part = integrate(c, cells, cell / kColumns, cell % kColumns, kFine, generator);
        integral += part.probability;
        // Cells less than half covered make one: by the light's edge the sum over a grid knows too little of each.
        const double count = kSamples * part.probability, variance = kSamples * part.variance * kSamples;
        if (part.covered >= 0.5) {
            expected[std::size_t(cell)] = count;
            observed[std::size_t(cell)] = discounted(observed[std::size_t(cell)], count, variance);
        } else {
            edgeExpected += count;
            edgeVariance += variance;
            edgeObserved += std::exchange(observed[std::size_t(cell)], 0);
        }
    }
    const bool compareEdge = std::max(edgeExpected, edgeObserved) > 2e-3 * kSamples;
    observed.push_back(compareEdge ? discounted(edgeObserved, edgeExpected, edgeVariance) : 0);
    expected.push_back(compareEdge ? edgeExpected : 0);
    return {integral, double(directions.size()) / kSamples, chiSquareTest(observed, expected).pValue};
}

/// Of a case whatever others there are.
unsigned seedOf(const std::string& name) {
    unsigned seed = 2166136261u;
    for (const char letter : name)
        seed = (seed ^ unsigned(letter)) * 16777619u;
    return seed;
}

TEST(LightsSampling, DirectionsHaveTheDensityThatLightsName) {
    std::vector<std::string> names;
    std::vector<double> pValues;
    for (const LightCase& c : allLightCases()) {
        if (!c.meet) continue;
        const Comparison result = compare(c, seedOf(c.name));
        // The sum over directions knows edges, and the pole of an area density where a sphere is grazed, to a few 1e-3;
        // the share is taken to 5 standard deviations.
        const double deviation = std::sqrt(result.validShare * (1 - result.validShare) / kSamples);
        EXPECT_NEAR(result.integral, result.validShare, 5e-3 + 5 * deviation) << c.name;
        names.push_back(c.name);
        pValues.push_back(result.pValue);
    }
    for (std::size_t i = 0; i < names.size(); ++i)
        EXPECT_GT(pValues[i], sidakLevel(1e-3, names.size())) << names[i];
}

TEST(LightsSampling, SampleAndEvaluateAgree) {
    for (const LightCase& c : allLightCases()) {
        if (!c.meet) continue;
        std::mt19937 generator(7);
        int valid = 0, differ = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec2<float> u = {float(generator() >> 8) * 0x1p-24f, float(generator() >> 8) * 0x1p-24f};
            const LightSample<float> s = sampleLight<float>(c.lights, 0, c.from, u);
            if (!s.valid) continue;
            ++valid;
            const Vec3<float> p = s.distance == kInfinity ? Vec3<float>{} : c.from + s.wi * s.distance;
            const LightEval<float> e = evaluateLight<float>(c.lights, 0, {c.from, p, s.wi});
            // Of pictures, a point's rounding shows.
            const auto same = [](float a, float b) { return std::abs(a - b) <= 1e-4f * a; };
            const bool sameL = same(e.L.r, s.L.r) && same(e.L.g, s.L.g) && same(e.L.b, s.L.b);
            differ += !sameL || !(std::abs(e.pdf - s.pdf) <= 1e-3f * s.pdf);
        }
        EXPECT_GT(valid, 2000) << c.name;
        // Rounding may put a direction over the edge of a pixel; where a sphere is grazed, it shows in the cosine.
        EXPECT_LE(differ, valid / 500) << c.name;
    }
}

template <class F>
std::uint32_t bitsOf(const F& x, int i) {
    return floatBits(lane(x, i));
}

void expectSameBits(const LightSample<Lanes8f>& wide, int i, const LightSample<float>& one, const std::string& name) {
    EXPECT_TRUE(bitsOf(wide.wi.x, i) == floatBits(one.wi.x) && bitsOf(wide.wi.y, i) == floatBits(one.wi.y) &&
                bitsOf(wide.wi.z, i) == floatBits(one.wi.z) && bitsOf(wide.distance, i) == floatBits(one.distance) &&
                bitsOf(wide.L.r, i) == floatBits(one.L.r) && bitsOf(wide.L.g, i) == floatBits(one.L.g) &&
                bitsOf(wide.L.b, i) == floatBits(one.L.b) && bitsOf(wide.pdf, i) == floatBits(one.pdf) &&
                lane(wide.valid, i) == one.valid && lane(wide.delta, i) == one.delta)
        << name;
}

/// A table with the lights of all cases (those by area apart: they are a mode of the table), and their names.
LightTable everyLight(bool classic) {
    LightTable table;
    table.tables.classicArea = classic;
    forEachType(LightTypes{}, [&]<class T>() {
        for (const LightCase& c : LightCases<T>::make(1)) {
            T light = c.lights.rows<T>()[0];
            const std::uint32_t shift = std::uint32_t(table.tables.numbers.size());
            if constexpr (requires { light.pixels; }) light.pixels += shift;
            if constexpr (requires { light.distribution; }) light.distribution += shift;
            if constexpr (requires { light.sums; }) light.sums += shift;
            if constexpr (requires { light.picture; }) light.picture += std::uint32_t(table.tables.pictures.size());
            for (EmissionPicture picture : c.lights.tables.pictures) {
                picture.firstPixel += shift;
                table.tables.pictures.push_back(picture);
            }
            table.tables.numbers.insert(table.tables.numbers.end(), c.lights.tables.numbers.begin(),
                                        c.lights.tables.numbers.end());
            table.add(light);
        }
    });
    return table;
}

TEST(LightsSampling, EightLanesGiveTheBitsOfOne) {
    for (const bool classic : {false, true}) {
        const LightTable table = everyLight(classic);
        std::mt19937 generator(11);
        const auto signedUnit = [&] { return float(generator() >> 8) * 0x1p-23f - 1.f; };
        for (int round = 0; round < 100000 / 8; ++round) {
            const float spread = std::exp2(float(int(generator() % 16)) - 6.f);
            Vec3<Lanes8f> from;
            Lanes8u id;
            const bool oneLight = generator() % 2 == 0;
            const std::uint32_t shared = std::uint32_t(generator() % table.size());
            for (int i = 0; i < 8; ++i) {
                setLane(from.x, i, spread * signedUnit());
                setLane(from.y, i, spread * signedUnit());
                setLane(from.z, i, spread * signedUnit());
                setLane(id, i, oneLight ? shared : std::uint32_t(generator() % table.size()));
            }
            const Vec2<Lanes8f> u = randomPair(generator);
            const LightSample<Lanes8f> wide = sampleLight(table, id, from, u);
            const LightHit<Lanes8f> hit = {from, from + wide.wi * min(wide.distance, Lanes8f(1e6f)), wide.wi};
            const LightEval<Lanes8f> wideEval = evaluateLight(table, id, hit);
            for (int i = 0; i < 8; ++i) {
                const std::string name = "light " + std::to_string(lane(id, i));
                expectSameBits(
                    wide, i, sampleLight<float>(table, lane(id, i), lane(from, i), {lane(u.x, i), lane(u.y, i)}), name);
                const LightEval<float> e =
                    evaluateLight<float>(table, lane(id, i), {lane(from, i), lane(hit.p, i), lane(hit.wi, i)});
                EXPECT_TRUE(bitsOf(wideEval.pdf, i) == floatBits(e.pdf) && bitsOf(wideEval.L.r, i) == floatBits(e.L.r))
                    << name;
            }
            if (testing::Test::HasFailure()) return;
        }
    }
}

}  // namespace
}  // namespace penumbra::test
