#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "iga/assembly/bilinear_form.h"
#include "iga/assembly/sparsity.h"
#include "iga/linalg/patch_coefficients.h"
#include "iga/topology/space.h"

namespace couture::iga {

/// A symmetric form on all patches as an operator that never forms its matrix: the field and its
/// derivatives at the Gauss points of whole patches by sum factorization, the coefficients there,
/// and the transpose back to the functions. Cost per function O(m^3 (p + 1)), m points per element
/// and direction; memory O(m^3), of forms whose coefficients vary O(1). The same bits for any
/// number of threads.
template <int d>
class FormOperator {
  public:
    /// @param space  must outlive this
    /// @param n_gauss_points  per direction and element; nothing: degree + 1 of the space
    /// @throws GeometryError  for a folded patch: patch, place, value
    /// @throws SolverError    if it would not fit into the machine's memory
    FormOperator(const Space<d>& space, BilinearForm<d> form,
                 std::optional<int> n_gauss_points = {});
    FormOperator(FormOperator&&) noexcept;
    ~FormOperator();

    [[nodiscard]] int n_unknowns() const { return space_->n_dofs() * form_.n_components; }
    [[nodiscard]] int n_components() const { return form_.n_components; }
    [[nodiscard]] const Space<d>& space() const { return *space_; }
    [[nodiscard]] const BilinearForm<d>& form() const { return form_; }

    /// A u, u of n_unknowns numbers numbered n_components * function + component. One call at a
    /// time: it keeps its work space.
    [[nodiscard]] VectorX operator*(const VectorX& u) const;

    /// Diagonal blocks of the matrix: n_unknowns x n_components, block i in rows n_components * i.
    /// Functions that a collapsed side joins count by themselves.
    ///
    /// @param is_diagonal  only the blocks' diagonals, the rest is zero: a third of the work
    [[nodiscard]] MatrixX diagonal_blocks(bool is_diagonal = false) const;

    /// For each patch and component the means, over the unit box, of what the form becomes there;
    /// see `patch_coefficients` of a matrix.
    [[nodiscard]] std::vector<std::vector<PatchCoefficients>> mean_coefficients() const;

    /// Bytes held.
    [[nodiscard]] std::size_t memory() const;

  private:
    struct PatchData;
    /// A plane of quadrature points: from derivatives and value by parameters to those in space,
    /// and the coefficients there if they vary.
    struct PlaneData;

    void require_memory(std::optional<int> n_gauss_points) const;
    void set_up(int patch, std::optional<int> n_gauss_points);
    void fill_plane(const PatchData& patch, int i_plane, PlaneData& plane) const;
    /// Numbers per quadrature point: the transformation and the weight.
    [[nodiscard]] int record_size() const { return n_slots_ * n_slots_ + 1; }
    template <int nc, int n_slots>
    void apply_layer(const PatchData& patch, int layer) const;
    template <int nc, int n_slots, int n_functions>
    void apply_layer_of(const PatchData& patch, int layer) const;
    void gather(const VectorX& u) const;
    [[nodiscard]] VectorX scatter() const;

    const Space<d>* space_;
    BilinearForm<d> form_;
    /// Parametric slots: d derivatives, and the value if the form or a rational patch needs it.
    int n_slots_ = d;
    std::vector<std::unique_ptr<PatchData>> patches_;
    Incidence incidence_;
};

}  // namespace couture::iga
