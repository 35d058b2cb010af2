// Where the program speaks: standard output for what was asked for, standard error for everything else.
//
// Colours: on a terminal only, and not where NO_COLOR or TERM=dumb asks for none. Errors: what cannot be written to
// standard output is Error(CannotWrite), but a reader that has gone away (EPIPE) is none: it had enough. Standard error
// is written as far as it can be. Thread safety: all functions may be called from several threads; lines stay whole.
#pragma once

#include "core/base/warnings.h"

#include <cstddef>
#include <string_view>

namespace penumbra {

/// Opens the standard descriptors that are closed, so that no picture takes the number of standard error, and ignores
/// SIGPIPE and SIGXFSZ, so that what cannot be written is an error and not the end. Call it first.
void prepareConsole();

void printOut(std::string_view text);
/// To any descriptor; false where not all of it could be written.
bool printTo(int descriptor, std::string_view text);
void printNote(std::string_view text);     ///< a line on standard error, as it is
void printWarning(std::string_view text);  ///< "warning: ..."
void printError(std::string_view text);    ///< "error: ..."

bool errorIsTerminal();
/// Columns of the terminal behind standard error; 80 where unknown.
int errorColumns();

/// Prints the warnings that have come together, at the latest when it goes out of scope, so that they stand before the
/// error that ends the work.
class WarningPrinter {
public:
    WarningPrinter(const Warnings& warnings, bool quiet) : warnings_(warnings), quiet_(quiet) {}
    ~WarningPrinter() { flush(); }
    WarningPrinter(const WarningPrinter&) = delete;
    WarningPrinter& operator=(const WarningPrinter&) = delete;
    void flush();

private:
    const Warnings& warnings_;
    bool quiet_;
    std::size_t printed_ = 0;
};

}  // namespace penumbra
