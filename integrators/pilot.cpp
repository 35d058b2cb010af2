#include "integrators/pilot.h"

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

/// What the film makes of radiance 1 in all channels.
double sensorResponse(const FilmSettings& film) {
    if (film.isIdentity()) return 1;
    double sum = 0;
    for (float m : film.sensorFromFilm) sum += double(m);
    return sum / 3;
}

}  // namespace

float typicalRadiance(const Scene& scene, const Integrator& integrator) {
    constexpr int kTiles = 8, kSide = 4;   // a grid of tiles, each of a few pixels
    double sum = 0;
    std::size_t pixels = 0;
    for (int ty = 0; ty < kTiles; ++ty)
        for (int tx = 0; tx < kTiles; ++tx) {
            const int x = scene.film.width * (2 * tx + 1) / (2 * kTiles), y = scene.film.height * (2 * ty + 1) / (2 * kTiles);
            const CropWindow window{x, y, std::min(x + kSide, scene.film.width), std::min(y + kSide, scene.film.height)};
            Film film(window, 1, scene.filter.normalization());
            RenderCounts counts;
            integrator.render(scene, {0, 0, window.width(), window.height()}, {0, 1}, {}, film, counts);
            for (std::size_t i = 0; i < film.pixelCount(); ++i) {
                const PixelEstimate e = film.estimate(i);
                sum += std::sqrt(std::max({e.mean[0], e.mean[1], e.mean[2], 0.0}));
                ++pixels;
            }
        }
    const double root = sum / double(pixels);
    return float(root * root / std::max(sensorResponse(scene.film), 1e-20));
}

}  // namespace penumbra
