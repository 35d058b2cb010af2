// Bumps and normal maps from scene text to pixels: against Lambert's cosine, against tilted smooth normals, and that a
// flat relief changes no bit.
#include "tests/integrators_fixture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace penumbra {
namespace {

using namespace test;

/// A square of side 2 around the origin in the plane z = 0, seen from above (+z) and lit along a direction with
/// irradiance 1 on what faces it.
std::string square(const Vec3<float>& towardsLight, const std::string& material, const std::string& more = "",
                   const std::string& uv = "0 0  1 0  1 1  0 1") {
    const auto text = [](float x) { return std::to_string(x) + " "; };
    return "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [ -.5 .5 -.5 .5 ]\n" +
           film(4, 4) +
           "PixelFilter \"box\"\nSampler \"sobol\" \"integer pixelsamples\" 4\n"
           "Integrator \"path\" \"integer maxdepth\" 1\nWorldBegin\n"
           "LightSource \"distant\" \"float illuminance\" 1 \"point3 to\" [ 0 0 0 ] \"point3 from\" [ " +
           text(towardsLight.x) + text(towardsLight.y) + text(towardsLight.z) + "]\n" + material +
           "\nShape \"trianglemesh\" \"point3 P\" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ]\n"
           "  \"integer indices\" [ 0 1 2 0 2 3 ] \"point2 uv\" [ " +
           uv + " ] " + more + "\n";
}

std::string constantMap(const TemporaryFolder& folder, const Vec3<float>& normal) {
    const auto encoded = [](float x) { return 0.5f * x + 0.5f; };
    folder.file("n.pfm", analytic::pfmImage(2, 2, std::vector<std::array<float, 3>>(
                                                      4, {encoded(normal.x), encoded(normal.y), encoded(normal.z)})));
    return "Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ] \"string normalmap\" \"n.pfm\"";
}

std::vector<double> greens(const std::string& text, const TemporaryFolder& folder) {
    const std::unique_ptr<RenderJob> job = renderText(text, {}, folder.path(""));
    EXPECT_EQ(job->counts().invalid, 0u);
    std::vector<double> list;
    for (std::size_t i = 0; i < job->film().pixelCount(); ++i)
        list.push_back(job->film().estimate(i).mean[1]);
    return list;
}

void expectAll(const std::vector<double>& values, double expected, double tolerance) {
    for (const double v : values)
        EXPECT_NEAR(v, expected, tolerance);
}

double lambert(const Vec3<float>& n, const Vec3<float>& towardsLight) {
    return std::max(double(dot(normalize(n), normalize(towardsLight))), 0.0) / M_PI;
}

const Vec3<float> kLights[] = {{0, 0, 1}, {1, 0, 1}, {-1, 2, 2}, {0.3f, -1, 0.5f}};

TEST(IntegratorsRelief, ATiltedNormalMapGivesItsCosine) {
    const TemporaryFolder folder;
    for (const Vec3<float>& light : kLights)
        for (const Vec3<float>& n : {Vec3<float>{0, 0, 1}, {0.6f, 0, 0.8f}, {0, -0.6f, 0.8f}, {0.48f, 0.36f, 0.8f}})
            expectAll(greens(square(light, constantMap(folder, n)), folder), lambert(n, light), 2e-6);
}

TEST(IntegratorsRelief, RedIsAlongUAndGreenAlongTheNormalCrossU) {
    const TemporaryFolder folder;
    const Vec3<float> n{0.48f, 0.36f, 0.8f};
    // u runs along y here, and n x u along -x; mirrored uv leave green at n x u, against v.
    for (const char* uv : {"0 1  0 0  1 0  1 1", "0 0  0 1  1 1  1 0"})
        for (const Vec3<float>& light : kLights)
            expectAll(greens(square(light, constantMap(folder, n), "", uv), folder), lambert({-n.y, n.x, n.z}, light),
                      2e-6);
}

TEST(IntegratorsRelief, ATiltedNormalMapIsATiltedSmoothNormal) {
    const TemporaryFolder folder;
    const std::string smooth = "\"normal N\" [ .48 .36 .8  .48 .36 .8  .48 .36 .8  .48 .36 .8 ]";
    for (const char* material : {"diffuse", "conductor", "coateddiffuse", "dielectric"}) {
        SCOPED_TRACE(material);
        const std::string rough = std::string("Material \"") + material + "\"" +
                                  (material == std::string("diffuse") ? "" : " \"float roughness\" .3");
        constantMap(folder, {0.48f, 0.36f, 0.8f});
        for (const Vec3<float>& light : kLights) {
            const std::vector<double> mapped =
                greens(square(light, rough + " \"string normalmap\" \"n.pfm\""), folder);
            const std::vector<double> given = greens(square(light, rough, smooth), folder);
            for (std::size_t i = 0; i < given.size(); ++i)
                EXPECT_NEAR(mapped[i], given[i], 1e-5 * (1 + given[i]));
        }
    }
}

/// The height 0.7 u over a square of side 2 rises by 0.35 a unit along x.
TEST(IntegratorsRelief, ARampGivesItsSlope) {
    const TemporaryFolder folder;
    const std::string material = "Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ] \"texture displacement\" \"d\"";
    const auto ramp = [&](const char* corners) {
        return std::string("Texture \"d\" \"float\" \"bilerp\" ") + corners + "\n" + material;
    };
    const std::string alongU = ramp("\"float v00\" 0 \"float v01\" 0 \"float v10\" .7 \"float v11\" .7");
    const std::string alongV = ramp("\"float v00\" 0 \"float v01\" -.7 \"float v10\" 0 \"float v11\" -.7");
    for (const Vec3<float>& light : kLights) {
        const auto expect = [&](const std::string& raised, const char* uv, const Vec3<float>& normal) {
            SCOPED_TRACE(uv);
            expectAll(greens(square(light, raised, "", uv), folder), lambert(normal, light), 2e-5);
        };
        expect(alongU, "0 0  1 0  1 1  0 1", {-0.35f, 0, 1});
        expect(alongV, "0 0  1 0  1 1  0 1", {0, 0.35f, 1});
        // Whichever way uv lie, the surface rises where the texture says.
        expect(alongU, "0 1  1 1  1 0  0 0", {-0.35f, 0, 1});
        expect(alongU, "0 0  0 1  1 1  1 0", {0, -0.35f, 1});
        // In half the space uv are twice as dense.
        expect(alongU, "0 0  2 0  2 2  0 2", {-0.7f, 0, 1});
    }
}

/// A texture of space is asked at displaced points: 0.3 x + 0.1 y, as a planar bilerp.
TEST(IntegratorsRelief, TexturesOfSpaceRaiseTheSurfaceToo) {
    const TemporaryFolder folder;
    const std::string material =
        "Texture \"d\" \"float\" \"bilerp\" \"float v00\" 0 \"float v01\" .1 \"float v10\" .3 \"float v11\" .4 "
        "\"string mapping\" \"planar\"\n"
        "Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ] \"texture displacement\" \"d\"";
    for (const Vec3<float>& light : kLights)
        expectAll(greens(square(light, material), folder), lambert({-0.3f, -0.1f, 1}, light), 2e-5);
}

std::string bytesOf(const RenderJob& job) {
    std::string bytes;
    for (std::size_t i = 0; i < job.film().pixelCount(); ++i) {
        const PixelEstimate e = job.film().estimate(i);
        bytes.append(reinterpret_cast<const char*>(e.mean), sizeof e.mean);
    }
    return bytes;
}

/// A ball, an ellipsoid of triangles and a floor in every material, with a lamp and a sky.
std::string relievedRoom(const std::string& relief) {
    std::string text = "LookAt 0 2 -5  0 .5 0  0 1 0\nCamera \"perspective\" \"float fov\" 45\n" + film(24, 16) +
                       "Sampler \"sobol\" \"integer pixelsamples\" 4\nWorldBegin\nLightSource \"infinite\"\n"
                       "LightSource \"point\" \"point3 from\" [ 1 4 -2 ] \"rgb I\" [ 9 9 9 ]\n"
                       "Texture \"flat\" \"float\" \"imagemap\" \"string filename\" \"flat.pfm\"\n"
                       "Texture \"rough\" \"float\" \"wrinkled\"\n"
                       "Texture \"waves\" \"float\" \"scale\" \"texture tex\" \"rough\" \"float scale\" .3\n";
    float x = -1.6f;
    for (const char* material : {"diffuse", "conductor", "dielectric", "coateddiffuse", "diffusetransmission"}) {
        text += scoped("Material \"" + std::string(material) + "\" " + relief + "\nTranslate " + std::to_string(x) +
                       " .4 0\nShape \"sphere\" \"float radius\" .4\nTranslate 0 -.4 -1\n"
                       "Shape \"trianglemesh\" \"point3 P\" [ -.4 0 -.4  .4 0 -.4  .4 .2 .4  -.4 .2 .4 ] "
                       "\"integer indices\" [ 0 2 1 0 3 2 ] \"normal N\" [ 0 1 0  .2 1 0  0 1 .3  -.2 1 0 ] "
                       "\"point2 uv\" [ 0 0  1 0  1 1  0 1 ]\n");
        x += 0.8f;
    }
    return text;
}

TEST(IntegratorsRelief, AFlatReliefChangesNoBit) {
    const TemporaryFolder folder;
    folder.file("flat.pfm", analytic::pfmImage(4, 4, std::vector<std::array<float, 3>>(16, {0.3f, 0.3f, 0.3f})));
    const auto render = [&](const std::string& relief) {
        const std::unique_ptr<RenderJob> job = renderText(relievedRoom(relief), {}, folder.path(""));
        EXPECT_EQ(job->counts().invalid, 0u);
        return bytesOf(*job);
    };
    const std::string plain = render("");
    EXPECT_EQ(render("\"texture displacement\" \"flat\""), plain);
    EXPECT_EQ(render("\"float displacement\" .7"), plain);
    EXPECT_NE(render("\"texture displacement\" \"waves\""), plain);
}

/// Whatever its relief, what loses no light reflects no more than arrives: under a sky of radiance 1 no pixel is
/// brighter.
TEST(IntegratorsRelief, TheFurnaceStaysBelowOne) {
    const TemporaryFolder folder;
    std::vector<std::array<float, 3>> hostile;
    for (int i = 0; i < 64; ++i)
        hostile.push_back({float((i * 7) % 11) / 10, float((i * 5) % 13) / 12, float((i * 3) % 8) / 7});
    folder.file("n.pfm", analytic::pfmImage(8, 8, hostile));
    RenderOptions options;
    options.build.roulette = RouletteRule::Off;
    for (const std::string relief : {"\"string normalmap\" \"n.pfm\"", "\"texture displacement\" \"waves\""})
        for (const std::string material :
             {"\"diffuse\" \"rgb reflectance\" [ 1 1 1 ]", "\"conductor\" \"rgb reflectance\" [ 1 1 1 ]",
              "\"conductor\" \"float roughness\" .3 \"rgb reflectance\" [ 1 1 1 ]", "\"thindielectric\""}) {
            const std::string text =
                "LookAt 0 0 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 45\n" + film(16, 16) +
                "PixelFilter \"box\"\nSampler \"sobol\" \"integer pixelsamples\" 16\n"
                "Integrator \"path\" \"integer maxdepth\" 20\nWorldBegin\nLightSource \"infinite\"\n"
                "Texture \"waves\" \"float\" \"wrinkled\"\nMaterial " + material + " " + relief +
                "\nShape \"sphere\"\n";
            const std::unique_ptr<RenderJob> job = renderText(text, options, folder.path(""));
            EXPECT_EQ(job->counts().invalid, 0u);
            double darkest = 1;
            for (std::size_t i = 0; i < job->film().pixelCount(); ++i) {
                const double mean = job->film().estimate(i).mean[1];
                EXPECT_LE(mean, 1 + 1e-5) << material << " " << relief;
                darkest = std::min(darkest, mean);
            }
            EXPECT_GT(darkest, 0.2) << material << " " << relief;
        }
}

}  // namespace
}  // namespace penumbra
