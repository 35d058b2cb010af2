// The program: splits the command line, runs one subcommand, and turns what it throws into messages and exit codes.
// This is the only place that catches everything and the only place that knows exit codes (but for the signal handler).

#include "app/commands/arguments.h"
#include "app/commands/commands.h"
#include "app/commands/console.h"
#include "app/commands/interrupt.h"
#include "app/commands/version.h"

#include <CLI/CLI.hpp>

#include <new>

namespace penumbra {
namespace {

constexpr char kDescription[] = "penumbra: a CPU Monte Carlo path tracer whose pictures carry their error";
constexpr char kFooter[] =
    "penumbra COMMAND --help shows the options of a command.\n"
    "\n"
    "Examples:\n"
    "  penumbra render scene.pbrt -o picture.exr --spp 256\n"
    "  penumbra convert picture.exr picture.png --exposure 1\n"
    "\n"
    "Exit codes: 0 done; 64 wrong command line; 65 wrong input; 66 missing input; 70 internal error;\n"
    "71 out of memory; 73 output cannot be created; 74 output cannot be written; 77 not permitted\n"
    "(--root); 78 wrong configuration; 130, 143 ended by a signal.\n";

void runProgram(int argc, char** argv) {
    CLI::App program(kDescription, "penumbra");
    program.footer(kFooter);
    bool version = false;
    Arguments arguments(program);
    arguments.flag("--version", version, "print the versions of the program and of its libraries");
    arguments.help();
    const Command commands[] = {addRenderCommand(program), addInfoCommand(program), addListCommand(program),
                                addConvertCommand(program)};
    program.allow_extras();
    for (const Command& command : commands)
        command.parser->allow_extras();
    try {
        program.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        const std::vector<CLI::App*> chosen = program.get_subcommands();
        return printOut(helpText(chosen.empty() ? program : *chosen.front()));
    } catch (const CLI::ParseError& e) {
        throw Error(ErrorKind::Usage, e.what());
    }
    rejectUnknownWords(program);
    if (version) return printOut(versionText());
    for (const Command& command : commands)
        if (command.parser->parsed()) return command.run();
    throw Error(ErrorKind::Usage, "a command is missing: penumbra --help lists them");
}

int fail(ErrorKind kind, const std::string& message) {
    printError(message);
    return int(kind);
}

}  // namespace
}  // namespace penumbra

int main(int argc, char** argv) {
    using namespace penumbra;
    prepareConsole();
    installInterrupts();
    try {
        runProgram(argc, argv);
        return 0;
    } catch (const Error& e) {
        return fail(e.kind(), e.what());
    } catch (const Interrupted& e) {
        printError("interrupted: " + e.outcome);
        return 128 + e.signal;
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::OutOfMemory, "out of memory");
    } catch (const std::exception& e) {
        return fail(ErrorKind::Internal, std::string("internal error: ") + e.what());
    }
}
