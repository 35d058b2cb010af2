// What benchmarks measure with: a clock, and the spread of repeated measurements.
//
// Thread safety: none needed.
#pragma once

#include <chrono>
#include <vector>

namespace penumbra {

/// What repeated measurements of one quantity gave.
struct Spread {
    double min = 0, median = 0, max = 0;
};
/// Of an even number of values the median is the mean of the middle two. REQUIRES: some values.
Spread spreadOf(std::vector<double> values);

/// Wall-clock seconds that a call takes.
template <class Work>
double secondsOf(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace penumbra
