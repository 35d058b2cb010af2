// MeshFacts: what a mesh of a scene file is as a surface, for people who made it (`penumbra info`).
//
// Thread safety: plain values.
#pragma once

#include "core/geometry/mesh_topology.h"

#include <string>

namespace penumbra {

struct MeshFacts {
    std::string where, type;   ///< "file:line:column" of the shape
    MeshTopology topology;     ///< as the file has it, but vertices of equal coordinates are one: seams of uv are no borders
};

}  // namespace penumbra
