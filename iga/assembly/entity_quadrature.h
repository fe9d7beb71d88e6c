#pragma once

#include <functional>

#include "iga/topology/space.h"

namespace couture::iga {

/// One quadrature point of a side, edge or corner.
template <int d>
struct EntityPoint {
    Vector3 x = Vector3::Zero();
    /// Outward unit normal of a side; zero on edges and corners.
    Vector3 normal = Vector3::Zero();
    /// Quadrature weight times area, length, or 1 for a corner.
    double weight = 1.0;
    /// Functions of the space that do not vanish here: global numbers and values.
    std::vector<int> dofs;
    VectorX values;
    /// Quadrature weight alone, and derivatives by the parameters of a side or edge (e of them): of
    /// the map, 3 x e, and of the functions, functions x e.
    double parameter_weight = 1.0;
    MatrixX tangents;
    MatrixX gradients;
    /// Of a side: the outward normal is sign * (t_0 x t_1), in the plane sign * (t_y, -t_x).
    double sign = 0.0;
};

/// Visits the Gauss points of an entity of the geometry's boundary (or of its inside).
///
/// @param n_gauss_points  per direction and element; nothing: degree + 1
/// @throws GeometryError  if the patch has more coordinates than parameters
template <int d>
void for_entity_points(const Space<d>& space, const PatchEntity<d>& entity,
                       std::optional<int> n_gauss_points,
                       const std::function<void(const EntityPoint<d>&)>& body);

}  // namespace couture::iga
