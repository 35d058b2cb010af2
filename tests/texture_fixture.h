// What the tests of textures share: a TextureInput without files and scene, small images, and a table with one texture.
#pragma once

#include "core/image/texture.h"
#include "core/image/texture_registry.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <string>
#include <vector>

namespace penumbra::test {

inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Images and textures by name instead of files and a scene.
class Input : public TextureInput {
public:
    explicit Input(TextureKind kind, SpectrumRole role = SpectrumRole::Albedo) : kind_(kind), role_(role) {}

    Input& text(const std::string& name, const std::string& value) {
        return parameter("string", name, std::vector<std::string>{value});
    }
    Input& number(const std::string& name, float value) { return parameter("float", name, std::vector<float>{value}); }
    Input& flag(const std::string& name, bool value) {
        return parameter("bool", name, std::vector<std::uint8_t>{std::uint8_t(value)});
    }
    Input& integer(const std::string& name, int value) {
        return parameter("integer", name, std::vector<std::int32_t>{value});
    }
    Input& vector(const std::string& name, float x, float y, float z) {
        return parameter("vector3", name, std::vector<float>{x, y, z});
    }
    Input& placed(const Matrix4& textureToWorld) {
        place = textureToWorld;
        return *this;
    }
    Input& operand(const std::string& name, const TextureOperand& value) {
        operands_[name] = value;
        return *this;
    }
    Input& file(const std::string& name, const Image& image) {
        text("filename", name);
        files_[name] = image;
        return *this;
    }

    TextureKind kind() const override { return kind_; }
    SpectrumRole role() const override { return role_; }
    const ColorSpace& filmColorSpace() const override { return *film; }
    const Matrix4& textureToWorld() const override { return place; }
    TextureOperand spectrum(std::string_view name, Rgb otherwise) override {
        return find(name, TextureOperand::color(otherwise));
    }
    TextureOperand scalar(std::string_view name, float otherwise) override {
        return find(name, TextureOperand::number(otherwise));
    }
    std::string path(std::string_view name) override {
        const std::string text = parameters_.text(name, "");
        if (text.empty()) fail("no " + std::string(name));
        return text;
    }
    Image image(const std::string& path, TransferFunction) override {
        ++reads;
        const auto found = files_.find(path);
        if (found == files_.end()) throw Error(ErrorKind::MissingInput, path + ": cannot be opened");
        return found->second;
    }
    const ParameterSet& parameters() const override { return parameters_; }
    std::string where() const override { return "test.pbrt:1:1: texture 'tested'"; }
    void warn(const std::string& text) override { warnings.push_back(text); }
    [[noreturn]] void fail(const std::string& text) override { throw Error(ErrorKind::BadData, where() + ": " + text); }

    const ColorSpace* film = &srgbColorSpace();
    Matrix4 place;
    std::vector<std::string> warnings;
    int reads = 0;

private:
    template <class T>
    Input& parameter(const std::string& type, const std::string& name, const T& values) {
        Parameter p;
        p.type = type;
        p.name = name;
        p.values = values;
        parameters_.add(p);
        return *this;
    }
    TextureOperand find(std::string_view name, const TextureOperand& otherwise) const {
        const auto found = operands_.find(std::string(name));
        return found == operands_.end() ? otherwise : found->second;
    }
    TextureKind kind_;
    SpectrumRole role_;
    ParameterSet parameters_;
    std::map<std::string, TextureOperand> operands_;
    std::map<std::string, Image> files_;
};

inline Input numberInput() {
    return Input(TextureKind::Float);
}
inline Input colorInput(SpectrumRole role = SpectrumRole::Albedo) {
    return Input(TextureKind::Spectrum, role);
}

template <class F>
TextureContext<F> at(F u, F v, F footprint = F(0.f)) {
    return {{u, v}, footprint, {F(0.f), F(0.f), F(0.f)}, {F(0.f), F(0.f), F(1.f)}, F(0.f)};
}

/// A place in space, on a surface that faces along n.
template <class F>
TextureContext<F> atPoint(const Vec3<F>& p, const Vec3<F>& n = {F(0.f), F(0.f), F(1.f)}, F width = F(0.f)) {
    return {{F(0.f), F(0.f)}, F(0.f), p, n, width};
}

/// A scene's table with one texture, which is looked up.
struct One {
    Textures textures;
    TextureOperand made;
    One(const char* className, Input input) { made = textures.add(className, input); }
    float number(float u, float v, float footprint = 0) const {
        return textures.scalar<float>(made.texture, at(u, v, footprint));
    }
    float number(const TextureContext<float>& context) const { return textures.scalar<float>(made.texture, context); }
    Spectrum<float> color(const TextureContext<float>& context) const {
        return textures.spectrum<float>(made.texture, context);
    }
    Spectrum<float> color(float u, float v, float footprint = 0) const {
        return textures.spectrum<float>(made.texture, at(u, v, footprint));
    }
};

inline void expectColor(const Spectrum<float>& c, float r, float g, float b, float tolerance = 0) {
    EXPECT_NEAR(c.r, r, tolerance);
    EXPECT_NEAR(c.g, g, tolerance);
    EXPECT_NEAR(c.b, b, tolerance);
}

inline Image grey(int width, int height, std::vector<float> values) {
    return Image(width, height, 1, std::move(values));
}
inline Image bytes(int width, int height, int channels, std::vector<std::uint8_t> values,
            TransferFunction encoding = TransferFunction::linear()) {
    return Image(width, height, channels, std::move(values), encoding);
}

}  // namespace penumbra::test
