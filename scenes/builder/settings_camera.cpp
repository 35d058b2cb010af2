// Camera and shutter.
#include "scenes/builder/settings.h"
#include "scenes/builder/shapes.h"

#include <fmt/format.h>

namespace penumbra::builder {
namespace {

constexpr float kMost = 1e30f;

class SceneCameraInput final : public CameraInput {
public:
    /// `ownAspect`: the command line makes a picture of another shape, which the camera has to follow.
    SceneCameraInput(const SceneDescription& scene, const FilmSettings& film, bool ownAspect, BuildContext& context)
        : camera_(scene.camera),
          film_(film),
          diagonal_(context.number(scene.film.parameters, "diagonal", 35, 1e-3f, 1e6f)),
          ownAspect_(ownAspect),
          context_(context) {}

    int width() const override { return film_.width; }
    int height() const override { return film_.height; }
    double filmDiagonal() const override { return diagonal_; }
    ScreenWindow screen() const override;

    const ParameterSet& parameters() const override { return camera_.parameters; }
    float number(std::string_view name, float otherwise, float least, float most) const override {
        return context_.number(camera_.parameters, name, otherwise, least, most);
    }
    int integer(std::string_view name, int otherwise, int least, int most) const override {
        return context_.integer(camera_.parameters, name, otherwise, least, most);
    }
    std::string path(const std::string& name) const override { return context_.path(name); }
    void warn(const std::string& text) override { context_.warn(camera_.where, owner() + ": " + text); }
    [[noreturn]] void fail(const std::string& text, ErrorKind kind) const override {
        context_.fail(camera_.where, owner() + ": " + text, kind);
    }
    std::string owner() const { return ownerName("camera", camera_.type); }

private:
    const CameraEntity& camera_;
    const FilmSettings& film_;
    double diagonal_;
    bool ownAspect_;
    BuildContext& context_;
};

ScreenWindow SceneCameraInput::screen() const {
    const float shape = float(film_.width) / float(film_.height);
    const float given = number("frameaspectratio", shape, 1e-6f, 1e6f);
    const double aspect = ownAspect_ ? shape : given;
    const double x = aspect > 1 ? aspect : 1, y = aspect > 1 ? 1 : 1 / aspect;
    const Parameter* window = camera_.parameters.find("float", "screenwindow");
    if (!window) return {-x, x, -y, y};
    const std::vector<float>& v = window->floats();
    if (v.size() != 4)
        context_.fail(window->where, fmt::format("screenwindow needs 4 numbers, {} are given", v.size()));
    for (const float s : v)
        if (!(s >= -kMost && s <= kMost)) context_.fail(window->where, "a number of screenwindow is too large");
    if (v[0] == v[1] || v[2] == v[3]) context_.fail(window->where, "screenwindow is empty");
    return {v[0], v[1], v[2], v[3]};
}

Matrix4 inverse(const Matrix4& m, SourcePosition where, const BuildContext& context) {
    Matrix4 out;
    if (!invert(m, out)) context.fail(where, "the transformation of the camera has no inverse");
    if (!isUsable(toRecord(out))) context.fail(where, "the camera is too far away, too large or too small to see");
    return out;
}

CameraPlacement readPlacement(const SceneDescription& scene, Shutter shutter, const BuildContext& context) {
    const CameraEntity& camera = scene.camera;
    CameraPlacement p;
    p.shutterOpen = shutter.open;
    p.shutterClose = shutter.close;
    p.transformTimes[0] = scene.transformTimes[0];
    p.transformTimes[1] = scene.transformTimes[1];
    // Times without a span say nothing of when things move; nothing may divide by it.
    if (!(p.transformTimes[1] > p.transformTimes[0])) p.transformTimes[1] = p.transformTimes[0] + 1;
    p.worldFromCameraStart = inverse(camera.cameraFromWorld.start, camera.where, context);
    p.worldFromCameraEnd = inverse(camera.cameraFromWorld.end, camera.where, context);
    return p;
}

}  // namespace

Shutter readShutter(const CameraEntity& camera, const BuildContext& context) {
    const float open = context.number(camera.parameters, "shutteropen", 0, -kMost, kMost);
    const float close = context.number(camera.parameters, "shutterclose", 1, -kMost, kMost);
    if (!(close > open))
        context.fail(camera.where, fmt::format("the shutter closes at {}, not after it opens at {}", close, open));
    return {open, close};
}

Camera readCamera(const SceneDescription& scene, Shutter shutter, const FilmSettings& film, float coneScale,
                  const BuildOptions& options, BuildContext& context) {
    const CameraEntity& camera = scene.camera;
    const double askedWidth = scene.film.parameters.integer("xresolution", 1280),
                 askedHeight = scene.film.parameters.integer("yresolution", 720);
    const bool ownAspect =
        options.width > 0 && options.height > 0 && askedWidth * options.height != askedHeight * options.width;
    SceneCameraInput input(scene, film, ownAspect, context);
    CameraModel model;
    if (!makeCamera(camera.type, input, model))
        context.fail(camera.where,
                     "unknown camera " + quote(camera.type) + suggestion(camera.type, pluginNames(CameraTypes{})));
    context.warnUnused(camera.parameters, input.owner());
    return Camera(std::move(model), readPlacement(scene, shutter, context), coneScale);
}

}  // namespace penumbra::builder
