// Materials and textures: names, roles, what stands in for what is not there yet, and what shapes learn of them.
#include "tests/measured_file.h"
#include "tests/scenes_builder_fixture.h"
#include "tests/temporary_folder.h"

#include <cmath>

namespace penumbra {
namespace {

const std::string kLight = "LightSource \"point\"\n";

BuiltScene withMaterial(const std::string& material) {
    return buildWorld(kLight + material + "\nShape \"sphere\"");
}

std::string materialError(const std::string& material) {
    return errorOf("WorldBegin\n" + material + "\nShape \"sphere\"");
}

std::uint32_t flagsOf(const BuiltScene& built) {
    return built.scene.geometry.shapes.at(0).flags;
}

template <class M>
M onlyMaterial(const BuiltScene& built) {
    EXPECT_EQ(built.scene.materials.size(), 1u);
    const std::vector<M>& rows = built.scene.materials.rows<M>();
    EXPECT_EQ(rows.size(), 1u) << "it is of another type";
    return rows.empty() ? M{} : rows[0];
}

TEST(MaterialLibrary, TheInitialMaterialIsGrey) {
    const BuiltScene built = withMaterial("");
    EXPECT_EQ(onlyMaterial<DiffuseMaterial>(built).reflectance.constant.g, 0.5f);
    EXPECT_EQ(built.scene.geometry.shapes[0].material, 0u);
}

TEST(MaterialLibrary, NamesMayBeUsedBeforeTheyAreDefined) {
    const BuiltScene built = buildWorld(
        kLight +
        "NamedMaterial \"glass\" Shape \"sphere\" Material \"diffuse\" \"rgb reflectance\" [.1 .2 .3] Shape \"disk\" "
        "MakeNamedMaterial \"glass\" \"string type\" \"dielectric\" \"float eta\" 1.7 "
        "NamedMaterial \"glass\" Shape \"disk\"");
    EXPECT_EQ(built.scene.materials.size(), 2u) << "one for each that is used";
    const auto& shapes = built.scene.geometry.shapes;
    EXPECT_EQ(shapes[0].material, shapes[2].material);
    EXPECT_EQ(built.scene.materials.tag(shapes[0].material), (kTagOf<DielectricMaterial, MaterialTypes>));
    EXPECT_EQ(built.scene.materials.tag(shapes[1].material), (kTagOf<DiffuseMaterial, MaterialTypes>));
    EXPECT_EQ(built.scene.materials.rows<DielectricMaterial>()[0].eta, 1.7f);
    EXPECT_TRUE(built.warnings.all().empty());
}

TEST(MaterialLibrary, UnknownNamesAndTypesNameTheNearest) {
    EXPECT_EQ(materialError("MakeNamedMaterial \"steel\" \"string type\" \"conductor\"\n  NamedMaterial \"stele\""),
              "test.pbrt:3:3: unknown material 'stele'; did you mean 'steel'?");
    EXPECT_EQ(materialError("Material \"difuse\""),
              "test.pbrt:2:1: unknown material 'difuse'; did you mean 'diffuse'?");
    EXPECT_EQ(errorOf("WorldBegin\nMakeNamedMaterial \"unused\" \"string type\" \"conducter\""),
              "test.pbrt:2:1: unknown material 'conducter'; did you mean 'conductor'?");
}

TEST(MaterialLibrary, OldWordsForInterface) {
    for (const char* type : {"interface", "", "none"}) {
        const BuiltScene built = withMaterial("Material \"" + std::string(type) + "\" \"float anything\" 1");
        EXPECT_EQ(built.scene.materials.rows<InterfaceMaterial>().size(), 1u);
        EXPECT_TRUE(built.warnings.all().empty());
    }
}

TEST(MaterialLibrary, StandInsWarnOnceAndTakeWhatTheyKnow) {
    const BuiltScene skin = buildWorld(kLight +
                                       "Material \"subsurface\" \"float roughness\" 0.25\nShape \"sphere\"\n"
                                       "Material \"subsurface\" Shape \"disk\"");
    ASSERT_EQ(skin.scene.materials.rows<DielectricMaterial>().size(), 2u);
    EXPECT_EQ(skin.scene.materials.rows<DielectricMaterial>()[0].uAlpha.constant, 0.5f);
    ASSERT_EQ(skin.warnings.all().size(), 1u);
    EXPECT_EQ(skin.warnings.all()[0],
              "test.pbrt:3:1: the material 'subsurface' is not there yet; 'dielectric' stands in for it");

    EXPECT_EQ(onlyMaterial<DielectricMaterial>(withMaterial("Material \"subsurface\"")).eta, 1.33f);
    EXPECT_EQ(onlyMaterial<DielectricMaterial>(withMaterial("Material \"subsurface\" \"float eta\" 1.5")).eta, 1.5f);
}

TEST(MaterialLibrary, MeasuredOnesComeFromFiles) {
    const TemporaryFolder folder;
    test::MeasuredMetal metal;
    metal.nodes = 4;
    const std::vector<char> bytes = test::measuredFile(metal);
    folder.file("metal.bsdf", std::string_view(bytes.data(), bytes.size()));
    folder.file("text.bsdf", "no measurement");
    const auto with = [&](const std::string& file) {
        return "WorldBegin\nMaterial \"measured\" \"string filename\" \"" + folder.path(file) + "\" Shape \"sphere\"";
    };
    const BuiltScene built = buildWorld(kLight + with("metal.bsdf").substr(11));
    EXPECT_EQ(onlyMaterial<MeasuredMaterial>(built).thetas, 8u);
    EXPECT_EQ(onlyMaterial<MeasuredMaterial>(built).colorWidth, 4u);
    EXPECT_NE(errorOf(with("none.bsdf")).find("test.pbrt:2:21: material 'measured'"), std::string::npos);
    EXPECT_NE(errorOf(with("text.bsdf")).find("test.pbrt:2:1: material 'measured': not a usable tensor file"), std::string::npos);
    EXPECT_NE(materialError("Material \"measured\"").find("needs a file: the parameter \"string filename\""), std::string::npos);
}

TEST(MaterialLibrary, CoatedMetals) {
    const auto metal = onlyMaterial<CoatedConductorMaterial>(
        withMaterial("Material \"coatedconductor\" \"float conductor.roughness\" 0.25 \"float interface.vroughness\" 0.01 "
                     "\"float interface.eta\" 2 \"rgb reflectance\" [.2 .4 .6] \"integer maxdepth\" 7"));
    EXPECT_EQ(metal.MetalRoughness::uAlpha.constant, 0.5f);
    EXPECT_EQ(metal.MetalRoughness::vAlpha.constant, 0.5f);
    EXPECT_EQ(metal.CoatRoughness::uAlpha.constant, 0.f);
    EXPECT_EQ(metal.CoatRoughness::vAlpha.constant, 0.1f);
    EXPECT_EQ(metal.reflectance.constant.b, 0.6f);
    EXPECT_EQ(metal.metalBounces, 4u);
    // eta and k of the metal count relative to the coat.
    const auto copper = onlyMaterial<ConductorMaterial>(withMaterial("Material \"conductor\""));
    const auto coated = onlyMaterial<CoatedConductorMaterial>(withMaterial("Material \"coatedconductor\""));
    EXPECT_NEAR(coated.difference.g, copper.difference.g / 2.25f, 1e-5f);
    EXPECT_NEAR(coated.product.g, copper.product.g / (2.25f * 2.25f), 1e-5f);
}

TEST(MaterialLibrary, HairIsColouredOneWay) {
    const auto hair = [](const std::string& p) { return onlyMaterial<HairMaterial>(withMaterial("Material \"hair\" " + p)); };
    EXPECT_EQ(hair("").by, HairMaterial::Color::Pigment);
    EXPECT_EQ(hair("").eumelanin.constant, 1.3f);
    EXPECT_EQ(hair("\"float pheomelanin\" .2").eumelanin.constant, 0.f);
    EXPECT_EQ(hair("\"rgb color\" [.1 .2 .3]").by, HairMaterial::Color::Reflectance);
    EXPECT_EQ(hair("\"rgb reflectance\" [.1 .2 .3]").color.constant.g, 0.2f);
    const HairMaterial dyed = hair("\"rgb sigma_a\" [.1 2 30] \"float beta_n\" .4 \"float alpha\" 3");
    EXPECT_EQ(dyed.by, HairMaterial::Color::Absorption);
    EXPECT_EQ(dyed.color.constant.b, 30.f);
    EXPECT_EQ(dyed.betaN.constant, 0.4f);
    EXPECT_EQ(dyed.alpha.constant, 3.f);
    EXPECT_NE(withMaterial("Material \"hair\" \"rgb sigma_a\" [1 1 1] \"float eumelanin\" 1").warnings.all().size(), 0u);
    EXPECT_NE(materialError("Material \"hair\" \"float eumelanin\" -1").find("eumelanin must lie between"), std::string::npos);
    EXPECT_NE(materialError("Material \"hair\" \"float eta\" 0").find("eta must lie between"), std::string::npos);
    EXPECT_NE(materialError("Material \"hair\" \"rgb sigma_a\" [-1 0 0]").find("sigma_a"), std::string::npos);
}

TEST(MaterialLibrary, ThinSheetsAndPanes) {
    EXPECT_EQ(onlyMaterial<ThinDielectricMaterial>(withMaterial("Material \"thindielectric\" \"float eta\" 1.3")).eta, 1.3f);
    const auto sheet = onlyMaterial<DiffuseTransmissionMaterial>(
        withMaterial("Material \"diffusetransmission\" \"rgb transmittance\" [.1 .7 .7] \"float scale\" 0.5"));
    EXPECT_EQ(sheet.reflectance.constant.r, 0.25f);
    EXPECT_EQ(sheet.transmittance.constant.r, 0.1f);
    EXPECT_EQ(sheet.scale, 0.5f);
}

/// Materials a (metal), b (paint), c (a border of media), and what else the text names.
std::string mixOf(const std::string& parameters) {
    return "MakeNamedMaterial \"a\" \"string type\" \"conductor\" MakeNamedMaterial \"b\" \"string type\" \"diffuse\" "
           "MakeNamedMaterial \"c\" \"string type\" \"interface\"\n"
           "Material \"mix\" \"string materials\" " +
           parameters;
}

TEST(MaterialLibrary, AMixHasTwoMembersAndAnAmount) {
    const BuiltScene built = withMaterial(mixOf("[\"a\" \"b\"] \"float amount\" 0.2"));
    const MaterialTable& table = built.scene.materials;
    ASSERT_EQ(table.mixes().size(), 1u);
    const MixMaterial& mix = table.mixes()[0];
    EXPECT_EQ(built.scene.geometry.shapes.at(0).material, kMixFlag);
    EXPECT_EQ(table.tag(mix.first), (kTagOf<ConductorMaterial, MaterialTypes>));
    EXPECT_EQ(table.tag(mix.second), (kTagOf<DiffuseMaterial, MaterialTypes>));
    EXPECT_EQ(mix.amount.constant, 0.2f);
    EXPECT_FALSE(table.mixesAreTextured());
    EXPECT_EQ(flagsOf(built) & (kShapeNeedsUv | kShapeNeedsTangent), 0u);
    EXPECT_TRUE(built.warnings.all().empty());
    EXPECT_EQ(withMaterial(mixOf("[\"a\" \"b\"]")).scene.materials.mixes().at(0).amount.constant, 0.5f);
    EXPECT_TRUE(withMaterial(mixOf("[\"a\" \"b\"] \"float amont\" 1")).warnsOf("did you mean 'amount'"));
}

TEST(MaterialLibrary, AMixOfOneAloneIsThatOne) {
    for (const char* amount : {"0", "-1"})
        EXPECT_EQ(withMaterial(mixOf("[\"b\" \"c\"] \"float amount\" " + std::string(amount)))
                      .scene.materials.tag(0), (kTagOf<DiffuseMaterial, MaterialTypes>));
    const BuiltScene built = withMaterial(mixOf("[\"a\" \"b\"] \"float amount\" 1"));
    EXPECT_TRUE(built.scene.materials.mixes().empty());
    const std::uint32_t met = built.scene.geometry.shapes.at(0).material;
    EXPECT_EQ(built.scene.materials.tag(met), (kTagOf<DiffuseMaterial, MaterialTypes>));
}

TEST(MaterialLibrary, MixesNestAndMayBeDefinedInAnyOrder) {
    const BuiltScene built = withMaterial(
        "NamedMaterial \"outer\" Shape \"disk\" NamedMaterial \"inner\" Shape \"disk\"\n"
        "MakeNamedMaterial \"outer\" \"string type\" \"mix\" \"string materials\" [\"inner\" \"paint\"]\n"
        "MakeNamedMaterial \"inner\" \"string type\" \"mix\" \"string materials\" [\"paint\" \"glass\"]\n"
        "MakeNamedMaterial \"paint\" \"string type\" \"diffuse\" MakeNamedMaterial \"glass\" \"string type\" "
        "\"dielectric\" NamedMaterial \"outer\"");
    const MaterialTable& table = built.scene.materials;
    ASSERT_EQ(table.mixes().size(), 2u) << "each is made once";
    EXPECT_EQ(table.size(), 2u);
    const auto& shapes = built.scene.geometry.shapes;
    EXPECT_EQ(shapes[0].material, shapes[2].material);
    EXPECT_NE(shapes[0].material, shapes[1].material);
    EXPECT_EQ(table.mixes()[shapes[0].material & ~kMixFlag].first, shapes[1].material);
    EXPECT_TRUE(built.warnings.all().empty());
}

TEST(MaterialLibrary, AMixNeedsWhatItsMembersNeed) {
    const std::string texture = "Texture \"t\" \"float\" \"checkerboard\" ";
    const BuiltScene mask = withMaterial(texture + mixOf("[\"a\" \"b\"] \"texture amount\" \"t\""));
    EXPECT_TRUE(mask.scene.materials.mixesAreTextured());
    EXPECT_EQ(flagsOf(mask) & (kShapeNeedsUv | kShapeNeedsTangent), kShapeNeedsUv);
    const std::string brushed =
        "MakeNamedMaterial \"d\" \"string type\" \"conductor\" \"float uroughness\" .1 \"texture vroughness\" \"t\"";
    EXPECT_EQ(flagsOf(withMaterial(texture + brushed + mixOf("[\"a\" \"d\"]"))) & (kShapeNeedsUv | kShapeNeedsTangent),
              kShapeNeedsUv | kShapeNeedsTangent);
    const BuiltScene holes = withMaterial(mixOf("[\"b\" \"c\"]") + "\nAreaLightSource \"diffuse\"");
    EXPECT_TRUE(holes.warnsOf("cannot be an area light"));
    EXPECT_FALSE(withMaterial(mixOf("[\"a\" \"b\"]") + "\nAreaLightSource \"diffuse\"").warnsOf("cannot be"));
}

TEST(MaterialLibrary, MixesThatMakeNoSenseAreErrors) {
    for (const char* members : {"\"a\"", "[\"a\" \"b\" \"c\"]"})
        EXPECT_NE(materialError(mixOf(members)).find("needs the names of two materials"), std::string::npos);
    EXPECT_NE(materialError("Material \"mix\"").find("needs the names of two materials"), std::string::npos);
    EXPECT_NE(materialError(mixOf("[\"a\" \"bb\"]")).find("unknown material 'bb'; known: a, b, c"), std::string::npos);
    const std::string mix = " \"string type\" \"mix\" \"string materials\" ";
    EXPECT_EQ(materialError("MakeNamedMaterial \"m\"" + mix + "[\"m\" \"m\"] NamedMaterial \"m\""),
              "test.pbrt:2:43: the material 'm' refers to itself: 'm' is mixed of 'm'");
    EXPECT_EQ(materialError("MakeNamedMaterial \"k\"" + mix + "[\"m\" \"m\"] MakeNamedMaterial \"m\"" + mix +
                            "[\"b\" \"n\"]\nMakeNamedMaterial \"n\"" + mix +
                            "[\"b\" \"m\"] MakeNamedMaterial \"b\" \"string type\" \"diffuse\" NamedMaterial \"k\""),
              "test.pbrt:3:43: the material 'm' refers to itself: 'm' is mixed of 'n' is mixed of 'm'");
}

TEST(MaterialLibrary, ADeepChainOfMixesIsAnError) {
    std::string chain = "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n";
    for (int i = 1; i < 20000; ++i)
        chain += "MakeNamedMaterial \"m" + std::to_string(i) + "\" \"string type\" \"mix\" \"string materials\" [\"m" +
                 std::to_string(i - 1) + "\" \"m0\"]\n";
    EXPECT_NE(materialError(chain + "NamedMaterial \"m19999\"").find("more than 64 deep"), std::string::npos);
}

TEST(MaterialLibrary, ReadsReliefs) {
    const TemporaryFolder folder;
    folder.file("n.pfm", "PF\n1 1\n-1.0\n" + std::string(12, '\0'));
    const std::string textures =
        "Texture \"t\" \"float\" \"fbm\" Texture \"c\" \"float\" \"constant\" \"float value\" 3\n";
    const auto reliefOf = [&](const std::string& parameters) {
        const BuiltScene built = buildWorld(
            kLight + textures + "Material \"diffuse\" " + parameters + " Shape \"sphere\"", folder.path(""));
        EXPECT_TRUE(built.warnings.all().empty()) << parameters;
        const ShapeRecord& shape = built.scene.geometry.shapes[0];
        const bool hasRelief = built.scene.materials.hasRelief<DiffuseMaterial>();
        EXPECT_EQ(shape.flags & kShapeNeedsUv, hasRelief ? kShapeNeedsUv : 0u);
        if (!hasRelief) return std::string("flat");
        const auto relief = built.scene.materials.reliefs<float>(shape.material);
        return std::string(relief(&ReliefRecord::displacement) != kNoTexture ? "raised " : "") +
               (relief(&ReliefRecord::normalMap) != kNoTexture ? "mapped" : "");
    };
    EXPECT_EQ(reliefOf(""), "flat");
    EXPECT_EQ(reliefOf("\"float displacement\" 2"), "flat");
    EXPECT_EQ(reliefOf("\"texture displacement\" \"c\""), "flat");
    EXPECT_EQ(reliefOf("\"texture displacement\" \"t\""), "raised ");
    EXPECT_EQ(reliefOf("\"string normalmap\" \"n.pfm\""), "mapped");
    EXPECT_EQ(reliefOf("\"texture displacement\" \"t\" \"string normalmap\" \"n.pfm\""), "mapped");  // the map wins
}

TEST(MaterialLibrary, AReliefBelongsToItsMaterialAlone) {
    const BuiltScene built = buildWorld(
        kLight + "Texture \"t\" \"float\" \"fbm\"\nMaterial \"diffuse\" Shape \"sphere\"\n"
        "Material \"diffuse\" \"texture displacement\" \"t\" Shape \"sphere\" Material \"conductor\" Shape \"sphere\"\n"
        "MakeNamedMaterial \"a\" \"string type\" \"dielectric\" \"texture displacement\" \"t\"\n"
        "MakeNamedMaterial \"b\" \"string type\" \"conductor\"\n"
        "Material \"mix\" \"string materials\" [ \"a\" \"b\" ] Shape \"sphere\"");
    const MaterialTable& m = built.scene.materials;
    EXPECT_TRUE(m.hasRelief<DiffuseMaterial>());
    EXPECT_TRUE(m.hasRelief<DielectricMaterial>());
    EXPECT_FALSE(m.hasRelief<ConductorMaterial>());
    const auto& shapes = built.scene.geometry.shapes;
    const auto raised = [&](std::uint32_t id) {
        return m.reliefs<float>(id)(&ReliefRecord::displacement) != kNoTexture;
    };
    EXPECT_FALSE(raised(shapes[0].material));
    EXPECT_TRUE(raised(shapes[1].material));
    EXPECT_FALSE(raised(shapes[2].material));
    EXPECT_TRUE(raised(m.mixes()[0].first));
    EXPECT_FALSE(raised(m.mixes()[0].second));
    EXPECT_TRUE(shapes[3].flags & kShapeNeedsUv);
}

TEST(MaterialLibrary, ErrorsOfReliefs) {
    const TemporaryFolder folder;
    folder.file("grey.pfm", "Pf\n1 1\n-1.0\n" + std::string(4, '\0'));
    const auto error = [&](const std::string& parameters) {
        return errorOf("WorldBegin\n" + kLight + "Material \"diffuse\" " + parameters + " Shape \"sphere\"", {},
                       folder.path(""));
    };
    EXPECT_NE(error("\"string normalmap\" \"gone.png\"").find("gone.png"), std::string::npos);
    EXPECT_NE(error("\"string normalmap\" \"grey.pfm\"").find("has no colours"), std::string::npos);
    EXPECT_NE(error("\"string normalmap\" \"\"").find("normalmap"), std::string::npos);
    EXPECT_NE(error("\"texture displacement\" \"t\"").find("unknown float texture 't'"), std::string::npos);
}

TEST(MaterialLibrary, UnusedParametersWarn) {
    const BuiltScene built = withMaterial("Material \"diffuse\" \"rgb reflectanse\" [1 1 1]");
    EXPECT_TRUE(built.warnsOf(
        "test.pbrt:3:20: parameter 'rgb reflectanse' of material 'diffuse' is unknown; did you mean 'reflectance'?"));
}

TEST(MaterialLibrary, ConductorsAndIndices) {
    const auto index = [](const std::string& p) {
        return onlyMaterial<ConductorMaterial>(withMaterial("Material \"conductor\" " + p));
    };
    // eta 0.2, k 3: eta^2 - k^2 and 4 eta^2 k^2.
    const ConductorMaterial rgb = index("\"rgb eta\" [.2 .2 .2] \"rgb k\" [3 3 3]");
    EXPECT_NEAR(rgb.difference.r, 0.04f - 9, 1e-5);
    EXPECT_NEAR(rgb.product.r, 4 * 0.04f * 9, 1e-5);
    EXPECT_NE(index("\"spectrum eta\" \"metal-Ag-eta\" \"spectrum k\" \"metal-Ag-k\"").difference.r,
              index("").difference.r);
    EXPECT_NE(
        materialError("Material \"conductor\" \"rgb reflectance\" [.5 .5 .5] \"rgb eta\" [1 1 1]").find("not both"),
        std::string::npos);
    const BuiltScene glass = withMaterial("Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"");
    EXPECT_NEAR(onlyMaterial<DielectricMaterial>(glass).eta, 1.51842, 1e-3);
}

struct NeedsCase {
    const char* name;
    const char* material;
    bool uv, tangent;
};
class MaterialNeeds : public testing::TestWithParam<NeedsCase> {};

/// What a material does not look at must not be asked of its shapes: it costs time at every hit.
TEST_P(MaterialNeeds, AreAskedOfShapesAndNoMore) {
    const TemporaryFolder folder;
    folder.file("t.pfm", "PF\n1 1\n-1.0\n" + std::string(12, '\0'));
    const BuiltScene built = buildWorld(kLight + GetParam().material + "\nShape \"sphere\"", folder.path(""));
    EXPECT_EQ((flagsOf(built) & kShapeNeedsUv) != 0, GetParam().uv);
    EXPECT_EQ((flagsOf(built) & kShapeNeedsTangent) != 0, GetParam().tangent);
    EXPECT_TRUE(built.warnings.all().empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, MaterialNeeds,
    testing::Values(NeedsCase{"Constant", "Material \"diffuse\"", false, false},
                    NeedsCase{"Isotropic", "Material \"conductor\" \"float roughness\" 0.3", false, false},
                    NeedsCase{"EqualAxes", "Material \"conductor\" \"float uroughness\" 0.3 \"float vroughness\" 0.3",
                              false, false},
                    NeedsCase{"Anisotropic", "Material \"conductor\" \"float uroughness\" 0.1 \"float vroughness\" 0.3",
                              false, true},
                    NeedsCase{"OneAxis", "Material \"coateddiffuse\" \"float uroughness\" 0.1", false, true},
                    NeedsCase{"Hair", "Material \"hair\"", true, true},
                    NeedsCase{"AxisBelow", "Material \"coatedconductor\" \"float conductor.uroughness\" 0.1", false, true},
                    NeedsCase{"CoatedMetal", "Material \"coatedconductor\" \"float conductor.roughness\" 0.1", false, false},
                    NeedsCase{"Image",
                              "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.pfm\" Material "
                              "\"diffuse\" \"texture reflectance\" \"t\"",
                              true, false},
                    NeedsCase{"ConstantTexture",
                              "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [1 0 0] Material \"diffuse\" "
                              "\"texture reflectance\" \"t\"",
                              false, false},
                    NeedsCase{"TexturedAxis",
                              "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"t.pfm\" Material "
                              "\"conductor\" \"texture uroughness\" \"t\"",
                              true, true},
                    NeedsCase{"TexturedBoth",
                              "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"t.pfm\" Material "
                              "\"conductor\" \"texture roughness\" \"t\"",
                              true, false}),
    [](const auto& info) { return info.param.name; });

TEST(TextureLibrary, ConstantsAndScalesFoldIntoMaterials) {
    const BuiltScene built = withMaterial(
        "Texture \"a\" \"spectrum\" \"constant\" \"rgb value\" [.2 .4 .8]\n"
        "Texture \"half\" \"float\" \"constant\" \"float value\" 0.5\n"
        "Texture \"b\" \"spectrum\" \"scale\" \"texture tex\" \"a\" \"texture scale\" \"half\"\n"
        "Material \"diffuse\" \"texture reflectance\" \"b\"");
    EXPECT_FLOAT_EQ(onlyMaterial<DiffuseMaterial>(built).reflectance.constant.b, 0.4f);
    EXPECT_EQ(built.scene.textures.count(), 0u);
}

TEST(TextureLibrary, ATextureIsMadeOnceForEachRole) {
    const TemporaryFolder folder;
    folder.file("t.pfm", "PF\n1 1\n-1.0\n" + std::string(12, '\0'));
    const std::string texture = "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.pfm\"\n";
    const std::string use = "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"\n";
    const BuiltScene built = buildWorld(kLight + texture + use + use, folder.path(""));
    EXPECT_EQ(built.scene.textures.count(), 1u);
    EXPECT_EQ(built.scene.textures.imageCount(), 1u);
    EXPECT_GT(built.scene.facts.textureBytes, 0u);
}

TEST(TextureLibrary, PtexIsRefusedWithAWarning) {
    const BuiltScene built = withMaterial(
        "Texture \"p\" \"spectrum\" \"ptex\" \"string filename\" \"p.ptx\"\n"
        "Material \"diffuse\" \"texture reflectance\" \"p\"");
    EXPECT_EQ(onlyMaterial<DiffuseMaterial>(built).reflectance.constant.g, 0.5f);
    EXPECT_EQ(built.warnings.all().size(), 1u);
    EXPECT_TRUE(built.warnsOf("test.pbrt:3:1: texture 'p': Ptex files are not supported"));
}

TEST(TextureLibrary, ATextureLiesInTheSpaceOfItsDirective) {
    const BuiltScene built = buildWorld(
        kLight + "Translate 5 0 0\nTexture \"t\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3\n"
        "Translate 1 0 0\nMaterial \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"");
    ASSERT_EQ(built.scene.textures.count(), 1u);
    const auto valueAt = [&](float x) {
        return built.scene.textures.spectrum<float>(0, {{0, 0}, 0, {x, 0.5f, 0.5f}, {0, 0, 1}, 0}).r;
    };
    EXPECT_EQ(valueAt(5.5f), 1);
    EXPECT_EQ(valueAt(4.5f), 0);
    EXPECT_TRUE(built.warnings.all().empty());
}

TEST(TextureLibrary, Errors) {
    const std::string use = "\nMaterial \"diffuse\" \"texture reflectance\" \"t\"";
    EXPECT_EQ(materialError("Texture \"u\" \"spectrum\" \"constant\"" + use),
              "test.pbrt:3:20: unknown spectrum texture 't'; known: u");
    EXPECT_NE(materialError("Texture \"t\" \"float\" \"constant\"" + use)
                  .find("needs a spectrum texture, and 't' is one of the other kind"),
              std::string::npos);
    EXPECT_EQ(materialError("Texture \"t\" \"spectrum\" \"imagemapp\""),
              "test.pbrt:2:1: unknown texture class 'imagemapp'; did you mean 'imagemap'?");
    EXPECT_NE(materialError("Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"t\"" + use)
                  .find("the texture 't' refers to itself"),
              std::string::npos);
    const std::string missing =
        materialError("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"no.png\"" + use);
    EXPECT_EQ(missing.rfind("test.pbrt:2:1: texture 't': ", 0), 0u) << missing;
    EXPECT_NE(missing.find("no.png"), std::string::npos) << missing;
}

TEST(TextureLibrary, ADeepChainIsAnError) {
    std::string chain = "Texture \"t0\" \"spectrum\" \"constant\"\n";
    for (int i = 1; i < 20000; ++i)
        chain += "Texture \"t" + std::to_string(i) + "\" \"spectrum\" \"scale\" \"texture tex\" \"t" +
                 std::to_string(i - 1) + "\"\n";
    EXPECT_NE(
        materialError(chain + "Material \"diffuse\" \"texture reflectance\" \"t19999\"").find("more than 64 deep"),
        std::string::npos);
}

}  // namespace
}  // namespace penumbra
