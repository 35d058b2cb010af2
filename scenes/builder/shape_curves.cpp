#include "scenes/builder/shape_curves.h"

#include "scenes/builder/shape_meshes.h"

#include <algorithm>

namespace penumbra::builder {
namespace {

constexpr float kWidest = 1e12f;

/// The number of the choice that the parameter names.
std::size_t choiceOf(const ParameterSet& p, const char* name, const std::vector<std::string>& choices,
                     const BuildContext& context, SourcePosition where) {
    const std::string text = p.text(name, choices.front());
    const auto found = std::find(choices.begin(), choices.end(), text);
    if (found != choices.end()) return std::size_t(found - choices.begin());
    const Parameter* given = p.findAny(name);
    context.fail(given ? given->where : where,
                 "unknown " + std::string(name) + " " + quote(text) + " of a curve" + suggestion(text, choices));
}

}  // namespace

CurveArrays takeCurveArrays(ParameterSet& p, const BuildContext& context, SourcePosition where) {
    CurveArrays arrays;
    const CurveType types[] = {CurveType::Flat, CurveType::Cylinder, CurveType::Ribbon};
    arrays.type = types[choiceOf(p, "type", {"flat", "cylinder", "ribbon"}, context, where)];
    arrays.spline = choiceOf(p, "basis", {"bezier", "bspline"}, context, where) == 1;
    arrays.degree = context.integer(p, "degree", 3, 2, 3);
    const float width = context.number(p, "width", 1, 0, kWidest);
    arrays.width0 = context.number(p, "width0", width, 0, kWidest);
    arrays.width1 = context.number(p, "width1", width, 0, kWidest);
    p.integer("splitdepth", 3);  // how finely it is cut up for the format's own intersections
    arrays.P = takeList<std::vector<float>>(p, "point3", "P");
    arrays.N = takeList<std::vector<float>>(p, "normal", "N");
    return arrays;
}

}  // namespace penumbra::builder
