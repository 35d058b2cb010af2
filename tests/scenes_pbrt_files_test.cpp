// Scenes of several files: Include, Import, gzip, and the errors of files.
#include "scenes/readers.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

/// A folder for the files of one test, removed with it. Messages are compared with the folder's name taken out.
class ScenesPbrtFiles : public testing::Test {
protected:
    ScenesPbrtFiles() {
        const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
        folder_ = fs::temp_directory_path() / ("penumbra_" + test + "_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    ~ScenesPbrtFiles() override {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    void write(const std::string& name, std::string_view text) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(path(name), std::ios::binary) << text;
    }
    SceneDescription read(const std::string& name) {
        warnings_ = Warnings();
        return readScene(path(name), warnings_);
    }
    /// "kind message", the folder replaced by nothing.
    std::string errorOf(const std::string& name) {
        try {
            read(name);
        } catch (const Error& e) {
            std::string text = e.what();
            const std::string prefix = folder_.string() + "/";
            for (std::size_t at; (at = text.find(prefix)) != std::string::npos;)
                text.erase(at, prefix.size());
            return std::to_string(static_cast<int>(e.kind())) + " " + text;
        }
        return "no error";
    }

    fs::path folder_;
    Warnings warnings_;
};

std::vector<std::string> typesOf(const std::vector<ShapeEntity>& shapes) {
    std::vector<std::string> types;
    for (const ShapeEntity& s : shapes)
        types.push_back(s.type);
    return types;
}

// `Shape "sphere" "float radius" 2`, compressed by gzip.
constexpr std::string_view kSphereGzip(
    "\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\xff\x0b\xce\x48\x2c\x48\x55\x50\x2a\x2e\xc8\x48\x2d\x4a\x55\x52\x50\x4a\xcb"
    "\xc9"
    "\x4f\x2c\x51\x28\x4a\x4c\xc9\x2c\x2d\x56\x52\x30\xe2\x02\x00\xf9\x8e\x0c\x40\x20\x00\x00\x00",
    52);

TEST_F(ScenesPbrtFiles, AnIncludedFileMayEndInsideADirective) {
    write("top.pbrt", "WorldBegin Include \"parts/mesh.pbrt\"\n 4 5 6 ] \"float alpha\" 1 Shape \"after\"");
    write("parts/mesh.pbrt", "Shape \"trianglemesh\"\n\"point3 P\" [ 1 2 3");
    const SceneDescription scene = read("top.pbrt");
    ASSERT_EQ(typesOf(scene.shapes), (std::vector<std::string>{"trianglemesh", "after"}));
    EXPECT_EQ(scene.shapes[0].parameters.numbers("point3", "P"), (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(scene.shapes[0].parameters.number("alpha", 0), 1);
    EXPECT_EQ(scene.position(scene.shapes[0].where), path("parts/mesh.pbrt") + ":1:1");
    EXPECT_EQ(scene.position(scene.shapes[0].parameters.findAny("alpha")->where), path("top.pbrt") + ":2:10");
}

TEST_F(ScenesPbrtFiles, NamesResolveAgainstTheTopFilesFolder) {
    write("top.pbrt", "WorldBegin Include \"parts/a.pbrt\"");
    write("parts/a.pbrt", "Include \"parts/b.pbrt\" Shape \"a\"");
    write("parts/b.pbrt", "Shape \"b\"");
    const SceneDescription scene = read("top.pbrt");
    EXPECT_EQ(typesOf(scene.shapes), (std::vector<std::string>{"b", "a"}));
    EXPECT_EQ(resolvePath(scene, "m.ply"), path("m.ply"));
    EXPECT_EQ(resolvePath(scene, "/abs/m.ply"), "/abs/m.ply");
    const fs::path here = fs::current_path();
    fs::current_path(folder_ / "parts");
    EXPECT_EQ(resolvePath(scene, "a.pbrt"), "a.pbrt") << "not beside the top file, but in the working directory";
    EXPECT_EQ(resolvePath(scene, "parts/a.pbrt"), path("parts/a.pbrt"));
    fs::current_path(here);
}

TEST_F(ScenesPbrtFiles, IncludeSharesTheStateImportCopiesIt) {
    write("top.pbrt",
          "WorldBegin CoordinateSystem \"mine\" Translate 1 0 0 Material \"conductor\"\n"
          "Import \"imported.pbrt\" Shape \"after import\" Include \"included.pbrt\" Shape \"after include\"");
    write("imported.pbrt",
          "Shape \"imported\" Translate 1 0 0 Material \"dielectric\" CoordSysTransform \"mine\"\n"
          "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" LightSource \"point\" ObjectBegin \"o\" Shape \"x\" "
          "ObjectEnd");
    write("included.pbrt", "Translate 5 0 0 Material \"interface\"");
    const SceneDescription scene = read("top.pbrt");
    ASSERT_EQ(typesOf(scene.shapes), (std::vector<std::string>{"imported", "after import", "after include"}));
    EXPECT_EQ(scene.shapes[0].material.index, 1);
    EXPECT_EQ(scene.shapes[0].objectToWorld.start.m[0][3], 1);
    EXPECT_EQ(scene.shapes[1].material.index, 1);
    EXPECT_EQ(scene.shapes[1].objectToWorld.start.m[0][3], 1);
    EXPECT_EQ(scene.shapes[2].material.index, 3);
    EXPECT_EQ(scene.shapes[2].objectToWorld.start.m[0][3], 6);
    EXPECT_EQ(scene.namedMaterials.size(), 1u);
    EXPECT_EQ(scene.lights.at(0).lightToWorld.m[0][3], 2);
    EXPECT_EQ(scene.objects.at(0).name, "o");
    ASSERT_EQ(warnings_.all().size(), 1u) << "named coordinate systems are not seen inside";
    EXPECT_TRUE(warnings_.all()[0].starts_with(path("imported.pbrt") + ":1:56: unknown coordinate system 'mine'"));
}

TEST_F(ScenesPbrtFiles, AnImportedFileEndsByItself) {
    write("top.pbrt", "WorldBegin Import \"a.pbrt\" \"float x\" 1");
    write("a.pbrt", "Shape \"a\"");
    EXPECT_EQ(errorOf("top.pbrt"), "65 top.pbrt:1:28: expected a directive, found the string 'float x' after 'Shape'");
    write("a.pbrt", "AttributeEnd");
    EXPECT_EQ(errorOf("top.pbrt"), "65 a.pbrt:1:1: 'AttributeEnd' ends no block, included from top.pbrt:1:19");
    write("a.pbrt", "Import \"b.pbrt\" Shape \"a\"");
    write("b.pbrt", "Include \"c.pbrt\" Shape \"b\"");
    write("c.pbrt", "Shape \"c\"");
    write("top.pbrt", "WorldBegin Import \"a.pbrt\" Shape \"top\"");
    EXPECT_EQ(typesOf(read("top.pbrt").shapes), (std::vector<std::string>{"c", "b", "a", "top"}));
}

TEST_F(ScenesPbrtFiles, FilesMayBeIncludedSeveralTimesAndAreListedOnce) {
    write("top.pbrt", "WorldBegin Include \"a.pbrt\" Include \"a.pbrt\" Include \"./a.pbrt\"");
    write("a.pbrt", "Shape \"a\"");
    const SceneDescription scene = read("top.pbrt");
    EXPECT_EQ(scene.shapes.size(), 3u);
    EXPECT_EQ(scene.files.size(), 3u) << "by name as written";
    EXPECT_EQ(scene.shapes[0].where.file, scene.shapes[1].where.file);
}

TEST_F(ScenesPbrtFiles, Compressed) {
    write("top.pbrt", "WorldBegin Include \"s.pbrt.gz\" \"float zmin\" 1");
    write("s.pbrt.gz", kSphereGzip);
    const SceneDescription scene = read("top.pbrt");
    EXPECT_EQ(scene.shapes.at(0).parameters.number("radius", 0), 2);
    EXPECT_EQ(scene.shapes.at(0).parameters.number("zmin", 0), 1);
    write("s.pbrt.gz", kSphereGzip.substr(0, 40));
    EXPECT_TRUE(errorOf("top.pbrt").starts_with("65 top.pbrt:1:20: s.pbrt.gz: the gzip data end too early"))
        << errorOf("top.pbrt");
    EXPECT_EQ(errorOf("s.pbrt.gz"), "65 s.pbrt.gz: the gzip data end too early");
}

TEST_F(ScenesPbrtFiles, MissingFilesTellWhoWantedThem) {
    EXPECT_EQ(errorOf("none.pbrt"), "66 none.pbrt: the file 'none.pbrt' cannot be opened: No such file or directory");
    write("top.pbrt", "WorldBegin\n  Include \"a.pbrt\"");
    write("a.pbrt", "\nInclude \"gone.pbrt\"");
    EXPECT_EQ(
        errorOf("top.pbrt"),
        "66 a.pbrt:2:9: the file 'gone.pbrt' cannot be opened: No such file or directory, included from top.pbrt:2:11");
    write("a.pbrt", "Include \".\"");
    EXPECT_TRUE(errorOf("top.pbrt").starts_with("65 a.pbrt:1:9: expected a file, but '")) << errorOf("top.pbrt");
    EXPECT_NE(errorOf("top.pbrt").find("is a folder, included from top.pbrt:2:11"), std::string::npos);
    write("a.pbrt", "Include \"" + std::string(100000, 'x') + "\"");
    EXPECT_TRUE(errorOf("top.pbrt").starts_with("66 a.pbrt:1:9: the file 'xxx")) << errorOf("top.pbrt").substr(0, 200);
    EXPECT_LT(errorOf("top.pbrt").size(), 1500u);
    write("a.pbrt", "Include \"/dev/null\"");
    EXPECT_EQ(errorOf("top.pbrt").substr(0, 3), "66 ") << "no regular file is never opened";
}

TEST_F(ScenesPbrtFiles, ErrorsInIncludedTextsTellTheChain) {
    write("top.pbrt", "WorldBegin Include \"a.pbrt\"");
    write("a.pbrt", "# one\n Include \"b.pbrt\"");
    write("b.pbrt", std::string_view("Shape \"x\0\"", 10));
    EXPECT_EQ(
        errorOf("top.pbrt"),
        "65 b.pbrt:1:9: a NUL byte: this is no text in UTF-8, included from a.pbrt:2:10, included from top.pbrt:1:20");
    write("b.pbrt", "Shap! \"x\"");
    EXPECT_EQ(
        errorOf("top.pbrt"),
        "65 b.pbrt:1:1: unknown directive 'Shap!'; did you mean 'Shape'?, included from a.pbrt:2:10, included from "
        "top.pbrt:1:20");
}

TEST_F(ScenesPbrtFiles, CyclesAndDepthEnd) {
    write("self.pbrt", "WorldBegin Include \"self.pbrt\"");
    EXPECT_EQ(errorOf("self.pbrt"),
              "65 self.pbrt:1:20: the file 'self.pbrt' is being read already: it would include itself for ever");
    write("a.pbrt", "WorldBegin Include \"b.pbrt\"");
    write("b.pbrt", "Import \"./a.pbrt\"");
    EXPECT_EQ(
        errorOf("a.pbrt"),
        "65 b.pbrt:1:8: the file './a.pbrt' is being read already: it would include itself for ever, included from "
        "a.pbrt:1:20");
    for (int i = 0; i < 70; ++i)
        write(std::to_string(i) + ".pbrt",
              (i == 0 ? "WorldBegin " : "") + std::string("Include \"") + std::to_string(i + 1) + ".pbrt\"");
    EXPECT_TRUE(errorOf("0.pbrt").starts_with("65 63.pbrt:1:9: files are included more than 64 deep"))
        << errorOf("0.pbrt");
}

TEST_F(ScenesPbrtFiles, DoublingIncludesEnd) {
    // 2^40 copies of the last file, were there no limit.
    const std::string padding(1 << 20, ' ');
    for (int i = 0; i < 40; ++i) {
        const std::string include = "Include \"" + std::to_string(i + 1) + ".pbrt\"\n";
        write(std::to_string(i) + ".pbrt", (i == 0 ? "WorldBegin " : "") + include + include);
    }
    write("40.pbrt", padding);
    EXPECT_NE(errorOf("0.pbrt").find("files are included again and again"), std::string::npos) << errorOf("0.pbrt");
}

TEST_F(ScenesPbrtFiles, NothingOutsideTheRootIsFound) {
    write("in/top.pbrt", "WorldBegin");
    write("in/deep/a.ply", "");
    write("out/b.ply", "");
    fs::create_symlink("../out/b.ply", folder_ / "in/link.ply");
    fs::create_symlink("deep/a.ply", folder_ / "in/inner.ply");
    SceneDescription scene;
    scene.topFile = path("in/top.pbrt");
    scene.root = canonicalRoot(path("in/../in"));
    for (const char* name : {"deep/a.ply", "deep/../deep/./a.ply", "inner.ply", "none.ply", "deep/none/none.ply"})
        EXPECT_EQ(resolvePath(scene, name), path("in/" + std::string(name)));
    EXPECT_EQ(resolvePath(scene, path("in/deep/a.ply")), path("in/deep/a.ply"));
    for (const std::string& name : {std::string("../out/b.ply"), std::string("link.ply"), std::string("/etc/passwd"),
                                    std::string(".."), std::string("deep/../../in2"), path("inside"), path("out/none")})
        try {
            resolvePath(scene, name);
            ADD_FAILURE() << name;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::NotPermitted) << name;
        }
    EXPECT_THROW(canonicalRoot(path("none")), Error);
    EXPECT_THROW(canonicalRoot(path("in/top.pbrt")), Error);
}

TEST_F(ScenesPbrtFiles, ReadersAreChosenByExtension) {
    write("scene", "WorldBegin Shape \"s\"");
    EXPECT_EQ(read("scene").shapes.size(), 1u);
    write("s.pbrt.gz", "WorldBegin Shape \"plain text, whatever the name says\"");
    EXPECT_EQ(read("s.pbrt.gz").shapes.size(), 1u);
    EXPECT_EQ(errorOf("s.pbr"), "65 s.pbr: no reader for scenes of the extension '.pbr'; did you mean '.pbrt'?");
    EXPECT_EQ(errorOf("s.blend.gz"), "65 s.blend.gz: no reader for scenes of the extension '.blend'; known: .pbrt");
}

}  // namespace
}  // namespace penumbra
