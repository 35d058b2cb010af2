// Parts of shapes.cpp: arrays of meshes out of parameters.
#pragma once

#include "scenes/builder/context.h"

#include "core/geometry/mesh.h"
#include "core/geometry/ply.h"

namespace penumbra::builder {

/// Moves the arrays of a mesh out of its directive's parameters.
MeshArrays takeMeshArrays(ParameterSet& parameters);

/// The mesh of a bilinearmesh, each patch (p00 p10 p01 p11) as two triangles. Errors as meshFromArrays has them.
TriangleMesh meshFromPatches(MeshArrays arrays, const std::string& where, Warnings& warnings);

}  // namespace penumbra::builder
