#include "iga/spline/point_inversion.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <span>

#include "iga/core/error.h"
#include "iga/spline/bezier_cell.h"

namespace couture::iga {

namespace {

/// A cell is searched as one when its control net differs from a multilinear one by less than this
/// part of its size: then its distance function has one valley and Newton finds it.
constexpr double flatness = 0.1;
/// Halvings of one element at most: maps like t^2 never get flat at 0.
constexpr int max_halvings = 12;
constexpr int max_newton_steps = 60;
constexpr int max_backtracks = 30;
/// Distances below this part of the coordinates are rounding.
constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();

/// Axis-parallel box; unused coordinates stay 0.
struct Box {
    Vector3 lower = Vector3::Zero();
    Vector3 upper = Vector3::Zero();

    void extend(const Box& other) {
        lower = lower.cwiseMin(other.lower);
        upper = upper.cwiseMax(other.upper);
    }
    [[nodiscard]] Vector3 center() const { return 0.5 * (lower + upper); }
    [[nodiscard]] double distance(const Vector3& x) const {
        return (lower - x).cwiseMax(x - upper).cwiseMax(0.0).norm();
    }
};

Box bounding_box(const MatrixX& points) {
    Box box;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        box.lower[i] = points.col(i).minCoeff();
        box.upper[i] = points.col(i).maxCoeff();
    }
    return box;
}

/// Corner `i_corner` of a control net: bit k chooses the end of direction k.
template <int d>
int corner_index(const std::array<int, d>& degrees, int i_corner) {
    int index = 0;
    for (int k = d - 1; k >= 0; --k) {
        index = index * (degrees[k] + 1) + ((i_corner >> k & 1) != 0 ? degrees[k] : 0);
    }
    return index;
}

template <int d>
bool is_flat(const BezierCell<d>& cell, const MatrixX& points) {
    double deviation = 0.0;
    for (int i = 0; i < points.rows(); ++i) {
        Eigen::RowVectorXd linear = points.row(i);
        for (int corner = 0; corner < 1 << d; ++corner) {
            double weight = 1.0;
            int rest = i;
            for (int k = 0; k < d; ++k) {
                const double t =
                    static_cast<double>(rest % (cell.degrees[k] + 1)) / cell.degrees[k];
                weight *= (corner >> k & 1) != 0 ? t : 1.0 - t;
                rest /= cell.degrees[k] + 1;
            }
            linear -= weight * points.row(corner_index<d>(cell.degrees, corner));
        }
        deviation = std::max(deviation, linear.norm());
    }
    const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
    return deviation <= flatness * size;
}

/// Direction with the largest second difference of control points.
template <int d>
int most_curved_direction(const BezierCell<d>& cell, const MatrixX& points) {
    int result = 0;
    double largest = -1.0;
    int stride = 1;
    for (int k = 0; k < d; ++k) {
        const int p = cell.degrees[k];

        double bend = 0.0;
        for (int i = 0; i < points.rows(); ++i) {
            const int local = i / stride % (p + 1);
            if (local > 0 && local < p) {
                const auto second =
                    points.row(i - stride) - 2.0 * points.row(i) + points.row(i + stride);
                bend = std::max(bend, p * p * second.norm());
            }
        }
        if (bend > largest) {
            largest = bend;
            result = k;
        }
        stride *= p + 1;
    }
    return result;
}

/// Whether the tangents of a cell differ so little that it can't fold back on itself: by less than
/// half the least singular value of the middle ones, each tangent measured by its length there.
template <int d>
bool is_regular(const BezierCell<d>& cell, const MatrixX& points) {
    auto tangents = evaluate<d>(cell, Vector<d>::Constant(0.5)).dx;
    double change = 0.0;
    int stride = 1;
    for (int k = 0; k < d; ++k) {
        const int p = cell.degrees[k];
        double largest = 0.0;
        for (int i = 0; i < points.rows(); ++i) {
            if (i / stride % (p + 1) < p) {
                const VectorX difference =
                    p * (points.row(i + stride) - points.row(i)).transpose() - tangents.col(k);
                largest = std::max(largest, difference.norm());
            }
        }
        const double length = tangents.col(k).norm();
        if (!(largest < length)) {
            return false;
        }
        tangents.col(k) /= length;
        change += (largest / length) * (largest / length);
        stride *= p + 1;
    }
    const Matrix<d> metric = tangents.transpose() * tangents;
    const Eigen::SelfAdjointEigenSolver<Matrix<d>> eigen(metric, Eigen::EigenvaluesOnly);
    return change < 0.25 * eigen.eigenvalues()[0];
}

template <int d>
void add_flat_cells(const BezierCell<d>& cell, int n_halvings,
                    std::vector<BezierCell<d>>& flat_cells) {
    const MatrixX points = cell.points();
    if (n_halvings == max_halvings || is_flat(cell, points)) {
        flat_cells.push_back(cell);
        return;
    }
    for (const BezierCell<d>& half : halve(cell, most_curved_direction(cell, points))) {
        add_flat_cells(half, n_halvings + 1, flat_cells);
    }
}

/// Half the squared distance from a point to one of a cell, with derivatives by t.
template <int d>
struct Objective {
    double value;
    Vector<d> gradient;
    Matrix<d> hessian;
};

template <int d>
Objective<d> objective(const BezierCell<d>& cell, const Vector<d>& t, const VectorX& point) {
    const BezierPoint<d> at = evaluate(cell, t);
    const VectorX residual = at.x - point;
    Objective<d> result;
    result.value = 0.5 * residual.squaredNorm();
    result.gradient = at.dx.transpose() * residual;
    result.hessian = at.dx.transpose() * at.dx;
    for (int k = 0; k < d; ++k) {
        for (int l = 0; l < d; ++l) {
            result.hessian(k, l) += residual.dot(at.ddx.col(k + d * l));
        }
    }
    return result;
}

/// The gradient without the parts that push against the sides of the box.
template <int d>
Vector<d> projected_gradient(const Objective<d>& f, const Vector<d>& t) {
    Vector<d> result = f.gradient;
    for (int k = 0; k < d; ++k) {
        if ((t[k] <= 0.0 && result[k] > 0.0) || (t[k] >= 1.0 && result[k] < 0.0)) {
            result[k] = 0.0;
        }
    }
    return result;
}

/// Newton's step in the free directions, downhill also where the Hessian is not positive.
template <int d>
Vector<d> newton_step(const Objective<d>& f, const Vector<d>& free_gradient) {
    Matrix<d> hessian = f.hessian;
    for (int k = 0; k < d; ++k) {
        if (free_gradient[k] == 0.0) {
            hessian.row(k).setZero();
            hessian.col(k).setZero();
        }
    }
    const Eigen::SelfAdjointEigenSolver<Matrix<d>> eigen(hessian);
    const Vector<d> magnitudes = eigen.eigenvalues().cwiseAbs();
    const double floor =
        std::max(1e-14 * magnitudes.maxCoeff(), std::numeric_limits<double>::min());
    const Vector<d> components = (eigen.eigenvectors().transpose() * free_gradient)
                                     .cwiseQuotient(magnitudes.cwiseMax(floor));
    Vector<d> step = -eigen.eigenvectors() * components;
    for (int k = 0; k < d; ++k) {
        if (free_gradient[k] == 0.0) {
            step[k] = 0.0;
        }
    }
    return step;
}

/// Local minimum of the distance in a cell by projected Newton steps with backtracking.
/// Source: [NocedalWright06] Sec. 3.4, 16.7.
template <int d>
Vector<d> descend(const BezierCell<d>& cell, const VectorX& point, Vector<d> t) {
    Objective<d> f = objective(cell, t, point);
    for (int i = 0; i < max_newton_steps; ++i) {
        const Vector<d> gradient = projected_gradient(f, t);
        if (gradient.isZero(0.0)) {
            break;
        }
        Vector<d> step = newton_step(f, gradient);
        bool accepted = false;
        double moved = 0.0;
        for (int j = 0; j < max_backtracks && !accepted; ++j) {
            const Vector<d> next = (t + step).cwiseMax(0.0).cwiseMin(1.0);
            moved = (next - t).cwiseAbs().maxCoeff();
            const Objective<d> there = objective(cell, next, point);
            const bool is_lower = there.value < f.value + 1e-4 * gradient.dot(next - t);
            // Near the minimum only the gradient still tells better from worse.
            const bool is_flatter = there.value <= f.value * (1.0 + rounding) &&
                                    projected_gradient(there, next).norm() < 0.5 * gradient.norm();
            if (is_lower || is_flatter) {
                t = next;
                f = there;
                accepted = true;
            }
            // Back along the projected path: from the side of the box if it went far beyond.
            const double overshoot = step.cwiseAbs().maxCoeff();
            step *= overshoot > 2.0 ? 1.0 / overshoot : 0.5;
        }
        if (!accepted || moved <= std::numeric_limits<double>::epsilon()) {
            break;
        }
    }
    return t;
}

}  // namespace

template <int d>
struct PointInversion<d>::Tree {
    /// Inner nodes have children `child` and `child + 1`; leaves hold one cell.
    struct Node {
        Box box;
        int child = -1;
        int cell = -1;
    };

    explicit Tree(const Patch<d>& patch_to_invert) : patch(patch_to_invert) {
        for (const BezierCell<d>& element : bezier_cells(patch)) {
            add_flat_cells(element, 0, cells);
        }
        std::vector<Box> boxes;
        boxes.reserve(cells.size());
        for (const BezierCell<d>& cell : cells) {
            const MatrixX points = cell.points();
            boxes.push_back(bounding_box(points));
            regular.push_back(is_regular(cell, points));
        }
        std::vector<int> order(cells.size());
        std::iota(order.begin(), order.end(), 0);
        nodes.reserve(2 * cells.size());
        nodes.emplace_back();
        build(0, order, boxes);
    }

    void build(int i_node, std::span<int> order, const std::vector<Box>& boxes) {
        Box box = boxes[order[0]];
        Box centers{boxes[order[0]].center(), boxes[order[0]].center()};
        for (const int i : order) {
            box.extend(boxes[i]);
            centers.extend({boxes[i].center(), boxes[i].center()});
        }
        nodes[i_node].box = box;
        if (order.size() == 1) {
            nodes[i_node].cell = order[0];
            return;
        }
        Eigen::Index axis = 0;
        (centers.upper - centers.lower).maxCoeff(&axis);
        const std::size_t half = order.size() / 2;
        std::nth_element(order.begin(), order.begin() + half, order.end(), [&](int a, int b) {
            return boxes[a].center()[axis] < boxes[b].center()[axis];
        });
        const int child = static_cast<int>(nodes.size());
        nodes[i_node].child = child;
        nodes.resize(nodes.size() + 2);
        build(child, order.first(half), boxes);
        build(child + 1, order.subspan(half), boxes);
    }

    /// Nearest point of a cell: descends from the middle and the nearest corner, and from the other
    /// corners where the cell may fold.
    [[nodiscard]] InvertedPoint<d> nearest_in_cell(int i_cell, const VectorX& point) const {
        const BezierCell<d>& cell = cells[i_cell];
        struct Start {
            double distance;
            Vector<d> t;
        };
        std::array<Start, 1 << d> corners;
        for (int i = 0; i < 1 << d; ++i) {
            const auto row = cell.rows.row(corner_index<d>(cell.degrees, i));
            const VectorX x = row.head(point.size()).transpose() / row[point.size()];
            corners[i].distance = (x - point).norm();
            for (int k = 0; k < d; ++k) {
                corners[i].t[k] = (i >> k & 1) != 0 ? 1.0 : 0.0;
            }
        }
        std::sort(corners.begin(), corners.end(),
                  [](const Start& a, const Start& b) { return a.distance < b.distance; });
        InvertedPoint<d> result{Vector<d>::Zero(), std::numeric_limits<double>::infinity()};
        const int n_corners = regular[i_cell] ? 1 : 1 << d;
        for (int i = -1; i < n_corners && result.distance > zero(point); ++i) {
            const Vector<d> start = i < 0 ? Vector<d>(Vector<d>::Constant(0.5)) : corners[i].t;
            const Vector<d> t = descend<d>(cell, point, start);
            Vector<d> xi;
            for (int k = 0; k < d; ++k) {
                xi[k] = t[k] >= 1.0 ? cell.upper[k]
                                    : cell.lower[k] + t[k] * (cell.upper[k] - cell.lower[k]);
            }
            const double distance = (patch.point(xi) - point).norm();
            if (distance < result.distance) {
                result = {xi, distance};
            }
        }
        return result;
    }

    [[nodiscard]] double zero(const VectorX& point) const {
        const double size = std::max(nodes[0].box.lower.cwiseAbs().maxCoeff(),
                                     nodes[0].box.upper.cwiseAbs().maxCoeff());
        return rounding * std::max(size, point.cwiseAbs().maxCoeff());
    }

    /// Nearest point of the patch if one lies closer than `limit`.
    [[nodiscard]] std::optional<InvertedPoint<d>> nearest_within(const VectorX& point,
                                                                 double limit) const {
        if (point.size() != patch.dimension()) {
            throw InputError("PointInversion: point of {} coordinates; the patch has {}",
                             point.size(), patch.dimension());
        }
        if (!point.allFinite()) {
            throw InputError("PointInversion: the point has a coordinate that is not finite");
        }
        Vector3 x = Vector3::Zero();
        for (Eigen::Index i = 0; i < point.size(); ++i) {
            x[i] = point[i];
        }
        struct Candidate {
            double bound;
            double to_center;
            int node;
            bool operator<(const Candidate& other) const {
                return bound != other.bound ? bound > other.bound : to_center > other.to_center;
            }
        };
        std::priority_queue<Candidate> queue;
        const auto push = [&](int i_node) {
            const Box& box = nodes[i_node].box;
            queue.push({box.distance(x), (box.center() - x).norm(), i_node});
        };
        std::optional<InvertedPoint<d>> best;
        double best_distance = limit;
        push(0);
        while (!queue.empty() && queue.top().bound <= best_distance &&
               (!best || best_distance > zero(point))) {
            const Node& node = nodes[queue.top().node];
            queue.pop();
            if (node.cell < 0) {
                push(node.child);
                push(node.child + 1);
                continue;
            }
            const InvertedPoint<d> found = nearest_in_cell(node.cell, point);
            if (found.distance < best_distance || (!best && found.distance <= best_distance)) {
                best = found;
                best_distance = found.distance;
            }
        }
        return best;
    }

    Patch<d> patch;
    std::vector<BezierCell<d>> cells;
    /// Of each cell: whether it can't fold.
    std::vector<bool> regular;
    std::vector<Node> nodes;
};

template <int d>
PointInversion<d>::PointInversion(const Patch<d>& patch) : tree_(std::make_unique<Tree>(patch)) {}
template <int d>
PointInversion<d>::PointInversion(PointInversion&&) noexcept = default;
template <int d>
PointInversion<d>& PointInversion<d>::operator=(PointInversion&&) noexcept = default;
template <int d>
PointInversion<d>::~PointInversion() = default;

template <int d>
InvertedPoint<d> PointInversion<d>::nearest(const VectorX& point) const {
    return *tree_->nearest_within(point, std::numeric_limits<double>::infinity());
}

template <int d>
std::optional<Vector<d>> PointInversion<d>::find(const VectorX& point, double tolerance) const {
    const auto found = tree_->nearest_within(point, tolerance);
    return found ? std::optional<Vector<d>>(found->xi) : std::nullopt;
}

template class PointInversion<1>;
template class PointInversion<2>;
template class PointInversion<3>;

}  // namespace couture::iga
