#include "lights/light_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace penumbra {
namespace {

/// What a node costs (Conty Estevez, Kulla, section 4.3): its light, times the directions that it goes to, times its
/// size; as importance sees a node as the sphere round its box, the size is that sphere's.
double costOf(const LightBounds& b) {
    const double o = b.spread, w = std::min(o + b.falloff, std::numbers::pi);
    const double directions =
        2 * std::numbers::pi * (1 - std::cos(o)) +
        std::numbers::pi / 2 * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o));
    return b.intensity() * directions * b.radiusSquared();
}

double along(const Vec3<double>& v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

}  // namespace

class LightTree::Builder {
public:
    Builder(LightTree& tree, std::span<const LightBounds> bounds, std::span<const std::uint32_t> lights)
        : tree_(tree), bounds_(bounds), lights_(lights), order_(bounds.size()) {
        LightBounds all = bounds[0];
        double strongest = 0;
        for (std::size_t i = 0; i < bounds.size(); ++i) {
            order_[i] = std::uint32_t(i);
            all.lower = {std::min(all.lower.x, bounds[i].lower.x), std::min(all.lower.y, bounds[i].lower.y),
                         std::min(all.lower.z, bounds[i].lower.z)};
            all.upper = {std::max(all.upper.x, bounds[i].upper.x), std::max(all.upper.y, bounds[i].upper.y),
                         std::max(all.upper.z, bounds[i].upper.z)};
            strongest = std::max(strongest, bounds[i].intensity());
        }
        // Importances near one, whatever the scene's size and its lights' strength, keep floats from over- and
        // underflow.
        if (all.radiusSquared() > 0) size_ = all.radiusSquared();
        factor_ = size_ / strongest;
        tree.nodes_.reserve(bounds.size() - 1);
    }

    struct Part {
        LightBounds bounds;
        std::uint32_t link;
        std::size_t lights;
    };
    Part build(std::size_t begin, std::size_t end, int depth, std::uint32_t trail) {
        if (end - begin == 1) return leaf(order_[begin], trail);
        const std::size_t middle = split(begin, end, depth);
        const std::size_t node = tree_.nodes_.size();
        tree_.nodes_.emplace_back();
        const Part left = build(begin, middle, depth + 1, trail);
        const Part right = build(middle, end, depth + 1, trail | 1u << depth);
        write(tree_.nodes_[node], 0, left);
        write(tree_.nodes_[node], 1, right);
        LightBounds bounds = left.bounds;
        bounds.add(right.bounds);
        return {bounds, std::uint32_t(node) | (bounds.isTwoSided ? kTwoSided : 0u), end - begin};
    }

private:
    Part leaf(std::uint32_t i, std::uint32_t trail) {
        tree_.trails_[lights_[i]] = trail;
        return {bounds_[i], lights_[i] | kLeaf | (bounds_[i].isTwoSided ? kTwoSided : 0u), 1};
    }

    void write(Node& node, int side, const Part& part) const {
        const LightBounds& b = part.bounds;
        const Vec3<double> c = b.center();
        Child& child = node.child[side];
        child.x = float(c.x);
        child.y = float(c.y);
        child.z = float(c.z);
        // Rounding must not leave a light outside.
        const double rounding = 0x1p-23 * (std::abs(c.x) + std::abs(c.y) + std::abs(c.z));
        const double radius = std::sqrt(b.radiusSquared()) * (1 + 0x1p-20) + (b.radiusSquared() > 0 ? rounding : 0);
        child.radiusSquared = float(radius * radius);
        // The axis is that of the flow; the cone round it has to hold the cone of the bounds.
        const double flow = b.directed();
        const Vec3<double> axis = flow > 0 ? b.flow * (1 / flow) : b.axis;
        const double turn = std::acos(std::clamp(dot(axis, b.axis), -1., 1.));
        child.axisX = float(axis.x);
        child.axisY = float(axis.y);
        child.axisZ = float(axis.z);
        child.directed = float(flow * factor_);
        constexpr double kFaintest = 1e-12;  // of the strongest
        const double even = std::max(b.undirected() * factor_, kFaintest * size_);
        node.rest[side] = {float(even), float(std::cos(std::min(turn + b.spread + b.falloff, std::numbers::pi))),
                           float(part.lights), std::bit_cast<float>(part.link)};
    }

    /// Puts the lights of the left child first and returns where the right child's begin.
    std::size_t split(std::size_t begin, std::size_t end, int depth) {
        const std::size_t count = end - begin;
        // So that what is below fits into the bits of a trail even if it is cut in halves only.
        const bool isDeep = depth + int(std::bit_width(count - 1)) + 1 >= kMaxDepth;
        const std::size_t middle = isDeep || count == 2 ? begin : cheapestSplit(begin, end);
        return middle > begin && middle < end ? middle : medianSplit(begin, end);
    }

    double place(std::uint32_t i, int axis) const { return along(bounds_[i].center(), axis); }

    struct Range {
        double low, high;
    };
    Range rangeOf(std::size_t begin, std::size_t end, int axis) const {
        Range r{place(order_[begin], axis), place(order_[begin], axis)};
        for (std::size_t k = begin; k < end; ++k) {
            r.low = std::min(r.low, place(order_[k], axis));
            r.high = std::max(r.high, place(order_[k], axis));
        }
        return r;
    }

    std::size_t medianSplit(std::size_t begin, std::size_t end) {
        int widest = 0;
        double width = -1;
        for (int axis = 0; axis < 3; ++axis) {
            const Range r = rangeOf(begin, end, axis);
            if (r.high - r.low > width) width = r.high - r.low, widest = axis;
        }
        const std::size_t middle = begin + (end - begin) / 2;
        const auto at = [&](std::size_t k) { return order_.begin() + std::ptrdiff_t(k); };
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            const double x = place(a, widest), y = place(b, widest);
            return x < y || (x == y && a < b);
        });
        return middle;
    }

    /// The best of the cuts between kBuckets slices along each axis; `begin` where there is none.
    std::size_t cheapestSplit(std::size_t begin, std::size_t end) {
        std::array<Range, 3> ranges;
        double widest = 0;
        for (int axis = 0; axis < 3; ++axis) {
            ranges[std::size_t(axis)] = rangeOf(begin, end, axis);
            widest = std::max(widest, ranges[std::size_t(axis)].high - ranges[std::size_t(axis)].low);
        }
        double least = INFINITY;
        int bestAxis = -1;
        std::size_t bestCut = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const Range r = ranges[std::size_t(axis)];
            if (!(r.high > r.low)) continue;
            std::array<Slice, kBuckets> slices{};
            for (std::size_t k = begin; k < end; ++k)
                slices[bucketOf(order_[k], axis, r)].add(bounds_[order_[k]]);
            // Cuts that leave long thin nodes are to be avoided (the paper's factor for regularity).
            const double regularity = widest / (r.high - r.low);
            std::array<double, kBuckets> below{};
            Slice part;
            for (std::size_t cut = 1; cut < kBuckets; ++cut) {
                part.add(slices[cut - 1]);
                below[cut] = part.cost();
            }
            part = {};
            for (std::size_t cut = kBuckets - 1; cut > 0; --cut) {
                part.add(slices[cut]);
                const double cost = regularity * (below[cut] + part.cost());
                if (cost < least) least = cost, bestAxis = axis, bestCut = cut;
            }
        }
        if (bestAxis < 0) return begin;
        const auto at = [&](std::size_t k) { return order_.begin() + std::ptrdiff_t(k); };
        const auto middle = std::stable_partition(at(begin), at(end), [&](std::uint32_t i) {
            return bucketOf(i, bestAxis, ranges[std::size_t(bestAxis)]) < bestCut;
        });
        return std::size_t(middle - order_.begin());
    }

    static constexpr std::size_t kBuckets = 12;
    std::size_t bucketOf(std::uint32_t i, int axis, const Range& r) const {
        const double t = (place(i, axis) - r.low) / (r.high - r.low);
        return std::min(std::size_t(t * kBuckets), kBuckets - 1);
    }

    struct Slice {
        LightBounds bounds;
        bool isEmpty = true;
        void add(const LightBounds& b) {
            if (isEmpty)
                bounds = b;
            else
                bounds.add(b);
            isEmpty = false;
        }
        void add(const Slice& s) {
            if (!s.isEmpty) add(s.bounds);
        }
        double cost() const { return isEmpty ? 0 : costOf(bounds); }
    };

    LightTree& tree_;
    std::span<const LightBounds> bounds_;
    std::span<const std::uint32_t> lights_;
    std::vector<std::uint32_t> order_;
    double size_ = 1, factor_ = 1;
};

LightTree::LightTree(std::span<const LightBounds> bounds, std::span<const std::uint32_t> lights, std::uint32_t idCount,
                     std::uint32_t units) {
    if (bounds.empty()) return;
    units_ = units;
    onlyLight_ = lights[0];
    trails_.assign(idCount, kNoTrail);
    Builder(*this, bounds, lights).build(0, bounds.size(), 0, 0);
}

}  // namespace penumbra
