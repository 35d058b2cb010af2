// The texture classes there are, and the table's rows of each. A new class is a file beside this and an entry in
// TextureTypes; see texture_plugin.h. A make() that is not in its class's header needs this file.
#pragma once

#include "core/image/texture_bilerp.h"
#include "core/image/texture_checkerboard.h"
#include "core/image/texture_constant.h"
#include "core/image/texture_directionmix.h"
#include "core/image/texture_dots.h"
#include "core/image/texture_fbm.h"
#include "core/image/texture_imagemap.h"
#include "core/image/texture_marble.h"
#include "core/image/texture_mix.h"
#include "core/image/texture_ptex.h"
#include "core/image/texture_scale.h"
#include "core/image/texture_windy.h"
#include "core/image/texture_wrinkled.h"

#include <tuple>

namespace penumbra {

using TextureTypes = TypeList<ConstantTexture, ImageTexture, ScaleTexture, CheckerboardTexture, MixTexture,
                              DirectionMixTexture, BilerpTexture, DotsTexture, FbmTexture, WrinkledTexture,
                              WindyTexture, MarbleTexture, PtexTexture>;

struct TextureRows {
    template <class... Ts>
    static std::tuple<std::vector<Ts>...> storage(TypeList<Ts...>);
    decltype(storage(TextureTypes{})) byClass;
};

template <class T>
std::vector<T>& TextureTables::rows() {
    return std::get<std::vector<T>>(rows_->byClass);
}
template <class T>
const std::vector<T>& TextureTables::rows() const {
    return std::get<std::vector<T>>(rows_->byClass);
}

template <class T>
TextureOperand TextureTables::append(const T& row, std::initializer_list<TextureOperand> uses, TextureInput& input) {
    Node node;
    node.tag = kTagOf<T, TextureTypes>;
    node.row = std::uint32_t(rows<T>().size());
    const TextureOperand operand = appendNode(node, uses, input);
    rows<T>().push_back(row);
    return operand;
}

template <class T>
const T* TextureTables::find(const TextureOperand& operand) const {
    if (operand.isConstant()) return nullptr;
    const Node& node = nodes_[operand.texture];
    return node.tag == kTagOf<T, TextureTypes> ? &rows<T>()[node.row] : nullptr;
}

}  // namespace penumbra
