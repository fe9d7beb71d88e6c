#include "meshing/volume/boundary_slide.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "iga/core/parallel.h"
#include "iga/spline/approximate.h"
#include "iga/topology/side_patch.h"

namespace couture::meshing {

using iga::Patch;

namespace {

/// Control points within this part of their size of a plane or line lie in it.
constexpr double flatness = 1e-10;
constexpr int max_newton_steps = 40;
/// Steps below this part of the coordinates end a descent.
constexpr double rounding = 1e-15;

/// Extent of points (columns) along their principal axes, ascending, and the axes.
struct PrincipalAxes {
    Vector3 extents;
    Matrix<3> axes;
};

PrincipalAxes principal_axes(const MatrixX& points) {
    const Vector3 centre = points.rowwise().mean();
    const MatrixX arms = points.colwise() - centre;
    const Eigen::SelfAdjointEigenSolver<Matrix<3>> eigen(Matrix<3>(arms * arms.transpose()));
    PrincipalAxes result;
    result.axes = eigen.eigenvectors();
    result.extents = (result.axes.transpose() * arms).cwiseAbs().rowwise().maxCoeff();
    return result;
}

/// Point of a patch.
template <int e>
struct Foot {
    Vector<e> xi;
    Vector3 x;
    double distance = std::numeric_limits<double>::infinity();
    bool has_converged = false;
};

/// Descends to the nearest point of a patch by Gauss and Newton's method within the parameter box;
/// converges fast where the distance is small against the radius of curvature.
/// Source: [NocedalWright06] Sec. 10.3, 16.7.
template <int e>
Foot<e> descend(const Patch<e>& patch, const Vector3& x, Vector<e> xi) {
    Foot<e> foot;
    Vector<e> step = Vector<e>::Zero();
    for (int i = 0; i < max_newton_steps; ++i) {
        const Vector<e> next = xi + step;
        const iga::PointBasis<e> basis =
            iga::evaluate_basis<e>(patch.space(), patch.weights(), next);
        Vector3 point = Vector3::Zero();
        Matrix<3, e> tangents = Matrix<3, e>::Zero();
        for (std::size_t f = 0; f < basis.functions.size(); ++f) {
            const Vector3 control_point =
                patch.control_points().row(basis.functions[f]).transpose();
            point += basis.values[f] * control_point;
            tangents += control_point * basis.gradients.row(f);
        }
        const double distance = (point - x).norm();
        if (distance > foot.distance) {
            step *= 0.5;
            continue;
        }
        xi = next;
        foot = {xi, point, distance, false};
        Vector<e> gradient = tangents.transpose() * (point - x);
        Matrix<e> hessian = tangents.transpose() * tangents;
        for (int k = 0; k < e; ++k) {
            const iga::KnotVector& knots = patch.knots(k);
            if ((xi[k] <= knots.front() && gradient[k] > 0.0) ||
                (xi[k] >= knots.back() && gradient[k] < 0.0)) {
                gradient[k] = 0.0;
                hessian.row(k).setZero();
                hessian.col(k).setZero();
                hessian(k, k) = 1.0;
            }
        }
        step = -hessian.ldlt().solve(gradient);
        for (int k = 0; k < e; ++k) {
            const iga::KnotVector& knots = patch.knots(k);
            step[k] = std::clamp(xi[k] + step[k], knots.front(), knots.back()) - xi[k];
        }
        const double size = std::max(point.cwiseAbs().maxCoeff(), x.cwiseAbs().maxCoeff());
        if (!step.allFinite() || (tangents * step).norm() <= rounding * size) {
            foot.has_converged = step.allFinite();
            break;
        }
    }
    return foot;
}

/// Patches of a face or curve as they were, for nearest points: the best of samples (breakpoints
/// and middles of elements) is where the descent starts.
template <int e>
class Target {
  public:
    void add(Patch<e> patch) {
        std::array<std::vector<double>, e> positions;
        int n = 1;
        for (int k = 0; k < e; ++k) {
            const std::vector<double>& b = patch.knots(k).breakpoints();
            for (std::size_t i = 0; i + 1 < 2 * b.size(); ++i) {
                positions[k].push_back(0.5 * (b[i / 2] + b[(i + 1) / 2]));
            }
            n *= static_cast<int>(positions[k].size());
        }
        Samples samples{MatrixX(3, n), MatrixX(e, n)};
        for (int i = 0; i < n; ++i) {
            Vector<e> xi;
            for (int k = 0, rest = i; k < e; ++k) {
                const int n_here = static_cast<int>(positions[k].size());
                xi[k] = positions[k][rest % n_here];
                rest /= n_here;
            }
            samples.xi.col(i) = xi;
            samples.x.col(i) = patch.point(xi);
        }
        samples_.push_back(std::move(samples));
        inversions_.emplace_back(patch);
        patches_.push_back(std::move(patch));
    }

    [[nodiscard]] Vector3 nearest(const Vector3& x) const {
        std::vector<double> distances;
        std::vector<Eigen::Index> seeds;
        for (const Samples& samples : samples_) {
            Eigen::Index seed = 0;
            distances.push_back((samples.x.colwise() - x).colwise().squaredNorm().minCoeff(&seed));
            seeds.push_back(seed);
        }
        const double least = *std::min_element(distances.begin(), distances.end());
        Foot<e> best;
        for (std::size_t i = 0; i < patches_.size(); ++i) {
            // Samples of an adjoining patch may be up to about twice as far as the nearest.
            if (distances[i] > 4.0 * least) {
                continue;
            }
            Foot<e> foot = descend<e>(patches_[i], x, samples_[i].xi.col(seeds[i]));
            if (!foot.has_converged) {
                const iga::InvertedPoint<e> found = inversions_[i].nearest(x);
                foot = {found.xi, patches_[i].point(found.xi), found.distance, true};
            }
            if (foot.distance < best.distance) {
                best = foot;
            }
        }
        return best.x;
    }

  private:
    struct Samples {
        MatrixX x;
        MatrixX xi;
    };
    std::vector<Patch<e>> patches_;
    std::vector<Samples> samples_;
    std::vector<iga::PointInversion<e>> inversions_;
};

/// A side or edge with its functions at its Greville points.
template <int e>
struct Entity {
    iga::TensorSpace<e> space;
    /// Empty, or of each function.
    VectorX weights;
    std::vector<int> dofs;
    std::vector<iga::PointBasis<e>> at_greville;
    /// The denominators there.
    VectorX weights_at_greville;

    Entity(const Patch<e>& patch, std::vector<int> numbers)
        : space(patch.space()), weights(patch.weights()), dofs(std::move(numbers)) {
        std::array<std::vector<double>, e> points;
        for (int k = 0; k < e; ++k) {
            points[k] = space.knots[k].greville();
        }
        weights_at_greville = VectorX::Ones(space.n_basis());
        for (int i = 0; i < space.n_basis(); ++i) {
            const std::array<int, e> index = space.indices(i);
            Vector<e> xi;
            for (int k = 0; k < e; ++k) {
                xi[k] = points[k][index[k]];
            }
            at_greville.push_back(iga::evaluate_basis<e>(space, weights, xi));
            if (weights.size() > 0) {
                const iga::PointBasis<e> plain = iga::evaluate_basis<e>(space, {}, xi);
                weights_at_greville[i] = 0.0;
                for (std::size_t f = 0; f < plain.functions.size(); ++f) {
                    weights_at_greville[i] += plain.values[f] * weights[plain.functions[f]];
                }
            }
        }
    }

    [[nodiscard]] Vector3 position(int i, const MatrixX& points) const {
        Vector3 result = Vector3::Zero();
        for (std::size_t f = 0; f < at_greville[i].functions.size(); ++f) {
            result += at_greville[i].values[f] * points.col(dofs[at_greville[i].functions[f]]);
        }
        return result;
    }
    [[nodiscard]] Matrix<3, e> tangents(int i, const MatrixX& points) const {
        Matrix<3, e> result = Matrix<3, e>::Zero();
        for (std::size_t f = 0; f < at_greville[i].functions.size(); ++f) {
            result +=
                points.col(dofs[at_greville[i].functions[f]]) * at_greville[i].gradients.row(f);
        }
        return result;
    }
    [[nodiscard]] Patch<e> patch(const MatrixX& points) const {
        MatrixX own(dofs.size(), 3);
        for (std::size_t i = 0; i < dofs.size(); ++i) {
            own.row(i) = points.col(dofs[i]).transpose();
        }
        return {space, std::move(own), weights};
    }
    /// Control points that take `positions` (rows) at the Greville points.
    [[nodiscard]] MatrixX interpolated(const MatrixX& positions) const {
        MatrixX rows =
            iga::interpolate<e>(space, MatrixX(weights_at_greville.asDiagonal() * positions));
        return weights.size() > 0 ? MatrixX(weights.cwiseInverse().asDiagonal() * rows) : rows;
    }
};

/// One step of the retraction: moves the Greville points of the `movable` functions to the nearest
/// points of their targets and interpolates; other control points stay.
template <int e, typename Pieces>
void put_back(const Pieces& pieces, Freedom movable, const std::vector<Freedom>& freedom,
              MatrixX& points) {
    struct Job {
        const typename Pieces::value_type* piece;
        int i;
    };
    std::vector<Job> jobs;
    std::vector<int> job_of(points.cols(), -1);
    for (const auto& piece : pieces) {
        for (std::size_t i = 0; i < piece.entity.dofs.size(); ++i) {
            const int dof = piece.entity.dofs[i];
            if (freedom[dof] == movable && job_of[dof] < 0) {
                job_of[dof] = static_cast<int>(jobs.size());
                jobs.push_back({&piece, static_cast<int>(i)});
            }
        }
    }
    MatrixX positions(3, jobs.size());
    parallel_for(static_cast<int>(jobs.size()), [&](int j) {
        positions.col(j) =
            jobs[j].piece->target->nearest(jobs[j].piece->entity.position(jobs[j].i, points));
    });
    const MatrixX before = points;
    for (const auto& piece : pieces) {
        const Entity<e>& entity = piece.entity;
        MatrixX own(entity.dofs.size(), 3);
        for (std::size_t i = 0; i < entity.dofs.size(); ++i) {
            const int job = job_of[entity.dofs[i]];
            const Vector3 position = job >= 0 ? Vector3(positions.col(job))
                                              : entity.position(static_cast<int>(i), before);
            own.row(i) = position.transpose();
        }
        const MatrixX control_points = entity.interpolated(own);
        for (std::size_t i = 0; i < entity.dofs.size(); ++i) {
            if (job_of[entity.dofs[i]] >= 0) {
                points.col(entity.dofs[i]) = control_points.row(i).transpose();
            }
        }
    }
}

template <int e, typename Pieces>
double largest_distance(const Pieces& pieces, const MatrixX& points, int n_samples) {
    std::vector<double> largest(pieces.size(), 0.0);
    parallel_for(static_cast<int>(pieces.size()), [&](int i_piece) {
        const Patch<e> patch = pieces[i_piece].entity.patch(points);
        int n = 1;
        for (int k = 0; k < e; ++k) {
            n *= n_samples * patch.knots(k).n_elements();
        }
        for (int i = 0; i < n; ++i) {
            Vector<e> xi;
            for (int k = 0, rest = i; k < e; ++k) {
                const std::vector<double>& breakpoints = patch.knots(k).breakpoints();
                const int n_here = n_samples * patch.knots(k).n_elements();
                const int at = rest % n_here;
                rest /= n_here;
                const double t = (at % n_samples + 0.5) / n_samples;
                xi[k] =
                    (1.0 - t) * breakpoints[at / n_samples] + t * breakpoints[at / n_samples + 1];
            }
            const Vector3 x = patch.point(xi);
            largest[i_piece] =
                std::max(largest[i_piece], (pieces[i_piece].target->nearest(x) - x).norm());
        }
    });
    double result = 0.0;
    for (const double distance : largest) {
        result = std::max(result, distance);
    }
    return result;
}

}  // namespace

struct BoundarySlide::Side {
    Entity<2> entity;
    const Target<2>* target;
};

struct BoundarySlide::Edge {
    Entity<1> entity;
    const Target<1>* target;
};

struct BoundarySlide::OldFace {
    /// Nothing for a plane face.
    std::unique_ptr<Target<2>> target;
    Vector3 normal = Vector3::Zero();
};

struct BoundarySlide::OldCurve {
    /// Nothing for a straight curve.
    std::unique_ptr<Target<1>> target;
    Vector3 tangent = Vector3::Zero();
};

void TangentFrames::set(int point, Freedom freedom, const Vector3& axis) {
    freedom_[point] = freedom;
    axes_.col(point) = axis;
}

void TangentFrames::project(Eigen::Ref<MatrixX> columns) const {
    for (std::size_t i = 0; i < freedom_.size(); ++i) {
        const Vector3 axis = axes_.col(i);
        const double along = axis.dot(columns.col(i));
        switch (freedom_[i]) {
            case Freedom::interior:
                break;
            case Freedom::face:
                columns.col(i) -= along * axis;
                break;
            case Freedom::curve:
                columns.col(i) = along * axis;
                break;
            case Freedom::fixed:
                columns.col(i).setZero();
                break;
        }
    }
}

BoundarySlide::BoundarySlide(const iga::MultiPatch<3>& deformed, const BoundaryFeatures& features) {
    const auto points_of = [&](const std::vector<iga::PatchEntity<3>>& entities) {
        std::vector<double> numbers;
        for (const iga::PatchEntity<3>& entity : entities) {
            const iga::Patch<3>& patch = deformed.patches[entity.patch];
            for (const int i : iga::functions_on<3>(patch.space(), entity.position)) {
                for (int k = 0; k < 3; ++k) {
                    numbers.push_back(patch.control_points()(i, k));
                }
            }
        }
        return MatrixX(Eigen::Map<MatrixX>(numbers.data(), 3, numbers.size() / 3));
    };
    const int n_dofs = features.dofs().n_dofs;
    is_curved_.assign(n_dofs, false);
    for (int i = 0; i < n_dofs; ++i) {
        freedom_.push_back(features.freedom(i));
        feature_.push_back(features.feature(i));
    }
    for (const auto& sides : features.faces()) {
        OldFace face;
        const PrincipalAxes shape = principal_axes(points_of(sides));
        face.normal = shape.axes.col(0);
        if (shape.extents[0] > flatness * shape.extents[2]) {
            face.target = std::make_unique<Target<2>>();
            for (const iga::PatchEntity<3>& side : sides) {
                const iga::Surface surface =
                    iga::entity_patch<3, 2>(deformed.patches[side.patch], side.position);
                face.target->add(surface);
                sides_.push_back(
                    {Entity<2>(surface, features.dofs_on(deformed, side)), face.target.get()});
            }
        }
        old_faces_.push_back(std::move(face));
    }
    for (const auto& edges : features.curves()) {
        OldCurve curve;
        const PrincipalAxes shape = principal_axes(points_of(edges));
        curve.tangent = shape.axes.col(2);
        if (shape.extents[1] > flatness * shape.extents[2]) {
            curve.target = std::make_unique<Target<1>>();
            for (const iga::PatchEntity<3>& edge : edges) {
                const iga::Curve line =
                    iga::entity_patch<3, 1>(deformed.patches[edge.patch], edge.position);
                curve.target->add(line);
                edges_.push_back(
                    {Entity<1>(line, features.dofs_on(deformed, edge)), curve.target.get()});
            }
        }
        old_curves_.push_back(std::move(curve));
    }
    for (int i = 0; i < n_dofs; ++i) {
        is_curved_[i] =
            (freedom_[i] == Freedom::face && old_faces_[feature_[i]].target != nullptr) ||
            (freedom_[i] == Freedom::curve && old_curves_[feature_[i]].target != nullptr);
    }
}

BoundarySlide::BoundarySlide(BoundarySlide&&) noexcept = default;
BoundarySlide& BoundarySlide::operator=(BoundarySlide&&) noexcept = default;
BoundarySlide::~BoundarySlide() = default;

bool BoundarySlide::has_curved() const { return !sides_.empty() || !edges_.empty(); }

TangentFrames BoundarySlide::frames(const MatrixX& points) const {
    MatrixX axes = MatrixX::Zero(3, points.cols());
    // Inner faces may show their sides either way round.
    const auto add = [&](int dof, const Vector3& axis) {
        const double length = axis.norm();
        if (length > 0.0) {
            axes.col(dof) += (axes.col(dof).dot(axis) < 0.0 ? -1.0 : 1.0) / length * axis;
        }
    };
    for (const Side& side : sides_) {
        for (std::size_t i = 0; i < side.entity.dofs.size(); ++i) {
            if (freedom_[side.entity.dofs[i]] == Freedom::face) {
                const Matrix<3, 2> t = side.entity.tangents(static_cast<int>(i), points);
                add(side.entity.dofs[i], t.col(0).cross(t.col(1)));
            }
        }
    }
    for (const Edge& edge : edges_) {
        for (std::size_t i = 0; i < edge.entity.dofs.size(); ++i) {
            if (freedom_[edge.entity.dofs[i]] == Freedom::curve) {
                add(edge.entity.dofs[i], edge.entity.tangents(static_cast<int>(i), points));
            }
        }
    }
    TangentFrames result(static_cast<int>(points.cols()));
    for (int i = 0; i < points.cols(); ++i) {
        Vector3 axis = axes.col(i).normalized();
        if (freedom_[i] == Freedom::face && !is_curved_[i]) {
            axis = old_faces_[feature_[i]].normal;
        } else if (freedom_[i] == Freedom::curve && !is_curved_[i]) {
            axis = old_curves_[feature_[i]].tangent;
        }
        // A point without normal or tangent stays where it is.
        const bool has_axis = freedom_[i] == Freedom::interior || axis.norm() > 0.5;
        result.set(i, has_axis ? freedom_[i] : Freedom::fixed, axis);
    }
    return result;
}

MatrixX BoundarySlide::retracted(const MatrixX& points) const {
    MatrixX result = points;
    put_back<1>(edges_, Freedom::curve, freedom_, result);
    put_back<2>(sides_, Freedom::face, freedom_, result);
    return result;
}

double BoundarySlide::distance(const MatrixX& points, int n_samples) const {
    return std::max(largest_distance<2>(sides_, points, n_samples),
                    largest_distance<1>(edges_, points, n_samples));
}

}  // namespace couture::meshing
