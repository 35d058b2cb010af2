// What the textures of noise share: their parameters, and that each is of one kind.
#pragma once

#include "core/image/texture_mapping.h"
#include "core/image/texture_plugin.h"
#include "core/math/noise.h"

namespace penumbra {

/// The parameters of the textures whose octaves can be set.
inline constexpr ParameterInfo kOctaveParameters[] = {
    {"integer", "octaves", "8", "of noise, at most 32"},
    {"float", "roughness", "0.5", "amplitude of an octave, relative to the one before"},
};

Octaves readOctaves(TextureInput& input);

/// Fails where the scene file wants a texture of the other kind from a class that has this one alone.
void requireKind(TextureInput& input, TextureKind kind, std::string_view className);

}  // namespace penumbra
