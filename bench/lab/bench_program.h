// BenchProgram: what the programs that measure a scene share: the scene and the options that say how it renders,
// --json, messages and exit codes.
//
//     BenchProgram program("ray_roof", "...");
//     program.whole("--rounds", rounds, 1, 1000, "measurements of each");
//     return program.run(argc, argv, [&](RenderJob& job, bool json) { return report(...); });
//
// Results go to standard output, warnings and errors to standard error; exit codes are those of ErrorKind.
//
// Thread safety: none; one a process.
#pragma once

#include "app/batch/render_job.h"

#include <functional>
#include <memory>
#include <string>

namespace CLI {
class App;
}

namespace penumbra {

class BenchProgram {
public:
    BenchProgram(const std::string& name, const std::string& description);
    ~BenchProgram();

    /// An option of this program alone: a whole number; what `value` holds is the default.
    void whole(const std::string& name, int& value, int least, int most, const std::string& help);
    /// Loads the scene and prints what `measure` says of it.
    int run(int argc, char** argv, const std::function<std::string(RenderJob& job, bool json)>& measure);

private:
    void addSceneOptions();
    void measureScene(const std::function<std::string(RenderJob&, bool)>& measure) const;

    std::unique_ptr<CLI::App> app_;
    RenderOptions options_;
    int threads_ = 0;
    bool json_ = false;
};

}  // namespace penumbra
