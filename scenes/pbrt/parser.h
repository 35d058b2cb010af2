// Parser: the directives of a pbrt scene, in order, into a SceneDescription.
//
// Grammar and state only: whether a shape or material of some type exists, and what its parameters mean, is the
// business of whoever builds the scene; names of materials, media, textures and objects are resolved there too. What
// pbrt calls an error at once is an ErrorAt here; what it only reports (an unknown colour space) is a warning, and so
// are a directive that nobody knows (skipped with its values), WorldEnd (of pbrt-v3), an unknown Option, and an
// AttributeBegin that the end of the file closes. Matrices of things that do not move have start == end exactly.
//
// Hostile input: blocks nest at most kDeepestBlocks deep; a text with more than kMostUnknown directives that nobody
// knows, or with words that cannot be directives, is no scene; a matrix without inverse is an error; what a directive
// inherits (Attribute parameters, names) beyond kFreelyInherited bytes may take kMostInherited bytes in all. Thread
// safety: none; one instance reads one scene.
#pragma once

#include "scenes/pbrt/sources.h"
#include "scenes/pbrt/state.h"
#include "scenes/pbrt/values.h"

#include <map>
#include <string>
#include <string_view>

namespace penumbra::pbrt {

class Parser {
public:
    static constexpr std::size_t kDeepestBlocks = 4096;
    static constexpr std::size_t kMostUnknown = 100;
    static constexpr std::uint64_t kFreelyInherited = 1024;
    static constexpr std::uint64_t kMostInherited = std::uint64_t{128} << 20;

    /// All three must outlive this object; a top file is open in `sources`.
    Parser(Sources& sources, SceneDescription& scene, Warnings& warnings)
        : sources_(sources), scene_(scene), warnings_(warnings), values_(sources, scene, warnings) {}

    /// Reads to the end of the top file.
    void run();

private:
    enum class Where { Anywhere, BeforeWorld, InWorld };
    struct Directive {
        std::string_view name;
        Where where;
        void (Parser::*read)();
    };
    static const std::vector<Directive>& directives();
    static const Directive* findDirective(std::string_view name);
    using Names = std::map<std::string, SourcePosition>;

    // parser.cpp: the loop, blocks and what all directives share
    void readDirectives();
    void checkPlace(const Directive& d) const;
    void skipUnknown(const Token& token);
    void closeBlocksAtEnd();
    void openBlock(std::string_view beginsWith, std::string_view endsWith);
    void closeBlock();
    AttributeState& state() { return context_.state; }
    void warn(const std::string& text);
    void define(Names& names, const std::string& name, std::string_view what);
    void charge(std::uint64_t inherited);
    void chargeNames() {
        charge(state().material.name.size() + state().medium.inside.size() + state().medium.outside.size());
    }
    ParameterSet readParameters() { return values_.readParameters(state().colorSpace); }
    ParameterSet readParametersWith(Defaults kind);
    std::string readTypeOf(std::string_view what) { return values_.readString("the type of the " + std::string(what)); }
    Entity readEntity(std::string_view what);
    std::string takeTypeParameter(const ParameterSet& parameters, std::string_view what) const;

    // directives_state.cpp: transforms, blocks, files, attribute state
    void identity();
    void translate();
    void scale();
    void rotate();
    void lookAt();
    void transform();
    void concatTransform();
    void coordinateSystem();
    void coordSysTransform();
    void activeTransform();
    void transformTimes();
    void attributeBegin() { openBlock("AttributeBegin", "AttributeEnd"); }
    void transformBegin() { openBlock("TransformBegin", "TransformEnd"); }
    void attribute();
    void colorSpace();
    void reverseOrientation() { state().reverseOrientation = !state().reverseOrientation; }
    void include();
    void import();
    void multiply(const Matrix4& m);
    Matrix4 readMatrix();
    void checkFinite(const Matrix4& m) const;

    // directives_options.cpp: before WorldBegin
    void camera();
    void film();
    void sampler() { scene_.sampler = readEntity("sampler"); }
    void integrator() { scene_.integrator = readEntity("integrator"); }
    void pixelFilter() { scene_.filter = readEntity("pixel filter"); }
    void accelerator() { scene_.accelerator = readEntity("accelerator"); }
    void option();
    void worldBegin();
    void worldEnd() { warn("WorldEnd is a word of pbrt-v3 and is ignored"); }
    void setDefaults();

    // directives_world.cpp: what is in the world
    void shape();
    void material();
    void namedMaterial();
    void makeNamedMaterial();
    void texture();
    void makeNamedMedium();
    void mediumInterface();
    void lightSource();
    void areaLightSource();
    void objectBegin();
    void objectEnd();
    void objectInstance();

    Sources& sources_;
    SceneDescription& scene_;
    Warnings& warnings_;
    ValueReader values_;
    Context context_;
    std::string_view directive_;  ///< the word of the one being read
    SourcePosition where_;        ///< its place
    SourcePosition worldBegan_;   ///< line 0: not yet
    std::uint64_t inheritedBytes_ = 0;
    std::size_t unknownDirectives_ = 0;
    Names floatTextures_, spectrumTextures_, materials_, media_, objects_;
};

}  // namespace penumbra::pbrt
