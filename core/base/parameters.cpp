#include "core/base/parameters.h"

#include <algorithm>

namespace penumbra {

std::span<const std::string> parameterTypes() {
    static const std::vector<std::string> types{"float",     "integer",  "bool",    "string", "point2",
                                                "vector2",   "point3",   "vector3", "normal", "rgb",
                                                "blackbody", "spectrum", "texture"};
    return types;
}

std::size_t Parameter::count() const {
    return std::visit([](const auto& list) { return list.size(); }, values);
}

bool ParameterSet::wasAsked(std::string_view type, std::string_view name) const {
    return std::any_of(asked_.begin(), asked_.end(), [&](const Asked& a) { return a.name == name && a.type == type; });
}

void ParameterSet::noteAsked(std::string_view type, std::string_view name) const {
    if (!wasAsked(type, name)) asked_.push_back({std::string(type), std::string(name)});
}

const Parameter* ParameterSet::find(std::string_view type, std::string_view name) const {
    noteAsked(type, name);
    for (auto p = list_.rbegin(); p != list_.rend(); ++p)
        if (p->name == name && p->type == type) {
            p->used = true;
            return &*p;
        }
    return nullptr;
}

const Parameter* ParameterSet::findAny(std::string_view name) const {
    noteAsked("", name);
    for (auto p = list_.rbegin(); p != list_.rend(); ++p)
        if (p->name == name) return &*p;
    return nullptr;
}

const Parameter* ParameterSet::findSingle(std::string_view type, std::string_view name) const {
    const Parameter* p = find(type, name);
    if (p && p->count() != 1)
        throw ErrorAt(p->where, "'" + p->type + " " + p->name + "' must be one value, but " +
                                    std::to_string(p->count()) + " are given");
    return p;
}

float ParameterSet::number(std::string_view name, float otherwise) const {
    const Parameter* p = findSingle("float", name);
    return p ? p->floats().front() : otherwise;
}

int ParameterSet::integer(std::string_view name, int otherwise) const {
    const Parameter* p = findSingle("integer", name);
    return p ? p->ints().front() : otherwise;
}

bool ParameterSet::boolean(std::string_view name, bool otherwise) const {
    const Parameter* p = findSingle("bool", name);
    return p ? p->bools().front() != 0 : otherwise;
}

std::string ParameterSet::text(std::string_view name, const std::string& otherwise) const {
    const Parameter* p = findSingle("string", name);
    return p ? p->strings().front() : otherwise;
}

const std::vector<float>& ParameterSet::numbers(std::string_view type, std::string_view name) const {
    static const std::vector<float> none;
    const Parameter* p = find(type, name);
    return p ? p->floats() : none;
}

const std::vector<std::int32_t>& ParameterSet::integers(std::string_view name) const {
    static const std::vector<std::int32_t> none;
    const Parameter* p = find("integer", name);
    return p ? p->ints() : none;
}

std::string ParameterSet::unusedMessage(const Parameter& p, std::string_view object) const {
    std::string types;
    std::vector<std::string> names;
    for (const Asked& a : asked_) {
        if (a.name == p.name && !a.type.empty()) types += (types.empty() ? "" : " or ") + a.type;
        if (a.name != p.name) names.push_back(a.name);
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    const std::string start = "parameter " + quote(p.type + " " + p.name) + " of " + std::string(object);
    if (!types.empty()) return start + " is ignored: it has to be of type " + types;
    return start + " is unknown" + suggestion(p.name, names);
}

void ParameterSet::warnUnused(std::span<const std::string> files, std::string_view object, Warnings& warnings) const {
    for (const Parameter& p : list_) {
        const bool shadowed = wasAsked(p.type, p.name);  // a later twin was found in its place
        if (!p.used && !p.inherited && !shadowed)
            warnings.add(formatPosition(files, p.where) + ": " + unusedMessage(p, object));
    }
}

void ParameterSet::markAllUsed() const {
    for (const Parameter& p : list_)
        p.used = true;
}

}  // namespace penumbra
