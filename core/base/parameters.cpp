#include "core/base/parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace penumbra {
namespace {

/// The whole word as a number; false where it is none.
template <class Number>
bool parseNumber(std::string_view word, Number& value) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size();
}

template <class Number>
std::vector<Number> parseNumbers(const std::string& text, SourcePosition where) {
    std::vector<Number> numbers;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find_first_of(", ", begin), text.size());
        const std::string word = text.substr(begin, end - begin);
        Number n{};
        if (!parseNumber(word, n) || !std::isfinite(double(n)))
            throw ErrorAt(where,
                          quote(word) + (std::is_integral_v<Number> ? " is not a whole number" : " is not a number"),
                          ErrorKind::Usage);
        numbers.push_back(n);
        begin = end + 1;
    }
    return numbers;
}

/// Gives an override the type that is asked for.
void convert(Parameter& p, std::string_view type) {
    const std::string text = p.strings().front();
    if (type == "bool") {
        if (text != "true" && text != "false")
            throw ErrorAt(p.where, quote(text) + " is neither true nor false", ErrorKind::Usage);
        p.values = std::vector<std::uint8_t>{text == "true"};
    } else if (type == "integer") {
        p.values = parseNumbers<std::int32_t>(text, p.where);
    } else if (type != "string" && type != "texture") {
        p.values = parseNumbers<float>(text, p.where);
    }
    p.type = type;
}

}  // namespace

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
    if (!list_.empty() && !wasAsked(type, name)) asked_.push_back({std::string(type), std::string(name)});
}

const Parameter* ParameterSet::find(std::string_view type, std::string_view name) const {
    noteAsked(type, name);
    for (auto p = list_.rbegin(); p != list_.rend(); ++p)
        if (p->name == name && (p->type == type || p->type.empty())) {
            if (p->type.empty()) convert(*p, type);
            p->used = true;
            return &*p;
        }
    return nullptr;
}

void ParameterSet::override(const std::string& name, const std::string& text, SourcePosition where) {
    std::erase_if(list_, [&](const Parameter& p) { return p.name == name; });
    list_.push_back({.type = "", .name = name, .where = where, .values = std::vector{text}, .colorSpace = ""});
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

std::vector<std::string> ParameterSet::namesAsked() const {
    std::vector<std::string> names;
    for (const Asked& a : asked_)
        names.push_back(a.name);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

std::string ParameterSet::unusedMessage(const Parameter& p, std::string_view object) const {
    std::string types;
    for (const Asked& a : asked_)
        if (a.name == p.name && !a.type.empty()) types += (types.empty() ? "" : " or ") + a.type;
    const std::string start = "parameter " + quote(p.type + " " + p.name) + " of " + std::string(object);
    if (!types.empty()) return start + " is ignored: it has to be of type " + types;
    return start + " is unknown" + suggestion(p.name, namesAsked());
}

void ParameterSet::warnUnused(std::span<const std::string> files, std::string_view object, Warnings& warnings) const {
    for (const Parameter& p : list_) {
        if (p.used || p.inherited) continue;
        if (p.type.empty())
            throw ErrorAt(p.where,
                          std::string(object) + " has no parameter " + quote(p.name) + suggestion(p.name, namesAsked()),
                          ErrorKind::Usage);
        if (!wasAsked(p.type, p.name))  // else a later twin was found in its place
            warnings.add(formatPosition(files, p.where) + ": " + unusedMessage(p, object));
    }
    asked_ = {};  // of a million lights these names would be most of the memory
}

void ParameterSet::markAllUsed() const {
    for (const Parameter& p : list_)
        p.used = true;
}

}  // namespace penumbra
