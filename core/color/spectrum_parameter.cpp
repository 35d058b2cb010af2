#include "core/color/spectrum_parameter.h"

#include <fmt/format.h>

#include <cmath>

namespace penumbra {
namespace {

/// One parameter being read: its values, and messages that say where it stands.
class Reader {
public:
    Reader(const Parameter& p, const SpectrumContext& context, std::string_view owner)
        : p_(p),
          context_(context),
          prefix_(fmt::format("{}: {} of {}", formatPosition(context.files, p.where), quote(p.type + " " + p.name),
                              owner)) {}

    const std::string& prefix() const { return prefix_; }

    [[noreturn]] void fail(const std::string& reason, ErrorKind kind = ErrorKind::BadData) const {
        throw Error(kind, prefix_ + ": " + reason);
    }

    /// The values, all finite; `count` of them where it is not 0.
    const std::vector<float>& numbers(std::size_t count) const {
        if (!std::holds_alternative<std::vector<float>>(p_.values)) fail("expected numbers");
        const std::vector<float>& list = p_.floats();
        if (count != 0 && list.size() != count)
            fail(fmt::format("expected {} number{}, found {}", count, count == 1 ? "" : "s", list.size()));
        for (const float v : list)
            if (!std::isfinite(v)) fail("a number is not finite");
        return list;
    }

    double kelvin() const {
        const float t = numbers(1).front();
        if (!(t > 0)) fail(fmt::format("a temperature of {} K is not above 0", t));
        return t;
    }

    Rgb rgb(float largest) const {
        const std::vector<float>& v = numbers(3);
        for (const float c : v)
            if (!(c >= 0 && c <= largest))
                fail(fmt::format("{} is outside the allowed range, {}", c,
                                 std::isfinite(largest) ? fmt::format("0 to {}", largest) : "0 and above"));
        return {v[0], v[1], v[2]};
    }

    /// The space in which an rgb was written; scene readers have complained of unknown ones already.
    const ColorSpace& space() const {
        const ColorSpace* found = findColorSpace(p_.colorSpace);
        return found ? *found : srgbColorSpace();
    }

    /// The curve of a blackbody or spectrum, nowhere negative.
    SampledSpectrum curve() const {
        if (p_.type == "blackbody") return blackbodySpectrum(kelvin());
        if (p_.type != "spectrum") fail("expected an rgb, blackbody or spectrum");
        SampledSpectrum s = p_.isText() ? named() : piecewiseLinearSpectrum(numbers(0), prefix_);
        bool negative = false;
        for (double& v : s.values) {
            negative = negative || v < 0;
            v = std::max(v, 0.0);
        }
        if (negative) context_.warnings.add(prefix_ + ": negative values of the spectrum count as 0");
        return s;
    }

private:
    SampledSpectrum named() const {
        if (p_.strings().size() != 1) fail(fmt::format("expected one name, found {}", p_.strings().size()));
        const std::string& name = p_.strings().front();
        if (const SampledSpectrum* builtin = findBuiltinSpectrum(name)) return *builtin;
        try {
            return readSpectrumFile(context_.resolvePath(name));
        } catch (const Error& e) {
            const bool looksLikeName = name.find_first_of("./\\") == std::string::npos;
            if (e.kind() != ErrorKind::MissingInput || !looksLikeName) fail(e.what(), e.kind());
            fail(fmt::format("{} is neither a built-in spectrum nor a file{}", quote(name),
                             suggestion(name, builtinSpectrumNames())));
        }
    }

    const Parameter& p_;
    const SpectrumContext& context_;
    std::string prefix_;
};

/// A curve's value for a dielectric: the mean as the eye weights it under D65. Where a curve is 0 (outside the range of
/// its file) it counts as 1, no border at all.
double meanIndex(const SampledSpectrum& curve) {
    const SampledSpectrum& d65 = *findBuiltinSpectrum("stdillum-D65");
    double sum = 0, weights = 0;
    for (int i = 0; i < kWavelengthCount; ++i) {
        const double weight = colorMatching(i)[1] * d65.values[i];
        sum += weight * (curve.values[i] == 0 ? 1 : curve.values[i]);
        weights += weight;
    }
    return sum / weights;
}

/// Half of a conductor's index: numbers per channel, or a curve.
struct IndexPart {
    bool isCurve = false;
    SampledSpectrum curve;
    Rgb numbers;
};

IndexPart readIndexPart(const Parameter* p, std::string_view copper, const SpectrumContext& context,
                        std::string_view owner) {
    IndexPart part;
    part.isCurve = !p || p->type != "rgb";
    if (!p)
        part.curve = *findBuiltinSpectrum(copper);
    else if (part.isCurve)
        part.curve = Reader(*p, context, owner).curve();
    else
        part.numbers = readSpectrumParameter(*p, SpectrumRole::Unbounded, context, owner);
    return part;
}

}  // namespace

Rgb readSpectrumParameter(const Parameter& p, SpectrumRole role, const SpectrumContext& context,
                          std::string_view owner) {
    const Reader reader(p, context, owner);
    const bool isLight = role == SpectrumRole::Illuminant;
    Rgb color;
    if (p.type == "rgb") {
        const ColorSpace& space = reader.space();
        color = apply(isLight ? lightConversion(space, context.film) : reflectanceConversion(space, context.film),
                      reader.rgb(role == SpectrumRole::Albedo ? 1 : INFINITY));
    } else {
        color = isLight ? illuminantToRgb(reader.curve(), context.film, reader.prefix())
                        : reflectanceToRgb(reader.curve(), context.film);
    }
    if (!color.isFinite()) reader.fail("the colour is too large for a float");
    if (isLight) return color;  // a colour outside the film's space is still that light
    return clamp(color, 0, role == SpectrumRole::Albedo ? 1 : INFINITY);
}

float readIndexOfRefraction(const Parameter& p, const SpectrumContext& context, std::string_view owner) {
    const Reader reader(p, context, owner);
    double index = 0;
    if (p.type == "float")
        index = reader.numbers(1).front();
    else if (p.type == "rgb")
        index = reader.rgb(INFINITY).mean();
    else
        index = meanIndex(reader.curve());
    if (!(index > 0) || !std::isfinite(float(index)))
        reader.fail(fmt::format("an index of refraction of {} is not above 0", index));
    return float(index);
}

ConductorIndex readConductorIndex(const Parameter* eta, const Parameter* k, const SpectrumContext& context,
                                  std::string_view owner) {
    const IndexPart e = readIndexPart(eta, "metal-Cu-eta", context, owner);
    const IndexPart a = readIndexPart(k, "metal-Cu-k", context, owner);
    if (e.isCurve && a.isCurve) return fitConductor(e.curve, a.curve, context.film);
    const auto perChannel = [&](const IndexPart& part) {
        return part.isCurve ? clamp(reflectanceToRgb(part.curve, context.film), 0, INFINITY) : part.numbers;
    };
    return {perChannel(e), perChannel(a)};
}

}  // namespace penumbra
