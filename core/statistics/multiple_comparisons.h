// Many tests at once: p-values adjusted so that the chance of even one false alarm in the family stays below alpha.
//
// Conventions: test i is rejected where its adjusted p-value is <= alpha.
//
// Thread safety: pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace penumbra {

/// Holm's step-down adjustment (Holm 1979): valid whatever the dependence between the tests, never weaker than
/// Bonferroni.
std::vector<double> holmAdjusted(std::span<const double> pValues);

/// The level for each of `tests` independent tests that gives the family the level `alpha` (Sidak 1967).
double sidakLevel(double alpha, std::size_t tests);

}  // namespace penumbra
