// Light sources, and area lights on shapes.
//
// Thread safety: none; one instance belongs to one build.
#pragma once

#include "scenes/builder/context.h"

#include "core/geometry/geometry.h"
#include "lights/registry.h"

#include <map>

namespace penumbra::builder {

/// Adds every LightSource of the scene.
void addLightSources(const SceneDescription& scene, BuildContext& context, LightTable& lights);

/// What an AreaLightSource says of any shape it is put on.
struct AreaEmission {
    Rgb radiance{0, 0, 0};
    float power = 0;  ///< where positive: of one primitive, instead of the radiance's size
    bool twoSided = false;

    /// Of a primitive of that area.
    Spectrum<float> radianceOf(double area) const;
    bool isBlack() const { return radiance == Rgb{}; }
};

class AreaLightLibrary {
public:
    AreaLightLibrary(const SceneDescription& scene, BuildContext& context) : scene_(scene), context_(context) {}
    /// By index into SceneDescription::areaLights.
    const AreaEmission& get(int index);

private:
    AreaEmission read(const Entity& entity);
    Rgb readImageMean(const Entity& entity, const std::string& file, const std::string& owner);

    const SceneDescription& scene_;
    BuildContext& context_;
    std::map<int, AreaEmission> read_;
};

/// Makes the shape's triangles lights: one where two of them are a rectangle, else one each. REQUIRES: the shape is in
/// `geometry`, in world space.
void addMeshLights(const AreaEmission& emission, const Geometry& geometry, LightTable& lights, ShapeRecord& shape);
/// `worldFromObject` as in the quadric, in double.
void addQuadricLight(const AreaEmission& emission, const QuadricRecord& quadric, const Matrix4& worldFromObject,
                     LightTable& lights, ShapeRecord& shape);

}  // namespace penumbra::builder
