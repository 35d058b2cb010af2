// Cameras that are no projections of a plane: spherical ones against their definitions and an environment image; lenses
// against lens makers' formulas, a ray tracer in double precision, and the irradiance that a disk gives.
#include "core/camera/lens_system.h"

#include "tests/geometry_fixture.h"
#include "tests/integrators_fixture.h"

#include <gtest/gtest.h>

#include <fstream>

namespace penumbra {
namespace {

using namespace test;

constexpr int kWidth = 48, kHeight = 32;
const std::string kWorld = "WorldBegin\nLightSource \"infinite\"\n";

std::unique_ptr<RenderJob> jobWith(const std::string& camera, const std::string& folder = ".") {
    return prepareText(camera + "\n" + film(kWidth, kHeight) + kWorld, {}, folder);
}

Vec3d directionAt(const Camera& camera, double u, double v) {
    return widened(camera.ray<float>({float(u * kWidth), float(v * kHeight)}, {0.5f, 0.5f}, 0.f).direction);
}

void expectNear(Vec3d a, Vec3d b, double tolerance, const std::string& what = "") {
    EXPECT_LT(length(a - b), tolerance) << what << ": " << a.x << " " << a.y << " " << a.z << ", not " << b.x << " "
                                        << b.y << " " << b.z;
}

TEST(SphericalCamera, EquirectangularFollowsItsFormula) {
    const auto job = jobWith("Camera \"spherical\" \"string mapping\" \"equirectangular\"");
    Random random(1);
    for (int i = 0; i < 500; ++i) {
        const double u = 1.2 * random() - 0.1, v = 1.2 * random() - 0.1;  // filters reach over the edge
        const double theta = v * std::numbers::pi, phi = 2 * u * std::numbers::pi;
        expectNear(directionAt(job->scene().camera, u, v),
                   {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)}, 3e-6);
    }
}

TEST(SphericalCamera, EqualAreaHasTheFormatsAxesAndIsUniform) {
    const auto job = jobWith("Camera \"spherical\"");
    const Camera& camera = job->scene().camera;
    expectNear(directionAt(camera, 0.5, 0.5), {0, 1, 0}, 1e-6);
    expectNear(directionAt(camera, 1, 0.5), {1, 0, 0}, 1e-6);
    expectNear(directionAt(camera, 0.5, 1), {0, 0, 1}, 1e-6);
    for (const auto& [u, v] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}})
        expectNear(directionAt(camera, u, v), {0, -1, 0}, 1e-6);
    constexpr int n = 200;
    Vec3d sum, squares;
    for (int i = 0; i < n * n; ++i) {
        const Vec3d d = directionAt(camera, (i % n + 0.5) / n, (i / n + 0.5) / n);
        sum = sum + d;
        squares = squares + Vec3d{d.x * d.x, d.y * d.y, d.z * d.z};
    }
    expectNear(sum * (1.0 / (n * n)), {}, 1e-5, "mean");
    expectNear(squares * (1.0 / (n * n)), {1 / 3., 1 / 3., 1 / 3.}, 1e-4, "mean square");
}

TEST(SphericalCamera, TheEqualAreaMapGoesOnOverItsEdges) {
    const auto job = jobWith("Camera \"spherical\"");
    const Camera& camera = job->scene().camera;
    Random random(2);
    for (int i = 0; i < 200; ++i) {
        const double along = random(), step = 1e-4;
        for (const double edge : {0.0, 1.0}) {
            expectNear(directionAt(camera, edge - step, along), directionAt(camera, edge + step, along), 2e-3);
            expectNear(directionAt(camera, along, edge - step), directionAt(camera, along, edge + step), 2e-3);
        }
    }
}

/// The camera takes the picture that an infinite light shows, pixel for pixel.
TEST(SphericalCamera, PhotographsAnEnvironment) {
    const SceneFolder folder;
    const auto job = renderText("Camera \"spherical\"\n" + film(16, 16) +
                                    "PixelFilter \"box\" \"float xradius\" .001 \"float yradius\" .001\n"
                                    "Sampler \"independent\" \"integer pixelsamples\" 1\nWorldBegin\n"
                                    "Transform [ 1 0 0 0  0 0 1 0  0 1 0 0  0 0 0 1 ]\n"
                                    "LightSource \"infinite\" \"string filename\" \"sky.pfm\"\n",
                                {}, folder.path());
    std::vector<double> shown, made;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const double a = float(std::sin(0.9 * x + 0.4 * y)), b = float(std::cos(1.7 * y));
            made.push_back(0.4 + 0.3 * b + 0 * a);
            shown.push_back(job->film().estimate(std::size_t(16 * y + x)).mean[1]);
        }
    // The light's magnitude is scaled; its picture is not.
    const double scale = shown[0] / made[0];
    EXPECT_GT(scale, 0);
    for (std::size_t i = 0; i < made.size(); ++i)
        EXPECT_NEAR(shown[i], scale * made[i], 1e-4 * scale) << i;
}

// ---- lenses ---------------------------------------------------------------------------------------------------------

using Elements = std::vector<LensElement>;

/// Two surfaces of glass.
Elements singlet(double r1, double r2, double thickness, double eta, double diameter = 20) {
    return {{r1, thickness, eta, diameter}, {r2, 0, 1, diameter}};
}
/// All but infinitely thin, with a focal length of 50 mm and the stop right behind it.
Elements thinLens(double stop) {
    return {{50, 1e-4, 1.5, 200}, {-50, 1e-4, 1, 200}, {0, 0, 0, stop}};
}
/// Positive, negative, stop, positive: with rims so narrow that the corners see little.
const Elements kTriplet{{20, 3, 1.62, 10}, {90, 4, 1, 10},    {-40, 1.5, 1.6, 9}, {22, 2, 1, 9},
                        {0, 2, 0, 8},      {80, 3, 1.62, 10}, {-25, 0, 1, 10}};

std::string lensText(const Elements& elements) {
    std::string text = "# radius thickness index diameter\n";
    for (const LensElement& e : elements)
        text += std::to_string(e.curvatureRadius) + " " + std::to_string(e.thickness) + "\t" + std::to_string(e.eta) +
                " " + std::to_string(e.apertureDiameter) + "\n";
    return text;
}

class LensFolder {
public:
    explicit LensFolder(const Elements& elements) { folder_.file("lens.dat", lensText(elements)); }
    std::unique_ptr<RenderJob> job(const std::string& parameters) const {
        return jobWith("Camera \"realistic\" \"string lensfile\" \"lens.dat\" " + parameters, folder_.path(""));
    }
    const TemporaryFolder& folder() const { return folder_; }

private:
    TemporaryFolder folder_;
};

TEST(Lens, FocalLengthAndPrincipalPlanesAreTheLensMakers) {
    const double r1 = 80, r2 = -120, t = 12, n = 1.6;
    const ThickLens lens = thickLensOf(singlet(r1, r2, t, n));
    const double f = 1 / ((n - 1) * (1 / r1 - 1 / r2 + (n - 1) * t / (n * r1 * r2)));
    EXPECT_NEAR(lens.focalLength, f, 1e-9 * f);
    EXPECT_NEAR(lens.frontPrincipal, -f * (n - 1) * t / (r2 * n), 1e-9 * t);
    EXPECT_NEAR(lens.rearPrincipal, -f * (n - 1) * t / (r1 * n), 1e-9 * t);
    // Two thin lenses: 1/f = 1/a + 1/b - d/(a b).
    Elements pair = thinLens(100);
    pair.back() = {0, 30, 0, 100};
    const Elements second = singlet(90, -90, 1e-9, 1.5, 100);
    pair.insert(pair.end(), second.begin(), second.end());
    EXPECT_NEAR(thickLensOf(pair).focalLength, 1 / (1 / 50. + 1 / 90. - 30 / (50. * 90.)), 1e-3);
}

TEST(Lens, IsFocusedByTheThickLensEquation) {
    for (const double distance : {400., 2000., 1e6}) {
        const ThickLens lens = thickLensOf(kTriplet);
        const double image = filmDistance(lens, distance) - lens.rearPrincipal;
        const double gap = lens.length + lens.rearPrincipal - lens.frontPrincipal, object = distance - gap - image;
        EXPECT_NEAR(1 / image + 1 / object, 1 / lens.focalLength, 1e-12);
        EXPECT_LT(image, object) << "the lens stands near the film";
    }
    EXPECT_THROW(filmDistance(thickLensOf(thinLens(1)), 199), Error);
    EXPECT_NO_THROW(filmDistance(thickLensOf(thinLens(1)), 201));
    EXPECT_THROW(filmDistance(thickLensOf(singlet(-50, 50, 1, 1.5)), 1e4), Error) << "diverges";
}

/// The way of a ray in double, by the centres of the spheres; nothing where it is stopped.
std::optional<ExactHit> traceExactly(const Elements& elements, double distance, Vec3d p, Vec3d d) {
    double vertex = distance;
    for (std::size_t i = elements.size(); i-- > 0;) {
        const LensElement& e = elements[i];
        if (i + 1 < elements.size()) vertex += e.thickness;
        if (e.curvatureRadius == 0) {
            p = p + d * ((vertex - p.z) / d.z);
        } else {
            const Vec3d center{0, 0, vertex - e.curvatureRadius}, q = p - center;
            const double b = dot(q, d), root = b * b - dot(q, q) + e.curvatureRadius * e.curvatureRadius;
            if (root < 0) return {};
            const double near = -b - std::sqrt(root), far = -b + std::sqrt(root);
            p = p + d * (e.curvatureRadius > 0 ? far : near);
            Vec3d n = normalized(p - center);
            if (dot(n, d) > 0) n = n * -1;
            const double ratio = (e.eta ? e.eta : 1) / (i > 0 && elements[i - 1].eta ? elements[i - 1].eta : 1);
            const double cosine = -dot(n, d), sine2 = ratio * ratio * (1 - cosine * cosine);
            if (sine2 > 1) return {};
            d = d * ratio + n * (ratio * cosine - std::sqrt(1 - sine2));
        }
        if (std::hypot(p.x, p.y) > e.apertureDiameter / 2) return {};
    }
    ExactHit hit;
    hit.p = p, hit.ng = d;
    return hit;
}

TEST(Lens, TracesWhatATracerInDoubleTraces) {
    const double distance = filmDistance(thickLensOf(kTriplet), 1500);
    const LensSystem lens(kTriplet, distance, {});
    Random random(4);
    int through = 0, disagree = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3d from{30 * random() - 15, 30 * random() - 15, 0}, to = random.inCube(7) + Vec3d{0, 0, distance};
        const Vec3d d = normalized(to - from);
        if (d.z <= 0) continue;
        const LensRay<float> r = lens.trace(rounded(from), rounded(d));
        const std::optional<ExactHit> exact = traceExactly(kTriplet, distance, widened(rounded(from)), d);
        if ((r.weight > 0) != exact.has_value()) {
            ++disagree;  // at a rim
            continue;
        }
        if (!exact) continue;
        ++through;
        EXPECT_EQ(r.weight, 1.f);
        expectNear(widened(r.origin), exact->p, 1e-4);
        expectNear(widened(r.direction), exact->ng, 2e-5);
    }
    EXPECT_GT(through, 500);
    EXPECT_LE(disagree, 2);
}

/// In the limit of a thin lens: all rays of a point of the film meet where the lens equation says.
TEST(RealisticCamera, IsAThinLensWhereTheLensIsThin) {
    const LensFolder folder(thinLens(1));
    const auto job = folder.job("\"float aperturediameter\" 1 \"float focusdistance\" 1");
    const double a = (1000 + std::sqrt(1000. * 800)) / 2, b = 1000 - a;  // a + b = 1000, a b = 50 * 1000
    const double width = 35 / std::sqrt(1 + std::pow(double(kHeight) / kWidth, 2));
    Random random(5);
    int live = 0;
    for (int i = 0; i < 500; ++i) {
        const float px = float(kWidth * random()), py = float(kHeight * random());
        const CameraRay<float> r = job->scene().camera.ray<float>({px, py}, {float(random()), float(random())}, 0.f);
        if (!(r.weight > 0)) continue;
        ++live;
        // Millimetres on the film; metres in the scene, x to the right and y up.
        const double x = (px / kWidth - 0.5) * width, y = (0.5 - py / kHeight) * width * kHeight / kWidth;
        const Vec3d focus{x * a / b * 1e-3, y * a / b * 1e-3, 1};
        const Vec3d met = widened(r.origin) + widened(r.direction) * ((1 - r.origin.z) / double(r.direction.z));
        // Off the axis a thin lens is not sharp: what is in focus lies on bowls, of which the narrower is curved by
        // less than 4 / f. So a ray half a mm from the axis strays by 0.5 mm x 2 angle^2 x a / b, and a bit.
        const double angle = std::hypot(x, y) / b;
        EXPECT_LT(length(met - focus), 1e-5 + 0.5e-3 * 2.2 * angle * angle * a / b) << x << " " << y;
        EXPECT_NEAR(r.origin.z, b * 1e-3, 1e-4);
        EXPECT_LT(std::hypot(r.origin.x, r.origin.y), 0.501e-3);
    }
    EXPECT_GT(live, 300);
}

/// Irradiance from a disk of radiance 1, parallel to the film, at a point off its axis (e.g. Howell's catalogue, B-12).
double irradianceOfDisk(double radius, double distance, double offset) {
    const double r2 = radius * radius, z2 = distance * distance, o2 = offset * offset, sum = o2 + z2 + r2;
    return std::numbers::pi / 2 * (1 - (o2 + z2 - r2) / std::sqrt(sum * sum - 4 * o2 * r2));
}

/// The mean weight of a point of the film, over a grid of lens numbers.
double meanWeight(const Camera& camera, float px, float py) {
    constexpr int n = 256;
    double sum = 0;
    for (int i = 0; i < n * n; ++i)
        sum += camera.ray<float>({px, py}, {(float(i % n) + 0.5f) / n, (float(i / n) + 0.5f) / n}, 0.f).weight;
    return sum / (n * n);
}

TEST(RealisticCamera, WeighsRaysByTheIrradianceOfItsStop) {
    const LensFolder folder(thinLens(40));
    for (const double stop : {0.5, 8., 30.}) {
        const auto job = folder.job("\"float focusdistance\" 3 \"float aperturediameter\" " + std::to_string(stop));
        const double b = filmDistance(thickLensOf(thinLens(stop)), 3000);
        const double pixel = 35 / std::hypot(kWidth, kHeight);
        for (const auto& [px, py] : {std::pair{24.f, 16.f}, {30.f, 16.f}, {5.f, 3.f}, {48.f, 32.f}}) {
            const double offset = std::hypot(px - 24, py - 16) * pixel;
            const double exact = irradianceOfDisk(stop / 2, b, offset);
            EXPECT_NEAR(meanWeight(job->scene().camera, px, py), exact, 0.01 * exact) << stop << " at " << offset;
        }
    }
}

/// Whatever rectangle rays are sent to, as much light comes through as through the whole rear element.
TEST(RealisticCamera, PupilsMissNoLight) {
    const LensFolder folder(kTriplet);
    const auto job = folder.job("\"float focusdistance\" 2 \"float aperturediameter\" 8");
    const LensSystem lens(kTriplet, filmDistance(thickLensOf(kTriplet), 2000), {});
    const double pixel = 35 / std::hypot(kWidth, kHeight), z = lens.rearZ();
    double center = 0;
    for (const float px : {24.f, 32.f, 40.f, 44.f, 47.f}) {
        const double x = (24 - px) * pixel;
        constexpr int n = 400;
        constexpr double reach = 9;
        double sum = 0;
        for (int i = 0; i < n * n; ++i) {
            const Vec3d to{reach * (2 * (i % n + 0.5) / n - 1), reach * (2 * (i / n + 0.5) / n - 1), z};
            const Vec3d d = normalized(to - Vec3d{x, 0, 0});
            sum += lens.trace<float>({float(x), 0, 0}, rounded(d)).weight * std::pow(d.z, 4);
        }
        const double whole = sum / (n * n) * 4 * reach * reach / (z * z);
        const double ours = meanWeight(job->scene().camera, px, 16);
        EXPECT_NEAR(ours, whole, 0.015 * whole + 1e-5) << px;
        if (px == 24) center = whole;
        if (px == 47) {
            EXPECT_LT(whole, 0.75 * center) << "nothing is vignetted";
        }
    }
}

TEST(RealisticCamera, ShapesOfTheStopLetThroughAsMuchAsARoundOne) {
    const LensFolder folder(thinLens(8));
    const double exact = irradianceOfDisk(4, filmDistance(thickLensOf(thinLens(8)), 3000), 0);
    // A bright and a dark half.
    folder.folder().file("half.pfm", analytic::pfmImage(2, 1, {{1, 1, 1}, {0, 0, 0}}));
    for (const char* shape : {"gaussian", "square", "pentagon", "star", "half.pfm"}) {
        const auto job = folder.job("\"float aperturediameter\" 8 \"float focusdistance\" 3 \"string aperture\" \"" +
                                    std::string(shape) + "\"");
        const double mean = meanWeight(job->scene().camera, 24, 16);
        // The half of an image is that of a square, of which the round rim leaves less.
        const bool isImage = std::string(shape) == "half.pfm";
        EXPECT_NEAR(mean, isImage ? mean : exact, 0.02 * exact) << shape;
        if (!isImage) continue;
        Random random(6);
        for (int i = 0; i < 300; ++i) {
            const CameraRay<float> r =
                job->scene().camera.ray<float>({24, 16}, {float(random()), float(random())}, 0.f);
            if (r.origin.x > 2.1e-3f) {
                EXPECT_EQ(r.weight, 0.f) << "the right of the image is dark";
            }
        }
    }
}

TEST(RealisticCamera, AUniformWorldShowsTheIrradianceOfTheStop) {
    const LensFolder folder(thinLens(20));
    RenderOptions options;
    options.build.samplesOverride = 4096;
    const auto job =
        renderText("Camera \"realistic\" \"string lensfile\" \"lens.dat\" \"float aperturediameter\" 20\n" +
                       film(2, 2) + "PixelFilter \"box\"\n" + kWorld,
                   options, folder.folder().path(""));
    const PixelEstimate e = job->film().estimate(0);
    // What the lens keeps out, the corners of the square about its stop, is black but not empty, as the sky is.
    EXPECT_NEAR(e.alpha, 1 - std::numbers::pi / 4, 0.04);
    const double b = filmDistance(thickLensOf(thinLens(20)), 10000), half = 35 / std::sqrt(8.);
    double mean = 0;
    constexpr int n = 40;
    for (int i = 0; i < n * n; ++i)
        mean += irradianceOfDisk(10, b, half * std::hypot((i % n + 0.5) / n, (i / n + 0.5) / n)) / (n * n);
    EXPECT_NEAR(e.mean[1], mean, 5 * e.standardError[1]);
    EXPECT_LT(e.standardError[1], 0.02 * mean);
}

TEST(RealisticCamera, SaysWhatIsWrong) {
    const LensFolder folder(thinLens(8));
    const TemporaryFolder& files = folder.folder();
    files.file("five.dat", "1 2 3 4 5");
    files.file("word.dat", "1 2 3 four");
    files.file("flat.dat", "0 1 1 5");
    files.file("negative.dat", "50 1 1.5 -5");
    const auto errorOf = [&](const std::string& parameters) {
        try {
            jobWith("Camera \"realistic\" " + parameters, files.path(""));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const auto lens = [](const std::string& file) { return "\"string lensfile\" \"" + file + "\""; };
    const auto expectPart = [&](const std::string& parameters, const std::string& part) {
        const std::string error = errorOf(parameters);
        EXPECT_NE(error.find(part), std::string::npos) << error;
        EXPECT_EQ(error.rfind("test.pbrt:1:1: ", 0), 0u) << error;
    };
    expectPart("", "camera 'realistic': the parameter \"string lensfile\" is missing");
    expectPart(lens("none.dat"), "none.dat");
    expectPart(lens("five.dat"), "there are 5 numbers");
    expectPart(lens("word.dat"), "word.dat:1:7: expected a finite number, found 'four'");
    expectPart(lens("flat.dat"), "no surface of the lens is curved");
    expectPart(lens("negative.dat"), "surface 1: diameter -5 is not above 0");
    expectPart(lens("lens.dat") + " \"float focusdistance\" .1", "cannot be focused on 100 mm: at least 200 mm");
    expectPart(lens("lens.dat") + " \"float aperturediameter\" 9", "opens to 8 mm, not to 9 mm");
    expectPart(lens("lens.dat") + " \"string aperture\" \"sqare\"", "aperture 'sqare' is none of gaussian, square");
}

}  // namespace
}  // namespace penumbra
