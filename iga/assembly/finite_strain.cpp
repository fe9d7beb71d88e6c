#include "iga/assembly/finite_strain.h"

#include <algorithm>

#include "iga/assembly/assembler.h"
#include "iga/assembly/field_grid.h"
#include "iga/assembly/linear_form.h"
#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/mechanics/kinematics.h"

namespace couture::iga {

namespace {

/// F - I of a displacement with components a: which entry D_s u_a adds to. Axisymmetric: F_33 =
/// 1 + u_r / r, so that the value (s = d) of component 0 adds to entry (3, 3) with factor 1 / r.
template <int d, typename Body>
void for_gradient_entries(Kinematics kinematics, double radius, const Body& body) {
    for (int a = 0; a < d; ++a) {
        for (int s = 0; s < d; ++s) {
            body(a, s, 3 * a + s, 1.0);
        }
    }
    if (d == 2 && kinematics == Kinematics::axisymmetric) {
        // On the axis u_r / r tends to du_r / dr.
        const bool is_on_axis = !(radius > 0.0);
        body(0, is_on_axis ? 0 : d, 8, is_on_axis ? 1.0 : 1.0 / radius);
    }
}

}  // namespace

template <int d>
FiniteStrain<d>::FiniteStrain(const SpacePtr<d>& space, const Problem& problem,
                              std::optional<int> n_gauss_points)
    : space_(space),
      problem_(problem),
      n_gauss_points_(n_gauss_points),
      materials_(materials_of_patches(problem, space->n_patches())),
      gradients_(space->n_patches()) {
    check_kinematics(problem, d);
    if (problem.kinematics == Kinematics::plane_stress) {
        throw InputError(
            "kinematics = 'plane_stress' holds for linear elasticity only; at finite strain take "
            "'plane_strain', 'axisymmetric' or a solid");
    }
    for (int p = 0; p < space->n_patches(); ++p) {
        const Material& one = problem.materials[materials_[p]];
        if (!one.hyperelastic) {
            throw InputError(
                "[material.{}] of patch {} is linear elastic, others are hyperelastic; at finite "
                "strain every material needs a hyperelastic 'model'",
                one.name, p);
        }
    }
}

template <int d>
const Hyperelastic& FiniteStrain<d>::material(int patch) const {
    return *problem_.materials[materials_[patch]].hyperelastic;
}

template <int d>
Matrix<3> FiniteStrain<d>::displacement_gradient(int patch, int i_plane, int i_point) const {
    const PatchGradients& here = gradients_[patch];
    const std::size_t point = static_cast<std::size_t>(i_plane) * here.points_per_plane + i_point;
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&here.H[9 * point]);
}

template <int d>
SmallestVolume<d> FiniteStrain<d>::deform(const MatrixX& displacement) {
    const Field<d> field{space_, displacement};
    SmallestVolume<d> smallest;
    smallest.det_F = std::numeric_limits<double>::infinity();
    for (int p = 0; p < space_->n_patches(); ++p) {
        const GeometryGrid<d> grid(space_->geometry().patches[p], space_->tensor(p),
                                   gauss_points<d>(space_->tensor(p), n_gauss_points_));
        PatchGradients& here = gradients_[p];
        here.n_planes = grid.n_planes();
        here.points_per_plane = grid.points_per_plane();
        here.H.resize(static_cast<std::size_t>(9) * here.n_planes * here.points_per_plane);
        std::vector<SmallestVolume<d>> of_plane(here.n_planes, smallest);
        const int n_slabs = std::min(n_threads(), here.n_planes);
        parallel_for(n_slabs, [&](int slab) {
            GeometryPlane<d> plane;
            FieldGrid<d> values(field, p, grid);
            for (int i = here.n_planes * slab / n_slabs; i < here.n_planes * (slab + 1) / n_slabs;
                 ++i) {
                grid.evaluate(i, plane);
                values.evaluate(i, plane);
                for (int q = 0; q < plane.n_points; ++q) {
                    double* H = &here.H[9 * (static_cast<std::size_t>(i) * plane.n_points + q)];
                    std::fill(H, H + 9, 0.0);
                    const MatrixX gradient = values.gradient(q);
                    const VectorX value = values.value(q);
                    for_gradient_entries<d>(problem_.kinematics, plane.x[3 * q],
                                            [&](int a, int s, int entry, double f) {
                                                H[entry] += f * (s < d ? gradient(a, s) : value[a]);
                                            });
                    const double det_F = 1.0 + volume_change(displacement_gradient(p, i, q));
                    if (!(det_F >= of_plane[i].det_F)) {
                        of_plane[i] = {det_F, p, grid.parameter(i, q)};
                    }
                }
            }
        });
        for (const SmallestVolume<d>& one : of_plane) {
            if (!(one.det_F >= smallest.det_F)) {
                smallest = one;
            }
        }
    }
    return smallest;
}

template <int d>
MatrixX FiniteStrain<d>::internal_forces() const {
    LinearForm<d> form;
    form.n_components = d;
    form.coefficients = [this](int patch, const GeometryGrid<d>&, int i_plane,
                               const GeometryPlane<d>& plane, double* b) {
        for (int q = 0; q < plane.n_points; ++q) {
            const double* x = &plane.x[3 * static_cast<std::size_t>(q)];
            const double factor =
                measure(problem_.kinematics, problem_.thickness, Vector3(x[0], x[1], x[2]));
            const Matrix<3> P =
                piola_stress(material(patch), displacement_gradient(patch, i_plane, q));
            double* here = b + static_cast<std::size_t>(q) * d * (d + 1);
            for_gradient_entries<d>(
                problem_.kinematics, x[0], [&](int a, int s, int entry, double f) {
                    here[a * (d + 1) + s] += factor * f * P(entry / 3, entry % 3);
                });
        }
    };
    return integrate(*space_, form, {}, n_gauss_points_);
}

template <int d>
void FiniteStrain<d>::tangent(BlockMatrix& matrix) const {
    BilinearForm<d> form;
    form.n_components = d;
    form.has_value = problem_.kinematics == Kinematics::axisymmetric;
    form.plane_coefficients = [this](int patch, const GeometryGrid<d>&, int i_plane,
                                     const GeometryPlane<d>& plane, double* A) {
        for (int q = 0; q < plane.n_points; ++q) {
            const double* x = &plane.x[3 * static_cast<std::size_t>(q)];
            const double factor =
                measure(problem_.kinematics, problem_.thickness, Vector3(x[0], x[1], x[2]));
            const Matrix<9> dP =
                factor * piola_tangent(material(patch), displacement_gradient(patch, i_plane, q));
            double* here = A + static_cast<std::size_t>(q) * d * d * (d + 1) * (d + 1);
            for_gradient_entries<d>(
                problem_.kinematics, x[0], [&](int a, int s, int row, double f) {
                    for_gradient_entries<d>(problem_.kinematics, x[0],
                                            [&](int b, int t, int column, double g) {
                                                here[((a * d + b) * (d + 1) + s) * (d + 1) + t] +=
                                                    f * g * dP(row, column);
                                            });
                });
        }
    };
    assemble_into(matrix, *space_, form, n_gauss_points_);
}

template <int d>
double FiniteStrain<d>::energy() const {
    double energy = 0.0;
    for (int p = 0; p < space_->n_patches(); ++p) {
        const GeometryGrid<d> grid(space_->geometry().patches[p], space_->tensor(p),
                                   gauss_points<d>(space_->tensor(p), n_gauss_points_));
        std::vector<double> of_plane(grid.n_planes(), 0.0);
        parallel_for(grid.n_planes(), [&](int i) {
            GeometryPlane<d> plane;
            grid.evaluate(i, plane);
            for (int q = 0; q < plane.n_points; ++q) {
                const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
                of_plane[i] += plane.quadrature_weight[q] * std::abs(plane.determinant[q]) *
                               measure(problem_.kinematics, problem_.thickness, x) *
                               stored_energy(material(p), displacement_gradient(p, i, q));
            }
        });
        for (const double one : of_plane) {
            energy += one;
        }
    }
    return energy;
}

template class FiniteStrain<2>;
template class FiniteStrain<3>;

}  // namespace couture::iga
