#pragma once

#include <array>
#include <vector>

#include "iga/assembly/form_operator.h"
#include "iga/assembly/geometry_grid.h"
#include "iga/core/buffer.h"
#include "iga/spline/bspline_basis.h"

namespace couture::iga {

using Vector4d = double __attribute__((vector_size(32)));
/// Components of a function are padded to one vector.
constexpr int lanes = 4;
/// Numbers of coefficients that a point has: [t][b][s][lane a].
constexpr int coefficient_size(int n_slots, int nc) { return n_slots * nc * n_slots * lanes; }

template <int d>
struct FormOperator<d>::PatchData {
    PatchData(int number, const Patch<d>& geometry, const TensorSpace<d>& tensor,
              const std::array<int, d>& n_points)
        : index(number), grid(geometry, tensor, n_points), sizes(tensor.sizes()) {
        for (int k = 0; k < d; ++k) {
            tables[k] =
                tabulate(tensor.knots[k], tensor.knots[k].breakpoints(), grid.line(k).unit_points);
        }
        for (int k = 0; k < d - 1; ++k) {
            n_plane_functions *= sizes[k];
        }
        points_per_layer = d == 3 ? grid.line(d - 1).points_per_element : 1;
        n_layers = grid.n_planes() / points_per_layer;
        layer_planes = d == 3 ? tables[d - 1].n_functions : sizes[1];
        if (d == 2) {
            n_plane_functions = sizes[0];
        }
    }

    int index;
    GeometryGrid<d> grid;
    std::array<BasisTable, d> tables;
    std::array<int, d> sizes;
    double orientation = 1.0;
    bool is_rational = false;
    /// Layers of elements in the last direction of a volume, each a piece of work with so many
    /// planes of points; the one layer of a surface.
    int n_layers = 1;
    int points_per_layer = 1;
    /// Functions of a plane (a line of a surface), and such planes that a layer reaches.
    int n_plane_functions = 1;
    int layer_planes = 1;
    /// Of forms with constant coefficients: of each point its record, and the coefficients.
    Buffer<double> records;
    Buffer<double> coefficients;
    /// Work space: the functions' numbers, and what each layer adds to those that it reaches.
    Buffer<double> rows;
    std::vector<Buffer<double>> sums;
};

template <int d>
struct FormOperator<d>::PlaneData {
    GeometryPlane<d> geometry;
    Buffer<double> A;
    Buffer<double> records;
    Buffer<double> coefficients;
};

}  // namespace couture::iga
