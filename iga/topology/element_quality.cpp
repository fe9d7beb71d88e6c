#include "iga/topology/element_quality.h"

#include <Eigen/LU>
#include <array>

#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/spline/bspline_basis.h"
#include "iga/spline/gauss.h"

namespace couture::iga {

namespace {

/// Of a sum of a few hundred terms, relative to their size.
constexpr double rounding = 1e-14;

/// Values and derivatives of one direction's functions at a point of one element.
struct Values1D {
    int first_function = 0;
    /// 2 x (degree + 1).
    MatrixX N;
};

/// Positions of samples in an element, one direction: its ends (0 and last) and Gauss points.
std::vector<double> sample_positions(int degree) {
    const GaussRule& rule = gauss_rule(degree + 1);
    std::vector<double> positions{0.0};
    positions.insert(positions.end(), rule.points.begin(), rule.points.end());
    positions.push_back(1.0);
    return positions;
}

double position_in(const KnotVector& knots, int element, double position) {
    const std::vector<double>& b = knots.breakpoints();
    return (1.0 - position) * b[element] + position * b[element + 1];
}

template <int d>
struct PointOfMap {
    Vector<d> x;
    Matrix<d> J;
};

/// One patch: all values needed at samples, and where they are.
template <int d>
struct Sampler {
    const Patch<d>& patch;
    MatrixX rows;
    /// Largest coordinate (times weight).
    double largest = 0.0;
    std::array<std::vector<double>, d> positions;
    /// [direction][element * n_positions + position].
    std::array<std::vector<Values1D>, d> values;

    explicit Sampler(const Patch<d>& p) : patch(p) {
        rows = patch.is_rational() ? patch.homogeneous() : patch.control_points();
        largest = rows.leftCols(d).cwiseAbs().maxCoeff();
        for (int k = 0; k < d; ++k) {
            const KnotVector& knots = patch.knots(k);
            positions[k] = sample_positions(knots.degree());
            for (int e = 0; e < knots.n_elements(); ++e) {
                const int span = knots.span_of_element(e);
                for (const double position : positions[k]) {
                    values[k].push_back(
                        {span - knots.degree(),
                         basis_derivatives(knots, span, position_in(knots, e, position), 1)});
                }
            }
        }
    }

    [[nodiscard]] int n_elements() const {
        int product = 1;
        for (int k = 0; k < d; ++k) {
            product *= patch.knots(k).n_elements();
        }
        return product;
    }
    [[nodiscard]] std::array<int, d> element(int i_element) const {
        std::array<int, d> result;
        for (int k = 0; k < d; ++k) {
            result[k] = i_element % patch.knots(k).n_elements();
            i_element /= patch.knots(k).n_elements();
        }
        return result;
    }
    [[nodiscard]] Vector<d> xi(const std::array<int, d>& e, const std::array<int, d>& q) const {
        Vector<d> result;
        for (int k = 0; k < d; ++k) {
            result[k] = position_in(patch.knots(k), e[k], positions[k][q[k]]);
        }
        return result;
    }

    [[nodiscard]] Vector<d> middle(const std::array<int, d>& e) const {
        Vector<d> result;
        for (int k = 0; k < d; ++k) {
            result[k] = position_in(patch.knots(k), e[k], 0.5);
        }
        return result;
    }

    [[nodiscard]] PointOfMap<d> point(const std::array<int, d>& e,
                                      const std::array<int, d>& q) const {
        // Rows: value, then derivatives; columns: coordinates and weight.
        Eigen::Matrix<double, d + 1, d + 1> sums = Eigen::Matrix<double, d + 1, d + 1>::Zero();
        std::array<const Values1D*, d> table;
        int n_functions = 1;
        for (int k = 0; k < d; ++k) {
            table[k] = &values[k][e[k] * positions[k].size() + q[k]];
            n_functions *= static_cast<int>(table[k]->N.cols());
        }
        for (int f = 0; f < n_functions; ++f) {
            int rest = f;
            int function = 0;
            int stride = 1;
            Vector<d + 1> N = Vector<d + 1>::Ones();
            for (int k = 0; k < d; ++k) {
                const int n = static_cast<int>(table[k]->N.cols());
                const int i = rest % n;
                rest /= n;
                function += stride * (table[k]->first_function + i);
                stride *= patch.knots(k).n_basis();
                for (int row = 0; row <= d; ++row) {
                    N[row] *= table[k]->N(row == k + 1 ? 1 : 0, i);
                }
            }
            for (int c = 0; c < rows.cols(); ++c) {
                sums.col(c) += rows(function, c) * N;
            }
        }
        PointOfMap<d> result;
        Matrix<d>& J = result.J;
        const double weight = patch.is_rational() ? sums(0, d) : 1.0;
        result.x = sums.row(0).template head<d>().transpose() / weight;
        for (int k = 0; k < d; ++k) {
            for (int i = 0; i < d; ++i) {
                J(i, k) =
                    patch.is_rational()
                        ? (sums(k + 1, i) - sums(k + 1, d) * sums(0, i) / sums(0, d)) / sums(0, d)
                        : sums(k + 1, i);
            }
            // What rounding leaves of a vanishing derivative has no direction.
            const double terms = table[k]->N.row(1).template lpNorm<1>() * largest / weight;
            if (J.col(k).norm() <= rounding * terms) {
                J.col(k).setZero();
            }
        }
        return result;
    }
};

/// A sample of an element: the scaled Jacobian and where.
struct Sample {
    double quality = 0.0;
    bool is_corner = false;
};

template <int d>
struct ElementSamples {
    std::vector<Sample> samples;
    std::vector<std::array<int, d>> positions;
    double det_sum = 0.0;
    double shape_ratio = 0.0;
    double angle_deviation = 0.0;
};

template <int d>
ElementSamples<d> sample_element(const Sampler<d>& sampler, const std::array<int, d>& element) {
    ElementSamples<d> result;
    CellCorners<d> corners;
    int n_corners = 0;
    int n_positions = 1;
    for (int k = 0; k < d; ++k) {
        n_positions *= static_cast<int>(sampler.positions[k].size());
    }
    for (int i = 0; i < n_positions; ++i) {
        std::array<int, d> q;
        int n_ends = 0;
        for (int k = 0, rest = i; k < d; ++k) {
            const int n = static_cast<int>(sampler.positions[k].size());
            q[k] = rest % n;
            rest /= n;
            n_ends += q[k] == 0 || q[k] == n - 1 ? 1 : 0;
        }
        if (n_ends == 0 || n_ends == d) {
            const auto [x, J] = sampler.point(element, q);
            result.samples.push_back({scaled_jacobian<d>(J), n_ends == d});
            result.positions.push_back(q);
            result.det_sum += n_ends == 0 ? J.determinant() : 0.0;
            if (n_ends == d) {
                corners.col(n_corners++) = x;
            }
        }
    }
    result.shape_ratio = shape_ratio(corners);
    result.angle_deviation = angle_deviation(corners);
    return result;
}

/// Takes the largest values and adds to the sums, which become means later.
template <int d>
void add_shape(const Sampler<d>& sampler, int patch, int element, const ElementSamples<d>& samples,
               QualitySummary<d>& summary) {
    if (samples.shape_ratio > summary.max_shape_ratio) {
        summary.max_shape_ratio = samples.shape_ratio;
        summary.worst_shape_ratio_patch = patch;
        summary.worst_shape_ratio_xi = sampler.middle(sampler.element(element));
    }
    summary.max_angle_deviation = std::max(summary.max_angle_deviation, samples.angle_deviation);
    summary.mean_shape_ratio += samples.shape_ratio;
    summary.mean_angle_deviation += samples.angle_deviation;
}

}  // namespace

template <int d>
double scaled_jacobian(const Matrix<d>& J) {
    double product = 1.0;
    for (int k = 0; k < d; ++k) {
        product *= J.col(k).norm();
    }
    return product > 0.0 ? J.determinant() / product : 0.0;
}

template <int d>
QualitySummary<d> element_quality(const MultiPatch<d>& multipatch) {
    QualitySummary<d> summary;
    double total = 0.0;
    std::size_t n_samples = 0;
    std::size_t n_elements = 0;
    for (int p = 0; p < multipatch.n_patches(); ++p) {
        const Patch<d>& patch = multipatch.patches[p];
        if (patch.dimension() != d) {
            throw InputError(
                "element_quality: patch {} has {} parameters in {} dimensions; the scaled Jacobian "
                "needs as many dimensions as parameters",
                p, d, patch.dimension());
        }
        const Sampler<d> sampler(patch);
        std::vector<ElementSamples<d>> elements(sampler.n_elements());
        parallel_for(sampler.n_elements(),
                     [&](int e) { elements[e] = sample_element<d>(sampler, sampler.element(e)); });
        double det_sum = 0.0;
        for (const ElementSamples<d>& element : elements) {
            det_sum += element.det_sum;
        }
        const double orientation = det_sum < 0.0 ? -1.0 : 1.0;
        for (int e = 0; e < sampler.n_elements(); ++e) {
            add_shape<d>(sampler, p, e, elements[e], summary);
            ++n_elements;
            for (std::size_t i = 0; i < elements[e].samples.size(); ++i) {
                const Sample& sample = elements[e].samples[i];
                const double quality = orientation * sample.quality;
                total += quality;
                ++n_samples;
                double& least =
                    sample.is_corner ? summary.min_at_corners : summary.min_at_gauss_points;
                least = std::min(least, quality);
                if (quality < summary.min_scaled_jacobian) {
                    summary.min_scaled_jacobian = quality;
                    summary.worst_patch = p;
                    summary.worst_xi = sampler.xi(sampler.element(e), elements[e].positions[i]);
                }
            }
        }
    }
    if (n_samples > 0) {
        summary.mean_scaled_jacobian = total / static_cast<double>(n_samples);
        summary.mean_shape_ratio /= static_cast<double>(n_elements);
        summary.mean_angle_deviation /= static_cast<double>(n_elements);
    }
    return summary;
}

template double scaled_jacobian<2>(const Matrix<2>&);
template double scaled_jacobian<3>(const Matrix<3>&);
template QualitySummary<2> element_quality<2>(const MultiPatch<2>&);
template QualitySummary<3> element_quality<3>(const MultiPatch<3>&);

}  // namespace couture::iga
