// penumbra info: what is in a scene.

#include "app/batch/scene_inputs.h"
#include "app/batch/statistics.h"
#include "app/commands/arguments.h"
#include "app/commands/commands.h"
#include "app/commands/console.h"
#include "app/commands/threads.h"
#include "core/base/parallel.h"
#include "scenes/builder.h"
#include "scenes/readers.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <memory>

namespace penumbra {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kExamples[] =
    "The scene is read and built, but not rendered.\n"
    "\n"
    "Examples:\n"
    "  penumbra info scene.pbrt\n"
    "  penumbra info scene.pbrt --json\n";

struct InfoRequest {
    std::string scene, root;
    int threads = 0;
    bool json = false, strict = false;
};

/// How many there are of each type, by the names that scene files use; types that do not occur are left out.
template <class... Ts, class Count>
Json countsOf(TypeList<Ts...> types, Count&& count) {
    Json counts = Json::object();
    forEachType(types, [&]<class T>() {
        const std::string name(T::kInfo.name);
        if (const std::size_t n = count.template operator()<T>()) counts[name] = counts.value(name, std::size_t(0)) + n;
    });
    return counts;
}

Json materialCounts(const MaterialTable& table) {
    Json counts = countsOf(MaterialTypes{}, [&]<class T>() { return table.rows<T>().size(); });
    if (!table.mixes().empty()) counts[MixMaterial::kInfo.name] = table.mixes().size();
    return counts;
}

Json triple(const Vec3<float>& v) {
    return {v.x, v.y, v.z};
}

Json meshList(const std::vector<MeshFacts>& meshes) {
    Json list = Json::array();
    for (const MeshFacts& mesh : meshes) {
        const MeshTopology& t = mesh.topology;
        list.push_back({{"where", mesh.where},
                        {"type", mesh.type},
                        {"triangles", t.triangles},
                        {"vertices", t.vertices},
                        {"edges", t.edges},
                        {"manifold", t.isManifold()},
                        {"closed", t.isClosed()},
                        {"oriented", t.isOriented()},
                        {"euler_characteristic", t.eulerCharacteristic()},
                        {"components", t.components},
                        {"borders", t.borders},
                        {"border_edges", t.borderEdges},
                        {"crowded_edges", t.crowdedEdges},
                        {"pinched_vertices", t.pinchedVertices},
                        {"turned_edges", t.turnedEdges},
                        {"degenerate_triangles", t.degenerateTriangles}});
    }
    return list;
}

Json facts(const std::string& path, const Scene& scene, const std::vector<MeshFacts>& meshes, const SceneInputs& inputs,
           const Warnings& warnings) {
    const SceneFacts& f = scene.facts;
    const CropWindow& crop = scene.film.crop;
    Json json = {
        {"schema", 1},
        {"scene", path},
        {"scene_sha256", inputs.hash},
        {"files", {{"texts", inputs.texts}, {"assets", inputs.assets}}},
        {"film",
         {{"resolution", {scene.film.width, scene.film.height}},
          {"crop", {crop.x0, crop.y0, crop.x1, crop.y1}},
          {"filename", scene.film.fileName},
          {"color_space", scene.film.colorSpace}}},
        {"sampler",
         {{"type", scene.sampler.info().name}, {"samples_per_pixel", scene.samplesPerPixel}, {"seed", scene.seed}}},
        {"integrator", {{"type", scene.integrator.name}, {"maxdepth", scene.integrator.maxDepth}}},
        {"shapes", f.shapes},
        {"triangles", f.triangles},
        {"dropped_triangles", f.droppedTriangles},
        {"instances", f.instances},
        {"motion", scene.hasMotion},
        {"meshes", meshList(meshes)},
        {"materials", materialCounts(scene.materials)},
        {"lights", countsOf(LightTypes{}, [&]<class T>() { return scene.lights.rows<T>().size(); })},
        {"textures",
         {{"count", scene.textures.count()},
          {"images", scene.textures.imageCount()},
          {"bytes", scene.textures.bytes()}}},
        {"geometry_bytes", scene.geometry.memoryBytes()},
        {"seconds", {{"build", f.buildSeconds}, {"acceleration", f.accelerationSeconds}}},
        {"warnings", warnings.all()},
    };
    const SceneBounds bounds = scene.accelerator.bounds();
    json["bounds"] = bounds.lower.x <= bounds.upper.x
                         ? Json{{"lower", triple(bounds.lower)}, {"upper", triple(bounds.upper)}}
                         : Json();
    return json;
}

/// "2 diffuse, 1 conductor".
std::string countList(const Json& counts) {
    std::string text;
    for (const auto& [name, count] : counts.items())
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count.get<std::size_t>(), name);
    return text.empty() ? "none" : text;
}

/// "3 borders".
std::string counted(const Json& count, const char* one, const char* more) {
    return fmt::format("{} {}", count.get<std::size_t>(), count == 1 ? one : more);
}

/// "closed manifold, 2 components, Euler characteristic 4".
std::string surfaceText(const Json& mesh) {
    std::string text = mesh["closed"] == true     ? "closed manifold"
                       : mesh["manifold"] == true ? "manifold with " + counted(mesh["borders"], "border", "borders")
                                                  : "no manifold";
    const auto fault = [&](const char* name, const char* one, const char* more) {
        if (mesh[name] != 0) text += ", " + counted(mesh[name], one, more);
    };
    fault("crowded_edges", "edge of more than two triangles", "edges of more than two triangles");
    fault("pinched_vertices", "vertex where parts merely touch", "vertices where parts merely touch");
    fault("turned_edges", "edge between triangles that face opposite ways", "edges between triangles that face opposite ways");
    fault("degenerate_triangles", "degenerate triangle", "degenerate triangles");
    if (mesh["components"] != 1) text += ", " + counted(mesh["components"], "component", "components");
    return text + fmt::format(", Euler characteristic {}", mesh["euler_characteristic"].get<std::int64_t>());
}

std::string asText(const Json& j) {
    std::string text;
    const auto line = [&](const char* name, const std::string& value) {
        text += fmt::format("{:<12} {}\n", name, value);
    };
    const auto number = [](const Json& value) { return value.get<double>(); };
    const Json& film = j["film"];
    line("scene", j["scene"].get<std::string>());
    line("hash", j["scene_sha256"].get<std::string>());
    line("files", fmt::format("{} of text, {} of data", j["files"]["texts"].size(), j["files"]["assets"].size()));
    std::string picture = fmt::format("{}x{}, {}", film["resolution"][0].get<int>(), film["resolution"][1].get<int>(),
                                      film["color_space"].get<std::string>());
    const Json whole = {0, 0, film["resolution"][0], film["resolution"][1]};
    if (film["crop"] != whole) picture += ", crop " + film["crop"].dump();
    line("picture", picture + ", to " + film["filename"].get<std::string>());
    line("sampler",
         fmt::format("{}, {} samples per pixel, seed {}", j["sampler"]["type"].get<std::string>(),
                     j["sampler"]["samples_per_pixel"].get<int>(), j["sampler"]["seed"].get<std::uint32_t>()));
    line("integrator", fmt::format("{}, maxdepth {}", j["integrator"]["type"].get<std::string>(),
                                   j["integrator"]["maxdepth"].get<int>()));
    line("geometry", fmt::format("{} shapes with {} triangles, {} instances, {}{}", j["shapes"].get<std::size_t>(),
                                 countText(number(j["triangles"])), j["instances"].get<std::size_t>(),
                                 bytesText(number(j["geometry_bytes"])), j["motion"].get<bool>() ? ", moving" : ""));
    if (j["dropped_triangles"] != 0)
        line("", fmt::format("{} degenerate triangles were left out", j["dropped_triangles"].get<std::size_t>()));
    constexpr std::size_t kMostMeshes = 20;
    const Json& meshes = j["meshes"];
    for (std::size_t i = 0; i < meshes.size() && i < kMostMeshes; ++i)
        line(i == 0 ? "meshes" : "",
             fmt::format("{}: {}, {} triangles, {}", meshes[i]["where"].get<std::string>(), meshes[i]["type"].get<std::string>(),
                         countText(number(meshes[i]["triangles"])), surfaceText(meshes[i])));
    if (meshes.size() > kMostMeshes) line("", fmt::format("and {} more, which --json lists", meshes.size() - kMostMeshes));
    line("bounds",
         j["bounds"].is_null() ? "nothing to see" : j["bounds"]["lower"].dump() + " to " + j["bounds"]["upper"].dump());
    line("materials", countList(j["materials"]));
    line("lights", countList(j["lights"]));
    line("textures",
         fmt::format("{} from {} images, {}", j["textures"]["count"].get<std::size_t>(),
                     j["textures"]["images"].get<std::size_t>(), bytesText(number(j["textures"]["bytes"]))));
    line("built in", fmt::format("{:.3f} s, and {:.3f} s for the acceleration structure", number(j["seconds"]["build"]),
                                 number(j["seconds"]["acceleration"])));
    line("warnings", std::to_string(j["warnings"].size()));
    return text;
}

void runInfo(const InfoRequest& request) {
    if (request.scene.empty()) throw Error(ErrorKind::Usage, "a scene is missing: penumbra info SCENE");
    const ThreadLimit threads(chooseThreads(request.threads));
    Warnings warnings(request.strict);
    WarningPrinter printer(warnings, false);
    SceneDescription description = readScene(request.scene, warnings, request.root);
    const SceneInputs inputs = findSceneInputs(description);
    std::vector<MeshFacts> meshes;
    BuildOptions options;
    options.meshFacts = &meshes;
    const Scene scene = buildScene(std::move(description), options, warnings);
    const Json json = facts(request.scene, scene, meshes, inputs, warnings);
    printOut(request.json ? json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n" : asText(json));
}

}  // namespace

Command addInfoCommand(CLI::App& program) {
    CLI::App& command = *program.add_subcommand("info", "say what is in a scene, without rendering it");
    command.footer(kExamples);
    const auto request = std::make_shared<InfoRequest>();
    Arguments arguments(command);
    arguments.positional("SCENE", request->scene, "the scene (.pbrt, .pbrt.gz); \"-\" reads standard input");
    arguments.flag("--json", request->json, "as JSON");
    arguments.flag("--strict", request->strict, "warnings are errors");
    addRootOption(arguments, request->root);
    arguments.whole("-t,--nthreads", "N", {1, kMostThreads}, request->threads,
                    "threads (default: $SLURM_CPUS_PER_TASK, $CUE_THREADS, else every processor)");
    arguments.help();
    return {&command, [request] { runInfo(*request); }};
}

}  // namespace penumbra
