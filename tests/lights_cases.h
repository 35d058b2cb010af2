// The configurations in which every registered light type is tested. A new type needs a specialisation of LightCases:
// without it the property tests do not compile, with it they all run on the type.
#pragma once

#include "core/math/double_vector.h"
#include "lights/registry.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace penumbra::test {

/// One light (id 0 of its table) and a point that looks at it.
struct LightCase {
    std::string name;
    LightTable lights;
    Vec3<float> from{};
    /// All points of the light that a ray from `from` in the unit direction w meets with nothing before them but the
    /// light's own openings; empty function for delta lights. Computed in double, by other means than the light's own.
    std::function<std::vector<LightHit<float>>(const Vec3d& w)> meet;
};

template <class T>
struct LightCases;  // static std::vector<LightCase> make(double scale): everything scaled about the origin

inline const Spectrum<float> kTestRadiance = {2.f, 1.f, 0.5f};

/// A picture of 5 x 4 pixels, none of them black.
inline EmissionPicture testPicture(LightTables& tables) {
    std::vector<float> rgb;
    for (int i = 0; i < 3 * 20; ++i)
        rgb.push_back(0.5f + float(i * 7 % 11));
    return makePicture(rgb, 5, 4, tables);
}

/// Puts a picture on the only light of the table.
template <class T>
void putPicture(LightTable& lights, const EmissionPicture& picture) {
    T light = lights.rows<T>()[0];
    const LightTables tables = lights.tables;
    lights = {};
    lights.tables = tables;
    lights.tables.pictures.push_back(picture);
    light.flags |= kLightPictured;
    lights.add(light);
}

inline LightHit<float> hitAt(const Vec3<float>& from, Vec3d w, double t) {
    return {from, rounded(widened(from) + w * t), rounded(w)};
}

/// Meets the plane of corner + a ex + b ey where `inside(a, b)`.
template <class Inside>
auto meetPlane(const Vec3<float>& from, Vec3d corner, Vec3d ex, Vec3d ey, Inside inside) {
    return [=](const Vec3d& w) {
        const Vec3d n = cross(ex, ey), toCorner = corner - widened(from);
        const double t = dot(toCorner, n) / dot(w, n);
        const Vec3d q = w * t - toCorner;
        const double a = dot(cross(q, ey), n) / dot(n, n), b = dot(cross(ex, q), n) / dot(n, n);
        std::vector<LightHit<float>> hits;
        if (t > 0 && inside(a, b)) hits.push_back(hitAt(from, w, t));
        return hits;
    };
}

template <>
struct LightCases<RectangleLight> {
    static std::vector<LightCase> make(double scale) {
        std::vector<LightCase> cases;
        const auto add = [&](std::string name, Vec3d corner, Vec3d ex, Vec3d ey, Vec3d facing, Vec3d from,
                             std::uint32_t flags = 0, bool classic = false) {
            LightCase c;
            c.name = "rectangle " + name;
            corner = corner * scale, ex = ex * scale, ey = ey * scale;
            c.from = rounded(from * scale);
            c.lights.add(
                RectangleLight::make(rounded(corner), rounded(ex), rounded(ey), rounded(facing), kTestRadiance, flags));
            c.lights.tables.classicArea = classic;
            c.meet = meetPlane(c.from, corner, ex, ey,
                               [](double a, double b) { return a >= 0 && a <= 1 && b >= 0 && b <= 1; });
            cases.push_back(std::move(c));
        };
        const Vec3d x{1, 0, 0}, y{0, 1, 0}, down{0, 0, -1}, up{0, 0, 1};
        add("over its corner", {0, 0, 1}, x, y, down, {0, 0, 0});
        add("by area", {0, 0, 1}, x, y, down, {0, 0, 0}, 0, true);
        add("centred", {-1, -1, 1}, x * 2, y * 2, down, {0, 0, 0});
        add("very near", {-1, -1, 0.01}, x * 2, y * 2, down, {0.1, 0.2, 0});
        add("grazing", {0.5, -0.5, 0.02}, x, y, down, {0, 0, 0});
        add("beside", {2, 3, 1}, x, y * 0.5, down, {0, 0, 0});
        add("long", {-5, 0.1, 0.2}, x * 10, y * 0.1, down, {0, 0, 0});
        add("small", {-0.05, 0.03, 1}, x * 0.06, y * 0.03, down, {0, 0, 0});
        add("tiny, by area", {-0.05, 0.03, 1}, x * 0.008, y * 0.008, down, {0, 0, 0});
        add("two-sided from behind", {0, 0, 1}, x, y, up, {0.2, 0.7, 0}, kLightTwoSided);
        add("tilted", {0.3, -0.2, 1}, {0.6, 0.8, 0}, {-0.48, 0.36, 0.8}, {0, 0, -1}, {0, 0, 0}, kLightUnmet);
        add("with a picture", {-1, -1, 1}, x * 2, y * 2, down, {0, 0, 0});
        LightTable& lights = cases.back().lights;
        putPicture<RectangleLight>(lights,
                                   onTriangle(testPicture(lights.tables),
                                              {rounded(Vec3d{-1, -1, 1} * scale), rounded(Vec3d{1, -1, 1} * scale),
                                               rounded(Vec3d{-1, 1, 1} * scale)},
                                              {{{0, 0}, {1, 0}, {0, 1}}}));
        return cases;
    }
};

template <>
struct LightCases<TriangleLight> {
    static std::vector<LightCase> make(double scale) {
        std::vector<LightCase> cases;
        const auto add = [&](std::string name, Vec3d a, Vec3d b, Vec3d c, Vec3d from, std::uint32_t flags = 0,
                             bool classic = false) {
            LightCase l;
            l.name = "triangle " + name;
            a = a * scale, b = b * scale, c = c * scale;
            l.from = rounded(from * scale);
            l.lights.add(TriangleLight::make(rounded(a), rounded(b), rounded(c), rounded(widened(l.from) - a),
                                             kTestRadiance, flags));
            l.lights.tables.classicArea = classic;
            l.meet =
                meetPlane(l.from, a, b - a, c - a, [](double u, double v) { return u >= 0 && v >= 0 && u + v <= 1; });
            cases.push_back(std::move(l));
        };
        add("over its corner", {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 0});
        add("by area", {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 0}, 0, true);
        add("around", {-1, -1, 0.3}, {2, -0.5, 0.4}, {0, 1.5, 0.2}, {0, 0, 0});
        add("very near", {-1, -1, 0.01}, {2, -0.5, 0.01}, {0, 1.5, 0.01}, {0, 0, 0});
        add("nearly all", {-10, -10, 0.01}, {20, -5, 0.01}, {0, 15, 0.01}, {0, 0, 0});
        add("sliver", {-1, 0, 1}, {1, 0.02, 1}, {0, 0.03, 1}, {0, 0, 0});
        add("grazing", {1, -0.5, 0.05}, {2, -0.5, 0.05}, {1, 0.5, 0.05}, {0, 0, 0});
        add("small", {0.5, 0.5, 1}, {0.53, 0.5, 1.01}, {0.5, 0.54, 1}, {0, 0, 0});
        add("tiny, by area", {0.5, 0.5, 1}, {0.51, 0.5, 1.01}, {0.5, 0.51, 1}, {0, 0, 0});
        add("other winding", {0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {0.2, 0.1, 0}, kLightTwoSided);
        add("with a picture", {-1, -1, 0.5}, {2, -0.5, 0.8}, {0, 1.5, 0.6}, {0, 0, 0});
        LightTable& lights = cases.back().lights;
        const TriangleLight& light = lights.rows<TriangleLight>()[0];
        putPicture<TriangleLight>(lights,
                                  onTriangle(testPicture(lights.tables),
                                             {light.corner, light.corner + light.edgeB, light.corner + light.edgeC},
                                             {{{-0.2f, 0.1f}, {0.9f, 0.3f}, {0.5f, 1.2f}}}));
        return cases;
    }
};

template <>
struct LightCases<SphereLight> {
    static constexpr double kFull = 2 * std::numbers::pi;
    struct Part {
        double zMin = -1, zMax = 1, phiMax = kFull;
        bool whole() const { return zMin == -1 && zMax == 1 && phiMax == kFull; }
    };
    static std::vector<LightCase> make(double scale) {
        std::vector<LightCase> cases;
        const auto add = [&](std::string name, Matrix4 m, Vec3d from, Part part = {}, std::uint32_t flags = 0,
                             bool classic = false) {
            LightCase c;
            c.name = "sphere " + name;
            m = scaling(scale, scale, scale) * m;
            c.from = rounded(from * scale);
            SphereLight light;
            SphereLight::make(m, 1, part.zMin, part.zMax, part.phiMax, kTestRadiance, flags, light);
            c.lights.add(light);
            c.lights.tables.classicArea = classic;
            c.meet = meet(c.from, m, part);
            cases.push_back(std::move(c));
        };
        const Matrix4 unit, ellipsoid = translation(0, 0.5, 3) * rotation(40, 1, 2, 0) * scaling(0.5, 1.5, 1);
        add("at 2", translation(0, 0, 2), {0, 0, 0});
        add("at 2 by area", translation(0, 0, 2), {0, 0, 0}, {}, 0, true);
        add("at 30", translation(0, 20, 20), {0, 0, 0});
        add("near its surface", translation(0, 0, 1.001), {0, 0, 0});
        add("from inside", unit, {0.3, -0.2, 0.4}, {}, kLightReversed);
        add("from inside, two-sided by area", unit, {0.3, -0.2, 0.4}, {}, kLightTwoSided, true);
        add("mirrored", translation(1, 1, 2) * scaling(-0.7, 0.7, 0.7), {0, 0, 0});
        add("ellipsoid", ellipsoid, {0, 0, 0});
        add("ellipsoid from inside", scaling(0.5, 1.5, 1), {0.1, 0.2, 0.3}, {}, kLightTwoSided);
        add("zone", translation(0, 0, 3), {0.2, 0, 0}, {-0.5, 0.3, kFull});
        add("bowl, two-sided", translation(0, 0, 3), {0, 0, 0}, {-1, 0.2, 4.0}, kLightTwoSided);
        add("sector of an ellipsoid", ellipsoid, {0, 0, 0}, {-0.9, 0.7, 3.0}, kLightReversed);
        add("with a picture", translation(1, 1, 2) * rotation(70, 1, 0, 2), {0, 0, 0});
        LightTable& lights = cases.back().lights;
        putPicture<SphereLight>(
            lights, onRound(testPicture(lights.tables), EmissionPicture::Sphere,
                            scaling(scale, scale, scale) * translation(1, 1, 2) * rotation(70, 1, 0, 2), kFull,
                            std::numbers::pi, 0));
        return cases;
    }

private:
    static std::function<std::vector<LightHit<float>>(const Vec3d&)> meet(const Vec3<float>& from, const Matrix4& m,
                                                                          Part part) {
        Matrix4 inverse;
        invert(m, inverse);
        return [=](const Vec3d& w) {
            const Vec3d o = transformPoint(inverse, widened(from)), d = transformVector(inverse, w);
            const double a = dot(d, d), b = dot(o, d), c = dot(o, o) - 1, root = b * b - a * c;
            std::vector<LightHit<float>> hits;
            if (root < 0) return hits;
            for (const double t : {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a}) {
                const Vec3d q = o + d * t;
                double phi = std::atan2(q.y, q.x);
                if (phi < 0) phi += kFull;
                const bool exists = part.whole() || (q.z >= part.zMin && q.z <= part.zMax && phi <= part.phiMax);
                if (t > 0 && exists) hits.push_back(hitAt(from, w, t));
                if (part.whole() && !hits.empty()) break;
            }
            return hits;
        };
    }
};

template <>
struct LightCases<DiskLight> {
    static std::vector<LightCase> make(double scale) {
        std::vector<LightCase> cases;
        const auto add = [&](std::string name, Vec3d center, Vec3d rx, Vec3d ry, double inner, double phiMax,
                             Vec3d from, std::uint32_t flags = 0) {
            LightCase c;
            c.name = "disk " + name;
            center = center * scale, rx = rx * scale, ry = ry * scale;
            c.from = rounded(from * scale);
            c.lights.add(DiskLight::make(rounded(center), rounded(rx), rounded(ry), float(inner), float(phiMax),
                                         rounded(widened(c.from) - center), kTestRadiance, flags));
            c.meet = meetPlane(c.from, center, rx, ry, [=](double a, double b) {
                const double r = std::sqrt(a * a + b * b), phi = std::atan2(b, a);
                return r <= 1 && r >= inner && (phi < 0 ? phi + 2 * std::numbers::pi : phi) <= phiMax;
            });
            cases.push_back(std::move(c));
        };
        const double full = 2 * std::numbers::pi;
        add("on its axis", {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0, full, {0, 0, 0});
        add("beside", {2, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0, full, {0, 0, 0});
        add("ring", {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0.5, full, {0.3, 0, 0});
        add("sector of a ring", {0.5, 0, 1}, {0, 1, 0}, {1, 0, 0}, 0.3, 4, {0, 0, 0}, kLightTwoSided);
        add("ellipse", {0, 1, 2}, {1.5, 0, 0.5}, {0.2, 0.6, 0}, 0, full, {0, 0, 0});
        add("ring with a picture", {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0.5, full, {0.3, 0, 0});
        LightTable& lights = cases.back().lights;
        putPicture<DiskLight>(lights, onRound(testPicture(lights.tables), EmissionPicture::Disk,
                                              scaling(scale, scale, scale) * translation(0, 0, 1), full, 1, 0.5));
        return cases;
    }
};

template <>
struct LightCases<CylinderLight> {
    static std::vector<LightCase> make(double scale) {
        std::vector<LightCase> cases;
        const double full = 2 * std::numbers::pi;
        const auto add = [&](std::string name, Matrix4 m, double zMin, double zMax, double phiMax, Vec3d from,
                             std::uint32_t flags = 0) {
            LightCase c;
            c.name = "cylinder " + name;
            m = scaling(scale, scale, scale) * m;
            c.from = rounded(from * scale);
            CylinderLight light;
            CylinderLight::make(m, 0.5, zMin, zMax, phiMax, kTestRadiance, flags, light);
            c.lights.add(light);
            c.meet = meet(c.from, m, zMin, zMax, phiMax);
            cases.push_back(std::move(c));
        };
        const Matrix4 lying = translation(0, 0, 2) * rotation(90, 1, 0, 0);
        add("across", lying, -1, 1, full, {0, 0, 0});
        add("thin and long", lying * scaling(0.1, 0.1, 4), -1, 1, full, {0, 0, 0});
        add("from inside, reversed", Matrix4{}, -1, 0.5, full, {0.1, 0.2, 0.1}, kLightReversed);
        add("along its axis, two-sided", translation(0.2, 0, 2), -1, 1, full, {0, 0, 0}, kLightTwoSided);
        add("gutter", lying, -0.5, 1, 3.5, {0, 0, 0}, kLightTwoSided);
        add("elliptic and mirrored", translation(0, 0.5, 2) * rotation(40, 1, 2, 0) * scaling(-0.5, 1.5, 1), -0.9, 0.7,
            5.0, {0, 0, 0}, kLightReversed);
        add("with a picture", lying, -1, 1, full, {0, 0, 0});
        LightTable& lights = cases.back().lights;
        putPicture<CylinderLight>(lights,
                                  onRound(testPicture(lights.tables), EmissionPicture::Cylinder,
                                          scaling(scale, scale, scale) * lying * scaling(0.5, 0.5, 0.5), full, -2, 2));
        return cases;
    }

private:
    static std::function<std::vector<LightHit<float>>(const Vec3d&)> meet(const Vec3<float>& from, const Matrix4& m,
                                                                          double zMin, double zMax, double phiMax) {
        Matrix4 inverse;
        invert(m, inverse);
        return [=](const Vec3d& w) {
            const Vec3d o = transformPoint(inverse, widened(from)), d = transformVector(inverse, w);
            const double a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y, c = o.x * o.x + o.y * o.y - 0.25;
            std::vector<LightHit<float>> hits;
            if (b * b < a * c) return hits;
            for (const double root : {-std::sqrt(b * b - a * c), std::sqrt(b * b - a * c)}) {
                const double t = (root - b) / a, z = o.z + t * d.z, phi = std::atan2(o.y + t * d.y, o.x + t * d.x);
                const bool exists = z >= zMin && z <= zMax && (phi < 0 ? phi + 2 * std::numbers::pi : phi) <= phiMax;
                if (t > 0 && exists) hits.push_back(hitAt(from, w, t));
            }
            return hits;
        };
    }
};

template <>
struct LightCases<PointLight> {
    static std::vector<LightCase> make(double scale) {
        LightCase c;
        c.name = "point";
        c.lights.add(PointLight{rounded(Vec3d{1, 2, 2} * scale), kTestRadiance * float(scale * scale)});
        return {c};
    }
};

template <>
struct LightCases<SpotLight> {
    static std::vector<LightCase> make(double scale) {
        std::vector<LightCase> cases;
        const auto add = [&](std::string name, Vec3d from, Vec3d axis, double inner, double outer) {
            LightCase c;
            c.name = "spot " + name;
            c.lights.add(SpotLight::make(scaling(scale, scale, scale), from, axis, inner, outer,
                                         kTestRadiance * float(scale * scale)));
            cases.push_back(std::move(c));
        };
        add("from its axis", {0, 0, 2}, {0, 0, -3}, 25, 30);
        add("from its edge", {1, 2, 2}, {0, -2, -2}, 10, 40);
        add("from its rim", {0, 0, 5}, {0, 2.6e-5, -1}, 1e-3, 2e-3);
        return cases;
    }
};

template <>
struct LightCases<GoniometricLight> {
    static std::vector<LightCase> make(double scale) {
        LightCase c;
        c.name = "goniometric";
        std::vector<float> image;
        for (int i = 0; i < 25; ++i)
            image.push_back(float(i % 7));
        c.lights.add(GoniometricLight::make(scaling(scale, scale, scale) * translation(1, 2, 2) * rotation(40, 1, 2, 3),
                                            image, 5, kTestRadiance * float(scale * scale), c.lights.tables));
        return {c};
    }
};

template <>
struct LightCases<ProjectionLight> {
    static std::vector<LightCase> make(double scale) {
        LightCase c;
        c.name = "projection";
        std::vector<float> image;
        for (int i = 0; i < 3 * 12; ++i)
            image.push_back(float(i % 5 + 1));
        c.lights.add(ProjectionLight::make(scaling(scale, scale, scale) * translation(1, 0, 2) * rotation(170, 0, 1, 0),
                                           image, 4, 3, 60, float(scale * scale), c.lights.tables));
        return {c};
    }
};

template <>
struct LightCases<DistantLight> {
    static std::vector<LightCase> make(double) {
        LightCase c;
        c.name = "distant";
        c.lights.add(DistantLight{{0.6f, 0.f, 0.8f}, kTestRadiance});
        return {c};
    }
};

inline std::vector<LightHit<float>> meetInfinity(const Vec3d& w) {
    return {LightHit<float>{{}, {}, rounded(w)}};
}

template <>
struct LightCases<ConstantInfiniteLight> {
    static std::vector<LightCase> make(double) {
        LightCase c;
        c.name = "infinite constant";
        c.lights.add(ConstantInfiniteLight{kTestRadiance});
        c.meet = meetInfinity;
        return {c};
    }
};

template <>
struct LightCases<ImageInfiniteLight> {
    static std::vector<LightCase> make(double) {
        std::vector<LightCase> cases;
        const auto add = [&](std::string name, SkyMap map, std::size_t n, const Matrix4& m, auto pixel) {
            LightCase c;
            c.name = "infinite image " + name;
            const std::size_t width = map == SkyMap::LatLong ? 2 * n : n;
            std::vector<float> rgb;
            for (std::size_t y = 0; y < n; ++y) {
                for (std::size_t x = 0; x < width; ++x) {
                    const float value = pixel(x, y);
                    rgb.insert(rgb.end(), {value, 0.5f * value, 2.f * value});
                }
            }
            const ImageInfiniteLight light =
                ImageInfiniteLight::make(map, rgb, width, n, kTestRadiance, m, c.lights.tables);
            c.lights.add(light);
            c.meet = meetInfinity;
            cases.push_back(std::move(c));
        };
        const auto bright = [](auto x, auto y) { return x == 2 && y == 5 ? 100.f : 1.f; };
        add("of one pixel", SkyMap::EqualArea, 1, Matrix4{}, [](auto, auto) { return 1.f; });
        add("with a bright pixel", SkyMap::EqualArea, 8, rotation(50, 1, 1, 0), bright);
        add("half black", SkyMap::EqualArea, 5, rotation(-90, 1, 0, 0),
            [](auto x, auto y) { return y < 3 ? 0.f : float(x); });
        add("mirrored", SkyMap::EqualArea, 6, scaling(1, -1, 1), [](auto x, auto y) { return float(x * x + y); });
        add("by latitude, with a bright pixel", SkyMap::LatLong, 8, rotation(50, 1, 1, 0), bright);
        add("by latitude, bright poles", SkyMap::LatLong, 7, rotation(20, 1, 0, 0),
            [](auto x, auto y) { return y == 0 || y == 6 ? 30.f : float(x % 3); });
        return cases;
    }
};

template <>
struct LightCases<PortalInfiniteLight> {
    static std::vector<LightCase> make(double scale) {
        std::vector<LightCase> cases;
        // The window: 2 wide, 1 high, 1 above and turned a little; x of its frame along ex, y along ey, out is +z.
        const auto add = [&](std::string name, Vec3d corner, Vec3d ex, Vec3d ey, std::size_t n, auto sky) {
            LightCase c;
            c.name = "infinite portal " + name;
            corner = corner * scale, ex = ex * scale, ey = ey * scale;
            c.lights.add(PortalInfiniteLight::make({corner, corner + ey, corner + ex + ey, corner + ex}, n, sky,
                                                   c.lights.tables));
            const auto window = meetPlane(c.from, corner, ex, ey,
                                          [](double a, double b) { return a >= 0 && a <= 1 && b >= 0 && b <= 1; });
            c.meet = [=](const Vec3d& w) {
                std::vector<LightHit<float>> hits = window(w);
                for (LightHit<float>& hit : hits)
                    hit = {c.from, {}, rounded(w)};
                return hits;
            };
            cases.push_back(std::move(c));
        };
        const auto plain = [](Vec3d) { return kTestRadiance; };
        const auto striped = [](Vec3d w) { return kTestRadiance * float(std::sin(9 * w.x) > 0.3 ? 0 : 1 + w.y * w.y); };
        const auto sunny = [](Vec3d w) {
            return kTestRadiance * (length(w - normalized({0.3, 0.2, 1})) < 0.1 ? 50.f : 1.f);
        };
        add("plain", {-1, -0.5, 1}, {2, 0, 0}, {0, 1, 0}, 64, plain);
        add("of one pixel", {-0.3, 0.2, 0.7}, {1, 0.2, 0}, {-0.1, 0.5, 0}, 1, plain);
        add("within one pixel", {0.1, 0.2, 3}, {0.1, 0, 0}, {0, 0.2, 0}, 8, plain);
        add("striped, beside", {0.5, -0.5, 0.6}, {2, 0, 0.3}, {0, 1, 0}, 64, striped);
        add("with a sun", {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, 128, sunny);
        return cases;
    }
};

/// All cases of all registered types.
inline std::vector<LightCase> allLightCases(double scale = 1) {
    std::vector<LightCase> all;
    forEachType(LightTypes{}, [&]<class T>() {
        for (LightCase& c : LightCases<T>::make(scale))
            all.push_back(std::move(c));
    });
    return all;
}

}  // namespace penumbra::test
