#include "scenes/overrides.h"

namespace penumbra {
namespace {

Entity* findDirective(SceneDescription& scene, std::string_view name) {
    if (name == "Camera") return &scene.camera;
    if (name == "Film") return &scene.film;
    if (name == "PixelFilter") return &scene.filter;
    if (name == "Sampler") return &scene.sampler;
    if (name == "Integrator") return &scene.integrator;
    return nullptr;
}

void apply(SceneDescription& scene, const std::string& text) {
    static const std::vector<std::string> known{"Camera", "Film", "PixelFilter", "Sampler", "Integrator"};
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
        throw Error(ErrorKind::Usage,
                    "-D " + quote(text) + ": expected DIRECTIVE.PARAMETER=VALUE, such as Film.iso=200");
    const std::string key = text.substr(0, equals), value = text.substr(equals + 1);
    const std::size_t dot = key.find('.');
    const std::string directive = key.substr(0, dot);
    Entity* entity = findDirective(scene, directive);
    if (!entity)
        throw Error(ErrorKind::Usage,
                    "-D " + quote(text) + ": unknown directive " + quote(directive) + suggestion(directive, known));
    const SourcePosition where{std::uint32_t(scene.files.size()), 0, 0};
    scene.files.push_back("-D " + text);
    if (dot == std::string::npos) {
        entity->type = value;
        entity->parameters = {};
        entity->where = where;
    } else {
        entity->parameters.override(key.substr(dot + 1), value, where);
    }
}

}  // namespace

void applyOverrides(SceneDescription& scene, std::span<const std::string> overrides) {
    for (const std::string& text : overrides)
        apply(scene, text);
}

}  // namespace penumbra
