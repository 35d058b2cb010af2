// Shapes, orientation, objects, instances and motion.
#include "tests/scenes_builder_fixture.h"
#include "tests/temporary_folder.h"

#include <cmath>

namespace penumbra {
namespace {

const std::string kTriangle = "Shape \"trianglemesh\" \"point3 P\" [0 0 0  4 0 0  0 4 0]\n";
const std::string kTriangleWithNormals =
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0  4 0 0  0 4 0] \"normal N\" [0 0 -1  0 0 -1  0 0 -1]\n";
const std::string kLight = "LightSource \"infinite\"\n";

/// z of the geometric normal met by a ray along -z through (x, y).
float normalZ(const std::string& world, float x = 0.5f, float y = 0.5f) {
    const BuiltScene built = buildWorld(kLight + world);
    const auto hit = trace(built.scene, {x, y, 10}, {0, 0, -1});
    return hit ? hit->at.ng.z : 0.f;
}

struct OrientationCase {
    const char* name;
    std::string world;
    float expected;
    float x = 0.5f;
};

class Orientation : public testing::TestWithParam<OrientationCase> {};

TEST_P(Orientation, GivesTheNormalOfTheFormat) {
    EXPECT_GT(normalZ(GetParam().world, GetParam().x) * GetParam().expected, 0.8f);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, Orientation,
    testing::Values(
        OrientationCase{"Triangle", kTriangle, 1},
        OrientationCase{"TriangleReversed", "ReverseOrientation\n" + kTriangle, -1},
        // A mirrored mesh keeps the side that it had in object space.
        OrientationCase{"TriangleMirroredInX", "Scale -1 1 1\n" + kTriangle, 1, -0.5f},
        OrientationCase{"TriangleMirroredInZ", "Scale 1 1 -1\n" + kTriangle, -1},
        OrientationCase{"TriangleMirroredAndReversed", "Scale 1 1 -1 ReverseOrientation\n" + kTriangle, 1},
        OrientationCase{"TriangleTurnedTwice", "ReverseOrientation ReverseOrientation\n" + kTriangle, 1},
        // Vertex normals win, and are themselves turned by ReverseOrientation.
        OrientationCase{"Normals", kTriangleWithNormals, -1},
        OrientationCase{"NormalsReversed", "ReverseOrientation\n" + kTriangleWithNormals, 1},
        OrientationCase{"NormalsMirrored", "Scale 1 1 -1\n" + kTriangleWithNormals, 1},
        // Seen from +z, a sphere shows its outside; a mirroring matrix turns quadrics inside out.
        OrientationCase{"Sphere", "Shape \"sphere\"", 1, 0},
        OrientationCase{"SphereReversed", "ReverseOrientation Shape \"sphere\"", -1, 0},
        OrientationCase{"SphereMirrored", "Scale -1 1 1 Shape \"sphere\"", -1, 0},
        OrientationCase{"SphereMirroredReversed", "Scale -1 1 1 ReverseOrientation Shape \"sphere\"", 1, 0},
        OrientationCase{"Disk", "Shape \"disk\"", 1, 0},
        OrientationCase{"DiskReversed", "ReverseOrientation Shape \"disk\"", -1, 0},
        OrientationCase{"Cylinder", "Rotate 90 1 0 0 Shape \"cylinder\"", 1, 0},
        OrientationCase{"CylinderReversed", "ReverseOrientation Rotate 90 1 0 0 Shape \"cylinder\"", -1, 0},
        OrientationCase{"CylinderMirrored", "Scale 1 1 -1 Rotate 90 1 0 0 Shape \"cylinder\"", -1, 0},
        OrientationCase{"DiskTurned", "Rotate 180 1 0 0 Shape \"disk\"", -1, 0},
        OrientationCase{"DiskMirroredInX", "Scale -1 1 1 Shape \"disk\"", -1, 0},
        // Of an instance the stored normal is transformed, without a further turn.
        OrientationCase{"Instance", "ObjectBegin \"o\" " + kTriangle + "ObjectEnd ObjectInstance \"o\"", 1},
        OrientationCase{"InstanceMirrored",
                        "ObjectBegin \"o\" " + kTriangle + "ObjectEnd Scale 1 1 -1 ObjectInstance \"o\"", -1},
        OrientationCase{"MirroredInObject",
                        "ObjectBegin \"o\" Scale 1 1 -1 " + kTriangle + "ObjectEnd ObjectInstance \"o\"", -1},
        OrientationCase{"SphereInstanceMirrored",
                        "ObjectBegin \"o\" Shape \"sphere\" ObjectEnd Scale -1 1 1 ObjectInstance \"o\"", 1, 0},
        OrientationCase{"Patch", "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  4 0 0  0 4 0  4 4 0]", 1},
        OrientationCase{"Subdivision",
                        "Shape \"loopsubdiv\" \"point3 P\" [-4 -4 0  8 -4 0  -4 8 0] \"integer indices\" [0 1 2]", -1}),
    [](const auto& info) { return info.param.name; });

TEST(WorldBuilder, BakesMatricesIntoMeshes) {
    const BuiltScene built = buildWorld(kLight + "Translate 0 0 3 Scale 2 2 2 " + kTriangle);
    const auto hit = trace(built.scene, {5, 2, 10}, {0, 0, -1});
    ASSERT_TRUE(hit);
    EXPECT_FLOAT_EQ(hit->distance, 7);
    EXPECT_TRUE(built.scene.geometry.instances.empty());
    EXPECT_FALSE(built.scene.hasMotion);
}

TEST(WorldBuilder, PlacesObjects) {
    const BuiltScene built = buildWorld(kLight +
                                        "ObjectBegin \"o\" Translate 0 0 1 Shape \"disk\" ObjectEnd "
                                        "ObjectInstance \"o\" Translate 10 0 2 ObjectInstance \"o\"");
    EXPECT_EQ(built.scene.geometry.instances.size(), 2u);
    EXPECT_EQ(built.scene.geometry.groups.size(), 2u);
    EXPECT_EQ(built.scene.facts.shapes, 1u);
    EXPECT_FALSE(built.scene.hasMotion);
    EXPECT_FLOAT_EQ(trace(built.scene, {0, 0, 10}, {0, 0, -1}).value().distance, 9);
    EXPECT_FLOAT_EQ(trace(built.scene, {10, 0, 10}, {0, 0, -1}).value().distance, 7);
    EXPECT_FALSE(trace(built.scene, {5, 0, 10}, {0, 0, -1}));
}

TEST(WorldBuilder, LeavesOutWhatIsNeverPlacedOrEmpty) {
    const BuiltScene built =
        buildWorld(kLight +
                   "ObjectBegin \"unused\" Shape \"sphere\" ObjectEnd "
                   "ObjectBegin \"empty\" ObjectEnd ObjectInstance \"empty\" "
                   "ObjectBegin \"flat\" Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 2 0 0] ObjectEnd "
                   "ObjectInstance \"flat\"");
    EXPECT_TRUE(built.scene.geometry.shapes.empty());
    EXPECT_TRUE(built.scene.geometry.instances.empty());
    EXPECT_EQ(built.scene.facts.droppedTriangles, 1u);
    EXPECT_TRUE(built.warnsOf("shape 'trianglemesh': no triangle is left of the mesh"));
    EXPECT_FALSE(trace(built.scene, {0, 0, 10}, {0, 0, -1}));
}

TEST(WorldBuilder, MovesShapes) {
    const BuiltScene built =
        buildWorld(kLight + "ActiveTransform EndTime Translate 4 0 0 ActiveTransform All Shape \"disk\"");
    EXPECT_TRUE(built.scene.hasMotion);
    ASSERT_EQ(built.scene.geometry.instances.size(), 1u);
    for (const float time : {0.f, 0.25f, 0.5f, 1.f}) {
        EXPECT_TRUE(trace(built.scene, {4 * time, 0, 10}, {0, 0, -1}, time)) << time;
        EXPECT_FALSE(trace(built.scene, {4 * time + 1.1f, 0, 10}, {0, 0, -1}, time)) << time;
    }
}

TEST(WorldBuilder, MovesInstances) {
    const BuiltScene built =
        buildWorld(kLight +
                   "ObjectBegin \"o\" Translate 0 7 0 Shape \"disk\" ObjectEnd "
                   "ActiveTransform EndTime Translate 4 0 0 ActiveTransform All ObjectInstance \"o\"");
    EXPECT_TRUE(built.scene.hasMotion);
    EXPECT_TRUE(trace(built.scene, {0, 7, 10}, {0, 0, -1}, 0));
    EXPECT_TRUE(trace(built.scene, {2, 7, 10}, {0, 0, -1}, 0.5f));
    EXPECT_FALSE(trace(built.scene, {2, 7, 10}, {0, 0, -1}, 0));
}

/// A shape that moves inside an object has a group of its own, placed by the product of both motions.
TEST(WorldBuilder, MovesShapesInsideObjects) {
    const std::string object =
        "ObjectBegin \"o\" Shape \"disk\" ActiveTransform EndTime Translate 4 0 0 ActiveTransform All Shape \"disk\" "
        "ObjectEnd ";
    const BuiltScene still = buildWorld(kLight + object + "Translate 0 20 0 Scale 2 2 2 ObjectInstance \"o\"");
    EXPECT_EQ(still.scene.geometry.groups.size(), 3u);
    EXPECT_EQ(still.scene.geometry.instances.size(), 2u);
    EXPECT_TRUE(trace(still.scene, {4, 20, 10}, {0, 0, -1}, 0.5f));
    EXPECT_TRUE(trace(still.scene, {0, 20, 10}, {0, 0, -1}, 1));
    EXPECT_FALSE(trace(still.scene, {4, 20, 10}, {0, 0, -1}, 0));

    const BuiltScene moving = buildWorld(
        kLight + object + "ActiveTransform EndTime Translate 0 10 0 ActiveTransform All ObjectInstance \"o\"");
    EXPECT_TRUE(trace(moving.scene, {2, 5, 10}, {0, 0, -1}, 0.5f));
    EXPECT_TRUE(trace(moving.scene, {4, 10, 10}, {0, 0, -1}, 1));
    EXPECT_TRUE(trace(moving.scene, {0, 10, 10}, {0, 0, -1}, 1));
}

TEST(WorldBuilder, KnowsThatTheCameraMoves) {
    const BuiltScene built = buildText(
        "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\nCamera \"perspective\"\nWorldBegin " + kLight);
    EXPECT_TRUE(built.scene.hasMotion);
    EXPECT_TRUE(built.scene.camera.moves());
}

TEST(WorldBuilder, CutsQuadrics) {
    const BuiltScene built =
        buildWorld(kLight +
                   "Shape \"sphere\" \"float radius\" 2 \"float zmin\" 1.5 \"float zmax\" -1 "
                   "Translate 10 0 0 Shape \"disk\" \"float radius\" 2 \"float innerradius\" 1 \"float height\" 3");
    ASSERT_EQ(built.scene.geometry.quadrics.size(), 2u);
    const QuadricRecord& sphere = built.scene.geometry.quadrics[0];
    EXPECT_FLOAT_EQ(sphere.zMin, -1);
    EXPECT_FLOAT_EQ(sphere.zMax, 1.5f);
    EXPECT_FLOAT_EQ(sphere.thetaMin, std::acos(0.75f));
    EXPECT_FLOAT_EQ(sphere.thetaMax, std::acos(-0.5f));
    EXPECT_FLOAT_EQ(trace(built.scene, {11.5f, 0, 10}, {0, 0, -1}).value().distance, 7);
    EXPECT_FALSE(trace(built.scene, {10.5f, 0, 10}, {0, 0, -1}));
}

/// Half a gutter above z = 0, its ends open; the limits of z in any order.
TEST(WorldBuilder, CutsCylinders) {
    const BuiltScene built = buildWorld(
        kLight +
        "Rotate 90 0 1 0 Rotate 90 0 0 1 Shape \"cylinder\" \"float radius\" 2 \"float zmin\" 3 \"float zmax\" -1 "
        "\"float phimax\" 180 Shape \"cylinder\" \"float zmin\" 1 \"float zmax\" 1");
    EXPECT_TRUE(built.warnsOf("shape 'cylinder': nothing is left of it by its limits"));
    ASSERT_EQ(built.scene.geometry.quadrics.size(), 1u);
    const QuadricRecord& q = built.scene.geometry.quadrics[0];
    EXPECT_EQ(q.zMin, -1);
    EXPECT_EQ(q.zMax, 3);
    // The axis is along x now, and the object's y, where the half with phi < 180 is, along z.
    EXPECT_NEAR(trace(built.scene, {2.5f, 0, 10}, {0, 0, -1}).value().distance, 8, 1e-5);
    EXPECT_NEAR(trace(built.scene, {2.5f, 0, 0}, {0, 0, 1}).value().distance, 2, 1e-5);
    EXPECT_FALSE(trace(built.scene, {2.5f, 0, 0}, {0, 0, -1}));
    EXPECT_FALSE(trace(built.scene, {3.5f, 0, 10}, {0, 0, -1}));
    EXPECT_FALSE(trace(built.scene, {-10, 0, 1}, {1, 0, 0}));
}

TEST(WorldBuilder, LeavesOutWhatFloatsCannotHold) {
    const BuiltScene built = buildWorld(kLight +
                                        "AttributeBegin Scale 1e-30 1e-30 1e-30 Shape \"sphere\" AttributeEnd "
                                        "AttributeBegin Scale 1e30 1e30 1e30 Shape \"sphere\" AttributeEnd "
                                        "ObjectBegin \"o\" Shape \"sphere\" ObjectEnd "
                                        "Scale 1e-30 1 1e-30 ObjectInstance \"o\"");
    EXPECT_TRUE(built.scene.geometry.instances.empty());
    EXPECT_TRUE(built.warnsOf("too large or too small"));
    EXPECT_FALSE(trace(built.scene, {0, 0, 10}, {0, 0, -1}));
}

/// A straight strand along x from 0 to 3, seen from above as a band of the given parameters.
std::string strand(const std::string& parameters = "\"float width\" 1") {
    return "Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] " + parameters + "\n";
}

TEST(SceneCurves, AreBands) {
    const BuiltScene built =
        buildWorld(kLight + "Translate 0 0 2 Scale 2 2 2 " + strand("\"float width0\" 1 \"float width1\" 0.5"));
    EXPECT_TRUE(built.warnings.all().empty());
    const auto hit = trace(built.scene, {3, 0.2f, 10}, {0, 0, -1});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance, 8, 1e-5);
    EXPECT_NEAR(hit->at.uv.x, 0.5, 1e-5);
    // Half a width of 1.5 is .75 there, and v grows towards -z x +x = -y.
    EXPECT_NEAR(hit->at.uv.y, 0.5 - 0.2 / 1.5, 1e-5);
    EXPECT_NEAR(hit->at.frame.s.x, 1, 1e-6);
    EXPECT_NEAR(hit->at.ng.z, -1, 1e-6) << "on the far side of the ray";
    EXPECT_TRUE(trace(built.scene, {3, 0.74f, 10}, {0, 0, -1}));
    EXPECT_FALSE(trace(built.scene, {3, 0.76f, 10}, {0, 0, -1}));
    EXPECT_FALSE(trace(built.scene, {6.01f, 0, 10}, {0, 0, -1})) << "no caps";
}

TEST(SceneCurves, MirrorsTurnThem) {
    for (const std::string& place : {std::string("Scale 1 -1 1 "), std::string("Scale 1 -1 1.2 ")}) {
        const auto hit = trace(buildWorld(kLight + place + strand()).scene, {1.5f, 0.2f, 10}, {0, 0, -1});
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->at.uv.y, 0.7, 1e-5) << place << "v as in object space";
        EXPECT_NEAR(hit->at.ng.z, 1, 1e-6) << place;
    }
    const auto reversed =
        trace(buildWorld(kLight + "ReverseOrientation " + strand()).scene, {1.5f, 0.2f, 10}, {0, 0, -1});
    ASSERT_TRUE(reversed);
    EXPECT_NEAR(reversed->at.ng.z, 1, 1e-6);
}

/// A scene may have a million strands: those that differ by nothing but their points are one shape.
TEST(SceneCurves, JoinOthersLikeThem) {
    std::string many;
    for (int i = 0; i < 300; ++i)
        many += "AttributeBegin Translate 0 " + std::to_string(2 * i) + " 0\n" + strand() + "AttributeEnd\n";
    const BuiltScene built = buildWorld(kLight + "Material \"conductor\"\n" + many +
                                        strand("\"string basis\" \"bspline\"") + "Material \"diffuse\"\n" + many);
    const Geometry& g = built.scene.geometry;
    ASSERT_EQ(g.shapes.size(), 3u);
    EXPECT_EQ(g.shapes[0].count, 300u);
    EXPECT_EQ(g.shapes[2].first, 301u);
    const auto hit = trace(built.scene, {1.5f, 100, 10}, {0, 0, -1});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->at.uv.x, 0.5, 1e-5);
    EXPECT_FALSE(trace(built.scene, {1.5f, 99, 10}, {0, 0, -1}));
}

/// Under a matrix that is no similarity a curve keeps its own space: the width is scaled as the format has it.
TEST(SceneCurves, KeepTheirSpaceUnderSkewedMatrices) {
    const std::string skewed = "Scale 1 3 1 " + strand();
    const BuiltScene built = buildWorld(kLight + "AttributeBegin " + skewed + skewed + "AttributeEnd " + strand());
    EXPECT_EQ(built.scene.geometry.groups.size(), 3u) << "two matrices: 1 3 1, and 1 9 1";
    EXPECT_EQ(built.scene.geometry.instances.size(), 2u);
    EXPECT_TRUE(trace(built.scene, {1.5f, 4.4f, 10}, {0, 0, -1}));
    EXPECT_FALSE(trace(built.scene, {1.5f, 4.6f, 10}, {0, 0, -1}));
    const BuiltScene object =
        buildWorld(kLight + "ObjectBegin \"o\" " + skewed + strand() +
                   "ObjectEnd Translate 0 0 5 ObjectInstance \"o\" Translate 0 20 0 ObjectInstance \"o\"");
    EXPECT_EQ(object.scene.geometry.groups.size(), 2u);
    ASSERT_EQ(object.scene.geometry.instances.size(), 2u);
    const auto hit = trace(object.scene, {1.5f, 21.4f, 10}, {0, 0, -1});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance, 5, 1e-5);
    EXPECT_NEAR(hit->at.uv.y, 0.5 - 1.4 / 3, 1e-4);
    EXPECT_FALSE(trace(object.scene, {1.5f, 21.6f, 10}, {0, 0, -1}));
}

TEST(SceneCurves, Move) {
    const BuiltScene built =
        buildWorld(kLight + "ActiveTransform EndTime Translate 0 4 0 ActiveTransform All " + strand());
    EXPECT_TRUE(trace(built.scene, {1.5f, 2, 10}, {0, 0, -1}, 0.5f));
    EXPECT_FALSE(trace(built.scene, {1.5f, 2, 10}, {0, 0, -1}, 0));
}

TEST(SceneCurves, HaveHoles) {
    // Two thirds of the way along: 1 up to u = 0.5, then 0; and across, 1 up to v = 0.5.
    for (const bool across : {false, true}) {
        const std::string parameter =
            across ? "\"float vscale\" 2 \"float uscale\" 1e-6" : "\"float uscale\" 2 \"float vscale\" 1e-6";
        const BuiltScene built =
            buildWorld(kLight + "Texture \"half\" \"float\" \"checkerboard\" \"float tex1\" 1 \"float tex2\" 0 " +
                       parameter + "\n" + strand("\"float width\" 1 \"texture alpha\" \"half\""));
        EXPECT_TRUE(trace(built.scene, {0.6f, 0.2f, 10}, {0, 0, -1})) << "u 0.2, v 0.3";
        EXPECT_EQ(trace(built.scene, {2.4f, 0.2f, 10}, {0, 0, -1}).has_value(), across) << "u 0.8, v 0.3";
        EXPECT_EQ(trace(built.scene, {0.6f, -0.2f, 10}, {0, 0, -1}).has_value(), !across) << "u 0.2, v 0.7";
    }
    const BuiltScene thin = buildWorld(kLight + strand("\"float width\" 1 \"float alpha\" 0.3"));
    int met = 0;
    for (int i = 0; i < 4000; ++i)
        met += trace(thin.scene, {0.1f + 2.8f * float(i) / 4000, 0.1f, 10}, {0, 0, -1}).has_value();
    EXPECT_NEAR(met, 1200, 110);  // 3.8 standard deviations
}

TEST(SceneCurves, DoNotShine) {
    const BuiltScene built = buildWorld("AreaLightSource \"diffuse\" " + strand() + strand());
    EXPECT_TRUE(built.scene.lights.empty());
    EXPECT_TRUE(built.warnsOf("test.pbrt:2:27: shape 'curve': curves cannot be area lights; it does not shine"));
}

TEST(SceneCurves, RefuseWhatTheFormatDoes) {
    const auto error = [](const std::string& parameters) { return errorOf("WorldBegin\n" + strand(parameters)); };
    EXPECT_EQ(error("\"string basis\" \"bspine\"")
                  .rfind("test.pbrt:2:52: unknown basis 'bspine' of a curve; did you mean 'bspline'?", 0),
              0u)
        << error("\"string basis\" \"bspine\"");
    EXPECT_NE(error("\"string type\" \"tube\"").find("unknown type 'tube' of a curve"), std::string::npos);
    EXPECT_NE(error("\"integer degree\" 4").find("degree is 4, outside the allowed range, 2 to 3"), std::string::npos);
    EXPECT_NE(error("\"float width1\" -1").find("width1 is -1, outside the allowed range"), std::string::npos);
    EXPECT_NE(error("\"integer degree\" 2").find("4 points make no curve of degree 2"), std::string::npos);
    EXPECT_NE(error("\"string type\" \"ribbon\"").find("needs 2 normals \"N\", but has 0"), std::string::npos);
}

TEST(WorldBuilder, ReadsPlyMeshes) {
    const TemporaryFolder folder;
    folder.file("m.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n4 0 0\n0 4 0\n3 0 1 2\n");
    const std::string scene = "WorldBegin LightSource \"infinite\"\nShape \"plymesh\" \"string filename\" \"m.ply\"";
    const BuiltScene built = buildText(scene, {}, folder.path(""));
    EXPECT_EQ(built.scene.facts.triangles, 1u);
    EXPECT_TRUE(trace(built.scene, {1, 1, 10}, {0, 0, -1}));
}

TEST(WorldBuilder, NamesTheDirectiveAndTheFileThatIsMissing) {
    try {
        buildText("WorldBegin\n  Shape \"plymesh\" \"string filename\" \"no/such.ply\"", {}, "/some/folder");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::MissingInput);
        const std::string text = error.what();
        EXPECT_EQ(text.rfind("test.pbrt:2:3: shape 'plymesh': /some/folder/no/such.ply: ", 0), 0u) << text;
    }
}

TEST(WorldBuilder, DropsWhatNoMaterialLooksAt) {
    const std::string mesh =
        "Shape \"trianglemesh\" \"point3 P\" [0 0 0 4 0 0 0 4 0] \"point2 uv\" [0 0 1 0 0 1] \"vector3 S\" [1 0 0 1 0 "
        "0 1 0 0]\n";
    EXPECT_TRUE(buildWorld(mesh).scene.geometry.uvs.empty());
    const BuiltScene anisotropic =
        buildWorld("Material \"conductor\" \"float uroughness\" 0.1 \"float vroughness\" 0.3\n" + mesh);
    EXPECT_EQ(anisotropic.scene.geometry.uvs.size(), 6u);
    EXPECT_EQ(anisotropic.scene.geometry.tangents.size(), 9u);
}

TEST(WorldBuilder, MarksTheBordersOfMedia) {
    const std::string medium =
        "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [0 0 0] "
        "\"float scale\" 2\n";
    const BuiltScene built =
        buildText("MediumInterface \"\" \"ink\"\nCamera \"perspective\"\n" + medium +
                  "WorldBegin LightSource \"infinite\"\n"
                  "MediumInterface \"ink\" \"\" Shape \"sphere\" MediumInterface \"ink\" \"ink\" Shape \"disk\"");
    ASSERT_EQ(built.scene.media.size(), 2u);
    EXPECT_EQ(built.scene.media[1].absorption.g, 4);
    EXPECT_EQ(built.scene.cameraMedium, 1u);
    const ShapeRecord &border = built.scene.geometry.shapes[0], &within = built.scene.geometry.shapes[1];
    EXPECT_TRUE(border.flags & kShapeMediumBoundary);
    EXPECT_EQ(border.mediumInside, 1u);
    EXPECT_EQ(border.mediumOutside, 0u);
    EXPECT_FALSE(within.flags & kShapeMediumBoundary);
    EXPECT_TRUE(built.warnings.all().empty());
}

TEST(WorldBuilder, WarnsOfScatteringAndOfOtherMedia) {
    const BuiltScene built = buildWorld(
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" MakeNamedMedium \"smoke\" \"string type\" \"cloud\" "
        "MediumInterface \"fog\" \"smoke\" Shape \"sphere\" LightSource \"infinite\"");
    EXPECT_TRUE(built.warnsOf("medium 'fog': scattering media come later: light is only absorbed"));
    EXPECT_TRUE(built.warnsOf("the medium type 'cloud' is not there yet"));
    ASSERT_EQ(built.scene.media.size(), 3u);
    EXPECT_EQ(built.scene.media[1].absorption.r, 1);
    EXPECT_EQ(built.scene.media[2].absorption.r, 0);
}

}  // namespace
}  // namespace penumbra
