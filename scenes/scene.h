// Scene: everything a render reads, immutable after it is built, owned by value and referred to by 32-bit ids.
//
// Thread safety: immutable. Only this folder knows materials and lights both; integrators see them through it.
#pragma once

#include "core/camera/camera.h"
#include "core/color/sensor.h"
#include "core/film/film.h"
#include "core/film/filter.h"
#include "core/geometry/accelerator.h"
#include "core/image/texture.h"
#include "lights/light_sampler.h"
#include "lights/registry.h"
#include "materials/registry.h"
#include "samplers/registry.h"
#include "scenes/description.h"
#include "scenes/light_masks.h"

#include <array>

namespace penumbra {

/// A homogeneous medium; what it absorbs per unit of length. Scattering media come later.
struct MediumRecord {
    Spectrum<float> absorption{};
};

/// The picture that the scene asks for.
struct FilmSettings {
    int width = 1280, height = 720;
    CropWindow crop;
    std::string fileName = "penumbra.exr";
    std::string colorSpace = "srgb";
    std::array<float, 9> sensorFromFilm{1, 0, 0, 0, 1, 0, 0, 0, 1};   ///< row by row: white balance times imaging ratio
    float maxComponent = kInfinity;                                   ///< of a sample, which is scaled down to it: a bias
    AovSet aovs;                                                      ///< what is kept beside the picture
    bool aovsInCameraSpace = false;                                   ///< N, Ns and P; else in the world
    bool isIdentity() const { return sensorFromFilm == std::array<float, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1} && maxComponent == kInfinity; }
};

enum class RouletteRule {
    Late,   ///< our own: from the third scattering on, relative to how bright the pixel is (integrators/path.h)
    Pbrt,   ///< from the second on, with the throughput
    Off
};
enum class Strategy { Mis, BsdfOnly, LightOnly };

/// The words that the command line and headers of pictures use.
const char* rouletteName(RouletteRule rule);
const char* strategyName(Strategy strategy);

/// Settings of integrators; each reads what concerns it.
struct IntegratorSettings {
    std::string name = "path";
    int maxDepth = 5;                     ///< scattering events, as pbrt counts them
    RouletteRule roulette = RouletteRule::Late;
    Strategy strategy = Strategy::Mis;
    LightSelection lightSelection = LightSelection::Bvh;
    float maxDistance = kInfinity;        ///< ambientocclusion
    bool cosineSampling = true;           ///< ambientocclusion
};

/// Counts and sizes for people: `penumbra info`, --stats.
struct SceneFacts {
    std::size_t triangles = 0, droppedTriangles = 0, shapes = 0, instances = 0, areaLights = 0;
    std::size_t textureBytes = 0, geometryBytes = 0;
    double buildSeconds = 0, accelerationSeconds = 0;
};

struct Scene {
    Geometry geometry;
    Accelerator accelerator;
    MaterialTable materials;
    Textures textures;
    LightTable lights;
    LightMasks lightMasks;
    LightSampler lightSampler;
    std::vector<MediumRecord> media;          ///< row 0: vacuum
    std::uint32_t cameraMedium = 0;
    Camera camera;
    Filter filter;
    FilmSettings film;
    Sampler sampler;
    int samplesPerPixel = 16;
    std::uint32_t seed = 0;
    IntegratorSettings integrator;
    bool hasMotion = false;                   ///< some shape, instance or the camera moves: rays need a time
    SceneFacts facts;

    Scene() = default;
    // The accelerator refers to the geometry's tables, which keep their place in memory when the vectors move.
    Scene(Scene&&) = default;
    Scene& operator=(Scene&&) = default;
};

}  // namespace penumbra
