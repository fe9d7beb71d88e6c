#pragma once

#include <functional>
#include <vector>

#include "meshing/parts/part_definition.h"
#include "meshing/parts/part_surface_builder.h"

namespace couture::meshing {

/// A part as a surface, and how it is put together.
struct PartSurfaceDefinition {
    PartInfo info;
    double default_edge_length = 0.0;
    std::function<void(const PartValues&, PartSurfaceBuilder&)> build;
};

}  // namespace couture::meshing
