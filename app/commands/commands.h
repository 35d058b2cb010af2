// The subcommands of the program, one file each.
//
// An addXCommand() declares a subcommand and its options to CLI11; the Command's run() does the work after parsing. It
// throws Error (or Interrupted) and never exits: main.cpp turns that into the exit code.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace penumbra {

struct Command {
    CLI::App* parser;  ///< owned by the program's parser
    std::function<void()> run;
};

Command addRenderCommand(CLI::App& program);
Command addInfoCommand(CLI::App& program);
Command addListCommand(CLI::App& program);
Command addConvertCommand(CLI::App& program);

}  // namespace penumbra
