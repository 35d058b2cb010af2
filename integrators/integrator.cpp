#include "integrators/path_batch.h"

#include <algorithm>

namespace penumbra {

void RenderCounts::add(const RenderCounts& o) {
    paths += o.paths;
    rays += o.rays;
    shadowRays += o.shadowRays;
    groups += o.groups;
    liveLanes += o.liveLanes;
    clamped.add(o.clamped);
    const std::uint64_t total = invalid + o.invalid;
    for (const InvalidSample& s : o.firstInvalid) addInvalid(s);
    invalid = total;
}

void RenderCounts::addInvalid(InvalidSample s) {
    ++invalid;
    const auto before = [](const InvalidSample& a, const InvalidSample& b) {
        return a.pixel != b.pixel ? a.pixel < b.pixel : a.sample < b.sample;
    };
    firstInvalid.insert(std::upper_bound(firstInvalid.begin(), firstInvalid.end(), s, before), s);
    if (firstInvalid.size() > kMostInvalid) firstInvalid.pop_back();
}

PathBatch& threadBatch() {
    thread_local const std::unique_ptr<PathBatch> batch = std::make_unique<PathBatch>();
    return *batch;
}

}  // namespace penumbra
