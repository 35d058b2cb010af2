// Uses the installed package as a program of someone else would: renders the scene that it is given, with what
// app/batch/renderer.h shows, and prints the version and the mean of the picture.
#include <cstdio>
#include <numeric>

#include "app/batch/renderer.h"
#include "core/base/version.h"

int main(int argc, char** argv) {
    if (argc != 3) return 64;
    try {
        penumbra::RendererSettings settings;
        settings.samples = 4;
        settings.width = settings.height = 16;
        penumbra::Renderer renderer(argv[1], settings);
        if (!renderer.render()) return 70;
        renderer.write(argv[2]);
        const penumbra::Picture picture = renderer.picture();
        const double sum = std::accumulate(picture.color.begin(), picture.color.end(), 0.0);
        std::printf("Penumbra %s: mean %.6f\n", penumbra::kVersion, sum / double(picture.color.size()));
        return 0;
    } catch (const penumbra::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return int(error.kind());
    }
}
