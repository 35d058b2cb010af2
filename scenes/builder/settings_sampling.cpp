// Sampler, integrator and options.
#include "scenes/builder/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace penumbra::builder {
namespace {

constexpr int kMostSamples = 1 << 30;  // what the film's sums are made for

/// The format's samplers that others stand in for. All have the same expectation; only the noise differs.
struct SamplerStandIn {
    const char* name;
    const char* ours;
    bool samePoints;   ///< Sobol points as well: nothing worth a warning
    bool powersOfTwo;  ///< rounds samples per pixel down
};
constexpr SamplerStandIn kSamplerStandIns[] = {
    {"zsobol", "sobol", true, true},
    {"paddedsobol", "sobol", true, false},
    {"halton", "sobol", false, false},
    {"pmj02bn", "sobol", false, false},
};

/// Null for samplers that are there.
const SamplerStandIn* findStandIn(const std::string& name) {
    const std::vector<std::string> ours = pluginNames(SamplerTypes{});
    if (std::find(ours.begin(), ours.end(), name) != ours.end()) return nullptr;
    const auto found = std::find_if(std::begin(kSamplerStandIns), std::end(kSamplerStandIns),
                                    [&](const SamplerStandIn& s) { return name == s.name; });
    return found == std::end(kSamplerStandIns) ? nullptr : found;
}

std::vector<std::string> samplerNames() {
    std::vector<std::string> names = pluginNames(SamplerTypes{});
    for (const SamplerStandIn& s : kSamplerStandIns)
        if (findStandIn(s.name)) names.emplace_back(s.name);
    return names;
}

/// The sampler of the scene file, or of its stand-in; `input` answers with the samples per pixel.
Sampler makeSceneSampler(const Entity& entity, SamplerInput& input, BuildContext& context) {
    const SamplerStandIn* standIn = findStandIn(entity.type);
    if (entity.parameters.findAny("pixelsamples")) {
        const int samples = context.integer(entity.parameters, "pixelsamples", 16, 1, kMostSamples);
        if (standIn && standIn->powersOfTwo && input.samplesOverride == 0)
            input.samplesOverride = int(std::bit_floor(unsigned(samples)));
    }
    for (const char* name : {"xsamples", "ysamples"})
        if (entity.parameters.findAny(name)) context.integer(entity.parameters, name, 4, 1, 1 << 15);
    Sampler sampler;
    if (!makeSampler(standIn ? standIn->ours : entity.type, input, sampler))
        context.fail(entity.where, "unknown sampler " + quote(entity.type) + suggestion(entity.type, samplerNames()));
    if (standIn && !standIn->samePoints)
        context.warn(entity.where, fmt::format("the sampler {} is not there yet; '{}' stands in for it",
                                               quote(entity.type), standIn->ours));
    return sampler;
}

/// What the format calls an integrator, and what it becomes here.
struct IntegratorRule {
    const char* name;
    const char* ours;
    bool exists;  ///< else it is said that another stands in
};
constexpr IntegratorRule kIntegrators[] = {
    {"path", "path", true},
    {"volpath", "path", true},
    {"simplepath", "path", true},
    {"direct", "direct", true},
    {"ambientocclusion", "ambientocclusion", true},
    {"normals", "normals", true},
    {"simplevolpath", "path", true},
    {"randomwalk", "path", false},
    {"lightpath", "path", false},
    {"bdpt", "path", false},
    {"mlt", "path", false},
    {"sppm", "path", false},
    {"function", "path", false},
};

const IntegratorRule* findIntegrator(const std::string& name) {
    const auto found = std::find_if(std::begin(kIntegrators), std::end(kIntegrators),
                                    [&](const IntegratorRule& r) { return name == r.name; });
    return found == std::end(kIntegrators) ? nullptr : found;
}

/// As in pbrt, an unknown one is said and replaced.
LightSelection readLightSelection(const ParameterSet& p, BuildContext& context) {
    const std::string name = p.text("lightsampler", "bvh");
    if (name == "uniform") return LightSelection::Uniform;
    if (name == "power") return LightSelection::Power;
    if (name == "exhaustive") {
        context.warn(p.findAny("lightsampler")->where, "the light sampler 'exhaustive' is not there yet; 'bvh' stands in for it");
    } else if (name != "bvh") {
        const std::vector<std::string> known{"bvh", "uniform", "power", "exhaustive"};
        context.warn(p.findAny("lightsampler")->where,
                     "unknown light sampler " + quote(name) + suggestion(name, known) + "; 'bvh' stands in for it");
    }
    return LightSelection::Bvh;
}

void readIntegratorParameters(const Entity& entity, const IntegratorRule& rule, IntegratorSettings& s,
                              BuildContext& context) {
    const ParameterSet& p = entity.parameters;
    const std::string ours = rule.ours;
    if (ours == "path") s.maxDepth = context.integer(p, "maxdepth", 5, 0, 1 << 30);
    if (ours == "path" || ours == "direct") s.lightSelection = readLightSelection(p, context);
    if (ours == "ambientocclusion") {
        s.cosineSampling = p.boolean("cossample", true);
        s.maxDistance = p.number("maxdistance", kInfinity);
        if (!(s.maxDistance > 0))
            context.fail(p.findAny("maxdistance")->where, fmt::format("maxdistance {} is not above 0", s.maxDistance));
    }
    if (entity.type == "simplepath") {
        // It has no roulette and no weights; both leave the expectation alone, but the strategies are what was asked
        // for.
        const bool lights = p.boolean("samplelights", true);
        p.boolean("samplebsdf", true);
        if (!lights) s.strategy = Strategy::BsdfOnly;
    }
    if (p.boolean("regularize", false)) context.warn(entity.where, "regularize is not there yet and is ignored");
    if (!rule.exists) p.markAllUsed();
    context.warnUnused(p, ownerName("integrator", entity.type));
}

}  // namespace

SamplerChoice readSampler(const SceneDescription& scene, const BuildOptions& options, BuildContext& context) {
    const Entity& entity = scene.sampler;
    SamplerChoice choice;
    SamplerInput input{entity.parameters, options.samplesOverride};
    choice.sampler = makeSceneSampler(entity, input, context);
    const int sceneSeed = entity.parameters.integer("seed", scene.options.integer("seed", 0));
    entity.parameters.text("randomization", "");
    context.warnUnused(entity.parameters, ownerName("sampler", entity.type));
    if (!options.sampler.empty() && options.sampler != entity.type) {
        const ParameterSet none;
        SamplerInput other{none, input.samplesPerPixel};
        const SamplerStandIn* standIn = findStandIn(options.sampler);
        if (!makeSampler(standIn ? standIn->ours : options.sampler, other, choice.sampler))
            throw Error(ErrorKind::Usage,
                        "unknown sampler " + quote(options.sampler) + suggestion(options.sampler, samplerNames()));
        input.samplesPerPixel = other.samplesPerPixel;
    }
    choice.samplesPerPixel = input.samplesPerPixel;
    choice.seed = options.seed.value_or(std::uint32_t(sceneSeed));
    return choice;
}

IntegratorSettings readIntegrator(const Entity& entity, const BuildOptions& options, BuildContext& context) {
    const IntegratorRule* rule = findIntegrator(entity.type);
    if (!rule) {
        std::vector<std::string> known;
        for (const IntegratorRule& r : kIntegrators)
            known.emplace_back(r.name);
        context.fail(entity.where, "unknown integrator " + quote(entity.type) + suggestion(entity.type, known));
    }
    IntegratorSettings s;
    s.name = rule->ours;
    readIntegratorParameters(entity, *rule, s, context);
    if (!options.integrator.empty()) {
        const IntegratorRule* other = findIntegrator(options.integrator);
        s.name = other ? other->ours : options.integrator;  // unknown ones are for whoever makes integrators to refuse
    } else if (!rule->exists) {
        context.warn(entity.where, fmt::format("the integrator {} is not there yet; '{}' stands in for it",
                                               quote(entity.type), rule->ours));
    }
    s.maxDepth = options.maxDepth.value_or(s.maxDepth);
    s.roulette = options.roulette.value_or(s.roulette);
    s.strategy = options.strategy.value_or(s.strategy);
    s.lightSelection = options.lightSelection.value_or(s.lightSelection);
    return s;
}

float readConeScale(const ParameterSet& options, int samplesPerPixel) {
    if (options.boolean("disabletexturefiltering", false)) return 0;
    return std::max(0.125f, 1 / std::sqrt(float(samplesPerPixel)));  // the format's rule
}

void readOptions(const ParameterSet& options, BuildContext& context) {
    for (const char* name : {"disablepixeljitter", "forcediffuse"}) {
        const Parameter* p = options.find("bool", name);
        if (p && options.boolean(name, false))
            context.warn(p->where, "the option " + quote(name) + " is not there yet and is ignored");
    }
}

}  // namespace penumbra::builder
