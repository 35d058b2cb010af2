#include "core/color/sensor.h"

#include "core/color/spectrum.h"

#include <fmt/format.h>

#include <cmath>

namespace penumbra {
namespace {

std::span<const std::string> sensorNames() {
    static const std::vector<std::string> names{
        "cie1931",       "canon_eos_100d",     "canon_eos_1dx_mkii", "canon_eos_200d",    "canon_eos_200d_mkii",
        "canon_eos_5d",  "canon_eos_5d_mkii",  "canon_eos_5d_mkiii", "canon_eos_5d_mkiv", "canon_eos_5ds",
        "canon_eos_m",   "hasselblad_l1d_20c", "nikon_d810",         "nikon_d850",        "sony_ilce_6400",
        "sony_ilce_7m3", "sony_ilce_7rm3",     "sony_ilce_9"};
    return names;
}

/// The position of a parameter that the film's parameters hold.
SourcePosition whereIs(const ParameterSet& film, std::string_view name) {
    const Parameter* p = film.findAny(name);
    return p ? p->where : SourcePosition{};
}

/// True for cie1931, false for a camera. Unknown ones warn and count as cie1931.
bool isObserver(const ParameterSet& film, std::span<const std::string> files, Warnings& warnings) {
    const std::string name = film.text("sensor", "cie1931");
    const std::span<const std::string> known = sensorNames();
    if (std::find(known.begin(), known.end(), name) != known.end()) return name == "cie1931";
    warnings.add(fmt::format("{}: unknown sensor {}, taken as cie1931{}",
                             formatPosition(files, whereIs(film, "sensor")), quote(name), suggestion(name, known)));
    return true;
}

}  // namespace

Matrix3 whiteBalanceMatrix(double kelvin, const ColorSpace& space) {
    const Chromaticity lamp = chromaticityOf(xyzSum(daylightSpectrum(kelvin)));
    return space.rgbFromXyz * bradfordAdaptation(lamp, space.white) * space.xyzFromRgb;
}

FilmSensor readFilmSensor(const ParameterSet& film, double shutterOpen, double shutterClose, const ColorSpace& space,
                          std::span<const std::string> files, Warnings& warnings) {
    const bool observer = isObserver(film, files, warnings);
    const double iso = film.number("iso", 100);
    const double whiteBalance = film.number("whitebalance", observer ? 0 : 6500);
    // Below about 1000 K no white can be told from a lamp so red, and the adaptation would divide by almost nothing.
    constexpr double kLeastKelvin = 1000, kMostKelvin = 1e6;
    if (!(iso > 0) || !std::isfinite(iso))
        throw Error(ErrorKind::BadData,
                    fmt::format("{}: iso {} is not above 0", formatPosition(files, whereIs(film, "iso")), iso));
    if (whiteBalance != 0 && !(whiteBalance >= kLeastKelvin && whiteBalance <= kMostKelvin))
        throw Error(
            ErrorKind::BadData,
            fmt::format("{}: whitebalance {} is outside the allowed range, {} to {} K, or 0 for none",
                        formatPosition(files, whereIs(film, "whitebalance")), whiteBalance, kLeastKelvin, kMostKelvin));
    FilmSensor sensor;
    sensor.imagingRatio = (shutterClose - shutterOpen) * iso / 100;
    if (whiteBalance != 0) sensor.matrix = whiteBalanceMatrix(whiteBalance, space);
    return sensor;
}

}  // namespace penumbra
