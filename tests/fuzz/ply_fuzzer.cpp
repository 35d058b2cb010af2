// Fuzz target: the PLY reader, plain and gzip, and what the builder does with the mesh first.

#include "core/geometry/ply.h"
#include "tests/fuzz/property.h"

#include <string>

namespace penumbra {
namespace {

void requireSound(const TriangleMesh& mesh) {
    const std::size_t vertices = mesh.vertexCount();
    fuzz::require(mesh.indices.size() % 3 == 0, "triangles have three corners");
    fuzz::require(std::all_of(mesh.indices.begin(), mesh.indices.end(), [&](auto i) { return i < vertices; }),
                  "every index has its vertex");
    fuzz::require(mesh.normals.empty() || mesh.normals.size() == 3 * vertices, "each vertex has its normal");
    fuzz::require(mesh.uvs.empty() || mesh.uvs.size() == 2 * vertices, "each vertex has its uv");
    fuzz::require(mesh.faceIndices.empty() || mesh.faceIndices.size() == mesh.triangleCount(), "triangles have numbers");
}

void readMesh(const std::string& bytes, Warnings& warnings) {
    PatchMesh patches = readPlyBytes(bytes, "fuzz.ply", warnings);
    requireSound(patches.mesh);
    // A byte of a file is worth 100 when it is compressed, and a quad of five bytes is six indices of four.
    fuzz::require(patches.mesh.positions.size() + patches.mesh.indices.size() <=
                      (std::size_t{64} << 20) + 2000 * bytes.size(),
                  "a mesh is not larger than its file can say");
    DiceOptions options;
    options.needsUv = options.polygons = options.numbersFaces = true;
    options.mostTriangles = 4096;
    const std::size_t most = std::max(options.mostTriangles, patches.mesh.triangleCount());
    TriangleMesh mesh = dice(std::move(patches), options);
    requireSound(mesh);
    fuzz::require(mesh.triangleCount() <= most, "no more triangles than allowed");
    dropBadTriangles(mesh);
    bounds(mesh);
}

}  // namespace
}  // namespace penumbra

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    using namespace penumbra;
    return fuzz::execute([&](Warnings& warnings) { readMesh(std::string(reinterpret_cast<const char*>(data), size), warnings); });
}
