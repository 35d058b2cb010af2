// What the tests of integrators share: scenes from short texts, rendered through the job that the program uses, and the
// two scenes in which everything happens at once.
#pragma once

#include "app/batch/render_job.h"
#include "scenes/analytic/scene_text.h"
#include "scenes/readers.h"
#include "tests/measured_file.h"
#include "tests/temporary_folder.h"

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace penumbra::test {

using analytic::scoped;

/// Reads and builds. A warning ends in an Error: these scenes have to mean what they say.
inline std::unique_ptr<RenderJob> prepareText(const std::string& text, const RenderOptions& options = {},
                                              const std::string& folder = ".") {
    Warnings warnings(true);
    return std::make_unique<RenderJob>(readSceneText(text, "test.pbrt", folder, warnings), options, warnings);
}

inline std::unique_ptr<RenderJob> renderText(const std::string& text, const RenderOptions& options = {},
                                             const std::string& folder = ".") {
    std::unique_ptr<RenderJob> job = prepareText(text, options, folder);
    job->run();
    return job;
}

inline std::string film(int width, int height) {
    return "Film \"rgb\" \"integer xresolution\" " + std::to_string(width) + " \"integer yresolution\" " +
           std::to_string(height) + "\n";
}

/// A folder with the files that the scenes below use: sky.pfm (an equal-area map), wood.pfm and metal.bsdf.
class SceneFolder {
public:
    SceneFolder() {
        folder_.file("sky.pfm", image(16));
        folder_.file("wood.pfm", image(8));
        MeasuredMetal metal;
        metal.nodes = 8;
        const std::vector<char> measured = measuredFile(metal);
        folder_.file("metal.bsdf", std::string_view(measured.data(), measured.size()));
    }
    std::string path() const { return folder_.path(""); }
    std::string path(const std::string& name) const { return folder_.path(name); }

private:
    static std::string image(int n) {
        std::vector<std::array<float, 3>> pixels;
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const float a = float(std::sin(0.9 * x + 0.4 * y)), b = float(std::cos(1.7 * y));
                pixels.push_back({0.45f + 0.4f * a, 0.4f + 0.3f * b, 0.35f + 0.2f * a * b});
            }
        return analytic::pfmImage(n, n, pixels);
    }

    TemporaryFolder folder_;
};

/// Every kind of light and of material, textures, holes, a lens and a filter with negative lobes; nothing moves. 36 x 28
/// pixels.
inline std::string roomText(const std::string& sampler = "sobol", int samples = 8) {
    return "LookAt 0 1.1 -4.5  0 .8 0  0 1 0\n"
           "Camera \"perspective\" \"float fov\" 55 \"float lensradius\" .05 \"float focaldistance\" 4.5\n" +
           film(36, 28) + "PixelFilter \"mitchell\"\nIntegrator \"path\" \"integer maxdepth\" 9\nSampler \"" + sampler +
           "\" \"integer pixelsamples\" " + std::to_string(samples) + R"(
WorldBegin
LightSource "infinite" "string filename" "sky.pfm" "float scale" .3
LightSource "infinite" "rgb L" [ .05 .06 .07 ]
LightSource "infinite" "string filename" "sky.pfm" "point3 portal" [ -1 2.9 -1  1 2.9 -1  1 2.9 1  -1 2.9 1 ]
LightSource "distant" "point3 from" [ 1 2 -1 ] "rgb L" [ .4 .3 .2 ]
LightSource "point" "point3 from" [ -1 1.8 -1 ] "rgb I" [ .3 .5 .6 ]
LightSource "spot" "point3 from" [ 1 2.2 -1 ] "point3 to" [ .3 0 0 ] "rgb I" [ .6 .5 .3 ] "float conedeltaangle" 20
AttributeBegin
  Translate -1.5 2 1
  Rotate 100 1 0 0
  LightSource "goniometric" "string filename" "sky.pfm" "rgb I" [ .4 .4 .5 ]
  LightSource "projection" "string filename" "wood.pfm" "float fov" 70
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 4 4 3 ]
  Shape "trianglemesh" "point3 P" [ -.5 2.4 -.5  .5 2.4 -.5  .5 2.4 .5  -.5 2.4 .5 ] "integer indices" [ 0 1 2 0 2 3 ]
  Shape "trianglemesh" "point3 P" [ 1.5 2 0  1.9 2 0  1.5 2 .5 ] "integer indices" [ 0 1 2 ]
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 3 1 1 ] "bool twosided" true
  Translate -1.6 1.2 .5
  Shape "sphere" "float radius" .15
  Translate 0 .6 0
  Rotate 90 1 0 0
  Shape "disk" "float radius" .2
  Translate 0 -.1 -.3
  Shape "cylinder" "float radius" .03 "float zmin" -.2 "float zmax" .2
AttributeEnd
Texture "wood" "spectrum" "imagemap" "string filename" "wood.pfm" "string filter" "trilinear" "float uscale" 2
Texture "check" "spectrum" "checkerboard" "rgb tex1" [ .7 .6 .5 ] "rgb tex2" [ .2 .3 .2 ] "float uscale" 9 "float vscale" 9
Texture "rough" "float" "checkerboard" "float tex1" .05 "float tex2" .4 "float uscale" 4 "float vscale" 8
Texture "noise" "float" "wrinkled"
Texture "waves" "float" "scale" "texture tex" "noise" "float scale" .2
Texture "marble" "spectrum" "marble" "float scale" 9
Material "diffuse" "texture reflectance" "check" "texture displacement" "waves"
Shape "trianglemesh" "point3 P" [ -3 0 -3  3 0 -3  3 0 3  -3 0 3 ] "integer indices" [ 0 2 1 0 3 2 ] "point2 uv" [ 0 0 1 0 1 1 0 1 ]
Material "diffuse" "texture reflectance" "wood"
Shape "trianglemesh" "point3 P" [ -3 0 2  3 0 2  3 3 2  -3 3 2 ] "integer indices" [ 0 2 1 0 3 2 ] "point2 uv" [ 0 0 1 0 1 1 0 1 ]
   "normal N" [ 0 0 -1  .3 0 -1  .3 .2 -1  0 .2 -1 ]
)" +
           scoped(
               "Translate -1.2 .5 0\nMaterial \"conductor\" \"texture roughness\" \"rough\"\n"
               "Shape \"sphere\" \"float radius\" .5\n") +
           scoped(
               "Translate 0 .5 -.6\nMaterial \"dielectric\" \"float eta\" 1.5\nShape \"sphere\" \"float radius\" "
               ".5\n") +
           scoped(
               "Translate 1.1 .5 -.4\nMaterial \"coateddiffuse\" \"rgb reflectance\" [ .2 .5 .7 ] \"float roughness\" "
               ".1\n"
               "Shape \"sphere\" \"float radius\" .5 \"float zmin\" -.4 \"float phimax\" 300\n") +
           scoped(
               "Translate 1.5 1.4 -.6\nMaterial \"diffusetransmission\"\nShape \"disk\" \"float radius\" .4\n"
               "Translate -2.6 0 0\nMaterial \"thindielectric\"\nShape \"disk\" \"float radius\" .4\n") +
           scoped(
               "Translate 1.3 .2 -1.8\nMaterial \"phong\" \"texture kd\" \"check\"\nShape \"sphere\" \"float radius\" "
               ".2\n"
               "Translate -2.7 0 0\nMaterial \"blinn\" \"rgb kd\" [ .3 .3 .3 ] \"rgb ks\" [ .6 .5 .2 ]\n"
               "Shape \"sphere\" \"float radius\" "
               ".2\n") +
           scoped(
               "Translate .6 .25 -1.6\nMaterial \"dielectric\" \"float roughness\" .2\n"
               "Shape \"sphere\" \"float radius\" .25\n") +
           scoped(
               "Translate .5 .1 -2\nMaterial \"measured\" \"string filename\" \"metal.bsdf\"\n"
               "Shape \"sphere\" \"float radius\" .1\n") +
           scoped(
               "Translate .1 .15 -1.9\nMaterial \"hair\" \"float beta_n\" .5\nShape \"sphere\" \"float radius\" .15\n") +
           scoped(
               "Translate -1.1 .2 -1.4\nMaterial \"coatedconductor\" \"float interface.roughness\" .01\n"
               "  \"float conductor.roughness\" .05\nShape \"sphere\" \"float radius\" .2\n") +
           scoped(
               "Translate -.5 .25 -1.5\nMaterial \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" "
               "\"metal-Au-k\" \"float uroughness\" .3 \"float vroughness\" .05 \"texture displacement\" \"waves\"\n"
               "Shape \"sphere\" \"float radius\" .25\n") +
           R"(
MakeNamedMaterial "paint" "string type" "diffuse" "rgb reflectance" [ .2 .3 .7 ]
MakeNamedMaterial "metal" "string type" "conductor" "texture roughness" "rough"
MakeNamedMaterial "hole" "string type" "interface"
MakeNamedMaterial "worn" "string type" "mix" "string materials" [ "paint" "metal" ] "texture amount" "rough"
Material "mix" "string materials" [ "worn" "hole" ] "float amount" .3
)" + scoped("Translate -1.8 .3 -1\nShape \"sphere\" \"float radius\" .3\n") +
           scoped(
               "Translate -.9 .1 -1.4\nMaterial \"coateddiffuse\"\n"
               "Shape \"curve\" \"float width\" .06 \"point3 P\" [ 0 0 0  .3 .5 .2  .6 -.2 .3  .9 .4 .1 ]\n"
               "Shape \"curve\" \"string type\" \"cylinder\" \"string basis\" \"bspline\" \"float width1\" .02 \"float "
               "width0\" "
               ".08 \"point3 P\" [ 0 0 0  .2 .8 .1  .5 .2 .2  .9 .9 .1  1.1 .3 0  1.5 .6 0 ]\n"
               "Scale 1 .7 1\nShape \"curve\" \"string type\" \"ribbon\" \"normal N\" [ 0 .3 -1  1 0 -1 ] \"float "
               "width\" .1 "
               "\"point3 P\" [ 0 .6 0  .2 1 .2  .5 .8 .3  .8 1.2 .1 ]\n") +
           R"(
MakeNamedMedium "ink" "string type" "homogeneous" "rgb sigma_a" [ .5 1.5 2.5 ] "rgb sigma_s" [ 0 0 0 ]
AttributeBegin
  MediumInterface "ink" ""
  Material "interface"
  Translate 2 .5 .6
  Shape "sphere" "float radius" .4
AttributeEnd
)" +
           scoped(
               "Material \"diffuse\"\nAttribute \"shape\" \"texture alpha\" \"rough\"\nTranslate .8 1.6 -.5\nShape "
               "\"disk\" \"float radius\" .3\n"
               "Translate -1.4 0 0\nAreaLightSource \"diffuse\"\nShape \"sphere\" \"float radius\" .15\n") +
           R"(
ObjectBegin "stone"
  Material "coateddiffuse" "texture reflectance" "marble" "string normalmap" "wood.pfm"
  Shape "cylinder" "float radius" .1 "float phimax" 250
  Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  0 0 1 ] "integer indices" [ 0 2 1 0 1 3 0 3 2 1 2 3 ]
  Translate 0 1 0
  Shape "sphere" "float radius" .3
ObjectEnd
)" + scoped("Translate 1.6 0 1\nScale .6 .8 .6\nObjectInstance \"stone\"\n") +
           scoped("Translate -2 0 1.2\nRotate 40 0 1 0\nScale -.7 .5 .7\nObjectInstance \"stone\"\n");
}

/// The camera, a mesh, a sphere, and instances with a still and a moving part move. 32 x 24 pixels.
inline std::string motionText(const std::string& sampler = "sobol", int samples = 8) {
    const auto moving = [](const std::string& transform) {
        return "ActiveTransform EndTime\n" + transform + "ActiveTransform All\n";
    };
    return moving("Translate .3 0 0\nRotate 3 0 1 0\n") +
           "LookAt 0 1.5 -5  0 .7 0  0 1 0\n"
           "Camera \"perspective\" \"float fov\" 45 \"float lensradius\" .03 \"float focaldistance\" 5\n"
           "  \"float shutteropen\" .1 \"float shutterclose\" .9\n" +
           film(32, 24) + "Integrator \"path\" \"integer maxdepth\" 6\nSampler \"" + sampler +
           "\" \"integer pixelsamples\" " + std::to_string(samples) + R"(
WorldBegin
LightSource "infinite" "string filename" "sky.pfm"
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 6 5 4 ]
  Translate 0 3 0
  Rotate 90 1 0 0
  Shape "disk" "float radius" .8
AttributeEnd
Material "diffuse" "rgb reflectance" [ .6 .6 .6 ]
Shape "trianglemesh" "point3 P" [ -4 0 -4  4 0 -4  4 0 4  -4 0 4 ] "integer indices" [ 0 2 1 0 3 2 ]
ObjectBegin "wheel"
  Material "conductor" "float roughness" .1
  Shape "curve" "string type" "cylinder" "float width" .1 "point3 P" [ -.6 0 0  -.2 .6 .3  .2 -.2 .3  .6 .8 0 ]
  Shape "trianglemesh" "point3 P" [ -.5 0 0  .5 0 0  .5 1 0  -.5 1 0 ] "integer indices" [ 0 1 2 0 2 3 ] "float alpha" .7
  Material "diffuse" "rgb reflectance" [ .7 .3 .2 ]
  AttributeBegin
)" + moving("Rotate 70 0 0 1\n") +
           R"(
    Translate .5 .5 0
    Shape "sphere" "float radius" .25
  AttributeEnd
ObjectEnd
)" + scoped(moving("Translate .2 .3 0\nRotate 45 0 1 0\n") + "Translate -1.5 0 0\nObjectInstance \"wheel\"\n") +
           scoped("Translate .8 0 .8\nScale -1 1 1\nObjectInstance \"wheel\"\n") +
           scoped(moving("Translate 0 .4 0\n") +
                  "Translate 0 .5 -1\nMaterial \"dielectric\"\nShape \"sphere\" \"float radius\" .4\n") +
           scoped("Material \"coateddiffuse\" \"rgb reflectance\" [ .2 .6 .3 ]\n" + moving("Rotate 30 0 1 0\n") +
                  "Translate 1.5 0 -.5\nShape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0  0 0 1 ] "
                  "\"integer indices\" [ 0 2 1 0 1 3 0 3 2 1 2 3 ]\n");
}

}  // namespace penumbra::test
