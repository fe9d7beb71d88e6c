#include "iga/solve/state_transfer.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "iga/assembly/assembler.h"
#include "iga/assembly/field_grid.h"
#include "iga/assembly/finite_strain.h"
#include "iga/assembly/linear_form.h"
#include "iga/core/error.h"
#include "iga/core/format.h"
#include "iga/core/parallel.h"
#include "iga/linalg/sparse_solver.h"
#include "iga/spline/approximate.h"
#include "iga/topology/locator.h"

namespace couture::iga {

namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Finds points of the new mesh in the old deformed one.
template <int d>
class OldBody {
  public:
    OldBody(const MultiPatch<d>& deformed, double tolerance)
        : locator_(deformed), tolerance_(tolerance * deformed.size()) {}

    /// @param patch  of the new mesh: the point is most likely in the same one of the old mesh
    [[nodiscard]] Location<d> find(const Vector3& x, int patch, const Vector<d>& xi,
                                   double& gap) const {
        const auto [location, distance] = locator_.nearest(x, patch);
        if (distance > tolerance_) {
            throw GeometryError(
                "transfer: the point {} of the new mesh (patch {} at parameter {}) lies {:.3g} "
                "outside the old one, more than {:.3g}; the new mesh must be one of the same "
                "body",
                format_point(x), patch, format_point(xi), distance, tolerance_);
        }
        gap = distance;
        return location;
    }

  private:
    Locator<d> locator_;
    double tolerance_;
};

template <int d>
Vector3 in_space(const VectorX& point) {
    Vector3 x = Vector3::Zero();
    x.head<d>() = point;
    return x;
}

/// Displacement coefficients on the new space.
template <int d>
MatrixX transfer_displacement(const Field<d>& old, const OldBody<d>& body, const Space<d>& space,
                              double& largest_gap) {
    MatrixX result = MatrixX::Zero(space.n_dofs(), d);
    VectorX n_patches = VectorX::Zero(space.n_dofs());
    for (int p = 0; p < space.n_patches(); ++p) {
        const TensorSpace<d>& tensor = space.tensor(p);
        const VectorX& weights = space.weights(p);
        const std::vector<Vector<d>> points = greville_points(tensor);
        const int n = static_cast<int>(points.size());
        // Homogeneous values: rational functions interpolate times their denominator.
        MatrixX values(n, d);
        VectorX gaps(n);
        parallel_for(n, [&](int i) {
            const Patch<d>& patch = space.geometry().patches[p];
            const Location<d> at =
                body.find(in_space<d>(patch.point(points[i])), p, points[i], gaps[i]);
            double W = 1.0;
            if (weights.size() > 0) {
                const PointBasis<d> basis = evaluate_basis(tensor, VectorX(), points[i]);
                W = basis.values.dot(weights(basis.functions));
            }
            values.row(i) = W * old.value(at.patch, at.xi).transpose();
        });
        largest_gap = std::max(largest_gap, gaps.maxCoeff());
        MatrixX coefficients = interpolate<d>(tensor, values);
        if (weights.size() > 0) {
            coefficients.array().colwise() /= weights.array();
        }
        for (int i = 0; i < n; ++i) {
            result.row(space.dofs(p)[i]) += coefficients.row(i);
            n_patches[space.dofs(p)[i]] += 1.0;
        }
    }
    return n_patches.cwiseInverse().asDiagonal() * result;
}

/// F - I of the displacement U over a deformed body at x: with H = grad_x U, F = (I - H)^-1.
Matrix<3> from_deformed(const Matrix<3>& H) { return (Matrix<3>::Identity() - H).inverse() * H; }

}  // namespace

template <int d>
MultiPatch<d> deformed_body(const ReferenceConfiguration<d>& reference,
                            const MatrixX& displacement) {
    const Space<d>& space = *reference.space;
    if (!space.is_isoparametric()) {
        throw InputError(
            "a deformed mesh needs a displacement with the functions of its geometry; take a "
            "discretization with geometry = 'interpolated', or at least the geometry's degree");
    }
    const MatrixX moved =
        reference.is_undeformed() ? displacement : MatrixX(displacement - reference.displacement);
    MultiPatch<d> body = space.geometry();
    for (int p = 0; p < body.n_patches(); ++p) {
        const Patch<d>& patch = body.patches[p];
        MatrixX points = patch.control_points();
        for (Eigen::Index i = 0; i < points.rows(); ++i) {
            points.row(i) += moved.row(space.dofs(p)[i]);
        }
        body.patches[p] = Patch<d>(patch.space(), points, patch.weights());
    }
    return body;
}

template <int d>
TransferredState<d> transfer_state(const ReferenceConfiguration<d>& old, Kinematics kinematics,
                                   const MatrixX& displacement, const MultiPatch<d>& mesh,
                                   const TransferOptions& options) {
    TransferredState<d> result;
    const OldBody<d> body(deformed_body(old, displacement), options.tolerance);
    const Field<d> old_displacement{old.space, displacement};
    const auto space = std::make_shared<const Space<d>>(mesh);
    ReferenceConfiguration<d> deformed{space, {}, {}};
    deformed.displacement =
        transfer_displacement<d>(old_displacement, body, *space, result.largest_gap);

    // F - I at the quadrature points: evaluated in the old mesh, and of the new displacement.
    const Field<d> new_displacement{space, deformed.displacement};
    LinearForm<d> form;
    form.n_components = 9;
    std::vector<VectorX> gaps(space->n_patches());
    for (int p = 0; p < space->n_patches(); ++p) {
        const GeometryGrid<d> grid(mesh.patches[p], space->tensor(p),
                                   gauss_points<d>(space->tensor(p), options.n_gauss_points));
        gaps[p] = VectorX::Zero(grid.n_planes());
    }
    form.coefficients = [&](int patch, const GeometryGrid<d>& grid, int i_plane,
                            const GeometryPlane<d>& plane, double* b) {
        for (int q = 0; q < plane.n_points; ++q) {
            const double* x = &plane.x[3 * static_cast<std::size_t>(q)];
            double gap = 0.0;
            const Location<d> at =
                body.find(Vector3(x[0], x[1], x[2]), patch, grid.parameter(i_plane, q), gap);
            gaps[patch][i_plane] = std::max(gaps[patch][i_plane], gap);
            const RowMajor3 H =
                total_displacement_gradient<d>(old, kinematics, displacement, at.patch, at.xi);
            for (int i = 0; i < 9; ++i) {
                b[(static_cast<std::size_t>(q) * 9 + i) * (d + 1) + d] = H.data()[i];
            }
        }
    };
    const MatrixX rhs = integrate(*space, form, {}, options.n_gauss_points);
    const BlockMatrix mass = assemble(*space, scalar_form<d>(0.0, 1.0), options.n_gauss_points);
    const std::unique_ptr<LinearSolver> solver = make_linear_solver({});
    solver->factorize({mass, {}, {}});
    static_cast<void>(solver->solve(rhs, deformed.gradient));
    for (const VectorX& of_patch : gaps) {
        result.largest_gap = std::max(result.largest_gap, of_patch.maxCoeff());
    }

    SmallestVolume<d> smallest;
    smallest.det_F = std::numeric_limits<double>::infinity();
    double drift = 0.0;
    double size = 0.0;
    // Of the mesh moved back.
    bool is_folded = false;
    for (int p = 0; p < space->n_patches(); ++p) {
        const GeometryGrid<d> grid(mesh.patches[p], space->tensor(p),
                                   gauss_points<d>(space->tensor(p), options.n_gauss_points));
        FieldGrid<d> displacements(new_displacement, p, grid);
        FieldGrid<d> gradients({space, deformed.gradient}, p, grid);
        GeometryPlane<d> plane;
        for (int i = 0; i < grid.n_planes(); ++i) {
            grid.evaluate(i, plane);
            displacements.evaluate(i, plane);
            gradients.evaluate(i, plane);
            for (int q = 0; q < plane.n_points; ++q) {
                Matrix<3> H = Matrix<3>::Zero();
                H.topLeftCorner<d, d>() = displacements.gradient(q);
                if (kinematics == Kinematics::axisymmetric) {
                    const double r = plane.x[3 * q];
                    H(2, 2) = r > 0.0 ? displacements.value(q)[0] / r : H(0, 0);
                }
                is_folded = is_folded || !((Matrix<3>::Identity() - H).determinant() > 0.0);
                const Matrix<3> direct = from_deformed(H);
                const VectorX row = gradients.value(q);
                const Matrix<3> projected = Eigen::Map<const RowMajor3>(row.data());
                const double det_F = 1.0 + volume_change(projected);
                if (!(det_F >= smallest.det_F)) {
                    smallest = {det_F, p, grid.parameter(i, q)};
                }
                const double weight = plane.quadrature_weight[q] * std::abs(plane.determinant[q]);
                drift += weight * (projected - direct).squaredNorm();
                size += weight * direct.squaredNorm();
            }
        }
    }
    result.gradient_drift = size > 0.0 ? std::sqrt(drift / size) : 0.0;
    result.min_det_F = smallest.det_F;
    result.displacement = deformed.displacement;
    result.transfer = is_folded ? Transfer::gradient : options.transfer;
    if (result.transfer == Transfer::displacement) {
        result.reference = make_reference<d>(deformed.undeformed());
        return result;
    }
    if (!(smallest.det_F > 0.0)) {
        throw GeometryError(
            "transfer: the projected deformation gradient has det F_b = {:.3g} in patch {} at "
            "parameter {}{}; it must be positive: mesh again earlier or with finer elements",
            smallest.det_F, smallest.patch, format_point(smallest.xi),
            is_folded ? ", and the new mesh folds when it is moved back" : "");
    }
    result.reference = std::make_shared<const ReferenceConfiguration<d>>(std::move(deformed));
    return result;
}

#define COUTURE_INSTANTIATE(d)                                                                \
    template MultiPatch<d> deformed_body(const ReferenceConfiguration<d>&, const MatrixX&);   \
    template TransferredState<d> transfer_state(const ReferenceConfiguration<d>&, Kinematics, \
                                                const MatrixX&, const MultiPatch<d>&,         \
                                                const TransferOptions&);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::iga
