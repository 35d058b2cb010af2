#include "scenes/builder/world.h"

#include <algorithm>
#include <bit>

namespace penumbra::builder {
namespace {

/// The motion of a part that moves within something that is placed or moves itself.
std::vector<Matrix4> composed(const TransformPair& outer, const TransformPair& inner) {
    if (outer.animated() && inner.animated()) return motionMatrices(outer.start * inner.start, outer.end * inner.end);
    std::vector<Matrix4> motion =
        outer.animated() ? motionMatrices(outer.start, outer.end) : motionMatrices(inner.start, inner.end);
    for (Matrix4& m : motion)
        m = outer.animated() ? m * inner.start : outer.start * m;
    return motion;
}

std::map<std::string, std::size_t, std::less<>> objectNames(const SceneDescription& description) {
    std::map<std::string, std::size_t, std::less<>> names;
    for (std::size_t i = 0; i < description.objects.size(); ++i)
        names[description.objects[i].name] = i;
    return names;
}

/// Whether nothing but their points tells the two sets of curves apart.
bool areAlike(const BuiltShape& a, const BuiltShape& b) {
    using Words = std::array<std::uint32_t, sizeof(ShapeRecord) / 4>;
    return a.record.kind == ShapeKind::Curves && std::bit_cast<Words>(a.record) == std::bit_cast<Words>(b.record) &&
           a.material.handle.tag == b.material.handle.tag && a.material.handle.row == b.material.handle.row &&
           a.curves.spline == b.curves.spline && a.curves.level == b.curves.level &&
           a.curves.normals.empty() == b.curves.normals.empty();
}

/// Curves join the last ones like them, if they are not too far back.
void addShape(std::vector<BuiltShape>& shapes, BuiltShape&& built) {
    constexpr std::ptrdiff_t kFarthest = 64;
    if (built.record.kind == ShapeKind::Curves) {
        const auto end = shapes.rbegin() + std::min(kFarthest, shapes.rend() - shapes.rbegin());
        const auto like = std::find_if(shapes.rbegin(), end, [&](const BuiltShape& s) { return areAlike(s, built); });
        if (like != end) return like->curves.append(built.curves);
    }
    shapes.push_back(std::move(built));
}

bool isSkewedCurve(const ShapeEntity& shape) {
    return shape.type == "curve" && !isSimilarity(shape.objectToWorld.start);
}

}  // namespace

void WorldBuilder::add(SceneDescription& description) {
    SkewedGroups skewed;
    for (ShapeEntity& shape : description.shapes) {
        const TransformPair place = shape.objectToWorld;
        const SourcePosition where = shape.where;
        if (place.animated()) {
            const std::size_t group = addMovingGroup(std::move(shape));
            addInstance(group, motionMatrices(place.start, place.end), where);
        } else if (isSkewedCurve(shape)) {
            if (addSkewedCurve(std::move(shape), skewed)) addInstance(groups_.size() - 1, {place.start}, where);
        } else if (std::optional<BuiltShape> built = shapes_.build(std::move(shape), {place.start, true})) {
            addShape(groups_[0].shapes, std::move(*built));
        }
    }
    description.shapes = {};

    const auto names = objectNames(description);
    std::map<std::size_t, Object> objects;  // only of those that are used
    for (const ObjectInstance& instance : description.instances) {
        const auto found = names.find(instance.name);
        if (found == names.end()) {
            std::vector<std::string> known;
            for (const auto& entry : names)
                known.push_back(entry.first);
            context_.fail(instance.where, "unknown object " + quote(instance.name) + suggestion(instance.name, known));
        }
        const auto [place, isNew] = objects.try_emplace(found->second);
        if (isNew) place->second = addObject(description.objects[found->second]);
        const TransformPair& to = instance.instanceToWorld;
        addInstance(place->second.still, motionMatrices(to.start, to.end), instance.where);
        for (const MovingPart& part : place->second.moving)
            addInstance(part.group, composed(to, part.motion), instance.where);
    }
    description.objects = {};
}

std::size_t WorldBuilder::addGroup(std::vector<BuiltShape> shapes) {
    if (shapes.empty()) return 0;
    groups_.push_back({std::move(shapes)});
    return groups_.size() - 1;
}

/// The shape stays in its object space, where what mirrors it is the motion.
std::size_t WorldBuilder::addMovingGroup(ShapeEntity&& shape) {
    std::vector<BuiltShape> shapes;
    if (std::optional<BuiltShape> built = shapes_.build(std::move(shape), {Matrix4{}, false}))
        shapes.push_back(std::move(*built));
    return addGroup(std::move(shapes));
}

/// The curve stays in its object space, in the group of those under its matrix. True where that is a new group, the
/// last.
bool WorldBuilder::addSkewedCurve(ShapeEntity&& shape, SkewedGroups& groups) {
    const Matrix4 matrix = shape.objectToWorld.start;
    std::optional<BuiltShape> built = shapes_.build(std::move(shape), {Matrix4{}, false, determinant3(matrix) < 0});
    if (!built) return false;
    const auto [group, isNew] = groups.try_emplace(std::bit_cast<std::array<double, 16>>(matrix.m), groups_.size());
    if (isNew) groups_.emplace_back();
    addShape(groups_[group->second].shapes, std::move(*built));
    return isNew;
}

WorldBuilder::Object WorldBuilder::addObject(ObjectDefinition& definition) {
    Object object;
    std::vector<BuiltShape> still;
    SkewedGroups skewed;
    for (ShapeEntity& shape : definition.shapes) {
        const TransformPair place = shape.objectToWorld;
        if (place.animated()) {
            if (const std::size_t group = addMovingGroup(std::move(shape))) object.moving.push_back({group, place});
        } else if (isSkewedCurve(shape)) {
            if (addSkewedCurve(std::move(shape), skewed)) object.moving.push_back({groups_.size() - 1, place});
        } else if (std::optional<BuiltShape> built = shapes_.build(std::move(shape), {place.start, false})) {
            addShape(still, std::move(*built));
        }
    }
    object.still = addGroup(std::move(still));
    return object;
}

void WorldBuilder::addInstance(std::size_t group, const std::vector<Matrix4>& motion, SourcePosition where) {
    if (group == 0) return;  // nothing to be seen
    InstanceRecord record;
    record.group = std::uint32_t(group);
    record.firstMatrix = std::uint32_t(scene_.geometry.matrices.size());
    record.segments = std::uint32_t(motion.size() - 1);
    std::vector<AffineRecord> matrices;
    for (const Matrix4& m : motion) {
        matrices.push_back(toRecord(m));
        if (!isUsable(matrices.back()))
            return context_.warn(where, "what is placed here is too large or too small to be seen, and left out");
    }
    scene_.geometry.matrices.insert(scene_.geometry.matrices.end(), matrices.begin(), matrices.end());
    scene_.geometry.instances.push_back(record);
    scene_.hasMotion = scene_.hasMotion || record.segments > 0;
}

void WorldBuilder::finish() {
    Geometry& g = scene_.geometry;
    scene_.materials.finish();
    reserveTables();
    g.groups.assign(groups_.size(), {});
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        g.groups[i] = {std::uint32_t(g.shapes.size()), std::uint32_t(groups_[i].shapes.size())};
        for (BuiltShape& shape : groups_[i].shapes)
            append(shape);
        groups_[i] = {};
    }
    for (InstanceRecord& instance : g.instances)
        instance.firstShape = g.groups[instance.group].firstShape;
    g.finish();
    scene_.facts.shapes = g.shapes.size();
    scene_.facts.instances = g.instances.size();
    scene_.facts.triangles = g.indices.size() / 3;
    scene_.facts.droppedTriangles = shapes_.counts().droppedTriangles;
    scene_.facts.geometryBytes = g.memoryBytes();
}

/// One mesh alone is moved as it is; several are copied one by one into tables that never grow.
void WorldBuilder::reserveTables() {
    Geometry& g = scene_.geometry;
    std::size_t meshes = 0, shapes = 0, quadrics = 0, positions = 0, normals = 0, uvs = 0, tangents = 0, indices = 0;
    for (const Group& group : groups_)
        for (const BuiltShape& shape : group.shapes) {
            ++shapes;
            if (shape.record.kind != ShapeKind::Mesh) {
                quadrics += shape.record.kind != ShapeKind::Curves;
                continue;
            }
            ++meshes;
            positions += shape.mesh.positions.size();
            normals += shape.mesh.normals.size();
            uvs += shape.mesh.uvs.size();
            tangents += shape.mesh.tangents.size();
            indices += shape.mesh.indices.size();
        }
    g.shapes.reserve(shapes);
    g.quadrics.reserve(quadrics);
    if (meshes < 2) return;
    const auto reserve = [](auto& table, std::size_t count) {
        if (count > 0) table.reserve(count + kSpareFloats);
    };
    reserve(g.positions, positions);
    reserve(g.normals, normals);
    reserve(g.uvs, uvs);
    reserve(g.tangents, tangents);
    reserve(g.indices, indices);
}

void WorldBuilder::append(BuiltShape& shape) {
    Geometry& g = scene_.geometry;
    const bool isMesh = shape.record.kind == ShapeKind::Mesh;
    ShapeRecord record = isMesh                                   ? g.addMesh(std::move(shape.mesh))
                         : shape.record.kind == ShapeKind::Curves ? g.addCurves(std::move(shape.curves))
                                                                  : g.addQuadric(shape.quadric);
    record.flags |= shape.record.flags;
    record.alpha = shape.record.alpha;
    record.alphaTexture = shape.record.alphaTexture;
    record.mediumInside = shape.record.mediumInside;
    record.mediumOutside = shape.record.mediumOutside;
    record.material = scene_.materials.id(shape.material.handle);
    if (shape.emission) {
        if (isMesh)
            addMeshLights(*shape.emission, g, shape.faceOfTriangle, scene_.lights, record);
        else
            addQuadricLight(*shape.emission, shape.quadric, shape.groupFromObject, scene_.lights, record);
        if (record.isMasked() && !(record.flags & kShapeInvisible))
            scene_.lightMasks.add(record.light, scene_.lights.size() - record.light, std::uint32_t(g.shapes.size()));
    }
    g.shapes.push_back(record);
}

}  // namespace penumbra::builder
