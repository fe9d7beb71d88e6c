#include "rom/kriging_inputs.h"

#include <cmath>
#include <numbers>

namespace couture::rom {

namespace {

constexpr double turn = 2.0 * std::numbers::pi;

}  // namespace

KrigingInputs::KrigingInputs(const ParameterSpace& space, const std::vector<int>& sampled) {
    for (int i = 0; i < static_cast<int>(sampled.size()); ++i) {
        if (space.parameters()[sampled[i]].is_periodic) {
            inputs_.push_back({sampled[i], i, Wave::cosine});
            inputs_.push_back({sampled[i], i, Wave::sine});
        } else {
            inputs_.push_back({sampled[i], i, Wave::none});
        }
    }
}

std::vector<int> KrigingInputs::parameters() const {
    std::vector<int> result;
    for (const Input& input : inputs_) result.push_back(input.parameter);
    return result;
}

std::vector<KrigingInputs::Wave> KrigingInputs::waves() const {
    std::vector<Wave> result;
    for (const Input& input : inputs_) result.push_back(input.wave);
    return result;
}

double KrigingInputs::value(const Input& input, double t) {
    switch (input.wave) {
        case Wave::cosine:
            return 0.5 * (1.0 + std::cos(turn * t));
        case Wave::sine:
            return 0.5 * (1.0 + std::sin(turn * t));
        case Wave::none:
            break;
    }
    return t;
}

VectorX KrigingInputs::at(const VectorX& unit_point) const {
    VectorX result(size());
    for (int i = 0; i < size(); ++i) {
        result[i] = value(inputs_[i], unit_point[inputs_[i].parameter]);
    }
    return result;
}

VectorX KrigingInputs::slopes(const VectorX& unit_point) const {
    VectorX result = VectorX::Ones(size());
    for (int i = 0; i < size(); ++i) {
        const double angle = turn * unit_point[inputs_[i].parameter];
        if (inputs_[i].wave == Wave::cosine) result[i] = -0.5 * turn * std::sin(angle);
        if (inputs_[i].wave == Wave::sine) result[i] = 0.5 * turn * std::cos(angle);
    }
    return result;
}

MatrixX KrigingInputs::of_design(const MatrixX& points) const {
    MatrixX result(points.rows(), size());
    for (int i = 0; i < size(); ++i) {
        for (Eigen::Index k = 0; k < points.rows(); ++k) {
            result(k, i) = value(inputs_[i], points(k, inputs_[i].column));
        }
    }
    return result;
}

}  // namespace couture::rom
