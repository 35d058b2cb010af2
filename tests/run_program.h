// Runs the built program as a user does, and keeps what it said and how it ended.
#pragma once

#include "tests/temporary_folder.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace penumbra {

struct ProgramRun {
    int code = 0;  ///< the exit code; 1000 + signal where a signal ended it
    std::string out, err;
    double cpuSeconds = 0;        ///< of all threads
    std::uint64_t peakBytes = 0;  ///< the most memory held at once; not less than the test itself held at the start
};

struct ProgramSurroundings {
    std::string folder;                                            ///< working directory; empty: as it is
    std::vector<std::pair<std::string, std::string>> environment;  ///< set beside what there is
    std::string input;                                             ///< on standard input
    std::function<void()> inChild;                                 ///< called last before the program starts
};

/// A program that has been started. Its outputs go to files, so that it never waits for a reader.
class StartedProgram {
public:
    explicit StartedProgram(const std::vector<std::string>& arguments, const ProgramSurroundings& surroundings = {}) {
        files_.file("in", surroundings.input);
        process_ = ::fork();
        if (process_ == 0) runChild(arguments, surroundings);
    }
    ~StartedProgram() {
        if (process_ <= 0) return;
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
    StartedProgram(const StartedProgram&) = delete;
    StartedProgram& operator=(const StartedProgram&) = delete;

    void signal(int number) const { ::kill(process_, number); }
    /// The program has come so far that it has a handler for the signal.
    bool handles(int number) const {
        std::ifstream status("/proc/" + std::to_string(process_) + "/status");
        for (std::string word; status >> word;)
            if (word == "SigCgt:") {
                std::uint64_t caught = 0;
                status >> std::hex >> caught;
                return caught >> (number - 1) & 1;
            }
        return false;
    }
    std::string errSoFar() const { return readBytes(files_.path("err")); }

    ProgramRun wait() {
        int status = 0;
        rusage used{};
        ::wait4(process_, &status, 0, &used);
        process_ = 0;
        const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), readBytes(files_.path("out")),
                readBytes(files_.path("err")), seconds(used.ru_utime) + seconds(used.ru_stime),
                std::uint64_t(used.ru_maxrss) << 10};
    }

private:
    static void redirect(const std::string& path, int flags, int descriptor) {
        const int opened = ::open(path.c_str(), flags, 0600);
        if (opened < 0 || ::dup2(opened, descriptor) < 0) ::_exit(126);
        ::close(opened);
    }

    [[noreturn]] void runChild(const std::vector<std::string>& arguments,
                               const ProgramSurroundings& surroundings) const {
        redirect(files_.path("in"), O_RDONLY, STDIN_FILENO);
        redirect(files_.path("out"), O_WRONLY | O_CREAT, STDOUT_FILENO);
        redirect(files_.path("err"), O_WRONLY | O_CREAT, STDERR_FILENO);
        for (const char* variable : {"OCIO", "SLURM_CPUS_PER_TASK", "CUE_THREADS"})
            ::unsetenv(variable);
        for (const auto& [name, value] : surroundings.environment)
            ::setenv(name.c_str(), value.c_str(), 1);
        if (!surroundings.folder.empty() && ::chdir(surroundings.folder.c_str()) != 0) ::_exit(126);
        std::vector<char*> words{const_cast<char*>(PENUMBRA_PROGRAM)};
        for (const std::string& word : arguments)
            words.push_back(const_cast<char*>(word.c_str()));
        words.push_back(nullptr);
        if (surroundings.inChild) surroundings.inChild();
        ::execv(PENUMBRA_PROGRAM, words.data());
        ::_exit(127);
    }

    TemporaryFolder files_;
    pid_t process_ = 0;
};

inline ProgramRun runProgram(const std::vector<std::string>& arguments, const ProgramSurroundings& surroundings = {}) {
    return StartedProgram(arguments, surroundings).wait();
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// A lit sphere on nothing, 32 x 24 pixels, 4 samples each, to film.exr.
inline constexpr char kSmallScene[] = R"(
LookAt 0 1 -5  0 0.3 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 32 "integer yresolution" 24 "string filename" "film.exr"
Sampler "sobol" "integer pixelsamples" 4
Integrator "path" "integer maxdepth" 4
WorldBegin
LightSource "infinite" "rgb L" [0.3 0.3 0.4]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [6 5 4]
  Translate 0 2 0
  Shape "sphere" "float radius" 0.3
AttributeEnd
Material "diffuse" "rgb reflectance" [0.6 0.5 0.3]
Shape "sphere" "float radius" 1
)";

}  // namespace penumbra
