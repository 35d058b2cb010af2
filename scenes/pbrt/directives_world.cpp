// The directives of the world block: shapes, materials, textures, media, lights, objects and their instances.
#include "scenes/pbrt/parser.h"

namespace penumbra::pbrt {

void Parser::shape() {
    ShapeEntity shape;
    shape.where = where_;
    shape.type = readTypeOf("shape");
    shape.parameters = readParametersWith(Defaults::Shape);
    shape.objectToWorld = state().ctm;
    shape.reverseOrientation = state().reverseOrientation;
    shape.material = state().material;
    shape.areaLight = state().areaLight;
    shape.medium = state().medium;
    chargeNames();
    auto& shapes =
        context_.object >= 0 ? scene_.objects[static_cast<std::size_t>(context_.object)].shapes : scene_.shapes;
    shapes.push_back(std::move(shape));
}

void Parser::material() {
    Entity material;
    material.where = where_;
    material.type = readTypeOf("material");
    material.parameters = readParametersWith(Defaults::Material);
    state().material = {{}, static_cast<int>(scene_.materials.size()), where_};
    scene_.materials.push_back(std::move(material));
}

void Parser::namedMaterial() {
    state().material = {values_.readName("the name of the material"), -1, where_};
}

void Parser::makeNamedMaterial() {
    NamedMaterialEntity material;
    material.where = where_;
    material.name = values_.readName("the name of the material");
    material.parameters = readParametersWith(Defaults::Material);
    material.type = takeTypeParameter(material.parameters, "material");
    define(materials_, material.name, "material");
    scene_.namedMaterials.push_back(std::move(material));
}

void Parser::texture() {
    TextureEntity texture;
    texture.where = where_;
    texture.name = values_.readName("the name of the texture");
    const SourcePosition kindWhere = sources_.peek().where;
    const std::string kind = values_.readString("\"float\" or \"spectrum\"");
    if (kind != "float" && kind != "spectrum" && kind != "color")  // color: the word of pbrt-v3
        throw ErrorAt(kindWhere, "expected \"float\" or \"spectrum\" as the kind of the texture, found " + quote(kind));
    texture.isFloat = kind == "float";
    texture.type = readTypeOf("texture");
    texture.parameters = readParametersWith(Defaults::Texture);
    texture.textureToWorld = state().ctm.start;
    define(texture.isFloat ? floatTextures_ : spectrumTextures_, texture.name,
           texture.isFloat ? "float texture" : "spectrum texture");
    scene_.textures.push_back(std::move(texture));
}

void Parser::makeNamedMedium() {
    NamedMediumEntity medium;
    medium.where = where_;
    medium.name = values_.readName("the name of the medium");
    medium.parameters = readParametersWith(Defaults::Medium);
    medium.type = takeTypeParameter(medium.parameters, "medium");
    medium.mediumToWorld = state().ctm.start;
    define(media_, medium.name, "medium");
    scene_.media.push_back(std::move(medium));
}

void Parser::mediumInterface() {
    MediumReference& medium = state().medium;
    medium.inside = values_.readName("the name of the inside medium");
    medium.outside = values_.stringFollows() ? values_.readName("the name of the outside medium") : medium.inside;
    medium.given = true;
    medium.where = where_;
}

void Parser::lightSource() {
    LightEntity light;
    light.where = where_;
    light.type = readTypeOf("light");
    light.parameters = readParametersWith(Defaults::Light);
    light.lightToWorld = state().ctm.start;
    light.medium = state().medium.outside;
    chargeNames();
    scene_.lights.push_back(std::move(light));
}

void Parser::areaLightSource() {
    Entity light;
    light.where = where_;
    light.type = readTypeOf("area light");
    light.parameters = readParametersWith(Defaults::Light);
    state().areaLight = static_cast<int>(scene_.areaLights.size());
    scene_.areaLights.push_back(std::move(light));
}

void Parser::objectBegin() {
    const std::string name = values_.readName("the name of the object");
    if (context_.object >= 0)
        throw ErrorAt(where_, "'ObjectBegin' inside the object " +
                                  quote(scene_.objects[static_cast<std::size_t>(context_.object)].name));
    openBlock("ObjectBegin", "ObjectEnd");
    define(objects_, name, "object");
    context_.object = static_cast<int>(scene_.objects.size());
    scene_.objects.push_back({name, where_, {}});
}

void Parser::objectEnd() {
    closeBlock();
    context_.object = -1;
}

void Parser::objectInstance() {
    const std::string name = values_.readName("the name of the object");
    if (context_.object >= 0) throw ErrorAt(where_, "'ObjectInstance' inside 'ObjectBegin'");
    scene_.instances.push_back({name, where_, state().ctm});
}

}  // namespace penumbra::pbrt
