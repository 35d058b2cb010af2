#include "core/film/exact_sum.h"

#include <cmath>

namespace penumbra {

double fromFixed(__int128 x) {
    const bool negative = x < 0;
    const unsigned __int128 m = negative ? -static_cast<unsigned __int128>(x) : static_cast<unsigned __int128>(x);
    const double magnitude = double(std::uint64_t(m >> 64)) + std::ldexp(double(std::uint64_t(m)), -64);
    return negative ? -magnitude : magnitude;
}

}  // namespace penumbra
