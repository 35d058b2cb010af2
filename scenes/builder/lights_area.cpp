// Area lights: their parameters, and what they make of a mesh or a quadric.
#include "scenes/builder/lights.h"

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
    std::array<Vec2<float>, 3> uv{{{0, 0}, {1, 0}, {1, 1}}};  ///< of a mesh without
    Vec3<float> facing;
    double area = 0;

    LightTriangle(const Geometry& g, const ShapeRecord& shape, std::uint32_t triangle) {
        const std::uint32_t* index = &g.indices[3 * std::size_t(shape.first + triangle)];
        for (std::size_t i = 0; i < 3; ++i)
            corner[i] = at(g.positions, index[i]);
        if (shape.uvShift != kNone)
            for (std::size_t i = 0; i < 3; ++i) {
                const float* v = &g.uvs[2 * std::size_t(index[i] + shape.uvShift)];
                uv[i] = {v[0], v[1]};
            }
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

/// Whether a picture that lies rightly on the one triangle does so on the other.
bool isOnePicture(const LightTriangle& a, const LightTriangle& b) {
    LightTables tables;
    tables.pictures.push_back(onTriangle({}, a.corner, a.uv));
    const Records<float, EmissionPicture> picture(tables.pictures.data(), 0u);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2<float> uv = pictureUv<float>(picture, b.corner[i]);
        if (!(std::abs(uv.x - b.uv[i].x) < 1e-4f && std::abs(uv.y - b.uv[i].y) < 1e-4f)) return false;
    }
    return true;
}

/// The rectangle that a mesh of two triangles is, with its picture on it if there is one; nothing otherwise.
std::optional<RectangleShape> rectangleOf(const Geometry& g, const ShapeRecord& shape, bool hasPicture) {
    if (shape.count != 2) return std::nullopt;
    const LightTriangle a(g, shape, 0), b(g, shape, 1);
    if (!(dot(a.facing, b.facing) > 0) || (hasPicture && !isOnePicture(a, b))) return std::nullopt;
    return rectangleOfTriangles(a.corner, b.corner);
}

/// The area of the face that each triangle is a part of.
class FaceAreas {
public:
    FaceAreas(const Geometry& g, const ShapeRecord& shape, const std::vector<std::int32_t>& faceOfTriangle)
        : faceOfTriangle_(faceOfTriangle) {
        if (faceOfTriangle.empty()) return;
        areas_.resize(std::size_t(faceOfTriangle.back()) + 1);  // they ascend
        for (std::uint32_t i = 0; i < shape.count; ++i)
            areas_[std::size_t(faceOfTriangle[i])] += LightTriangle(g, shape, i).area;
    }
    double of(std::uint32_t index, const LightTriangle& triangle) const {
        return faceOfTriangle_.empty() ? triangle.area : areas_[std::size_t(faceOfTriangle_[index])];
    }

private:
    const std::vector<std::int32_t>& faceOfTriangle_;
    std::vector<double> areas_;
};

/// Adds a light on a shape, with the picture as `lay` lays it there.
template <class Light, class Lay>
void addLight(const AreaEmission& emission, Light light, LightTable& lights, Lay&& lay) {
    if (emission.picture) {
        light.flags |= kLightPictured;
        light.picture = std::uint32_t(lights.tables.pictures.size());
        lights.tables.pictures.push_back(lay(*emission.picture));
    }
    lights.add(light);
}

}  // namespace

Spectrum<float> AreaEmission::radianceOf(double area) const {
    if (!(power > 0)) return toSpectrum(radiance);
    const double factor = power / (kPi * area * pictureLuminance * (twoSided ? 2 : 1));
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
    if (!file.empty()) readPicture(entity, file, owner, emission);
    emission.radiance = (file.empty() ? context_.illuminant(p, "L", owner) : Rgb{1, 1, 1}) * scale;
    if (!(emission.radiance.largest() <= kMost))
        context_.fail(entity.where, owner + ": the radiance is too large for a float");
    context_.warnUnused(p, owner);
    return emission;
}

void AreaLightLibrary::readPicture(const Entity& entity, const std::string& file, const std::string& owner,
                                   AreaEmission& emission) {
    const LightImage image(file, entity.where, owner, context_);
    emission.pictureLuminance = image.meanLuminance(context_.filmColorSpace(), [](double, double) { return 1.; });
    emission.picture = context_.placed(entity.where, owner,
                                       [&] { return makePicture(image.rgb, image.width, image.height, tables_); });
}

void addMeshLights(const AreaEmission& emission, const Geometry& geometry,
                   const std::vector<std::int32_t>& faceOfTriangle, LightTable& lights, ShapeRecord& shape) {
    const FaceAreas areas(geometry, shape, faceOfTriangle);
    const std::uint32_t flags = lightFlags(emission, shape);
    shape.light = lights.size();
    if (const std::optional<RectangleShape> r = rectangleOf(geometry, shape, emission.picture.has_value())) {
        const LightTriangle half(geometry, shape, 0);
        const Spectrum<float> radiance = emission.radianceOf(areas.of(0, half));
        addLight(
            emission, RectangleLight::make(r->corner, r->edgeX, r->edgeY, half.facing, radiance, flags), lights,
            [&](const EmissionPicture& picture) { return onTriangle(picture, half.corner, half.uv); });
        return;
    }
    shape.lightStride = 1;
    for (std::uint32_t i = 0; i < shape.count; ++i) {
        const LightTriangle t(geometry, shape, i);
        const Spectrum<float> radiance = emission.radianceOf(areas.of(i, t));
        addLight(
            emission, TriangleLight::make(t.corner[0], t.corner[1], t.corner[2], t.facing, radiance, flags), lights,
            [&](const EmissionPicture& picture) { return onTriangle(picture, t.corner, t.uv); });
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
        const auto add = [&]<class Light>(Light light, auto&& lay) {
            const bool made = Light::make(worldFromObject, q.radius, q.zMin, q.zMax, q.phiMax,
                                          emission.radianceOf(area), flags | (flipped ? kLightReversed : 0u), light);
            if (made)
                addLight(emission, light, lights, lay);
            else
                shape.light = kNone;
        };
        if (q.kind == ShapeKind::Sphere)
            add(SphereLight{}, [&](const EmissionPicture& picture) {
                return onRound(picture, EmissionPicture::Sphere,
                               worldFromObject * scaling(q.radius, q.radius, q.radius), q.phiMax, q.thetaMax,
                               q.thetaMin);
            });
        else
            add(CylinderLight{}, [&](const EmissionPicture& picture) {
                return onRound(picture, EmissionPicture::Cylinder,
                               worldFromObject * scaling(q.radius, q.radius, q.radius), q.phiMax,
                               double(q.zMin) / q.radius, double(q.zMax) / q.radius);
            });
        return;
    }
    const double inner = double(q.innerRadius) / q.radius;
    const double area = 0.5 * q.phiMax * q.radius * q.radius * (1 - inner * inner);
    const Vec3<float> up = loadAffine<float>(&q.worldFromObject, 0u).normal({0, 0, flipped ? -1.f : 1.f});
    const Matrix4 fromUnit = worldFromObject * translation(0, 0, q.zMin) * scaling(q.radius, q.radius, q.radius);
    addLight(emission,
             DiskLight::make(rounded(transformPoint(worldFromObject, {0, 0, q.zMin})),
                             rounded(transformVector(worldFromObject, {q.radius, 0, 0})),
                             rounded(transformVector(worldFromObject, {0, q.radius, 0})), float(inner), q.phiMax, up,
                             emission.radianceOf(area), flags),
             lights, [&](const EmissionPicture& picture) {
                 return onRound(picture, EmissionPicture::Disk, fromUnit, q.phiMax, 1, inner);
             });
}

}  // namespace penumbra::builder
