// Bad command lines and surroundings.
#pragma once

#include "tests/bad_input/bad_input.h"

namespace penumbra::bad_input {

/// The small scene, rendered with these options.
inline Case withOptions(const std::string& name, std::vector<std::string> options, const std::string& says, int code = 64) {
    Case c{name, world(""), code, says, std::move(options)};
    c.hasPlace = false;
    return c;
}

/// Every option that takes a value, with values that it does not take.
inline std::vector<Case> optionCases() {
    struct Option {
        const char* name;
        std::vector<const char*> values;
    };
    const std::vector<const char*> noCounts{"", "0", "-1", "1e9x", "4.5", "99999999999999999999", " 4", "nan", "0x10", "+4"};
    const std::vector<Option> numbers{
        {"--spp", noCounts},
        {"--nthreads", noCounts},
        {"--replicates", noCounts},
        {"--resolution", {"", "640", "0x5", "5x0", "-1x5", "5x", "5x5x5", "16777217x1", "5,5"}},
        {"--cropwindow", {"", "0,1,0", "0,1,0,1,0", "0,1,0,2", "-.5,1,0,1", "nan,1,0,1", "0,1,0,", "a,b,c,d", "1,0,0,1", "0,0,0,0"}},
        {"--pixelbounds", {"", "0,1,0", "0,1,0,1.5", "-1,4,0,4", "4,2,0,4", "100,101,0,1"}},
        {"--seed", {"", "-1", "4294967296", "x"}},
        {"--maxdepth", {"", "-1", "100001", "1e3"}},
        {"--clamp", {"", "0", "-1", "nan", "inf", "1e300", "no"}},
        {"--aov", {"", ",", "N,", "Q", "normal"}},
        {"--display-server", {"", ":", "host:", "host:0", "host:65536", "host:-1", "host:1x"}},
        {"--progress", {"", "xml", "json:", "json:-1", "json:x", "json:99999999999", "json:987654"}},
        {"--sampler", {"", "sobl"}},
        {"--integrator", {"", "pat"}},
        {"--roulette", {"", "Late"}},
        {"--strategy", {"", "both"}},
        {"--light-selection", {"", "tree"}},
        {"--light-sampling", {"", "solid"}},
        {"--intersection", {"", "exact"}},
        {"--lanes", {"", "4"}},
    };
    std::vector<Case> cases;
    for (const Option& option : numbers)
        for (const char* value : option.values) {
            const std::string name = std::string(option.name) + " " + value;
            cases.push_back(withOptions(name, {option.name, value}, std::string("error: ") + option.name));
        }
    for (const char* value : {"0", "-1", "nan", "1e99", "soon"})
        cases.push_back(withOptions(std::string("--write-partial=") + value, {std::string("--write-partial=") + value},
                                    "error: --write-partial: '"));
    for (const char* value : {"yaml", "TEXT"})
        cases.push_back(withOptions(std::string("--stats=") + value, {std::string("--stats=") + value}, "error: --stats: unknown form"));
    for (const char* value : {"", "1", "1,", ",1", "-1,0", "1,2,3", "a,b", "99999999999,0"})
        cases.push_back(withOptions(std::string("--pixel ") + value, {"--pixel", value, "--sample", "0"}, "error: --pixel"));
    for (const char* value : {"", "-1", "x", "99999999999"})
        cases.push_back(withOptions(std::string("--sample ") + value, {"--pixel", "0,0", "--sample", value}, "error: --sample"));
    const std::vector<std::pair<const char*, const char*>> overrides{
        {"", "error: -D"},           {"Film", "error: -D"},          {"=", "error: -D"},
        {"Film.=3", "error: -D"},    {".iso=3", "error: -D"},        {"Flim.iso=3", "error: -D"},
        {"Film.iso=", "error: -D"},  {"Film.iso=\n3", "error: -D"},
    };
    for (const auto& [value, says] : overrides)
        cases.push_back(withOptions(std::string("-D ") + value, {"-D", value}, says));
    cases.push_back(withOptions("an option that does not exist", {"--ssp", "4"}, "error: unknown option '--ssp'; did you mean '--spp'?"));
    cases.push_back(withOptions("a long name behind one dash", {"-spp", "4"}, "error: unknown option '-spp'"));
    cases.push_back(withOptions("an option with control characters", {"--\x1b[31m\n"}, "error: unknown option"));
    cases.push_back(withOptions("an option of 100000 characters", {"--" + repeated("a", 100000)}, "error: unknown option"));
    cases.push_back(withOptions("two scenes", {"scene.pbrt"}, "error: one word too many: 'scene.pbrt'"));
    cases.push_back(withOptions("--pixel alone", {"--pixel", "0,0"}, "error: --pixel and --sample belong together"));
    cases.push_back(withOptions("a pixel outside", {"--pixel", "4,0", "--sample", "0"}, "error: pixel 4,0 is outside the picture"));
    cases.push_back(withOptions("a sample that is not rendered", {"--pixel", "0,0", "--sample", "1"}, "error: sample 1 is not rendered"));
    cases.push_back(withOptions("more replicates than samples", {"--replicates", "2"}, "error: 2 replicates need"));
    cases.push_back(withOptions("two crops", {"--cropwindow", "0,1,0,1", "--pixelbounds", "0,1,0,1"}, "error: --cropwindow and --pixelbounds"));
    cases.push_back(withOptions("a picture beyond all memory", {"--resolution", "16777216x16777216"}, "error: scene.pbrt:1:1: a film of", 65));
    cases.push_back(withOptions("AOVs beyond all memory", {"--resolution", "20000x10000", "--aov", "all"}, "error: scene.pbrt:1:1: a film of", 65));
    cases.push_back(withOptions("a root that is not there", {"--root", "no"}, "error: --root: ", 66));
    cases.push_back(withOptions("a root that is a file", {"--root", "scene.pbrt"}, "error: --root: ", 66));
    cases.push_back(withOptions("a partial picture in a device", {"-o", "/dev/null", "--write-partial"}, "error: /dev/null: is no regular file"));
    return cases;
}

/// Pictures where none can be.
inline std::vector<Case> outputCases() {
    const auto output = [](const std::string& name, const std::string& path, const std::string& says, int code = 73, Files others = {}) {
        Case c{name, world("", std::move(others)), code, says, {"-o", path}};
        c.hasPlace = false;
        return c;
    };
    return {
        output("no name", "", "error: '': a picture needs the name of a file"),
        output("a folder", "folder", "error: 'folder': a picture needs the name of a file", 73, {{"folder/", ""}}),
        output("a folder with a slash", "folder/", "error: 'folder/': a picture needs the name of a file", 73, {{"folder/", ""}}),
        output("a folder that looks like a picture", "a.exr", "error: 'a.exr': a picture needs the name of a file", 73, {{"a.exr/", ""}}),
        output("the scene itself", "scene.pbrt", "error: scene.pbrt: is a file of the scene"),
        output("a link to the scene", "a.exr", "error: a.exr: is a file of the scene", 73, {{"a.exr -> scene.pbrt", ""}}),
        output("a link to itself", "a.exr", "error: a.exr: cannot create the file: Too many levels", 73, {{"a.exr -> a.exr", ""}}),
        output("no such folder", "no/a.exr", "error: no/a.exr: there is no folder 'no'"),
        output("a file as a folder", "scene.pbrt/a.exr", "error: scene.pbrt/a.exr: there is no folder"),
        output("a name of 300 characters", repeated("a", 300) + ".exr", "error: " + repeated("a", 200)),
        output("a path of 100000 characters", repeated("a/", 50000) + "a.exr", "error: a/a/a/"),
        output("an unknown kind of picture", "a.qoi", "error: a.qoi: unknown kind of picture", 64),
        output("no kind of picture", "a", "error: a: unknown kind of picture", 64),
        output("a file system that takes no files", "/proc/a.exr", "error: /proc/a.exr: cannot create the file"),
        output("a full device", "/dev/full", "error: /dev/full: cannot write from byte 0 on: No space left", 74),
    };
}

/// What the environment says.
inline std::vector<Case> environmentCases() {
    const auto ocio = [](const std::string& name, const std::string& value, int code, Files others = {}) {
        Case c{name, world("", std::move(others)), code, "error: ", {"-o", "out.png"}};
        c.environment = {{"OCIO", value}};
        c.hasPlace = false;
        return c;
    };
    const auto threads = [](const std::string& value) {
        Case c{"SLURM_CPUS_PER_TASK=" + value, world(""), 0, "warning: SLURM_CPUS_PER_TASK is ", {}};
        c.environment = {{"SLURM_CPUS_PER_TASK", value}};
        c.threads = "";
        c.hasPlace = false;
        return c;
    };
    return {
        ocio("$OCIO that is not there", "no.ocio", 66),
        ocio("$OCIO that is a folder", "folder", 66, {{"folder/", ""}}),
        ocio("$OCIO that is garbage", "c.ocio", 78, {{"c.ocio", "\x01\x02\xff garbage"}}),
        ocio("$OCIO that is empty text", "c.ocio", 78, {{"c.ocio", ""}}),
        ocio("$OCIO with nothing in it", "c.ocio", 78, {{"c.ocio", "ocio_profile_version: 2\n"}}),
        ocio("$OCIO of a later version", "c.ocio", 78, {{"c.ocio", "ocio_profile_version: 99\n"}}),
        ocio("$OCIO of an unknown built-in", "ocio://nothing", 78),
        threads("0"), threads("-3"), threads("many"), threads("99999999999999999999"), threads("2 "),
    };
}

}  // namespace penumbra::bad_input
