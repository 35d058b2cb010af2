// Reading PLY meshes: ascii, binary little-endian and big-endian, plain or gzip.
//
// Taken: of element `vertex` x y z, nx ny nz, and the first complete pair of u v, s t, texture_u texture_v, texture_s
// texture_t; of element `face` the list `vertex_indices` (or `vertex_index`) and `face_indices`. Properties may have
// any scalar type and order, lists any integer type of length; all other elements and properties are skipped.
//
// Polygons: triangles are taken as they are; a quad a b c d becomes the triangles a b c and a c d (a b d and b c d
// where it is concave at b or d), which is the same surface where it is planar. pbrt takes a quad for a bilinear patch;
// what to do about those that are far from planar is up to dice() (patches.h). Uvs inside a quad that is planar, but no
// parallelogram, differ from pbrt's a little. Other polygons are skipped; one warning counts them.
//
// Hostile input: Error(BadData), "file:line: ..." in the header and "file: element entry: ..." behind it. Counts are
// checked against the size of the file before memory is taken for them, indices against the number of vertices. Numbers
// that are not finite are kept: dropBadTriangles() removes what they spoil.
#pragma once

#include "core/geometry/patches.h"

#include <string>
#include <string_view>

namespace penumbra {

/// Error(MissingInput) where the file cannot be opened.
PatchMesh readPly(const std::string& path, Warnings& warnings);

/// The same for a file that is in memory; `name` stands for its path in messages.
PatchMesh readPlyBytes(std::string_view bytes, const std::string& name, Warnings& warnings);

}  // namespace penumbra
