// What the tests of the scene builder share: scenes from short texts, and rays to look at them with.
#pragma once

#include "core/geometry/surface_point.h"
#include "scenes/builder.h"
#include "scenes/readers.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace penumbra {

struct BuiltScene {
    Scene scene;
    Warnings warnings;

    /// Whether some warning contains the text.
    bool warnsOf(std::string_view text) const {
        for (const std::string& w : warnings.all())
            if (w.find(text) != std::string::npos) return true;
        return false;
    }
};

inline BuiltScene buildText(std::string_view text, const BuildOptions& options = {}, const std::string& folder = ".") {
    BuiltScene built;
    SceneDescription description = readSceneText(text, "test.pbrt", folder, built.warnings);
    built.scene = buildScene(std::move(description), options, built.warnings);
    return built;
}

/// A scene of only a world block.
inline BuiltScene buildWorld(const std::string& world, const std::string& folder = ".") {
    return buildText("WorldBegin\n" + world, {}, folder);
}

/// The message of the error that the text must give; "" where it gives none.
inline std::string errorOf(std::string_view text, const BuildOptions& options = {}, const std::string& folder = ".") {
    try {
        buildText(text, options, folder);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

struct RayResult {
    float distance;
    SurfacePoint<float> at;
};

/// What a ray meets first; nothing where it meets nothing.
inline std::optional<RayResult> trace(const Scene& scene, Vec3<float> origin, Vec3<float> direction, float time = 0) {
    RayHitPacket r{};
    r.ray.originX[0] = origin.x, r.ray.originY[0] = origin.y, r.ray.originZ[0] = origin.z;
    r.ray.directionX[0] = direction.x, r.ray.directionY[0] = direction.y, r.ray.directionZ[0] = direction.z;
    r.ray.far[0] = kInfinity;
    r.ray.time[0] = time;
    r.ray.mask[0] = kNoHit;
    r.hit.geometry[0] = r.hit.instance[0] = kNoHit;
    scene.accelerator.intersect(r, 1);
    if (r.hit.geometry[0] == kNoHit) return std::nullopt;
    const Hit<float> hit{r.hit.geometry[0], r.hit.primitive[0], r.hit.instance[0],
                         r.hit.u[0],        r.hit.v[0],         r.ray.far[0]};
    return RayResult{hit.t, surfacePoint(scene.geometry, hit, origin, direction, time)};
}

}  // namespace penumbra
