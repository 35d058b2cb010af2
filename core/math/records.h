// Records: how lanes read tables of plain structs. Each lane has its own row of an array of T; fields are read by member
// pointer. T consists of 32-bit words only (float and std::uint32_t), so every field has a word offset.
#pragma once

#include "core/math/spectrum.h"
#include "core/math/vector.h"

#include <type_traits>

namespace penumbra {

/// Row `index[k]` of `base` for lane k. Where all lanes share one row (the usual case: groups are sorted) a field is one
/// broadcast load; otherwise a gather. At most 2^31 words in the table.
template <class F, class T>
class Records {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);

public:
    Records(const T* base, const UInt<F>& index) : base_(base), index_(index) {
        if constexpr (kLanes<F> > 1) {
            first_ = lane(index, 0);
            shared_ = all(index == UInt<F>(first_));
        } else {
            first_ = index;
        }
    }
    /// All lanes read that row.
    static Records ofRow(const T* base, std::uint32_t row) {
        Records r(base);
        r.index_ = UInt<F>(row);
        r.first_ = row;
        return r;
    }
    const UInt<F>& index() const { return index_; }
    /// True where all lanes read one row: first() is then that row.
    bool shared() const { return shared_; }
    const T& first() const { return base_[first_]; }
    /// The row of one lane.
    const T& row(int i) const { return base_[lane(index_, i)]; }

    F operator()(float T::*field) const { return read<F>(&(base_[0].*field), base_[first_].*field); }
    UInt<F> operator()(std::uint32_t T::*field) const { return read<UInt<F>>(&(base_[0].*field), base_[first_].*field); }
    /// An enumeration over std::uint32_t, as its number.
    template <class E>
        requires(std::is_enum_v<E> && sizeof(E) == 4)
    UInt<F> operator()(E T::*field) const {
        return read<UInt<F>>(reinterpret_cast<const std::uint32_t*>(&(base_[0].*field)), std::uint32_t(base_[first_].*field));
    }
    Vec3<F> operator()(Vec3<float> T::*field) const {
        const auto& f0 = base_[0].*field;
        const auto& f = base_[first_].*field;
        return {read<F>(&f0.x, f.x), read<F>(&f0.y, f.y), read<F>(&f0.z, f.z)};
    }
    Spectrum<F> operator()(Spectrum<float> T::*field) const {
        const auto& f0 = base_[0].*field;
        const auto& f = base_[first_].*field;
        return {read<F>(&f0.r, f.r), read<F>(&f0.g, f.g), read<F>(&f0.b, f.b)};
    }

private:
    explicit Records(const T* base) : base_(base) {}
    template <class R, class W>
    R read(const W* firstRow, W shared) const {
        if (shared_) return R(shared);
        return gather(firstRow, index_ * UInt<F>(std::uint32_t(sizeof(T) / 4)));
    }
    const T* base_;
    UInt<F> index_;
    std::uint32_t first_ = 0;
    bool shared_ = true;
};

}  // namespace penumbra
