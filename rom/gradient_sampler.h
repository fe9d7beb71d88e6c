#pragma once

#include "iga/mechanics/problem.h"
#include "rom/reduced_model.h"
#include "rom/sample_grid.h"

namespace couture::rom {

class GridKernel;

/// Problems at points on both sides, `step` away along one parameter.
struct ProblemChange {
    double step = 0.0;
    iga::Problem below;
    iga::Problem above;
};

/// Largest values of a member are made of these: at each point of grids the von Mises stress and
/// the displacement's length, with derivatives by the parameters. Both are 0 where the value is.
struct SampleGradients {
    /// n_points, and n_points x n_parameters.
    VectorX von_mises;
    MatrixX von_mises_gradient;
    VectorX displacement;
    MatrixX displacement_gradient;
};

/// Derivatives of what FieldSampler samples, in units of the deck.
///
/// By the chain rule: with H = du/dx, changes dx and du of the control points' and the
/// displacement's functions have dH = d(du)/dx - H d(dx)/dx. Where the material or the temperature
/// depends on a parameter, that part is by central differences at given gradients.
class GradientSampler {
  public:
    /// @param space, grids  as of FieldSampler
    GradientSampler(iga::SpacePtr<3> space, const std::vector<SampleGrid>& grids);
    ~GradientSampler();
    GradientSampler(const GradientSampler&) = delete;
    GradientSampler& operator=(const GradientSampler&) = delete;
    GradientSampler(GradientSampler&&) noexcept;
    GradientSampler& operator=(GradientSampler&&) noexcept;

    [[nodiscard]] int n_points() const { return first_points_.back(); }

    /// @param evaluation, gradient  of one point of the parameters
    /// @param problem   there: an elastic solid
    /// @param changes   of the problem with each parameter; nothing where it does not change
    /// @param columns   the parameters that derivatives are wanted for; the others are 0
    /// @throws InputError  for a problem that is no elastic solid, another number of changes
    [[nodiscard]] SampleGradients sample(const Evaluation& evaluation,
                                         const EvaluationGradient& gradient,
                                         const iga::Problem& problem,
                                         const std::vector<std::optional<ProblemChange>>& changes,
                                         const std::vector<int>& columns) const;

  private:
    iga::SpacePtr<3> space_;
    std::vector<int> first_points_;
    std::vector<GridKernel> kernels_;
};

}  // namespace couture::rom
