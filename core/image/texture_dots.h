// dots: about two in five of the unit cells of (s, t) hold a dot of radius 0.35, shifted within its cell at random.
//
// As in pbrt, whose files rely on it, `inside` is the value around the dots and `outside` that of the dots. Dots are
// not filtered.
#pragma once

#include "core/image/texture_mapping.h"
#include "core/image/texture_plugin.h"
#include "core/math/noise.h"

namespace penumbra {

struct DotsTexture {
    static constexpr auto kParameters = TextureMapping::parameters({
        {"spectrum or float texture", "inside", "1", "the value around the dots"},
        {"spectrum or float texture", "outside", "0", "the value of the dots"},
    });
    static constexpr PluginInfo kInfo{"dots", "dots at random places", kParameters};
    static constexpr float kRadius = 0.35f;

    static TextureOperand make(TextureInput& input, TextureTables& tables) {
        DotsTexture t;
        t.mapping = TextureMapping::make(input);
        t.around = input.value("inside", 1.f);
        t.dots = input.value("outside", 0.f);
        return tables.append(t, {t.around, t.dots}, input);
    }

    template <class V, class F>
    V evaluate(const TextureContext<F>& at, const TextureTables& tables) const {
        const MappedPoint<F> m = mapping.map(at);
        return tables.blend<V>(around, dots, select(isDot(m.s, m.t), F(1.f), F(0.f)), at);
    }

    template <class F>
    static Mask<F> isDot(F s, F t) {
        // Cells are centred on whole numbers; what decides about one are noises at places of its own.
        const F cellS = floor(s + F(0.5f)), cellT = floor(t + F(0.5f));
        const auto random = [&](float ds, float dt) {
            return gradientNoise(Vec3<F>{cellS + F(ds), cellT + F(dt), F(0.5f)});
        };
        const Mask<F> has = random(0.5f, 0.5f) > F(0.f);
        if (none(has)) return has;
        const F reach(0.5f - kRadius);
        const F ds = s - (cellS + reach * random(1.5f, 2.8f)), dt = t - (cellT + reach * random(4.5f, 9.8f));
        return has & (ds * ds + dt * dt < F(kRadius * kRadius));
    }

    TextureMapping mapping;
    TextureOperand around, dots;
};

}  // namespace penumbra
