#include "app/commands/arguments.h"

#include "scenes/description.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>

namespace penumbra {
namespace {

constexpr std::size_t kHelpColumn = 28, kHelpWidth = 100;

/// "--outfile" of "-o,--outfile": how messages name an option.
std::string longName(const std::string& names) {
    return names.substr(names.rfind(',') + 1);
}

[[noreturn]] void refuse(const std::string& names, const std::string& reason) {
    throw Error(ErrorKind::Usage, longName(names) + ": " + reason);
}

/// Lines of at most `width` columns, broken at spaces.
std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
    std::vector<std::string> lines{""};
    std::size_t begin = 0;
    while (begin < text.size()) {
        const std::size_t end = std::min(text.find(' ', begin), text.size());
        const std::string word = text.substr(begin, end - begin);
        if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) lines.emplace_back();
        lines.back() += (lines.back().empty() ? "" : " ") + word;
        begin = end + 1;
    }
    return lines;
}

/// A name with what it means beside it, or below where the name is long.
std::string helpRow(const std::string& name, const std::string& meaning) {
    std::string row = "  " + name;
    bool beside = row.size() + 2 <= kHelpColumn;
    if (!beside) row += '\n';
    for (const std::string& line : wrapped(meaning, kHelpWidth - kHelpColumn)) {
        row += std::string(beside ? kHelpColumn - row.size() : kHelpColumn, ' ') + line + '\n';
        beside = false;
    }
    return row;
}

std::string optionName(const CLI::Option& option) {
    if (option.get_positional()) return option.get_name(true);
    std::string name;
    for (const std::string& s : option.get_snames())
        name += "-" + s + ", ";
    for (const std::string& l : option.get_lnames())
        name += "--" + l + ", ";
    name.resize(name.size() - 2);
    const std::string value = option.get_type_name();
    return name + (value.empty() || value.front() == '[' ? "" : " ") + value;
}

std::string optionRows(const CLI::App& app) {
    std::string words, options, heading;
    for (const CLI::Option* option : app.get_options()) {
        const std::string row = helpRow(optionName(*option), option->get_description());
        if (option->get_positional()) {
            words += row;
            continue;
        }
        if (option->get_group() != heading) options += "\n" + option->get_group() + ":\n";
        heading = option->get_group();
        options += row;
    }
    return (words.empty() ? "" : "\n" + words) + options;
}

std::string commandRows(const CLI::App& program) {
    std::string text;
    for (const CLI::App* command : program.get_subcommands({}))
        text += helpRow(command->get_name(), command->get_description());
    return text.empty() ? text : "\nCommands:\n" + text;
}

/// "penumbra render".
std::string programName(const CLI::App& app) {
    return (app.get_parent() ? app.get_parent()->get_name() + " " : "") + app.get_name();
}

std::string usage(const CLI::App& app) {
    std::string line = "Usage: " + programName(app);
    if (!app.get_subcommands({}).empty()) line += " COMMAND";
    line += " [options]";
    for (const CLI::Option* option : app.get_options())
        if (option->get_positional()) line += " " + option->get_name(true);
    return line + "\n";
}

std::vector<std::string> optionNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& s : option->get_snames())
            names.push_back("-" + s);
        for (const std::string& l : option->get_lnames())
            names.push_back("--" + l);
    }
    return names;
}

void rejectFirst(const CLI::App& app, const std::vector<std::string>& words) {
    if (words.empty()) return;
    const auto option =
        std::find_if(words.begin(), words.end(), [](const std::string& w) { return w.size() > 1 && w[0] == '-'; });
    if (option != words.end()) {
        const std::string name = option->substr(0, option->find('='));
        std::vector<std::string> known = optionNames(app);
        if (nearestNames(name, known).empty()) known.clear();  // fifty options would be no help
        throw Error(ErrorKind::Usage, "unknown option " + quote(name) + suggestion(name, known) + " (" +
                                          programName(app) + " --help lists all)");
    }
    if (app.get_parent()) throw Error(ErrorKind::Usage, "one word too many: " + quote(words.front()));
    std::vector<std::string> known;
    for (const CLI::App* command : app.get_subcommands({}))
        known.push_back(command->get_name());
    throw Error(ErrorKind::Usage, "unknown command " + quote(words.front()) + suggestion(words.front(), known));
}

}  // namespace

void Arguments::help() {
    app_.set_help_flag("-h,--help", "print this help")->group(group_);
}

void Arguments::positional(const std::string& name, std::string& value, const std::string& help) {
    app_.add_option(name, value, help)->take_last();
}

void Arguments::positionals(const std::string& name, std::vector<std::string>& values, const std::string& help) {
    app_.add_option(name, values, help);
}

void Arguments::flag(const std::string& names, bool& value, const std::string& help) {
    app_.add_flag(names, value, help)->group(group_);
}

void Arguments::text(const std::string& names, const std::string& valueName, const std::string& help, Setter set) {
    app_.add_option_function<std::string>(names, std::move(set), help)
        ->type_name(valueName)
        ->take_last()
        ->group(group_);
}

void Arguments::texts(const std::string& names, const std::string& valueName, const std::string& help,
                      std::vector<std::string>& values) {
    app_.add_option(names, values, help)->type_name(valueName)->type_size(1)->allow_extra_args(false)->group(group_);
}

void Arguments::optionalText(const std::string& name, const std::string& otherwise, const std::string& valueName,
                             std::string& value, const std::string& help) {
    // A flag, because an option with an optional value would swallow the word behind it.
    app_.add_flag(name + "{" + otherwise + "}", value, help)->type_name("[=" + valueName + "]")->group(group_);
}

void Arguments::choice(const std::string& names, std::vector<std::string> known, const std::string& help, Setter set) {
    std::string all;
    for (const std::string& name : known)
        all += (all.empty() ? "" : ", ") + name;
    text(names, "NAME", help + ": " + all, [=, set = std::move(set)](const std::string& value) {
        checkName(names, value, known);
        set(value);
    });
}

void Arguments::checkName(const std::string& names, const std::string& value, const std::vector<std::string>& known) {
    if (std::find(known.begin(), known.end(), value) == known.end())
        refuse(names, "unknown name " + quote(value) + suggestion(value, known));
}

void Arguments::real(const std::string& names, const std::string& valueName, double least, double most, float& value,
                     const std::string& help) {
    text(names, valueName, help,
         [=, &value](const std::string& t) { value = float(parseReal(names, t, least, most)); });
}

double Arguments::parseReal(const std::string& names, const std::string& text, double least, double most) {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !(number >= least && number <= most))
        refuse(names, fmt::format("{} is not a number from {} to {}", quote(text), least, most));
    return number;
}

std::vector<std::string> Arguments::split(const std::string& text) {
    std::vector<std::string> words{""};
    for (const char c : text)
        if (c == ',')
            words.emplace_back();
        else
            words.back() += c;
    return words;
}

std::vector<std::string> Arguments::split(const std::string& names, const std::string& text, std::size_t count) {
    std::vector<std::string> words = split(text);
    if (words.size() != count)
        refuse(names,
               fmt::format("{} are {} values; {} are needed, with commas between", quote(text), words.size(), count));
    return words;
}

std::int64_t Arguments::parseWhole(const std::string& names, const std::string& text, WholeRange range) {
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || number < range.least || number > range.most)
        refuse(names, fmt::format("{} is not a whole number from {} to {}", quote(text), range.least, range.most));
    return number;
}

std::pair<int, int> Arguments::parsePair(const std::string& names, const std::string& text, char separator,
                                         WholeRange range) {
    const std::size_t at = text.find(separator);
    if (at == std::string::npos)
        refuse(names, fmt::format("{} are not two whole numbers with '{}' between", quote(text), separator));
    return {int(parseWhole(names, text.substr(0, at), range)), int(parseWhole(names, text.substr(at + 1), range))};
}

void addRootOption(Arguments& arguments, std::string& root) {
    arguments.text("--root", "FOLDER", "read no file outside this folder, links followed (default: files anywhere)",
                   [&root](const std::string& folder) {
                       try {
                           root = canonicalRoot(folder);
                       } catch (const Error& e) {
                           throw Error(e.kind(), std::string("--root: ") + e.what());
                       }
                   });
}

std::string helpText(const CLI::App& app) {
    const std::string footer = app.get_footer();
    return app.get_description() + "\n\n" + usage(app) + commandRows(app) + optionRows(app) +
           (footer.empty() ? "" : "\n" + footer);
}

void rejectUnknownWords(const CLI::App& program) {
    for (const CLI::App* command : program.get_subcommands())
        rejectFirst(*command, command->remaining());
    rejectFirst(program, program.remaining());
}

}  // namespace penumbra
