// What every directive of the pbrt format does to the SceneDescription.
#include "scenes/readers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace penumbra {
namespace {

SceneDescription read(const std::string& text, std::vector<std::string> warnings = {}) {
    Warnings collected;
    SceneDescription scene = readSceneText(text, "s.pbrt", "", collected);
    EXPECT_EQ(collected.all(), warnings) << text;
    return scene;
}

/// The scene of a world block.
SceneDescription readWorld(const std::string& text, std::vector<std::string> warnings = {}) {
    return read("WorldBegin\n" + text, std::move(warnings));
}

Vec3d apply(const Matrix4& m, double x, double y, double z) {
    return transformPoint(m, {x, y, z});
}

void expectPoint(Vec3d p, double x, double y, double z) {
    EXPECT_NEAR(p.x, x, 1e-12);
    EXPECT_NEAR(p.y, y, 1e-12);
    EXPECT_NEAR(p.z, z, 1e-12);
}

TEST(ScenesPbrtDirectives, Defaults) {
    const SceneDescription scene = readWorld("");
    EXPECT_EQ(scene.camera.type, "perspective");
    EXPECT_EQ(scene.film.type, "rgb");
    EXPECT_EQ(scene.film.colorSpace, "srgb");
    EXPECT_EQ(scene.sampler.type, "zsobol");
    EXPECT_EQ(scene.integrator.type, "volpath");
    EXPECT_EQ(scene.filter.type, "gaussian");
    EXPECT_EQ(scene.accelerator.type, "bvh");
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].type, "diffuse");
    EXPECT_EQ(scene.transformTimes[0], 0);
    EXPECT_EQ(scene.transformTimes[1], 1);
    EXPECT_EQ(scene.files, (std::vector<std::string>{"s.pbrt"}));
}

TEST(ScenesPbrtDirectives, OptionsBlockKeepsTypesAndTheLastWins) {
    const SceneDescription scene = read(
        "Sampler \"sobol\" \"integer pixelsamples\" 4\n Integrator \"path\" PixelFilter \"box\"\n"
        "Accelerator \"kdtree\" Film \"gbuffer\" ColorSpace \"REC2020\" Film \"rgb\" \"integer xresolution\" [ 64 ]\n"
        "Camera \"orthographic\" Camera \"perspective\" \"float fov\" 30\nWorldBegin");
    EXPECT_EQ(scene.sampler.type, "sobol");
    EXPECT_EQ(scene.sampler.parameters.integer("pixelsamples", 0), 4);
    EXPECT_EQ(scene.integrator.type, "path");
    EXPECT_EQ(scene.filter.type, "box");
    EXPECT_EQ(scene.accelerator.type, "kdtree");
    EXPECT_EQ(scene.film.type, "rgb");
    EXPECT_EQ(scene.film.colorSpace, "rec2020");
    EXPECT_EQ(scene.film.parameters.integer("xresolution", 0), 64);
    EXPECT_EQ(scene.camera.type, "perspective");
    EXPECT_EQ(scene.camera.parameters.number("fov", 0), 30);
    EXPECT_EQ(scene.camera.where.line, 4u);
    EXPECT_EQ(scene.camera.where.column, 23u);
}

TEST(ScenesPbrtDirectives, Options) {
    const SceneDescription scene = read(
        "Option \"Seed\" 42 Option \"disable_pixel-jitter\" true Option \"render-coord-sys\" \"world\"\n"
        "Option \"displacementedgescale\" 2.5 Option \"bool wavefront\" [false]\nWorldBegin");
    EXPECT_EQ(scene.options.integer("seed", 0), 42);
    EXPECT_TRUE(scene.options.boolean("disablepixeljitter", false));
    EXPECT_EQ(scene.options.text("rendercoordsys", ""), "world");
    EXPECT_EQ(scene.options.number("displacementedgescale", 0), 2.5f);
    EXPECT_FALSE(scene.options.boolean("wavefront", true));
    read("Option \"sed\" [1 2 \"x\"] WorldBegin",
         {"s.pbrt:1:1: unknown option 'sed'; did you mean 'seed'? (it is ignored)"});
}

TEST(ScenesPbrtDirectives, ParameterValues) {
    const SceneDescription scene = readWorld(
        "Shape \"s\" \"float a\" 1 \"float b\" [ 1 2 ] \"integer i\" [-3] \"bool t\" true \"bool f\" [ \"false\" true "
        "]\n"
        "\"string s\" [ \"x\" \"y z\" ] \"point2 p2\" [1 2] \"vector2 v2\" [1 2] \"point3 p3\" [1 2 3] \"vector3 v3\" "
        "[1 2 3]\n"
        "\"normal n\" [0 0 1] \"rgb c\" [1 .5 0] \"blackbody bb\" 6500 \"spectrum pairs\" [400 1 500 2]\n"
        "\"spectrum named\" \"metal-Cu-eta\" \"spectrum file\" [\"a.spd\"] \"texture tex\" \"t\" \"  float \t spaced  "
        "\" 4");
    const ParameterSet& p = scene.shapes.at(0).parameters;
    EXPECT_EQ(p.all().size(), 18u);
    EXPECT_EQ(p.number("a", 0), 1);
    EXPECT_EQ(p.numbers("float", "b"), (std::vector<float>{1, 2}));
    EXPECT_EQ(p.integer("i", 0), -3);
    EXPECT_TRUE(p.boolean("t", false));
    EXPECT_EQ(p.find("bool", "f")->bools(), (std::vector<std::uint8_t>{0, 1}));
    EXPECT_EQ(p.find("string", "s")->strings(), (std::vector<std::string>{"x", "y z"}));
    EXPECT_EQ(p.numbers("normal", "n"), (std::vector<float>{0, 0, 1}));
    EXPECT_EQ(p.find("rgb", "c")->floats(), (std::vector<float>{1, .5f, 0}));
    EXPECT_EQ(p.find("rgb", "c")->colorSpace, "srgb");
    EXPECT_EQ(p.find("blackbody", "bb")->floats(), (std::vector<float>{6500}));
    EXPECT_EQ(p.find("spectrum", "pairs")->floats(), (std::vector<float>{400, 1, 500, 2}));
    EXPECT_TRUE(p.find("spectrum", "named")->isText());
    EXPECT_EQ(p.find("spectrum", "file")->strings(), (std::vector<std::string>{"a.spd"}));
    EXPECT_EQ(p.find("texture", "tex")->strings(), (std::vector<std::string>{"t"}));
    EXPECT_EQ(p.number("spaced", 0), 4);
    EXPECT_EQ(p.find("string", "s")->where.line, 3u);
    EXPECT_EQ(p.find("string", "s")->where.column, 1u);
}

TEST(ScenesPbrtDirectives, HabitsOfOlderFiles) {
    const SceneDescription scene = readWorld(
        "Texture \"t\" \"color\" \"imagemap\" Shape \"s\" \"point P\" [1 2 3] \"vector v\" [1 2 3] \"color c\" [1 1 "
        "1]\n"
        "\"normal3 N\" [0 0 1] \"bool b\" [\"true\"]\nTranslate [1 2 3]\nWorldEnd\n",
        {"s.pbrt:5:1: WorldEnd is a word of pbrt-v3 and is ignored"});
    const ParameterSet& p = scene.shapes.at(0).parameters;
    for (const char* type : {"point3", "vector3", "rgb", "normal"})
        EXPECT_TRUE(std::any_of(p.all().begin(), p.all().end(), [&](const Parameter& q) { return q.type == type; }))
            << type;
    EXPECT_EQ(p.find("rgb", "c")->colorSpace, "srgb");
    EXPECT_TRUE(p.boolean("b", false));
    EXPECT_FALSE(scene.textures.at(0).isFloat);
}

TEST(ScenesPbrtDirectives, AParameterGivenTwiceIsTheLastOne) {
    const SceneDescription scene =
        readWorld("Shape \"s\" \"float r\" 1 \"texture r\" \"t\"",
                  {"s.pbrt:2:23: parameter 'texture r' replaces 'float r' of the same directive"});
    ASSERT_EQ(scene.shapes.at(0).parameters.all().size(), 1u);
    EXPECT_EQ(scene.shapes.at(0).parameters.all()[0].type, "texture");
}

TEST(ScenesPbrtDirectives, TransformsMultiplyFromTheRight) {
    const SceneDescription scene = readWorld(
        "Translate 1 2 3 Scale 2 2 2 Rotate 90 0 0 1 Shape \"s\"\n"
        "Transform [0 1 0 0  -1 0 0 0  0 0 1 0  7 8 9 1] Shape \"s\"\n"
        "ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 1] Shape \"s\"\n"
        "Identity Shape \"s\" Transform [2 0 0 0 0 2 0 0 0 0 2 0 4 0 0 2] Shape \"s\"\n");
    ASSERT_EQ(scene.shapes.size(), 5u);
    expectPoint(apply(scene.shapes[0].objectToWorld.start, 1, 0, 0), 1, 4, 3);
    expectPoint(apply(scene.shapes[1].objectToWorld.start, 1, 0, 0), 7, 9, 9);
    expectPoint(apply(scene.shapes[2].objectToWorld.start, 0, 0, 0), 7, 9, 9);
    EXPECT_EQ(scene.shapes[3].objectToWorld.start, Matrix4{});
    expectPoint(apply(scene.shapes[4].objectToWorld.start, 1, 1, 1), 3, 1, 1);
    for (const ShapeEntity& s : scene.shapes)
        EXPECT_FALSE(s.objectToWorld.animated());
}

TEST(ScenesPbrtDirectives, LookAtIsCameraFromWorld) {
    const SceneDescription scene = read(
        "LookAt 0 0 -5  0 0 0  0 1 0 Camera \"perspective\"\nWorldBegin Shape \"s\" CoordSysTransform \"camera\" Shape "
        "\"s\"\n"
        "CoordSysTransform \"world\" Shape \"s\"");
    expectPoint(apply(scene.camera.cameraFromWorld.start, 0, 0, 0), 0, 0, 5);
    EXPECT_FALSE(scene.camera.cameraFromWorld.animated());
    EXPECT_EQ(scene.shapes[0].objectToWorld.start, Matrix4{}) << "WorldBegin resets the CTM";
    expectPoint(apply(scene.shapes[1].objectToWorld.start, 0, 0, 0), 0, 0, -5);
    EXPECT_EQ(scene.shapes[2].objectToWorld.start, Matrix4{});
}

TEST(ScenesPbrtDirectives, ActiveTransformMovesOneOfTheTwo) {
    const SceneDescription scene = read(
        "TransformTimes 0.25 0.75 ActiveTransform StartTime Translate 9 9 9 WorldBegin\n"
        "Shape \"still\" AttributeBegin ActiveTransform EndTime Translate 1 0 0 Shape \"moves\" AttributeEnd Translate "
        "0 2 0\n"
        "Shape \"both\" ActiveTransform StartTime Rotate 30 1 2 3 ActiveTransform EndTime Rotate 30 1 2 3 Shape "
        "\"equal\"\n"
        "ActiveTransform StartTime Scale 2 2 2 CoordinateSystem \"here\" Identity ActiveTransform All "
        "CoordSysTransform \"here\"\n"
        "ReverseOrientation Shape \"moves\"");
    EXPECT_EQ(scene.transformTimes[0], 0.25);
    EXPECT_EQ(scene.transformTimes[1], 0.75);
    ASSERT_EQ(scene.shapes.size(), 5u);
    for (const ShapeEntity& s : scene.shapes)
        EXPECT_EQ(s.objectToWorld.animated(), s.type == "moves") << s.where.line;
    expectPoint(apply(scene.shapes[1].objectToWorld.end, 0, 0, 0), 1, 0, 0);
    expectPoint(apply(scene.shapes[1].objectToWorld.start, 0, 0, 0), 0, 0, 0);
    expectPoint(apply(scene.shapes[2].objectToWorld.start, 0, 0, 0), 0, 2, 0);
    EXPECT_EQ(scene.shapes[3].objectToWorld.start, scene.shapes[3].objectToWorld.end) << "equal bits";
    EXPECT_TRUE(scene.shapes[4].reverseOrientation);
}

TEST(ScenesPbrtDirectives, BlocksRestoreTheWholeState) {
    for (const std::string block : {"Attribute", "Transform"}) {
        const SceneDescription scene = readWorld("Material \"conductor\" " + block +
                                                 "Begin\nTranslate 1 0 0 ReverseOrientation Material \"dielectric\"\n"
                                                 "AreaLightSource \"diffuse\" MediumInterface \"fog\" \"air\" "
                                                 "ColorSpace \"rec2020\" ActiveTransform EndTime\n"
                                                 "Attribute \"shape\" \"float radius\" 3\nShape \"in\"\n" +
                                                 block + "End\nShape \"out\" \"rgb c\" [1 1 1]");
        const ShapeEntity &in = scene.shapes.at(0), &out = scene.shapes.at(1);
        EXPECT_EQ(in.material.index, 2);
        EXPECT_EQ(in.areaLight, 0);
        EXPECT_EQ(in.medium.inside, "fog");
        EXPECT_EQ(in.medium.outside, "air");
        EXPECT_TRUE(in.medium.given && in.reverseOrientation);
        EXPECT_EQ(in.parameters.number("radius", 0), 3);
        EXPECT_EQ(out.material.index, 1);
        EXPECT_EQ(out.areaLight, -1);
        EXPECT_FALSE(out.medium.given || out.reverseOrientation);
        EXPECT_EQ(out.objectToWorld.start, Matrix4{});
        EXPECT_EQ(out.parameters.find("rgb", "c")->colorSpace, "srgb");
        EXPECT_EQ(out.parameters.findAny("radius"), nullptr);
    }
}

TEST(ScenesPbrtDirectives, AttributeDefaultsRankBelowOwnParameters) {
    const SceneDescription scene = readWorld(
        "Attribute \"shape\" \"float radius\" 1 \"float zmin\" -1 Attribute \"shape\" \"float radius\" 2\n"
        "Shape \"a\" Shape \"b\" \"texture radius\" \"t\" Attribute \"light\" \"rgb L\" [1 1 1] LightSource \"point\"\n"
        "AreaLightSource \"diffuse\" Attribute \"material\" \"float roughness\" 0.5 Material \"conductor\"\n"
        "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" Attribute \"texture\" \"float scale\" 3\n"
        "Texture \"t\" \"float\" \"constant\" Attribute \"medium\" \"float g\" .5 MakeNamedMedium \"f\" \"string "
        "type\" \"cloud\"");
    EXPECT_EQ(scene.shapes[0].parameters.number("radius", 0), 2);
    EXPECT_EQ(scene.shapes[0].parameters.number("zmin", 0), -1);
    EXPECT_TRUE(scene.shapes[0].parameters.all()[0].inherited);
    EXPECT_EQ(scene.shapes[1].parameters.number("radius", 0), 0) << "an own parameter of another type hides it";
    EXPECT_NE(scene.lights[0].parameters.find("rgb", "L"), nullptr);
    EXPECT_NE(scene.areaLights[0].parameters.find("rgb", "L"), nullptr);
    EXPECT_EQ(scene.materials[1].parameters.number("roughness", 0), 0.5f);
    EXPECT_EQ(scene.namedMaterials[0].parameters.number("roughness", 0), 0.5f);
    EXPECT_EQ(scene.textures[0].parameters.number("scale", 0), 3);
    EXPECT_EQ(scene.media[0].parameters.number("g", 0), 0.5f);
    Warnings unused;
    scene.shapes[1].parameters.find("texture", "radius");
    scene.shapes[1].parameters.warnUnused(scene.files, "shape", unused);
    EXPECT_TRUE(unused.all().empty()) << "inherited parameters are never unused";
}

TEST(ScenesPbrtDirectives, NamesAreKeptForLater) {
    const SceneDescription scene = readWorld(
        "NamedMaterial \"later | ::#\" Shape \"a\" MakeNamedMaterial \"later | ::#\" \"string type\" \"conductor\"\n"
        "Texture \"t\" \"float\" \"constant\" Translate 1 2 3 Texture \"t\" \"spectrum\" \"scale\"");
    EXPECT_EQ(scene.shapes[0].material.name, "later | ::#");
    EXPECT_EQ(scene.shapes[0].material.index, -1);
    EXPECT_EQ(scene.shapes[0].material.where.column, 1u);
    EXPECT_EQ(scene.namedMaterials[0].name, "later | ::#");
    EXPECT_EQ(scene.namedMaterials[0].type, "conductor");
    EXPECT_TRUE(scene.namedMaterials[0].parameters.all()[0].used);
    ASSERT_EQ(scene.textures.size(), 2u) << "float and spectrum textures are two name spaces";
    EXPECT_TRUE(scene.textures[0].isFloat);
    EXPECT_EQ(scene.textures[1].type, "scale");
    expectPoint(apply(scene.textures[1].textureToWorld, 0, 0, 0), 1, 2, 3);
}

TEST(ScenesPbrtDirectives, MediaReachCameraAndLights) {
    const SceneDescription scene = read(
        "Translate 0 0 4 MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" MediumInterface \"\" \"fog\"\n"
        "Camera \"perspective\" WorldBegin LightSource \"point\" MediumInterface \"smoke\" Shape \"s\"\n"
        "Translate 1 0 0 LightSource \"spot\"");
    EXPECT_EQ(scene.media[0].type, "homogeneous");
    expectPoint(apply(scene.media[0].mediumToWorld, 0, 0, 0), 0, 0, 4);
    EXPECT_EQ(scene.camera.medium, "fog");
    EXPECT_EQ(scene.lights[0].medium, "fog") << "the media persist over WorldBegin";
    EXPECT_EQ(scene.shapes[0].medium.inside, "smoke");
    EXPECT_EQ(scene.shapes[0].medium.outside, "smoke") << "one name stands for both sides";
    EXPECT_EQ(scene.lights[1].medium, "smoke");
    expectPoint(apply(scene.lights[1].lightToWorld, 0, 0, 0), 1, 0, 0);
}

TEST(ScenesPbrtDirectives, ObjectsAndInstances) {
    const SceneDescription scene = readWorld(
        "Translate 1 0 0 ObjectBegin \"o\" Translate 0 1 0 Shape \"a\" Shape \"b\" ObjectEnd Shape \"c\"\n"
        "AttributeBegin Scale 2 2 2 ActiveTransform EndTime Translate 0 0 1 ObjectInstance \"o\" AttributeEnd\n"
        "ObjectInstance \"undefined so far\"");
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.objects[0].name, "o");
    ASSERT_EQ(scene.objects[0].shapes.size(), 2u);
    expectPoint(apply(scene.objects[0].shapes[0].objectToWorld.start, 0, 0, 0), 1, 1, 0);
    ASSERT_EQ(scene.shapes.size(), 1u);
    expectPoint(apply(scene.shapes[0].objectToWorld.start, 0, 0, 0), 1, 0, 0);
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_TRUE(scene.instances[0].instanceToWorld.animated());
    expectPoint(apply(scene.instances[0].instanceToWorld.start, 1, 0, 0), 3, 0, 0);
    EXPECT_EQ(scene.instances[1].name, "undefined so far");
}

TEST(ScenesPbrtDirectives, ColorSpaces) {
    const SceneDescription scene = readWorld(
        "ColorSpace \"ACES2065-1\" Shape \"a\" \"rgb c\" [1 1 1] ColorSpace \"dci-p3\" Shape \"b\" \"rgb c\" [1 1 1]\n"
        "ColorSpace \"srbg\" Shape \"c\" \"rgb c\" [1 1 1]",
        {"s.pbrt:3:1: unknown colour space 'srbg'; did you mean 'srgb'? (the directive is ignored)"});
    EXPECT_EQ(scene.shapes[0].parameters.find("rgb", "c")->colorSpace, "aces2065-1");
    EXPECT_EQ(scene.shapes[1].parameters.find("rgb", "c")->colorSpace, "dci-p3");
    EXPECT_EQ(scene.shapes[2].parameters.find("rgb", "c")->colorSpace, "dci-p3");
}

TEST(ScenesPbrtDirectives, OnlyWarnings) {
    readWorld("CoordSysTransform \"wordl\"",
              {"s.pbrt:2:1: unknown coordinate system 'wordl'; did you mean 'world'? (the directive is ignored)"});
    readWorld("AttributeBegin\n Shape \"s\"",
              {"s.pbrt:2:1: 'AttributeBegin' has no 'AttributeEnd' (the end of the file closes it)"});
}

TEST(ScenesPbrtDirectives, UnknownOnesAreSkippedWithTheirValues) {
    const SceneDescription scene = readWorld(
        "Shpae \"sphere\" \"float radius\" [1 2] true -5 .5 [ \"a\" ] Shape \"a\" Materiol Shape \"b\" Shpae",
        {"s.pbrt:2:1: unknown directive 'Shpae'; did you mean 'Shape'? (it is skipped with its values)",
         "s.pbrt:2:66: unknown directive 'Materiol'; did you mean 'Material'? (it is skipped with its values)",
         "s.pbrt:2:85: unknown directive 'Shpae'; did you mean 'Shape'? (it is skipped with its values)"});
    ASSERT_EQ(scene.shapes.size(), 2u);
    EXPECT_EQ(scene.shapes[0].type, "a");
    EXPECT_EQ(scene.shapes[1].type, "b");
}

TEST(ScenesPbrtDirectives, NamesAreComposedUnicode) {
    const std::string apart = "Gru\u0308n", one = "Gr\u00fcn";
    const SceneDescription scene = readWorld(
        "Texture \"" + apart + "\" \"float\" \"constant\" \"string path\" \"" + apart + "\"\n" +
        "MakeNamedMaterial \"" + apart + "\" \"string type\" \"dielectric\" \"texture roughness\" \"" + apart +
        "\"\nNamedMaterial \"" + apart + "\" Shape \"s\"\nObjectBegin \"" + apart + "\" ObjectEnd ObjectInstance \"" +
        apart + "\"");
    EXPECT_EQ(scene.textures.at(0).name, one);
    EXPECT_EQ(scene.textures[0].parameters.text("path", ""), apart) << "files are found by the name they have";
    EXPECT_EQ(scene.namedMaterials.at(0).name, one);
    EXPECT_EQ(scene.namedMaterials[0].parameters.find("texture", "roughness")->strings().front(), one);
    EXPECT_EQ(scene.shapes.at(0).material.name, one);
    EXPECT_EQ(scene.objects.at(0).name, one);
    EXPECT_EQ(scene.instances.at(0).name, one);
}

TEST(ScenesPbrtDirectives, WhatCannotBeADirectiveOrIsNoneTooOftenIsNoScene) {
    Warnings warnings;
    EXPECT_THROW(readSceneText("WorldBegin\n{ \"a\"", "s.pbrt", "", warnings), Error);
    EXPECT_THROW(readSceneText("WorldBegin\nShape-a", "s.pbrt", "", warnings), Error);
    EXPECT_THROW(readSceneText("WorldBegin\n" + std::string(101, 'S'), "s.pbrt", "", warnings), Error);
    std::string many = "WorldBegin";
    for (int i = 0; i < 100; ++i)
        many += "\nNothing";
    readSceneText(many, "s.pbrt", "", warnings);
    EXPECT_THROW(readSceneText(many + "\nNothing", "s.pbrt", "", warnings), Error);
}

TEST(ScenesPbrtDirectives, WarningsAreErrorsWhereStrict) {
    Warnings strict(true);
    try {
        readSceneText("WorldBegin\n WorldEnd", "s.pbrt", "", strict);
        FAIL() << "no error";
    } catch (const Error& e) {
        EXPECT_STREQ(e.what(), "s.pbrt:2:2: WorldEnd is a word of pbrt-v3 and is ignored");
    }
}

TEST(ScenesPbrtDirectives, LargeMeshesKeepEveryNumber) {
    std::string text = "Shape \"trianglemesh\" \"point3 P\" [";
    for (int i = 0; i < 30000; ++i)
        text += std::to_string(i) + (i % 7 == 0 ? ".25\n" : " ");
    text += "] \"integer indices\" [";
    for (int i = 0; i < 30000; ++i)
        text += std::to_string(i) + "\t";
    const SceneDescription scene = readWorld(text + "]");
    const std::vector<float>& points = scene.shapes[0].parameters.numbers("point3", "P");
    ASSERT_EQ(points.size(), 30000u);
    for (int i = 0; i < 30000; ++i)
        ASSERT_EQ(points[i], static_cast<float>(i) + (i % 7 == 0 ? 0.25f : 0.f)) << i;
    const std::vector<std::int32_t>& indices = scene.shapes[0].parameters.integers("indices");
    ASSERT_EQ(indices.size(), 30000u);
    for (int i = 0; i < 30000; ++i)
        ASSERT_EQ(indices[i], i);
}

}  // namespace
}  // namespace penumbra
