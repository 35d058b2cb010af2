// What all parts of the scene builder share: the place of things in messages, warnings, colours, files.
//
// Thread safety: none; one instance belongs to one build.
#pragma once

#include "core/color/spectrum_parameter.h"
#include "core/math/spectrum.h"
#include "scenes/description.h"

#include <set>

namespace penumbra::builder {

class BuildContext {
public:
    /// All three must outlive this object.
    BuildContext(const SceneDescription& scene, const ColorSpace& film, Warnings& warnings);

    const ColorSpace& filmColorSpace() const { return spectra_.film; }
    std::span<const std::string> files() const { return spectra_.files; }
    Warnings& warnings() { return spectra_.warnings; }
    const SpectrumContext& spectra() const { return spectra_; }

    /// "file:line:column".
    std::string position(SourcePosition where) const { return formatPosition(files(), where); }
    [[noreturn]] void fail(SourcePosition where, const std::string& text, ErrorKind kind = ErrorKind::BadData) const;
    void warn(SourcePosition where, const std::string& text);
    /// The first time only for each `kind` of warning: what is not there yet is said once, not at every place that
    /// wants it.
    void warnOnce(const std::string& kind, SourcePosition where, const std::string& text);
    /// Warns of parameters that nothing asked for; `owner` as in "shape 'sphere'".
    void warnUnused(const ParameterSet& parameters, const std::string& owner);

    /// Calls f(); an Error of it that has no place yet gets this one.
    template <class Function>
    auto placed(SourcePosition where, const std::string& owner, Function&& f) const {
        try {
            return f();
        } catch (const ErrorAt&) {
            throw;
        } catch (const Error& error) {
            fail(where, owner + ": " + error.what(), error.kind());
        }
    }

    /// The path of a file of the scene; throws where it is not to be read, so call it inside placed().
    std::string path(const std::string& name) const { return spectra_.resolvePath(name); }

    /// The rgb, blackbody or spectrum of that name; null where absent.
    static const Parameter* findSpectrum(const ParameterSet& parameters, std::string_view name);
    /// An emitted spectrum; white where absent.
    Rgb illuminant(const ParameterSet& parameters, std::string_view name, const std::string& owner) const;

    /// A finite number between the limits, else an error that names the parameter and both.
    float number(const ParameterSet& parameters, std::string_view name, float otherwise, float least, float most) const;
    int integer(const ParameterSet& parameters, std::string_view name, int otherwise, int least, int most) const;

private:
    SpectrumContext spectra_;
    std::set<std::string> said_;
};

inline Spectrum<float> toSpectrum(Rgb c) {
    return {c.r, c.g, c.b};
}

/// "shape 'sphere'".
inline std::string ownerName(std::string_view what, std::string_view name) {
    return std::string(what) + " " + quote(name);
}

}  // namespace penumbra::builder
