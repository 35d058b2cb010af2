// The directives before WorldBegin: camera, film and how the picture is made.
#include "core/base/text.h"
#include "scenes/pbrt/parser.h"

#include <algorithm>
#include <array>

namespace penumbra::pbrt {

namespace {

struct OptionRule {
    const char* name;  ///< folded
    const char* type;
};

constexpr std::array<OptionRule, 11> kOptions{{
    {"seed", "integer"},
    {"disablepixeljitter", "bool"},
    {"disablewavelengthjitter", "bool"},
    {"disabletexturefiltering", "bool"},
    {"forcediffuse", "bool"},
    {"pixelstats", "bool"},
    {"wavefront", "bool"},
    {"displacementedgescale", "float"},
    {"rendercoordsys", "string"},
    {"msereferenceimage", "string"},
    {"msereferenceout", "string"},
}};

/// Option names ignore case, '_' and '-'. A type before the name, as parameters have it, says nothing new.
std::string folded(const std::string& name) {
    std::string out = lowerCase(name.substr(name.find_last_of(' ') + 1));
    std::erase_if(out, [](char c) { return c == '_' || c == '-'; });
    return out;
}

}  // namespace

void Parser::setDefaults() {
    scene_.camera.type = "perspective";
    scene_.film.type = "rgb";
    scene_.sampler.type = "zsobol";
    scene_.integrator.type = "volpath";
    scene_.filter.type = "gaussian";
    scene_.accelerator.type = "bvh";
    Entity initialMaterial;
    initialMaterial.type = "diffuse";
    scene_.materials.push_back(initialMaterial);
}

void Parser::camera() {
    CameraEntity camera{readEntity("camera"), state().ctm, state().medium.outside};
    TransformPair worldFromCamera;
    if (!invert(state().ctm.start, worldFromCamera.start) || !invert(state().ctm.end, worldFromCamera.end))
        throw ErrorAt(where_, "the transformation of the camera has no inverse");
    context_.coordinateSystems["camera"] = worldFromCamera;
    scene_.camera = std::move(camera);
}

void Parser::film() {
    scene_.film = FilmEntity{readEntity("film"), state().colorSpace};
}

void Parser::option() {
    Parameter p;
    p.where = sources_.peek().where;
    const std::string name = values_.readString("the name of the option");
    p.name = folded(name);
    const auto rule =
        std::find_if(kOptions.begin(), kOptions.end(), [&](const OptionRule& r) { return r.name == p.name; });
    if (rule == kOptions.end()) {
        std::vector<std::string> known;
        for (const OptionRule& r : kOptions)
            known.emplace_back(r.name);
        values_.skipValue();
        return warn("unknown option " + quote(name) + suggestion(p.name, known) + " (it is ignored)");
    }
    p.type = rule->type;
    values_.readValue(p);
    scene_.options.add(std::move(p));
}

void Parser::worldBegin() {
    worldBegan_ = where_;
    state().ctm = TransformPair{};
    state().startActive = state().endActive = true;
    context_.coordinateSystems["world"] = state().ctm;
}

}  // namespace penumbra::pbrt
