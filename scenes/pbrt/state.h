// What the directives of a pbrt file change: the attribute state, and the context of a file or an imported part.
#pragma once

#include "scenes/description.h"

#include <array>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::pbrt {

/// The kinds of directive that the Attribute directive gives default parameters to.
enum class Defaults : std::uint8_t { Shape, Light, Material, Medium, Texture };
inline constexpr std::size_t kDefaultsKinds = 5;

/// Everything that AttributeBegin saves and AttributeEnd restores.
struct AttributeState {
    TransformPair ctm;  ///< world block: object to world; before WorldBegin: camera from world
    bool startActive = true, endActive = true;
    bool reverseOrientation = false;
    MaterialReference material{{}, 0, {}};
    int areaLight = -1;
    MediumReference medium;
    std::string colorSpace = "srgb";
    /// Shared by all states that have not added to them; null where there are none.
    std::array<std::shared_ptr<const std::vector<Parameter>>, kDefaultsKinds> defaults;
};

/// A block that is open: what began it, and the state to go back to.
struct Block {
    std::string_view beganWith, endsWith;  ///< directives
    SourcePosition where;
    AttributeState saved;
};

/// What an imported part has of its own.
struct Context {
    AttributeState state;
    std::vector<Block> blocks;
    std::map<std::string, TransformPair> coordinateSystems;
    int object = -1;  ///< index of the object definition that is open, -1 = none
};

}  // namespace penumbra::pbrt
