#include "rom/designs.h"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "iga/core/error.h"

namespace couture::rom {

namespace {

using Random = std::mt19937_64;

void check(const char* who, int n_parameters, int n_points) {
    if (n_parameters < 1 || n_points < 1) {
        throw InputError("{}: {} points of {} parameters; both must be at least 1", who, n_points,
                         n_parameters);
    }
}

/// In [0, 1), the same for every standard library.
double uniform(Random& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

int below(Random& random, int n) { return std::min(n - 1, static_cast<int>(uniform(random) * n)); }

void shuffle(std::vector<int>& values, Random& random) {
    for (int i = static_cast<int>(values.size()) - 1; i > 0; --i) {
        std::swap(values[i], values[below(random, i + 1)]);
    }
}

MatrixX random_hypercube(int n_parameters, int n_points, Random& random) {
    MatrixX points(n_points, n_parameters);
    std::vector<int> order(n_points);
    for (int axis = 0; axis < n_parameters; ++axis) {
        std::iota(order.begin(), order.end(), 0);
        shuffle(order, random);
        for (int i = 0; i < n_points; ++i) {
            points(i, axis) = (order[i] + 0.5) / n_points;
        }
    }
    return points;
}

constexpr int exponent = 15;

/// Share of one point in phi^p: the sum of 1 / distance^p to the others but `left_out`.
double crowding(const MatrixX& points, int point, int left_out) {
    double sum = 0.0;
    for (int i = 0; i < points.rows(); ++i) {
        if (i != point && i != left_out) {
            sum += std::pow((points.row(i) - points.row(point)).squaredNorm(), -0.5 * exponent);
        }
    }
    return sum;
}

/// Exchanges one coordinate of two points if that lowers phi. The distance between the two stays.
void try_exchange(MatrixX& points, int a, int b, int axis) {
    const double before = crowding(points, a, b) + crowding(points, b, a);
    std::swap(points(a, axis), points(b, axis));
    if (crowding(points, a, b) + crowding(points, b, a) >= before) {
        std::swap(points(a, axis), points(b, axis));
    }
}

/// Positions on an axis that a nested rule adds at a level, as fractions of the axis.
std::vector<double> added_fractions(int level) {
    if (level == 0) {
        return {0.5};
    }
    if (level == 1) {
        return {0.0, 1.0};
    }
    std::vector<double> fractions;
    const int n = 1 << level;
    for (int i = 1; i < n; i += 2) {
        fractions.push_back(static_cast<double>(i) / n);
    }
    return fractions;
}

double position(double fraction, NestedRule rule) {
    return rule == NestedRule::equidistant ? fraction
                                           : 0.5 * (1.0 - std::cos(std::numbers::pi * fraction));
}

/// Each point of a sparse grid has one level on each axis: that at which its position was added.
void add_grid_points(int axis, int levels_left, NestedRule rule, VectorX& point,
                     std::vector<VectorX>& points) {
    if (axis == point.size()) {
        points.push_back(point);
        return;
    }
    for (int level = 0; level <= levels_left; ++level) {
        for (const double fraction : added_fractions(level)) {
            point[axis] = fraction == 0.5 ? 0.5 : position(fraction, rule);
            add_grid_points(axis + 1, levels_left - level, rule, point, points);
        }
    }
}

MatrixX rows(const std::vector<VectorX>& points) {
    MatrixX matrix(points.size(), points.front().size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        matrix.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
    }
    return matrix;
}

}  // namespace

MatrixX star_design(int n_parameters, int level) {
    check("star_design", n_parameters, 1);
    if (level != 1 && level != 2) {
        throw InputError(
            "star_design: level {}; it must be 1 (ends of the axes) or 2 (and half way)", level);
    }
    const std::vector<double> positions =
        level == 1 ? std::vector<double>{0.0, 1.0} : std::vector<double>{0.0, 0.25, 0.75, 1.0};
    const int n_positions = static_cast<int>(positions.size());
    MatrixX points = MatrixX::Constant(1 + n_positions * n_parameters, n_parameters, 0.5);
    for (int axis = 0; axis < n_parameters; ++axis) {
        for (int i = 0; i < n_positions; ++i) {
            points(1 + axis * n_positions + i, axis) = positions[i];
        }
    }
    return points;
}

MatrixX full_design(int n_parameters, int n_per_axis) {
    check("full_design", n_parameters, n_per_axis);
    constexpr double most_points = 1e7;
    if (std::pow(n_per_axis, n_parameters) > most_points) {
        throw InputError("full_design: {}^{} points are more than {}; take a sparse design",
                         n_per_axis, n_parameters, most_points);
    }
    const auto n_points = static_cast<int>(std::lround(std::pow(n_per_axis, n_parameters)));
    MatrixX points(n_points, n_parameters);
    for (int i = 0; i < n_points; ++i) {
        for (int axis = n_parameters - 1, rest = i; axis >= 0; --axis, rest /= n_per_axis) {
            points(i, axis) =
                n_per_axis == 1 ? 0.5 : static_cast<double>(rest % n_per_axis) / (n_per_axis - 1);
        }
    }
    return points;
}

MatrixX random_design(int n_parameters, int n_points, std::uint64_t seed) {
    check("random_design", n_parameters, n_points);
    Random random(seed);
    return MatrixX::NullaryExpr(n_points, n_parameters, [&] { return uniform(random); });
}

MatrixX normal_design(int n_parameters, int n_points, std::uint64_t seed) {
    check("normal_design", n_parameters, n_points);
    const MatrixX uniform = random_design(2, n_parameters * n_points, seed);
    MatrixX values(n_points, n_parameters);
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        values.data()[i] = std::sqrt(-2.0 * std::log1p(-uniform(i, 0))) *
                           std::cos(2.0 * std::numbers::pi * uniform(i, 1));
    }
    return values;
}

MatrixX sobol_design(int n_parameters, int n_points) {
    check("sobol_design", n_parameters, n_points);
    boost::random::sobol sequence(static_cast<std::size_t>(n_parameters));
    const double scale = 1.0 / (static_cast<double>(boost::random::sobol::max()) + 1.0);
    MatrixX points(n_points, n_parameters);
    for (int i = 0; i < n_points; ++i) {
        for (int axis = 0; axis < n_parameters; ++axis) {
            points(i, axis) = static_cast<double>(sequence()) * scale;
        }
    }
    return points;
}

MatrixX latin_hypercube_design(int n_parameters, int n_points, std::uint64_t seed) {
    check("latin_hypercube_design", n_parameters, n_points);
    Random random(seed);
    MatrixX points = random_hypercube(n_parameters, n_points, random);
    if (n_points < 3 || n_parameters < 2) {
        return points;
    }
    // Enough for phi to settle; one exchange costs O(n d).
    const int n_exchanges = 200 * n_points;
    for (int i = 0; i < n_exchanges; ++i) {
        const int a = below(random, n_points);
        const int b = (a + 1 + below(random, n_points - 1)) % n_points;
        try_exchange(points, a, b, below(random, n_parameters));
    }
    return points;
}

MatrixX smolyak_design(int n_parameters, int level, NestedRule rule) {
    check("smolyak_design", n_parameters, 1);
    constexpr int highest = 20;
    if (level < 0 || level > highest) {
        throw InputError("smolyak_design: level {}; it must be 0 to {}", level, highest);
    }
    std::vector<VectorX> points;
    VectorX point(n_parameters);
    add_grid_points(0, level, rule, point, points);
    return rows(points);
}

}  // namespace couture::rom
