// Lanes: the arithmetic types that transport code is generic over, and the only file that knows how they are made.
//
// Hot code is written once, as templates over F, and runs with F = float (one path: replay, tests, tools) or
// F = Lanes8f (eight paths in an AVX2 register). Both give the same bits: every operation here is IEEE-exact or built
// from the same exact operations in the same order, contraction is off, and min/max are defined by select.
//
// Conventions: Mask<F>, UInt<F>, Int<F> belong to F. Masks use & | !, never ~ or && (the scalar mask is bool).
// A branch is select(mask, a, b); a data-dependent loop is `while (any(active))` with finished lanes frozen by select.
// Unsigned values convert to float through int and must stay below 2^31; clamp before converting float to int.
#pragma once

#include <bit>
#include <cstdint>
#include <immintrin.h>

namespace penumbra {

// ---------------------------------------------------------------------------------------------------- eight lanes

namespace detail {
using V8f = float __attribute__((vector_size(32)));
using V8i = std::int32_t __attribute__((vector_size(32)));
using V8u = std::uint32_t __attribute__((vector_size(32)));
}  // namespace detail

/// Eight truth values; each lane is all ones or all zeros.
struct Mask8 {
    detail::V8i v;
    Mask8() = default;
    Mask8(bool b) : v(detail::V8i{} - (b ? 1 : 0)) {}
    explicit Mask8(detail::V8i x) : v(x) {}
    friend Mask8 operator&(Mask8 a, Mask8 b) { return Mask8(a.v & b.v); }
    friend Mask8 operator|(Mask8 a, Mask8 b) { return Mask8(a.v | b.v); }
    friend Mask8 operator^(Mask8 a, Mask8 b) { return Mask8(a.v ^ b.v); }
    friend Mask8 operator!(Mask8 a) { return Mask8(~a.v); }
    friend Mask8 operator==(Mask8 a, Mask8 b) { return Mask8(~(a.v ^ b.v)); }
    Mask8& operator&=(Mask8 b) { v &= b.v; return *this; }
    Mask8& operator|=(Mask8 b) { v |= b.v; return *this; }
};

struct Lanes8u;

struct Lanes8i {
    detail::V8i v;
    Lanes8i() = default;
    Lanes8i(std::int32_t x) : v(detail::V8i{} + x) {}
    explicit Lanes8i(detail::V8i x) : v(x) {}
    explicit Lanes8i(Lanes8u x);
    friend Lanes8i operator+(Lanes8i a, Lanes8i b) { return Lanes8i(a.v + b.v); }
    friend Lanes8i operator-(Lanes8i a, Lanes8i b) { return Lanes8i(a.v - b.v); }
    friend Lanes8i operator*(Lanes8i a, Lanes8i b) { return Lanes8i(a.v * b.v); }
    friend Lanes8i operator&(Lanes8i a, Lanes8i b) { return Lanes8i(a.v & b.v); }
    friend Lanes8i operator|(Lanes8i a, Lanes8i b) { return Lanes8i(a.v | b.v); }
    friend Lanes8i operator<<(Lanes8i a, int n) { return Lanes8i(a.v << n); }
    friend Lanes8i operator>>(Lanes8i a, int n) { return Lanes8i(a.v >> n); }
    friend Mask8 operator==(Lanes8i a, Lanes8i b) { return Mask8(a.v == b.v); }
    friend Mask8 operator!=(Lanes8i a, Lanes8i b) { return Mask8(a.v != b.v); }
    friend Mask8 operator<(Lanes8i a, Lanes8i b) { return Mask8(a.v < b.v); }
    friend Mask8 operator>(Lanes8i a, Lanes8i b) { return Mask8(a.v > b.v); }
    friend Mask8 operator<=(Lanes8i a, Lanes8i b) { return Mask8(a.v <= b.v); }
    friend Mask8 operator>=(Lanes8i a, Lanes8i b) { return Mask8(a.v >= b.v); }
};

struct Lanes8u {
    detail::V8u v;
    Lanes8u() = default;
    Lanes8u(std::uint32_t x) : v(detail::V8u{} + x) {}
    explicit Lanes8u(detail::V8u x) : v(x) {}
    explicit Lanes8u(Lanes8i x) : v((detail::V8u)x.v) {}
    friend Lanes8u operator+(Lanes8u a, Lanes8u b) { return Lanes8u(a.v + b.v); }
    friend Lanes8u operator-(Lanes8u a, Lanes8u b) { return Lanes8u(a.v - b.v); }
    friend Lanes8u operator*(Lanes8u a, Lanes8u b) { return Lanes8u(a.v * b.v); }
    friend Lanes8u operator&(Lanes8u a, Lanes8u b) { return Lanes8u(a.v & b.v); }
    friend Lanes8u operator|(Lanes8u a, Lanes8u b) { return Lanes8u(a.v | b.v); }
    friend Lanes8u operator^(Lanes8u a, Lanes8u b) { return Lanes8u(a.v ^ b.v); }
    friend Lanes8u operator<<(Lanes8u a, int n) { return Lanes8u(a.v << n); }
    friend Lanes8u operator>>(Lanes8u a, int n) { return Lanes8u(a.v >> n); }
    friend Mask8 operator==(Lanes8u a, Lanes8u b) { return Mask8(a.v == b.v); }
    friend Mask8 operator!=(Lanes8u a, Lanes8u b) { return Mask8(a.v != b.v); }
    friend Mask8 operator<(Lanes8u a, Lanes8u b) { return Mask8(a.v < b.v); }
    Lanes8u& operator+=(Lanes8u b) { v += b.v; return *this; }
    Lanes8u& operator*=(Lanes8u b) { v *= b.v; return *this; }
    Lanes8u& operator^=(Lanes8u b) { v ^= b.v; return *this; }
    Lanes8u& operator|=(Lanes8u b) { v |= b.v; return *this; }
};

inline Lanes8i::Lanes8i(Lanes8u x) : v((detail::V8i)x.v) {}

struct Lanes8f {
    detail::V8f v;
    Lanes8f() = default;
    Lanes8f(float x) : v(detail::V8f(_mm256_set1_ps(x))) {}
    explicit Lanes8f(detail::V8f x) : v(x) {}
    explicit Lanes8f(Lanes8i x) : v(detail::V8f(_mm256_cvtepi32_ps(__m256i(x.v)))) {}
    friend Lanes8f operator+(Lanes8f a, Lanes8f b) { return Lanes8f(a.v + b.v); }
    friend Lanes8f operator-(Lanes8f a, Lanes8f b) { return Lanes8f(a.v - b.v); }
    friend Lanes8f operator*(Lanes8f a, Lanes8f b) { return Lanes8f(a.v * b.v); }
    friend Lanes8f operator/(Lanes8f a, Lanes8f b) { return Lanes8f(a.v / b.v); }
    friend Lanes8f operator-(Lanes8f a) { return Lanes8f(-a.v); }
    friend Mask8 operator<(Lanes8f a, Lanes8f b) { return Mask8(a.v < b.v); }
    friend Mask8 operator>(Lanes8f a, Lanes8f b) { return Mask8(a.v > b.v); }
    friend Mask8 operator<=(Lanes8f a, Lanes8f b) { return Mask8(a.v <= b.v); }
    friend Mask8 operator>=(Lanes8f a, Lanes8f b) { return Mask8(a.v >= b.v); }
    friend Mask8 operator==(Lanes8f a, Lanes8f b) { return Mask8(a.v == b.v); }
    friend Mask8 operator!=(Lanes8f a, Lanes8f b) { return Mask8(a.v != b.v); }
    Lanes8f& operator+=(Lanes8f b) { v += b.v; return *this; }
    Lanes8f& operator-=(Lanes8f b) { v -= b.v; return *this; }
    Lanes8f& operator*=(Lanes8f b) { v *= b.v; return *this; }
    Lanes8f& operator/=(Lanes8f b) { v /= b.v; return *this; }
};

// ---------------------------------------------------------------------------------------------------- the family of F

template <class F>
struct LaneFamily;
template <>
struct LaneFamily<float> {
    using Mask = bool;
    using UInt = std::uint32_t;
    using Int = std::int32_t;
    static constexpr int width = 1;
};
template <>
struct LaneFamily<Lanes8f> {
    using Mask = Mask8;
    using UInt = Lanes8u;
    using Int = Lanes8i;
    static constexpr int width = 8;
};
template <class F> using Mask = typename LaneFamily<F>::Mask;
template <class F> using UInt = typename LaneFamily<F>::UInt;
template <class F> using Int = typename LaneFamily<F>::Int;
template <class F> inline constexpr int kLanes = LaneFamily<F>::width;

// ---------------------------------------------------------------------------------------------------- select, any, all

inline float select(bool m, float a, float b) { return m ? a : b; }
inline std::uint32_t select(bool m, std::uint32_t a, std::uint32_t b) { return m ? a : b; }
inline std::int32_t select(bool m, std::int32_t a, std::int32_t b) { return m ? a : b; }
inline bool select(bool m, bool a, bool b) { return m ? a : b; }
inline Lanes8f select(Mask8 m, Lanes8f a, Lanes8f b) {
    return Lanes8f(detail::V8f(_mm256_blendv_ps(__m256(b.v), __m256(a.v), _mm256_castsi256_ps(__m256i(m.v)))));
}
inline Lanes8i select(Mask8 m, Lanes8i a, Lanes8i b) {
    return Lanes8i(detail::V8i(_mm256_blendv_epi8(__m256i(b.v), __m256i(a.v), __m256i(m.v))));
}
inline Lanes8u select(Mask8 m, Lanes8u a, Lanes8u b) {
    return Lanes8u(detail::V8u(_mm256_blendv_epi8(__m256i(b.v), __m256i(a.v), __m256i(m.v))));
}
inline Mask8 select(Mask8 m, Mask8 a, Mask8 b) { return Mask8((a.v & m.v) | (b.v & ~m.v)); }

/// One bit a lane, lane 0 in bit 0.
inline unsigned bits(bool m) { return m ? 1u : 0u; }
inline unsigned bits(Mask8 m) { return unsigned(_mm256_movemask_ps(_mm256_castsi256_ps(__m256i(m.v)))); }
inline bool any(bool m) { return m; }
inline bool any(Mask8 m) { return bits(m) != 0; }
inline bool all(bool m) { return m; }
inline bool all(Mask8 m) { return bits(m) == 0xFFu; }
inline bool none(bool m) { return !m; }
inline bool none(Mask8 m) { return bits(m) == 0; }
template <class M> int countLanes(M m) { return std::popcount(bits(m)); }

/// The mask of the first n lanes.
template <class F> Mask<F> firstLanes(int n);
template <> inline bool firstLanes<float>(int n) { return n > 0; }
template <> inline Mask8 firstLanes<Lanes8f>(int n) {
    const detail::V8i i = {0, 1, 2, 3, 4, 5, 6, 7};
    return Mask8(detail::V8i(i < n));
}

/// 0, 1, 2, ... across the lanes.
template <class F> UInt<F> laneIndices();
template <> inline std::uint32_t laneIndices<float>() { return 0; }
template <> inline Lanes8u laneIndices<Lanes8f>() { return Lanes8u(detail::V8u{0, 1, 2, 3, 4, 5, 6, 7}); }

// One lane of a value: for the batch driver and for adapters that loop over lanes.
inline float lane(float x, int) { return x; }
inline std::uint32_t lane(std::uint32_t x, int) { return x; }
inline std::int32_t lane(std::int32_t x, int) { return x; }
inline bool lane(bool x, int) { return x; }
inline float lane(const Lanes8f& x, int i) { return x.v[i]; }
inline std::uint32_t lane(const Lanes8u& x, int i) { return x.v[i]; }
inline std::int32_t lane(const Lanes8i& x, int i) { return x.v[i]; }
inline bool lane(const Mask8& x, int i) { return x.v[i] != 0; }
inline void setLane(float& x, int, float y) { x = y; }
inline void setLane(std::uint32_t& x, int, std::uint32_t y) { x = y; }
inline void setLane(bool& x, int, bool y) { x = y; }
inline void setLane(Lanes8f& x, int i, float y) { x.v[i] = y; }
inline void setLane(Lanes8u& x, int i, std::uint32_t y) { x.v[i] = y; }
inline void setLane(Mask8& x, int i, bool y) { x.v[i] = y ? -1 : 0; }

// ---------------------------------------------------------------------------------------------------- conversions

template <class F> F toFloat(Int<F> x);
template <> inline float toFloat<float>(std::int32_t x) { return float(x); }
template <> inline Lanes8f toFloat<Lanes8f>(Lanes8i x) { return Lanes8f(x); }
/// x < 2^31.
template <class F> F toFloat(UInt<F> x);
template <> inline float toFloat<float>(std::uint32_t x) { return float(std::int32_t(x)); }
template <> inline Lanes8f toFloat<Lanes8f>(Lanes8u x) { return Lanes8f(Lanes8i(x)); }
/// Towards zero; |x| < 2^31.
inline std::int32_t toInt(float x) { return std::int32_t(x); }
inline Lanes8i toInt(Lanes8f x) { return Lanes8i(detail::V8i(_mm256_cvttps_epi32(__m256(x.v)))); }
/// Towards zero; 0 <= x < 2^31.
inline std::uint32_t toUInt(float x) { return std::uint32_t(std::int32_t(x)); }
inline Lanes8u toUInt(Lanes8f x) { return Lanes8u(toInt(x)); }
inline std::uint32_t asUInt(std::int32_t x) { return std::uint32_t(x); }
inline Lanes8u asUInt(Lanes8i x) { return Lanes8u(x); }
inline std::int32_t asInt(std::uint32_t x) { return std::int32_t(x); }
inline Lanes8i asInt(Lanes8u x) { return Lanes8i(x); }

inline std::uint32_t floatBits(float x) { return std::bit_cast<std::uint32_t>(x); }
inline Lanes8u floatBits(Lanes8f x) { return Lanes8u((detail::V8u)x.v); }
inline float floatFromBits(std::uint32_t x) { return std::bit_cast<float>(x); }
inline Lanes8f floatFromBits(Lanes8u x) { return Lanes8f((detail::V8f)x.v); }

// ---------------------------------------------------------------------------------------------------- arithmetic

inline float sqrt(float x) { return __builtin_sqrtf(x); }
inline Lanes8f sqrt(Lanes8f x) { return Lanes8f(detail::V8f(_mm256_sqrt_ps(__m256(x.v)))); }
inline float floor(float x) { return _mm_cvtss_f32(_mm_floor_ss(_mm_set_ss(x), _mm_set_ss(x))); }
inline Lanes8f floor(Lanes8f x) { return Lanes8f(detail::V8f(_mm256_floor_ps(__m256(x.v)))); }

// Cold code in double says std::sqrt and so on: without these a double would silently round to float.
double sqrt(double) = delete;
double floor(double) = delete;
double abs(double) = delete;
double min(double, double) = delete;
double max(double, double) = delete;

/// Nearest integer, ties to even.
inline float roundToEven(float x) {
    return _mm_cvtss_f32(_mm_round_ss(_mm_set_ss(x), _mm_set_ss(x), _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC));
}
inline Lanes8f roundToEven(Lanes8f x) {
    return Lanes8f(detail::V8f(_mm256_round_ps(__m256(x.v), _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC)));
}

inline float abs(float x) { return floatFromBits(floatBits(x) & 0x7FFFFFFFu); }
inline Lanes8f abs(Lanes8f x) { return floatFromBits(floatBits(x) & Lanes8u(0x7FFFFFFFu)); }

// min and max are selects: min(a, NaN) = NaN, min(NaN, b) = b, in both families.
inline float min(float a, float b) { return a < b ? a : b; }
inline float max(float a, float b) { return a > b ? a : b; }
inline Lanes8f min(Lanes8f a, Lanes8f b) { return Lanes8f(detail::V8f(_mm256_min_ps(__m256(a.v), __m256(b.v)))); }
inline Lanes8f max(Lanes8f a, Lanes8f b) { return Lanes8f(detail::V8f(_mm256_max_ps(__m256(a.v), __m256(b.v)))); }
inline std::int32_t min(std::int32_t a, std::int32_t b) { return a < b ? a : b; }
inline std::int32_t max(std::int32_t a, std::int32_t b) { return a > b ? a : b; }
inline Lanes8i min(Lanes8i a, Lanes8i b) { return Lanes8i(detail::V8i(_mm256_min_epi32(__m256i(a.v), __m256i(b.v)))); }
inline Lanes8i max(Lanes8i a, Lanes8i b) { return Lanes8i(detail::V8i(_mm256_max_epi32(__m256i(a.v), __m256i(b.v)))); }
inline std::uint32_t min(std::uint32_t a, std::uint32_t b) { return a < b ? a : b; }
inline Lanes8u min(Lanes8u a, Lanes8u b) { return Lanes8u(detail::V8u(_mm256_min_epu32(__m256i(a.v), __m256i(b.v)))); }

template <class F> F clamp(F x, F lo, F hi) { return min(max(x, lo), hi); }
template <class F> F sqr(F x) { return x * x; }
template <class F> F safeSqrt(F x) { return sqrt(max(x, F(0.f))); }
template <class F> F lerp(F t, F a, F b) { return (F(1.f) - t) * a + t * b; }
/// x with its sign flipped where the mask is set.
inline float flipSign(bool m, float x) { return m ? -x : x; }
inline Lanes8f flipSign(Mask8 m, Lanes8f x) {
    return floatFromBits(floatBits(x) ^ Lanes8u((detail::V8u)(m.v & std::int32_t(0x80000000))));
}
/// |x| with the sign of s.
inline float copySign(float x, float s) { return floatFromBits((floatBits(x) & 0x7FFFFFFFu) | (floatBits(s) & 0x80000000u)); }
inline Lanes8f copySign(Lanes8f x, Lanes8f s) {
    return floatFromBits((floatBits(x) & Lanes8u(0x7FFFFFFFu)) | (floatBits(s) & Lanes8u(0x80000000u)));
}
template <class F> Mask<F> isFinite(F x) { return (floatBits(x) & UInt<F>(0x7F800000u)) != UInt<F>(0x7F800000u); }

/// 32-bit rotation of the bit order (bit 0 <-> bit 31).
inline std::uint32_t reverseBits(std::uint32_t x) {
    x = __builtin_bswap32(x);
    x = ((x & 0x0F0F0F0Fu) << 4) | ((x >> 4) & 0x0F0F0F0Fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}
inline Lanes8u reverseBits(Lanes8u x) {
    const __m256i swapBytes = _mm256_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12,
                                               3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12);
    // Each nibble reversed by table, the two nibbles of a byte exchanged.
    const __m256i nibble = _mm256_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15,
                                            0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15);
    const __m256i low = _mm256_set1_epi8(0x0F);
    const __m256i b = _mm256_shuffle_epi8(__m256i(x.v), swapBytes);
    const __m256i lo = _mm256_shuffle_epi8(nibble, _mm256_and_si256(b, low));
    const __m256i hi = _mm256_shuffle_epi8(nibble, _mm256_and_si256(_mm256_srli_epi16(b, 4), low));
    return Lanes8u(detail::V8u(_mm256_or_si256(_mm256_slli_epi16(lo, 4), hi)));
}

// ---------------------------------------------------------------------------------------------------- memory

/// Contiguous, unaligned.
template <class F> F load(const float* p);
template <> inline float load<float>(const float* p) { return *p; }
template <> inline Lanes8f load<Lanes8f>(const float* p) { return Lanes8f(detail::V8f(_mm256_loadu_ps(p))); }
template <class F> UInt<F> load(const std::uint32_t* p);
template <> inline std::uint32_t load<float>(const std::uint32_t* p) { return *p; }
template <> inline Lanes8u load<Lanes8f>(const std::uint32_t* p) {
    return Lanes8u(detail::V8u(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))));
}
inline void store(float* p, float x) { *p = x; }
inline void store(float* p, Lanes8f x) { _mm256_storeu_ps(p, __m256(x.v)); }
inline void store(std::uint32_t* p, std::uint32_t x) { *p = x; }
inline void store(std::uint32_t* p, Lanes8u x) { _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), __m256i(x.v)); }
/// Eight 16-bit indices, widened.
template <class F> UInt<F> loadIndices(const std::uint16_t* p);
template <> inline std::uint32_t loadIndices<float>(const std::uint16_t* p) { return *p; }
template <> inline Lanes8u loadIndices<Lanes8f>(const std::uint16_t* p) {
    return Lanes8u(detail::V8u(_mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)))));
}

inline float gather(const float* base, std::uint32_t i) { return base[i]; }
inline std::uint32_t gather(const std::uint32_t* base, std::uint32_t i) { return base[i]; }
inline Lanes8f gather(const float* base, Lanes8u i) {
    return Lanes8f(detail::V8f(_mm256_i32gather_ps(base, __m256i(i.v), 4)));
}
inline Lanes8u gather(const std::uint32_t* base, Lanes8u i) {
    return Lanes8u(detail::V8u(_mm256_i32gather_epi32(reinterpret_cast<const int*>(base), __m256i(i.v), 4)));
}
inline void scatter(std::uint32_t* base, std::uint32_t i, std::uint32_t x) { base[i] = x; }
inline void scatter(std::uint32_t* base, const Lanes8u& i, const Lanes8u& x) {
    for (int k = 0; k < 8; ++k) base[i.v[k]] = x.v[k];
}

/// Asks for the line of memory of base[i], which need not be there.
inline void prefetch(const std::uint32_t* base, std::uint32_t i) {
    _mm_prefetch(reinterpret_cast<const char*>(base) + std::size_t(i) * sizeof *base, _MM_HINT_T0);
}

/// Four consecutive floats at base + offset of every lane, as four lane values (row loads and a transpose: cheaper than
/// gathers). The 16 bytes must be readable.
inline void loadRows4(const float* base, std::uint32_t offset, float out[4]) {
    for (int k = 0; k < 4; ++k) out[k] = base[offset + std::uint32_t(k)];
}
[[gnu::always_inline]] inline void loadRows4(const float* base, const Lanes8u& offset, Lanes8f out[4]) {
    alignas(32) std::uint32_t o[8];
    store(o, offset);
    const auto row = [&](int a) {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(base + o[a])), _mm_loadu_ps(base + o[a + 4]), 1);
    };
    const __m256 r0 = row(0), r1 = row(1), r2 = row(2), r3 = row(3);
    const __m256 t0 = _mm256_unpacklo_ps(r0, r1), t1 = _mm256_unpackhi_ps(r0, r1);
    const __m256 t2 = _mm256_unpacklo_ps(r2, r3), t3 = _mm256_unpackhi_ps(r2, r3);
    out[0].v = detail::V8f(_mm256_shuffle_ps(t0, t2, 0x44));
    out[1].v = detail::V8f(_mm256_shuffle_ps(t0, t2, 0xEE));
    out[2].v = detail::V8f(_mm256_shuffle_ps(t1, t3, 0x44));
    out[3].v = detail::V8f(_mm256_shuffle_ps(t1, t3, 0xEE));
}

/// Four lane values as four consecutive floats at base + offset of every lane.
inline void scatterRows4(float* base, std::uint32_t offset, const float in[4]) {
    for (int k = 0; k < 4; ++k) base[offset + std::uint32_t(k)] = in[k];
}
[[gnu::always_inline]] inline void scatterRows4(float* base, const Lanes8u& offset, const Lanes8f in[4]) {
    alignas(32) std::uint32_t o[8];
    store(o, offset);
    const __m256 a = __m256(in[0].v), b = __m256(in[1].v), c = __m256(in[2].v), d = __m256(in[3].v);
    const __m256 t0 = _mm256_unpacklo_ps(a, b), t1 = _mm256_unpackhi_ps(a, b);
    const __m256 t2 = _mm256_unpacklo_ps(c, d), t3 = _mm256_unpackhi_ps(c, d);
    const auto rows = [&](int k, __m256 both) {
        _mm_storeu_ps(base + o[k], _mm256_castps256_ps128(both));
        _mm_storeu_ps(base + o[k + 4], _mm256_extractf128_ps(both, 1));
    };
    rows(0, _mm256_shuffle_ps(t0, t2, 0x44)), rows(1, _mm256_shuffle_ps(t0, t2, 0xEE));
    rows(2, _mm256_shuffle_ps(t1, t3, 0x44)), rows(3, _mm256_shuffle_ps(t1, t3, 0xEE));
}

namespace detail {
/// Rows become columns. Spelt out, as is what follows: arrays that a loop runs over stay in memory (GCC 12).
[[gnu::always_inline]] inline void transpose8(__m256& a, __m256& b, __m256& c, __m256& d, __m256& e, __m256& f,
                                              __m256& g, __m256& h) {
    const __m256 ab0 = _mm256_unpacklo_ps(a, b), ab1 = _mm256_unpackhi_ps(a, b);
    const __m256 cd0 = _mm256_unpacklo_ps(c, d), cd1 = _mm256_unpackhi_ps(c, d);
    const __m256 ef0 = _mm256_unpacklo_ps(e, f), ef1 = _mm256_unpackhi_ps(e, f);
    const __m256 gh0 = _mm256_unpacklo_ps(g, h), gh1 = _mm256_unpackhi_ps(g, h);
    const __m256 l0 = _mm256_shuffle_ps(ab0, cd0, 0x44), l1 = _mm256_shuffle_ps(ab0, cd0, 0xEE);
    const __m256 l2 = _mm256_shuffle_ps(ab1, cd1, 0x44), l3 = _mm256_shuffle_ps(ab1, cd1, 0xEE);
    const __m256 h0 = _mm256_shuffle_ps(ef0, gh0, 0x44), h1 = _mm256_shuffle_ps(ef0, gh0, 0xEE);
    const __m256 h2 = _mm256_shuffle_ps(ef1, gh1, 0x44), h3 = _mm256_shuffle_ps(ef1, gh1, 0xEE);
    a = _mm256_permute2f128_ps(l0, h0, 0x20), b = _mm256_permute2f128_ps(l1, h1, 0x20);
    c = _mm256_permute2f128_ps(l2, h2, 0x20), d = _mm256_permute2f128_ps(l3, h3, 0x20);
    e = _mm256_permute2f128_ps(l0, h0, 0x31), f = _mm256_permute2f128_ps(l1, h1, 0x31);
    g = _mm256_permute2f128_ps(l2, h2, 0x31), h = _mm256_permute2f128_ps(l3, h3, 0x31);
}
}  // namespace detail

/// Eight consecutive floats at base + offset of every lane, as eight lane values.
inline void loadRows8(const float* base, std::uint32_t offset, float out[8]) {
    for (int k = 0; k < 8; ++k) out[k] = base[offset + std::uint32_t(k)];
}
[[gnu::always_inline]] inline void loadRows8(const float* base, const Lanes8u& offset, Lanes8f out[8]) {
    alignas(32) std::uint32_t o[8];
    store(o, offset);
    const auto row = [&](int k) { return _mm256_loadu_ps(base + o[k]); };
    __m256 a = row(0), b = row(1), c = row(2), d = row(3), e = row(4), f = row(5), g = row(6), h = row(7);
    detail::transpose8(a, b, c, d, e, f, g, h);
    out[0].v = detail::V8f(a), out[1].v = detail::V8f(b), out[2].v = detail::V8f(c), out[3].v = detail::V8f(d);
    out[4].v = detail::V8f(e), out[5].v = detail::V8f(f), out[6].v = detail::V8f(g), out[7].v = detail::V8f(h);
}
namespace detail {
/// For each 8-bit mask, the permutation that moves its set lanes to the front, in order.
struct CompressTable {
    alignas(32) std::uint32_t index[256][8];
    constexpr CompressTable() : index{} {
        for (unsigned m = 0; m < 256; ++m) {
            unsigned n = 0;
            for (unsigned i = 0; i < 8; ++i)
                if (m >> i & 1u) index[m][n++] = i;
            while (n < 8) index[m][n++] = 0;
        }
    }
};
inline constexpr CompressTable kCompress{};
}  // namespace detail

/// The lanes of `keep`, each as a row of eight floats, `stride` floats apart from p on, packed. Room for all lanes must be
/// there (spare lanes leave junk behind the rows).
inline void storeRows8(float* p, std::uint32_t, const float in[8], unsigned keep) {
    if (keep)
        for (int k = 0; k < 8; ++k) p[k] = in[k];
}
[[gnu::always_inline]] inline void storeRows8(float* p, std::uint32_t stride, const Lanes8f in[8], unsigned keep) {
    // Packed before the transpose, which needs no branch: how many lanes go on is hard to predict.
    const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(detail::kCompress.index[keep]));
    const auto pack = [&](int i) { return _mm256_permutevar8x32_ps(__m256(in[i].v), order); };
    __m256 a = pack(0), b = pack(1), c = pack(2), d = pack(3), e = pack(4), f = pack(5), g = pack(6), h = pack(7);
    detail::transpose8(a, b, c, d, e, f, g, h);
    const auto row = [&](std::uint32_t k, __m256 r) { _mm256_storeu_ps(p + k * stride, r); };
    row(0, a), row(1, b), row(2, c), row(3, d), row(4, e), row(5, f), row(6, g), row(7, h);
}

/// Stores the lanes of `keep` packed at p and returns nothing; room for all lanes must be there (spare lanes hold junk).
inline void storePacked(float* p, float x, unsigned keep) { if (keep) *p = x; }
inline void storePacked(std::uint32_t* p, std::uint32_t x, unsigned keep) { if (keep) *p = x; }
inline void storePacked(float* p, Lanes8f x, unsigned keep) {
    const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(detail::kCompress.index[keep]));
    _mm256_storeu_ps(p, _mm256_permutevar8x32_ps(__m256(x.v), order));
}
inline void storePacked(std::uint32_t* p, Lanes8u x, unsigned keep) {
    const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(detail::kCompress.index[keep]));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm256_permutevar8x32_epi32(__m256i(x.v), order));
}

/// storePacked in 16 bits, for numbers below 2^16.
inline void storePackedIndices(std::uint16_t* p, std::uint32_t x, unsigned keep) { if (keep) *p = std::uint16_t(x); }
inline void storePackedIndices(std::uint16_t* p, Lanes8u x, unsigned keep) {
    const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(detail::kCompress.index[keep]));
    const __m256i packed = _mm256_permutevar8x32_epi32(__m256i(x.v), order);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p),
                     _mm_packus_epi32(_mm256_castsi256_si128(packed), _mm256_extracti128_si256(packed, 1)));
}

/// Table of eight entries looked up by the low three bits of each lane (one instruction when wide).
inline std::uint32_t lookup8(const std::uint32_t table[8], std::uint32_t i) { return table[i & 7u]; }
inline Lanes8u lookup8(const std::uint32_t table[8], Lanes8u i) {
    return Lanes8u(detail::V8u(_mm256_permutevar8x32_epi32(
        _mm256_loadu_si256(reinterpret_cast<const __m256i*>(table)), __m256i(i.v))));
}

}  // namespace penumbra
