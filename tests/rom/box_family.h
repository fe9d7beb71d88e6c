#pragma once

#include <limits>

#include "iga/core/parallel.h"
#include "iga/solve/linear_static.h"
#include "iga/solve/static_system.h"
#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "rom/designs.h"
#include "rom/member_geometry.h"
#include "rom/snapshots.h"

namespace couture::tests {

/// A cantilever of two patches whose control points are linear in width and taper, under a force
/// that is the sum of a given one and `lift` times another; Young's modulus and force factored.
struct BoxFamily {
    enum { width, taper, force, lift, youngs_modulus, poissons_ratio };

    [[nodiscard]] static rom::ParameterSpace parameters() {
        using Group = rom::ParameterGroup;
        return rom::ParameterSpace({{"width", Group::geometry, "mm", 8.0, 12.0},
                                    {"taper", Group::geometry, "", 0.0, 0.3},
                                    {"force", Group::load, "N", 50.0, 200.0},
                                    {"lift", Group::load, "", -1.0, 1.0},
                                    {"youngs_modulus", Group::material, "MPa", 1e5, 3e5},
                                    {"poissons_ratio", Group::material, "", 0.2, 0.4}});
    }

    [[nodiscard]] static iga::MultiPatch<3> geometry(const VectorX& point, int degree = 2,
                                                     int n_elements = 2) {
        iga::MultiPatch<3> part;
        for (int k = 0; k < 2; ++k) {
            const iga::Patch<3> box = iga::make_box<3>(Vector3(10.0, 10.0, 6.0));
            MatrixX corners = box.control_points();
            corners.col(0).array() += 10.0 * k;
            part.patches.emplace_back(box.space(), corners);
        }
        (void)iga::find_interfaces(part);
        part.boundary_sets["wall"] = {iga::make_side<3>(0, 0)};
        part.boundary_sets["tip"] = {iga::make_side<3>(1, 1)};
        part = iga::refine<3>(part, degree, std::array<int, 3>{n_elements, n_elements, n_elements});
        for (iga::Patch<3>& patch : part.patches) {
            MatrixX X = patch.control_points();
            X.col(1) *= point[width] / 10.0;
            X.col(2).array() *= 1.0 - point[taper] * X.col(0).array() / 20.0;
            patch = iga::Patch<3>(patch.space(), X);
        }
        return part;
    }

    [[nodiscard]] static iga::Problem problem(const VectorX& point) {
        iga::Problem problem;
        problem.materials = {
            iga::make_isotropic("steel", point[youngs_modulus], point[poissons_ratio])};
        problem.supports = {iga::make_support("wall", 0.0, 0.0, 0.0)};
        iga::Resultant pull;
        pull.on = "tip";
        pull.force = point[force] * Vector3(1.0, 0.2, point[lift]);
        problem.resultants = {pull};
        return problem;
    }

    /// Displacement, 3 node + component.
    [[nodiscard]] static VectorX solve(const VectorX& point) {
        const auto space = std::make_shared<const iga::Space<3>>(geometry(point));
        return iga::flatten(iga::solve_linear_static<3>(space, problem(point))
                                .cases.at(0)
                                .displacement.coefficients);
    }

    /// Full designs of n points per parameter.
    [[nodiscard]] static rom::SnapshotSet snapshots(int n = 3) {
        rom::SnapshotSet set{
            parameters(), {0, 0, 1, 0, -1, 0}, parameters().centre(), {}, {}, {}, {}, {}};
        set.reference = geometry(set.reference_point);
        set.geometry_points = rom::full_design(2, n);
        set.mechanics_factors = {rom::full_design(1, n), rom::full_design(1, n)};
        const iga::Space<3> space(set.reference);
        set.control_points.resize(3 * space.n_dofs(), n * n);
        set.displacements.resize(3 * space.n_dofs(), n * n * n * n);
        const MatrixX points = set.design().points();
        // Systems are too small to be shared between threads.
        const int n_threads_before = n_threads();
        set_n_threads(1);
        for (int i = 0; i < points.rows(); ++i) {
            VectorX unit = set.parameters.to_unit(set.reference_point);
            unit[width] = points(i, 0);
            unit[taper] = points(i, 1);
            unit[lift] = points(i, 2);
            unit[poissons_ratio] = points(i, 3);
            const VectorX point = set.parameters.from_unit(unit);
            set.control_points.col(i / (n * n)) = rom::to_field(space, geometry(point));
            set.displacements.col(i) = solve(point);
        }
        set_n_threads(n_threads_before);
        return set;
    }

    /// In units of the parameters, from the unit cube.
    [[nodiscard]] static VectorX point(std::initializer_list<double> unit_point) {
        VectorX unit(6);
        std::copy(unit_point.begin(), unit_point.end(), unit.begin());
        return parameters().from_unit(unit);
    }

    static void refuse(MatrixX& fields, int column) {
        fields.col(column).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
};

}  // namespace couture::tests
