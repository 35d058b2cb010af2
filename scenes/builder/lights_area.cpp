// Area lights: their parameters, and what they make of a mesh or a quadric.
#include "scenes/builder/lights.h"

#include "core/image/image_io.h"

#include <fmt/format.h>

#include <cmath>

namespace penumbra::builder {
namespace {

constexpr float kMost = 1e30f;

std::uint32_t lightFlags(const AreaEmission& emission, const ShapeRecord& shape) {
    const std::uint32_t sides = emission.twoSided ? kLightTwoSided : 0u;
    // A shape that no ray meets has one strategy only, and its weight must not be shared.
    if (shape.flags & kShapeInvisible) return sides | kLightUnmet;
    return sides | (shape.isMasked() ? kLightPierced : 0u);
}

Vec3<float> rounded(Vec3d v) {
    return {float(v.x), float(v.y), float(v.z)};
}

/// One triangle of a shape, facing the way that hits of it do.
struct LightTriangle {
    std::array<Vec3<float>, 3> corner;
    Vec3<float> facing;
    double area = 0;

    LightTriangle(const Geometry& g, const ShapeRecord& shape, std::uint32_t triangle) {
        const std::uint32_t* index = &g.indices[3 * std::size_t(shape.first + triangle)];
        for (std::size_t i = 0; i < 3; ++i)
            corner[i] = at(g.positions, index[i]);
        const auto edge = [&](std::size_t i) {
            return Vec3<double>{double(corner[i].x) - corner[0].x, double(corner[i].y) - corner[0].y,
                                double(corner[i].z) - corner[0].z};
        };
        Vec3<double> n = cross(edge(1), edge(2));
        const double twice = std::sqrt(dot(n, n));
        area = 0.5 * twice;
        n = n * ((shape.flags & kShapeFlipNormal ? -1 : 1) / twice);
        if (shape.normalShift != kNone) {
            // The vertex normals say which side is outside, as they do at hits.
            Vec3<double> sum{};
            for (std::size_t i = 0; i < 3; ++i) {
                const Vec3<float> v = at(g.normals, index[i] + shape.normalShift);
                sum += Vec3<double>{v.x, v.y, v.z};
            }
            if (dot(sum, n) < 0) n = -n;
        }
        facing = {float(n.x), float(n.y), float(n.z)};
    }

private:
    static Vec3<float> at(const std::vector<float>& table, std::uint32_t row) {
        const float* v = &table[3 * std::size_t(row)];
        return {v[0], v[1], v[2]};
    }
};

/// The rectangle that a mesh of two triangles is; nothing otherwise.
std::optional<RectangleShape> rectangleOf(const Geometry& g, const ShapeRecord& shape) {
    if (shape.count != 2) return std::nullopt;
    const LightTriangle a(g, shape, 0), b(g, shape, 1);
    if (!(dot(a.facing, b.facing) > 0)) return std::nullopt;
    return rectangleOfTriangles(a.corner, b.corner);
}

}  // namespace

Spectrum<float> AreaEmission::radianceOf(double area) const {
    if (!(power > 0)) return toSpectrum(radiance);
    const double factor = power / (kPi * area * (twoSided ? 2 : 1));
    return toSpectrum(radiance * float(std::fmin(factor, kMost)));
}

const AreaEmission& AreaLightLibrary::get(int index) {
    const auto [place, isNew] = read_.try_emplace(index);
    if (isNew) place->second = read(scene_.areaLights[std::size_t(index)]);
    return place->second;
}

AreaEmission AreaLightLibrary::read(const Entity& entity) {
    if (entity.type != "diffuse") {
        const std::vector<std::string> known{"diffuse"};
        context_.fail(entity.where, "unknown area light " + quote(entity.type) + suggestion(entity.type, known));
    }
    const ParameterSet& p = entity.parameters;
    const std::string owner = ownerName("area light", entity.type);
    AreaEmission emission;
    emission.twoSided = p.boolean("twosided", false);
    emission.power = context_.number(p, "power", 0, -kMost, kMost);
    const float scale = context_.number(p, "scale", 1, 0, kMost);
    const std::string file = p.text("filename", "");
    if (!file.empty() && BuildContext::findSpectrum(p, "L"))
        context_.fail(entity.where, owner + ": takes either L or an image, not both");
    emission.radiance =
        (file.empty() ? context_.illuminant(p, "L", owner) : readImageMean(entity, file, owner)) * scale;
    if (!(emission.radiance.largest() <= kMost))
        context_.fail(entity.where, owner + ": the radiance is too large for a float");
    context_.warnUnused(p, owner);
    return emission;
}

/// The image's mean; with a power, scaled to luminance 1, as the format divides by it.
Rgb AreaLightLibrary::readImageMean(const Entity& entity, const std::string& file, const std::string& owner) {
    context_.warnOnce("area light image", entity.where,
                      owner + ": images on area lights are not there yet; their mean stands in for them");
    const Image image = context_.placed(entity.where, owner, [&] { return readImage(context_.path(file)); });
    std::array<double, 3> sum{};
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Rgb c = image.rgb(x, y);
            const float channel[3] = {c.r, c.g, c.b};
            for (std::size_t i = 0; i < 3; ++i)
                if (std::isfinite(channel[i])) sum[i] += std::fmax(channel[i], 0.f);
        }
    const double count = double(image.width()) * image.height();
    const Rgb mean = apply(lightConversion(image.colorSpace(), context_.filmColorSpace()),
                           {float(sum[0] / count), float(sum[1] / count), float(sum[2] / count)});
    const double luminance = context_.filmColorSpace().luminance(mean);
    return entity.parameters.number("power", 0) > 0 && luminance > 0 ? mean / float(luminance) : mean;
}

void addMeshLights(const AreaEmission& emission, const Geometry& geometry, LightTable& lights, ShapeRecord& shape) {
    const std::uint32_t flags = lightFlags(emission, shape);
    shape.light = lights.size();
    if (const std::optional<RectangleShape> r = rectangleOf(geometry, shape)) {
        const LightTriangle half(geometry, shape, 0);
        lights.add(
            RectangleLight::make(r->corner, r->edgeX, r->edgeY, half.facing, emission.radianceOf(half.area), flags));
        return;
    }
    shape.lightStride = 1;
    for (std::uint32_t i = 0; i < shape.count; ++i) {
        const LightTriangle t(geometry, shape, i);
        lights.add(
            TriangleLight::make(t.corner[0], t.corner[1], t.corner[2], t.facing, emission.radianceOf(t.area), flags));
    }
}

void addQuadricLight(const AreaEmission& emission, const QuadricRecord& q, const Matrix4& worldFromObject,
                     LightTable& lights, ShapeRecord& shape) {
    const std::uint32_t flags = lightFlags(emission, shape);
    const bool flipped = shape.flags & kShapeFlipNormal;
    shape.light = lights.size();
    // Power goes by the area in object space, as the format has it.
    if (q.kind != ShapeKind::Disk) {
        const double area = double(q.phiMax) * q.radius * (double(q.zMax) - q.zMin);
        const auto add = [&]<class Light>(Light light) {
            const bool made = Light::make(worldFromObject, q.radius, q.zMin, q.zMax, q.phiMax,
                                          emission.radianceOf(area), flags | (flipped ? kLightReversed : 0u), light);
            if (made)
                lights.add(light);
            else
                shape.light = kNone;
        };
        q.kind == ShapeKind::Sphere ? add(SphereLight{}) : add(CylinderLight{});
        return;
    }
    const double inner = double(q.innerRadius) / q.radius;
    const double area = 0.5 * q.phiMax * q.radius * q.radius * (1 - inner * inner);
    const Vec3<float> up = loadAffine<float>(&q.worldFromObject, 0u).normal({0, 0, flipped ? -1.f : 1.f});
    lights.add(DiskLight::make(rounded(transformPoint(worldFromObject, {0, 0, q.zMin})),
                               rounded(transformVector(worldFromObject, {q.radius, 0, 0})),
                               rounded(transformVector(worldFromObject, {0, q.radius, 0})), float(inner), q.phiMax, up,
                               emission.radianceOf(area), flags));
}

}  // namespace penumbra::builder
