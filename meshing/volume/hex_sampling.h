#pragma once

#include <array>
#include <optional>
#include <vector>

#include "meshing/volume/parameterize_volume.h"

namespace couture::meshing {

/// Hexahedra: patches of degree 1, one element each between neighbouring points.
struct SampledHexahedra {
    iga::MultiPatch<3> hexahedra;
    /// Of all hexahedra: whether det J is positive in each of them, proven.
    ParameterizationReport report;
    /// Whether inner points had to move.
    bool has_moved_points = false;
};

/// Hexahedra between points of a volume at uniform parameters of each patch: nodes of neighbours
/// are the same to the last bit, interfaces and boundary sets are kept. Folded ones are mended by
/// moving points inside the body (see parameterize_volume); whether all are positive: see the
/// report.
///
/// @param n_points  per direction, at least 2; nothing: as many as control points
/// @throws InputError  if n_points is below 2
///
/// Source: [Maquart19] Sec. 7.1.1, Eq. (7.1).
[[nodiscard]] SampledHexahedra sample_hexahedra(const iga::MultiPatch<3>& volume,
                                                std::optional<int> n_points = std::nullopt);

/// Hexahedra between six grids of points: Coons first, then inner points in the middle of their six
/// neighbours (the smallest Laplacian energy) if that leaves all hexahedra positive, and is mended
/// as above if neither does.
///
/// @param sides  points on sides 0 to 5 of a box in columns, the lower tangential direction
///               fastest
/// @param n  points per direction, at least 2
/// @throws InputError  if numbers of points don't fit, or sides differ by more than 1e-9 of the
///                     size on a common edge
///
/// Source: [Maquart19] Sec. 7.1.1.
[[nodiscard]] SampledHexahedra hexahedra_between(const std::array<MatrixX, 6>& sides,
                                                 const std::array<int, 3>& n);

}  // namespace couture::meshing
