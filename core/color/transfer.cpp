#include "core/color/transfer.h"

#include "core/base/text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace penumbra {

float linearFromSrgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float srgbFromLinear(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

std::optional<TransferFunction> TransferFunction::parse(std::string_view text) {
    const std::string lower = lowerCase(text);
    if (lower == "srgb") return srgb();
    if (lower == "linear") return linear();
    constexpr std::string_view kGamma = "gamma ";
    if (!lower.starts_with(kGamma)) return std::nullopt;
    const char* begin = lower.data() + lower.find_first_not_of(' ', kGamma.size() - 1);
    float exponent = 0;
    const auto [end, status] = std::from_chars(begin, lower.data() + lower.size(), exponent);
    const bool whole = status == std::errc() && lower.find_first_not_of(' ', end - lower.data()) == std::string::npos;
    if (!whole || !std::isfinite(exponent) || exponent <= 0) return std::nullopt;
    return gamma(exponent);
}

float TransferFunction::decode(float encoded) const {
    switch (kind_) {
        case Kind::Linear:
            return encoded;
        case Kind::Srgb:
            return linearFromSrgb(encoded);
        case Kind::Gamma:
            return std::pow(encoded, exponent_);
    }
    return encoded;
}

std::array<float, 256> TransferFunction::decodeTable() const {
    std::array<float, 256> table;
    for (int i = 0; i < 256; ++i)
        table[i] = decode(float(i) / 255.f);
    return table;
}

std::string TransferFunction::name() const {
    switch (kind_) {
        case Kind::Linear:
            return "linear";
        case Kind::Srgb:
            return "sRGB";
        case Kind::Gamma:
            return fmt::format("gamma {}", exponent_);
    }
    return {};
}

}  // namespace penumbra
