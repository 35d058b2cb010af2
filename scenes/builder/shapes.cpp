#include "scenes/builder/shapes.h"

#include "scenes/builder/shape_curves.h"
#include "scenes/builder/shape_meshes.h"

#include "core/geometry/subdivision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace penumbra::builder {
namespace {

const std::vector<std::string>& knownShapes() {
    static const std::vector<std::string> known{"trianglemesh", "plymesh", "bilinearmesh", "loopsubdiv",
                                                "sphere",       "disk",    "cylinder",     "curve"};
    return known;
}

bool isQuadric(const ShapeEntity& shape) {
    return shape.type == "sphere" || shape.type == "disk" || shape.type == "cylinder";
}

/// Whether the geometric normal is the other one than the shape itself would have: its own orientation, and a mirrored
/// object, which keeps the side that it had.
bool flipsNormal(const ShapeEntity& shape, const ShapePlace& place) {
    const bool mirrored = (determinant3(place.groupFromObject) < 0) != place.mirrorsGroup;
    // The format's subdivision surfaces face against their control mesh.
    const bool reversedSurface = shape.type == "loopsubdiv";
    return (shape.reverseOrientation != mirrored) != reversedSurface;
}

/// In radians, at most the whole circle.
float readPhiMax(const BuildContext& context, const ParameterSet& p) {
    const float degrees = std::min(context.number(p, "phimax", 360, -1e30f, 1e30f), 360.f);
    return degrees == 360 ? kTwoPi : degrees * (kPi / 180);
}

}  // namespace

bool isUsable(const AffineRecord& m) {
    for (const float x : m.m)
        if (!(std::fabs(x) < kLargestCoordinate)) return false;
    const auto at = [&](int r, int c) { return double(m.m[4 * r + c]); };
    const double determinant = at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) -
                               at(0, 1) * (at(1, 0) * at(2, 2) - at(1, 2) * at(2, 0)) +
                               at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0));
    return std::fabs(determinant) > 1e-36 && std::fabs(determinant) < 1e36;
}

std::optional<BuiltShape> ShapeBuilder::build(ShapeEntity&& shape, const ShapePlace& place) {
    checkType(shape);
    const std::string owner = ownerName("shape", shape.type);
    BuiltShape out;
    out.groupFromObject = place.groupFromObject;
    out.material = materials_.get(shape.material);
    if (out.material.needsUv || showsUv_) out.record.flags |= kShapeNeedsUv;
    if (out.material.needsTangent) out.record.flags |= kShapeNeedsTangent;
    if (flipsNormal(shape, place)) out.record.flags |= kShapeFlipNormal;
    readAlpha(shape, out.record);
    readEmission(shape, place, out);
    const bool isThere = isQuadric(shape)        ? buildQuadric(shape, place, out)
                         : shape.type == "curve" ? buildCurves(shape, place, out)
                                                 : buildMesh(shape, place, out);
    readMedia(shape, out);
    context_.warnUnused(shape.parameters, owner);
    if (!isThere || (out.record.flags & kShapeInvisible && !out.emission)) return std::nullopt;
    return out;
}

void ShapeBuilder::checkType(const ShapeEntity& shape) const {
    const std::vector<std::string>& known = knownShapes();
    if (std::find(known.begin(), known.end(), shape.type) == known.end())
        context_.fail(shape.where, "unknown shape " + quote(shape.type) + suggestion(shape.type, known));
}

bool ShapeBuilder::buildCurves(ShapeEntity& shape, const ShapePlace& place, BuiltShape& out) {
    const std::string owner = ownerName("shape", shape.type);
    out.record.kind = ShapeKind::Curves;
    out.record.flags |= kShapeNeedsTangent;  // their direction is what hair and brushed threads are about
    const CurveArrays arrays = takeCurveArrays(shape.parameters, context_, shape.where);
    if (arrays.type == CurveType::Cylinder) out.record.flags |= kShapeCurveCylinder;
    if (determinant3(place.groupFromObject) < 0) out.record.flags |= kShapeCurveMirrored;
    out.curves = curvesFromArrays(arrays, context_.position(shape.where) + ": " + owner, context_.warnings());
    if (!(place.groupFromObject == Matrix4{})) transform(out.curves, place.groupFromObject);
    if (out.curves.indices.empty())
        context_.warn(shape.where,
                      owner + ": nothing of it is large enough, or small enough, to be seen; it is left out");
    return !out.curves.indices.empty();
}

bool ShapeBuilder::buildMesh(ShapeEntity& shape, const ShapePlace& place, BuiltShape& out) {
    out.record.kind = ShapeKind::Mesh;
    PatchMesh faces = readMesh(shape);
    if (meshFacts_)
        meshFacts_->push_back(
            {context_.position(shape.where), shape.type,
             topologyOf(weldedIndices(faces.mesh.indices, faces.mesh.positions), faces.mesh.vertexCount())});
    faces.mesh.faceIndices = {};
    DiceOptions cut;
    cut.place = place.groupFromObject;
    cut.needsUv = out.record.flags & (kShapeNeedsUv | kShapeNeedsTangent) || (out.emission && out.emission->picture);
    cut.polygons = shape.type == "plymesh";
    cut.numbersFaces = out.emission && out.emission->power > 0;
    cut.mostTriangles = std::min(cut.mostTriangles, roomForDiced_);
    if (!cut.needsUv) faces.mesh.uvs = {};
    if (!(out.record.flags & kShapeNeedsTangent)) faces.mesh.tangents = {};
    const std::size_t whole = faces.mesh.triangleCount();
    out.mesh = dice(std::move(faces), cut);
    TriangleMesh& mesh = out.mesh;
    if (mesh.triangleCount() > whole) roomForDiced_ -= mesh.triangleCount();
    if (!(place.groupFromObject == Matrix4{})) transform(mesh, place.groupFromObject);
    if (shape.reverseOrientation)
        for (float& n : mesh.normals)
            n = -n;
    counts_.droppedTriangles += dropBadTriangles(mesh);
    if (cut.numbersFaces) out.faceOfTriangle = std::move(mesh.faceIndices);
    mesh.faceIndices = {};
    if (mesh.triangleCount() == 0)
        context_.warn(shape.where, ownerName("shape", shape.type) + ": no triangle is left of the mesh");
    return mesh.triangleCount() != 0;
}

PatchMesh ShapeBuilder::readMesh(ShapeEntity& shape) {
    const std::string where = context_.position(shape.where) + ": " + ownerName("shape", shape.type);
    ParameterSet& p = shape.parameters;
    if (shape.type == "plymesh") return readPlyMesh(shape);
    if (shape.type == "bilinearmesh") {
        // An image by which pbrt samples the patch as a light, which alters no expectation.
        p.text("emissionfilename", "");
        return meshFromPatches(takeMeshArrays(p), where, context_.warnings());
    }
    if (shape.type == "loopsubdiv") {
        const int levels = context_.integer(p, "levels", 3, 0, 24);
        p.text("scheme", "");
        MeshArrays control;
        control.P = takeList<std::vector<float>>(p, "point3", "P");
        control.indices = takeList<std::vector<std::int32_t>>(p, "integer", "indices");
        return {subdivideLoop(meshFromArrays(std::move(control), where, context_.warnings()), levels, where), {}};
    }
    return {meshFromArrays(takeMeshArrays(p), where, context_.warnings()), {}};
}

PatchMesh ShapeBuilder::readPlyMesh(const ShapeEntity& shape) {
    const ParameterSet& p = shape.parameters;
    const std::string owner = ownerName("shape", shape.type);
    const std::string file = p.text("filename", "");
    if (file.empty()) context_.fail(shape.where, owner + ": \"string filename\" is missing");
    p.number("edgelength", 1);
    if (const Parameter* displacement = p.find("texture", "displacement"))
        context_.warnOnce("displacement", displacement->where,
                          owner + ": displacement is not there yet and is ignored");
    return context_.placed(shape.where, owner, [&] { return readPly(context_.path(file), context_.warnings()); });
}

bool ShapeBuilder::buildQuadric(const ShapeEntity& shape, const ShapePlace& place, BuiltShape& out) {
    QuadricRecord& q = out.quadric;
    q = shape.type == "sphere" ? readSphere(shape) : shape.type == "disk" ? readDisk(shape) : readCylinder(shape);
    out.record.kind = q.kind;
    const bool isEmptyPart =
        !(q.phiMax > 0) || (q.kind == ShapeKind::Disk ? !(q.innerRadius < q.radius) : !(q.zMax > q.zMin));
    Matrix4 objectFromGroup;
    const bool invertible = invert(place.groupFromObject, objectFromGroup);
    q.worldFromObject = toRecord(place.groupFromObject);
    q.objectFromWorld = toRecord(objectFromGroup);
    const bool usable = invertible && isUsable(q.worldFromObject) && isUsable(q.objectFromWorld);
    if (isEmptyPart || !usable)
        context_.warn(shape.where, ownerName("shape", shape.type) +
                                       (isEmptyPart ? ": nothing is left of it by its limits"
                                                    : ": it is too large or too small to be seen, and left out"));
    return !isEmptyPart && usable;
}

QuadricRecord ShapeBuilder::readSphere(const ShapeEntity& shape) {
    const ParameterSet& p = shape.parameters;
    QuadricRecord q;
    q.kind = ShapeKind::Sphere;
    q.radius = context_.number(p, "radius", 1, 1e-12f, 1e12f);
    const float a = p.number("zmin", -q.radius), b = p.number("zmax", q.radius);
    q.zMin = std::clamp(std::min(a, b), -q.radius, q.radius);
    q.zMax = std::clamp(std::max(a, b), -q.radius, q.radius);
    q.thetaMin = std::acos(q.zMax / q.radius);
    q.thetaMax = std::acos(q.zMin / q.radius);
    q.phiMax = readPhiMax(context_, p);
    return q;
}

QuadricRecord ShapeBuilder::readDisk(const ShapeEntity& shape) {
    const ParameterSet& p = shape.parameters;
    QuadricRecord q;
    q.kind = ShapeKind::Disk;
    q.radius = context_.number(p, "radius", 1, 1e-12f, 1e12f);
    q.innerRadius = context_.number(p, "innerradius", 0, 0, 1e12f);
    q.zMin = q.zMax = context_.number(p, "height", 0, -1e12f, 1e12f);
    q.phiMax = readPhiMax(context_, p);
    return q;
}

QuadricRecord ShapeBuilder::readCylinder(const ShapeEntity& shape) {
    const ParameterSet& p = shape.parameters;
    QuadricRecord q;
    q.kind = ShapeKind::Cylinder;
    q.radius = context_.number(p, "radius", 1, 1e-12f, 1e12f);
    const float a = context_.number(p, "zmin", -1, -1e12f, 1e12f), b = context_.number(p, "zmax", 1, -1e12f, 1e12f);
    q.zMin = std::min(a, b);
    q.zMax = std::max(a, b);
    q.phiMax = readPhiMax(context_, p);
    return q;
}

/// A number of 0 or less makes the shape invisible, which is for lights.
void ShapeBuilder::readAlpha(const ShapeEntity& shape, ShapeRecord& record) {
    const ParameterSet& p = shape.parameters;
    const Parameter* texture = p.find("texture", "alpha");
    const TextureOperand alpha = texture ? textures_.scalar(*texture) : TextureOperand::number(p.number("alpha", 1));
    if (!alpha.isConstant()) {
        record.alphaTexture = alpha.texture;
        record.flags |= kShapeNeedsUv;
        return;
    }
    record.alpha = alpha.constant.r;
    if (!(record.alpha > 0)) record.flags |= kShapeInvisible;
}

void ShapeBuilder::readEmission(const ShapeEntity& shape, const ShapePlace& place, BuiltShape& out) {
    if (shape.areaLight < 0) return;
    const std::string owner = ownerName("shape", shape.type);
    if (shape.type == "curve")
        return context_.warnOnce("shining curve", shape.where,
                                 owner + ": curves cannot be area lights; it does not shine");
    if (!place.mayShine)
        return context_.warnOnce(
            "moving light", shape.where,
            owner + ": shapes that move or stand in objects cannot be area lights; it does not shine");
    if (out.material.passThrough)
        return context_.warn(shape.where,
                             owner + ": a shape with an interface material cannot be an area light; it does not shine");
    const AreaEmission& emission = lights_.get(shape.areaLight);
    if (!emission.isBlack()) out.emission = emission;
}

void ShapeBuilder::readMedia(const ShapeEntity& shape, BuiltShape& out) {
    const MediumReference& medium = shape.medium;
    if (!medium.given || medium.inside == medium.outside) return;
    out.record.flags |= kShapeMediumBoundary;
    out.record.mediumInside = media_.row(medium.inside, medium.where);
    out.record.mediumOutside = media_.row(medium.outside, medium.where);
}

}  // namespace penumbra::builder
