// Reading the pixels of a job's film, also while it is rendered.
#pragma once

#include "app/batch/render_job.h"

namespace penumbra {

/// Calls visit(number in the window, number in the film) for all pixels of the window (of film coordinates), while
/// nothing changes them; row by row within each tile.
template <class Visit>
void visitPixels(const RenderJob& job, const Tile& window, const Visit& visit) {
    const auto number = [](int x, int y, int width) { return std::size_t(y) * std::size_t(width) + std::size_t(x); };
    const int filmWidth = job.film().crop().width();
    job.visitTiles(window, [&](const Tile& part) {
        for (int y = part.y0; y < part.y1; ++y)
            for (int x = part.x0; x < part.x1; ++x)
                visit(number(x - window.x0, y - window.y0, window.x1 - window.x0), number(x, y, filmWidth));
    });
}

}  // namespace penumbra
