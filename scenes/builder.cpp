#include "scenes/builder.h"

#include "scenes/builder/settings.h"
#include "scenes/builder/world.h"

#include <chrono>

namespace penumbra {
namespace {

using namespace builder;

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void buildSettings(const SceneDescription& description, const BuildOptions& options, BuildContext& context,
                   Scene& scene) {
    const Shutter shutter = readShutter(description.camera, context);
    scene.film = readFilm(description.film, shutter, options, context);
    SamplerChoice choice = readSampler(description, options, context);
    scene.sampler = choice.sampler;
    scene.samplesPerPixel = choice.samplesPerPixel;
    scene.seed = choice.seed;
    const float coneScale = readConeScale(description.options, scene.samplesPerPixel);
    scene.camera = readCamera(description, shutter, scene.film, coneScale, options, context);
    scene.hasMotion = scene.camera.moves();
    scene.filter = Filter(readFilter(description.filter, context));
    scene.integrator = readIntegrator(description.integrator, options, context);
    readOptions(description.options, context);
}

void buildWorld(SceneDescription& description, const BuildOptions& options, BuildContext& context, Scene& scene) {
    TextureLibrary textures(description, context, scene.textures);
    MaterialLibrary materials(description, context, textures, scene.materials);
    MediumLibrary media(description, context, scene.media);
    AreaLightLibrary areaLights(description, context, scene.lights.tables);
    ShapeBuilder shapes(context, textures, materials, media, areaLights, scene.film.aovs.has(Aov::Uv),
                        options.meshFacts);
    WorldBuilder world(context, shapes, scene);
    scene.cameraMedium = media.row(description.camera.medium, description.camera.where);
    world.add(description);
    world.finish();
    scene.facts.areaLights = scene.lights.size();
    addLightSources(description, context, scene.lights);
    scene.facts.textureBytes = scene.textures.bytes();
}

void buildAccelerator(const BuildOptions& options, Scene& scene) {
    const Clock::time_point start = Clock::now();
    scene.accelerator = Accelerator(scene.geometry, options.intersection, &scene.textures);
    scene.facts.accelerationSeconds = secondsSince(start);
}

void buildLightSelection(const BuildOptions& options, Scene& scene) {
    LightTables& tables = scene.lights.tables;
    const SceneBounds b = scene.accelerator.bounds();
    if (b.lower.x <= b.upper.x) {
        tables.sceneCenter = (b.lower + b.upper) * 0.5f;
        tables.sceneRadius = length(b.upper - b.lower) * 0.5f;
    }
    tables.classicArea = options.classicArea;
    // Directions of scattering find a constant infinite light so well that light sampling is left out, unless it is all
    // there is.
    const bool lightsOnly = scene.integrator.strategy == Strategy::LightOnly;
    scene.lightSampler = LightSampler(scene.integrator.lightSelection, scene.lights, lightsOnly);
}

Scene build(SceneDescription& description, const BuildOptions& options, Warnings& warnings) {
    const Clock::time_point start = Clock::now();
    BuildContext context(description, filmColorSpace(description), warnings);
    Scene scene;
    buildSettings(description, options, context, scene);
    buildWorld(description, options, context, scene);
    buildAccelerator(options, scene);
    buildLightSelection(options, scene);
    const bool needsLights = scene.integrator.name == "path" || scene.integrator.name == "direct";
    if (scene.lights.empty() && needsLights) context.warn({}, "the scene has no lights: the picture will be black");
    scene.facts.buildSeconds = secondsSince(start) - scene.facts.accelerationSeconds;
    return scene;
}

}  // namespace

Scene buildScene(SceneDescription description, const BuildOptions& options, Warnings& warnings) {
    try {
        return build(description, options, warnings);
    } catch (const ErrorAt& error) {
        throw error.placed(description.files);
    }
}

}  // namespace penumbra
