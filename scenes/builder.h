// The scene builder: from a SceneDescription (what a file says) to a Scene (what a render reads).
//
// Everything a file may name and everything it may get wrong is decided here; nothing of it reaches the hot code. What
// Penumbra does not have yet is replaced by something sensible, with one warning a kind; what no renderer has is an
// error.
// (overrides.h, before: what a command line says against the file in the file's own words.)
//   builder/context.h           what the parts share: messages with places, colours, paths
//   builder/settings_*.cpp      film, camera, filter, sampler, integrator (and the command line's overrides)
//   builder/textures.cpp        textures by name and role
//   builder/materials.cpp       materials by name, late; material_input.h is what they ask
//   builder/media.cpp           media by name
//   builder/shapes.cpp          meshes and quadrics
//   builder/lights_*.cpp        light sources; area lights on shapes
//   builder/world.cpp           objects, instances, motion: the tables of the geometry
//
// Errors: Error(BadData), or MissingInput for a file that is not there; the message begins with "file:line:column: ".
// Error(Usage) for an override that names nothing known. Warnings begin with the place, too.
//
// Memory: the description is taken apart while the scene is built, so that no mesh exists twice.
//
// Thread safety: one call uses one thread but for the acceleration structure; calls with own Warnings may run side by
// side.
#pragma once

#include "scenes/mesh_facts.h"
#include "scenes/scene.h"

#include <array>
#include <optional>

namespace penumbra {

/// What the command line says against the scene file. Zero, empty or unset: as the file says.
struct BuildOptions {
    int samplesOverride = 0;    ///< samples per pixel (--spp)
    int width = 0, height = 0;  ///< both or none (--resolution); the crop keeps its fraction of the picture
    std::optional<std::array<float, 4>> cropWindow;  ///< x0 x1 y0 y1, fractions of the picture
    std::optional<std::array<int, 4>> pixelBounds;   ///< x0 x1 y0 y1, pixels of the picture as it is made
    std::optional<std::uint32_t> seed;
    std::string sampler, integrator;  ///< types; of the file's directive then remain samples per pixel and maxdepth
    IntersectionMode intersection = IntersectionMode::Robust;

    std::optional<int> maxDepth;
    std::optional<RouletteRule> roulette;
    std::optional<Strategy> strategy;
    std::optional<LightSelection> lightSelection;
    bool classicArea = false;  ///< --light-sampling area
    std::optional<AovSet> aovs;  ///< --aov, for the film's own
    std::optional<float> clamp;  ///< limit on a sample's components (--clamp) for the film's own; infinity: none

    std::vector<MeshFacts>* meshFacts = nullptr;  ///< where given, gets an entry for every mesh
};

Scene buildScene(SceneDescription description, const BuildOptions& options, Warnings& warnings);

}  // namespace penumbra
