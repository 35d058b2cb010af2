// Parts of shapes.cpp: arrays of meshes out of parameters.
#pragma once

#include "scenes/builder/context.h"

#include "core/geometry/mesh.h"
#include "core/geometry/ply.h"

namespace penumbra::builder {

/// Moves a list of values out of a directive's parameters; empty where it is absent.
template <class List>
List takeList(ParameterSet& parameters, const char* type, const char* name) {
    const Parameter* found = parameters.find(type, name);
    if (!found) return {};
    for (Parameter& p : parameters.all())
        if (&p == found) return std::move(std::get<List>(p.values));
    return {};
}

/// Moves the arrays of a mesh out of its directive's parameters.
MeshArrays takeMeshArrays(ParameterSet& parameters);

/// The mesh of a bilinearmesh, whose indices are p00 p10 p01 p11 of each patch. Errors as meshFromArrays has them.
PatchMesh meshFromPatches(MeshArrays arrays, const std::string& where, Warnings& warnings);

}  // namespace penumbra::builder
