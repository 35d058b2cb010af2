// Shapes: from a Shape directive to a mesh, quadric or curves in the space of its group.
#pragma once

#include "scenes/builder/lights.h"
#include "scenes/builder/materials.h"
#include "scenes/builder/media.h"

#include "core/geometry/geometry.h"
#include "core/geometry/patches.h"
#include "scenes/mesh_facts.h"

namespace penumbra::builder {

/// A shape that is ready for the geometry's tables.
struct BuiltShape {
    ShapeRecord record;  ///< kind, flags and media; the rest is filled in by the geometry's tables
    SceneMaterial material;
    TriangleMesh mesh;  ///< where record.kind is Mesh
    std::vector<std::int32_t> faceOfTriangle;  ///< of lights that ask for it; empty: each is a face of its own
    QuadricRecord quadric;
    CurveSet curves;
    Matrix4 groupFromObject;
    std::optional<AreaEmission> emission;
};

/// Where a shape stands.
struct ShapePlace {
    Matrix4 groupFromObject;
    bool mayShine = true;       ///< it stands still in the world: neither moving nor in an object
    bool mirrorsGroup = false;  ///< the shape's own matrix is that of its group's instances, and mirrors
};

struct ShapeCounts {
    std::size_t droppedTriangles = 0;
};

/// Thread safety: none; one instance belongs to one build.
class ShapeBuilder {
public:
    /// All must outlive this object. `showsUv`: uv are wanted for themselves, whatever materials look at. `meshFacts`: null,
    /// or what gets an entry for every mesh.
    ShapeBuilder(BuildContext& context, TextureLibrary& textures, MaterialLibrary& materials, MediumLibrary& media,
                 AreaLightLibrary& lights, bool showsUv, std::vector<MeshFacts>* meshFacts)
        : context_(context),
          textures_(textures),
          materials_(materials),
          media_(media),
          lights_(lights),
          showsUv_(showsUv),
          meshFacts_(meshFacts) {}

    /// Takes the directive apart. Nothing where nothing of it can be seen.
    std::optional<BuiltShape> build(ShapeEntity&& shape, const ShapePlace& place);
    const ShapeCounts& counts() const { return counts_; }

private:
    /// Fails where nobody knows the type.
    void checkType(const ShapeEntity& shape) const;
    bool buildCurves(ShapeEntity& shape, const ShapePlace& place, BuiltShape& out);
    bool buildMesh(ShapeEntity& shape, const ShapePlace& place, BuiltShape& out);
    bool buildQuadric(const ShapeEntity& shape, const ShapePlace& place, BuiltShape& out);
    PatchMesh readMesh(ShapeEntity& shape);
    PatchMesh readPlyMesh(const ShapeEntity& shape);
    QuadricRecord readSphere(const ShapeEntity& shape);
    QuadricRecord readDisk(const ShapeEntity& shape);
    QuadricRecord readCylinder(const ShapeEntity& shape);
    void readAlpha(const ShapeEntity& shape, ShapeRecord& record);
    void readEmission(const ShapeEntity& shape, const ShapePlace& place, BuiltShape& out);
    void readMedia(const ShapeEntity& shape, BuiltShape& out);

    BuildContext& context_;
    TextureLibrary& textures_;
    MaterialLibrary& materials_;
    MediumLibrary& media_;
    AreaLightLibrary& lights_;
    const bool showsUv_;
    std::vector<MeshFacts>* meshFacts_;
    ShapeCounts counts_;
    std::size_t roomForDiced_ = std::size_t(1) << 23;  ///< triangles of patches, in the whole scene
};

/// Whether rays can be taken through the matrix and back in float: it has an inverse, and all is far from overflow.
bool isUsable(const AffineRecord& m);

}  // namespace penumbra::builder
