// LightSource: point, spot, goniometric, projection, distant, infinite.
#include "scenes/builder/lights.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>

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
        const Vec3d p = transformPoint(light_.lightToWorld, point("from", {0, 0, 0}));
        lights_.add(PointLight{rounded(p), toSpectrum(intensity(4 * kPi))});
    }

    void addSpot() {
        const Vec3d from = point("from", {0, 0, 0}), to = point("to", {0, 0, 1});
        const Vec3d axis = {to.x - from.x, to.y - from.y, to.z - from.z};
        const float outer = context_.number(parameters_, "coneangle", 30, 0, 180);
        const float delta = context_.number(parameters_, "conedeltaangle", 5, 0, 360);
        if (!(std::hypot(axis.x, axis.y, axis.z) > 0)) fail("its points 'from' and 'to' give no direction");
        // The inner cone is what is left of the outer one; up to twice its angle the format mirrors what is more than
        // all of it, beyond that its light would shine outside of the cone.
        const float inner = delta > 2 * outer ? 0 : std::fabs(outer - delta);
        if (delta > 2 * outer)
            context_.warn(light_.where, owner_ +
                                            ": conedeltaangle is more than twice coneangle; the light falls off "
                                            "from the axis on");
        add([&] {
            SpotLight light = SpotLight::make(light_.lightToWorld, from, axis, inner, outer, {});
            light.intensity = toSpectrum(intensity(light.unitPower()));
            return light;
        });
    }

    void addGoniometric() {
        const std::string file = parameters_.text("filename", "");
        if (file.empty()) {
            context_.warn(light_.where, owner_ + ": without a filename it shines alike in all directions");
            return addPoint();
        }
        // The mean of the channels is the same in any space only before it is changed, so the image's own is taken.
        const LightImage image = squareImage(file, LightImage::Space::Own);
        std::vector<float> values;
        for (std::size_t i = 0; i < image.rgb.size(); i += 3)
            values.push_back((image.rgb[i] + image.rgb[i + 1] + image.rgb[i + 2]) / 3);
        add([&] {
            GoniometricLight light =
                GoniometricLight::make(light_.lightToWorld, values, image.width, {}, lights_.tables);
            light.intensity = toSpectrum(intensity(4 * kPi * light.mean));
            return light;
        });
    }

    void addProjection() {
        const std::string file = parameters_.text("filename", "");
        if (file.empty()) fail("needs an image, as \"string filename\"");
        const float fov = context_.number(parameters_, "fov", 90, 0.01f, 179);
        const LightImage image = readFile(file);
        const ProjectionScreen screen(image.width, image.height, fov);
        const float unitPower =
            number("power", 0) > 0
                ? float(luminance(image, [&](double u, double v) { return screen.cosineCubed(u, v); }) * screen.area())
                : 1.f;
        const float factor = checked(Rgb{1, 1, 1} * withPower(unitPower)).r;
        add([&] {
            return ProjectionLight::make(light_.lightToWorld, image.rgb, image.width, image.height, fov, factor,
                                         lights_.tables);
        });
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
        const float illuminance = number("illuminance", 0);
        if (!file.empty()) return addImage(file, illuminance);
        const Rgb radiance = checked(spectrum("L") * scale() * (illuminance > 0 ? illuminance / kPi : 1.f));
        if (const Parameter* portal = parameters_.find("point3", "portal"))
            // The image is of one colour, and fine enough to know how much its pixels cover.
            return addPortal(*portal, 64, [&](Vec3d) { return toSpectrum(radiance); });
        lights_.add(ConstantInfiniteLight{toSpectrum(radiance)});
    }

    void finish() { context_.warnUnused(parameters_, owner_); }

private:
    /// Adds the light that `make` makes; errors of it get the place.
    template <class Make>
    void add(Make make) {
        context_.placed(light_.where, owner_, [&] { lights_.add(make()); });
    }

    LightImage readFile(const std::string& file, LightImage::Space space = LightImage::Space::Film) const {
        return LightImage(file, light_.where, owner_, context_, space);
    }

    LightImage squareImage(const std::string& file, LightImage::Space space) const {
        LightImage image = readFile(file, space);
        if (image.width != image.height) failOfShape(file, image);
        return image;
    }
    [[noreturn]] void failOfShape(const std::string& file, const LightImage& image) const {
        fail(fmt::format(
            "the image {} has {} x {} pixels; it has to be square, in the equal-area octahedral map (imgtool "
            "of pbrt makes one of a latitude-longitude map)",
            quote(file, 200), image.width, image.height));
    }

    /// The format knows square images only. One of 2:1 can hardly be meant otherwise than by latitude and longitude.
    SkyMap skyMap(const std::string& file, const LightImage& image) const {
        const std::vector<std::string> known{"equalarea", "latlong"};
        const std::string mapping = parameters_.text("mapping", "");
        if (mapping == "latlong") return SkyMap::LatLong;
        if (!mapping.empty() && mapping != "equalarea")
            context_.fail(parameters_.findAny("mapping")->where,
                          "unknown mapping " + quote(mapping) + suggestion(mapping, known));
        if (mapping.empty() && image.width == 2 * image.height) {
            context_.warnOnce("latlong", light_.where,
                              owner_ +
                                  ": an image twice as wide as high is taken to go by latitude and longitude; "
                                  "\"string mapping\" \"latlong\" says so");
            return SkyMap::LatLong;
        }
        if (image.width != image.height) failOfShape(file, image);
        return SkyMap::EqualArea;
    }

    void addImage(const std::string& file, float illuminance) {
        if (BuildContext::findSpectrum(parameters_, "L")) fail("takes either L or an image, not both");
        const LightImage image = readFile(file);
        const SkyMap map = skyMap(file, image);
        float size = 1;
        if (illuminance > 0) {
            // The format divides by half of the true illuminance of an upward surface: 2 pi times the mean, over all
            // directions, of what comes from above.
            const double upward =
                kTwoPi * luminance(image, [&](double s, double t) {
                    if (map == SkyMap::LatLong)  // pi / 2 sin is the solid angle of a pixel over the mean one
                        return std::fmax(std::cos(kPi * t), 0.) * std::sin(kPi * t) * (kPi / 2);
                    return double(std::fmax(equalAreaDirection(Vec2<float>{float(s), float(t)}).z, 0.f));
                });
            if (!(upward > 0)) fail("an illuminance needs an image that is not black above the horizon");
            size = float(illuminance / upward);
        }
        const Rgb factor = checked(Rgb{1, 1, 1} * (scale() * size));
        if (const Parameter* portal = parameters_.find("point3", "portal")) {
            Matrix4 toLight;
            if (!invert(light_.lightToWorld, toLight)) fail("its matrix is singular");
            return addPortal(*portal, image.height, [&](Vec3d w) {
                const Vec3d d = transformVector(toLight, w);
                const double length = std::hypot(d.x, d.y, d.z);
                return toSpectrum(image.sky(map, {d.x / length, d.y / length, d.z / length}) * factor.r);
            });
        }
        add([&] {
            return ImageInfiniteLight::make(map, image.rgb, image.width, image.height, toSpectrum(factor),
                                            light_.lightToWorld, lights_.tables);
        });
    }

    /// The corners are given in the world, whatever the light's matrix.
    void addPortal(const Parameter& portal, std::size_t resolution, const std::function<Spectrum<float>(Vec3d)>& sky) {
        const std::vector<float>& v = portal.floats();
        if (v.size() != 12)
            context_.fail(portal.where, fmt::format("a portal needs four points, {} numbers are given", v.size()));
        std::array<Vec3d, 4> corners;
        for (std::size_t i = 0; i < 4; ++i)
            corners[i] = {v[3 * i], v[3 * i + 1], v[3 * i + 2]};
        add([&] { return PortalInfiniteLight::make(corners, resolution, sky, lights_.tables); });
    }

    /// The mean over the image's pixels of the luminance times a weight of the pixel's middle, in [0, 1]^2.
    template <class Weight>
    double luminance(const LightImage& image, Weight&& weight) const {
        return image.meanLuminance(context_.filmColorSpace(), weight);
    }

    /// Scale, and power where it is given, for a light whose flux without them is `unitPower`.
    float withPower(float unitPower) const {
        const float power = number("power", 0);
        if (!(power > 0)) return scale();
        if (!(unitPower > 0)) fail("a power needs a light that is not black");
        return scale() * (power / unitPower);
    }
    /// I, for a light whose flux is `unitPower` where I is 1.
    Rgb intensity(float unitPower) const { return checked(spectrum("I") * withPower(unitPower)); }

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
    struct Kind {
        const char* name;
        void (SourceReader::*add)();
    };
    static constexpr Kind kinds[] = {
        {"point", &SourceReader::addPoint},
        {"spot", &SourceReader::addSpot},
        {"goniometric", &SourceReader::addGoniometric},
        {"projection", &SourceReader::addProjection},
        {"distant", &SourceReader::addDistant},
        {"infinite", &SourceReader::addInfinite},
    };
    const auto kind =
        std::find_if(std::begin(kinds), std::end(kinds), [&](const Kind& k) { return light.type == k.name; });
    if (kind == std::end(kinds)) {
        std::vector<std::string> known;
        for (const Kind& k : kinds)
            known.emplace_back(k.name);
        context.fail(light.where, "unknown light " + quote(light.type) + suggestion(light.type, known));
    }
    SourceReader reader(light, context, lights);
    (reader.*kind->add)();
    reader.finish();
}

}  // namespace

void addLightSources(const SceneDescription& scene, BuildContext& context, LightTable& lights) {
    for (const LightEntity& light : scene.lights)
        addSource(light, context, lights);
}

}  // namespace penumbra::builder
