#include "core/image/texture_octaves.h"

#include <string>

namespace penumbra {

Octaves readOctaves(TextureInput& input) {
    // Number 32 has 1.99^32 times the frequency of the first: floats that differ by a cell of it have no digits left.
    constexpr int kMost = 32;
    const Octaves octaves{input.parameters().integer("octaves", 8), input.parameters().number("roughness", 0.5f)};
    if (octaves.count < 0 || octaves.count > kMost)
        input.fail("octaves " + std::to_string(octaves.count) + " is not between 0 and " + std::to_string(kMost));
    return octaves;
}

void requireKind(TextureInput& input, TextureKind kind, std::string_view className) {
    if (input.kind() == kind) return;
    const char* const only = kind == TextureKind::Float ? "float" : "spectrum";
    input.fail("the texture class " + quote(std::string(className)) + " is for \"" + only + "\" textures only");
}

}  // namespace penumbra
