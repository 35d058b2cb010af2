#include "core/image/texture.h"

#include "core/image/image_io.h"
#include "core/image/texture_registry.h"

#include <algorithm>

namespace penumbra {
namespace {

template <class V, class F>
V constantOf(const TextureOperand& operand) {
    if constexpr (std::is_same_v<V, F>) {
        return F(operand.constant.r);
    } else {
        return {F(operand.constant.r), F(operand.constant.g), F(operand.constant.b)};
    }
}

/// Calls f(id) for each different texture of the group and puts its values into the lanes that have it.
template <class V, class F, class Function>
V forEachTexture(const UInt<F>& texture, const Function& f) {
    const std::uint32_t first = lane(texture, 0);
    if (all(texture == UInt<F>(first))) return first == kNoTexture ? V{} : f(first);
    V out{};
    Mask<F> active = texture != UInt<F>(kNoTexture);
    while (any(active)) {
        const std::uint32_t id = lane(texture, std::countr_zero(bits(active)));
        const Mask<F> here = active & (texture == UInt<F>(id));
        out = select(here, f(id), out);
        active = active & !here;
    }
    return out;
}

}  // namespace

// ---------------------------------------------------------------------------------------------------- TextureTables

TextureTables::TextureTables() : rows_(std::make_unique<TextureRows>()) {}
TextureTables::~TextureTables() = default;

TextureOperand TextureTables::appendNode(Node node, std::initializer_list<TextureOperand> uses, TextureInput& input) {
    for (const TextureOperand& use : uses) {
        if (use.isConstant()) continue;
        node.depth = std::max(node.depth, nodes_[use.texture].depth + 1);
        node.cost += nodes_[use.texture].cost;
    }
    if (node.depth > kTextureDepthLimit)
        input.fail("textures within textures are more than " + std::to_string(kTextureDepthLimit) + " deep");
    if (node.cost > kTextureCostLimit)
        input.fail("one look-up would evaluate " + std::to_string(node.cost) + " textures; at most " +
                   std::to_string(kTextureCostLimit) + " are allowed");
    node.albedo = input.kind() == TextureKind::Spectrum && input.role() == SpectrumRole::Albedo;
    nodes_.push_back(node);
    return {{}, std::uint32_t(nodes_.size() - 1)};
}

std::uint32_t TextureTables::addImage(const std::string& path, TransferFunction pngEncoding, TextureInput& input) {
    const auto [begin, end] = loaded_.equal_range(path);
    const auto found =
        std::find_if(begin, end, [&](const auto& entry) { return entry.second.pngEncoding == pngEncoding; });
    if (found != end) return found->second.index;
    Image image;
    try {
        image = input.image(path, pngEncoding);
    } catch (const Error& error) {
        throw Error(error.kind(), input.where() + ": " + error.what());
    }
    if (image.isEmpty()) input.fail("the image " + quote(path) + " is empty");
    const auto index = std::uint32_t(images_.size());
    images_.emplace_back(image);
    loaded_.insert({path, {pngEncoding, index}});
    if (const std::size_t count = images_.back().nonFiniteCount(); count != 0)
        input.warn("the image " + quote(path) + " has " + std::to_string(count) +
                   " values that are infinite or not a number; they count as 0");
    return index;
}

std::size_t TextureTables::bytes() const {
    std::size_t sum = nodes_.size() * sizeof(Node);
    forEachType(TextureTypes{}, [&]<class T>() { sum += rows<T>().size() * sizeof(T); });
    for (const ImagePyramid& image : images_)
        sum += image.bytes();
    return sum;
}

template <class V, class F>
V TextureTables::value(const TextureOperand& operand, const TextureContext<F>& at) const {
    return operand.isConstant() ? constantOf<V, F>(operand) : evaluate<V>(operand.texture, at);
}

template <class V, class F>
V TextureTables::blend(const TextureOperand& a, const TextureOperand& b, const F& weight,
                       const TextureContext<F>& at) const {
    const Mask<F> needsA = weight != F(1.f), needsB = weight != F(0.f);
    const V valueA = any(needsA) ? value<V>(a, at) : V{};
    const V valueB = any(needsB) ? value<V>(b, at) : V{};
    return select(!needsB, valueA, select(!needsA, valueB, valueA + (valueB - valueA) * weight));
}

template <class V, class F>
V TextureTables::evaluate(std::uint32_t id, const TextureContext<F>& at) const {
    const Node& node = nodes_[id];
    V out{};
    dispatch(TextureTypes{}, node.tag, [&]<class T>() {
        if constexpr (requires(const T& t) { t.template evaluate<V>(at, *this); })
            out = rows<T>()[node.row].template evaluate<V>(at, *this);
    });
    return out;
}

template float TextureTables::evaluate<float, float>(std::uint32_t, const TextureContext<float>&) const;
template Lanes8f TextureTables::evaluate<Lanes8f, Lanes8f>(std::uint32_t, const TextureContext<Lanes8f>&) const;

// ---------------------------------------------------------------------------------------------------- Textures

Image TextureInput::image(const std::string& path, TransferFunction pngEncoding) {
    ReadImageOptions options;
    options.pngEncoding = pngEncoding;
    return readImage(path, options);
}

Textures::Textures() : tables_(std::make_unique<TextureTables>()) {}
Textures::~Textures() = default;
Textures::Textures(Textures&&) noexcept = default;
Textures& Textures::operator=(Textures&&) noexcept = default;

TextureOperand Textures::add(std::string_view className, TextureInput& input) {
    TextureOperand made;
    forEachType(TextureTypes{}, [&]<class T>() {
        if (T::kInfo.name == className) made = T::make(input, *tables_);
    });
    return made;
}

bool Textures::knows(std::string_view className) {
    bool known = false;
    forEachType(TextureTypes{}, [&]<class T>() { known = known || T::kInfo.name == className; });
    return known;
}

template <class F>
Spectrum<F> Textures::spectrum(const UInt<F>& texture, const TextureContext<F>& at) const {
    return forEachTexture<Spectrum<F>, F>(texture, [&](std::uint32_t id) {
        const Spectrum<F> value = tables_->evaluate<Spectrum<F>>(id, at);
        return tables_->isAlbedo(id) ? clampAlbedo(value) : value;
    });
}

template <class F>
F Textures::scalar(const UInt<F>& texture, const TextureContext<F>& at) const {
    return forEachTexture<F, F>(texture, [&](std::uint32_t id) { return tables_->evaluate<F>(id, at); });
}

template Spectrum<float> Textures::spectrum<float>(const std::uint32_t&, const TextureContext<float>&) const;
template Spectrum<Lanes8f> Textures::spectrum<Lanes8f>(const Lanes8u&, const TextureContext<Lanes8f>&) const;
template float Textures::scalar<float>(const std::uint32_t&, const TextureContext<float>&) const;
template Lanes8f Textures::scalar<Lanes8f>(const Lanes8u&, const TextureContext<Lanes8f>&) const;

std::size_t Textures::count() const {
    return tables_->count();
}
std::size_t Textures::imageCount() const {
    return tables_->imageCount();
}
std::size_t Textures::bytes() const {
    return tables_->bytes();
}

}  // namespace penumbra
