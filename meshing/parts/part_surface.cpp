#include "meshing/parts/part_surface.h"

#include "iga/core/error.h"
#include "meshing/parts/block_surfaces.h"
#include "meshing/parts/branched_bar_surfaces.h"
#include "meshing/parts/casting_surface.h"
#include "meshing/parts/part_surface_definition.h"
#include "meshing/parts/plate_surfaces.h"
#include "meshing/parts/seal_surfaces.h"
#include "meshing/parts/torus_surfaces.h"
#include "meshing/parts/wheel_surface.h"

namespace couture::meshing {

namespace {

/// Shorter edges would take more than some ten million triangles.
constexpr double largest_refinement = 20.0;

const std::vector<PartSurfaceDefinition>& definitions() {
    static const std::vector<PartSurfaceDefinition> all = [] {
        std::vector<PartSurfaceDefinition> list;
        for (const auto& group :
             {branched_bar_surfaces, seal_surfaces, wheel_surfaces, casting_surfaces,
              plate_surfaces, torus_surfaces, block_surfaces}) {
            const std::vector<PartSurfaceDefinition> some = group();
            list.insert(list.end(), some.begin(), some.end());
        }
        return list;
    }();
    return all;
}

}  // namespace

const std::vector<PartInfo>& part_surfaces() {
    static const std::vector<PartInfo> all = [] {
        std::vector<PartInfo> list;
        for (const PartSurfaceDefinition& definition : definitions()) {
            list.push_back(definition.info);
        }
        return list;
    }();
    return all;
}

double default_edge_length(const std::string& name) {
    return find_definition("default_edge_length", definitions(), name).default_edge_length;
}

PartSurface make_part_surface(const std::string& name,
                              const std::map<std::string, double>& parameters,
                              double target_edge_length) {
    const PartSurfaceDefinition& definition =
        find_definition("make_part_surface", definitions(), name);
    const PartValues values = complete_values(definition.info, parameters);
    const double standard = definition.default_edge_length;
    const double shortest = standard / largest_refinement;
    constexpr double longest = 1e6;
    if (target_edge_length != 0.0 &&
        !(target_edge_length >= shortest && target_edge_length <= longest)) {
        throw InputError(
            "{}: target_edge_length = {} is out of range; it must lie in [{}, {}] mm, or be 0 for "
            "{} mm",
            name, target_edge_length, shortest, longest, standard);
    }
    PartSurfaceBuilder builder(target_edge_length == 0.0 ? standard : target_edge_length);
    definition.build(values, builder);
    return builder.finish();
}

}  // namespace couture::meshing
