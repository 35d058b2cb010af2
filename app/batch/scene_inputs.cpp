#include "app/batch/scene_inputs.h"

#include "core/base/parallel.h"
#include "core/base/sha256.h"

#include <filesystem>
#include <set>

namespace penumbra {
namespace {

/// Collects the files that parameters name, each once.
class AssetFinder {
public:
    explicit AssetFinder(const SceneDescription& scene) : scene_(scene) {}

    void visit(const Entity& entity) { visit(entity.parameters); }
    template <class EntityType>
    void visit(const std::vector<EntityType>& entities) {
        for (const EntityType& e : entities)
            visit(e.parameters);
    }
    void visit(const ParameterSet& parameters) {
        for (const Parameter& p : parameters.all())
            if (p.isText() && (p.type == "string" || p.type == "spectrum" || p.type.empty()))
                for (const std::string& name : p.strings())
                    visitName(name);
    }
    std::vector<std::string> paths() && { return std::move(paths_); }

private:
    void visitName(const std::string& name) try {
        if (name.empty() || !names_.insert(name).second) return;
        std::error_code ignored;
        const std::string path = resolvePath(scene_, name);
        if (std::filesystem::is_regular_file(path, ignored)) paths_.push_back(path);
    } catch (const Error&) {
        // Outside the root. If it is a file that the scene needs, the builder says so, and where.
    }

    const SceneDescription& scene_;
    std::set<std::string> names_;
    std::vector<std::string> paths_;
};

std::vector<std::string> assetsOf(const SceneDescription& scene) {
    AssetFinder finder(scene);  // not the film's: its file name is the picture's
    for (const Entity* e : {static_cast<const Entity*>(&scene.camera), &scene.sampler, &scene.integrator})
        finder.visit(*e);
    finder.visit(scene.materials);
    finder.visit(scene.namedMaterials);
    finder.visit(scene.textures);
    finder.visit(scene.media);
    finder.visit(scene.lights);
    finder.visit(scene.areaLights);
    finder.visit(scene.shapes);
    for (const ObjectDefinition& object : scene.objects)
        finder.visit(object.shapes);
    return std::move(finder).paths();
}

std::string digestOrEmpty(const std::string& path) {
    try {
        return sha256OfFile(path);
    } catch (const Error&) {
        return "";
    }
}

}  // namespace

SceneInputs findSceneInputs(const SceneDescription& scene) {
    // Behind the files, which alone have digests, stand overrides.
    const auto firstOverride = scene.files.begin() + std::ptrdiff_t(scene.digests.size());
    SceneInputs inputs{{scene.files.begin(), firstOverride}, assetsOf(scene), ""};
    std::vector<std::string> digests(inputs.assets.size());
    parallelFor(digests.size(), [&](std::size_t i) { digests[i] = digestOrEmpty(inputs.assets[i]); });
    Sha256 all;
    for (const std::string& digest : scene.digests)
        all.add("text " + digest + "\n");
    for (const std::string& digest : digests)
        all.add("file " + digest + "\n");
    inputs.hash = all.hex();
    return inputs;
}

}  // namespace penumbra
