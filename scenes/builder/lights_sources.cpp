// LightSource: point, distant, infinite; and what stands in for the kinds that are not there yet.
#include "scenes/builder/lights.h"

#include "core/image/image_io.h"

#include <fmt/format.h>

#include <cmath>

namespace penumbra::builder {
namespace {

constexpr float kMost = 1e30f;

/// One light source being read.
class SourceReader {
public:
    SourceReader(const LightEntity& light, BuildContext& context, LightTable& lights)
        : light_(light),
          parameters_(light.parameters),
          context_(context),
          lights_(lights),
          owner_(ownerName("light", light.type)) {}

    void addPoint() {
        // The kinds of point light that have a shape of their own count as shining alike everywhere, with what flux
        // they are given.
        const Vec3d p = transformPoint(light_.lightToWorld, point("from", {0, 0, 0}));
        const float power = number("power", 0);
        const Rgb intensity = (light_.type == "projection" ? Rgb{1, 1, 1} : spectrum("I")) * scale() *
                              (power > 0 ? power / (4 * kPi) : 1.f);
        lights_.add(PointLight{rounded(p), toSpectrum(checked(intensity))});
    }

    void addDistant() {
        const Vec3d from = point("from", {0, 0, 0}), to = point("to", {0, 0, 1});
        const Vec3d w = transformVector(light_.lightToWorld, {from.x - to.x, from.y - to.y, from.z - to.z});
        const double size = std::hypot(w.x, w.y, w.z);
        if (!(size > 0) || !std::isfinite(size)) fail("its points 'from' and 'to' give no direction");
        const float illuminance = number("illuminance", 0);
        const Rgb irradiance = spectrum("L") * scale() * (illuminance > 0 ? illuminance : 1.f);
        lights_.add(DistantLight{rounded({w.x / size, w.y / size, w.z / size}), toSpectrum(checked(irradiance))});
    }

    void addInfinite() {
        const std::string file = parameters_.text("filename", "");
        if (const Parameter* portal = parameters_.find("point3", "portal"))
            context_.warnOnce("portal", portal->where,
                              owner_ + ": portals are not there yet; the light comes from everywhere");
        const float illuminance = number("illuminance", 0);
        if (!file.empty()) return addImage(file, illuminance);
        const Rgb radiance = spectrum("L") * scale() * (illuminance > 0 ? illuminance / kPi : 1.f);
        lights_.add(ConstantInfiniteLight{toSpectrum(checked(radiance))});
    }

    void finish() { context_.warnUnused(parameters_, owner_); }

private:
    void addImage(const std::string& file, float illuminance) {
        if (BuildContext::findSpectrum(parameters_, "L")) fail("takes either L or an image, not both");
        const std::string path = context_.placed(light_.where, owner_, [&] { return context_.path(file); });
        const Image image = context_.placed(light_.where, owner_, [&] { return readImage(path); });
        if (image.width() != image.height())
            fail(
                fmt::format("the image {} has {} x {} pixels; it has to be square, in the equal-area octahedral map "
                            "(imgtool of pbrt makes "
                            "one of a latitude-longitude map)",
                            quote(path, 200), image.width(), image.height()));
        const std::vector<float> pixels = inFilmSpace(image);
        const float size = illuminance > 0 ? illuminance / upwardIlluminance(pixels, std::size_t(image.width())) : 1.f;
        const Rgb factor = checked(Rgb{1, 1, 1} * (scale() * size));
        context_.placed(light_.where, owner_, [&] {
            lights_.add(ImageInfiniteLight::make(pixels, std::size_t(image.width()), toSpectrum(factor),
                                                 light_.lightToWorld, lights_.tables));
        });
    }

    /// r, g, b of all pixels; what is negative in the image's own space is 0.
    std::vector<float> inFilmSpace(const Image& image) const {
        const Matrix3 toFilm = lightConversion(image.colorSpace(), context_.filmColorSpace());
        std::vector<float> pixels;
        pixels.reserve(3 * std::size_t(image.width()) * std::size_t(image.height()));
        std::size_t broken = 0;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                const Rgb c = image.rgb(x, y);
                broken += !c.isFinite();
                const Rgb film = apply(toFilm, {std::fmax(c.r, 0.f), std::fmax(c.g, 0.f), std::fmax(c.b, 0.f)});
                pixels.insert(pixels.end(), {film.r, film.g, film.b});
            }
        if (broken)
            context_.warn(light_.where, fmt::format("{}: {} pixels of the image are not finite and count as black",
                                                    owner_, broken));
        return pixels;
    }

    /// What the format divides an illuminance by: half of the true one of an upward surface.
    float upwardIlluminance(const std::vector<float>& pixels, std::size_t n) const {
        double sum = 0;
        for (std::size_t y = 0; y < n; ++y)
            for (std::size_t x = 0; x < n; ++x) {
                const float* c = &pixels[3 * (y * n + x)];
                const Vec3<float> d =
                    equalAreaDirection(Vec2<float>{(float(x) + 0.5f) / float(n), (float(y) + 0.5f) / float(n)});
                const double luminance = context_.filmColorSpace().luminance({c[0], c[1], c[2]});
                if (d.z > 0 && std::isfinite(luminance)) sum += luminance * d.z;
            }
        if (!(sum > 0)) fail("an illuminance needs an image that is not black above the horizon");
        return float(kTwoPi * sum / (double(n) * double(n)));
    }

    static Vec3<float> rounded(Vec3d v) { return {float(v.x), float(v.y), float(v.z)}; }
    float number(const char* name, float otherwise) const {
        return context_.number(parameters_, name, otherwise, -kMost, kMost);
    }
    float scale() const { return context_.number(parameters_, "scale", 1, 0, kMost); }
    Rgb spectrum(const char* name) const { return context_.illuminant(parameters_, name, owner_); }
    Rgb checked(Rgb c) const {
        if (!(c.largest() <= kMost)) fail("its light is too large for a float");
        return c;
    }
    Vec3d point(const char* name, Vec3d otherwise) const {
        const Parameter* p = parameters_.find("point3", name);
        if (!p) return otherwise;
        const std::vector<float>& v = p->floats();
        if (v.size() != 3) context_.fail(p->where, fmt::format("{} needs 3 numbers, {} are given", name, v.size()));
        return {v[0], v[1], v[2]};
    }
    [[noreturn]] void fail(const std::string& text) const { context_.fail(light_.where, owner_ + ": " + text); }

    const LightEntity& light_;
    const ParameterSet& parameters_;
    BuildContext& context_;
    LightTable& lights_;
    std::string owner_;
};

void addSource(const LightEntity& light, BuildContext& context, LightTable& lights) {
    static const std::vector<std::string> known{"point", "distant", "infinite", "spot", "goniometric", "projection"};
    if (std::find(known.begin(), known.end(), light.type) == known.end())
        context.fail(light.where, "unknown light " + quote(light.type) + suggestion(light.type, known));
    SourceReader reader(light, context, lights);
    if (light.type == "distant")
        reader.addDistant();
    else if (light.type == "infinite")
        reader.addInfinite();
    else
        reader.addPoint();
    if (light.type == "point" || light.type == "distant" || light.type == "infinite") return reader.finish();
    context.warnOnce("light " + light.type, light.where,
                     "the light " + quote(light.type) + " is not there yet; 'point' stands in for it");
    light.parameters.markAllUsed();
}

}  // namespace

void addLightSources(const SceneDescription& scene, BuildContext& context, LightTable& lights) {
    for (const LightEntity& light : scene.lights)
        addSource(light, context, lights);
}

}  // namespace penumbra::builder
