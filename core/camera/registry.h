// The camera types there are. A new one is a file beside this and an entry in CameraTypes.
#pragma once

#include "core/camera/orthographic.h"
#include "core/camera/perspective.h"
#include "core/camera/realistic.h"
#include "core/camera/spherical.h"

#include <variant>

namespace penumbra {

using CameraTypes = TypeList<PerspectiveCamera, OrthographicCamera, SphericalCamera, RealisticCamera>;

namespace detail {
template <class... Ts>
std::variant<Ts...> cameraStorage(TypeList<Ts...>);
}

/// One camera of any type, in its own space.
using CameraModel = decltype(detail::cameraStorage(CameraTypes{}));

/// Makes the camera of that name; false where there is none.
bool makeCamera(std::string_view name, CameraInput& input, CameraModel& out);

}  // namespace penumbra
