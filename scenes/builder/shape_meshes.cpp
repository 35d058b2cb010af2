#include "scenes/builder/shape_meshes.h"

namespace penumbra::builder {

MeshArrays takeMeshArrays(ParameterSet& p) {
    using Floats = std::vector<float>;
    using Integers = std::vector<std::int32_t>;
    return {takeList<Floats>(p, "point3", "P"),          takeList<Floats>(p, "normal", "N"),
            takeList<Floats>(p, "vector3", "S"),         takeList<Floats>(p, "point2", "uv"),
            takeList<Integers>(p, "integer", "indices"), takeList<Integers>(p, "integer", "faceIndices")};
}

TriangleMesh meshFromPatches(MeshArrays arrays, const std::string& where, Warnings& warnings) {
    if (arrays.indices.empty() && arrays.P.size() == 12) arrays.indices = {0, 1, 2, 3};
    if (arrays.indices.empty())
        throw Error(ErrorKind::BadData, where + ": \"indices\" are missing; they may be only with 4 points");
    if (const std::size_t surplus = arrays.indices.size() % 4) {
        warnings.add(where + ": the number of \"indices\" is not a multiple of 4; the last " + std::to_string(surplus) +
                     " are ignored");
        arrays.indices.resize(arrays.indices.size() - surplus);
    }
    // A patch alone has its own parameters as uv.
    if (arrays.uv.empty() && arrays.P.size() == 12 && arrays.indices == std::vector<std::int32_t>{0, 1, 2, 3})
        arrays.uv = {0, 0, 1, 0, 0, 1, 1, 1};
    std::vector<std::int32_t> triangles;
    triangles.reserve(arrays.indices.size() / 4 * 6);
    for (std::size_t i = 0; i < arrays.indices.size(); i += 4) {
        const std::int32_t p00 = arrays.indices[i], p10 = arrays.indices[i + 1], p01 = arrays.indices[i + 2],
                           p11 = arrays.indices[i + 3];
        triangles.insert(triangles.end(), {p00, p10, p11, p00, p11, p01});
    }
    arrays.indices = std::move(triangles);
    arrays.faceIndices = {};
    return meshFromArrays(std::move(arrays), where, warnings);
}

}  // namespace penumbra::builder
