// ParameterSet: the typed "type name" values of one directive of a scene, with their places in the text.
//
// Types are the scene format's own words (float, integer, bool, string, point2, vector2, point3, vector3, normal, rgb,
// blackbody, spectrum, texture). A look-up asks for an exact type and marks the parameter used; whatever no look-up has
// asked for can be reported afterwards ("unknown parameter 'radios'; did you mean 'radius'?").
// A value from the command line has no type of its own: it takes the one that the first look-up asks for.
//
// Errors: a look-up of one value that finds several throws ErrorAt with the parameter's place.
// Thread safety: look-ups write marks, so one set belongs to one thread.
#pragma once

#include "core/base/error.h"
#include "core/base/warnings.h"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace penumbra {

struct Parameter {
    std::string type, name;  ///< no type: an override that nothing has asked for yet
    SourcePosition where;
    /// float, point*, vector*, normal, rgb, blackbody, numeric spectrum: floats. integer: ints. string, texture, named
    /// or file spectrum: strings. bool: bools (as bytes).
    std::variant<std::vector<float>, std::vector<std::int32_t>, std::vector<std::string>, std::vector<std::uint8_t>>
        values;
    std::string colorSpace;  ///< the space in force where an rgb was written ("srgb", ...)
    bool inherited = false;  ///< came from an Attribute directive: never reported as unused
    mutable bool used = false;

    const std::vector<float>& floats() const { return std::get<std::vector<float>>(values); }
    const std::vector<std::int32_t>& ints() const { return std::get<std::vector<std::int32_t>>(values); }
    const std::vector<std::string>& strings() const { return std::get<std::vector<std::string>>(values); }
    const std::vector<std::uint8_t>& bools() const { return std::get<std::vector<std::uint8_t>>(values); }
    bool isText() const { return std::holds_alternative<std::vector<std::string>>(values); }
    std::size_t count() const;  ///< of single values: 6 for a point3 array of two points
};

/// The words a scene file may use as the type of a parameter.
std::span<const std::string> parameterTypes();

/// Invariant: of several parameters of one type and name the last added wins (find walks from the back).
class ParameterSet {
public:
    void add(Parameter p) { list_.push_back(std::move(p)); }
    /// A value from the command line, in the place of all parameters of that name. Numbers are separated by commas.
    void override(const std::string& name, const std::string& text, SourcePosition where);
    const std::vector<Parameter>& all() const { return list_; }
    std::vector<Parameter>& all() { return list_; }

    /// The parameter of that type and name, marked used; null where absent.
    const Parameter* find(std::string_view type, std::string_view name) const;
    /// The last of that name, of any type; null where absent. Does not mark it used, but the name counts as asked for.
    const Parameter* findAny(std::string_view name) const;

    float number(std::string_view name, float otherwise) const;                   // "float"
    int integer(std::string_view name, int otherwise) const;                      // "integer"
    bool boolean(std::string_view name, bool otherwise) const;                    // "bool"
    std::string text(std::string_view name, const std::string& otherwise) const;  // "string"
    /// The array, empty where absent. `type` is one of the float-valued words; integers() is for "integer".
    const std::vector<float>& numbers(std::string_view type, std::string_view name) const;
    const std::vector<std::int32_t>& integers(std::string_view name) const;

    /// Warns of every parameter that no look-up asked for: of one asked for as another type with that type, of any
    /// other with the nearest name that was asked for. `object` is whose they are, as a message says it ("shape
    /// 'sphere'"). An override that no look-up asked for is ErrorAt(Usage).
    void warnUnused(std::span<const std::string> files, std::string_view object, Warnings& warnings) const;
    /// Marks all parameters used (for objects that are substituted whole).
    void markAllUsed() const;

private:
    /// What look-ups asked for: the known names of warnUnused. An empty type stands for any.
    struct Asked {
        std::string type, name;
    };
    const Parameter* findSingle(std::string_view type, std::string_view name) const;
    bool wasAsked(std::string_view type, std::string_view name) const;
    void noteAsked(std::string_view type, std::string_view name) const;
    std::vector<std::string> namesAsked() const;
    std::string unusedMessage(const Parameter& p, std::string_view object) const;

    mutable std::vector<Parameter> list_;  ///< mutable: marks, and the types of overrides
    mutable std::vector<Asked> asked_;
};

}  // namespace penumbra
