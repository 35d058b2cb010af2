// The corpus of bad inputs: its entries, and how one is put to the program.
//
// The tables are scene_text.h, ply.h, images.h and command_line.h beside this file. An entry is what is in a folder, how
// the program must end and what it must say. To add a case, add an entry; tests/bad_input_test.cpp holds each to the
// rules for all of them:
//   - no signal ends the program, and it needs no more than two seconds of processor time (and one for each 100 MB);
//   - it holds at most 256 MB and four times what the files have;
//   - a run that fails writes no picture, and no run changes a file or leaves one behind;
//   - what it says is one line an error or warning, without control characters, and names a file, line and column.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace penumbra::bad_input {

/// The bytes of a file; those of a large one are made when they are needed.
using Content = std::variant<std::string, std::function<std::string()>>;

/// By name: "a/b.ply" is a file, "a/" a folder, "a -> b" a symbolic link to b.
using Files = std::vector<std::pair<std::string, Content>>;

struct Case {
    std::string name;  ///< what is wrong
    Files files;       ///< in the working folder of the program
    int code = 65;     ///< that it must exit with
    std::string says;  ///< how a line of standard error must begin; empty: there must be none
    std::vector<std::string> options{};
    std::vector<std::string> command{"render", "scene.pbrt", "-o", "out.exr"};
    std::vector<std::pair<std::string, std::string>> environment{};
    std::string threads = "2";  ///< empty: none are asked for
    bool hasPlace = true;       ///< what it says names a file, a line and a column
};

/// A scene of one file.
inline Files scene(Content text, Files others = {}) {
    others.emplace_back("scene.pbrt", std::move(text));
    return others;
}

/// What makes a render short; its only line is the first one.
inline const std::string kHead =
    "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 Sampler \"sobol\" \"integer pixelsamples\" 1 ";

/// The text stands in the world block and begins at line 2.
inline Files world(const std::string& text, Files others = {}) {
    return scene(kHead + "WorldBegin LightSource \"infinite\"\n" + text, std::move(others));
}

/// The text stands before the world block and begins at line 2.
inline Files options(const std::string& text) {
    return scene(kHead + "\n" + text + "\nWorldBegin LightSource \"infinite\"");
}

inline std::string repeated(const std::string& text, std::size_t times) {
    std::string out;
    for (std::size_t i = 0; i < times; ++i)
        out += text;
    return out;
}


}  // namespace penumbra::bad_input
