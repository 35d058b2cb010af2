// A maker of measured materials: the tensor file that a gonio-photometer would write of a rough metal whose BRDF is known
// in closed form, in double precision and by formulas of its own.
//
// The metal: GGX microfacets of roughness (alphaX, alphaY), Smith's masking, Schlick's Fresnel factor of a reflectance
// that is a straight line over the wavelengths.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace penumbra::test {

/// The bytes of a tensor file out of its fields.
class TensorFileMaker {
public:
    void floats(const std::string& name, std::vector<std::uint64_t> shape, const std::vector<float>& values) {
        std::vector<char> bytes(values.size() * sizeof(float));
        std::memcpy(bytes.data(), values.data(), bytes.size());
        fields_.push_back({name, 10, std::move(shape), std::move(bytes)});
    }
    void text(const std::string& name, const std::string& value) {
        fields_.push_back({name, 1, {value.size()}, {value.begin(), value.end()}});
    }
    std::vector<char> bytes() const {
        std::uint64_t at = 12 + 2 + 4;
        for (const Field& f : fields_)
            at += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();
        std::vector<char> out;
        const auto put = [&out](const void* data, std::size_t size) {
            out.resize(out.size() + size);
            std::memcpy(out.data() + (out.size() - size), data, size);
        };
        const auto number = [&](auto x) { put(&x, sizeof x); };
        put("tensor_file", 12);
        number(std::uint8_t(1));
        number(std::uint8_t(0));
        number(std::uint32_t(fields_.size()));
        for (const Field& f : fields_) {
            number(std::uint16_t(f.name.size()));
            put(f.name.data(), f.name.size());
            number(std::uint16_t(f.shape.size()));
            number(f.type);
            number(at);
            for (const std::uint64_t extent : f.shape)
                number(extent);
            at += f.bytes.size();
        }
        for (const Field& f : fields_)
            put(f.bytes.data(), f.bytes.size());
        return out;
    }

private:
    struct Field {
        std::string name;
        std::uint8_t type;
        std::vector<std::uint64_t> shape;
        std::vector<char> bytes;
    };
    std::vector<Field> fields_;
};

struct MeasuredMetal {
    float alphaX = 0.4f, alphaY = 0.4f;
    double reflectance400 = 0.3, reflectance700 = 0.9;  ///< at normal incidence, at these wavelengths
    int nodes = 32, thetas = 8, phis = 9;  ///< of the file's grids; one phi where the metal is isotropic

    using V = std::array<double, 3>;
    bool isIsotropic() const { return alphaX == alphaY; }

    double density(const V& m) const {
        const double q = m[0] * m[0] / (alphaX * alphaX) + m[1] * m[1] / (alphaY * alphaY) + m[2] * m[2];
        return 1 / (kPi * alphaX * alphaY * q * q);
    }
    /// Lambda + 1 times the cosine: the area that the facets show to w, per area of the surface.
    double area(const V& w) const {
        return 0.5 * (w[2] + std::sqrt(std::pow(alphaX * w[0], 2) + std::pow(alphaY * w[1], 2) + w[2] * w[2]));
    }
    double reflectance(double wavelength) const {
        return reflectance400 + (reflectance700 - reflectance400) * (wavelength - 400) / 300;
    }
    double fresnel(double cosine, double wavelength) const {
        const double r = reflectance(wavelength);
        return r + (1 - r) * std::pow(1 - cosine, 5);
    }
    /// Masking of both over that of wo: what the file calls a spectrum, but for the Fresnel factor.
    double shadowing(const V& wo, const V& wi) const {
        if (wi[2] <= 0) return 0;
        const double lo = area(wo) / wo[2] - 1, li = area(wi) / wi[2] - 1;
        return (1 + lo) / (1 + lo + li);
    }
    /// f cos wi at one wavelength.
    double value(const V& wo, const V& wi, double wavelength) const {
        const V m = normalized({wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]});
        const double c = dot(wo, m);
        return fresnel(c, wavelength) * density(m) * shadowing(wo, wi) / (4 * area(wo));
    }

    static V direction(double theta, double phi) {
        return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    }
    static double dot(const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
    static V normalized(const V& a) {
        const double scale = 1 / std::sqrt(dot(a, a));
        return {a[0] * scale, a[1] * scale, a[2] * scale};
    }
    static constexpr double kPi = 3.14159265358979323846;
};

namespace detail {

/// The map of a density given at n x n nodes: rows, then columns, each by its integral.
class MeasuredMap {
public:
    MeasuredMap(const std::vector<double>& nodes, int n) : nodes_(nodes), n_(n) {}

    /// (x, y) that uniform (ux, uy) goes to.
    std::array<double, 2> operator()(double ux, double uy) const {
        std::vector<double> rows(std::size_t(n_), 0.0), line(rows);
        for (int y = 0; y < n_; ++y)
            for (int x = 0; x + 1 < n_; ++x)
                rows[std::size_t(y)] += 0.5 * (node(x, y) + node(x + 1, y));
        const double y = inverted(rows, uy);
        const int below = std::min(int(y), n_ - 2);
        for (int x = 0; x < n_; ++x)
            line[std::size_t(x)] = node(x, below) + (y - below) * (node(x, below + 1) - node(x, below));
        return {inverted(line, ux) / (n_ - 1), y / (n_ - 1)};
    }

private:
    double node(int x, int y) const { return nodes_[std::size_t(y * n_ + x)]; }
    /// Where the integral of the polygon through these values is u of the whole: by halving.
    static double inverted(const std::vector<double>& values, double u) {
        const auto integral = [&](double t) {
            double sum = 0;
            for (std::size_t i = 0; i + 1 < values.size(); ++i) {
                const double part = std::clamp(t - double(i), 0.0, 1.0);
                sum += part * (values[i] + 0.5 * part * (values[i + 1] - values[i]));
            }
            return sum;
        };
        double low = 0, high = double(values.size() - 1);
        const double wanted = u * integral(high);
        for (int step = 0; step < 40; ++step) {
            const double middle = 0.5 * (low + high);
            (integral(middle) < wanted ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }

    const std::vector<double>& nodes_;
    int n_;
};

}  // namespace detail

inline std::vector<char> measuredFile(const MeasuredMetal& metal) {
    using Metal = MeasuredMetal;
    constexpr double kPi = Metal::kPi;
    const int n = metal.nodes, phis = metal.isIsotropic() ? 1 : metal.phis;
    const auto theta = [](double u) { return u * u * kPi / 2; };
    const auto phi = [](double v) { return (2 * v - 1) * kPi; };
    const auto nodeAt = [&](int i) { return double(i) / (n - 1); };
    const std::vector<float> wavelengths{360, 400, 500, 600, 700, 830};

    std::vector<float> phiGrid, thetaGrid, ndf, sigma, visible, luminance, spectra;
    for (int i = 0; i < phis; ++i)
        phiGrid.push_back(phis == 1 ? 0.f : float(-kPi + 2 * kPi * i / (phis - 1)));
    for (int i = 0; i < metal.thetas; ++i)
        thetaGrid.push_back(float(1.5 * i / (metal.thetas - 1)));
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const Metal::V w = Metal::direction(theta(nodeAt(x)), phi(nodeAt(y)));
            ndf.push_back(float(metal.density(w)));
            sigma.push_back(float(metal.area(w)));
        }
    for (const float phiO : phiGrid)
        for (const float thetaO : thetaGrid) {
            const Metal::V wo = Metal::direction(thetaO, phiO);
            std::vector<double> nodes;
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) {
                    const double t = theta(nodeAt(x));
                    const Metal::V m = Metal::direction(t, phi(nodeAt(y)));
                    // Not quite nothing where nothing is seen, so that a mixture of slices has no holes.
                    const double seen = std::max(Metal::dot(wo, m), 1e-4) * metal.density(m) / metal.area(wo);
                    nodes.push_back(seen * 2 * kPi * kPi * nodeAt(x) * std::sin(t) + 1e-6);
                }
            visible.insert(visible.end(), nodes.begin(), nodes.end());
            const detail::MeasuredMap map(nodes, n);
            std::vector<Metal::V> facets;
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) {
                    const auto place = map(nodeAt(x), nodeAt(y));
                    facets.push_back(Metal::direction(theta(place[0]), phi(place[1])));
                }
            const auto spectrum = [&](const Metal::V& m, double wavelength) {
                const double c = std::max(Metal::dot(wo, m), 0.0);
                const Metal::V wi{2 * c * m[0] - wo[0], 2 * c * m[1] - wo[1], 2 * c * m[2] - wo[2]};
                return metal.fresnel(c, wavelength) * metal.shadowing(wo, wi);
            };
            for (const Metal::V& m : facets)
                luminance.push_back(float(spectrum(m, 550) + 0.01));
            for (const float wavelength : wavelengths)
                for (const Metal::V& m : facets)
                    spectra.push_back(float(spectrum(m, wavelength)));
        }

    const auto views = [&](std::vector<std::uint64_t> rest) {
        std::vector<std::uint64_t> shape{std::uint64_t(phis), std::uint64_t(metal.thetas)};
        shape.insert(shape.end(), rest.begin(), rest.end());
        return shape;
    };
    const std::uint64_t size = std::uint64_t(n);
    TensorFileMaker file;
    file.text("description", "a metal out of its formula");
    file.floats("phi_i", {phiGrid.size()}, phiGrid);
    file.floats("theta_i", {thetaGrid.size()}, thetaGrid);
    file.floats("wavelengths", {wavelengths.size()}, wavelengths);
    file.floats("ndf", {size, size}, ndf);
    file.floats("sigma", {size, size}, sigma);
    file.floats("vndf", views({size, size}), visible);
    file.floats("luminance", views({size, size}), luminance);
    file.floats("spectra", views({wavelengths.size(), size, size}), spectra);
    return file.bytes();
}

}  // namespace penumbra::test
