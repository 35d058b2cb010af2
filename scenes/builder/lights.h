// Light sources, and area lights on shapes.
//
// Thread safety: none; one instance belongs to one build.
#pragma once

#include "scenes/builder/context.h"

#include "core/geometry/geometry.h"
#include "lights/registry.h"

#include <cmath>
#include <map>
#include <optional>
#include <vector>

namespace penumbra::builder {

/// Adds every LightSource of the scene.
void addLightSources(const SceneDescription& scene, BuildContext& context, LightTable& lights);

/// An image of a light: r, g, b of all pixels. What is negative in the image's own space is 0; what is not finite
/// stays, with a warning, for the light to take as black.
struct LightImage {
    enum class Space { Film, Own };
    std::size_t width, height;
    std::vector<float> rgb;

    /// Reads the file; errors get the place and the owner.
    LightImage(const std::string& file, SourcePosition where, const std::string& owner, BuildContext& context,
               Space space = Space::Film);
    /// The colour of a unit direction, between pixels, in an image of all directions.
    Rgb sky(SkyMap map, Vec3d direction) const;
    /// The mean over all pixels of the luminance times weight(u, v) of the pixel's middle, in [0, 1]^2.
    template <class Weight>
    double meanLuminance(const ColorSpace& film, Weight&& weight) const;
};

/// What an AreaLightSource says of any shape it is put on.
struct AreaEmission {
    Rgb radiance{0, 0, 0};                   ///< with a picture, a factor on it
    std::optional<EmissionPicture> picture;  ///< to be laid on the shape
    float power = 0;                         ///< where positive: of one primitive, instead of the radiance's size
    double pictureLuminance = 1;
    bool twoSided = false;

    /// Of a primitive of that area.
    Spectrum<float> radianceOf(double area) const;
    bool isBlack() const { return radiance == Rgb{} || (picture && picture->mean == 0); }
};

class AreaLightLibrary {
public:
    /// Pictures go to `tables`.
    AreaLightLibrary(const SceneDescription& scene, BuildContext& context, LightTables& tables)
        : scene_(scene), context_(context), tables_(tables) {}
    /// By index into SceneDescription::areaLights.
    const AreaEmission& get(int index);

private:
    AreaEmission read(const Entity& entity);
    void readPicture(const Entity& entity, const std::string& file, const std::string& owner, AreaEmission& emission);

    const SceneDescription& scene_;
    BuildContext& context_;
    LightTables& tables_;
    std::map<int, AreaEmission> read_;
};

/// Makes the shape's triangles lights: one where two of them are a rectangle, else one each. Triangles of one face, by
/// `faceOfTriangle`, (which ascends), share its power; where that is empty, each is a face. REQUIRES: the shape is in `geometry`, in
/// world space.
void addMeshLights(const AreaEmission& emission, const Geometry& geometry,
                   const std::vector<std::int32_t>& faceOfTriangle, LightTable& lights, ShapeRecord& shape);
/// `worldFromObject` as in the quadric, in double.
void addQuadricLight(const AreaEmission& emission, const QuadricRecord& quadric, const Matrix4& worldFromObject,
                     LightTable& lights, ShapeRecord& shape);

template <class Weight>
double LightImage::meanLuminance(const ColorSpace& film, Weight&& weight) const {
    double sum = 0;
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const float* c = &rgb[3 * (y * width + x)];
            const double luminance = film.luminance({c[0], c[1], c[2]});
            if (std::isfinite(luminance))
                sum += luminance * weight((double(x) + 0.5) / double(width), (double(y) + 0.5) / double(height));
        }
    return sum / double(width * height);
}

}  // namespace penumbra::builder
