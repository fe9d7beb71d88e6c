#pragma once

#include <vector>

#include "rom/parameter_space.h"

namespace couture::rom {

/// What kriging sees of a model's parameters: their values in the unit cube, and of a periodic one
/// two, (1 + cos(2 pi t)) / 2 and (1 + sin(2 pi t)) / 2, so that both ends of its range are one
/// point. With Gaussian correlations of one length that is the periodic kernel
/// exp(-2 sin^2(pi (t - t')) / (4 length^2)).
///
/// Source: [RasmussenWilliams06] Sec. 4.2.3, Eq. (4.31).
class KrigingInputs {
  public:
    /// @param sampled  positions of the parameters in the space, in the order of the design
    KrigingInputs(const ParameterSpace& space, const std::vector<int>& sampled);

    [[nodiscard]] int size() const { return static_cast<int>(inputs_.size()); }
    /// Positions of the parameters in the space, of a periodic one twice.
    [[nodiscard]] std::vector<int> parameters() const;
    /// For each input whether it is a parameter's value, or the cosine or sine of a periodic one.
    enum class Wave { none, cosine, sine };
    [[nodiscard]] std::vector<Wave> waves() const;

    /// @param unit_point  of all parameters of the space
    [[nodiscard]] VectorX at(const VectorX& unit_point) const;
    /// d inputs / d unit_point of its parameter, one each.
    [[nodiscard]] VectorX slopes(const VectorX& unit_point) const;
    /// Of the points of a design of the sampled parameters, n x n_sampled: n x size().
    [[nodiscard]] MatrixX of_design(const MatrixX& points) const;

  private:
    struct Input {
        /// In the space, and among those sampled.
        int parameter = 0;
        int column = 0;
        Wave wave = Wave::none;
    };
    static double value(const Input& input, double t);

    std::vector<Input> inputs_;
};

}  // namespace couture::rom
