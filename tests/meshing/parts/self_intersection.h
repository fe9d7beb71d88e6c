#pragma once

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Whether two triangles meet anywhere else than in common vertices and edges. Exact.
[[nodiscard]] bool intersects_itself(const TriangleSoup& soup);

}  // namespace couture::meshing
