// Pieces of pbrt-v4 text from which the analytic scenes are put together.
//
// Conventions: angles in degrees; every returned string is one or more whole lines. A rectangle's normal is along its
// axis in the direction that `Facing` names.
//
// Thread safety: pure functions.
#pragma once

#include "scenes/analytic/analytic_scene.h"

#include <string>
#include <vector>

namespace penumbra::analytic {

struct Point {
    double x = 0, y = 0, z = 0;
};

constexpr int kNoDepth = -1;  ///< for integrators without a maxdepth

/// What stands before WorldBegin.
struct Setting {
    std::string camera;  ///< transforms and the Camera directive
    int maxDepth = 1;
    int width = 16, height = 16;
    std::string integrator = "path";
    std::string integratorParameters{};
    std::string filter = R"(PixelFilter "box" "float xradius" [ .5 ] "float yradius" [ .5 ])";
    std::string filmParameters{};
};
std::string sceneText(const Setting& setting, const std::string& world);

/// Parallel rays from a square window of the given half width around `eye`, toward `target`.
std::string orthographicView(Point eye, Point target, Point up, double halfWidth);
/// From 0.5 above the origin straight down on a square so small that it stands for a point.
std::string viewOfOrigin();
/// Looks along +z with one pixel per unit: the first column is x0 <= x < x0 + 1, the bottom row 0 <= y < 1.
std::string pixelGrid(int x0, int width, int height, const std::string& cameraParameters = {});

std::string diffuse(double reflectance);
std::string diffuse(double r, double g, double b);
std::string black();
std::string spectrumOf(double value);  ///< "[ v v v ]"

/// The shape with a diffuse emitter of the given radiance on it, black by reflection.
std::string emitter(double radiance, const std::string& shape, const std::string& parameters = {});
std::string constantSky(double radiance);

enum class Facing { Positive, Negative };
/// In the plane z = const: x0..x1 by y0..y1; facing +z, u runs along x and v along y.
std::string rectangleZ(double x0, double x1, double y0, double y1, double z, Facing facing);
/// In the plane x = const: y0..y1 by z0..z1.
std::string rectangleX(double y0, double y1, double z0, double z1, double x, Facing facing);
/// The inside of the cube [-1, 1]^3: twelve triangles, normals inward.
std::string cubeInside();
/// The same as an ASCII PLY file of six quads.
std::string cubeInsidePly();
/// The receiver: a square around the origin in the plane z = 0, normal +z.
std::string floorSquare(double halfWidth);
std::string sphere(double radius, Point centre = {});
/// Radius and centre; the normal is along +z or -z.
std::string disk(double radius, Point centre, Facing facing);

/// About the z axis, its middle at the origin, then placed by `transform`.
std::string cylinder(double radius, double length, const std::string& transform, double phiMax = 360);

/// AttributeBegin ... AttributeEnd around it.
std::string scoped(const std::string& text);

/// A colour PFM image; `pixels` row by row from the top.
std::string pfmImage(int width, int height, const std::vector<std::array<float, 3>>& pixels);

std::array<double, 3> grey(double value);

}  // namespace penumbra::analytic
