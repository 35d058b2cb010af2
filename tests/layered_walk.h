// The walk between a rough coat and its base as the scene format defines it, one event at a time with nothing
// precomputed and no connections: what the closures of layered materials are held against.
#pragma once

#include "core/math/hash.h"
#include "core/math/warps.h"
#include "materials/fresnel.h"
#include "materials/microfacet.h"

#include <cmath>
#include <functional>

namespace penumbra::test {

class LayeredWalk {
public:
    /// Where light goes that meets the base from `from`; both point up. Lessens the weight by what the base keeps.
    using Base = std::function<Vec3<float>(const Vec3<float>& from, LayeredWalk& numbers, double& weight)>;

    LayeredWalk(float eta, float thickness, Ggx<float> coat, int maxDepth, Base base)
        : eta_(eta), thickness_(thickness), coat_(coat), maxDepth_(maxDepth), base_(std::move(base)) {}

    struct Leaving {
        double weight = 0;
        Vec3<float> w{0, 0, 1};
        bool enteredCoat = false;
    };
    /// Energy that leaves after coming from wo, and where to.
    Leaving walk(const Vec3<float>& wo) {
        Leaving out{1, wo, false};
        Vec3<float> w;
        out.enteredCoat = meet(coat_, wo, eta_, w, out.weight);
        if (!out.enteredCoat) return {out.weight, w, false};
        for (int depth = 0; depth < maxDepth_ && out.weight > 0; depth += 2) {
            out.weight *= std::exp(-thickness_ / std::abs(w.z));
            const Vec3<float> up = base_(-w, *this, out.weight);
            out.weight *= std::exp(-thickness_ / std::max(up.z, 1e-6f));
            // The interface as it looks from below: x and y of what comes and goes are turned about.
            if (meet(coat_, up, 1 / eta_, w, out.weight)) return {out.weight, {-w.x, -w.y, -w.z}, true};
            w = -w;
        }
        return {0, {0, 0, 1}, true};
    }
    float next() { return unitFloat<float>(mixBits(++counter_ * 0x9E3779B9u)); }

private:
    /// Meets the interface from `from` (above it; eta is relative); true where refracted, then `to` points below.
    bool meet(const Ggx<float>& ggx, const Vec3<float>& from, float eta, Vec3<float>& to, double& weight) {
        const float x = next();
        const Vec3<float> m = ggx.sampleVisible(from, {x, next()});
        const float c = dot(from, m);
        const auto fresnel = dielectricFresnel(c, eta);
        const bool reflects = next() < fresnel.reflectance;
        to = reflects ? m * (2 * c) - from : (m * (c - fresnel.etaCosRefracted) - from) * (1 / eta);
        if (reflects != (to.z > 0)) weight = 0;
        weight *= ggx.shadowing(from, to);
        return !reflects;
    }

    float eta_, thickness_;
    Ggx<float> coat_;
    int maxDepth_;
    Base base_;
    std::uint32_t counter_ = 0;
};

}  // namespace penumbra::test
