// SceneDescription: a scene as its text says it, before anything is loaded or built.
//
// Plain data with source positions. Readers (one file or folder per format) make it; scenes/builder turns it into an
// immutable Scene. Nothing here depends on how scenes are rendered, so a new format touches nothing else.
//
// Conventions: matrices are object-to-world (column vectors) in the pbrt format's left-handed world; the pair holds them at
// the two times of `transformTimes`. Names are resolved late, by the builder, because a file may use a name before its
// definition.
#pragma once

#include "core/base/parameters.h"
#include "core/math/matrix.h"

#include <map>
#include <string>
#include <vector>

namespace penumbra {

struct TransformPair {
    Matrix4 start, end;
    bool animated() const { return !(start == end); }
};

/// One directive with a type and parameters.
struct Entity {
    std::string type;
    ParameterSet parameters;
    SourcePosition where;
};

/// Either a named material (name not empty) or an index into SceneDescription::materials.
struct MaterialReference {
    std::string name;
    int index = -1;
    SourcePosition where;
};

struct MediumReference {
    std::string inside, outside;   ///< names; empty = vacuum
    bool given = false;            ///< a MediumInterface is in force
    SourcePosition where;
};

struct ShapeEntity : Entity {
    TransformPair objectToWorld;
    bool reverseOrientation = false;
    MaterialReference material;
    int areaLight = -1;            ///< index into SceneDescription::areaLights, -1 = none
    MediumReference medium;
};

struct TextureEntity : Entity {    ///< type = class ("imagemap", ...)
    std::string name;
    bool isFloat = false;          ///< "float" textures and "spectrum" textures are two name spaces
    Matrix4 textureToWorld;        ///< CTM at the directive (start time)
};

struct LightEntity : Entity {
    Matrix4 lightToWorld;
    std::string medium;            ///< the outside medium in force
};

struct NamedMediumEntity : Entity {   ///< type = the "string type" parameter
    std::string name;
    Matrix4 mediumToWorld;
};

struct NamedMaterialEntity : Entity { ///< type = the "string type" parameter
    std::string name;
};

struct CameraEntity : Entity {
    TransformPair cameraFromWorld; ///< the CTM at the directive
    std::string medium;            ///< the outside medium in force
};

struct FilmEntity : Entity {
    std::string colorSpace = "srgb";
};

struct ObjectDefinition {
    std::string name;
    SourcePosition where;
    std::vector<ShapeEntity> shapes;
};

struct ObjectInstance {
    std::string name;
    SourcePosition where;
    TransformPair instanceToWorld;  ///< multiplies the shapes' own matrices from the left
};

struct SceneDescription {
    std::string topFile;                    ///< as given; relative names resolve against its folder, then the working directory
    std::string root;                       ///< the only folder that files are read from, as canonicalRoot() gives it; empty: any
    std::vector<std::string> files;         ///< every text file read; SourcePosition::file indexes it
    std::vector<std::string> digests;       ///< SHA-256 of the texts of `files` (inflated), in hexadecimal
    CameraEntity camera;
    FilmEntity film;
    Entity sampler, integrator, filter, accelerator;
    ParameterSet options;                   ///< Option directives, names folded to lower case without '_' and '-'
    double transformTimes[2] = {0, 1};

    std::vector<Entity> materials;          ///< unnamed, in order of their directives (index 0: the initial diffuse 0.5)
    std::vector<NamedMaterialEntity> namedMaterials;
    std::vector<TextureEntity> textures;
    std::vector<NamedMediumEntity> media;
    std::vector<LightEntity> lights;
    std::vector<Entity> areaLights;
    std::vector<ShapeEntity> shapes;
    std::vector<ObjectDefinition> objects;
    std::vector<ObjectInstance> instances;

    std::string position(SourcePosition where) const { return formatPosition(files, where); }
};

/// The file `name` of a scene: as it is if absolute, else in the folder of the top file, else in the working directory.
/// Error(NotPermitted) where that is not inside the scene's root.
std::string resolvePath(const SceneDescription& scene, const std::string& name);

/// The folder as SceneDescription::root wants it: absolute, without links. Error(MissingInput) where it is no folder.
std::string canonicalRoot(const std::string& folder);

/// Error(NotPermitted) where the path, its links followed, is not inside the root; an empty root allows any.
void checkInsideRoot(const std::string& root, const std::string& path);

}  // namespace penumbra
