// Accelerator: what finds the hits of rays in a Geometry: Embree's acceleration structures, or a list of the faces where the
// scene is small (face_list.h). With accelerator.cpp the only file that knows Embree, in version 3.13 or 4.
//
// Rays are given eight at a time (ray_packet.h), with a bit mask of the live lanes. Rays must be finite: Debian's Embree is
// built with assertions and aborts on NaN. Hits of instances carry the instance's row, others kNoHit; dead lanes keep what
// was in them. Results of one ray do not depend on the other lanes.
// Thread safety: intersect and occluded may run on any number of threads. The thread count of the build is that of TBB.
#pragma once

#include "core/geometry/geometry.h"
#include "core/geometry/ray_packet.h"

#include <memory>
#include <string>

namespace penumbra {

class Textures;

enum class IntersectionMode {
    Robust,   ///< watertight (the default): small scenes by FaceList, others by Embree's robust mode
    Embree,   ///< Embree's robust mode whatever the scene's size
    Fast      ///< Embree's other mode: 10 to 28 % faster; about one ray in a million slips through an edge
};

/// What the caller knows of the rays of a packet. For speed; results are the same in Robust mode. In Fast mode a few hits at
/// edges differ, so a ray that is traced again needs the same flag to be the same ray.
enum class Coherence { Incoherent, Coherent };

struct SceneBounds {
    Vec3<float> lower, upper;   ///< lower > upper where the scene is empty
};

class Accelerator {
public:
    Accelerator();
    /// Builds. `geometry`'s tables and `textures` (null where no alpha is a texture) must outlive this and not change; they may
    /// be moved. Throws Error(OutOfMemory or Internal).
    Accelerator(const Geometry& geometry, IntersectionMode mode, const Textures* textures = nullptr);
    ~Accelerator();
    Accelerator(Accelerator&&) noexcept;
    Accelerator& operator=(Accelerator&&) noexcept;

    void intersect(RayHitPacket& rays, unsigned live, Coherence coherence = Coherence::Incoherent) const noexcept;
    /// Sets far to -infinity where something lies between near and far.
    void occluded(RayPacket& rays, unsigned live) const noexcept;
    bool hasFaceList() const;
    /// One by one through Embree's single-ray calls: for ray_roof's comparison only; bits may differ from the packets'.
    void intersectSingly(RayHitPacket& rays, unsigned live) const noexcept;
    void occludedSingly(RayPacket& rays, unsigned live) const noexcept;

    SceneBounds bounds() const;
    /// "Embree 3.13.5", as the library says at run time.
    static std::string libraryVersion();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace penumbra
