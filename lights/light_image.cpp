#include "lights/light_image.h"

#include "core/base/error.h"

#include <limits>

namespace penumbra {

std::uint32_t roomForNumbers(const LightTables& tables, std::size_t count) {
    const std::size_t first = tables.numbers.size();
    if (first + count > std::size_t(std::numeric_limits<std::int32_t>::max()))
        throw Error(ErrorKind::BadData, "the images of the lights are too large");
    return std::uint32_t(first);
}

}  // namespace penumbra
