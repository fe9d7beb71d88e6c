#pragma once

#include <functional>

#include "meshing/volume/boundary_slide.h"
#include "meshing/volume/lbfgs.h"
#include "meshing/volume/shape_energy.h"

namespace couture::meshing {

/// Steps of L-BFGS that lower a ShapeEnergy, in variables scaled by the elements' sizes.
class ShapeDescent {
  public:
    /// Largest part of a step from a state that may be done, or more.
    using StepLimit = std::function<double(const MatrixX& from, const MatrixX& step)>;

    explicit ShapeDescent(const ShapeEnergy& energy) : energy_(energy) {}

    /// Starts with another measure.
    void start(const MatrixX& points, const ShapeMeasure& measure);
    /// Drops what is known of the Hessian.
    void forget() { memory_.clear(); }

    [[nodiscard]] const ShapeMeasure& measure() const { return measure_; }
    /// Sizes of the elements around each control point at the start.
    [[nodiscard]] const VectorX& sizes() const { return sizes_; }
    /// The state after `n_steps` steps in the tangent space of the boundary, or fewer if none
    /// lowers the energy.
    [[nodiscard]] MatrixX descend(MatrixX points, const TangentFrames& tangents, int n_steps,
                                  const StepLimit& limit = {});

  private:
    [[nodiscard]] MatrixX direction(const MatrixX& gradient, const TangentFrames& tangents) const;
    [[nodiscard]] double longest_step(const MatrixX& step) const;

    const ShapeEnergy& energy_;
    ShapeMeasure measure_;
    VectorX sizes_;
    Lbfgs memory_;
};

}  // namespace couture::meshing
