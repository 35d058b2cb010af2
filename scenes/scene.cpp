#include "scenes/scene.h"

namespace penumbra {

const char* rouletteName(RouletteRule rule) {
    switch (rule) {
        case RouletteRule::Late: return "late";
        case RouletteRule::Pbrt: return "pbrt";
        case RouletteRule::Off: return "off";
    }
    return "";
}

const char* strategyName(Strategy strategy) {
    switch (strategy) {
        case Strategy::Mis: return "mis";
        case Strategy::BsdfOnly: return "bsdf";
        case Strategy::LightOnly: return "light";
    }
    return "";
}

}  // namespace penumbra
