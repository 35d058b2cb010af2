// MediumLibrary: the media of a scene file by name. Homogeneous ones absorb; what scatters comes later.
#pragma once

#include "scenes/builder/context.h"
#include "scenes/scene.h"

#include <map>

namespace penumbra::builder {

class MediumLibrary {
public:
    /// All must outlive this object. Appends to `table`, whose row 0 becomes vacuum.
    MediumLibrary(const SceneDescription& scene, BuildContext& context, std::vector<MediumRecord>& table);

    /// The row of the medium; 0 for "". `where`: of the directive that names it.
    std::uint32_t row(const std::string& name, SourcePosition where);

private:
    MediumRecord make(const NamedMediumEntity& entity);
    MediumRecord makeHomogeneous(const NamedMediumEntity& entity);

    const SceneDescription& scene_;
    BuildContext& context_;
    std::vector<MediumRecord>& table_;
    std::map<std::string, std::size_t, std::less<>> names_;
    std::map<std::size_t, std::uint32_t> rows_;
};

}  // namespace penumbra::builder
