#pragma once

#include <string>
#include <vector>

namespace couture::drivers {

/// One way from a surface to splines on one thread, in seconds of processor time: other programs
/// on the machine don't count.
struct MeshingRow {
    std::string part;
    /// "triangles to quads", "triangles to volume", "surfaces to volume" (of those of all patches,
    /// inner ones twice), "family member" (triangles to volume, cuts and cuboids being those of the
    /// reference).
    std::string task;
    /// Triangles, or surfaces.
    int n_input = 0;
    /// Quads of the layout, or volumes.
    int n_patches = 0;
    int n_elements = 0;
    /// Of volumes; else 0.
    double min_scaled_jacobian = 0.0;
    double cpu_seconds = 0.0;
};

/// A wheel from triangles to quads, to a volume, and from the surfaces of that volume to volumes
/// again; and a member of the family of pants.
///
/// @param quick  the pant alone, in few triangles
[[nodiscard]] std::vector<MeshingRow> measure_meshing(bool quick);

}  // namespace couture::drivers
