#include "app/commands/console.h"

#include "core/base/error.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>

namespace penumbra {
namespace {

bool colours() {
    static const bool wanted = [] {
        const char* none = std::getenv("NO_COLOR");
        const char* terminal = std::getenv("TERM");
        return errorIsTerminal() && !(none && *none) && !(terminal && std::strcmp(terminal, "dumb") == 0);
    }();
    return wanted;
}

void printLabelled(std::string_view label, std::string_view colour, std::string_view text) {
    std::string line;
    if (colours()) line += colour;
    line += label;
    if (colours()) line += "\x1b[0m";
    line += text;
    printNote(line);
}

}  // namespace

void prepareConsole() {
    for (int descriptor = 0; descriptor <= 2; ++descriptor)
        if (::fcntl(descriptor, F_GETFD) == -1 && errno == EBADF) {
            // The lowest free number is this one. Standard output opened for reading makes writes fail as they would
            // have.
            const int opened = ::open("/dev/null", descriptor == STDOUT_FILENO ? O_RDONLY : O_WRONLY);
            if (opened != descriptor) std::_Exit(int(ErrorKind::Configuration));
        }
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

bool printTo(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written > 0)
            text.remove_prefix(std::size_t(written));
        else if (errno != EINTR)
            return false;
    }
    return true;
}

void printOut(std::string_view text) {
    if (printTo(STDOUT_FILENO, text) || errno == EPIPE) return;
    throw Error(ErrorKind::CannotWrite, std::string("standard output: ") + std::strerror(errno));
}

void printNote(std::string_view text) {
    printTo(STDERR_FILENO, std::string(text) + "\n");
}
void printWarning(std::string_view text) {
    printLabelled("warning: ", "\x1b[1;33m", text);
}
void printError(std::string_view text) {
    printLabelled("error: ", "\x1b[1;31m", text);
}

bool errorIsTerminal() {
    return ::isatty(STDERR_FILENO) == 1;
}

int errorColumns() {
    winsize size{};
    constexpr int kUnknown = 80;
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUnknown;
}

void WarningPrinter::flush() {
    for (; printed_ < warnings_.all().size(); ++printed_)
        if (!quiet_) printWarning(warnings_.all()[printed_]);
}

}  // namespace penumbra
