#include "core/geometry/geometry.h"

#include "core/base/error.h"

namespace penumbra {
namespace {

/// Appends a per-vertex array of `width` floats; returns the shift from global vertex numbers to its rows.
std::uint32_t appendAttribute(std::vector<float>& all, std::vector<float>&& mesh, std::size_t width, std::size_t firstVertex) {
    if (mesh.empty()) return kNone;
    if (all.size() / width + 1 == firstVertex) all.resize(all.size() + width);  // a shift of -1 would be kNone
    const std::size_t row = all.size() / width;
    if (all.capacity() == 0) all = std::move(mesh);   // unless room for several meshes was made
    else all.insert(all.end(), mesh.begin(), mesh.end());
    mesh = {};
    return std::uint32_t(row) - std::uint32_t(firstVertex);
}

/// Lanes address words by 31-bit offsets (gathers are signed).
void checkSize(std::size_t words) {
    if (words > 0x7FFFFFF0u)
        throw Error(ErrorKind::OutOfMemory, "the scene has too many triangles, shapes or instances (over 2^31 words in one table)");
}

}  // namespace

ShapeRecord Geometry::addMesh(TriangleMesh&& mesh) {
    const std::size_t firstVertex = positions.size() / 3, firstTriangle = indices.size() / 3;
    checkSize(positions.size() + mesh.positions.size());
    checkSize(indices.size() + mesh.indices.size());
    ShapeRecord r;
    r.kind = ShapeKind::Mesh;
    r.first = std::uint32_t(firstTriangle);
    r.count = std::uint32_t(mesh.indices.size() / 3);
    r.normalShift = appendAttribute(normals, std::move(mesh.normals), 3, firstVertex);
    r.uvShift = appendAttribute(uvs, std::move(mesh.uvs), 2, firstVertex);
    r.tangentShift = appendAttribute(tangents, std::move(mesh.tangents), 3, firstVertex);
    if (firstVertex)
        for (std::uint32_t& i : mesh.indices) i += std::uint32_t(firstVertex);
    if (indices.capacity() == 0) indices = std::move(mesh.indices);
    else indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
    mesh.indices = {};
    if (positions.capacity() == 0) positions = std::move(mesh.positions);
    else positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    mesh.positions = {};
    return r;
}

ShapeRecord Geometry::addQuadric(const QuadricRecord& q) {
    ShapeRecord r;
    r.kind = q.kind;
    r.first = std::uint32_t(quadrics.size());
    r.count = 1;
    quadrics.push_back(q);
    return r;
}

void Geometry::finish() {
    checkSize(shapes.size() * sizeof(ShapeRecord) / 4);
    checkSize(quadrics.size() * sizeof(QuadricRecord) / 4);
    checkSize(instances.size() * sizeof(InstanceRecord) / 4);
    checkSize(matrices.size() * sizeof(AffineRecord) / 4);
    // Row loads read 16 bytes from the start of any row.
    for (std::vector<float>* v : {&positions, &normals, &uvs, &tangents}) {
        v->reserve(v->size() + kSpareFloats);
        v->insert(v->end(), kSpareFloats, 0.f);
        v->resize(v->size() - kSpareFloats);
    }
    indices.reserve(indices.size() + kSpareFloats);
    indices.insert(indices.end(), kSpareFloats, 0u);
    indices.resize(indices.size() - kSpareFloats);
}

std::size_t Geometry::memoryBytes() const {
    return (positions.capacity() + normals.capacity() + uvs.capacity() + tangents.capacity() + indices.capacity()) * 4 +
           shapes.capacity() * sizeof(ShapeRecord) + quadrics.capacity() * sizeof(QuadricRecord) +
           instances.capacity() * sizeof(InstanceRecord) + matrices.capacity() * sizeof(AffineRecord);
}

}  // namespace penumbra
