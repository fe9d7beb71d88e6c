#pragma once

#include <optional>
#include <string>

#include "rom/coefficient_model.h"
#include "rom/pod.h"

namespace couture::rom {

struct FieldModelOptions {
    PodOptions pod = {};
    KrigingOptions kriging = {};
};

/// A field over parameters: mean + modes x coefficients, each coefficient by kriging.
///
/// Source: [Maquart19] Sec. 1.3.2, Eq. (1.18), and Sec. 7.2.1.
class FieldModel {
  public:
    /// Learns from fields at the points of a design. Refused fields leave the design: it stays a
    /// tensor product if they are all those of some points of its factors, else it becomes one
    /// factor; kriging's lengths are then those of the points of the first factor without
    /// refused fields, if these are at least half of the points. Without inputs (no
    /// factors) the one field is the mean.
    ///
    /// @param fields  n_values x n_points; columns of NaN are refused ones
    /// @param mean    n_values
    /// @throws InputError  for other sizes, without a field; as make_pod_basis and Kriging
    FieldModel(const TensorDesign& design, const MatrixX& fields, VectorX mean,
               const InnerProduct& product, const FieldModelOptions& options = {});
    /// As it was, e.g. from a file.
    FieldModel(VectorX mean, PodBasis basis, std::optional<int> n_modes_asked,
               CoefficientModel coefficients);

    [[nodiscard]] int n_modes() const { return static_cast<int>(basis_.modes.cols()); }
    [[nodiscard]] const VectorX& mean() const { return mean_; }
    [[nodiscard]] const PodBasis& basis() const { return basis_; }
    [[nodiscard]] const CoefficientModel& coefficients() const { return coefficients_; }
    [[nodiscard]] std::optional<int> n_modes_asked() const { return n_modes_asked_; }
    /// Says so if there are fewer modes than were asked for.
    [[nodiscard]] std::optional<std::string> missing_modes() const;

    /// The field of coefficients, one pass through the modes.
    [[nodiscard]] VectorX field(const VectorX& coefficients) const;
    /// Fields of coefficients: n_values x n_fields. @param coefficients  n_modes x n_fields
    [[nodiscard]] MatrixX fields(const MatrixX& coefficients) const;
    /// Standard errors of the values of a field from the variances of its coefficients.
    [[nodiscard]] VectorX standard_errors(const VectorX& variances) const;

  private:
    VectorX mean_;
    PodBasis basis_;
    std::optional<int> n_modes_asked_;
    CoefficientModel coefficients_;
};

/// Kriging of coefficients at the accepted points of a design. Where a design has holes its
/// likelihood costs a hundred times more: lengths and nugget are then those of the complete part of
/// it, if that is most of it. Where its first factor has more than 400 points, all coefficients
/// share the lengths and the nugget that are likeliest for the first of them at 400 of these
/// points: a likelihood costs their number to the third power.
///
/// @param accepted  positions among the points, rising
/// @param values    n_accepted x n_coefficients, the largest coefficients first
[[nodiscard]] CoefficientModel learned_coefficients(const TensorDesign& design,
                                                    const std::vector<int>& accepted,
                                                    const MatrixX& values,
                                                    const KrigingOptions& options);

/// The design without the points whose fields were refused, a tensor product where that is left.
///
/// @param accepted  positions of the others among the points, rising
[[nodiscard]] TensorDesign accepted_design(const TensorDesign& design,
                                           const std::vector<int>& accepted);

}  // namespace couture::rom
