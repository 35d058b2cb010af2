// What happens once, when a measured material is made: its file becomes the tables that the closure reads.
#include "materials/measured.h"

#include "core/base/sha256.h"
#include "core/base/tensor_file.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;
constexpr std::size_t kMostFloats = std::size_t{1} << 26;

[[noreturn]] void fail(const std::string& text) {
    throw Error(ErrorKind::BadData, "the measurement " + text);
}

/// The arrays of a file, with shapes that agree.
struct Measurement {
    std::vector<float> phi, theta, wavelengths, ndf, sigma, visible, luminance, spectra;
    std::size_t ndfWidth, ndfHeight, sigmaWidth, sigmaHeight, visibleWidth, visibleHeight, colorWidth, colorHeight;

    bool isIsotropic() const { return phi.size() <= 2; }
    std::size_t views() const { return phi.size() * theta.size(); }
};

void checkRising(const std::vector<float>& numbers, const char* name) {
    for (std::size_t i = 1; i < numbers.size(); ++i)
        if (!(numbers[i - 1] < numbers[i])) fail(std::string("has angles or wavelengths that do not rise: ") + name);
}

Measurement readMeasurement(const TensorFile& file) {
    Measurement m{file.floats("phi_i", 1), file.floats("theta_i", 1), file.floats("wavelengths", 1),
                  file.floats("ndf", 2),   file.floats("sigma", 2),   file.floats("vndf", 4),
                  file.floats("luminance", 4), file.floats("spectra", 5), 0, 0, 0, 0, 0, 0, 0, 0};
    const auto last = [&](const char* name, std::size_t& width, std::size_t& height) {
        const std::vector<std::size_t>& shape = file.shape(name);
        width = shape[shape.size() - 1];
        height = shape[shape.size() - 2];
        if (width < 2 || height < 2) fail(std::string("is less than two by two in ") + name);
    };
    last("ndf", m.ndfWidth, m.ndfHeight);
    last("sigma", m.sigmaWidth, m.sigmaHeight);
    last("vndf", m.visibleWidth, m.visibleHeight);
    last("luminance", m.colorWidth, m.colorHeight);
    checkRising(m.phi, "phi_i");
    checkRising(m.theta, "theta_i");
    checkRising(m.wavelengths, "wavelengths");

    using Shape = std::vector<std::size_t>;
    const std::size_t phis = m.phi.size(), thetas = m.theta.size();
    if (file.shape("vndf") != Shape{phis, thetas, m.visibleHeight, m.visibleWidth} ||
        file.shape("luminance") != Shape{phis, thetas, m.colorHeight, m.colorWidth} ||
        file.shape("spectra") != Shape{phis, thetas, m.wavelengths.size(), m.colorHeight, m.colorWidth})
        fail("has arrays of shapes that do not agree");
    constexpr float kTurn = 6.28318531f;
    if (!m.isIsotropic() && std::abs(m.phi.back() - m.phi.front() - kTurn) > 0.01f * kTurn)
        fail("is anisotropic and goes less than a full turn round, which is not supported");
    const std::size_t floats = phis + thetas + m.ndf.size() + m.sigma.size() +
        m.views() * (m.visibleHeight * (2 * m.visibleWidth + 1) + m.colorHeight * (5 * m.colorWidth + 1));
    if (floats > kMostFloats) fail("is too large");
    return m;
}

/// The colour of one at each wavelength, linear to zero at its neighbours, held beyond the ends.
std::vector<Rgb> colorsOf(const std::vector<float>& wavelengths, const ChannelWeights& weights) {
    std::vector<Rgb> colors(wavelengths.size());
    std::size_t above = 0;
    for (int i = 0; i < kWavelengthCount; ++i) {
        const double nm = kFirstWavelength + i;
        while (above < wavelengths.size() && wavelengths[above] < nm)
            ++above;
        const std::size_t right = std::min(above, wavelengths.size() - 1), left = above == 0 ? 0 : above - 1;
        const double width = double(wavelengths[right]) - wavelengths[left];
        const double t = width > 0 ? std::clamp((nm - wavelengths[left]) / width, 0.0, 1.0) : 1.0;
        const Rgb color{float(weights.rows[0][i]), float(weights.rows[1][i]), float(weights.rows[2][i])};
        colors[left] = colors[left] + float(1 - t) * color;
        colors[right] = colors[right] + float(t) * color;
    }
    return colors;
}

/// Sums along rows, over rows, and what to multiply all with so that the slice integrates to one.
struct SliceSums {
    std::vector<double> along, over;

    SliceSums(const float* nodes, std::size_t width, std::size_t height)
        : along(width * height), over(height) {
        for (std::size_t y = 0; y < height; ++y) {
            for (std::size_t x = 1; x < width; ++x)
                along[y * width + x] = along[y * width + x - 1] + 0.5 * (at(nodes, y * width + x - 1) + at(nodes, y * width + x));
            if (y > 0) over[y] = over[y - 1] + 0.5 * (along[y * width - 1] + along[(y + 1) * width - 1]);
        }
        if (!(over.back() > 0)) fail("has a direction of view from which nothing is seen");
    }
    double scale() const { return 1 / over.back(); }
    static double at(const float* nodes, std::size_t i) { return std::max(nodes[i], 0.f); }
};

/// Appends a density (measured_table.h); node(slice, i, scale) appends what stands at a node.
template <class Node>
void appendDensity(const std::vector<float>& values, std::size_t slices, std::size_t width,
                   std::size_t height, std::vector<float>& numbers, Node&& node) {
    std::vector<float> along, over;
    const std::size_t size = width * height;
    for (std::size_t s = 0; s < slices; ++s) {
        const SliceSums sums(values.data() + s * size, width, height);
        for (std::size_t i = 0; i < size; ++i) {
            node(s, i, float(SliceSums::at(values.data() + s * size, i) * sums.scale()));
            along.push_back(float(sums.along[i] * sums.scale()));
        }
        for (const double x : sums.over)
            over.push_back(float(x * sums.scale()));
    }
    numbers.insert(numbers.end(), along.begin(), along.end());
    numbers.insert(numbers.end(), over.begin(), over.end());
}

void appendMeasurement(const Measurement& m, const ChannelWeights& weights, std::vector<float>& numbers) {
    const auto append = [&](const std::vector<float>& values) {
        for (const float x : values)
            numbers.push_back(x);
    };
    append(m.phi);
    append(m.theta);
    for (const std::vector<float>* grid : {&m.ndf, &m.sigma})
        for (const float x : *grid)
            numbers.push_back(std::max(x, 0.f));
    appendDensity(m.visible, m.views(), m.visibleWidth, m.visibleHeight, numbers,
                  [&](std::size_t, std::size_t, float density) { numbers.push_back(density); });

    const std::vector<Rgb> colors = colorsOf(m.wavelengths, weights);
    const std::size_t size = m.colorWidth * m.colorHeight;
    appendDensity(m.luminance, m.views(), m.colorWidth, m.colorHeight, numbers,
                  [&](std::size_t view, std::size_t i, float density) {
                      Rgb sum{0, 0, 0};
                      for (std::size_t j = 0; j < colors.size(); ++j)
                          sum = sum + m.spectra[(view * colors.size() + j) * size + i] * colors[j];
                      for (const float x : {density, sum.r, sum.g, sum.b})
                          numbers.push_back(std::clamp(x, 0.f, 1e6f));
                  });
}

}  // namespace

MeasuredMaterial MeasuredMaterial::make(MaterialInput& input) {
    std::vector<char> bytes = input.file("filename", kMostBytes);
    std::vector<float> key{3};  // kinds 0 to 2 are coats
    for (const char x : sha256OfBytes({bytes.data(), bytes.size()}))
        key.push_back(float(x));
    MeasuredMaterial m;
    try {
        const Measurement measured = readMeasurement(TensorFile(std::move(bytes)));
        m.isotropic = measured.isIsotropic() ? 1 : 0;
        m.phis = std::uint32_t(measured.phi.size());
        m.thetas = std::uint32_t(measured.theta.size());
        m.ndfWidth = std::uint32_t(measured.ndfWidth);
        m.ndfHeight = std::uint32_t(measured.ndfHeight);
        m.sigmaWidth = std::uint32_t(measured.sigmaWidth);
        m.sigmaHeight = std::uint32_t(measured.sigmaHeight);
        m.visibleWidth = std::uint32_t(measured.visibleWidth);
        m.visibleHeight = std::uint32_t(measured.visibleHeight);
        m.colorWidth = std::uint32_t(measured.colorWidth);
        m.colorHeight = std::uint32_t(measured.colorHeight);
        m.block = input.tables().block(key, [&](std::vector<float>& numbers) {
            appendMeasurement(measured, input.channelWeights(), numbers);
        });
    } catch (const Error& error) {
        input.fail(error.what());
    }
    return m;
}

}  // namespace penumbra
