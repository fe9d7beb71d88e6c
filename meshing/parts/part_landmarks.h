#pragma once

#include "meshing/parts/part_surface.h"
#include "meshing/topology/pants_record.h"

namespace couture::meshing {

/// The corners of a part and points along its feature curves, by their names.
[[nodiscard]] Landmarks part_landmarks(const PartSurface& part);

}  // namespace couture::meshing
