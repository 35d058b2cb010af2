// ImagePyramid: an image with its ever smaller versions, and how textures read it over lanes.
//
// Level 0 is the image itself at its own size (nothing is resampled up); each next level has half the width and height,
// rounded up, down to 1 x 1. A texel of it is the mean of the area that it covers, so that odd sizes keep the image's
// mean. The means are taken in linear light. Images of bytes stay bytes: grey ones four texels a word, others r g b a
// in a word; a level is rounded once, to the byte whose value is nearest. Other images are floats, r g b (a) side by
// side. Row 0 is the top and (s, t) is measured from there: the centre of texel (i, j) is at ((i + 1/2) / W,
// (j + 1/2) / H).
//
// Level of detail: a look-up that covers the width w (in units of s and t) has the level log2(w max(W, H)), at least 0
// and at most the last. That is the pbrt format's (levels - 1) + log2(w) for powers of two. Point and bilinear filters
// read the level below it, trilinear blends the levels on both sides.
//
// Thread safety: immutable. Failures: look-ups have none; s, t and w may be anything, NaN included (which reads some
// texel of the image, or black where the wrap mode is Black).
// Source: Williams, "Pyramidal Parametrics", SIGGRAPH 1983; octahedral borders: Clarberg, "Fast Equal-Area Mapping of
// the (Hemi)Sphere using SIMD", JGT 13(3), 2008.
#pragma once

#include "core/image/image.h"
#include "core/math/records.h"

#include <type_traits>

namespace penumbra {

enum class WrapMode { Repeat, Black, Clamp, OctahedralSphere };
enum class TextureFilter { Point, Bilinear, Trilinear };

class ImagePyramid {
public:
    /// REQUIRES: the image is not empty.
    explicit ImagePyramid(const Image& image);

    int width() const { return int(levels_[0].width); }
    int height() const { return int(levels_[0].height); }
    int levelCount() const { return int(levels_.size()); }
    const ColorSpace& colorSpace() const { return *colorSpace_; }
    bool isGrey() const { return format_ == Format::ByteGrey || format_ == Format::FloatGrey; }
    /// True where numbers are read from alpha: the image has it and is not opaque everywhere.
    bool readsAlpha() const { return readsAlpha_; }
    /// Values of the file that were infinite or not a number; they count as 0.
    std::size_t nonFiniteCount() const { return nonFiniteCount_; }
    std::size_t bytes() const {
        return sizeof *this + levels_.size() * sizeof(Level) + words_.size() * sizeof(std::uint32_t) +
               floats_.size() * sizeof(float);
    }

    /// V = Spectrum<F>: r, g, b in the image's colour space. V = F: their mean, or alpha (readsAlpha).
    template <class V, class F>
    V lookup(F s, F t, F width, WrapMode wrap, TextureFilter filter) const;

    /// The texel (x, y) of a level, for tests and tools. REQUIRES: inside.
    Spectrum<float> texel(int level, int x, int y) const;

private:
    enum class Format { ByteGrey, ByteColor, FloatGrey, FloatColor };
    /// A row of the table of levels; offset and sizes in texels.
    struct Level {
        std::uint32_t offset, width, height;
    };
    template <class F>
    struct LevelOf {
        UInt<F> offset;
        Int<F> width, height;
    };
    template <class F>
    struct TexelPlace {
        UInt<F> index;
        Mask<F> inside;  ///< false: black
    };

    // How each format gives the texels at `index`.
    struct ByteGreyTexels;
    struct ByteColorTexels;
    struct FloatGreyTexels;
    struct FloatColorTexels;
    template <class Function>
    auto withTexels(Function&& function) const;

    template <class F>
    LevelOf<F> levelOf(const UInt<F>& level) const;
    template <class F>
    static F reduce(F s, WrapMode wrap);
    template <class F>
    static TexelPlace<F> place(const LevelOf<F>& level, Int<F> x, Int<F> y, WrapMode wrap);
    template <class V, class F, class Texels>
    V point(const Texels& texels, F s, F t, const UInt<F>& level, WrapMode wrap) const;
    template <class V, class F, class Texels>
    V bilinear(const Texels& texels, F s, F t, const UInt<F>& level, WrapMode wrap) const;
    template <class V, class F, class Texels>
    V filtered(const Texels& texels, F s, F t, F width, WrapMode wrap, TextureFilter filter) const;

    void addLevel(int width, int height);
    void storeBytes(const Image& image);
    void storeFloats(const Image& image);

    std::vector<Level> levels_;
    std::vector<std::uint32_t> words_;  ///< of byte formats
    std::vector<float> floats_;  ///< of float formats, with one spare at the end, because three are loaded as four
    std::array<float, 256> decode_{};
    const ColorSpace* colorSpace_ = nullptr;
    std::size_t nonFiniteCount_ = 0;
    std::uint32_t texelCount_ = 0;  ///< of all levels so far
    std::uint32_t stride_ = 0;      ///< floats a texel
    Format format_ = Format::ByteGrey;
    bool readsAlpha_ = false;
};

// ---------------------------------------------------------------------------------------------------- formats

struct ImagePyramid::ByteGreyTexels {
    const std::uint32_t* words;
    const float* decode;

    template <class V, class F>
    V texel(const UInt<F>& index) const {
        // Lanes have no shift by a lane's own count; the byte is brought to the top by a product.
        static constexpr std::uint32_t kToTop[8] = {1u << 24, 1u << 16, 1u << 8, 1u, 1u << 24, 1u << 16, 1u << 8, 1u};
        const UInt<F> word = gather(words, index >> 2);
        const F v = gather(decode, (word * lookup8(kToTop, index & UInt<F>(3u))) >> 24);
        if constexpr (std::is_same_v<V, F>) {
            return v;
        } else {
            return V::constant(v);
        }
    }
};

struct ImagePyramid::ByteColorTexels {
    const std::uint32_t* words;
    const float* decode;
    bool alpha;

    template <class V, class F>
    V texel(const UInt<F>& index) const {
        const UInt<F> word = gather(words, index);
        const UInt<F> low(0xFFu);
        if constexpr (std::is_same_v<V, F>) {
            if (alpha) return gather(decode, word >> 24);
        }
        const F r = gather(decode, word & low);
        const F g = gather(decode, (word >> 8) & low);
        const F b = gather(decode, (word >> 16) & low);
        if constexpr (std::is_same_v<V, F>) {
            return (r + g + b) / F(3.f);
        } else {
            return {r, g, b};
        }
    }
};

struct ImagePyramid::FloatGreyTexels {
    const float* values;

    template <class V, class F>
    V texel(const UInt<F>& index) const {
        const F v = gather(values, index);
        if constexpr (std::is_same_v<V, F>) {
            return v;
        } else {
            return V::constant(v);
        }
    }
};

struct ImagePyramid::FloatColorTexels {
    const float* values;
    std::uint32_t stride;
    bool alpha;

    template <class V, class F>
    V texel(const UInt<F>& index) const {
        F c[4];
        loadRows4(values, index * UInt<F>(stride), c);
        if constexpr (std::is_same_v<V, F>) {
            return alpha ? c[3] : (c[0] + c[1] + c[2]) / F(3.f);
        } else {
            return {c[0], c[1], c[2]};
        }
    }
};

template <class Function>
auto ImagePyramid::withTexels(Function&& function) const {
    switch (format_) {
        case Format::ByteGrey:
            return function(ByteGreyTexels{words_.data(), decode_.data()});
        case Format::ByteColor:
            return function(ByteColorTexels{words_.data(), decode_.data(), readsAlpha_});
        case Format::FloatGrey:
            return function(FloatGreyTexels{floats_.data()});
        case Format::FloatColor:
            break;
    }
    return function(FloatColorTexels{floats_.data(), stride_, readsAlpha_});
}

// ---------------------------------------------------------------------------------------------------- places

template <class F>
ImagePyramid::LevelOf<F> ImagePyramid::levelOf(const UInt<F>& level) const {
    const Records<F, Level> rows(levels_.data(), level);
    return {rows(&Level::offset), asInt(rows(&Level::width)), asInt(rows(&Level::height))};
}

/// A coordinate near enough to [0, 1] to be an index, with the same texels; NaN becomes the lowest.
template <class F>
F ImagePyramid::reduce(F s, WrapMode wrap) {
    if (wrap == WrapMode::Black) return clamp(s, F(-1.f), F(2.f));
    if (wrap == WrapMode::Repeat) s = s - floor(s);
    return clamp(s, F(0.f), F(1.f));
}

/// x and y at most one image beyond the image.
template <class F>
ImagePyramid::TexelPlace<F> ImagePyramid::place(const LevelOf<F>& level, Int<F> x, Int<F> y, WrapMode wrap) {
    const Int<F> zero(0), one(1), w = level.width, h = level.height;
    Mask<F> inside(true);
    switch (wrap) {
        case WrapMode::Repeat:
            x = select(x < zero, x + w, select(x >= w, x - w, x));
            y = select(y < zero, y + h, select(y >= h, y - h, y));
            break;
        case WrapMode::Black:
            inside = (x >= zero) & (x < w) & (y >= zero) & (y < h);
            break;
        case WrapMode::OctahedralSphere: {
            // Beyond an edge lies the same edge, run through the other way.
            const Mask<F> outX = (x < zero) | (x >= w);
            y = select(outX, h - one - y, y);
            x = select(x < zero, zero - one - x, select(x >= w, w + w - one - x, x));
            const Mask<F> outY = (y < zero) | (y >= h);
            x = select(outY, w - one - x, x);
            y = select(y < zero, zero - one - y, select(y >= h, h + h - one - y, y));
            break;
        }
        case WrapMode::Clamp:
            break;
    }
    x = clamp(x, zero, w - one);
    y = clamp(y, zero, h - one);
    return {level.offset + asUInt(y * w + x), inside};
}

// ---------------------------------------------------------------------------------------------------- filters

template <class V, class F, class Texels>
V ImagePyramid::point(const Texels& texels, F s, F t, const UInt<F>& level, WrapMode wrap) const {
    const LevelOf<F> size = levelOf<F>(level);
    const Int<F> x = toInt(floor(s * toFloat<F>(size.width))), y = toInt(floor(t * toFloat<F>(size.height)));
    const TexelPlace<F> at = place<F>(size, x, y, wrap);
    return select(at.inside, texels.template texel<V, F>(at.index), V{});
}

template <class V, class F, class Texels>
V ImagePyramid::bilinear(const Texels& texels, F s, F t, const UInt<F>& level, WrapMode wrap) const {
    const LevelOf<F> size = levelOf<F>(level);
    const F x = s * toFloat<F>(size.width) - F(0.5f), y = t * toFloat<F>(size.height) - F(0.5f);
    const F left = floor(x), top = floor(y);
    const Int<F> x0 = toInt(left), y0 = toInt(top), x1 = x0 + Int<F>(1), y1 = y0 + Int<F>(1);
    const auto texel = [&](const Int<F>& column, const Int<F>& row) {
        const TexelPlace<F> at = place<F>(size, column, row, wrap);
        const V value = texels.template texel<V, F>(at.index);
        return wrap == WrapMode::Black ? select(at.inside, value, V{}) : value;
    };
    // a + (b - a) t rather than (1 - t) a + t b: exact where the texels are equal.
    const auto blend = [](const V& a, const V& b, const F& weight) { return a + (b - a) * weight; };
    const F alongX = x - left, alongY = y - top;
    return blend(blend(texel(x0, y0), texel(x1, y0), alongX), blend(texel(x0, y1), texel(x1, y1), alongX), alongY);
}

template <class V, class F, class Texels>
V ImagePyramid::filtered(const Texels& texels, F s, F t, F width, WrapMode wrap, TextureFilter filter) const {
    const Int<F> last(std::int32_t(levels_.size()) - 1);
    const F size = F(float(std::max(levels_[0].width, levels_[0].height)));
    const F covered = clamp(width * size, F(1.f), F(0x1p30f));  // in texels of level 0
    const UInt<F> coveredBits = floatBits(covered);
    const Int<F> below = min(asInt(coveredBits >> 23) - Int<F>(127), last);  // the exponent: floor(log2) exactly
    s = reduce(s, wrap);
    t = reduce(t, wrap);
    if (filter == TextureFilter::Point) return point<V, F>(texels, s, t, asUInt(below), wrap);
    const V fine = bilinear<V, F>(texels, s, t, asUInt(below), wrap);
    const Mask<F> blended = (covered > F(1.f)) & (below < last);
    if (filter == TextureFilter::Bilinear || none(blended)) return fine;
    const F mantissa = floatFromBits((coveredBits & UInt<F>(0x007FFFFFu)) | UInt<F>(0x3F800000u));
    const F fraction = clamp(log(mantissa) * F(1.44269504088896341f), F(0.f), F(1.f));
    const V coarse = bilinear<V, F>(texels, s, t, asUInt(min(below + Int<F>(1), last)), wrap);
    return select(blended, fine + (coarse - fine) * fraction, fine);
}

template <class V, class F>
V ImagePyramid::lookup(F s, F t, F width, WrapMode wrap, TextureFilter filter) const {
    return withTexels([&](const auto& texels) { return filtered<V, F>(texels, s, t, width, wrap, filter); });
}

}  // namespace penumbra
