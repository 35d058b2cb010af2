// The texture classes there are. A new one is a file beside this and an entry in TextureTypes; see texture_plugin.h.
#pragma once

#include "core/image/texture_checkerboard.h"
#include "core/image/texture_constant.h"
#include "core/image/texture_imagemap.h"
#include "core/image/texture_scale.h"

namespace penumbra {

using TextureTypes = TypeList<ConstantTexture, ImageTexture, ScaleTexture, CheckerboardTexture>;

}  // namespace penumbra
