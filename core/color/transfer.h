// TransferFunction: how stored pixel values in [0, 1] encode linear light.
//
// Source: IEC 61966-2-1 (sRGB).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace penumbra {

float linearFromSrgb(float encoded);
float srgbFromLinear(float linear);

class TransferFunction {
public:
    static TransferFunction linear() { return TransferFunction(Kind::Linear, 1); }
    static TransferFunction srgb() { return TransferFunction(Kind::Srgb, 1); }
    /// linear = encoded^exponent
    static TransferFunction gamma(float exponent) { return TransferFunction(Kind::Gamma, exponent); }
    /// "sRGB", "linear" or "gamma x" (x > 0) of texture parameters; the words in any case. Empty where it is none of
    /// them.
    static std::optional<TransferFunction> parse(std::string_view text);

    float decode(float encoded) const;
    /// decode(i / 255) for every byte.
    std::array<float, 256> decodeTable() const;
    bool isLinear() const { return kind_ == Kind::Linear; }
    std::string name() const;
    friend bool operator==(const TransferFunction&, const TransferFunction&) = default;

private:
    enum class Kind { Linear, Srgb, Gamma };
    TransferFunction(Kind kind, float exponent) : kind_(kind), exponent_(exponent) {}
    Kind kind_;
    float exponent_;
};

}  // namespace penumbra
