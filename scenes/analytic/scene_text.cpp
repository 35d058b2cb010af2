#include "scenes/analytic/scene_text.h"

#include <fmt/format.h>

namespace penumbra::analytic {

namespace {

std::string quad(Point a, Point b, Point c, Point d) {
    return fmt::format(R"(Shape "trianglemesh" "point3 P" [ {} {} {}  {} {} {}  {} {} {}  {} {} {} ] )"
                       R"("integer indices" [ 0 1 2 0 2 3 ] "point2 uv" [ 0 0 1 0 1 1 0 1 ])"
                       "\n",
                       a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z);
}

}  // namespace

std::string sceneText(const Setting& s, const std::string& world) {
    const std::string depth = s.maxDepth == kNoDepth ? "" : fmt::format("\"integer maxdepth\" [ {} ] ", s.maxDepth);
    return fmt::format(
        "Integrator \"{}\" {}{}\n"
        "Sampler \"sobol\" \"integer pixelsamples\" [ 64 ]\n"
        "{}\n"
        "Film \"rgb\" \"integer xresolution\" [ {} ] \"integer yresolution\" [ {} ] "
        "\"string filename\" \"analytic.exr\" \"bool savefp16\" false {}\n"
        "{}WorldBegin\n{}",
        s.integrator, depth, s.integratorParameters, s.filter, s.width, s.height, s.filmParameters, s.camera, world);
}

std::string orthographicView(Point eye, Point target, Point up, double halfWidth) {
    return fmt::format(
        "LookAt {} {} {}  {} {} {}  {} {} {}\n"
        "Camera \"orthographic\" \"float screenwindow\" [ {} {} {} {} ]\n",
        eye.x, eye.y, eye.z, target.x, target.y, target.z, up.x, up.y, up.z, -halfWidth, halfWidth, -halfWidth,
        halfWidth);
}

std::string viewOfOrigin() {
    return orthographicView({0, 0, .5}, {0, 0, 0}, {0, 1, 0}, 1e-3);
}

std::string pixelGrid(int x0, int width, int height, const std::string& cameraParameters) {
    return fmt::format(
        "LookAt 0 0 -1  0 0 0  0 1 0\n"
        "Camera \"orthographic\" \"float screenwindow\" [ {} {} 0 {} ] {}\n",
        x0, x0 + width, height, cameraParameters);
}

std::string diffuse(double reflectance) {
    return diffuse(reflectance, reflectance, reflectance);
}

std::string diffuse(double r, double g, double b) {
    return fmt::format("Material \"diffuse\" \"rgb reflectance\" [ {} {} {} ]\n", r, g, b);
}

std::string black() {
    return diffuse(0);
}

std::string spectrumOf(double value) {
    return fmt::format("[ {} {} {} ]", value, value, value);
}

std::string emitter(double radiance, const std::string& shape, const std::string& parameters) {
    return scoped(black() +
                  fmt::format("AreaLightSource \"diffuse\" \"rgb L\" {} {}\n", spectrumOf(radiance), parameters) +
                  shape);
}

std::string constantSky(double radiance) {
    return fmt::format("LightSource \"infinite\" \"rgb L\" {}\n", spectrumOf(radiance));
}

std::string rectangleZ(double x0, double x1, double y0, double y1, double z, Facing facing) {
    const Point a{x0, y0, z}, b{x1, y0, z}, c{x1, y1, z}, d{x0, y1, z};
    return facing == Facing::Positive ? quad(a, b, c, d) : quad(a, d, c, b);
}

std::string rectangleX(double y0, double y1, double z0, double z1, double x, Facing facing) {
    const Point a{x, y0, z0}, b{x, y1, z0}, c{x, y1, z1}, d{x, y0, z1};
    return facing == Facing::Positive ? quad(a, b, c, d) : quad(a, d, c, b);
}

std::string cubeInside() {
    return R"(Shape "trianglemesh"
  "point3 P" [ -1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1 ]
  "integer indices" [ 0 1 2 0 2 3  4 7 6 4 6 5  0 4 5 0 5 1  3 2 6 3 6 7  0 3 7 0 7 4  1 5 6 1 6 2 ]
)";
}

std::string cubeInsidePly() {
    return "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 6\nproperty list uchar int vertex_indices\nend_header\n"
           "-1 -1 -1\n1 -1 -1\n1 1 -1\n-1 1 -1\n-1 -1 1\n1 -1 1\n1 1 1\n-1 1 1\n"
           "4 0 1 2 3\n4 4 7 6 5\n4 0 4 5 1\n4 3 2 6 7\n4 0 3 7 4\n4 1 5 6 2\n";
}

std::string floorSquare(double halfWidth) {
    return rectangleZ(-halfWidth, halfWidth, -halfWidth, halfWidth, 0, Facing::Positive);
}

std::string sphere(double radius, Point c) {
    return scoped(fmt::format("Translate {} {} {}\nShape \"sphere\" \"float radius\" [ {} ]\n", c.x, c.y, c.z, radius));
}

std::string disk(double radius, Point c, Facing facing) {
    return scoped(fmt::format("Translate {} {} {}\n{}Shape \"disk\" \"float radius\" [ {} ]\n", c.x, c.y, c.z,
                              facing == Facing::Negative ? "Rotate 180 1 0 0\n" : "", radius));
}

std::string cylinder(double radius, double length, const std::string& transform, double phiMax) {
    return scoped(transform + fmt::format("\nShape \"cylinder\" \"float radius\" [ {} ] \"float zmin\" [ {} ] "
                                          "\"float zmax\" [ {} ] \"float phimax\" [ {} ]\n",
                                          radius, -length / 2, length / 2, phiMax));
}

std::string scoped(const std::string& text) {
    return "AttributeBegin\n" + text + "AttributeEnd\n";
}

std::string pfmImage(int width, int height, const std::vector<std::array<float, 3>>& pixels) {
    std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", width, height);  // -1: little-endian
    for (int row = height - 1; row >= 0; --row) {                         // PFM starts at the bottom
        const char* line = reinterpret_cast<const char*>(pixels.data() + static_cast<std::size_t>(row) * width);
        bytes.append(line, sizeof(float) * 3 * static_cast<std::size_t>(width));
    }
    return bytes;
}

std::array<double, 3> grey(double value) {
    return {value, value, value};
}

}  // namespace penumbra::analytic
