#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "iga/core/buffer.h"
#include "rom/sample_grid.h"

namespace couture::rom {

/// The same number at several points.
constexpr int n_lanes = 4;
using Lanes = double __attribute__((vector_size(8 * n_lanes)));

/// What a member is at n_lanes points of a line.
struct PointLanes {
    /// Position and displacement.
    std::array<Lanes, 3> x;
    std::array<Lanes, 3> u;
    /// du_i / dx_j at 3 i + j.
    std::array<Lanes, 9> H;
    /// Of dx / dxi.
    Lanes det_J;
};

/// Functions of one direction at the points of a line.
struct LineTable {
    /// Those used: from `first`, `n_functions` of them.
    int first = 0;
    int n_functions = 0;
    /// Of a point: first non-zero one, counted from `first`, and the degree + 1 values and
    /// derivatives from there.
    int n_active = 0;
    std::vector<int> starts;
    std::vector<double> values;
    std::vector<double> derivatives;

    LineTable(const iga::KnotVector& knots, const std::vector<double>& parameters);
    [[nodiscard]] int n_points() const { return static_cast<int>(starts.size()); }
    [[nodiscard]] const double* value(int i_point) const { return &values[i_point * n_active]; }
    [[nodiscard]] const double* derivative(int i_point) const {
        return &derivatives[i_point * n_active];
    }
};

/// Evaluates geometry, displacement and its gradient on one grid by sum factorization: first along
/// lines (the direction with the fewest idle lanes, n_lanes points at a time), then across.
class GridKernel {
  public:
    GridKernel(const iga::Space<3>& space, const SampleGrid& grid);

    [[nodiscard]] int patch() const { return patch_; }
    /// Calls body(first point, stride, count, lanes) until all points of the grid were in `count`
    /// lanes: lane i holds the point first + i * stride.
    ///
    /// @param control_points, displacement  3 n_dofs numbers
    template <typename Body>
    void visit(const double* control_points, const double* displacement, const Body& body) const;

  private:
    static constexpr int n_fields = 6;

    /// Functions of the line's direction at n_lanes points: value and derivative of each.
    struct Block {
        int start = 0;
        int n_functions = 0;
        std::size_t first_table = 0;
    };

    void make_blocks();
    void make_denominators();
    /// Coefficients of the functions used, [across 1][across 0][along][field], times weights.
    void gather(const double* control_points, const double* displacement,
                Buffer<double>& net) const;
    /// Values, then derivatives along: [across 1][across 0][field].
    void contract_along(const Block& block, const Buffer<double>& net, Buffer<Lanes>& out) const;
    /// Value, derivative across 1, derivative along: [across 0][field] each.
    void contract_across_1(int i_point, const Buffer<Lanes>& in, Buffer<Lanes>& out) const;
    /// Value and three derivatives of each field.
    using FieldLanes = std::array<std::array<Lanes, n_fields>, 4>;
    [[nodiscard]] FieldLanes contract_across_0(int i_point, const Buffer<Lanes>& in) const;
    void divide(FieldLanes& fields, std::size_t i_denominator) const;
    [[nodiscard]] PointLanes to_point(const FieldLanes& fields) const;

    int patch_;
    /// Directions: across 0, across 1, along.
    std::array<int, 3> directions_{};
    /// 1 if these are a cyclic order of 0, 1, 2, else -1.
    double orientation_ = 1.0;
    std::array<int, 3> strides_{};
    int n_along_ = 0;
    std::vector<LineTable> tables_;
    std::vector<Block> blocks_;
    Buffer<Lanes> along_values_;
    Buffer<Lanes> along_derivatives_;
    std::vector<int> dofs_;
    std::vector<double> weights_;
    /// Of rational functions: 1 / W and the derivatives of W over W, in the order of visits.
    std::vector<std::array<Lanes, 4>> denominators_;
};

template <typename Body>
void GridKernel::visit(const double* control_points, const double* displacement,
                       const Body& body) const {
    Buffer<double> net;
    Buffer<Lanes> lines;
    Buffer<Lanes> rows;
    gather(control_points, displacement, net);
    std::size_t i_denominator = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        contract_along(blocks_[b], net, lines);
        const int first_along = static_cast<int>(b) * n_lanes;
        const int count = std::min(n_lanes, n_along_ - first_along);
        for (int i1 = 0; i1 < tables_[1].n_points(); ++i1) {
            contract_across_1(i1, lines, rows);
            for (int i0 = 0; i0 < tables_[0].n_points(); ++i0, ++i_denominator) {
                FieldLanes fields = contract_across_0(i0, rows);
                if (!denominators_.empty()) {
                    divide(fields, i_denominator);
                }
                body(i0 * strides_[0] + i1 * strides_[1] + first_along * strides_[2], strides_[2],
                     count, to_point(fields));
            }
        }
    }
}

}  // namespace couture::rom
