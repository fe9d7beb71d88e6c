#pragma once

#include "iga/assembly/bilinear_form.h"
#include "iga/assembly/geometry_grid.h"
#include "iga/core/buffer.h"

namespace couture::iga {

/// One row of a patch's matrix: the entries of function (i_0, i_1, i_2) with all neighbours
/// (j_0, j_1, j_2). Of a symmetric form only j_{d-1} >= i_{d-1} is computed.
template <int d>
struct StencilRow {
    std::array<int, d> i;
    /// [a * n_components + b][j_0 - i_0 + p_0][j_1 - i_1 + p_1][lane], lane = j_2 - i_2; for
    /// d = 2 there is one lane.
    const double* values;
    int n_lanes;
    std::array<int, 2> widths;

    /// Entry of pair 0 with a neighbour; the other pairs follow `pair_stride` apart.
    [[nodiscard]] const double* entry(int offset_0, int offset_1, int lane) const {
        return values + (offset_0 * widths[1] + offset_1) * n_lanes + lane;
    }
    [[nodiscard]] int pair_stride() const { return widths[0] * widths[1] * n_lanes; }
};

/// Integrates a bilinear form over one patch by patch-level sum factorization: every pair of
/// univariate functions is summed over its whole common support, one direction after the other,
/// the row's function first. Cost per function and component pair, m points and p + 1 functions
/// per element, w = 2 p + 1: O(m^4 (p + 1) + w m^4 + w^2 m^3) instead of O(m^3 (p + 1)^6) of an
/// element loop.
template <int d>
class PatchIntegrator {
  public:
    /// @param space, weights  the field's functions on the patch; weights empty for B-splines
    /// @param points_per_element  Gauss points per direction
    PatchIntegrator(int i_patch, const Patch<d>& geometry, const TensorSpace<d>& space,
                    const VectorX& weights, const BilinearForm<d>& form,
                    const std::array<int, d>& points_per_element);

    /// Number of planes of functions in the last direction, the unit of work.
    [[nodiscard]] int n_row_planes() const { return sizes_[d - 1]; }

    /// Floating-point operations of the three contractions (a multiply-add counts two), without
    /// geometry and coefficients: a lower bound of the work done.
    [[nodiscard]] double flops() const;

    /// Rows with i_{d-1} in [first, last), ascending; `sink` gets each once, from this thread.
    ///
    /// @throws GeometryError  where det J changes its sign: patch, place, value
    void integrate(int first, int last,
                   const std::function<void(const StencilRow<d>&)>& sink) const;

  private:
    struct Direction {
        BasisTable table;
        int degree = 0;
        int n_functions = 0;
        int n_points = 0;
        /// First and last element of each function's support.
        std::vector<int> first_element;
        std::vector<int> last_element;
    };
    struct Workspace;

    void fill_coefficients(int i_plane, int slot, Workspace& workspace) const;
    template <int n_physical, int n_parametric>
    void transform_coefficients(int slot, Workspace& workspace) const;
    template <typename V, int n_vectors, bool has_value>
    void contract_last(int i, Workspace& workspace) const;
    template <typename V, int n_vectors, int n>
    void contract_middle(int i, Workspace& workspace) const;
    template <typename V, int n_vectors, int n>
    void contract_first(int i, Workspace& workspace) const;
    template <typename V, int n_vectors>
    void integrate_with(int first, int last,
                        const std::function<void(const StencilRow<d>&)>& sink) const;

    int i_patch_;
    const BilinearForm<d>& form_;
    GeometryGrid<d> grid_;
    double orientation_ = 1.0;
    bool is_rational_;
    bool has_value_;
    std::array<int, d> sizes_{};
    std::array<Direction, d> directions_;
    VectorX weights_;
    /// Entries of A that may differ from zero, pairs a <= b only.
    struct Entry {
        int a, b, s, t;
        double value;
    };
    std::vector<Entry> entries_;
};

}  // namespace couture::iga
