// DisplayTransform: from the film's linear RGB to the code values of a screen, through OpenColorIO.
//
// The configuration is, in this order: the path given, the file that $OCIO names, or one built in code whose display
// "sRGB" has the views "Standard" (the sRGB curve alone), "ACES" (ACES 1.0 SDR video rendering) and "Raw" (no
// transform). Where a configuration knows ACES2065-1 the film's colours enter through it, so any configuration works
// with any film; otherwise they enter through its scene_linear role unconverted, unless `inputSpace` names the space.
// Thread safety: apply() may be called from several threads.
#pragma once

#include "core/color/color_space.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

struct DisplayOptions {
    std::string config;      ///< path of an OCIO configuration; empty: $OCIO, else the built-in one
    std::string display;     ///< empty: the configuration's default
    std::string view;        ///< empty: the display's default
    std::string inputSpace;  ///< colour space of the configuration in which the pixels are; empty: found as said above
    float exposure = 0;      ///< stops; pixels are multiplied by 2^exposure first
};

class DisplayTransform {
public:
    /// Throws Error: MissingInput or Configuration for the configuration, Usage for an unknown display, view or space
    /// (the message lists those there are).
    DisplayTransform(const DisplayOptions& options, const ColorSpace& film);
    ~DisplayTransform();
    DisplayTransform(DisplayTransform&&) noexcept;
    DisplayTransform& operator=(DisplayTransform&&) noexcept;

    /// Transforms interleaved r g b in place. Values in [0, 1] are in range of the display; none is clamped.
    /// Not-finite values become 0 first.
    void apply(std::span<float> rgb) const;

    const std::string& display() const;
    const std::string& view() const;
    /// "built in", or the path, with "$OCIO" before it where the environment chose it: results depend on it, so say it.
    const std::string& configuration() const;
    /// All three, for people: "display 'sRGB', view 'Standard' of the OpenColorIO configuration built in".
    std::string description() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

struct DisplayList {
    std::string display;
    std::vector<std::string> views;
};
/// What a configuration offers; empty path as in DisplayOptions.
std::vector<DisplayList> listDisplays(const std::string& config);

/// "OpenColorIO 2.1.2", as the library says at run time.
std::string displayLibraryVersion();

}  // namespace penumbra
