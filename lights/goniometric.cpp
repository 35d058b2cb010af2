#include "lights/goniometric.h"

namespace penumbra {

GoniometricLight GoniometricLight::make(const Matrix4& worldFromLight, std::span<const float> image,
                                        std::size_t resolution, const Spectrum<float>& intensity, LightTables& tables) {
    GoniometricLight light;
    light.place(worldFromLight, {0, 0, 0});
    light.resolution = std::uint32_t(resolution);
    light.pixels = roomForNumbers(tables, image.size());
    double sum = 0;
    for (const float value : image) {
        tables.numbers.push_back(usable(value));
        sum += tables.numbers.back();
    }
    light.mean = float(sum / double(image.size()));
    light.intensity = intensity;
    return light;
}

}  // namespace penumbra
