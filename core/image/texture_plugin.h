// What a texture class is to the table of textures, and the table as the classes see it.
//
// A texture class is a plain struct (one row of a table) with
//   static constexpr PluginInfo kInfo;
//   static TextureOperand make(TextureInput&, TextureTables&);   // cold; tables.append(row, ...) or a constant
//   template <class V, class F> V evaluate(const TextureContext<F>&, const TextureTables&) const;   // hot
// in a file of its own and an entry in texture_registry.h. V is Spectrum<F> or F. A row holds one texture, so its
// members are the same in all lanes; a group of lanes with several textures is evaluated once for each. Other textures
// are read by tables.value<V>(operand, at). A class whose textures are all constant has no evaluate, and one whose make
// refuses a kind (texture_octaves.h) has it for the other alone.
//
// Thread safety: make from one thread; after that immutable.
#pragma once

#include "core/base/plugin.h"
#include "core/image/texture.h"
#include "core/image/texture_pyramid.h"

#include <initializer_list>
#include <map>
#include <string>
#include <vector>

namespace penumbra {

/// To [0, 1]; NaN becomes 0.
template <class F>
Spectrum<F> clampAlbedo(const Spectrum<F>& c) {
    const F zero(0.f), one(1.f);
    return {clamp(c.r, zero, one), clamp(c.g, zero, one), clamp(c.b, zero, one)};
}

struct TextureRows;  // a vector for each class; texture_registry.h

class TextureTables {
public:
    TextureTables();
    ~TextureTables();

    /// Adds the row, which reads the textures `uses`. Fails (as input) where it would exceed a limit of texture.h.
    template <class T>
    TextureOperand append(const T& row, std::initializer_list<TextureOperand> uses, TextureInput& input);
    /// The row of the operand where it is a T; null otherwise. Valid until the next append.
    template <class T>
    const T* find(const TextureOperand& operand) const;

    /// The image of that file, read at most once for each encoding.
    std::uint32_t addImage(const std::string& path, TransferFunction pngEncoding, TextureInput& input);
    const ImagePyramid& image(std::uint32_t i) const { return images_[i]; }

    template <class V, class F>
    V value(const TextureOperand& operand, const TextureContext<F>& at) const;
    /// a where the weight is 0, b where it is 1, and between and beyond a + (b - a) weight. Where only one counts, only
    /// that is looked up.
    template <class V, class F>
    V blend(const TextureOperand& a, const TextureOperand& b, const F& weight, const TextureContext<F>& at) const;
    /// REQUIRES: id < count().
    template <class V, class F>
    V evaluate(std::uint32_t id, const TextureContext<F>& at) const;
    bool isAlbedo(std::uint32_t id) const { return nodes_[id].albedo; }

    std::size_t count() const { return nodes_.size(); }
    std::size_t imageCount() const { return images_.size(); }
    std::size_t bytes() const;

private:
    struct Node {
        std::uint32_t tag = 0, row = 0;     ///< class and its row
        std::uint32_t depth = 1, cost = 1;  ///< of the tree of textures below it
        bool albedo = false;                ///< values are clamped to [0, 1] for whoever looks them up
    };
    struct LoadedImage {
        TransferFunction pngEncoding;
        std::uint32_t index;
    };

    template <class T>
    std::vector<T>& rows();
    template <class T>
    const std::vector<T>& rows() const;
    TextureOperand appendNode(Node node, std::initializer_list<TextureOperand> uses, TextureInput& input);

    std::unique_ptr<TextureRows> rows_;
    std::vector<Node> nodes_;
    std::vector<ImagePyramid> images_;
    std::multimap<std::string, LoadedImage, std::less<>> loaded_;  ///< by path
};

}  // namespace penumbra
