// World: all shapes of a scene, those of objects and moving ones included, into the tables of the geometry.
//
// What stands still in the world is baked into group 0. An object becomes a group of the shapes that stand still in it;
// a moving shape, of the world or of an object, is a group of its own. Groups are placed by instances, one level deep,
// so an instance of a moving shape of an object carries the product of both motions.
//
// Curves join others like them, for a scene may have a million of one strand each. They keep a round section in their
// own space alone: where their matrix changes angles, all curves under it are a group, placed by an instance.
//
// Memory: shapes are gathered first, so that the tables are made once, at their size; a mesh is freed as it is
// appended.
//
// Thread safety: none; one instance belongs to one build.
#pragma once

#include "scenes/builder/shapes.h"

#include <array>
#include <map>

namespace penumbra::builder {

class WorldBuilder {
public:
    /// All must outlive this object.
    WorldBuilder(BuildContext& context, ShapeBuilder& shapes, Scene& scene)
        : context_(context), shapes_(shapes), scene_(scene) {}

    /// Takes the shapes out of the description. REQUIRES: called once.
    void add(SceneDescription& description);
    /// Fills the tables of geometry and area lights. REQUIRES: all materials of the scene are made.
    void finish();

private:
    struct Group {
        std::vector<BuiltShape> shapes;
    };
    /// A moving shape of an object, or its skewed curves: their group and its own place.
    struct MovingPart {
        std::size_t group = 0;
        TransformPair motion;
    };
    /// Groups by the matrix that places them, row by row.
    using SkewedGroups = std::map<std::array<double, 16>, std::size_t>;
    struct Object {
        std::size_t still = 0;  ///< group; 0: none
        std::vector<MovingPart> moving;
    };

    std::size_t addGroup(std::vector<BuiltShape> shapes);
    std::size_t addMovingGroup(ShapeEntity&& shape);
    bool addSkewedCurve(ShapeEntity&& shape, SkewedGroups& groups);
    Object addObject(ObjectDefinition& definition);
    void addInstance(std::size_t group, const std::vector<Matrix4>& motion, SourcePosition where);
    void reserveTables();
    void append(BuiltShape& shape);

    BuildContext& context_;
    ShapeBuilder& shapes_;
    Scene& scene_;
    std::vector<Group> groups_ = std::vector<Group>(1);
};

}  // namespace penumbra::builder
