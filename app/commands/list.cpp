// penumbra list: what there is, from the registries: names, summaries, parameters.

#include "app/commands/arguments.h"
#include "app/commands/commands.h"
#include "app/commands/console.h"
#include "core/camera/registry.h"
#include "core/film/aov.h"
#include "core/film/filter.h"
#include "core/image/texture_registry.h"
#include "integrators/registry.h"
#include "lights/registry.h"
#include "materials/registry.h"
#include "samplers/registry.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>

namespace penumbra {
namespace {

constexpr char kExamples[] =
    "Examples:\n"
    "  penumbra list                    all kinds, a line a name\n"
    "  penumbra list materials          the materials\n"
    "  penumbra list samplers sobol     one sampler with its parameters\n"
    "  penumbra list lights --verbose   all lights with their parameters\n";

struct Kind {
    std::string name;
    std::vector<PluginInfo> plugins;
};

template <class... Ts>
std::vector<PluginInfo> pluginsOf(TypeList<Ts...>) {
    return {Ts::kInfo...};
}

std::vector<Kind> kinds() {
    const std::span<const PluginInfo> filters = filterPlugins(), aovs = aovPlugins();
    return {{"integrators", pluginsOf(IntegratorTypes{})},
            {"samplers", pluginsOf(SamplerTypes{})},
            {"cameras", pluginsOf(CameraTypes{})},
            {"filters", {filters.begin(), filters.end()}},
            {"lights", lightPlugins()},
            {"materials", materialPlugins()},
            {"textures", pluginsOf(TextureTypes{})},
            {"aovs", {aovs.begin(), aovs.end()}}};
}

struct ListRequest {
    std::string kind, name;
    bool verbose = false, json = false;
};

/// Leaves of the list what the name asks for, in the singular or the plural, or by the name of a plug-in.
template <class T>
void keepOnly(std::vector<T>& list, const std::string& what, const std::string& wanted) {
    std::vector<std::string> known;
    for (const T& t : list)
        known.emplace_back(t.name);
    std::erase_if(list, [&](const T& t) { return t.name != wanted && t.name != wanted + "s"; });
    if (list.empty())
        throw Error(ErrorKind::Usage, "unknown " + what + " " + quote(wanted) + suggestion(wanted, known));
}

std::string row(const PluginInfo& plugin, bool withParameters) {
    std::string text = fmt::format("  {:<20} {}\n", plugin.name, plugin.summary);
    if (!withParameters) return text;
    for (const ParameterInfo& p : plugin.parameters)
        text +=
            fmt::format("      {:<26} {:<12} {}\n", fmt::format("\"{} {}\"", p.type, p.name), p.standard, p.meaning);
    return text;
}

std::string asText(const std::vector<Kind>& kinds, bool withParameters) {
    std::string text;
    for (const Kind& kind : kinds) {
        text += (text.empty() ? "" : "\n") + kind.name + "\n";
        for (const PluginInfo& plugin : kind.plugins)
            text += row(plugin, withParameters);
    }
    return text;
}

std::string asJson(const std::vector<Kind>& kinds) {
    using Json = nlohmann::ordered_json;
    Json all = Json::object();
    for (const Kind& kind : kinds)
        for (const PluginInfo& plugin : kind.plugins) {
            Json parameters = Json::array();
            for (const ParameterInfo& p : plugin.parameters)
                parameters.push_back(
                    {{"type", p.type}, {"name", p.name}, {"default", p.standard}, {"meaning", p.meaning}});
            all[kind.name].push_back({{"name", plugin.name}, {"summary", plugin.summary}, {"parameters", parameters}});
        }
    return all.dump(2) + "\n";
}

std::string singular(const std::string& kind) {
    return kind.substr(0, kind.size() - 1);
}

void runList(const ListRequest& request) {
    std::vector<Kind> list = kinds();
    if (!request.kind.empty()) keepOnly(list, "kind", request.kind);
    if (!request.name.empty()) keepOnly(list.front().plugins, singular(list.front().name), request.name);
    printOut(request.json ? asJson(list) : asText(list, request.verbose || !request.name.empty()));
}

}  // namespace

Command addListCommand(CLI::App& program) {
    CLI::App& command =
        *program.add_subcommand("list", "list the samplers, materials, lights ... there are, with their parameters");
    command.footer(kExamples);
    const auto request = std::make_shared<ListRequest>();
    Arguments arguments(command);
    arguments.positional("KIND", request->kind,
                         "integrators, samplers, cameras, filters, lights, materials, textures or aovs (default: all)");
    arguments.positional("NAME", request->name, "one of them, with its parameters and their defaults");
    arguments.flag("--verbose", request->verbose, "parameters and their defaults of all");
    arguments.flag("--json", request->json, "everything as JSON");
    arguments.help();
    return {&command, [request] { runList(*request); }};
}

}  // namespace penumbra
