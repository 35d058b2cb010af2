// The hash of a scene: what changes it and what does not.

#include "app/batch/scene_inputs.h"

#include "scenes/readers.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

namespace penumbra {
namespace {

constexpr char kScene[] =
    "Film \"rgb\" \"string filename\" \"asset.bin\"\n"
    "WorldBegin\n"
    "Include \"part.pbrt\"\n"
    "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"image.png\"\n"
    "Material \"conductor\" \"spectrum eta\" \"eta.spd\" \"spectrum k\" \"metal-Cu-k\"\n";

/// A folder with the scene and all it names. The files need only exist: nothing here loads them.
struct SceneFolder {
    TemporaryFolder folder;
    SceneFolder() {
        folder.file("scene.pbrt", kScene);
        folder.file("part.pbrt", "# nothing\n");
        folder.file("image.png", "pixels");
        folder.file("eta.spd", "400 1");
        folder.file("asset.bin", "the film's own file is no input");
    }
    SceneInputs inputs(const std::string& scene = "scene.pbrt") const {
        Warnings warnings;
        return findSceneInputs(readScene(folder.path(scene), warnings));
    }
};

TEST(SceneInputs, AreTheTextsAndTheFilesThatParametersName) {
    const SceneFolder scene;
    const SceneInputs inputs = scene.inputs();
    EXPECT_EQ(inputs.texts, (std::vector{scene.folder.path("scene.pbrt"), scene.folder.path("part.pbrt")}));
    EXPECT_EQ(std::set(inputs.assets.begin(), inputs.assets.end()),
              (std::set{scene.folder.path("image.png"), scene.folder.path("eta.spd")}));
    EXPECT_EQ(inputs.hash.size(), 64u);
}

TEST(SceneInputs, HashStaysWhereOnlyThePlaceChanges) {
    const SceneFolder here, there;
    EXPECT_EQ(here.inputs().hash, there.inputs().hash);
}

TEST(SceneInputs, HashChangesWithEveryInput) {
    const SceneFolder scene;
    std::set<std::string> hashes{scene.inputs().hash};
    const auto change = [&](const char* name, const std::string& bytes) {
        scene.folder.file(name, bytes);
        EXPECT_TRUE(hashes.insert(scene.inputs().hash).second) << name;
    };
    change("scene.pbrt", std::string(kScene) + "\n");
    change("part.pbrt", "# something\n");
    change("image.png", "others");
    change("eta.spd", "400 2");
    std::filesystem::remove(scene.folder.path("eta.spd"));
    EXPECT_TRUE(hashes.insert(scene.inputs().hash).second) << "removed";
}

TEST(SceneInputs, TheFilesOfTheFilmAreNone) {
    const SceneFolder scene;
    const std::string before = scene.inputs().hash;
    scene.folder.file("asset.bin", "another picture");
    EXPECT_EQ(scene.inputs().hash, before);
}

}  // namespace
}  // namespace penumbra
