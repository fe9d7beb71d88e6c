#include "io/sample_matrix.h"

#include "iga/spline/bspline_basis.h"

namespace couture::io {

std::vector<double> sample_parameters(const std::vector<double>& breakpoints, int samples) {
    std::vector<double> parameters;
    for (std::size_t e = 0; e + 1 < breakpoints.size(); ++e) {
        for (int i = 0; i < samples; ++i) {
            const double t = static_cast<double>(i) / samples;
            parameters.push_back((1.0 - t) * breakpoints[e] + t * breakpoints[e + 1]);
        }
    }
    parameters.push_back(breakpoints.back());
    return parameters;
}

SparseMatrix sample_matrix(const iga::KnotVector& knots, const std::vector<double>& parameters) {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const int span = knots.find_span(parameters[i]);
        const MatrixX values = iga::basis_derivatives(knots, span, parameters[i], 0);
        for (int j = 0; j <= knots.degree(); ++j) {
            entries.emplace_back(static_cast<int>(i), span - knots.degree() + j, values(0, j));
        }
    }
    SparseMatrix matrix(static_cast<Eigen::Index>(parameters.size()), knots.n_basis());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

}  // namespace couture::io
