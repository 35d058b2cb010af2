// Film and pixel filter.
#include "scenes/builder/settings.h"

#include <fmt/format.h>

#include <cmath>

namespace penumbra::builder {
namespace {

constexpr int kMostSide = 1 << 24;                              // coordinates of pixels are exact as floats
constexpr std::int64_t kMostPixels = std::int64_t{1} << 31;     // pixel numbers have 31 bits
constexpr std::int64_t kMostFilmBytes = std::int64_t{1} << 34;  // 16 GiB
constexpr std::int64_t kBytesPerPixel = sizeof(PixelSums) + sizeof(PixelSquares);

/// The size that the scene file gives.
struct Resolution {
    int width = 0, height = 0;
};

Resolution readResolution(const ParameterSet& film, const BuildContext& context) {
    // The product is checked, with the bytes, below.
    return {context.integer(film, "xresolution", 1280, 1, kMostSide),
            context.integer(film, "yresolution", 720, 1, kMostSide)};
}

/// Four numbers, or nothing where the parameter is absent.
template <class List>
const List* four(const Parameter* p, const List& values, const BuildContext& context) {
    if (!p) return nullptr;
    if (values.size() != 4)
        context.fail(p->where, fmt::format("{} needs 4 numbers, {} are given", p->name, values.size()));
    return &values;
}

/// A window of the picture in fractions of it, as pixels.
CropWindow cropOf(float x0, float x1, float y0, float y1, Resolution r) {
    // In float, as the format's own arithmetic, so that both agree on the last pixel.
    const auto pixel = [](float fraction, int size) { return int(std::ceil(fraction * float(size))); };
    return {pixel(x0, r.width), pixel(y0, r.height), pixel(x1, r.width), pixel(y1, r.height)};
}

CropWindow clipped(CropWindow c, Resolution r) {
    return {std::clamp(c.x0, 0, r.width), std::clamp(c.y0, 0, r.height), std::clamp(c.x1, 0, r.width),
            std::clamp(c.y1, 0, r.height)};
}

/// The command line's crop.
CropWindow cropOf(const BuildOptions& options, Resolution r) {
    CropWindow crop;
    if (options.cropWindow) {
        const auto& v = *options.cropWindow;
        crop = clipped(cropOf(v[0], v[1], v[2], v[3], r), r);
    } else {
        const auto& v = *options.pixelBounds;
        crop = clipped({v[0], v[2], v[1], v[3]}, r);
    }
    if (crop.width() <= 0 || crop.height() <= 0)
        throw Error(ErrorKind::Usage,
                    fmt::format("{} leaves no pixel of the picture of {}x{}",
                                options.cropWindow ? "--cropwindow" : "--pixelbounds", r.width, r.height));
    return crop;
}

/// `asked`: the scene's resolution; `made`: the one to render at.
CropWindow readCrop(const ParameterSet& film, Resolution asked, Resolution made, const BuildContext& context) {
    const Parameter* window = film.find("float", "cropwindow");
    const Parameter* bounds = film.find("integer", "pixelbounds");
    CropWindow crop{0, 0, made.width, made.height};
    if (window) {
        const std::vector<float>& v = *four(window, window->floats(), context);
        for (const float x : v)
            if (!(x >= 0 && x <= 1)) context.fail(window->where, fmt::format("cropwindow holds {}, outside 0 to 1", x));
        crop = clipped(cropOf(v[0], v[1], v[2], v[3], made), made);
    } else if (bounds) {
        const std::vector<std::int32_t>& v = *four(bounds, bounds->ints(), context);
        crop = clipped({v[0], v[2], v[1], v[3]}, asked);
        const auto scaled = [](int pixel, int from, int to) { return int(std::ceil(double(pixel) * to / from)); };
        crop = {scaled(crop.x0, asked.width, made.width), scaled(crop.y0, asked.height, made.height),
                scaled(crop.x1, asked.width, made.width), scaled(crop.y1, asked.height, made.height)};
    }
    if (crop.width() <= 0 || crop.height() <= 0) {
        const Parameter* given = window ? window : bounds;
        context.fail(given->where, given->name + " leaves no pixel of the picture");
    }
    return crop;
}

void checkSize(Resolution r, const CropWindow& crop, const AovSet& aovs, SourcePosition where, const BuildContext& context) {
    const std::int64_t bytesPerPixel = kBytesPerPixel + std::int64_t(AovSums::bytesPerPixel(aovs));
    const std::int64_t pixels = std::int64_t{r.width} * r.height;
    const std::int64_t cropPixels = std::int64_t{crop.width()} * crop.height();
    if (pixels <= kMostPixels && cropPixels <= kMostFilmBytes / bytesPerPixel) return;
    context.fail(
        where,
        fmt::format("a film of {} x {} pixels is too large: it would take {:.3g} bytes; at most {} pixels and {:.3g} "
                    "bytes are allowed",
                    r.width, r.height, double(cropPixels) * double(bytesPerPixel), kMostPixels,
                    double(kMostFilmBytes)));
}

/// What the film of that name keeps beside the picture, in the space that it asks for.
void readGbuffer(const FilmEntity& film, FilmSettings& settings, BuildContext& context) {
    static const std::vector<std::string> known{"camera", "world"};
    const std::string space = film.parameters.text("coordinatesystem", "camera");
    if (std::find(known.begin(), known.end(), space) == known.end())
        context.fail(film.where, "unknown coordinatesystem " + quote(space) + suggestion(space, known));
    settings.aovsInCameraSpace = space == "camera";
    for (const Aov aov : {Aov::Albedo, Aov::Normal, Aov::ShadingNormal, Aov::Position, Aov::DepthAlongX,
                          Aov::DepthAlongY, Aov::Uv})
        settings.aovs.add(aov);
    context.warn(film.where, "the film 'gbuffer' keeps albedo, N, Ns, P, dzdx, dzdy and uv, under these names, and SE "
                             "stands for Variance");
}

void readType(const FilmEntity& film, FilmSettings& settings, BuildContext& context) {
    static const std::vector<std::string> known{"rgb", "gbuffer", "spectral"};
    if (film.type == "rgb") return;
    if (film.type == "gbuffer") return readGbuffer(film, settings, context);
    if (std::find(known.begin(), known.end(), film.type) == known.end())
        context.fail(film.where, "unknown film " + quote(film.type) + suggestion(film.type, known));
    context.warn(film.where, "the film " + quote(film.type) + " is not there yet; it counts as 'rgb'");
    for (const char* name : {"nbuckets"})
        film.parameters.integer(name, 0);
    for (const char* name : {"lambdamin", "lambdamax"})
        film.parameters.number(name, 0);
}

}  // namespace

const ColorSpace& filmColorSpace(const SceneDescription& scene) {
    const ColorSpace* space = findColorSpace(scene.film.colorSpace);
    return space ? *space : srgbColorSpace();
}

FilmSettings readFilm(const FilmEntity& film, Shutter shutter, const BuildOptions& options, BuildContext& context) {
    FilmSettings settings;
    readType(film, settings, context);
    if (options.aovs) settings.aovs = *options.aovs;
    const ParameterSet& parameters = film.parameters;
    const Resolution asked = readResolution(parameters, context);
    const Resolution made = options.width > 0 && options.height > 0 ? Resolution{options.width, options.height} : asked;
    settings.width = made.width;
    settings.height = made.height;
    settings.crop = readCrop(parameters, asked, made, context);
    if (options.cropWindow || options.pixelBounds) settings.crop = cropOf(options, made);
    checkSize(made, settings.crop, settings.aovs, film.where, context);
    settings.fileName = parameters.text("filename", settings.fileName);
    settings.colorSpace = context.filmColorSpace().name;

    const FilmSensor sensor = readFilmSensor(parameters, shutter.open, shutter.close, context.filmColorSpace(),
                                             context.files(), context.warnings());
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            settings.sensorFromFilm[3 * row + column] = float(sensor.matrix.m[row][column] * sensor.imagingRatio);
    settings.maxComponent = parameters.number("maxcomponentvalue", kInfinity);
    if (!(settings.maxComponent > 0))
        context.fail(parameters.findAny("maxcomponentvalue")->where,
                     fmt::format("maxcomponentvalue {} is not above 0", settings.maxComponent));
    if (options.clamp) settings.maxComponent = *options.clamp;
    parameters.boolean("savefp16", true);  // pictures are always written in full floats
    parameters.number("diagonal", 35);     // matters to realistic cameras only
    context.warnUnused(parameters, ownerName("film", film.type));
    return settings;
}

FilterSettings readFilter(const Entity& filter, BuildContext& context) {
    struct Kind {
        const char* name;
        FilterKind kind;
        float radius;
    };
    static constexpr Kind kKinds[] = {{"box", FilterKind::Box, 0.5f},
                                      {"triangle", FilterKind::Triangle, 2},
                                      {"gaussian", FilterKind::Gaussian, 1.5f},
                                      {"mitchell", FilterKind::Mitchell, 2},
                                      {"sinc", FilterKind::Sinc, 4}};
    const auto found =
        std::find_if(std::begin(kKinds), std::end(kKinds), [&](const Kind& k) { return filter.type == k.name; });
    if (found == std::end(kKinds)) {
        std::vector<std::string> known;
        for (const Kind& k : kKinds)
            known.emplace_back(k.name);
        context.fail(filter.where, "unknown pixel filter " + quote(filter.type) + suggestion(filter.type, known));
    }
    const ParameterSet& p = filter.parameters;
    constexpr float kLeast = 1e-3f, kMostRadius = 64, kMostShape = 1e3f;
    FilterSettings s;
    s.kind = found->kind;
    s.radiusX = context.number(p, "xradius", found->radius, kLeast, kMostRadius);
    s.radiusY = context.number(p, "yradius", found->radius, kLeast, kMostRadius);
    if (s.kind == FilterKind::Gaussian) s.sigma = context.number(p, "sigma", 0.5f, kLeast, kMostShape);
    if (s.kind == FilterKind::Mitchell) {
        s.b = context.number(p, "B", 1.f / 3, -kMostShape, kMostShape);
        s.c = context.number(p, "C", 1.f / 3, -kMostShape, kMostShape);
    }
    if (s.kind == FilterKind::Sinc) s.tau = context.number(p, "tau", 3, kLeast, kMostShape);
    context.warnUnused(p, ownerName("pixel filter", filter.type));
    return s;
}

}  // namespace penumbra::builder
