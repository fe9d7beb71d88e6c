#pragma once

#include <functional>
#include <vector>

#include "meshing/topology/pants_curves.h"

namespace couture::meshing {

struct HandleCutOptions {
    /// Curves from there on are given loops: handles keep off them.
    int first_given = 0;
    /// No handles are looked for but the given ones.
    bool only_given = false;
    /// Whether handles become curves; else only tunnels and the kinds of given loops are found.
    bool cuts = true;
    /// Makes a handle shorter between all other curves; nothing: they are shortest as they are.
    std::function<SurfaceCurve(const SurfaceCurve&)> tightened = {};
};

/// Cuts the handles of a shell and says of the given loops on it which are handles.
///
/// @param shell  number of the connected component, see face_components; of genus 1 or more
/// @return the tunnel loops, which are no cuts, as points
/// @throws what find_handle_tunnel_loops throws
[[nodiscard]] std::vector<std::vector<Vector3>> cut_handles(SurfaceMesh& mesh, int shell,
                                                            PantsCurves& curves,
                                                            const HandleCutOptions& options);

}  // namespace couture::meshing
