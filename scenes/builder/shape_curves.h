// Parts of shapes.cpp: curves out of parameters.
#pragma once

#include "scenes/builder/context.h"

#include "core/geometry/curve_set.h"

namespace penumbra::builder {

/// Reads a curve's parameters and moves its points out of them.
CurveArrays takeCurveArrays(ParameterSet& parameters, const BuildContext& context, SourcePosition where);

}  // namespace penumbra::builder
