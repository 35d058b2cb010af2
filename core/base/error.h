// Error: the one exception of cold code, and the place in a text file that it speaks of.
//
// Conventions: libraries throw Error and never print or exit; main() catches it once and turns `kind` into the
// process's exit code (the sysexits numbers below). Code below Integrator::render never throws: there, failure is data.
#pragma once

#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// What went wrong, as the exit code that main() returns for it.
enum class ErrorKind : int {
    Usage = 64,         ///< the command line is wrong
    BadData = 65,       ///< an input file is wrong
    MissingInput = 66,  ///< an input file cannot be opened
    Internal = 70,      ///< a bug, or bits that ought to be equal are not
    OutOfMemory = 71,
    CannotCreate = 73,  ///< an output file cannot be created
    CannotWrite = 74,   ///< an output file cannot be written whole (full disk)
    NotPermitted = 77,
    Configuration = 78,
};

/// A place in one of the text files of a scene. `file` indexes the table of names that the reader keeps
/// (SceneDescription::files); line and column count from 1; line 0 means "no position".
struct SourcePosition {
    std::uint32_t file = 0, line = 0, column = 0;
};

class Error : public std::exception {
public:
    Error(ErrorKind kind, std::string message) : kind_(kind), message_(std::move(message)) {}
    ErrorKind kind() const noexcept { return kind_; }
    const char* what() const noexcept override { return message_.c_str(); }

private:
    ErrorKind kind_;
    std::string message_;
};

/// "file:line:column", or "file" alone where there is no line. Control characters of the name are escaped.
std::string formatPosition(std::span<const std::string> files, SourcePosition where);

/// An error in a scene's text, thrown by code that does not hold the table of file names (the lexer, ParameterSet).
/// Whoever holds the table catches it and throws placed(files) instead; uncaught it is still an Error, without its
/// place.
class ErrorAt : public Error {
public:
    ErrorAt(SourcePosition where, std::string message, ErrorKind kind = ErrorKind::BadData)
        : Error(kind, std::move(message)), where_(where) {}
    SourcePosition where() const noexcept { return where_; }
    /// "file:line:column: message".
    Error placed(std::span<const std::string> files) const;

private:
    SourcePosition where_;
};

/// Text from a file as a message may show it: in single quotes, cut after `most` bytes, control characters escaped.
std::string quote(std::string_view text, std::size_t most = 60);

/// The names nearest to `name` by edit distance (insert, delete, replace, swap neighbours; case is ignored), best
/// first, at most `most`; empty where none is near enough (more than a third of the letters differ).
std::vector<std::string> nearestNames(std::string_view name, std::span<const std::string> known, std::size_t most = 2);

/// "; did you mean 'diffuse'?", or the list ("; known: a, b, c", at most 50) where nothing is near.
std::string suggestion(std::string_view name, std::span<const std::string> known);

}  // namespace penumbra
