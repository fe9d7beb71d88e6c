#pragma once

#include <functional>

#include "meshing/layout/layout_samples.h"
#include "meshing/layout/volumetric_layout.h"

namespace couture::meshing {

/// A volumetric layout with the map of each cuboid, from its unit cube.
struct MappedLayout {
    VolumetricLayout layout;
    std::function<Vector3(int cuboid, const Vector3& xi)> map;
};

/// Samples of the boundary, `n_cells` along each arc.
[[nodiscard]] LayoutSamples sample(const MappedLayout& body, int n_cells);

/// `n` cuboids per direction of a box, moved by `map` from the unit cube.
[[nodiscard]] MappedLayout mapped_box(std::array<int, 3> n,
                                      std::function<Vector3(const Vector3&)> map);

/// An O-grid of 5 cuboids in each of `n` segments along a tube around a core: the disc of radius 1
/// is (x, y), moved by `place` with the coordinate along in [0, 1]. A ring has no ends. Nodes: 8 in
/// each section, those of the core first.
[[nodiscard]] MappedLayout o_grid(int n, bool is_ring,
                                  std::function<Vector3(double x, double y, double along)> place);

/// Torus about the z axis.
constexpr double torus_radius = 3.0;
constexpr double tube_radius = 1.0;
[[nodiscard]] MappedLayout torus_of_20();

}  // namespace couture::meshing
