// What the infinite lights (constant, image) have in common: in a scene file they are one plug-in, `LightSource
// "infinite"`.
#pragma once

#include "lights/light.h"

namespace penumbra {

inline constexpr ParameterInfo kInfiniteParameters[] = {
    {"spectrum", "L", "white", "radiance of a light without an image"},
    {"string", "filename", "", "image of all directions, instead of L"},
    {"string", "mapping", "", "of the image: equalarea (square, octahedral) or latlong; where not said, by its shape"},
    {"float", "scale", "1", "factor on L or the image"},
    {"float", "illuminance", "0", "where positive, the illuminance of an upward-facing surface"},
    {"point3", "portal", "", "four corners of a window that the light comes through"},
};
inline constexpr PluginInfo kInfiniteInfo = {
    "infinite", "light from all directions, constant or from an image of the surroundings", kInfiniteParameters};

/// Flux that enters the scene's bounding sphere: irradiance pi L on its area 4 pi r^2.
inline float infinitePower(float meanRadiance, const LightTables& tables) {
    return 4.f * kPi * kPi * meanRadiance * tables.sceneRadius * tables.sceneRadius;
}

}  // namespace penumbra
