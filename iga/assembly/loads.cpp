#include "iga/assembly/loads.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "iga/assembly/assembler.h"
#include "iga/assembly/elasticity.h"
#include "iga/assembly/entity_quadrature.h"
#include "iga/assembly/linear_form.h"
#include "iga/core/error.h"
#include "iga/core/format.h"
#include "iga/mechanics/kinematics.h"
#include "iga/spline/point_inversion.h"

namespace couture::iga {

namespace {

std::string prefix(const Entry& entry) {
    return entry.source.empty() ? std::string() : entry.source + ": ";
}

template <int d>
void require_sides(const Entry& load, const std::string& on, const BoundarySet<d>& set,
                   const char* what) {
    for (const PatchEntity<d>& entity : set) {
        if (!entity.is_side()) {
            throw InputError("{}{} on '{}': {} is not a side; name a set of sides", prefix(load),
                             what, on, entity.name());
        }
    }
}

/// Adds the integral of traction(point) times the functions over a set.
template <int d>
void add_surface_load(const Space<d>& space, const Problem& problem, const BoundarySet<d>& set,
                      std::optional<int> n_gauss_points,
                      const std::function<Vector3(const EntityPoint<d>&)>& traction, MatrixX& f) {
    for (const PatchEntity<d>& entity : set) {
        for_entity_points<d>(space, entity, n_gauss_points, [&](const EntityPoint<d>& point) {
            const double weight =
                point.weight * measure(problem.kinematics, problem.thickness, point.x);
            const Vector3 t = traction(point);
            for (std::size_t i = 0; i < point.dofs.size(); ++i) {
                for (Eigen::Index a = 0; a < f.cols(); ++a) {
                    f(point.dofs[i], a) += weight * t[a] * point.values[i];
                }
            }
        });
    }
}

Vector3 evaluate(const std::array<Function, 3>& components, const Vector3& x) {
    Vector3 result = Vector3::Zero();
    for (int a = 0; a < 3; ++a) {
        if (components[a]) {
            result[a] = components[a](x, 0.0);
        }
    }
    return result;
}

template <int d>
void add_resultant(const Space<d>& space, const Problem& problem, const Resultant& load,
                   std::optional<int> n_gauss_points, MatrixX& f) {
    const BoundarySet<d>& set = space.geometry().boundary_set(load.on);
    require_sides<d>(load, load.on, set, "resultant");
    if (problem.kinematics == Kinematics::axisymmetric &&
        (load.force[0] != 0.0 || load.moment != Vector3::Zero())) {
        throw InputError(
            "{}resultant on '{}': an axisymmetric body carries a resultant along the "
            "axis (y) only; use a pressure or traction for radial loads",
            prefix(load), load.on);
    }
    if (d == 2 && (load.force[2] != 0.0 || load.moment.head<2>() != Vector2::Zero())) {
        throw InputError(
            "{}resultant on '{}': force z, moment x and moment y must be 0 in the "
            "plane",
            prefix(load), load.on);
    }
    double area = 0.0;
    Vector3 centroid = Vector3::Zero();
    Matrix<3> second_moment = Matrix<3>::Zero();
    std::vector<int> dofs;
    for (const PatchEntity<d>& entity : set) {
        for_entity_points<d>(space, entity, n_gauss_points, [&](const EntityPoint<d>& point) {
            const double weight =
                point.weight * measure(problem.kinematics, problem.thickness, point.x);
            area += weight;
            centroid += weight * point.x;
            second_moment += weight * point.x * point.x.transpose();
        });
        const std::vector<int> on = space.dofs_on(entity);
        dofs.insert(dofs.end(), on.begin(), on.end());
    }
    if (!(area > 0.0)) {
        throw InputError("{}resultant on '{}': the set has no area", prefix(load), load.on);
    }
    centroid /= area;
    second_moment -= area * centroid * centroid.transpose();
    std::sort(dofs.begin(), dofs.end());
    dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());

    if (load.spread == Spread::control_points) {
        if (load.moment != Vector3::Zero()) {
            throw InputError(
                "{}resultant on '{}': a moment can't be spread equally on control "
                "points; use spread = \"traction\"",
                prefix(load), load.on);
        }
        for (const int dof : dofs) {
            for (Eigen::Index a = 0; a < f.cols(); ++a) {
                f(dof, a) += load.force[a] / static_cast<double>(dofs.size());
            }
        }
        return;
    }
    // Traction force / area + omega x (x - centroid) with inertia * omega = moment.
    Vector3 omega = Vector3::Zero();
    if (load.moment != Vector3::Zero()) {
        const Matrix<3> inertia = second_moment.trace() * Matrix<3>::Identity() - second_moment;
        const Eigen::FullPivLU<Matrix<3>> lu(inertia);
        omega = lu.solve(load.moment);
        if (!(inertia * omega).isApprox(load.moment, 1e-9)) {
            throw InputError(
                "{}resultant on '{}': the set lies on a line and carries no moment "
                "about it",
                prefix(load), load.on);
        }
    }
    add_surface_load<d>(
        space, problem, set, n_gauss_points,
        [&](const EntityPoint<d>& point) -> Vector3 {
            return load.force / area + omega.cross(point.x - centroid);
        },
        f);
}

template <int d>
void add_point_load(const Space<d>& space, const PointLoad& load, MatrixX& f) {
    if (!load.at) {
        for (const PatchEntity<d>& entity : space.geometry().boundary_set(load.on)) {
            if (entity.dimension() != 0) {
                throw InputError(
                    "{}point load on '{}': {} is not a corner; name a set of corners "
                    "or give 'at'",
                    prefix(load), load.on, entity.name());
            }
        }
        std::vector<int> dofs;
        for (const PatchEntity<d>& entity : space.geometry().boundary_set(load.on)) {
            dofs.push_back(space.dofs_on(entity).front());
        }
        std::sort(dofs.begin(), dofs.end());
        dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
        for (const int dof : dofs) {
            f.row(dof) += load.force.head(f.cols()).transpose();
        }
        return;
    }
    add_force(space, locate_load(space.geometry(), load), load.force, f);
}

}  // namespace

template <int d>
Location<d> locate_load(const MultiPatch<d>& geometry, const PointLoad& load) {
    const double size = geometry.size();
    constexpr double tolerance = 1e-6;
    double nearest_distance = std::numeric_limits<double>::infinity();
    for (int p = 0; p < geometry.n_patches(); ++p) {
        const Patch<d>& patch = geometry.patches[p];
        const InvertedPoint<d> found =
            PointInversion<d>(patch).nearest(load.at->head(patch.dimension()));
        nearest_distance = std::min(nearest_distance, found.distance);
        if (found.distance <= tolerance * size) {
            return {p, found.xi};
        }
    }
    throw InputError("{}point load at {} lies {:.3g} outside the body; move it onto the part",
                     prefix(load), format_point(*load.at), nearest_distance);
}

template <int d>
void add_force(const Space<d>& space, const Location<d>& place, const Vector3& force, MatrixX& f) {
    const PointBasis<d> basis =
        evaluate_basis(space.tensor(place.patch), space.weights(place.patch), place.xi);
    for (std::size_t i = 0; i < basis.functions.size(); ++i) {
        f.row(space.dofs(place.patch)[basis.functions[i]]) +=
            basis.values[i] * force.head(f.cols()).transpose();
    }
}

template <int d>
MatrixX assemble_loads(const Space<d>& space, const Problem& problem, const std::string& load_case,
                       std::optional<int> n_gauss_points) {
    const int nc = n_components<d>(problem);
    MatrixX f = MatrixX::Zero(space.n_dofs(), nc);
    const MultiPatch<d>& geometry = space.geometry();

    for (const Traction& load : problem.tractions) {
        if (acts_in(load, load_case)) {
            add_surface_load<d>(
                space, problem, geometry.boundary_set(load.on), n_gauss_points,
                [&](const EntityPoint<d>& point) { return evaluate(load.components, point.x); }, f);
        }
    }
    for (const Pressure& load : problem.pressures) {
        const BoundarySet<d>& set = geometry.boundary_set(load.on);
        require_sides<d>(load, load.on, set, "pressure");
        if (acts_in(load, load_case)) {
            add_surface_load<d>(
                space, problem, set, n_gauss_points,
                [&](const EntityPoint<d>& point) -> Vector3 {
                    return -load.value(point.x, 0.0) * point.normal;
                },
                f);
        }
    }
    for (const Resultant& load : problem.resultants) {
        if (acts_in(load, load_case)) {
            add_resultant<d>(space, problem, load, n_gauss_points, f);
        }
    }
    for (const PointLoad& load : problem.point_loads) {
        if (acts_in(load, load_case)) {
            add_point_load<d>(space, load, f);
        }
    }
    for (const BodyForce& load : problem.body_forces) {
        if (!acts_in(load, load_case)) {
            continue;
        }
        LinearForm<d> form;
        form.n_components = nc;
        form.coefficients = [&](int, const GeometryGrid<d>&, int, const GeometryPlane<d>& plane,
                                double* b) {
            for (int q = 0; q < plane.n_points; ++q) {
                const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
                const Vector3 force = evaluate(load.components, x) *
                                      measure(problem.kinematics, problem.thickness, x);
                for (int a = 0; a < nc; ++a) {
                    b[(static_cast<std::size_t>(q) * nc + a) * (d + 1) + d] = force[a];
                }
            }
        };
        f += integrate(space, form, load.patches, n_gauss_points);
    }
    const bool has_thermal =
        std::any_of(problem.temperatures.begin(), problem.temperatures.end(),
                    [&](const Temperature& t) { return acts_in(t, load_case); });
    if (has_thermal && problem.physics == Physics::elasticity) {
        const std::vector<int> materials = materials_of_patches(problem, space.n_patches());
        LinearForm<d> form;
        form.n_components = nc;
        form.coefficients = [&](int patch, const GeometryGrid<d>&, int,
                                const GeometryPlane<d>& plane, double* b) {
            const Material& material = problem.materials[materials[patch]];
            for (int q = 0; q < plane.n_points; ++q) {
                const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
                const Vector<6> stress = elastic_stress<d>(
                    problem, material, thermal_strain(problem, material, patch, load_case, x));
                const Vector<d*(d + 1)> work =
                    strain_operator<d>(problem.kinematics, x).transpose() * stress *
                    measure(problem.kinematics, problem.thickness, x);
                std::copy(work.data(), work.data() + work.size(),
                          b + static_cast<std::size_t>(q) * nc * (d + 1));
            }
        };
        f += integrate(space, form, {}, n_gauss_points);
    }
    return f;
}

template <int d>
SparseMatrix assemble_foundations(const Space<d>& space, const Problem& problem,
                                  std::optional<int> n_gauss_points) {
    const int nc = n_components<d>(problem);
    std::vector<Eigen::Triplet<double>> entries;
    for (const Foundation& foundation : problem.foundations) {
        const BoundarySet<d>& set = space.geometry().boundary_set(foundation.on);
        if (foundation.normal) {
            require_sides<d>(foundation, foundation.on, set, "foundation along the normal");
        }
        for (const PatchEntity<d>& entity : set) {
            for_entity_points<d>(space, entity, n_gauss_points, [&](const EntityPoint<d>& point) {
                const auto value_of = [&](const Function& function) {
                    const double value = function(point.x, 0.0);
                    if (!(value >= 0.0)) {
                        throw InputError(
                            "{}foundation on '{}': its stiffness is {:g} at {}; must be at least 0",
                            prefix(foundation), foundation.on, value, format_point(point.x));
                    }
                    return value;
                };
                Matrix<3> stiffness = Matrix<3>::Zero();
                if (foundation.normal) {
                    stiffness +=
                        value_of(*foundation.normal) * point.normal * point.normal.transpose();
                }
                for (int a = 0; a < 3; ++a) {
                    if (foundation.components[a]) {
                        stiffness(a, a) += value_of(*foundation.components[a]);
                    }
                }
                const double weight =
                    point.weight * measure(problem.kinematics, problem.thickness, point.x);
                for (std::size_t i = 0; i < point.dofs.size(); ++i) {
                    for (std::size_t j = 0; j < point.dofs.size(); ++j) {
                        const double w = weight * point.values[i] * point.values[j];
                        for (int a = 0; a < nc; ++a) {
                            for (int b = 0; b < nc; ++b) {
                                if (stiffness(a, b) != 0.0) {
                                    entries.emplace_back(point.dofs[i] * nc + a,
                                                         point.dofs[j] * nc + b,
                                                         w * stiffness(a, b));
                                }
                            }
                        }
                    }
                }
            });
        }
    }
    SparseMatrix result(space.n_dofs() * nc, space.n_dofs() * nc);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
}

template MatrixX assemble_loads(const Space<2>&, const Problem&, const std::string&,
                                std::optional<int>);
template MatrixX assemble_loads(const Space<3>&, const Problem&, const std::string&,
                                std::optional<int>);
template Location<2> locate_load(const MultiPatch<2>&, const PointLoad&);
template Location<3> locate_load(const MultiPatch<3>&, const PointLoad&);
template void add_force(const Space<2>&, const Location<2>&, const Vector3&, MatrixX&);
template void add_force(const Space<3>&, const Location<3>&, const Vector3&, MatrixX&);
template SparseMatrix assemble_foundations(const Space<2>&, const Problem&, std::optional<int>);
template SparseMatrix assemble_foundations(const Space<3>&, const Problem&, std::optional<int>);

}  // namespace couture::iga
