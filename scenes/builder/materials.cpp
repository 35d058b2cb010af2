#include "scenes/builder/materials.h"

#include "core/base/unicode.h"
#include "scenes/builder/material_input.h"

#include <fmt/format.h>

namespace penumbra::builder {
namespace {

/// What a parameter of a material that is not there yet becomes in the one that stands in for it.
struct Renamed {
    const char* from;
    const char* to;
};

/// The format's materials that are not there yet.
struct MaterialStandIn {
    const char* name;
    const char* ours;
    std::vector<Renamed> parameters;
    std::vector<Parameter> defaults;  ///< where they differ from those of the stand-in
};

Parameter floatParameter(std::string name, float value) {
    return {
        .type = "float", .name = std::move(name), .where = {}, .values = std::vector<float>{value}, .colorSpace = {}};
}

const std::vector<MaterialStandIn>& materialStandIns() {
    static const std::vector<MaterialStandIn> table{
        {"subsurface",
         "dielectric",
         {{"eta", "eta"},
          {"roughness", "roughness"},
          {"uroughness", "uroughness"},
          {"vroughness", "vroughness"},
          {"remaproughness", "remaproughness"}},
         {floatParameter("eta", 1.33f)}},
    };
    return table;
}

const MaterialStandIn* findStandIn(const std::string& name) {
    const auto& table = materialStandIns();
    const auto found =
        std::find_if(table.begin(), table.end(), [&](const MaterialStandIn& s) { return name == s.name; });
    return found == table.end() ? nullptr : &*found;
}

bool isOurs(std::string_view type) {
    const std::vector<std::string> names = pluginNames(MaterialTypes{});
    return std::find(names.begin(), names.end(), type) != names.end();
}

/// "" and "none" are old words for "interface".
std::string canonicalType(const std::string& type) {
    return type.empty() || type == "none" ? "interface" : type;
}

void checkType(const Entity& entity, const BuildContext& context) {
    const std::string type = canonicalType(entity.type);
    if (type == MixMaterial::kInfo.name || isOurs(type) || findStandIn(type)) return;
    std::vector<std::string> known;
    for (const PluginInfo& plugin : materialPlugins())
        known.emplace_back(plugin.name);
    for (const MaterialStandIn& s : materialStandIns())
        known.emplace_back(s.name);
    context.fail(entity.where, "unknown material " + quote(entity.type) + suggestion(entity.type, known));
}

Entity standInFor(const Entity& entity, const MaterialStandIn& standIn) {
    Entity out{standIn.ours, {}, entity.where};
    for (const Parameter& p : standIn.defaults) {
        out.parameters.add(p);
        out.parameters.all().back().where = entity.where;
    }
    for (const Parameter& p : entity.parameters.all())
        for (const Renamed& name : standIn.parameters)
            if (p.name == name.from) {
                // Of another type than the default, it would not replace it.
                std::erase_if(out.parameters.all(), [&](const Parameter& q) { return q.name == name.to; });
                out.parameters.add(p);
                out.parameters.all().back().name = name.to;
            }
    return out;
}

/// What a material looks at besides its textures.
void addNeeds(SceneMaterial& made, const MaterialTable& table) {
    dispatch(MaterialTypes{}, made.handle.tag, [&]<class M>() {
        if constexpr (requires { requires M::kNeedsUv; }) made.needsUv = true;
        if constexpr (requires(const M& m) { m.needsTangent(); })
            made.needsTangent = table.rows<M>()[made.handle.row].needsTangent();
    });
}

}  // namespace

MaterialLibrary::MaterialLibrary(const SceneDescription& scene, BuildContext& context, TextureLibrary& textures,
                                 MaterialTable& table)
    : scene_(scene), context_(context), textures_(textures), table_(table) {
    for (const Entity& m : scene.materials)
        checkType(m, context);
    for (std::size_t i = 0; i < scene.namedMaterials.size(); ++i) {
        checkType(scene.namedMaterials[i], context);
        names_[scene.namedMaterials[i].name] = i;
    }
}

SceneMaterial MaterialLibrary::get(const MaterialReference& reference) {
    if (!reference.name.empty() || reference.index < 0) return getNamed(reference.name, reference.where);
    if (const auto found = unnamed_.find(reference.index); found != unnamed_.end()) return found->second;
    const Entity& entity = scene_.materials[std::size_t(reference.index)];
    return unnamed_[reference.index] = make(entity, ownerName("material", entity.type));
}

SceneMaterial MaterialLibrary::getNamed(const std::string& name, SourcePosition where) {
    const auto found = names_.find(composed(name));  // a mix names its materials in plain strings
    if (found == names_.end()) {
        std::vector<std::string> known;
        for (const auto& entry : names_)
            known.push_back(entry.first);
        context_.fail(where, "unknown material " + quote(name) + suggestion(name, known));
    }
    const auto [place, isNew] = named_.try_emplace(found->second);
    if (!isNew) {
        if (!place->second) failCycle(found->second, where);
        return *place->second;
    }
    if (making_.size() >= kDeepest) context_.fail(where, fmt::format("mixes within mixes are more than {} deep", kDeepest));
    making_.push_back(found->second);
    const SceneMaterial made = make(scene_.namedMaterials[found->second], ownerName("material", name));
    making_.pop_back();
    place->second = made;
    return made;
}

/// Says which mixes lead back to the material.
void MaterialLibrary::failCycle(std::size_t material, SourcePosition where) const {
    const auto nameOf = [&](std::size_t i) { return quote(scene_.namedMaterials[i].name); };
    std::string cycle;
    for (auto i = std::find(making_.begin(), making_.end(), material); i != making_.end(); ++i)
        cycle += nameOf(*i) + " is mixed of ";
    context_.fail(where, "the material " + nameOf(material) + " refers to itself: " + cycle + nameOf(material));
}

SceneMaterial MaterialLibrary::make(const Entity& entity, const std::string& owner) {
    if (entity.type == MixMaterial::kInfo.name) return makeMix(entity, owner);
    const MaterialStandIn* standIn = findStandIn(entity.type);
    if (!standIn || isOurs(entity.type)) return makeOurs(entity, owner);
    context_.warnOnce(
        "material " + entity.type, entity.where,
        fmt::format("the material '{}' is not there yet; '{}' stands in for it", standIn->name, standIn->ours));
    entity.parameters.markAllUsed();
    return makeOurs(standInFor(entity, *standIn), owner);
}

SceneMaterial MaterialLibrary::makeMix(const Entity& entity, const std::string& owner) {
    const Parameter* names = entity.parameters.find("string", "materials");
    if (!names || names->count() != 2) context_.fail(entity.where, owner + ": a mix needs the names of two materials");
    const SceneMaterial first = getNamed(names->strings()[0], names->where);
    const SceneMaterial second = getNamed(names->strings()[1], names->where);
    SceneMaterialInput input(entity, owner, context_, textures_, table_.tables());
    const ScalarInput amount = input.scalar("amount", 0.5f);
    context_.warnUnused(entity.parameters, owner);
    if (amount.texture == kNoTexture && amount.constant <= 0) return first;
    if (amount.texture == kNoTexture && amount.constant >= 1) return second;
    return {table_.addMix(first.handle, second.handle, amount), first.passThrough || second.passThrough,
            first.needsUv || second.needsUv || input.usesTextures(), first.needsTangent || second.needsTangent};
}

SceneMaterial MaterialLibrary::makeOurs(const Entity& entity, const std::string& owner) {
    SceneMaterialInput input(entity, owner, context_, textures_, table_.tables());
    const std::string type = canonicalType(entity.type);
    SceneMaterial made;
    made.handle = *table_.add(type, input);
    made.passThrough = MaterialTable::isPassThrough(made.handle.tag);
    made.needsUv = input.usesTextures();
    addNeeds(made, table_);
    const ParameterSet& p = entity.parameters;
    if (made.passThrough)
        p.markAllUsed();
    else
        addRelief(entity, owner, made);
    context_.warnUnused(p, owner);
    return made;
}

void MaterialLibrary::addRelief(const Entity& entity, const std::string& owner, SceneMaterial& made) {
    const ParameterSet& p = entity.parameters;
    ReliefRecord relief;
    p.number("displacement", 0);  // a constant one tilts nothing
    if (const Parameter* displacement = p.find("texture", "displacement"))
        relief.displacement = textures_.scalar(*displacement).texture;
    if (p.find("string", "normalmap")) relief = {.normalMap = textures_.normalMap(entity, owner)};  // it wins
    if (relief.isFlat()) return;
    table_.setRelief(made.handle, relief);
    made.needsUv = true;
    made.needsTangent = made.needsTangent || relief.normalMap != kNoTexture;
}

}  // namespace penumbra::builder
