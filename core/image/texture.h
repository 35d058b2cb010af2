// Textures: functions of the surface that materials look up at a hit, over lanes; and how the scene's builder makes
// them.
//
// Conventions: uv as the shape gives them, p and n in world space; `width` is how much of the surface the ray's cone
// covers across, in world space, and `footprint` the same in units of uv (0: a point). The cone of a camera ray is one
// pixel wide, divided by the root of the samples a pixel (by 8 at most), so the footprint stands for
// max(|du/dx|, |dv/dx|, |du/dy|, |dv/dy|) in the formulas of the pbrt format: the w of its image maps is twice the
// footprint, and its checkerboard spreads over 1.5 footprints to either side.
// Texture ids index one table for the whole scene. A texture has a kind, and one of kind Spectrum a role; one texture
// of a scene file that is used under two roles is added twice (and shares its image). kNoTexture means "no texture".
// Spectra are linear RGB in the film's colour space. Where the role is Albedo, spectrum() gives values in [0, 1].
//
// Thread safety: add() from one thread; after that immutable, look-ups from any number of threads.
// Failures: none can happen after building, and look-ups never throw; uv may be anything, NaN included.
// Invariants: the textures that a texture refers to were added before it; at most kTextureDepthLimit deep and
// kTextureCostLimit evaluations a look-up, so that no scene file can make a look-up endless or the stack overflow.
#pragma once

#include "core/base/parameters.h"
#include "core/color/spectrum_parameter.h"
#include "core/image/image.h"
#include "core/math/matrix.h"
#include "core/math/spectrum.h"
#include "core/math/vector.h"

#include <cstdint>
#include <memory>

namespace penumbra {

inline constexpr std::uint32_t kNoTexture = 0xFFFFFFFFu;
inline constexpr std::uint32_t kTextureDepthLimit = 16;
inline constexpr std::uint32_t kTextureCostLimit = 256;

template <class F>
struct TextureContext {
    Vec2<F> uv;
    F footprint;
    Vec3<F> p;
    Vec3<F> n;  ///< unit geometric normal, of either side
    F width;
};

enum class TextureKind { Float, Spectrum };

/// A constant, or a texture of the table: a parameter of a texture, and what a texture of a scene file becomes. A
/// number stands in all three channels.
struct TextureOperand {
    Spectrum<float> constant{};
    std::uint32_t texture = kNoTexture;

    static TextureOperand number(float x) { return {{x, x, x}, kNoTexture}; }
    static TextureOperand color(Rgb c) { return {{c.r, c.g, c.b}, kNoTexture}; }
    bool isConstant() const { return texture == kNoTexture; }
};

/// Parameters of one texture of a scene file, with names of textures resolved and colours in the film's space.
class TextureInput {
public:
    virtual ~TextureInput() = default;
    virtual TextureKind kind() const = 0;
    virtual SpectrumRole role() const = 0;  ///< where kind() is Spectrum
    virtual const ColorSpace& filmColorSpace() const = 0;
    virtual const Matrix4& textureToWorld() const = 0;  ///< the transformation in force at the texture's directive
    /// "spectrum" texture, or any spectrum, under this texture's role.
    virtual TextureOperand spectrum(std::string_view name, Rgb otherwise) = 0;
    /// "float" texture or float.
    virtual TextureOperand scalar(std::string_view name, float otherwise) = 0;
    /// The "string" parameter as the path of a file, resolved like every path of the scene; fails where it is absent.
    virtual std::string path(std::string_view name) = 0;
    /// Reads an image file; here readImage with its default limits. Throws Error beginning with the path.
    virtual Image image(const std::string& path, TransferFunction pngEncoding);
    virtual const ParameterSet& parameters() const = 0;
    virtual std::string where() const = 0;                        ///< begins messages: "a.pbrt:3:1: texture 'wood'"
    virtual void warn(const std::string& text) = 0;               ///< with where() before it
    [[noreturn]] virtual void fail(const std::string& text) = 0;  ///< Error(BadData), likewise

    /// spectrum() or scalar() with a grey default, as kind() wants it.
    TextureOperand value(std::string_view name, float otherwise) {
        return kind() == TextureKind::Spectrum ? spectrum(name, {otherwise, otherwise, otherwise})
                                               : scalar(name, otherwise);
    }
};

class TextureTables;

class Textures {
public:
    Textures();
    ~Textures();
    Textures(Textures&&) noexcept;
    Textures& operator=(Textures&&) noexcept;

    /// Makes one texture of the class that a scene file names; see texture_registry.h for the classes there are.
    /// Textures that are constant (constants, their products) come back as constants, not clamped whatever the role.
    /// Throws Error: BadData, MissingInput for an image that is not there. REQUIRES: knows(className).
    TextureOperand add(std::string_view className, TextureInput& input);
    static bool knows(std::string_view className);
    /// The image file that the "string" parameter names as a map of normals; linear where the file does not say
    /// otherwise, bilinear and repeated. Its r, g, b are the image's own: no colour, and no matter of colour spaces.
    /// The id is of kind Spectrum. Throws as add() does, and where the image is grey.
    std::uint32_t addNormalMap(std::string_view parameter, TextureInput& input);

    /// Values at every lane's own texture; lanes with kNoTexture get 0. Ids of different textures may stand in one
    /// group; a group that shares one is quickest. REQUIRES: ids of kind Spectrum.
    template <class F>
    Spectrum<F> spectrum(const UInt<F>& texture, const TextureContext<F>& at) const;
    /// The same for ids of kind Float. Of an image this is the mean of r, g, b, or alpha where an image with alpha is
    /// not opaque everywhere (the pbrt format's rule).
    template <class F>
    F scalar(const UInt<F>& texture, const TextureContext<F>& at) const;

    /// For look-ups of one texture that have to outlive a move of this object: texture_plugin.h.
    const TextureTables& tables() const { return *tables_; }

    std::size_t count() const;       ///< of textures in the table
    std::size_t imageCount() const;  ///< of images, each shared by the textures that use it
    std::size_t bytes() const;       ///< of memory held, images included

private:
    std::unique_ptr<TextureTables> tables_;
};

}  // namespace penumbra
