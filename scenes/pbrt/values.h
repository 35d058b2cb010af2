// Values: what follows the word of a directive: strings, numbers, and lists of `"type name" value` parameters.
//
// A value is one token or a list in brackets. Habits of files for pbrt-v3 are understood: quoted "true" and "false",
// the types point, vector, color, normal3, and brackets around any fixed number of numbers.
//
// Invariants of what readParameters returns: no two parameters have one name (the last wins, with a warning); no value
// is empty; the number of values fits the type (a multiple of 3 for point3, ...; one for texture); rgb is not negative,
// and knows its colour space. Hostile input: a directive has at most kMostParameters parameters. Errors: ErrorAt with
// the place of what was found. Thread safety: none; one instance belongs to one thread.
#pragma once

#include "core/base/warnings.h"
#include "scenes/pbrt/sources.h"

#include <span>
#include <string>
#include <string_view>

namespace penumbra::pbrt {

class ValueReader {
public:
    static constexpr std::size_t kMostParameters = 256;

    /// Both must outlive this object.
    ValueReader(Sources& sources, const SceneDescription& scene, Warnings& warnings)
        : sources_(sources), scene_(scene), warnings_(warnings) {}

    /// A string in quotes; `what` says what it is, for the message where there is none: "the type of the shape".
    std::string readString(std::string_view what);
    /// The same as a name of the scene's own: names are compared in Unicode's composed form.
    std::string readName(std::string_view what);
    bool stringFollows() { return sources_.peek().kind == TokenKind::String; }
    /// Exactly so many numbers, with or without brackets; `directive` is whose they are.
    void readNumbers(std::string_view directive, std::span<double> out);

    ParameterSet readParameters(const std::string& colorSpace);
    /// The value of a parameter whose type, name and place are known.
    void readValue(Parameter& p);
    /// Passes over one value of any kind.
    void skipValue();
    /// Passes over all strings, lists, numbers and booleans up to the next word that is none.
    void skipValues();

private:
    Parameter readDeclaration();
    void addOrReplace(ParameterSet& set, Parameter p);
    void readSpectrum(Parameter& p);
    template <class T>
    std::vector<T> readNumberList();
    /// Calls visit(token) for every word and string of a value.
    template <class Visit>
    void visitValue(Visit&& visit);
    static void checkValue(const Parameter& p);
    std::string inListFrom(const Token& open) const;
    [[noreturn]] void failInList(const Token& open, const Token& found) const;

    Sources& sources_;
    const SceneDescription& scene_;
    Warnings& warnings_;
};

}  // namespace penumbra::pbrt
