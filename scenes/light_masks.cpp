#include "scenes/light_masks.h"

#include "core/geometry/alpha_mask.h"

#include <algorithm>
#include <bit>

namespace penumbra {

void LightMasks::add(std::uint32_t first, std::uint32_t count, std::uint32_t shape) {
    if (shapes_.size() < std::size_t(first) + count) shapes_.resize(std::size_t(first) + count, kNone);
    std::fill_n(shapes_.begin() + first, count, shape);
}

template <class F>
F LightMasks::at(const Geometry& geometry, const Textures& textures, const UInt<F>& light, const Vec3<F>& p) const {
    F part(1.f);
    Mask<F> active = light < UInt<F>(std::uint32_t(shapes_.size()));
    const UInt<F> shape = gather(shapes_.data(), select(active, light, UInt<F>(0u)));
    active = active & (shape != UInt<F>(kNone));
    while (any(active)) {
        const std::uint32_t row = lane(shape, std::countr_zero(bits(active)));
        const Mask<F> here = active & (shape == UInt<F>(row));
        const UInt<F> triangle = select(here, light - UInt<F>(geometry.shapes[row].light), UInt<F>(0u));
        part = select(here, AlphaMask(geometry, row, &textures).alphaAt(triangle, p), part);
        active = active & !here;
    }
    return part;
}

template float LightMasks::at<float>(const Geometry&, const Textures&, const std::uint32_t&, const Vec3<float>&) const;
template Lanes8f LightMasks::at<Lanes8f>(const Geometry&, const Textures&, const Lanes8u&, const Vec3<Lanes8f>&) const;

}  // namespace penumbra
