// What a material gets when it is made (MaterialInput, cold) and when it builds a closure at a hit (ShadingContext,
// hot).
//
// Thread safety: ShadingContext refers to immutable tables only.
#pragma once

#include "core/base/parameters.h"
#include "core/base/plugin.h"
#include "core/color/rgb.h"
#include "core/color/spectrum_parameter.h"
#include "core/image/texture.h"
#include "core/math/records.h"
#include "materials/bsdf.h"

#include <map>

namespace penumbra {

/// A colour that is constant or comes from a texture. Read it with
/// ShadingContext::spectrum.
struct SpectrumInput {
    Spectrum<float> constant{};
    std::uint32_t texture = kNoTexture;
};

/// A number that is constant or comes from a texture. Read it with ShadingContext::scalar.
struct ScalarInput {
    float constant = 0.f;
    std::uint32_t texture = kNoTexture;
};

/// The numbers that closures look up, of all materials in one array (ShadingContext::tables); a material keeps the
/// offset of its block. Materials that would fill equal blocks share one. Thread safety: none while blocks are added;
/// immutable afterwards.
class MaterialTables {
public:
    /// Offset of the block of that key (whatever decides the block's content, the kind of table first). Where there is
    /// none yet, fill(std::vector<float>&) appends it.
    template <class Fill>
    std::uint32_t block(const std::vector<float>& key, Fill&& fill) {
        const auto [place, isNew] = offsets_.try_emplace(key, std::uint32_t(numbers_.size()));
        if (isNew) fill(numbers_);
        return place->second;
    }
    const float* data() const { return numbers_.data(); }
    std::size_t size() const { return numbers_.size(); }

private:
    std::vector<float> numbers_;
    std::map<std::vector<float>, std::uint32_t> offsets_;
};

/// Parameters of one material, with names of textures resolved and colours in the film's space.
class MaterialInput {
public:
    virtual ~MaterialInput() = default;
    /// "spectrum" texture, or any spectrum as a reflectance; constants are clamped to [0, 1].
    virtual SpectrumInput albedo(std::string_view name, Rgb otherwise) = 0;
    /// The same of a coefficient of absorption or scattering: at least 0, of the role Unbounded.
    virtual SpectrumInput coefficient(std::string_view name, Rgb otherwise) = 0;
    /// "float" texture or float.
    virtual ScalarInput scalar(std::string_view name, float otherwise) = 0;
    /// As scalar, with the default taken from another input (uroughness falls back to roughness).
    virtual ScalarInput scalar(std::string_view name, const ScalarInput& otherwise) = 0;
    /// Relative index of a dielectric: float, spectrum or rgb.
    virtual float dielectricIndex(std::string_view name, float otherwise) = 0;
    /// eta and k of a conductor (default copper).
    virtual ConductorIndex conductorIndex(std::string_view eta, std::string_view k) = 0;
    /// The bytes of the file that a string parameter names, at most so many.
    virtual std::vector<char> file(std::string_view name, std::uint64_t most) = 0;
    /// By which spectra become colours of the film's space.
    virtual const ChannelWeights& channelWeights() const = 0;
    virtual const ParameterSet& parameters() const = 0;
    virtual void warn(const std::string& text) = 0;               ///< with the material's position before it
    [[noreturn]] virtual void fail(const std::string& text) = 0;  ///< Error(BadData), likewise
    virtual MaterialTables& tables() = 0;
};

template <class F>
struct ShadingContext {
    const Textures& textures;
    const float* tables;
    TextureContext<F> at;
    F chance{};  ///< in [0, 1): this hit's own, for materials whose closure estimates (kEstimates)

    /// `input` is a member of the material M, read for every lane's own row.
    template <class M>
    Spectrum<F> spectrum(const Records<F, M>& m, SpectrumInput M::*input) const {
        if (m.shared()) {
            const SpectrumInput& s = m.first().*input;
            if (s.texture == kNoTexture) return {F(s.constant.r), F(s.constant.g), F(s.constant.b)};
            return textures.spectrum<F>(UInt<F>(s.texture), at);
        }
        Spectrum<F> out;
        UInt<F> texture;
        for (int i = 0; i < kLanes<F>; ++i) {
            const SpectrumInput& s = m.row(i).*input;
            setLane(out.r, i, s.constant.r);
            setLane(out.g, i, s.constant.g);
            setLane(out.b, i, s.constant.b);
            setLane(texture, i, s.texture);
        }
        const Mask<F> textured = texture != UInt<F>(kNoTexture);
        if (none(textured)) return out;
        return select(textured, textures.spectrum<F>(texture, at), out);
    }

    template <class M>
    F scalar(const Records<F, M>& m, ScalarInput M::*input) const {
        if (m.shared()) {
            const ScalarInput& s = m.first().*input;
            if (s.texture == kNoTexture) return F(s.constant);
            return textures.scalar<F>(UInt<F>(s.texture), at);
        }
        F out;
        UInt<F> texture;
        for (int i = 0; i < kLanes<F>; ++i) {
            const ScalarInput& s = m.row(i).*input;
            setLane(out, i, s.constant);
            setLane(texture, i, s.texture);
        }
        const Mask<F> textured = texture != UInt<F>(kNoTexture);
        if (none(textured)) return out;
        return select(textured, textures.scalar<F>(texture, at), out);
    }
};

}  // namespace penumbra
