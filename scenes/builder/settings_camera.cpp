// Camera and shutter.
#include "scenes/builder/settings.h"
#include "scenes/builder/shapes.h"

#include <fmt/format.h>

namespace penumbra::builder {
namespace {

constexpr float kMost = 1e30f;
constexpr float kFarthest = 1e18f;  // whose square a float still holds

CameraKind readKind(const CameraEntity& camera, BuildContext& context) {
    if (camera.type == "perspective") return CameraKind::Perspective;
    if (camera.type == "orthographic") return CameraKind::Orthographic;
    static const std::vector<std::string> known{"perspective", "orthographic", "spherical", "realistic"};
    if (camera.type != "spherical" && camera.type != "realistic")
        context.fail(camera.where, "unknown camera " + quote(camera.type) + suggestion(camera.type, known));
    context.warn(camera.where, "the camera " + quote(camera.type) + " is not there yet; it counts as 'perspective'");
    return CameraKind::Perspective;
}

/// x0 x1 y0 y1 of the picture on the plane z = 1.
void readScreen(const CameraEntity& camera, const FilmSettings& film, bool otherAspect, const BuildContext& context,
                double screen[4]) {
    const float shape = float(film.width) / float(film.height);
    const float given = context.number(camera.parameters, "frameaspectratio", shape, 1e-6f, 1e6f);
    const double aspect = otherAspect ? shape : given;
    const double x = aspect > 1 ? aspect : 1, y = aspect > 1 ? 1 : 1 / aspect;
    screen[0] = -x, screen[1] = x, screen[2] = -y, screen[3] = y;
    const Parameter* window = camera.parameters.find("float", "screenwindow");
    if (!window) return;
    const std::vector<float>& v = window->floats();
    if (v.size() != 4) context.fail(window->where, fmt::format("screenwindow needs 4 numbers, {} are given", v.size()));
    for (const float s : v)
        if (!(s >= -kMost && s <= kMost)) context.fail(window->where, "a number of screenwindow is too large");
    if (v[0] == v[1] || v[2] == v[3]) context.fail(window->where, "screenwindow is empty");
    std::copy(v.begin(), v.end(), screen);
}

Matrix4 inverse(const Matrix4& m, SourcePosition where, const BuildContext& context) {
    Matrix4 out;
    if (!invert(m, out)) context.fail(where, "the transformation of the camera has no inverse");
    if (!isUsable(toRecord(out))) context.fail(where, "the camera is too far away, too large or too small to see");
    return out;
}

}  // namespace

Shutter readShutter(const CameraEntity& camera, const BuildContext& context) {
    const float open = context.number(camera.parameters, "shutteropen", 0, -kMost, kMost);
    const float close = context.number(camera.parameters, "shutterclose", 1, -kMost, kMost);
    if (!(close > open))
        context.fail(camera.where, fmt::format("the shutter closes at {}, not after it opens at {}", close, open));
    return {open, close};
}

CameraSettings readCamera(const SceneDescription& scene, Shutter shutter, const FilmSettings& film,
                          const BuildOptions& options, BuildContext& context) {
    const CameraEntity& camera = scene.camera;
    const ParameterSet& p = camera.parameters;
    CameraSettings s;
    s.kind = readKind(camera, context);
    s.width = film.width;
    s.height = film.height;
    if (s.kind == CameraKind::Perspective) s.fovDegrees = context.number(p, "fov", 90, 1e-4f, 179.99f);
    const double askedWidth = scene.film.parameters.integer("xresolution", 1280),
                 askedHeight = scene.film.parameters.integer("yresolution", 720);
    const bool otherAspect =
        options.width > 0 && options.height > 0 && askedWidth * options.height != askedHeight * options.width;
    readScreen(camera, film, otherAspect, context, s.screen);
    s.lensRadius = context.number(p, "lensradius", 0, 0, kMost);
    s.focalDistance = context.number(p, "focaldistance", 1e6f, 1e-30f, kFarthest);
    s.shutterOpen = shutter.open;
    s.shutterClose = shutter.close;
    s.transformTimes[0] = scene.transformTimes[0];
    s.transformTimes[1] = scene.transformTimes[1];
    // Times without a span say nothing of when things move; nothing may divide by it.
    if (!(s.transformTimes[1] > s.transformTimes[0])) s.transformTimes[1] = s.transformTimes[0] + 1;
    s.worldFromCameraStart = inverse(camera.cameraFromWorld.start, camera.where, context);
    s.worldFromCameraEnd = inverse(camera.cameraFromWorld.end, camera.where, context);
    if (camera.type != "perspective" && camera.type != "orthographic") p.markAllUsed();
    context.warnUnused(p, ownerName("camera", camera.type));
    return s;
}

}  // namespace penumbra::builder
