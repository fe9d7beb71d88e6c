#include "iga/assembly/finite_strain.h"

#include <Eigen/LU>
#include <algorithm>

#include "iga/assembly/assembler.h"
#include "iga/assembly/field_grid.h"
#include "iga/assembly/linear_form.h"
#include "iga/core/error.h"
#include "iga/core/format.h"
#include "iga/core/parallel.h"
#include "iga/mechanics/kinematics.h"

namespace couture::iga {

namespace {

/// Above it the volumetric part is projected unless told otherwise.
constexpr double nearly_incompressible = 0.49;

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

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

/// A tangent by F turned into one by F_f: the second index of each pair goes through F_b.
Matrix<9> pull_back(const Matrix<9>& A, const Matrix<3>& F_b) {
    Matrix<9> G = Matrix<9>::Zero();
    for (int i = 0; i < 3; ++i) {
        G.block<3, 3>(3 * i, 3 * i) = F_b;
    }
    return G * A * G.transpose();
}

}  // namespace

/// One patch's quadrature points, [plane][point].
template <int d>
struct FiniteStrain<d>::PatchState {
    int points_per_plane = 0;
    int n_planes = 0;
    /// F - I, 9 numbers each, row by row.
    Buffer<double> H;
    /// F_b, 9 numbers each, and 1 / det F_b; empty for the undeformed body.
    Buffer<double> F_b;
    Buffer<double> inverse_J_b;
    /// Where the volumetric part is projected: coefficients of the pressure p, p at the points, and
    /// g there.
    VectorX pressure_coefficients;
    VectorX pressure;
    VectorX dilatation;

    [[nodiscard]] std::size_t number(int i_plane, int i_point) const {
        return static_cast<std::size_t>(i_plane) * points_per_plane + i_point;
    }
    [[nodiscard]] std::size_t n_points() const {
        return static_cast<std::size_t>(n_planes) * points_per_plane;
    }
    [[nodiscard]] Matrix<3> gradient(std::size_t q) const {
        return Eigen::Map<const RowMajor3>(&H[9 * q]);
    }
    [[nodiscard]] Matrix<3> base(std::size_t q) const {
        return F_b.empty() ? Matrix<3>(Matrix<3>::Identity())
                           : Matrix<3>(Eigen::Map<const RowMajor3>(&F_b[9 * q]));
    }
    /// Undeformed volume over reference volume.
    [[nodiscard]] double shrink(std::size_t q) const {
        return inverse_J_b.empty() ? 1.0 : inverse_J_b[q];
    }
};

template <int d>
FiniteStrain<d>::FiniteStrain(ReferencePtr<d> reference, const Problem& problem,
                              std::optional<int> n_gauss_points, Volumetric volumetric)
    : reference_(std::move(reference)),
      problem_(problem),
      n_gauss_points_(n_gauss_points),
      materials_(materials_of_patches(problem, reference_->space->n_patches())),
      patches_(reference_->space->n_patches()) {
    check_kinematics(problem, d);
    if (problem.kinematics == Kinematics::plane_stress) {
        throw InputError(
            "kinematics = 'plane_stress' holds for linear elasticity only; at finite strain take "
            "'plane_strain', 'axisymmetric' or a solid");
    }
    const Space<d>& space = *reference_->space;
    for (int p = 0; p < space.n_patches(); ++p) {
        const Material& one = problem.materials[materials_[p]];
        if (!one.hyperelastic) {
            throw InputError(
                "[material.{}] of patch {} is linear elastic, others are hyperelastic; at finite "
                "strain every material needs a hyperelastic 'model'",
                one.name, p);
        }
        is_projected_.push_back(volumetric == Volumetric::projected ||
                                        (volumetric == Volumetric::automatic &&
                                         poissons_ratio(*one.hyperelastic) > nearly_incompressible)
                                    ? 1
                                    : 0);
        const GeometryGrid<d> grid(space.geometry().patches[p], space.tensor(p),
                                   gauss_points<d>(space.tensor(p), n_gauss_points_));
        PatchState& here = patches_[p];
        here.n_planes = grid.n_planes();
        here.points_per_plane = grid.points_per_plane();
        here.H.assign(9 * here.n_points(), 0.0);
    }
    if (!reference_->is_undeformed()) {
        set_up_reference();
    }
    if (std::find(is_projected_.begin(), is_projected_.end(), 1) != is_projected_.end()) {
        set_up_projection();
    }
}

template <int d>
FiniteStrain<d>::~FiniteStrain() = default;

template <int d>
void FiniteStrain<d>::set_up_reference() {
    const Space<d>& space = *reference_->space;
    const Field<d> field{reference_->space, reference_->gradient};
    for (int p = 0; p < space.n_patches(); ++p) {
        PatchState& here = patches_[p];
        const GeometryGrid<d> grid(space.geometry().patches[p], space.tensor(p),
                                   gauss_points<d>(space.tensor(p), n_gauss_points_));
        here.F_b.resize(9 * here.n_points());
        here.inverse_J_b.resize(here.n_points());
        const int n_slabs = std::min(n_threads(), here.n_planes);
        parallel_for(n_slabs, [&](int slab) {
            GeometryPlane<d> plane;
            FieldGrid<d> values(field, p, grid);
            for (int i = here.n_planes * slab / n_slabs; i < here.n_planes * (slab + 1) / n_slabs;
                 ++i) {
                grid.evaluate(i, plane);
                values.evaluate(i, plane);
                for (int q = 0; q < plane.n_points; ++q) {
                    const std::size_t number = here.number(i, q);
                    const VectorX H = values.value(q);
                    const Matrix<3> gradient = Eigen::Map<const RowMajor3>(H.data());
                    const double J = 1.0 + volume_change(gradient);
                    if (!(J > 0.0)) {
                        throw GeometryError(
                            "the deformation gradient of the reference has det F_b = {:.3g} in "
                            "patch {} at parameter {}; it must be positive: mesh again at an "
                            "earlier time or with finer elements",
                            J, p, format_point(grid.parameter(i, q)));
                    }
                    Eigen::Map<RowMajor3>(&here.F_b[9 * number]) = gradient + Matrix<3>::Identity();
                    here.inverse_J_b[number] = 1.0 / J;
                }
            }
        });
    }
}

template <int d>
void FiniteStrain<d>::set_up_projection() {
    const Space<d>& space = *reference_->space;
    std::vector<VectorX> volumes(space.n_patches());
    for (int p = 0; p < space.n_patches(); ++p) {
        const PatchState& here = patches_[p];
        const GeometryGrid<d> grid(space.geometry().patches[p], space.tensor(p),
                                   gauss_points<d>(space.tensor(p), n_gauss_points_));
        volumes[p].resize(static_cast<Eigen::Index>(here.n_points()));
        GeometryPlane<d> plane;
        for (int i = 0; i < here.n_planes; ++i) {
            grid.evaluate(i, plane);
            for (int q = 0; q < plane.n_points; ++q) {
                const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
                volumes[p][here.number(i, q)] =
                    plane.quadrature_weight[q] * std::abs(plane.determinant[q]) *
                    measure(problem_.kinematics, problem_.thickness, x) *
                    here.shrink(here.number(i, q));
            }
        }
    }
    projection_.emplace(reference_->space, n_gauss_points_, std::move(volumes));
}

template <int d>
const Hyperelastic& FiniteStrain<d>::material(int patch) const {
    return *problem_.materials[materials_[patch]].hyperelastic;
}

template <int d>
Matrix<3> FiniteStrain<d>::displacement_gradient(int patch, int i_plane, int i_point) const {
    return patches_[patch].gradient(patches_[patch].number(i_plane, i_point));
}

template <int d>
SmallestVolume<d> FiniteStrain<d>::deform(const MatrixX& displacement) {
    const SpacePtr<d>& space = reference_->space;
    const Field<d> field{space, reference_->is_undeformed()
                                    ? displacement
                                    : MatrixX(displacement - reference_->displacement)};
    SmallestVolume<d> smallest;
    smallest.det_F = std::numeric_limits<double>::infinity();
    for (int p = 0; p < space->n_patches(); ++p) {
        const GeometryGrid<d> grid(space->geometry().patches[p], space->tensor(p),
                                   gauss_points<d>(space->tensor(p), n_gauss_points_));
        PatchState& here = patches_[p];
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
                    const std::size_t number = here.number(i, q);
                    double* H = &here.H[9 * number];
                    std::fill(H, H + 9, 0.0);
                    const MatrixX gradient = values.gradient(q);
                    const VectorX value = values.value(q);
                    for_gradient_entries<d>(problem_.kinematics, plane.x[3 * q],
                                            [&](int a, int s, int entry, double f) {
                                                H[entry] += f * (s < d ? gradient(a, s) : value[a]);
                                            });
                    if (!here.F_b.empty()) {
                        Eigen::Map<RowMajor3> map(H);
                        const Matrix<3> F_b = here.base(number);
                        map = (F_b - Matrix<3>::Identity() + Matrix<3>(map) * F_b).eval();
                    }
                    const double det_F = 1.0 + volume_change(here.gradient(number));
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
    if (projection_ && smallest.det_F > 0.0) {
        for (int p = 0; p < space->n_patches(); ++p) {
            project_dilatation(p);
        }
    }
    return smallest;
}

template <int d>
void FiniteStrain<d>::project_dilatation(int patch) {
    if (is_projected_[patch] == 0) {
        return;
    }
    PatchState& here = patches_[patch];
    here.dilatation.resize(static_cast<Eigen::Index>(here.n_points()));
    for (std::size_t q = 0; q < here.n_points(); ++q) {
        here.dilatation[q] = dilatation(material(patch), here.gradient(q)).value;
    }
    here.pressure_coefficients =
        dilatation_modulus(material(patch)) * projection_->project(patch, here.dilatation);
    here.pressure = projection_->at_points(patch, here.pressure_coefficients);
}

template <int d>
Matrix<3> FiniteStrain<d>::piola(int patch, int i_plane, int i_point) const {
    const PatchState& here = patches_[patch];
    const std::size_t q = here.number(i_plane, i_point);
    const Matrix<3> H = here.gradient(q);
    const Hyperelastic& rubber = material(patch);
    Matrix<3> P = piola_stress(rubber, H);
    if (is_projected_[patch] != 0) {
        P += (here.pressure[q] - dilatation_modulus(rubber) * here.dilatation[q]) *
             dilatation(rubber, H).gradient;
    }
    return P;
}

template <int d>
Matrix<3> FiniteStrain<d>::piola_at(int patch, const Vector<d>& xi, const Matrix<3>& H) const {
    const Hyperelastic& rubber = material(patch);
    Matrix<3> P = piola_stress(rubber, H);
    if (is_projected_[patch] != 0) {
        const Dilatation g = dilatation(rubber, H);
        const double p = projection_->value(patch, patches_[patch].pressure_coefficients, xi);
        P += (p - dilatation_modulus(rubber) * g.value) * g.gradient;
    }
    return P;
}

template <int d>
MatrixX FiniteStrain<d>::internal_forces() const {
    LinearForm<d> form;
    form.n_components = d;
    form.coefficients = [this](int patch, const GeometryGrid<d>&, int i_plane,
                               const GeometryPlane<d>& plane, double* b) {
        const PatchState& here = patches_[patch];
        for (int q = 0; q < plane.n_points; ++q) {
            const std::size_t number = here.number(i_plane, q);
            const double* x = &plane.x[3 * static_cast<std::size_t>(q)];
            const double factor =
                measure(problem_.kinematics, problem_.thickness, Vector3(x[0], x[1], x[2]));
            Matrix<3> P = piola(patch, i_plane, q);
            if (!here.F_b.empty()) {
                P = here.shrink(number) * P * here.base(number).transpose();
            }
            double* to = b + static_cast<std::size_t>(q) * d * (d + 1);
            for_gradient_entries<d>(problem_.kinematics, x[0],
                                    [&](int a, int s, int entry, double f) {
                                        to[a * (d + 1) + s] += factor * f * P(entry / 3, entry % 3);
                                    });
        }
    };
    return integrate(*reference_->space, form, {}, n_gauss_points_);
}

template <int d>
BilinearForm<d> FiniteStrain<d>::tangent_form() const {
    BilinearForm<d> form;
    form.n_components = d;
    form.has_value = problem_.kinematics == Kinematics::axisymmetric;
    form.plane_coefficients = [this](int patch, const GeometryGrid<d>&, int i_plane,
                                     const GeometryPlane<d>& plane, double* A) {
        const PatchState& here = patches_[patch];
        const Hyperelastic& rubber = material(patch);
        for (int q = 0; q < plane.n_points; ++q) {
            const std::size_t number = here.number(i_plane, q);
            const double* x = &plane.x[3 * static_cast<std::size_t>(q)];
            const double factor =
                measure(problem_.kinematics, problem_.thickness, Vector3(x[0], x[1], x[2]));
            const Matrix<3> H = here.gradient(number);
            Matrix<9> dP = piola_tangent(rubber, H);
            if (is_projected_[patch] != 0) {
                const double k = dilatation_modulus(rubber);
                const RowMajor3 slope = dilatation(rubber, H).gradient;
                const Eigen::Map<const Vector<9>> g(slope.data());
                dP += (here.pressure[number] - k * here.dilatation[number]) *
                          dilatation_hessian(rubber, H) -
                      k * g * g.transpose();
            }
            if (!here.F_b.empty()) {
                dP = here.shrink(number) * pull_back(dP, here.base(number));
            }
            dP *= factor;
            double* to = A + static_cast<std::size_t>(q) * d * d * (d + 1) * (d + 1);
            for_gradient_entries<d>(
                problem_.kinematics, x[0], [&](int a, int s, int row, double f) {
                    for_gradient_entries<d>(problem_.kinematics, x[0],
                                            [&](int b, int t, int column, double g) {
                                                to[((a * d + b) * (d + 1) + s) * (d + 1) + t] +=
                                                    f * g * dP(row, column);
                                            });
                });
        }
    };
    return form;
}

template <int d>
void FiniteStrain<d>::tangent(BlockMatrix& matrix) const {
    assemble_into(matrix, *reference_->space, tangent_form(), n_gauss_points_);
    for (int p = 0; projection_ && p < reference_->space->n_patches(); ++p) {
        if (is_projected_[p] != 0 && projection_->is_elementwise(p)) {
            add_elementwise_stiffness(p, matrix);
        }
    }
}

template <int d>
Buffer<double> FiniteStrain<d>::dilatation_operator(int patch) const {
    const PatchState& here = patches_[patch];
    const Space<d>& space = *reference_->space;
    const GeometryGrid<d> grid(space.geometry().patches[patch], space.tensor(patch),
                               gauss_points<d>(space.tensor(patch), n_gauss_points_));
    Buffer<double> b;
    b.assign(here.n_points() * d * (d + 1), 0.0);
    parallel_for(here.n_planes, [&](int i) {
        GeometryPlane<d> plane;
        grid.evaluate(i, plane);
        for (int q = 0; q < plane.n_points; ++q) {
            const std::size_t number = here.number(i, q);
            const double* x = &plane.x[3 * static_cast<std::size_t>(q)];
            const double factor =
                plane.quadrature_weight[q] * std::abs(plane.determinant[q]) *
                measure(problem_.kinematics, problem_.thickness, Vector3(x[0], x[1], x[2]));
            const Matrix<3> slope = here.shrink(number) *
                                    dilatation(material(patch), here.gradient(number)).gradient *
                                    here.base(number).transpose();
            for_gradient_entries<d>(problem_.kinematics, x[0],
                                    [&](int a, int s, int entry, double f) {
                                        b[number * d * (d + 1) + a * (d + 1) + s] +=
                                            factor * f * slope(entry / 3, entry % 3);
                                    });
        }
    });
    return b;
}

/// Every element's mean dilatation is one spring between all its unknowns.
template <int d>
void FiniteStrain<d>::add_elementwise_stiffness(int patch, BlockMatrix& matrix) const {
    const double k = dilatation_modulus(material(patch));
    const SparseMatrix B = projection_->coupling(patch, dilatation_operator(patch));
    const SparseMatrix& volumes = projection_->mass(patch);
    std::vector<std::pair<int, Vector<d>>> rows;
    for (int e = 0; e < B.outerSize(); ++e) {
        rows.clear();
        for (SparseMatrix::InnerIterator it(B, e); it; ++it) {
            const int dof = static_cast<int>(it.row()) / d;
            if (rows.empty() || rows.back().first != dof) {
                rows.emplace_back(dof, Vector<d>::Zero());
            }
            rows.back().second[it.row() % d] = it.value();
        }
        const double stiffness = k / volumes.coeff(e, e);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const int row = rows[i].first;
            auto place = matrix.columns.begin() + matrix.row_begin[row];
            for (std::size_t j = i; j < rows.size(); ++j) {
                place = std::lower_bound(place, matrix.columns.begin() + matrix.row_begin[row + 1],
                                         rows[j].first);
                double* block = &matrix.values[(place - matrix.columns.begin()) * d * d];
                for (int a = 0; a < d; ++a) {
                    for (int b = 0; b < d; ++b) {
                        block[a * d + b] += stiffness * rows[i].second[a] * rows[j].second[b];
                    }
                }
            }
        }
    }
}

template <int d>
std::optional<VolumetricCoupling> FiniteStrain<d>::coupling() const {
    if (!projection_) {
        return {};
    }
    std::vector<Eigen::Triplet<double>> B;
    std::vector<Eigen::Triplet<double>> compliance;
    int n = 0;
    for (int p = 0; p < reference_->space->n_patches(); ++p) {
        if (is_projected_[p] == 0 || projection_->is_elementwise(p)) {
            continue;
        }
        const SparseMatrix here = projection_->coupling(p, dilatation_operator(p));
        const SparseMatrix& mass = projection_->mass(p);
        const double k = dilatation_modulus(material(p));
        for (int j = 0; j < here.outerSize(); ++j) {
            for (SparseMatrix::InnerIterator it(here, j); it; ++it) {
                B.emplace_back(it.row(), n + j, it.value());
            }
            for (SparseMatrix::InnerIterator it(mass, j); it; ++it) {
                compliance.emplace_back(n + it.row(), n + j, it.value() / k);
            }
        }
        n += projection_->n_functions(p);
    }
    if (n == 0) {
        return {};
    }
    VolumetricCoupling result;
    result.B.resize(static_cast<Eigen::Index>(reference_->space->n_dofs()) * d, n);
    result.B.setFromTriplets(B.begin(), B.end());
    result.compliance.resize(n, n);
    result.compliance.setFromTriplets(compliance.begin(), compliance.end());
    return result;
}

template <int d>
double FiniteStrain<d>::energy() const {
    const Space<d>& space = *reference_->space;
    double energy = 0.0;
    for (int p = 0; p < space.n_patches(); ++p) {
        const PatchState& here = patches_[p];
        const Hyperelastic& rubber = material(p);
        const GeometryGrid<d> grid(space.geometry().patches[p], space.tensor(p),
                                   gauss_points<d>(space.tensor(p), n_gauss_points_));
        std::vector<double> of_plane(grid.n_planes(), 0.0);
        parallel_for(grid.n_planes(), [&](int i) {
            GeometryPlane<d> plane;
            grid.evaluate(i, plane);
            for (int q = 0; q < plane.n_points; ++q) {
                const std::size_t number = here.number(i, q);
                const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
                double W = stored_energy(rubber, here.gradient(number));
                if (is_projected_[p] != 0) {
                    const double k = dilatation_modulus(rubber);
                    const double g = here.dilatation[number];
                    const double pressure = here.pressure[number];
                    W += pressure * g - 0.5 * pressure * pressure / k - 0.5 * k * g * g;
                }
                of_plane[i] += plane.quadrature_weight[q] * std::abs(plane.determinant[q]) *
                               measure(problem_.kinematics, problem_.thickness, x) *
                               here.shrink(number) * W;
            }
        });
        for (const double one : of_plane) {
            energy += one;
        }
    }
    return energy;
}

template <int d>
Matrix<3> total_displacement_gradient(const ReferenceConfiguration<d>& reference,
                                      Kinematics kinematics, const MatrixX& displacement, int patch,
                                      const Vector<d>& xi) {
    const bool is_undeformed = reference.is_undeformed();
    const Field<d> field{reference.space, is_undeformed
                                              ? displacement
                                              : MatrixX(displacement - reference.displacement)};
    const MatrixX gradient = field.gradient(patch, xi);
    const VectorX value = field.value(patch, xi);
    const double radius = reference.space->geometry().patches[patch].point(xi)[0];
    Matrix<3> H = Matrix<3>::Zero();
    for_gradient_entries<d>(kinematics, radius, [&](int a, int s, int entry, double f) {
        H(entry / 3, entry % 3) += f * (s < d ? gradient(a, s) : value[a]);
    });
    if (is_undeformed) {
        return H;
    }
    const VectorX base = Field<d>{reference.space, reference.gradient}.value(patch, xi);
    const Matrix<3> H_b = Eigen::Map<const RowMajor3>(base.data());
    return H_b + H + H * H_b;
}

#define COUTURE_INSTANTIATE(d)                                                                   \
    template class FiniteStrain<d>;                                                              \
    template Matrix<3> total_displacement_gradient(const ReferenceConfiguration<d>&, Kinematics, \
                                                   const MatrixX&, int, const Vector<d>&);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::iga
