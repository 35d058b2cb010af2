// How subcommands declare their options, and the help made from the declarations.
//
// CLI11 splits the command line; what a value may be is checked here, so that every message reads alike:
//     --spp: '1e9x' is not a whole number from 1 to 1073741824
//     --sampler: unknown name 'sobl'; did you mean 'sobol'?
// Errors: Error(Usage). Of an option that is given several times the last counts. Names are written as CLI11 takes them
// ("-o,--outfile"). What a setter refers to must outlive the parsing.
// Thread safety: none.
#pragma once

#include "core/base/error.h"

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace penumbra {

struct WholeRange {
    std::int64_t least, most;
};

class Arguments {
public:
    using Setter = std::function<void(const std::string&)>;

    explicit Arguments(CLI::App& app) : app_(app) {}

    /// The heading of the options that follow in the help.
    void group(const std::string& heading) { group_ = heading; }
    /// -h, --help, in the group that is being declared.
    void help();
    void positional(const std::string& name, std::string& value, const std::string& help);
    void positionals(const std::string& name, std::vector<std::string>& values, const std::string& help);
    void flag(const std::string& names, bool& value, const std::string& help);
    /// `valueName` stands for the value in the help.
    void text(const std::string& names, const std::string& valueName, const std::string& help, Setter set);
    /// One that may be given several times; all values count.
    void texts(const std::string& names, const std::string& valueName, const std::string& help,
               std::vector<std::string>& values);
    /// An option that may stand alone, or with a value behind a '='; alone, the value is `otherwise`.
    void optionalText(const std::string& name, const std::string& otherwise, const std::string& valueName,
                      std::string& value, const std::string& help);
    void choice(const std::string& names, std::vector<std::string> known, const std::string& help, Setter set);
    /// `Value` is a number type, or a std::optional of one.
    template <class Value>
    void whole(const std::string& names, const std::string& valueName, WholeRange range, Value& value,
               const std::string& help) {
        text(names, valueName, help,
             [=, &value](const std::string& t) { value = number<Value>(parseWhole(names, t, range)); });
    }
    void real(const std::string& names, const std::string& valueName, double least, double most, float& value,
              const std::string& help);

    /// Error(Usage) naming the option and the nearest name where `value` is none of those known.
    static void checkName(const std::string& names, const std::string& value, const std::vector<std::string>& known);
    /// `text` is a whole number in the range, else an error that names the option.
    static std::int64_t parseWhole(const std::string& names, const std::string& text, WholeRange range);
    /// A number in the range, likewise.
    static double parseReal(const std::string& names, const std::string& text, double least, double most);
    /// The words between commas.
    static std::vector<std::string> split(const std::string& text);
    /// As many as are asked for.
    static std::vector<std::string> split(const std::string& names, const std::string& text, std::size_t count);
    /// Two whole numbers with the separator between: "640x480".
    static std::pair<int, int> parsePair(const std::string& names, const std::string& text, char separator,
                                         WholeRange range);

private:
    template <class Value>
    static auto number(std::int64_t n) {
        if constexpr (requires { typename Value::value_type; })
            return typename Value::value_type(n);
        else
            return Value(n);
    }

    CLI::App& app_;
    std::string group_ = "Options";
};

/// --root, which confines what a scene may read; `root` gets the folder as SceneDescription::root has it.
void addRootOption(Arguments& arguments, std::string& root);

/// What --help prints: of the program (its commands) or of one command (its options with their defaults).
std::string helpText(const CLI::App& app);

/// Error(Usage) for words that no option took, naming the nearest option or command.
void rejectUnknownWords(const CLI::App& program);

}  // namespace penumbra
