#include "core/color/display.h"

#include "core/base/error.h"
#include "core/base/text.h"

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace OCIO = OCIO_NAMESPACE;

namespace penumbra {
namespace {

/// What the library has to say, as one line.
std::string reasonOf(const std::exception& e) {
    std::string text = e.what();
    std::replace_if(text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
    return text;
}

constexpr const char* kAces = "ACES2065-1";
constexpr const char* kScreen = "sRGB";
constexpr const char* kBuiltIn = "built in";

/// The library must not print: what it has to say comes back as exceptions anyhow.
void silenceLibrary() {
    static const bool once = [] {
        OCIO::SetLoggingFunction([](const char*) {});
        return true;
    }();
    (void)once;
}

OCIO::ConstTransformRcPtr builtinTransform(const char* style) {
    OCIO::BuiltinTransformRcPtr transform = OCIO::BuiltinTransform::Create();
    transform->setStyle(style);
    return transform;
}

/// ACES2065-1 to the XYZ that "DISPLAY - CIE-XYZ-D65_to_sRGB" takes, such that our linear sRGB comes out of its matrix
/// unchanged. (OpenColorIO's own transform rounds the white point otherwise: differences of 3e-5.)
OCIO::ConstTransformRcPtr plainTransform() {
    const Matrix3 screenXyz = xyzFromPrimaries({0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290});
    const Matrix3 m = screenXyz * reflectanceConversion(*findColorSpace("aces2065-1"), srgbColorSpace());
    double values[16] = {};
    values[15] = 1;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            values[4 * row + column] = m.m[row][column];
    OCIO::MatrixTransformRcPtr transform = OCIO::MatrixTransform::Create();
    transform->setMatrix(values);
    return transform;
}

void addView(OCIO::Config& config, const char* name, const OCIO::ConstTransformRcPtr& acesToScreenXyz) {
    OCIO::ViewTransformRcPtr view = OCIO::ViewTransform::Create(OCIO::REFERENCE_SPACE_SCENE);
    view->setName(name);
    view->setTransform(acesToScreenXyz, OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE);
    config.addViewTransform(view);
    config.addDisplayView(kScreen, name, name, kScreen, "", "", "");
}

/// Reference is ACES2065-1; the display is reached through CIE XYZ (D65), as in the ACES configurations.
OCIO::ConstConfigRcPtr makeBuiltInConfig() {
    OCIO::ConfigRcPtr config = OCIO::Config::Create();
    config->setVersion(2, 1);  // what OpenColorIO 2.1 understands
    OCIO::ColorSpaceRcPtr aces = OCIO::ColorSpace::Create(OCIO::REFERENCE_SPACE_SCENE);
    aces->setName(kAces);
    config->addColorSpace(aces);
    OCIO::ColorSpaceRcPtr raw = OCIO::ColorSpace::Create(OCIO::REFERENCE_SPACE_SCENE);
    raw->setName("Raw");
    raw->setIsData(true);
    config->addColorSpace(raw);
    OCIO::ColorSpaceRcPtr screen = OCIO::ColorSpace::Create(OCIO::REFERENCE_SPACE_DISPLAY);
    screen->setName(kScreen);
    screen->setTransform(builtinTransform("DISPLAY - CIE-XYZ-D65_to_sRGB"), OCIO::COLORSPACE_DIR_FROM_REFERENCE);
    config->addColorSpace(screen);
    config->setRole(OCIO::ROLE_SCENE_LINEAR, kAces);
    config->setRole(OCIO::ROLE_DEFAULT, "Raw");  // the file rules that every configuration has ask for it

    addView(*config, "Standard", plainTransform());
    addView(*config, "ACES", builtinTransform("ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0"));
    config->addDisplayView(kScreen, "Raw", "Raw", "");
    return config;
}

struct LoadedConfig {
    OCIO::ConstConfigRcPtr config;
    std::string source;
};

LoadedConfig loadConfig(const std::string& given) {
    const char* variable = std::getenv("OCIO");
    const bool fromEnvironment = given.empty() && variable && *variable;
    const std::string path = fromEnvironment ? variable : given;
    silenceLibrary();
    const std::string source = path.empty() ? kBuiltIn : (fromEnvironment ? "$OCIO " : "") + path;
    std::error_code ignored;
    const bool isFile =
        !path.empty() && !path.starts_with("ocio://");  // that prefix names what the library has built in
    if (isFile && !std::filesystem::is_regular_file(path, ignored))
        throw Error(ErrorKind::MissingInput, fmt::format("{}: the OpenColorIO configuration cannot be opened", source));
    try {
        OCIO::ConstConfigRcPtr config = path.empty() ? makeBuiltInConfig() : OCIO::Config::CreateFromFile(path.c_str());
        config->validate();
        return {config, source};
    } catch (const std::exception& e) {
        throw Error(ErrorKind::Configuration, fmt::format("{}: {}", source, reasonOf(e)));
    }
}

std::vector<std::string> displaysOf(const OCIO::Config& config) {
    std::vector<std::string> names;
    for (int i = 0; i < config.getNumDisplays(); ++i)
        names.emplace_back(config.getDisplay(i));
    return names;
}

std::vector<std::string> viewsOf(const OCIO::Config& config, const std::string& display) {
    std::vector<std::string> names;
    for (int i = 0; i < config.getNumViews(display.c_str()); ++i)
        names.emplace_back(config.getView(display.c_str(), i));
    return names;
}

std::vector<std::string> spacesOf(const OCIO::Config& config) {
    std::vector<std::string> names;
    for (int i = 0; i < config.getNumColorSpaces(); ++i)
        names.emplace_back(config.getColorSpaceNameByIndex(i));
    return names;
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names)
        text += (text.empty() ? "" : ", ") + name;
    return text;
}

/// The name in the configuration's spelling, found in any case; the default where none is asked for.
std::string choose(const char* kind, const std::string& wanted, const char* otherwise,
                   const std::vector<std::string>& known, const std::string& source) {
    if (known.empty())
        throw Error(ErrorKind::Configuration, fmt::format("{}: the configuration has no {}", source, kind));
    const std::string name = wanted.empty() ? otherwise : wanted;
    for (const std::string& k : known)
        if (lowerCase(k) == lowerCase(name)) return k;
    throw Error(ErrorKind::Usage, fmt::format("unknown {} {}; those of the OpenColorIO configuration ({}) are: {}",
                                              kind, quote(name), source, joined(known)));
}

/// The space in which pixels enter the configuration, and what takes the film's colours there.
struct Entry {
    std::string space;
    Matrix3 matrix;
};

Entry entryInto(const LoadedConfig& loaded, const std::string& wanted, const ColorSpace& film) {
    const OCIO::Config& config = *loaded.config;
    if (!wanted.empty()) return {choose("colour space", wanted, "", spacesOf(config), loaded.source), {}};
    for (const char* name : {"aces_interchange", kAces, "ACES - ACES2065-1", "aces", "lin_ap0"})
        if (config.getColorSpace(name))  // white to white, as OpenColorIO's own conversions of ACES go
            return {name, reflectanceConversion(film, *findColorSpace("aces2065-1"))};
    if (config.getColorSpace(OCIO::ROLE_SCENE_LINEAR)) return {OCIO::ROLE_SCENE_LINEAR, {}};
    throw Error(
        ErrorKind::Configuration,
        fmt::format(
            "{}: the configuration has neither ACES2065-1 nor a scene_linear role; name the colour space of the "
            "pixels; those of the configuration are: {}",
            loaded.source, joined(spacesOf(config))));
}

/// A view of data shows numbers as they are, so they must not be converted on entry either.
bool showsData(const OCIO::Config& config, const std::string& display, const std::string& view) {
    const OCIO::ConstColorSpaceRcPtr space =
        config.getColorSpace(config.getDisplayViewColorSpaceName(display.c_str(), view.c_str()));
    return space && space->isData();
}

}  // namespace

struct DisplayTransform::State {
    OCIO::ConstCPUProcessorRcPtr processor;
    Matrix3 matrix;  ///< film to the configuration's entry, exposure included
    std::string display, view, source;
};

DisplayTransform::DisplayTransform(const DisplayOptions& options, const ColorSpace& film) : state_(new State) {
    const LoadedConfig loaded = loadConfig(options.config);
    const OCIO::Config& config = *loaded.config;
    try {
        state_->source = loaded.source;
        state_->display =
            choose("display", options.display, config.getDefaultDisplay(), displaysOf(config), loaded.source);
        state_->view = choose("view", options.view, config.getDefaultView(state_->display.c_str()),
                              viewsOf(config, state_->display), loaded.source);
        const Entry entry = entryInto(loaded, options.inputSpace, film);
        const double gain = std::exp2(double(options.exposure));
        state_->matrix = diagonal({gain, gain, gain});
        if (!showsData(config, state_->display, state_->view)) state_->matrix = state_->matrix * entry.matrix;

        OCIO::DisplayViewTransformRcPtr transform = OCIO::DisplayViewTransform::Create();
        transform->setSrc(entry.space.c_str());
        transform->setDisplay(state_->display.c_str());
        transform->setView(state_->view.c_str());
        // Exact arithmetic but for the inversion of look-up tables, which would take minutes.
        constexpr auto kOptimization =
            OCIO::OptimizationFlags(OCIO::OPTIMIZATION_LOSSLESS | OCIO::OPTIMIZATION_LUT_INV_FAST);
        state_->processor = config.getProcessor(transform)->getOptimizedCPUProcessor(kOptimization);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {
        throw Error(ErrorKind::Configuration, fmt::format("{}: {}", loaded.source, reasonOf(e)));
    }
}

DisplayTransform::~DisplayTransform() = default;
DisplayTransform::DisplayTransform(DisplayTransform&&) noexcept = default;
DisplayTransform& DisplayTransform::operator=(DisplayTransform&&) noexcept = default;

void DisplayTransform::apply(std::span<float> rgb) const {
    const std::size_t pixels = rgb.size() / 3;
    for (std::size_t i = 0; i < pixels; ++i) {
        float* p = rgb.data() + 3 * i;
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(p[c])) p[c] = 0;
        const Triple v = state_->matrix * Triple{p[0], p[1], p[2]};
        for (int c = 0; c < 3; ++c)
            p[c] = float(v[c]);
    }
    if (pixels == 0) return;
    // In rows of a bounded length: OpenColorIO's sizes are longs, its scratch memory one row.
    constexpr std::size_t kRow = 4096;
    for (std::size_t first = 0; first < pixels; first += kRow) {
        OCIO::PackedImageDesc row(rgb.data() + 3 * first, long(std::min(kRow, pixels - first)), 1, 3);
        state_->processor->apply(row);
    }
}

const std::string& DisplayTransform::display() const {
    return state_->display;
}
const std::string& DisplayTransform::view() const {
    return state_->view;
}
const std::string& DisplayTransform::configuration() const {
    return state_->source;
}

std::string DisplayTransform::description() const {
    return fmt::format("display {}, view {} of the OpenColorIO configuration {}", quote(display()), quote(view()),
                       configuration());
}

std::vector<DisplayList> listDisplays(const std::string& path) {
    const LoadedConfig loaded = loadConfig(path);
    std::vector<DisplayList> list;
    for (const std::string& display : displaysOf(*loaded.config))
        list.push_back({display, viewsOf(*loaded.config, display)});
    return list;
}

std::string displayLibraryVersion() { return std::string("OpenColorIO ") + OCIO::GetVersion(); }

}  // namespace penumbra
