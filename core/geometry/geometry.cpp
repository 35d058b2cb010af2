#include "core/geometry/geometry.h"

#include "core/base/error.h"

namespace penumbra {
namespace {

/// Moves, unless room for several was made.
template <class T>
void appendTo(std::vector<T>& all, std::vector<T>&& part) {
    if (all.capacity() == 0)
        all = std::move(part);
    else
        all.insert(all.end(), part.begin(), part.end());
    part = {};
}

/// Appends a per-vertex array of `width` floats; returns the shift from global vertex numbers to its rows.
std::uint32_t appendAttribute(std::vector<float>& all, std::vector<float>&& mesh, std::size_t width, std::size_t firstVertex) {
    if (mesh.empty()) return kNone;
    if (all.size() / width + 1 == firstVertex) all.resize(all.size() + width);  // a shift of -1 would be kNone
    const std::size_t row = all.size() / width;
    appendTo(all, std::move(mesh));
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
    appendTo(indices, std::move(mesh.indices));
    appendTo(positions, std::move(mesh.positions));
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

ShapeRecord Geometry::addCurves(CurveSet&& curves) {
    const std::size_t firstVertex = curveVertices.size() / 4;
    checkSize(curveVertices.size() + curves.vertices.size());
    ShapeRecord r;
    r.kind = ShapeKind::Curves;
    r.first = std::uint32_t(curveIndices.size());
    r.count = std::uint32_t(curves.indices.size());
    r.flags = (curves.spline ? kShapeCurveSpline : 0u) | (curves.normals.empty() ? 0u : kShapeCurveRibbon) |
              curves.level << kShapeCurveLevelShift;
    if (!curves.normals.empty()) {
        curveNormals.resize(3 * firstVertex);
        curveNormals.insert(curveNormals.end(), curves.normals.begin(), curves.normals.end());
    }
    if (firstVertex)
        for (std::uint32_t& i : curves.indices)
            i += std::uint32_t(firstVertex);
    appendTo(curveIndices, std::move(curves.indices));
    appendTo(curveVertices, std::move(curves.vertices));
    curves = {};
    return r;
}

void Geometry::finish() {
    checkSize(shapes.size() * sizeof(ShapeRecord) / 4);
    checkSize(quadrics.size() * sizeof(QuadricRecord) / 4);
    checkSize(instances.size() * sizeof(InstanceRecord) / 4);
    checkSize(matrices.size() * sizeof(AffineRecord) / 4);
    // Row loads read 16 bytes from the start of any row.
    for (std::vector<float>* v : {&positions, &normals, &uvs, &tangents, &curveNormals}) {
        v->reserve(v->size() + kSpareFloats);
        v->insert(v->end(), kSpareFloats, 0.f);
        v->resize(v->size() - kSpareFloats);
    }
    indices.reserve(indices.size() + kSpareFloats);
    indices.insert(indices.end(), kSpareFloats, 0u);
    indices.resize(indices.size() - kSpareFloats);
}

std::size_t Geometry::memoryBytes() const {
    return (positions.capacity() + normals.capacity() + uvs.capacity() + tangents.capacity() + indices.capacity() +
            curveVertices.capacity() + curveNormals.capacity() + curveIndices.capacity()) *
               4 +
           shapes.capacity() * sizeof(ShapeRecord) + quadrics.capacity() * sizeof(QuadricRecord) +
           instances.capacity() * sizeof(InstanceRecord) + matrices.capacity() * sizeof(AffineRecord);
}

}  // namespace penumbra
