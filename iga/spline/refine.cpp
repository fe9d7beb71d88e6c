#include "iga/spline/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "iga/core/error.h"

namespace couture::iga {

namespace {

double knot_tolerance(const KnotVector& knots) {
    return knot_tolerance_of_span * (knots.back() - knots.front());
}

/// Index of the sorted value nearest to xi, if one lies within `tolerance`.
std::optional<std::size_t> find_near(std::span<const double> sorted, double xi, double tolerance) {
    const auto above = std::lower_bound(sorted.begin(), sorted.end(), xi) - sorted.begin();
    std::optional<std::size_t> nearest;
    double distance = tolerance;
    for (std::ptrdiff_t i = above - 1; i <= above; ++i) {
        if (i >= 0 && i < std::ssize(sorted) && std::abs(sorted[i] - xi) <= distance) {
            distance = std::abs(sorted[i] - xi);
            nearest = i;
        }
    }
    return nearest;
}

std::vector<double> expand(const std::vector<double>& breakpoints,
                           const std::vector<int>& multiplicities) {
    std::vector<double> knots;
    for (std::size_t i = 0; i < breakpoints.size(); ++i) {
        knots.insert(knots.end(), multiplicities[i], breakpoints[i]);
    }
    return knots;
}

/// Adds `factor` times the coefficients with which the blossom of a spline at the arguments
/// u_1 <= .. <= u_degree depends on its control points.
///
/// The arguments must be consecutive knots of a refinement of `knots`. They are then `n` of its
/// consecutive knots and some inserted ones, and each step of the de Boor triangle is a convex
/// combination: no cancellation, whatever the grading of the knots.
class Blossom {
  public:
    explicit Blossom(const KnotVector& knots)
        : knots_(knots), row_(knots.n_basis(), 0.0), first_(knots.n_basis()) {}

    void add(std::span<const double> u, double factor) {
        const std::vector<double>& t = knots_.knots();
        const int p = knots_.degree();
        std::array<double, max_degree> inserted{};
        int n_inserted = 0;
        int first_knot = -1;
        for (int i = 0; i < p;) {
            int count = 1;
            while (i + count < p && u[i + count] == u[i]) {
                ++count;
            }
            const auto [lower, upper] = std::equal_range(t.begin(), t.end(), u[i]);
            const int present = std::min<int>(count, static_cast<int>(upper - lower));
            if (i == 0) {
                first_knot = static_cast<int>(u[0] == knots_.back() ? lower - t.begin()
                                                                    : upper - t.begin() - present);
            }
            for (int k = present; k < count; ++k) {
                inserted[n_inserted++] = u[i];
            }
            i += count;
        }
        // weights[k] belongs to the blossom at the first r inserted knots and the p - r knots of
        // `t` that follow knot first - r + k, with r falling to 0.
        std::array<double, max_degree + 1> weights{};
        const int last = first_knot - 1;
        weights[0] = factor;
        for (int r = n_inserted; r > 0; --r) {
            const double x = inserted[r - 1];
            std::array<double, max_degree + 1> next{};
            for (int k = 0; k <= n_inserted - r; ++k) {
                const int j = last - (n_inserted - r) + k;
                const double a = t[j];
                const double b = t[j + p - r + 1];
                next[k] += weights[k] * (b - x) / (b - a);
                next[k + 1] += weights[k] * (x - a) / (b - a);
            }
            weights = next;
        }
        first_ = std::min(first_, last - n_inserted);
        last_ = std::max(last_, last);
        for (int k = 0; k <= n_inserted; ++k) {
            row_[last - n_inserted + k] += weights[k];
        }
    }

    /// Appends the row gathered so far and starts anew.
    void flush(int i_row, std::vector<Eigen::Triplet<double>>& triplets) {
        for (int j = first_; j <= last_; ++j) {
            if (row_[j] != 0.0) {
                triplets.emplace_back(i_row, j, row_[j]);
            }
            row_[j] = 0.0;
        }
        first_ = knots_.n_basis();
        last_ = -1;
    }

  private:
    const KnotVector& knots_;
    std::vector<double> row_;
    int first_;
    int last_ = -1;
};

double binomial(int n, int k) {
    double result = 1.0;
    for (int i = 1; i <= k; ++i) {
        result *= static_cast<double>(n - k + i) / i;
    }
    return result;
}

/// Calls `visit(subset, how often it occurs)` for the different subsets of `size` of the sorted
/// `values`.
template <typename Visit>
void for_each_subset(std::span<const double> values, int size, std::vector<double>& chosen,
                     double count, const Visit& visit) {
    const int n_missing = size - static_cast<int>(chosen.size());
    if (n_missing == 0) {
        visit(std::span<const double>(chosen), count);
        return;
    }
    const auto n_equal = static_cast<int>(
        std::upper_bound(values.begin(), values.end(), values.front()) - values.begin());
    const int n_rest = static_cast<int>(values.size()) - n_equal;
    for (int k = std::max(0, n_missing - n_rest); k <= std::min(n_equal, n_missing); ++k) {
        chosen.insert(chosen.end(), k, values.front());
        for_each_subset(values.subspan(n_equal), size, chosen, count * binomial(n_equal, k), visit);
        chosen.resize(chosen.size() - k);
    }
}

/// Matrix between spaces that contain each other with equal values of common knots. A control
/// point of the finer spline is its blossom at its degree many knots, and the blossom of a
/// polynomial written in a higher degree is the mean over all subsets of the arguments.
SparseMatrix prolongation_matrix(const KnotVector& coarse, const KnotVector& fine) {
    const double n_subsets = binomial(fine.degree(), coarse.degree());
    Blossom blossom(coarse);
    std::vector<Eigen::Triplet<double>> triplets;
    std::vector<double> chosen;
    const std::span<const double> knots(fine.knots());
    for (int i = 0; i < fine.n_basis(); ++i) {
        for_each_subset(knots.subspan(i + 1, fine.degree()), coarse.degree(), chosen, 1.0,
                        [&](std::span<const double> subset, double count) {
                            blossom.add(subset, count / n_subsets);
                        });
        blossom.flush(i, triplets);
    }
    SparseMatrix matrix(fine.n_basis(), coarse.n_basis());
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    return matrix;
}

void check_same_interval(const char* who, const KnotVector& a, const KnotVector& b) {
    const double tolerance = knot_tolerance(a);
    if (std::abs(a.front() - b.front()) > tolerance || std::abs(a.back() - b.back()) > tolerance) {
        throw InputError(
            "{}: the knot vectors span [{}, {}] and [{}, {}]; they must span the same interval, "
            "see KnotVector::rescaled",
            who, a.front(), a.back(), b.front(), b.back());
    }
}

}  // namespace

Refinement insert_knots(const KnotVector& knots, std::span<const double> new_knots) {
    const double tolerance = knot_tolerance(knots);
    std::vector<double> sorted(new_knots.begin(), new_knots.end());
    for (const double xi : sorted) {
        if (!(xi > knots.front() + tolerance && xi < knots.back() - tolerance)) {
            throw InputError("insert_knots: new knot {} does not lie inside ({}, {})", xi,
                             knots.front(), knots.back());
        }
    }
    std::sort(sorted.begin(), sorted.end());
    double previous = knots.front();
    for (double& xi : sorted) {
        if (const auto i = find_near(knots.breakpoints(), xi, tolerance)) {
            xi = knots.breakpoints()[*i];
        } else if (xi - previous <= tolerance) {
            xi = previous;
        }
        previous = xi;
    }
    sorted.insert(sorted.end(), knots.knots().begin(), knots.knots().end());
    std::sort(sorted.begin(), sorted.end());
    const int p = knots.degree();
    for (std::size_t i = p + 1; i + 2 * p + 1 < sorted.size(); ++i) {
        if (sorted[i] == sorted[i + p]) {
            const auto count = std::count(sorted.begin(), sorted.end(), sorted[i]);
            throw InputError(
                "insert_knots: knot {} would occur {} times; an interior knot of degree {} occurs "
                "at most {} times",
                sorted[i], count, p, p);
        }
    }
    KnotVector fine(p, std::move(sorted));
    SparseMatrix prolongation = prolongation_matrix(knots, fine);
    return {std::move(fine), std::move(prolongation)};
}

Refinement elevate_degree(const KnotVector& knots, int n_times) {
    if (n_times < 0 || knots.degree() + n_times > max_degree) {
        throw InputError(
            "elevate_degree: degree {} raised {} times; the result must be from {} to {}",
            knots.degree(), n_times, knots.degree(), max_degree);
    }
    std::vector<int> multiplicities = knots.multiplicities();
    for (int& multiplicity : multiplicities) {
        multiplicity += n_times;
    }
    KnotVector fine(knots.degree() + n_times, expand(knots.breakpoints(), multiplicities));
    SparseMatrix prolongation = prolongation_matrix(knots, fine);
    return {std::move(fine), std::move(prolongation)};
}

Refinement refine(const KnotVector& knots, int degree, int n_elements) {
    if (degree < knots.degree() || degree > max_degree) {
        throw InputError(
            "refine: degree {} asked of a spline of degree {}; it can only be raised, up to {}",
            degree, knots.degree(), max_degree);
    }
    if (n_elements < 1) {
        throw InputError("refine: {} elements asked; must be at least 1", n_elements);
    }
    const int n_parts = (n_elements + knots.n_elements() - 1) / knots.n_elements();
    const int n_times = degree - knots.degree();
    std::vector<double> fine_knots;
    for (int e = 0; e <= knots.n_elements(); ++e) {
        const double first = knots.breakpoints()[e];
        fine_knots.insert(fine_knots.end(), knots.multiplicities()[e] + n_times, first);
        if (e == knots.n_elements()) {
            break;
        }
        const double width = knots.breakpoints()[e + 1] - first;
        // An element so small that its parts would be slivers stays whole.
        for (int i = 1; i < n_parts && width / n_parts > knot_tolerance(knots); ++i) {
            fine_knots.push_back(first + width * i / n_parts);
        }
    }
    KnotVector fine(degree, std::move(fine_knots));
    SparseMatrix prolongation = prolongation_matrix(knots, fine);
    return {std::move(fine), std::move(prolongation)};
}

Refinement prolongation_to(const KnotVector& coarse, const KnotVector& fine) {
    const int n_times = fine.degree() - coarse.degree();
    if (n_times < 0) {
        throw InputError(
            "prolongation_to: degree {} of the finer space is below degree {} of the coarser one; "
            "it must not be",
            fine.degree(), coarse.degree());
    }
    check_same_interval("prolongation_to", coarse, fine);
    const double tolerance = knot_tolerance(coarse);
    std::vector<double> breakpoints = coarse.breakpoints();
    for (std::size_t i = 0; i < breakpoints.size(); ++i) {
        const auto there = find_near(fine.breakpoints(), breakpoints[i], tolerance);
        if (!there) {
            throw InputError(
                "prolongation_to: knot {} of the coarser space is missing in the finer one; all "
                "must be there, see common_refinement",
                breakpoints[i]);
        }
        const int needed = coarse.multiplicities()[i] + n_times;
        if (fine.multiplicities()[*there] < needed) {
            throw InputError(
                "prolongation_to: knot {} occurs {} times in the finer space; it must occur at "
                "least {} times, the {} of the coarser one and {} for the raised degree",
                breakpoints[i], fine.multiplicities()[*there], needed, coarse.multiplicities()[i],
                n_times);
        }
        breakpoints[i] = fine.breakpoints()[*there];
    }
    if (!coarse.is_open()) {
        // A part of a space keeps the knots beyond its ends, which `fine` has not.
        return {fine, prolongation_matrix(coarse, fine)};
    }
    const KnotVector snapped(coarse.degree(), expand(breakpoints, coarse.multiplicities()));
    return {fine, prolongation_matrix(snapped, fine)};
}

KnotVector common_refinement(const KnotVector& a, const KnotVector& b) {
    check_same_interval("common_refinement", a, b);
    const int degree = std::max(a.degree(), b.degree());
    const double tolerance = knot_tolerance(a);
    struct Knot {
        double value;
        int multiplicity;
    };
    std::vector<Knot> common;
    for (int i = 0; i <= a.n_elements(); ++i) {
        common.push_back({a.breakpoints()[i], a.multiplicities()[i] + degree - a.degree()});
    }
    for (int i = 0; i <= b.n_elements(); ++i) {
        const int multiplicity = b.multiplicities()[i] + degree - b.degree();
        if (const auto here = find_near(a.breakpoints(), b.breakpoints()[i], tolerance)) {
            common[*here].multiplicity = std::max(common[*here].multiplicity, multiplicity);
        } else {
            common.push_back({b.breakpoints()[i], multiplicity});
        }
    }
    std::sort(common.begin(), common.end(),
              [](const Knot& x, const Knot& y) { return x.value < y.value; });
    std::vector<double> knots;
    for (const Knot& knot : common) {
        knots.insert(knots.end(), knot.multiplicity, knot.value);
    }
    return {degree, std::move(knots)};
}

template <int d>
MatrixX apply_kronecker(const std::array<SparseMatrix, d>& matrices, const MatrixX& coefficients) {
    Eigen::Index n_columns = 1;
    for (const SparseMatrix& matrix : matrices) {
        n_columns *= matrix.cols();
    }
    if (coefficients.rows() != n_columns) {
        throw InputError("apply_kronecker: {} rows of coefficients; the matrices ask for {}",
                         coefficients.rows(), n_columns);
    }
    // Each step acts on the first index and moves it behind the others.
    MatrixX current = coefficients;
    for (const SparseMatrix& matrix : matrices) {
        const Eigen::Map<const MatrixX> unfolded(current.data(), matrix.cols(),
                                                 current.size() / matrix.cols());
        const MatrixX product = matrix * unfolded;
        current = product.transpose();
    }
    const Eigen::Map<const MatrixX> unfolded(current.data(), coefficients.cols(),
                                             current.size() / coefficients.cols());
    return unfolded.transpose();
}

template <int d>
Patch<d> refine(const Patch<d>& patch, const std::array<Refinement, d>& directions) {
    std::array<SparseMatrix, d> matrices;
    TensorSpace<d> space = patch.space();
    for (int k = 0; k < d; ++k) {
        matrices[k] = directions[k].prolongation;
        space.knots[k] = directions[k].knots;
        if (matrices[k].cols() != patch.knots(k).n_basis()) {
            throw InputError(
                "refine: the refinement of direction {} starts from {} functions; the patch has {}",
                k, matrices[k].cols(), patch.knots(k).n_basis());
        }
    }
    return Patch<d>::from_homogeneous(
        std::move(space), apply_kronecker<d>(matrices, patch.homogeneous()), patch.is_rational());
}

template <int d>
Patch<d> refine_to(const Patch<d>& patch, const TensorSpace<d>& space) {
    std::array<SparseMatrix, d> matrices;
    for (int k = 0; k < d; ++k) {
        matrices[k] = prolongation_to(patch.knots(k), space.knots[k]).prolongation;
    }
    return Patch<d>::from_homogeneous(space, apply_kronecker<d>(matrices, patch.homogeneous()),
                                      patch.is_rational());
}

template Patch<1> refine<1>(const Patch<1>&, const std::array<Refinement, 1>&);
template Patch<2> refine<2>(const Patch<2>&, const std::array<Refinement, 2>&);
template Patch<3> refine<3>(const Patch<3>&, const std::array<Refinement, 3>&);
template Patch<1> refine_to<1>(const Patch<1>&, const TensorSpace<1>&);
template Patch<2> refine_to<2>(const Patch<2>&, const TensorSpace<2>&);
template Patch<3> refine_to<3>(const Patch<3>&, const TensorSpace<3>&);
template MatrixX apply_kronecker<1>(const std::array<SparseMatrix, 1>&, const MatrixX&);
template MatrixX apply_kronecker<2>(const std::array<SparseMatrix, 2>&, const MatrixX&);
template MatrixX apply_kronecker<3>(const std::array<SparseMatrix, 3>&, const MatrixX&);

}  // namespace couture::iga
