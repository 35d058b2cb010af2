#include "scenes/builder/shape_meshes.h"

namespace penumbra::builder {

MeshArrays takeMeshArrays(ParameterSet& p) {
    using Floats = std::vector<float>;
    using Integers = std::vector<std::int32_t>;
    return {takeList<Floats>(p, "point3", "P"),          takeList<Floats>(p, "normal", "N"),
            takeList<Floats>(p, "vector3", "S"),         takeList<Floats>(p, "point2", "uv"),
            takeList<Integers>(p, "integer", "indices"), takeList<Integers>(p, "integer", "faceIndices")};
}

PatchMesh meshFromPatches(MeshArrays arrays, const std::string& where, Warnings& warnings) {
    if (arrays.indices.empty() && arrays.P.size() == 12) arrays.indices = {0, 1, 2, 3};
    if (arrays.indices.size() < 4)
        throw Error(ErrorKind::BadData, where + ": \"indices\" are missing, 4 a patch; they may be only with 4 points");
    if (const std::size_t surplus = arrays.indices.size() % 4) {
        warnings.add(where + ": the number of \"indices\" is not a multiple of 4; the last " + std::to_string(surplus) +
                     " are ignored");
        arrays.indices.resize(arrays.indices.size() - surplus);
    }
    const std::size_t points = arrays.P.size() / 3;
    for (std::size_t i = 0; i < arrays.indices.size(); ++i)
        if (arrays.indices[i] < 0 || std::size_t(arrays.indices[i]) >= points)
            throw Error(ErrorKind::BadData, where + ": \"indices\"[" + std::to_string(i) + "] is " +
                                                std::to_string(arrays.indices[i]) + ", but there are " +
                                                std::to_string(points) + " points");
    std::vector<std::int32_t> triangles;
    triangles.reserve(arrays.indices.size() / 4 * 6);
    PatchMesh patches;
    patches.quads.reserve(arrays.indices.size() / 4);
    for (std::size_t i = 0; i < arrays.indices.size(); i += 4) {
        const std::int32_t p00 = arrays.indices[i], p10 = arrays.indices[i + 1], p01 = arrays.indices[i + 2],
                           p11 = arrays.indices[i + 3];
        patches.quads.push_back(std::uint32_t(triangles.size() / 3));
        triangles.insert(triangles.end(), {p00, p10, p11, p00, p11, p01});
    }
    arrays.indices = std::move(triangles);
    arrays.faceIndices = {};
    patches.mesh = meshFromArrays(std::move(arrays), where, warnings);
    return patches;
}

}  // namespace penumbra::builder
