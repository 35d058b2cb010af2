#include "core/color/spectrum.h"

#include "core/base/number_file.h"
#include "core/base/text.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace penumbra {
namespace {

constexpr int kKnotStep = 5, kKnotCount = (kWavelengthCount - 1) / kKnotStep + 1;
using Knots = std::array<double, kKnotCount>;
struct NamedKnots {
    const char* name;
    Knots knots;
};

#include "core/color/data/builtin_spectra.inc"
#include "core/color/data/observer.inc"

SampledSpectrum linearBetween(const Knots& knots) {
    SampledSpectrum out;
    for (int i = 0; i < kWavelengthCount; ++i) {
        const int left = std::min(i / kKnotStep, kKnotCount - 2);
        const double t = double(i - left * kKnotStep) / kKnotStep;
        out.values[i] = (1 - t) * knots[left] + t * knots[left + 1];
    }
    return out;
}

/// Six-point Lagrange interpolation: takes the observer from 5 nm back to the standard's 1 nm table within 1e-5 of its
/// peak, where straight lines would be off by 1e-3.
SampledSpectrum smoothBetween(const Knots& knots) {
    constexpr int kPoints = 6;
    SampledSpectrum out;
    for (int i = 0; i < kWavelengthCount; ++i) {
        const int first = std::clamp(i / kKnotStep - kPoints / 2 + 1, 0, kKnotCount - kPoints);
        const double x = double(i) / kKnotStep - first;
        for (int a = 0; a < kPoints; ++a) {
            double weight = 1;
            for (int b = 0; b < kPoints; ++b)
                if (b != a) weight *= (x - b) / (a - b);
            out.values[i] += weight * knots[first + a];
        }
    }
    return out;
}

struct Builtins {
    std::vector<std::string> names;
    std::vector<SampledSpectrum> spectra;
    Builtins() {
        for (const NamedKnots& entry : kBuiltin) {
            names.emplace_back(entry.name);
            spectra.push_back(linearBetween(entry.knots));
        }
    }
};

const Builtins& builtins() {
    static const Builtins all;
    return all;
}

const std::array<SampledSpectrum, 3>& observer() {
    static const std::array<SampledSpectrum, 3> curves{smoothBetween(kObserver[0]), smoothBetween(kObserver[1]),
                                                       smoothBetween(kObserver[2])};
    return curves;
}

double planck(double metres, double kelvin) {
    constexpr double kLight = 299792458, kPlanck = 6.62606957e-34, kBoltzmann = 1.3806488e-23;
    const double fifth = metres * metres * metres * metres * metres;
    return 2 * kPlanck * kLight * kLight / (fifth * std::expm1(kPlanck * kLight / (metres * kBoltzmann * kelvin)));
}

void checkPairs(std::span<const float> pairs, std::string_view what) {
    const auto fail = [&](const std::string& reason) {
        throw Error(ErrorKind::BadData, fmt::format("{}: {}", what, reason));
    };
    if (pairs.empty() || pairs.size() % 2 != 0)
        fail(fmt::format("a spectrum is given by pairs of wavelength (nm) and value, but there are {} numbers",
                         pairs.size()));
    for (std::size_t i = 0; i < pairs.size(); i += 2) {
        if (!std::isfinite(pairs[i]) || !std::isfinite(pairs[i + 1])) fail("a number of the spectrum is not finite");
        if (!(pairs[i] > 0)) fail(fmt::format("wavelength {} nm is not above 0", pairs[i]));
        if (i > 0 && !(pairs[i] > pairs[i - 2]))
            fail(fmt::format("wavelengths have to rise, but {} nm follows {} nm", pairs[i], pairs[i - 2]));
    }
}

}  // namespace

SampledSpectrum constantSpectrum(double value) {
    SampledSpectrum out;
    out.values.fill(value);
    return out;
}

SampledSpectrum blackbodySpectrum(double kelvin) {
    constexpr double kWien = 2.8977721e-3;
    const double peak = planck(kWien / kelvin, kelvin);
    SampledSpectrum out;
    for (int i = 0; i < kWavelengthCount; ++i)
        out.values[i] = planck((kFirstWavelength + i) * 1e-9, kelvin) / peak;
    return out;
}

SampledSpectrum daylightSpectrum(double kelvin) {
    const double t =
        kelvin * 1.4388 / 1.4380;  // the scale's second radiation constant has changed since D65 was defined
    if (t < 4000) return blackbodySpectrum(t);
    const double x = t <= 7000 ? ((-4.607e9 / t + 2.9678e6) / t + 0.09911e3) / t + 0.244063
                               : ((-2.0064e9 / t + 1.9018e6) / t + 0.24748e3) / t + 0.23704;
    const double y = (-3 * x + 2.870) * x - 0.275;
    const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
    const double m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m, m2 = (0.03 - 31.4424 * x + 30.0717 * y) / m;
    Knots knots;
    for (int i = 0; i < kKnotCount; ++i)
        knots[i] = kDaylight[0][i] + m1 * kDaylight[1][i] + m2 * kDaylight[2][i];
    return linearBetween(knots);
}

SampledSpectrum piecewiseLinearSpectrum(std::span<const float> pairs, std::string_view what) {
    checkPairs(pairs, what);
    SampledSpectrum out;
    std::size_t right = 0;  // the first knot at or beyond the wavelength
    const std::size_t count = pairs.size() / 2;
    for (int i = 0; i < kWavelengthCount; ++i) {
        const double nm = kFirstWavelength + i;
        while (right < count && pairs[2 * right] < nm)
            ++right;
        if (right == count) break;
        const double x1 = pairs[2 * right], y1 = pairs[2 * right + 1];
        if (x1 == nm) {
            out.values[i] = y1;
        } else if (right > 0) {
            const double x0 = pairs[2 * right - 2], y0 = pairs[2 * right - 1];
            out.values[i] = y0 + (y1 - y0) * ((nm - x0) / (x1 - x0));
        }
    }
    return out;
}

SampledSpectrum readSpectrumFile(const std::string& path) {
    return piecewiseLinearSpectrum(readNumbers(path, "spectrum"), pathText(path));
}

const SampledSpectrum* findBuiltinSpectrum(std::string_view name) {
    const Builtins& all = builtins();
    const auto found = std::find(all.names.begin(), all.names.end(), name);
    return found == all.names.end() ? nullptr : &all.spectra[found - all.names.begin()];
}

std::span<const std::string> builtinSpectrumNames() {
    return builtins().names;
}

Triple colorMatching(int index) {
    return {observer()[0].values[index], observer()[1].values[index], observer()[2].values[index]};
}

Triple xyzSum(const SampledSpectrum& spectrum) {
    Triple sum{};
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < kWavelengthCount; ++i)
            sum[c] += observer()[c].values[i] * spectrum.values[i];
    return sum;
}

Rgb illuminantToRgb(const SampledSpectrum& spectrum, const ColorSpace& space, std::string_view what) {
    const Triple xyz = xyzSum(spectrum);
    if (!(xyz[1] > 0) || !std::isfinite(xyz[1]) || !std::isfinite(1 / xyz[1]))
        throw Error(ErrorKind::BadData, fmt::format("{}: the spectrum emits nothing between {} and {} nm", what,
                                                    kFirstWavelength, kLastWavelength));
    return space.fromXyz({xyz[0] / xyz[1], 1, xyz[2] / xyz[1]});
}

const ChannelWeights& channelWeights(const ColorSpace& space) {
    const auto make = [](const ColorSpace& s) {
        const SampledSpectrum& white = *findBuiltinSpectrum(s.illuminant);
        ChannelWeights weights;
        Triple sum{};
        for (int i = 0; i < kWavelengthCount; ++i) {
            const Triple rgb = s.rgbFromXyz * colorMatching(i);
            for (int c = 0; c < 3; ++c)
                sum[c] += weights.rows[c][i] = rgb[c] * white.values[i];
        }
        for (int c = 0; c < 3; ++c)
            for (double& w : weights.rows[c])
                w /= sum[c];
        return weights;
    };
    static const std::vector<std::pair<const ColorSpace*, ChannelWeights>> all = [&] {
        std::vector<std::pair<const ColorSpace*, ChannelWeights>> list;
        for (const std::string& name : colorSpaceNames())
            list.emplace_back(findColorSpace(name), make(*findColorSpace(name)));
        return list;
    }();
    return std::find_if(all.begin(), all.end(), [&](const auto& entry) { return entry.first == &space; })->second;
}

Rgb reflectanceToRgb(const SampledSpectrum& spectrum, const ColorSpace& space) {
    const ChannelWeights& weights = channelWeights(space);
    Triple sum{};
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < kWavelengthCount; ++i)
            sum[c] += weights.rows[c][i] * spectrum.values[i];
    return {float(sum[0]), float(sum[1]), float(sum[2])};
}

}  // namespace penumbra
