// What the benchmark programs print: lines for people, and one JSON object for programs.
//
// The JSON carries "schema", which grows by one when a field changes its meaning or goes away; docs/BENCHMARKS.md
// lists the fields.
//
// Thread safety: pure functions.
#pragma once

#include "bench/lab/ray_roof.h"
#include "bench/lab/render_benchmark.h"

#include <string>

namespace penumbra {

inline constexpr int kBenchmarkSchema = 1;

/// Each line ends in a line feed, the JSON too.
std::string renderBenchmarkText(const RenderBenchmark& result, const RenderJob& job);
std::string renderBenchmarkJson(const RenderBenchmark& result, const RenderJob& job);
std::string rayRoofText(const RayRoof& result, const RenderJob& job);
std::string rayRoofJson(const RayRoof& result, const RenderJob& job);

}  // namespace penumbra
