#include "core/image/image.h"

namespace penumbra {

Image::Image(int width, int height, int channels, std::vector<std::uint8_t> bytes, TransferFunction encoding)
    : width_(width),
      height_(height),
      channels_(channels),
      encoding_(encoding),
      bytes_(std::move(bytes)),
      decode_(encoding.decodeTable()) {}

Image::Image(int width, int height, int channels, std::vector<float> floats, const ColorSpace& space)
    : width_(width), height_(height), channels_(channels), space_(&space), floats_(std::move(floats)) {}

}  // namespace penumbra
