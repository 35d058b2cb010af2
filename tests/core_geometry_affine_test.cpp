// Affine maps over lanes against 4x4 matrices in double; motion against the format's definition: translation and
// stretch linear, rotation at a constant rate the short way round.
#include "core/math/affine.h"

#include "tests/geometry_fixture.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

using namespace test;

double largestDifference(const Matrix4& a, const Matrix4& b) {
    double worst = 0;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 4; ++c)
            worst = std::max(worst, std::abs(a.m[r][c] - b.m[r][c]));
    return worst;
}

/// What affineAt gives, as a matrix.
Matrix4 matrixAt(const std::vector<Matrix4>& motion, float time) {
    std::vector<AffineRecord> table;
    for (const Matrix4& m : motion)
        table.push_back(toRecord(m));
    const Affine<float> a = affineAt<float>(table.data(), 0u, std::uint32_t(table.size() - 1), time);
    Matrix4 m;
    const Vec3<float> columns[4] = {a.x, a.y, a.z, a.origin};
    for (std::size_t c = 0; c < 4; ++c)
        m.m[0][c] = columns[c].x, m.m[1][c] = columns[c].y, m.m[2][c] = columns[c].z;
    return m;
}

TEST(Affine, PointsVectorsAndNormalsAgreeWithMatrices) {
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        Matrix4 m = translation(5 * random(), -3, 2) * rotation(360 * random(), random(), random(), 1) *
                    scaling(0.2 + random(), i % 2 ? -1 : 1, 2 * random() + 0.1) *
                    rotation(360 * random(), 1, random(), 0);
        const AffineRecord record = toRecord(m);
        m = ExactSearch::matrixOf(record);
        Matrix4 inverse;
        ASSERT_TRUE(invert(m, inverse));
        const Affine<float> a = loadAffine<float>(&record, 0u);
        const Vec3<float> v = rounded(random.inCube(3));
        const Vec3d p = widened(a.point(v)), exact = transformPoint(m, widened(v));
        const Vec3<float> bound = a.pointError(v, {0, 0, 0});
        EXPECT_LE(std::abs(p.x - exact.x), bound.x);
        EXPECT_LE(std::abs(p.y - exact.y), bound.y);
        EXPECT_LE(std::abs(p.z - exact.z), bound.z);
        EXPECT_LT(length(widened(a.vector(v)) - transformVector(m, widened(v))), 1e-5);
        const Vec3d n = normalized(transformVector(transpose(inverse), widened(v)));
        EXPECT_LT(length(normalized(widened(a.normal(v))) - n), 2e-5) << "mirrored: " << i % 2;
    }
}

TEST(Affine, LanesHaveTheirOwnMatrixAndTime) {
    std::vector<AffineRecord> table;
    Random random(2);
    for (int i = 0; i < 20; ++i)
        table.push_back(toRecord(translation(i, random(), 0) * rotation(20 * i, 0, 1, 1)));
    Lanes8u first, segments;
    Lanes8f time;
    for (int k = 0; k < 8; ++k) {
        setLane(first, k, std::uint32_t(2 * k));
        setLane(segments, k, std::uint32_t(k % 4));  // some stand still
        setLane(time, k, k == 7 ? 1.f : float(random()));
    }
    const Affine<Lanes8f> wide = affineAt<Lanes8f>(table.data(), first, segments, time);
    for (int k = 0; k < 8; ++k) {
        const Affine<float> one = affineAt<float>(table.data(), lane(first, k), lane(segments, k), lane(time, k));
        for (const auto& [a, b] :
             {std::pair{&wide.x, &one.x}, {&wide.y, &one.y}, {&wide.z, &one.z}, {&wide.origin, &one.origin}}) {
            EXPECT_EQ(lane(a->x, k), b->x);
            EXPECT_EQ(lane(a->y, k), b->y);
            EXPECT_EQ(lane(a->z, k), b->z);
        }
    }
}

/// A turn about a fixed axis is what slerp makes of its ends.
TEST(Motion, TurnsAtAConstantRate) {
    Random random(3);
    for (const double degrees : {0.3, 10.0, 90.0, 179.0})
        for (const double mirror : {1.0, -1.0}) {
            const Vec3d axis = random.inCube(1);
            const Matrix4 s0 = scaling(1, 1.5, 0.7 * mirror), s1 = scaling(2, 1, 0.9 * mirror);
            const auto at = [&](double t) {
                Matrix4 s = s0;
                for (std::size_t i = 0; i < 3; ++i)
                    s.m[i][i] = (1 - t) * s0.m[i][i] + t * s1.m[i][i];
                return translation(3 * t, -2 * t, 1) * rotation(degrees * t, axis.x, axis.y, axis.z) * s;
            };
            const std::vector<Matrix4> motion = motionMatrices(at(0), at(1));
            ASSERT_LE(motion.size(), 129u);
            EXPECT_EQ(motion.front(), at(0));
            EXPECT_EQ(motion.back(), at(1));
            for (const double t : {0.0, 0.1, 0.25, 1 / 3., 0.5, 0.77, 0.999, 1.0})
                EXPECT_LT(largestDifference(matrixAt(motion, float(t)), at(float(t))), degrees < 100 ? 3e-5 : 1.5e-4)
                    << degrees << " degrees at " << t;
        }
}

TEST(Motion, TakesTheShortWayRound) {
    const std::vector<Matrix4> motion = motionMatrices(Matrix4{}, rotation(200, 0, 0, 1));
    EXPECT_LT(largestDifference(matrixAt(motion, 0.5f), rotation(-80, 0, 0, 1)), 5e-5);
}

TEST(Motion, ShiftsInOneSegmentAndStandsStillInNone) {
    EXPECT_EQ(motionMatrices(translation(1, 2, 3), translation(1, 2, 3)).size(), 1u);
    const std::vector<Matrix4> motion = motionMatrices(translation(1, 2, 3), translation(5, 2, -1));
    EXPECT_EQ(motion.size(), 2u);
    EXPECT_LT(largestDifference(matrixAt(motion, 0.25f), translation(2, 2, 2)), 1e-6);
}

}  // namespace
}  // namespace penumbra
