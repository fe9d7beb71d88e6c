#include "iga/assembly/elasticity.h"

#include <algorithm>

#include "iga/assembly/assembler.h"
#include "iga/assembly/field_grid.h"
#include "iga/core/parallel.h"
#include "iga/mechanics/kinematics.h"

namespace couture::iga {

template <int d>
BilinearForm<d> stiffness_form(const Problem& problem, int n_patches) {
    check_kinematics(problem, d);
    const std::vector<int> materials = materials_of_patches(problem, n_patches);
    BilinearForm<d> form;
    form.n_components = n_components<d>(problem);
    form.varies = problem.kinematics == Kinematics::axisymmetric;
    const Kinematics kinematics = problem.kinematics;
    const double thickness = problem.thickness;

    if (problem.physics == Physics::poisson) {
        std::vector<double> conductivities;
        for (const int m : materials) {
            conductivities.push_back(problem.materials[m].conductivity);
        }
        form.coefficients = [=](int patch, const Vector3& x, double* A) {
            const double k = conductivities[patch] * measure(kinematics, thickness, x);
            for (int s = 0; s < d; ++s) {
                A[s * (d + 1) + s] = k;
            }
        };
        return form;
    }

    form.has_value = problem.kinematics == Kinematics::axisymmetric;
    std::vector<ElasticStiffness> stiffnesses;
    for (const int m : materials) {
        stiffnesses.push_back(effective_stiffness(kinematics, problem.materials[m].stiffness));
    }
    form.coefficients = [=](int patch, const Vector3& x, double* A) {
        const auto E = strain_operator<d>(kinematics, x);
        const Eigen::Matrix<double, 6, d*(d + 1)> DE = stiffnesses[patch] * E;
        const double factor = measure(kinematics, thickness, x);
        for (int a = 0; a < d; ++a) {
            for (int b = 0; b < d; ++b) {
                for (int s = 0; s <= d; ++s) {
                    for (int t = 0; t <= d; ++t) {
                        A[((a * d + b) * (d + 1) + s) * (d + 1) + t] =
                            factor * E.col(a * (d + 1) + s).dot(DE.col(b * (d + 1) + t));
                    }
                }
            }
        }
    };
    return form;
}

Vector<6> thermal_strain(const Problem& problem, const Material& material, int patch,
                         const std::string& load_case, const Vector3& x) {
    const auto combination = problem.combinations.find(load_case);
    if (combination != problem.combinations.end()) {
        Vector<6> sum = Vector<6>::Zero();
        for (const auto& [name, factor] : combination->second) {
            sum += factor * thermal_strain(problem, material, patch, name, x);
        }
        return sum;
    }
    double change = 0.0;
    for (const Temperature& temperature : problem.temperatures) {
        const PatchList& on = temperature.patches;
        if (acts_in(temperature, load_case) &&
            (on.empty() || std::find(on.begin(), on.end(), patch) != on.end())) {
            change += temperature.change(x, 0.0);
        }
    }
    Vector<6> strain = Vector<6>::Zero();
    strain.head<3>() = change * material.thermal_expansion;
    return strain;
}

template <int d>
Vector<6> elastic_stress(const Problem& problem, const Material& material,
                         const Vector<6>& elastic_strain) {
    return effective_stiffness(problem.kinematics, material.stiffness) * elastic_strain;
}

template <int d>
Vector<6> total_strain(Kinematics kinematics, const Vector3& x, const MatrixX& gradient,
                       const VectorX& value) {
    Vector<6> strain = Vector<6>::Zero();
    for (int a = 0; a < d; ++a) {
        strain[a] = gradient(a, a);
    }
    strain[5] = gradient(0, 1) + gradient(1, 0);
    if constexpr (d == 3) {
        strain[3] = gradient(1, 2) + gradient(2, 1);
        strain[4] = gradient(0, 2) + gradient(2, 0);
    } else if (kinematics == Kinematics::axisymmetric) {
        // On the axis u_r / r tends to du_r / dr.
        strain[2] = x[0] > 0.0 ? value[0] / x[0] : gradient(0, 0);
    }
    return strain;
}

template <int d>
double body_volume(const Problem& problem, const MultiPatch<d>& geometry) {
    if (problem.kinematics != Kinematics::axisymmetric) {
        return volume(geometry) * (d == 2 ? problem.thickness : 1.0);
    }
    double sum = 0.0;
    for (const Patch<d>& patch : geometry.patches) {
        std::array<int, d> n_points;
        for (int k = 0; k < d; ++k) {
            // x det J has degree 3 p - 1; rational maps by points enough.
            n_points[k] = patch.is_rational() ? 12 : (3 * patch.knots(k).degree() + 1) / 2;
        }
        const GeometryGrid<d> grid(patch, patch.space(), n_points);
        GeometryPlane<d> plane;
        for (int i = 0; i < grid.n_planes(); ++i) {
            grid.evaluate(i, plane);
            for (int q = 0; q < plane.n_points; ++q) {
                const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
                sum += plane.quadrature_weight[q] * std::abs(plane.determinant[q]) *
                       measure(problem.kinematics, problem.thickness, x);
            }
        }
    }
    return sum;
}

template <int d>
double strain_energy(const Problem& problem, const Field<d>& displacement,
                     const std::string& load_case, std::optional<int> n_gauss_points) {
    const Space<d>& space = *displacement.space;
    const std::vector<int> materials = materials_of_patches(problem, space.n_patches());
    double energy = 0.0;
    for (int p = 0; p < space.n_patches(); ++p) {
        const Material& material = problem.materials[materials[p]];
        const GeometryGrid<d> grid(space.geometry().patches[p], space.tensor(p),
                                   gauss_points<d>(space.tensor(p), n_gauss_points));
        std::vector<double> of_plane(grid.n_planes(), 0.0);
        parallel_for(grid.n_planes(), [&](int i) {
            GeometryPlane<d> plane;
            grid.evaluate(i, plane);
            FieldGrid<d> values(displacement, p, grid);
            values.evaluate(i, plane);
            for (int q = 0; q < plane.n_points; ++q) {
                const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
                const double weight = plane.quadrature_weight[q] * std::abs(plane.determinant[q]) *
                                      measure(problem.kinematics, problem.thickness, x);
                if (problem.physics == Physics::poisson) {
                    of_plane[i] +=
                        weight * material.conductivity * values.gradient(q).squaredNorm();
                    continue;
                }
                const Vector<6> strain =
                    total_strain<d>(problem.kinematics, x, values.gradient(q), values.value(q)) -
                    thermal_strain(problem, material, p, load_case, x);
                of_plane[i] += weight * strain.dot(elastic_stress<d>(problem, material, strain));
            }
        });
        for (const double part : of_plane) {
            energy += 0.5 * part;
        }
    }
    return energy;
}

#define COUTURE_INSTANTIATE(d)                                                               \
    template BilinearForm<d> stiffness_form(const Problem&, int);                            \
    template Vector<6> elastic_stress<d>(const Problem&, const Material&, const Vector<6>&); \
    template double body_volume(const Problem&, const MultiPatch<d>&);                       \
    template double strain_energy(const Problem&, const Field<d>&, const std::string&,       \
                                  std::optional<int>);                                       \
    template Vector<6> total_strain<d>(Kinematics, const Vector3&, const MatrixX&, const VectorX&);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::iga
