// Camera rays against the definitions of the pbrt-v4 format in double precision, through scene text: projections,
// windows, lens, shutter and motion.
#include "core/camera/camera.h"

#include "tests/geometry_fixture.h"
#include "tests/integrators_fixture.h"

#include <gtest/gtest.h>

#include <functional>

namespace penumbra {
namespace {

using namespace test;

struct ExactRay {
    Vec3d origin, direction;
};

/// A camera of the format, in its own words.
struct Definition {
    bool perspective = true;
    double fov = 90, x0 = -1, x1 = 1, y0 = -1, y1 = 1;
    double lensRadius = 0, focalDistance = 1e6;
    int width = 48, height = 32;

    /// In camera space: +x right, +y up, +z forward; raster row 0 is the top.
    ExactRay ray(double px, double py, double u, double v) const {
        const double x = x0 + px / width * (x1 - x0), y = y1 - py / height * (y1 - y0);
        const double scale = std::tan(fov / 2 * std::numbers::pi / 180);
        ExactRay r =
            perspective ? ExactRay{{0, 0, 0}, normalized({x * scale, y * scale, 1})} : ExactRay{{x, y, 0}, {0, 0, 1}};
        if (lensRadius == 0) return r;
        const Vec3d focus = r.origin + r.direction * (focalDistance / r.direction.z);
        r.origin = r.origin + onDisk(u, v) * lensRadius;
        r.direction = normalized(focus - r.origin);
        return r;
    }
    /// The concentric map.
    static Vec3d onDisk(double u, double v) {
        const double x = 2 * u - 1, y = 2 * v - 1, quarter = std::numbers::pi / 4;
        if (x == 0 && y == 0) return {};
        const bool wide = std::abs(x) > std::abs(y);
        const double r = wide ? x : y, theta = wide ? quarter * y / x : 2 * quarter - quarter * x / y;
        return {r * std::cos(theta), r * std::sin(theta), 0};
    }
};

/// The frame of LookAt: the camera's axes and place in the world.
struct Frame3 {
    Vec3d right, up, forward, eye;
    static Frame3 lookAt(Vec3d eye, Vec3d look, Vec3d up) {
        const Vec3d f = normalized(look - eye), r = normalized(cross(normalized(up), f));
        return {r, cross(f, r), f, eye};
    }
    Vec3d vector(Vec3d v) const { return right * v.x + up * v.y + forward * v.z; }
    ExactRay ray(const ExactRay& r) const { return {eye + vector(r.origin), vector(r.direction)}; }
};

std::unique_ptr<RenderJob> jobWith(const std::string& camera, const std::string& filmText = film(48, 32)) {
    return prepareText(camera + "\n" + filmText + "WorldBegin\nLightSource \"infinite\"\n");
}

void expectRays(const Camera& camera, const std::function<ExactRay(double, double, double, double, double)>& exact,
                double tolerance = 2e-6) {
    Random random(1);
    for (int i = 0; i < 500; ++i) {
        const Vec2<float> raster = {float(48 * random()), float(32 * random())},
                          lens = {float(random()), float(random())};
        const float shutter = float(random());
        const CameraRay<float> ray = camera.ray(raster, lens, shutter);
        const ExactRay want = exact(raster.x, raster.y, lens.x, lens.y, shutter);
        EXPECT_LT(length(widened(ray.origin) - want.origin), tolerance * (1 + length(want.origin)));
        EXPECT_LT(length(widened(ray.direction) - want.direction), tolerance);
    }
}

const Frame3 kView = Frame3::lookAt({1, 2, -3}, {0.5, 0, 1}, {0.1, 1, 0.3});
const std::string kLookAt = "LookAt 1 2 -3  .5 0 1  .1 1 .3\n";

void expectStill(const std::string& camera, const Definition& d, const std::string& filmText = film(48, 32)) {
    const auto job = jobWith(kLookAt + camera, filmText);
    expectRays(job->scene().camera,
               [&](double x, double y, double u, double v, double) { return kView.ray(d.ray(x, y, u, v)); });
}

TEST(Camera, Perspective) {
    Definition d;
    d.x0 = -1.5, d.x1 = 1.5;  // the shorter axis spans the field of view
    d.fov = 40;
    expectStill("Camera \"perspective\" \"float fov\" 40", d);
    d.fov = 90;
    expectStill("Camera \"perspective\"", d);
}

TEST(Camera, PortraitPictures) {
    Definition d;
    d.width = 20, d.height = 32;
    d.y0 = -1.6, d.y1 = 1.6;
    expectStill("Camera \"perspective\"", d, film(20, 32));
}

TEST(Camera, AspectAndWindow) {
    Definition d;
    d.x0 = -2, d.x1 = 2;
    expectStill("Camera \"perspective\" \"float frameaspectratio\" 2", d);
    d.x0 = -1, d.x1 = 1, d.y0 = -4, d.y1 = 4;
    expectStill("Camera \"perspective\" \"float frameaspectratio\" .25", d);
    d.x0 = -0.5, d.x1 = 1, d.y0 = 0.25, d.y1 = 2, d.fov = 60;
    expectStill("Camera \"perspective\" \"float fov\" 60 \"float screenwindow\" [ -.5 1 .25 2 ]", d);
}

TEST(Camera, Orthographic) {
    Definition d;
    d.perspective = false;
    d.x0 = -1.5, d.x1 = 1.5;
    expectStill("Camera \"orthographic\"", d);
    d.x0 = -3, d.x1 = 2, d.y0 = 0, d.y1 = 5;
    expectStill("Camera \"orthographic\" \"float screenwindow\" [ -3 2 0 5 ]", d);
}

TEST(Camera, ThinLens) {
    Definition d;
    d.x0 = -1.5, d.x1 = 1.5;
    d.fov = 50, d.lensRadius = 0.2, d.focalDistance = 4;
    expectStill("Camera \"perspective\" \"float fov\" 50 \"float lensradius\" .2 \"float focaldistance\" 4", d);
    d.perspective = false;  // about the ray, not about the axis
    expectStill("Camera \"orthographic\" \"float lensradius\" .2 \"float focaldistance\" 4", d);
}

/// All rays of a point of the picture meet in the plane of focus, and fill the lens evenly.
TEST(Camera, RaysMeetInThePlaneOfFocus) {
    const auto job = jobWith("Camera \"perspective\" \"float lensradius\" .3 \"float focaldistance\" 5");
    const auto at5 = [](const CameraRay<float>& r) {
        return widened(r.origin) + widened(r.direction) * ((5 - r.origin.z) / double(r.direction.z));
    };
    Random random(2);
    Vec3d sum;
    double squares = 0;
    for (int i = 0; i < 4096; ++i) {
        const CameraRay<float> r =
            job->scene().camera.ray<float>({10, 20}, {(float(i % 64) + 0.5f) / 64, (float(i / 64) + 0.5f) / 64}, 0.f);
        EXPECT_LT(length(at5(r) - at5(job->scene().camera.ray<float>({10, 20}, {0.5f, 0.5f}, 0.f))), 1e-5);
        sum = sum + widened(r.origin);
        squares += dot(widened(r.origin), widened(r.origin));
    }
    EXPECT_LT(length(sum) / 4096, 1e-6);
    EXPECT_NEAR(squares / 4096, 0.3 * 0.3 / 2, 1e-4);  // the mean of r^2 over a disk
}

/// Polygons of blades: uniform (the polar moment of a regular polygon), inside the circle, one corner up.
TEST(Camera, BladedApertures) {
    for (const int n : {3, 5, 8}) {
        const auto job = jobWith(
            "Camera \"perspective\" \"float lensradius\" .3 \"float focaldistance\" 5 \"integer apertureblades\" " +
            std::to_string(n));
        constexpr int kSide = 200;
        double squares = 0, highest = 0, lowest = 0;
        Vec3d sum;
        for (int i = 0; i < kSide * kSide; ++i) {
            const Vec2<float> u{(float(i % kSide) + 0.5f) / kSide, (float(i / kSide) + 0.5f) / kSide};
            const Vec3d q = widened(job->scene().camera.ray<float>({24, 16}, u, 0.f).origin) * (1 / 0.3);
            squares += dot(q, q);
            sum = sum + q;
            highest = std::max(highest, q.y), lowest = std::min(lowest, q.y);
        }
        const double step = 2 * std::numbers::pi / n;
        EXPECT_NEAR(squares / (kSide * kSide), (2 + std::cos(step)) / 6, 2e-3);
        EXPECT_LT(length(sum) / (kSide * kSide), 2e-3);
        EXPECT_NEAR(highest, 1, 0.02);
        EXPECT_NEAR(lowest, n % 2 ? -std::cos(step / 2) : -1, 0.02);
    }
}

/// Times: uniform while the shutter is open, in terms of the transform times, and held at their ends.
TEST(Camera, Shutter) {
    const std::string mesh =
        "AttributeBegin\nActiveTransform EndTime\nTranslate 1 0 0\nActiveTransform All\n"
        "Shape \"sphere\"\nAttributeEnd\n";
    const auto time = [&](const std::string& text, float u) {
        const auto job = prepareText(text + film(48, 32) + "WorldBegin\nLightSource \"infinite\"\n" + mesh);
        return job->scene().camera.ray<float>({1, 1}, {0.5f, 0.5f}, u).time;
    };
    const std::string camera = "Camera \"perspective\" \"float shutteropen\" .25 \"float shutterclose\" .75\n";
    EXPECT_FLOAT_EQ(time(camera, 0.f), 0.25f);
    EXPECT_FLOAT_EQ(time(camera, 0.5f), 0.5f);
    EXPECT_FLOAT_EQ(time("TransformTimes 0 2\n" + camera, 0.5f), 0.25f);
    EXPECT_FLOAT_EQ(time("TransformTimes .5 1\n" + camera, 0.f), 0.f);
    EXPECT_FLOAT_EQ(time("TransformTimes .5 1\n" + camera, 1.f), 0.5f);
}

/// A camera that is shifted and turned while the shutter is open: the shift linear, the turn at a constant rate.
TEST(Camera, Motion) {
    // CTM = camera-from-world, so what is written last acts first: the world passes by the camera.
    const auto job = jobWith(
        "ActiveTransform EndTime\nRotate -30 0 1 0\nTranslate -2 0 -1\nActiveTransform All\n"
        "Camera \"perspective\" \"float fov\" 50 \"float screenwindow\" [ -1 1 -1 1 ]");
    Definition d;
    d.fov = 50;
    expectRays(
        job->scene().camera,
        [&](double x, double y, double u, double v, double t) {
            const Matrix4 world = translation(2 * t, 0, t) * rotation(30 * t, 0, 1, 0);
            const ExactRay r = d.ray(x, y, u, v);
            return ExactRay{transformPoint(world, r.origin), transformVector(world, r.direction)};
        },
        2e-5);
}

class CameraLanes : public testing::TestWithParam<const char*> {};

TEST_P(CameraLanes, EightLanesGiveTheBitsOfOne) {
    const TemporaryFolder folder;
    folder.file("lens.dat", "30 5 1.6 20\n 0 3 0 10\n 200 3 1.6 12\n -60 0 1 12\n");
    const auto job =
        prepareText("ActiveTransform EndTime\nRotate -30 0 1 0\nTranslate -2 0 -1\nActiveTransform All\n" + kLookAt +
                        "Camera " + GetParam() + film(48, 32) + "WorldBegin\nLightSource \"infinite\"\n",
                    {}, folder.path(""));
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        Vec2<Lanes8f> raster, lens;
        Lanes8f shutter;
        float numbers[8][5];
        for (int k = 0; k < 8; ++k) {
            for (float& x : numbers[k])
                x = float(random());
            setLane(raster.x, k, 48 * numbers[k][0]), setLane(raster.y, k, 32 * numbers[k][1]);
            setLane(lens.x, k, numbers[k][2]), setLane(lens.y, k, numbers[k][3]);
            setLane(shutter, k, numbers[k][4]);
        }
        const CameraRay<Lanes8f> wide = job->scene().camera.ray(raster, lens, shutter);
        for (int k = 0; k < 8; ++k) {
            const float* n = numbers[k];
            const CameraRay<float> one = job->scene().camera.ray<float>({48 * n[0], 32 * n[1]}, {n[2], n[3]}, n[4]);
            EXPECT_EQ(lane(wide.origin.x, k), one.origin.x);
            EXPECT_EQ(lane(wide.origin.y, k), one.origin.y);
            EXPECT_EQ(lane(wide.origin.z, k), one.origin.z);
            EXPECT_EQ(lane(wide.direction.x, k), one.direction.x);
            EXPECT_EQ(lane(wide.direction.y, k), one.direction.y);
            EXPECT_EQ(lane(wide.direction.z, k), one.direction.z);
            EXPECT_EQ(lane(wide.time, k), one.time);
            EXPECT_EQ(lane(wide.weight, k), one.weight);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Types, CameraLanes,
    testing::Values("\"perspective\" \"float lensradius\" .1 \"float focaldistance\" 3 ",
                    "\"orthographic\" \"float lensradius\" .1 \"integer apertureblades\" 6 ", "\"spherical\" ",
                    "\"spherical\" \"string mapping\" \"equirectangular\" ",
                    "\"realistic\" \"string lensfile\" \"lens.dat\" \"float aperturediameter\" 8 ",
                    "\"realistic\" \"string lensfile\" \"lens.dat\" \"string aperture\" \"star\" "));

}  // namespace
}  // namespace penumbra
