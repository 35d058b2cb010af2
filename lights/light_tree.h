// LightTree: picks a light in proportion to what it may contribute at a place, in time that grows with the logarithm of
// their number.
//
// Sources: Conty Estevez, Kulla 2018 ("Importance sampling of many lights with adaptive tree splitting", HPG), and
// pbrt-v4's use of it (Pharr, Jakob, Humphreys 2023, section 12.6.3). A binary tree over the lights; each node bounds
// where its lights are and where they shine to (LightBounds). A pick goes down from the root, at each node to one of
// two children in proportion to their importance: intensity / d^2 times the cosines at the light and at the surface.
// Where by its bounds no light of a node can shine, that is 0, as in the sources; else it is an estimate of the mean
// over the node's lights where theirs is a bound, which says little of large nodes near by. (With their bounds the
// variance of 10^5 lamps over a floor is 15 to 20 times what it is here.)
//
// Probabilities are whole numbers of units of 2^-24, as fine as a sampler's numbers: a node owns an interval of those
// numbers and divides it between its children, a child of any importance getting at least one unit for each light below
// it. So a light that can contribute is never impossible to pick, and the probability told is exactly the measure of
// the numbers that pick the light.
//
// All lanes descend together; each reads its own node. The way to a given light (for multiple importance sampling) is a
// word of left-or-right bits.
//
// Thread safety: immutable once built.
// Invariants: depth at most kMaxDepth; a node's interval has at least as many units as lights.
#pragma once

#include "core/math/vector.h"
#include "lights/light_bounds.h"

#include <span>
#include <vector>

namespace penumbra {

/// Where light is wanted: a point and the normal of its surface (of either side).
template <class F>
struct LitPoint {
    Vec3<F> p, n;
};

class LightTree {
public:
    static constexpr std::uint32_t kUnits = 1u << 24;  ///< of probability: all there is
    static constexpr int kMaxDepth = 31;

    LightTree() = default;
    /// One leaf a light; `lights[i]` has the bounds `bounds[i]`. REQUIRES: ids below idCount, intensities above 0, and
    /// no more lights than `units`, the interval of numbers that the tree owns (from 0).
    LightTree(std::span<const LightBounds> bounds, std::span<const std::uint32_t> lights, std::uint32_t idCount,
              std::uint32_t units);

    /// Units of all numbers that pick some light; 0 where there is no tree.
    std::uint32_t units() const { return units_; }

    /// The light that `number` (below units()) picks at `at`, and how many numbers do. Where nothing can shine there,
    /// or the lane is not `wanted`, the light is any of them and the units are 0.
    template <class F>
    void pick(const LitPoint<F>& at, const UInt<F>& number, const Mask<F>& wanted, UInt<F>& light,
              UInt<F>& units) const;

    /// How many numbers pick `light` at `at`; 0 for lights that are not in the tree.
    template <class F>
    UInt<F> unitsOf(const LitPoint<F>& at, const UInt<F>& light) const;

private:
    static constexpr std::uint32_t kLeaf = 1u << 31, kTwoSided = 1u << 30, kIndex = kTwoSided - 1u;
    static constexpr float kBlur = 0.3f;
    static constexpr std::uint32_t kNoTrail = 0xFFFFFFFFu;

    /// One of the two children of a node. `link` is a node or, with kLeaf, a light; with kTwoSided the cosine at the
    /// light counts whatever its sign.
    struct Child {
        float x, y, z, radiusSquared;         ///< the sphere round the box
        float axisX, axisY, axisZ, directed;  ///< intensity that goes with the cosine from the axis
    };
    struct Rest {
        float even;      ///< intensity in all directions
        float cosLimit;  ///< of the angle from the axis beyond which nothing shines
        float lights;    ///< below
        float link;      ///< bits of a word
    };
    /// Three rows of eight words, so that lanes load them whole.
    struct Node {
        Child child[2];
        Rest rest[2];
    };
    static constexpr std::uint32_t kNodeWords = sizeof(Node) / 4;
    static_assert(kNodeWords == 24);

    class Builder;

    template <class F>
    static F importance(const F child[8], F even, F cosLimit, const UInt<F>& link, const LitPoint<F>& at);

    /// About the mean cosine, where it is positive, over directions that cover an angle round one of that cosine.
    template <class F>
    static F meanCosine(F cosine, F sinCover2) {
        return F(0.5f) * (cosine + sqrt(cosine * cosine + F(kBlur) * max(sinCover2, F(1e-4f))));
    }

    /// Goes down from the root in the lanes of `active`; `goesLeft(left units, node's first number, depth)` says where.
    template <class F, class GoesLeft>
    void descend(const LitPoint<F>& at, Mask<F> active, UInt<F>& light, UInt<F>& units, GoesLeft&& goesLeft) const;

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> trails_;  ///< by light: bit i is set where the way down turns right at depth i
    std::uint32_t units_ = 0, onlyLight_ = 0;
};

template <class F>
F LightTree::importance(const F child[8], F even, F cosLimit, const UInt<F>& link, const LitPoint<F>& at) {
    const Vec3<F> d = at.p - Vec3<F>{child[0], child[1], child[2]};
    const F radius2 = child[3], distance2 = lengthSquared(d);
    const F perDistance = F(1.f) / sqrt(max(distance2, F(1e-37f)));
    // The angle that the sphere covers; all directions from within.
    const F sinCover2 = min(radius2 * (perDistance * perDistance), F(1.f));
    const Mask<F> within = !(sinCover2 < F(1.f));

    const F along = dot(d, Vec3<F>{child[4], child[5], child[6]}) * perDistance;
    const Mask<F> twoSided = (link & UInt<F>(kTwoSided)) != UInt<F>(0u);
    const F cosAxis = clamp(select(twoSided, abs(along), along), F(-1.f), F(1.f));
    // Nothing shines where even the nearest of the directions that the sphere covers is beyond the limit. At the very
    // limit rounding must not decide.
    const F cosCover = sqrt(F(1.f) - sinCover2), sinAxis = sqrt(F(1.f) - cosAxis * cosAxis);
    const F cosNearest = cosAxis * cosCover + sinAxis * sqrt(sinCover2);
    const Mask<F> shines = within | (cosAxis >= cosCover) | (cosNearest > cosLimit - F(1e-5f));

    const F cosSurface = abs(dot(d, at.n)) * perDistance;
    const F intensity = even + child[7] * meanCosine(cosAxis, sinCover2);
    const F value = intensity * meanCosine(cosSurface, sinCover2) / max(distance2, max(radius2 * F(0.25f), F(1e-30f)));
    return select(shines, value, F(0.f));
}

template <class F, class GoesLeft>
void LightTree::descend(const LitPoint<F>& at, Mask<F> active, UInt<F>& light, UInt<F>& units,
                        GoesLeft&& goesLeft) const {
    light = UInt<F>(onlyLight_);
    units = select(active, UInt<F>(units_), UInt<F>(0u));
    if (nodes_.empty()) return;
    UInt<F> node(0u), first(0u);
    for (int depth = 0; any(active); ++depth) {
        F left[8], right[8], rest[8];
        const float* const base = &nodes_[0].child[0].x;
        const UInt<F> offset = node * UInt<F>(kNodeWords);
        loadRows8(base, offset, left);
        loadRows8(base, offset + UInt<F>(8u), right);
        loadRows8(base, offset + UInt<F>(16u), rest);
        const UInt<F> linkLeft = floatBits(rest[3]), linkRight = floatBits(rest[7]);
        const F a = importance<F>(left, rest[0], rest[1], linkLeft, at);
        const F b = importance<F>(right, rest[4], rest[5], linkRight, at);
        // The left child's part: in proportion, but a unit for each light on either side that can shine.
        const Mask<F> leftShines = a > F(0.f), rightShines = b > F(0.f);
        const UInt<F> least = select(leftShines, toUInt(rest[2]), UInt<F>(0u));
        const UInt<F> most = units - select(rightShines, toUInt(rest[6]), UInt<F>(0u));
        const UInt<F> share = toUInt(toFloat<F>(units) * (a / max(a + b, F(1e-37f))));
        const UInt<F> atMost = min(share, most), leftUnits = select(atMost < least, least, atMost);
        const Mask<F> goes = goesLeft(leftUnits, first, depth);
        const UInt<F> link = select(goes, linkLeft, linkRight);
        const Mask<F> alive = active & (leftShines | rightShines);
        const UInt<F> part = select(goes, leftUnits, units - leftUnits);
        units = select(active, select(alive, part, UInt<F>(0u)), units);
        first = select(goes, first, first + leftUnits);
        const Mask<F> isLeaf = (link & UInt<F>(kLeaf)) != UInt<F>(0u);
        light = select(alive & isLeaf, link & UInt<F>(kIndex), light);
        active = alive & !isLeaf & (units != UInt<F>(0u));
        node = select(active, link & UInt<F>(kIndex), node);
    }
}

template <class F>
void LightTree::pick(const LitPoint<F>& at, const UInt<F>& number, const Mask<F>& wanted, UInt<F>& light,
                     UInt<F>& units) const {
    descend(at, wanted, light, units,
            [&](const UInt<F>& leftUnits, const UInt<F>& first, int) { return number - first < leftUnits; });
}

template <class F>
UInt<F> LightTree::unitsOf(const LitPoint<F>& at, const UInt<F>& light) const {
    if (units_ == 0) return UInt<F>(0u);
    const UInt<F> trail = gather(trails_.data(), light);
    UInt<F> found, units;
    descend(at, trail != UInt<F>(kNoTrail), found, units,
            [&](const UInt<F>&, const UInt<F>&, int depth) { return ((trail >> depth) & UInt<F>(1u)) == UInt<F>(0u); });
    return units;
}

}  // namespace penumbra
