#include "iga/topology/jacobian_certificate.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/spline/bernstein.h"
#include "iga/spline/refine.h"

namespace couture::iga {

namespace {

/// Rounding of control points after knot insertion and of the products: some hundred operations.
constexpr double rounding = 128 * std::numeric_limits<double>::epsilon();

/// The patch in Bezier elements: coordinates centred and divided by `size`, homogeneous rows if
/// rational.
template <int d>
struct BezierPatch {
    std::array<int, d> degrees{};
    std::array<int, d> n_elements{};
    std::array<int, d> n_functions{};
    std::array<std::vector<double>, d> breakpoints;
    MatrixX rows;
    bool is_rational = false;
    double size = 1.0;
};

template <int d>
BezierPatch<d> to_bezier(const Patch<d>& patch) {
    BezierPatch<d> result;
    result.is_rational = patch.is_rational();
    const MatrixX& points = patch.control_points();
    const Eigen::RowVectorXd low = points.colwise().minCoeff();
    const Eigen::RowVectorXd high = points.colwise().maxCoeff();
    const double size = (high - low).norm();
    result.size = size > 0.0 ? size : 1.0;
    const MatrixX centred = (points.rowwise() - 0.5 * (low + high)) / result.size;
    if (result.is_rational) {
        result.rows.resize(points.rows(), d + 1);
        result.rows << patch.weights().asDiagonal() * centred, patch.weights();
        result.rows /= patch.weights().maxCoeff();
    } else {
        result.rows = centred;
    }
    std::array<SparseMatrix, d> to_elements;
    for (int k = 0; k < d; ++k) {
        const KnotVector& knots = patch.knots(k);
        std::vector<double> new_knots;
        for (int e = 1; e < knots.n_elements(); ++e) {
            new_knots.insert(new_knots.end(), knots.degree() - knots.multiplicities()[e],
                             knots.breakpoints()[e]);
        }
        to_elements[k] = insert_knots(knots, new_knots).prolongation;
        result.degrees[k] = knots.degree();
        result.n_elements[k] = knots.n_elements();
        result.n_functions[k] = knots.degree() * knots.n_elements() + 1;
        result.breakpoints[k] = knots.breakpoints();
    }
    result.rows = apply_kronecker<d>(to_elements, result.rows);
    return result;
}

/// One coordinate (or the weight) of a Bezier element.
template <int d>
Bernstein<d> component(const BezierPatch<d>& patch, const std::array<int, d>& element,
                       int coordinate) {
    Bernstein<d> result = Bernstein<d>::zero(patch.degrees);
    for (std::size_t c = 0; c < result.coefficients.size(); ++c) {
        int rest = static_cast<int>(c);
        int function = 0;
        int stride = 1;
        for (int k = 0; k < d; ++k) {
            const int i = rest % (patch.degrees[k] + 1);
            rest /= patch.degrees[k] + 1;
            function += stride * (element[k] * patch.degrees[k] + i);
            stride *= patch.n_functions[k];
        }
        result.coefficients[c] = patch.rows(function, coordinate);
    }
    return result;
}

template <int d>
std::array<int, d> sum(const std::array<int, d>& a, const std::array<int, d>& b) {
    std::array<int, d> result;
    for (int k = 0; k < d; ++k) {
        result[k] = a[k] + b[k];
    }
    return result;
}

/// a b - c e, where both products have the same degrees.
template <int d>
ScaledBernstein<d> minor_of(const ScaledBernstein<d>& a, const ScaledBernstein<d>& b,
                            const ScaledBernstein<d>& c, const ScaledBernstein<d>& e) {
    auto result = ScaledBernstein<d>::zero(sum<d>(a.degrees, b.degrees));
    result.add_product(1.0, a, b);
    result.add_product(-1.0, c, e);
    return result;
}

/// Rows of a square matrix of polynomials; all entries of a row have the same degrees.
template <int d>
using PolynomialMatrix = std::vector<std::vector<ScaledBernstein<d>>>;

/// Laplace expansion by the first two rows (first row for a 3 x 3 matrix).
template <int d>
ScaledBernstein<d> determinant(const PolynomialMatrix<d>& M) {
    if (M.size() == 2) {
        return minor_of(M[0][0], M[1][1], M[0][1], M[1][0]);
    }
    std::array<int, d> degrees{};
    for (const auto& row : M) {
        degrees = sum<d>(degrees, row[0].degrees);
    }
    auto result = ScaledBernstein<d>::zero(degrees);
    if (M.size() == 3) {
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            const int k = (i + 2) % 3;
            result.add_product(1.0, M[0][i], minor_of(M[1][j], M[2][k], M[1][k], M[2][j]));
        }
        return result;
    }
    // Columns of the upper and of the lower minor, and the sign of their permutation.
    constexpr int pairs[6][5] = {{0, 1, 2, 3, 1}, {0, 2, 1, 3, -1}, {0, 3, 1, 2, 1},
                                 {1, 2, 0, 3, 1}, {1, 3, 0, 2, -1}, {2, 3, 0, 1, 1}};
    for (const auto& [i, j, k, l, sign] : pairs) {
        result.add_product(sign, minor_of(M[0][i], M[1][j], M[0][j], M[1][i]),
                           minor_of(M[2][k], M[3][l], M[2][l], M[3][k]));
    }
    return result;
}

/// det J of an element over its own [0, 1]^d (times w^(d+1) if rational) in scaled coordinates.
template <int d>
struct ElementDeterminant {
    Bernstein<d> polynomial;
    Bernstein<d> weight;
    /// Values below it in size are zero but for rounding.
    double noise = 0.0;
};

template <int d>
double largest_norm(const std::vector<Bernstein<d>>& row) {
    double largest = 0.0;
    for (std::size_t c = 0; c < row[0].coefficients.size(); ++c) {
        double squared = 0.0;
        for (const Bernstein<d>& entry : row) {
            squared += entry.coefficients[c] * entry.coefficients[c];
        }
        largest = std::max(largest, squared);
    }
    return std::sqrt(largest);
}

template <int d>
ElementDeterminant<d> element_determinant(const BezierPatch<d>& patch,
                                          const std::array<int, d>& element) {
    std::vector<Bernstein<d>> X;
    for (int i = 0; i < patch.rows.cols(); ++i) {
        X.push_back(component<d>(patch, element, i));
    }
    PolynomialMatrix<d> M;
    double product = 1.0;
    double relative_error = 1.0;
    const auto append_row = [&](const std::vector<Bernstein<d>>& row) {
        M.emplace_back();
        for (const Bernstein<d>& entry : row) {
            M.back().push_back(to_scaled(entry));
        }
    };
    std::array<double, d> norms;
    for (int k = 0; k < d; ++k) {
        std::vector<Bernstein<d>> row;
        for (const Bernstein<d>& coordinate : X) {
            row.push_back(coordinate.derivative(k));
        }
        append_row(row);
        norms[k] = largest_norm(row);
        product *= norms[k];
    }
    if (patch.is_rational) {
        append_row(X);
        relative_error = largest_norm(X);
    }
    // Control points are off by rounding times 1 (the size): derivatives by degree times that.
    double error = product;
    for (int k = 0; k < d; ++k) {
        double others = patch.degrees[k];
        for (int m = 0; m < d; ++m) {
            others *= m == k ? 1.0 : norms[m];
        }
        error += others;
    }
    return {to_bernstein(determinant<d>(M)), patch.is_rational ? X[d] : Bernstein<d>{},
            rounding * relative_error * error};
}

/// A part of an element with its polynomial.
template <int d>
struct Cell {
    Bernstein<d> polynomial;
    /// Lower corner and edge length in the element's [0, 1]^d.
    Vector<d> corner = Vector<d>::Zero();
    double length = 1.0;
    int depth = 0;
    double smallest = 0.0;
};

/// What one element says; values with the element's own orientation, scaled coordinates.
template <int d>
struct ElementResult {
    Validity validity = Validity::valid;
    int orientation = 1;
    double integral = 0.0;
    double min_coefficient = std::numeric_limits<double>::infinity();
    double max_coefficient = -std::numeric_limits<double>::infinity();
    double min_value = std::numeric_limits<double>::infinity();
    double max_value = -std::numeric_limits<double>::infinity();
    Vector<d> min_xi = Vector<d>::Zero();
    Vector<d> max_xi = Vector<d>::Zero();
};

enum class CellState { positive, boundary_zero, folded, unknown };

/// Faces of the cell, of all dimensions: -1 low, 0 free, 1 high in each direction.
template <int d, typename Visit>
void for_each_face(const Visit& visit) {
    constexpr int n_faces = d == 2 ? 9 : 27;
    for (int code = 0; code < n_faces; ++code) {
        std::array<int, d> face;
        for (int k = 0, rest = code; k < d; ++k, rest /= 3) {
            face[k] = rest % 3 - 1;
        }
        visit(face);
    }
}

template <int d>
bool is_on_face(const std::array<int, d>& degrees, int i_coefficient,
                const std::array<int, d>& face) {
    for (int k = 0; k < d; ++k) {
        const int i = i_coefficient % (degrees[k] + 1);
        i_coefficient /= degrees[k] + 1;
        if ((face[k] == -1 && i != 0) || (face[k] == 1 && i != degrees[k])) {
            return false;
        }
    }
    return true;
}

/// A polynomial without negative coefficients vanishes exactly on the faces (of any dimension)
/// whose coefficients are all zero. These must lie on the patch's boundary.
///
/// @param is_at_boundary  [direction][low, high] of the cell
template <int d>
CellState state_of(const Bernstein<d>& P, double noise,
                   const std::array<std::array<bool, 2>, d>& is_at_boundary) {
    const double smallest = *std::min_element(P.coefficients.begin(), P.coefficients.end());
    if (smallest > noise) {
        return CellState::positive;
    }
    bool has_inner_zero = false;
    bool has_negative_corner = false;
    for_each_face<d>([&](const std::array<int, d>& face) {
        bool is_corner = true;
        bool is_at_side = false;
        for (int k = 0; k < d; ++k) {
            is_corner = is_corner && face[k] != 0;
            is_at_side = is_at_side || (face[k] != 0 && is_at_boundary[k][face[k] == 1 ? 1 : 0]);
        }
        if (is_at_side && !is_corner) {
            return;
        }
        double largest = 0.0;
        for (std::size_t c = 0; c < P.coefficients.size(); ++c) {
            if (is_on_face<d>(P.degrees, static_cast<int>(c), face)) {
                largest = std::max(largest, std::abs(P.coefficients[c]));
                has_negative_corner =
                    has_negative_corner || (is_corner && P.coefficients[c] < -noise);
            }
        }
        has_inner_zero = has_inner_zero || (!is_at_side && largest <= noise);
    });
    if (has_negative_corner || has_inner_zero) {
        return CellState::folded;
    }
    return smallest >= -noise ? CellState::boundary_zero : CellState::unknown;
}

template <int d>
class ElementCheck {
  public:
    ElementCheck(const BezierPatch<d>& patch, const std::array<int, d>& element)
        : patch_(patch), element_(element), det_(element_determinant<d>(patch, element)) {}

    ElementResult<d> run(int max_depth) {
        Cell<d> whole{.polynomial = std::move(det_.polynomial)};
        std::vector<double>& coefficients = whole.polynomial.coefficients;
        for (const double c : coefficients) {
            result_.integral += c / static_cast<double>(coefficients.size());
        }
        if (result_.integral < 0.0) {
            result_.orientation = -1;
            for (double& c : coefficients) {
                c = -c;
            }
        }
        const auto [least, most] = std::minmax_element(coefficients.begin(), coefficients.end());
        result_.max_coefficient = *most;
        whole.smallest = *least;
        sample(whole, static_cast<int>(least - coefficients.begin()));
        sample(whole, static_cast<int>(most - coefficients.begin()));

        const auto is_better = [](const Cell<d>& a, const Cell<d>& b) {
            return a.smallest > b.smallest;
        };
        std::priority_queue<Cell<d>, std::vector<Cell<d>>, decltype(is_better)> cells(is_better);
        cells.push(std::move(whole));
        while (!cells.empty()) {
            const Cell<d> cell = cells.top();
            cells.pop();
            if (examine(cell, max_depth)) {
                split(cell, [&](Cell<d> child) { cells.push(std::move(child)); });
            }
            if (result_.validity == Validity::folded) {
                for (; !cells.empty(); cells.pop()) {
                    result_.min_coefficient =
                        std::min(result_.min_coefficient, cells.top().smallest);
                }
            }
        }
        return result_;
    }

  private:
    /// @return whether the cell must be split
    bool examine(const Cell<d>& cell, int max_depth) {
        const Bernstein<d>& P = cell.polynomial;
        const auto least = std::min_element(P.coefficients.begin(), P.coefficients.end());
        sample_corners(cell);
        const bool is_negative =
            sample(cell, static_cast<int>(least - P.coefficients.begin())) < -det_.noise;
        const CellState state =
            is_negative ? CellState::folded : state_of<d>(P, det_.noise, boundary_of(cell));
        if (state == CellState::unknown && cell.depth < max_depth) {
            return true;
        }
        result_.min_coefficient = std::min(result_.min_coefficient, *least);
        if (state == CellState::folded) {
            result_.validity = Validity::folded;
        } else if (state == CellState::unknown) {
            result_.validity = Validity::undecided;
        } else if (state == CellState::boundary_zero && result_.validity == Validity::valid) {
            result_.validity = Validity::degenerate;
        }
        return false;
    }

    template <typename Push>
    void split(const Cell<d>& cell, const Push& push) {
        std::vector<Cell<d>> parts{cell};
        for (int k = 0; k < d; ++k) {
            std::vector<Cell<d>> finer;
            for (const Cell<d>& part : parts) {
                auto [low, high] = part.polynomial.halves(k);
                finer.push_back(part);
                finer.back().polynomial = std::move(low);
                finer.push_back(part);
                finer.back().polynomial = std::move(high);
                finer.back().corner[k] += 0.5 * cell.length;
            }
            parts = std::move(finer);
        }
        for (Cell<d>& part : parts) {
            part.length = 0.5 * cell.length;
            part.depth = cell.depth + 1;
            part.smallest = *std::min_element(part.polynomial.coefficients.begin(),
                                              part.polynomial.coefficients.end());
            push(std::move(part));
        }
    }

    std::array<std::array<bool, 2>, d> boundary_of(const Cell<d>& cell) const {
        std::array<std::array<bool, 2>, d> result;
        for (int k = 0; k < d; ++k) {
            result[k][0] = element_[k] == 0 && cell.corner[k] == 0.0;
            result[k][1] =
                element_[k] == patch_.n_elements[k] - 1 && cell.corner[k] + cell.length == 1.0;
        }
        return result;
    }

    void sample_corners(const Cell<d>& cell) {
        for (int code = 0; code < (1 << d); ++code) {
            Vector<d> xi;
            int index = 0;
            int stride = 1;
            for (int k = 0; k < d; ++k) {
                const int bit = (code >> k) & 1;
                xi[k] = bit;
                index += stride * bit * cell.polynomial.degrees[k];
                stride *= cell.polynomial.degrees[k] + 1;
            }
            keep(cell, xi, cell.polynomial.coefficients[index]);
        }
    }

    /// The value at the point that a coefficient belongs to.
    double sample(const Cell<d>& cell, int i_coefficient) {
        const Vector<d> xi = cell.polynomial.abscissa(i_coefficient);
        const double value = cell.polynomial(xi);
        keep(cell, xi, value);
        return value;
    }

    void keep(const Cell<d>& cell, const Vector<d>& xi, double value) {
        const Vector<d> local = cell.corner + cell.length * xi;
        double detJ = value;
        if (patch_.is_rational) {
            detJ /= std::pow(det_.weight(local), d + 1);
        }
        if (detJ < result_.min_value) {
            result_.min_value = detJ;
            result_.min_xi = local;
        }
        if (detJ > result_.max_value) {
            result_.max_value = detJ;
            result_.max_xi = local;
        }
    }

    const BezierPatch<d>& patch_;
    std::array<int, d> element_;
    ElementDeterminant<d> det_;
    ElementResult<d> result_;
};

template <int d>
std::array<int, d> element_indices(const BezierPatch<d>& patch, int i_element) {
    std::array<int, d> result;
    for (int k = 0; k < d; ++k) {
        result[k] = i_element % patch.n_elements[k];
        i_element /= patch.n_elements[k];
    }
    return result;
}

}  // namespace

template <int d>
PatchCertificate<d> certify(const Patch<d>& patch, int max_depth) {
    if (patch.dimension() != d) {
        throw InputError(
            "certify: a patch with {} parameters in {} dimensions; det J needs as many dimensions "
            "as parameters",
            d, patch.dimension());
    }
    const BezierPatch<d> bezier = to_bezier(patch);
    int n_elements = 1;
    for (const int n : bezier.n_elements) {
        n_elements *= n;
    }
    std::vector<ElementResult<d>> results(n_elements);
    parallel_for(n_elements, [&](int e) {
        results[e] = ElementCheck<d>(bezier, element_indices(bezier, e)).run(max_depth);
    });

    PatchCertificate<d> certificate;
    double integral = 0.0;
    for (const ElementResult<d>& result : results) {
        integral += result.integral;
    }
    certificate.orientation = integral < 0.0 ? -1 : 1;
    certificate.validity = Validity::valid;
    certificate.min_coefficient = std::numeric_limits<double>::infinity();
    const double weight_scale =
        patch.is_rational() ? std::pow(patch.weights().maxCoeff(), d + 1) : 1.0;
    for (int e = 0; e < n_elements; ++e) {
        const ElementResult<d>& result = results[e];
        const std::array<int, d> element = element_indices(bezier, e);
        const bool is_reversed = result.orientation != certificate.orientation;
        const Validity validity = is_reversed ? Validity::folded : result.validity;
        certificate.validity = std::max(certificate.validity, validity);
        if (validity >= Validity::undecided) certificate.unproven.push_back(e);
        // From the element's [0, 1]^d and scaled coordinates to the patch's.
        double scale = std::pow(bezier.size, d);
        for (int k = 0; k < d; ++k) {
            scale /= bezier.breakpoints[k][element[k] + 1] - bezier.breakpoints[k][element[k]];
        }
        certificate.min_coefficient =
            std::min(certificate.min_coefficient,
                     scale * weight_scale *
                         (is_reversed ? -result.max_coefficient : result.min_coefficient));
        const double value = scale * (is_reversed ? -result.max_value : result.min_value);
        if (value < certificate.min_jacobian) {
            certificate.min_jacobian = value;
            const Vector<d>& local = is_reversed ? result.max_xi : result.min_xi;
            for (int k = 0; k < d; ++k) {
                const std::vector<double>& breakpoints = bezier.breakpoints[k];
                certificate.min_xi[k] = (1.0 - local[k]) * breakpoints[element[k]] +
                                        local[k] * breakpoints[element[k] + 1];
            }
        }
    }
    return certificate;
}

std::string to_string(Validity validity) {
    switch (validity) {
        case Validity::valid:
            return "valid";
        case Validity::degenerate:
            return "degenerate";
        case Validity::folded:
            return "folded";
        case Validity::undecided:
            break;
    }
    return "undecided";
}

template PatchCertificate<2> certify<2>(const Patch<2>&, int);
template PatchCertificate<3> certify<3>(const Patch<3>&, int);

}  // namespace couture::iga
