#include "verification/manufactured/patch_tests.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "iga/assembly/assembler.h"
#include "iga/assembly/constraints.h"
#include "iga/assembly/elasticity.h"
#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "verification/manufactured/wave.h"
#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

/// Rounding of a small, well conditioned system.
constexpr double exact = 1e-12;

/// One wave: the displacement is a polynomial of its profile's degree.
WaveSolution polynomial(int degree, int dimension) {
    WaveSolution solution{power(degree), {{{1.0, 2.0, -1.5}, {0.7, -0.4, 0.5}, 0.0}}};
    if (dimension == 2) {
        solution.waves[0].amplitude[2] = 0.0;
        solution.waves[0].direction[2] = 0.0;
    }
    return solution;
}

/// Largest of the relative errors in L2 and H1.
template <int d>
double polynomial_error(const SpacePtr<d>& space, int degree, std::optional<int> n_gauss = {}) {
    const WaveSolution solution = polynomial(degree, d);
    const CaseResult<d> result =
        solve<d>(space, wave_problem<d>(solution, Physics::elasticity), n_gauss);
    const ErrorNorms errors = error_norms<d>(result.displacement, solution.exact<d>(d));
    return std::max(errors.l2 / errors.l2_exact, errors.h1 / errors.h1_exact);
}

template <int d>
MultiPatch<d> single(Patch<d> patch) {
    MultiPatch<d> geometry;
    geometry.patches = {std::move(patch)};
    name_outer(geometry);
    return geometry;
}

/// The unit box's corners moved: affine, or each on its own.
template <int d>
MatrixX box_corners(bool affine) {
    Matrix<3> shear;
    shear << 1.2, 0.3, -0.1, 0.2, 0.9, 0.15, -0.1, 0.25, 1.1;
    MatrixX corners(1 << d, d);
    for (int i = 0; i < (1 << d); ++i) {
        const Vector3 unit(i & 1, i >> 1 & 1, i >> 2 & 1);
        Vector3 x = shear * unit;
        if (!affine) {
            x += 0.12 * Vector3(std::sin(3.0 * i), std::sin(5.0 * i + 1.0), std::cos(4.0 * i));
        }
        corners.row(i) = x.head<d>().transpose();
    }
    return corners;
}

/// One Bezier patch of the unit box with all control points but the corners pushed about: curved in
/// the inside and on every side.
template <int d>
Patch<d> curved_box(int degree) {
    TensorSpace<d> space = make_box<d>(Vector<d>::Ones()).space();
    space.knots.fill(KnotVector::uniform(degree, 1));
    MatrixX control_points(space.n_basis(), d);
    for (int i = 0; i < space.n_basis(); ++i) {
        const std::array<int, d> index = space.indices(i);
        bool is_corner = true;
        for (int k = 0; k < d; ++k) {
            control_points(i, k) = index[k] / static_cast<double>(degree);
            is_corner = is_corner && index[k] % degree == 0;
        }
        if (!is_corner) {
            for (int k = 0; k < d; ++k) {
                control_points(i, k) += 0.12 / degree * std::sin(7.0 * i + 2.0 * k);
            }
        }
    }
    return {space, control_points};
}

template <int d>
void polynomials_on_multilinear_maps(Recorder& recorder) {
    recorder.set_source("exactness: polynomials pulled back lie in the space");
    for (const bool affine : {true, false}) {
        const MultiPatch<d> box = single<d>(make_multilinear<d>(box_corners<d>(affine)));
        for (int p = 1; p <= 4; ++p) {
            recorder.vanishing(fmt::format("{} p={}", affine ? "affine" : "multilinear", p),
                               polynomial_error<d>(make_space<d>(box, p, 3), p), exact);
        }
    }
}

template <int d>
void linear_fields_on_curved_maps(Recorder& recorder) {
    recorder.set_source("exactness: isoparametric space, integrands of degree 3p - 1");
    for (int p = 2; p <= 4; ++p) {
        const SpacePtr<d> space = make_space<d>(single<d>(curved_box<d>(p)), p, 2);
        // The integrand cofactor x gradient of a test function has degree d p - 1 per direction.
        const int n = std::max(p + 1, (d * p + 1) / 2);
        recorder.vanishing(fmt::format("p={}, {} points", p, n), polynomial_error<d>(space, 1, n),
                           exact);
    }
    if (d == 3) {
        const SpacePtr<3> twisted = make_space<3>(part<3>("twisted_box"), 3, 2);
        MultiPatch<3> named = twisted->geometry();
        name_outer(named);
        recorder.vanishing("twisted box p=3, 5 points",
                           polynomial_error<3>(make_space<3>(named, 3, 2), 1, 5), exact);
    }
}

/// Quadrature can't be exact on rational maps: its error must fall as points are added.
template <int d>
void linear_fields_on_rational_maps(Recorder& recorder, const std::string& name, int degree,
                                    const std::vector<int>& n_points) {
    recorder.set_source("convergence of Gauss quadrature");
    MultiPatch<d> geometry = part<d>(name);
    name_outer(geometry);
    const SpacePtr<d> space = make_space<d>(geometry, degree, 1);
    double previous = 0.0;
    for (const int n : n_points) {
        const double error = polynomial_error<d>(space, 1, n);
        if (previous == 0.0) {
            constexpr double coarse = 1e-2;
            recorder.vanishing(fmt::format("{}, {} points", name, n), error, coarse);
        } else {
            constexpr double fall = 0.1;
            recorder.vanishing(fmt::format("{}, {} points: ratio", name, n), error / previous,
                               fall);
        }
        previous = error;
    }
    const int many = n_points.back() + 12;
    recorder.vanishing(fmt::format("{}, {} points", name, many),
                       polynomial_error<d>(space, 1, many), exact);
}

/// The second of two distorted cells with its parameters renamed and reversed.
Patch<3> renamed_cell(const MatrixX& corners, const std::array<int, 3>& axes, int reversed) {
    MatrixX renamed(8, 3);
    for (int i = 0; i < 8; ++i) {
        int from = 0;
        for (int k = 0; k < 3; ++k) {
            from |= ((i >> k & 1) ^ (reversed >> k & 1)) << axes[k];
        }
        renamed.row(i) = corners.row(from);
    }
    return make_multilinear<3>(renamed);
}

/// All 48 ways to number the second cell: each of its 6 sides in each of 8 orientations.
void face_orientations(Recorder& recorder) {
    recorder.set_source("exactness: the field does not see the numbering");
    constexpr int degree = 3;
    MatrixX first = box_corners<3>(false);
    MatrixX second = first;
    for (int i = 0; i < 8; i += 2) {
        second.row(i) = first.row(i + 1);
        second.row(i + 1) =
            first.row(i + 1) + Vector3(0.9 + 0.05 * i, 0.1, 0.02 * i - 0.1).transpose();
    }
    std::map<std::pair<int, std::array<int, 4>>, double> errors;
    std::array<int, 3> axes = {0, 1, 2};
    do {
        for (int reversed = 0; reversed < 8; ++reversed) {
            MultiPatch<3> geometry;
            geometry.patches = {make_multilinear<3>(first), renamed_cell(second, axes, reversed)};
            find_interfaces(geometry);
            const Interface<3>& met = geometry.interfaces.at(0);
            name_outer(geometry);
            const double error = polynomial_error<3>(make_space<3>(geometry, degree, 2), degree);
            errors[{met.second_side,
                    {met.map.axis[0], met.map.axis[1], met.map.reversed[0], met.map.reversed[1]}}] =
                error;
        }
    } while (std::next_permutation(axes.begin(), axes.end()));
    recorder.absolute("sides x orientations met", 48.0, static_cast<double>(errors.size()), 0.0);
    double largest = 0.0;
    for (const auto& [key, error] : errors) {
        largest = std::max(largest, error);
    }
    recorder.vanishing("cubic field, largest error", largest, exact);
}

/// Rows: the number of zero-energy modes of an unheld body, and the forces of its rigid motions.
template <int d>
void rigid_motions(Recorder& recorder, const std::string& name, int degree) {
    recorder.set_source("rigid-body kinematics");
    const SpacePtr<d> space = make_space<d>(part<d>(name), degree, 1);
    Problem problem;
    problem.kinematics = d == 2 ? Kinematics::plane_strain : Kinematics::solid;
    problem.materials = {make_isotropic("solid", 1.0, 0.3)};
    const BlockMatrix K = assemble<d>(*space, stiffness_form<d>(problem, space->n_patches()));
    const MatrixX dense = K * MatrixX::Identity(K.n_unknowns(), K.n_unknowns());
    const VectorX energies =
        Eigen::SelfAdjointEigenSolver<MatrixX>(dense, Eigen::EigenvaluesOnly).eigenvalues();
    const double largest = energies.cwiseAbs().maxCoeff();
    constexpr double zero = 1e-12;
    recorder.absolute(name + ": zero-energy modes", d == 2 ? 3.0 : 6.0,
                      static_cast<double>((energies.array() < zero * largest).count()), 0.0);
    std::vector<std::string> names;
    const MatrixX modes = rigid_body_modes<d>(*space, problem, names);
    recorder.vanishing(
        name + ": force of rigid motions",
        (dense * modes).cwiseAbs().maxCoeff() / (largest * modes.cwiseAbs().maxCoeff()), exact);
}

}  // namespace

std::vector<Case> patch_test_cases() {
    return {
        {"patch test 2D, degree p", false, polynomials_on_multilinear_maps<2>},
        {"patch test 3D, degree p", false, polynomials_on_multilinear_maps<3>},
        {"patch test 2D, curved", false, linear_fields_on_curved_maps<2>},
        {"patch test 3D, curved", false, linear_fields_on_curved_maps<3>},
        {"patch test 2D, NURBS", false,
         [](Recorder& r) {
             linear_fields_on_rational_maps<2>(r, "quarter_annulus", 2, {3, 5, 7});
         }},
        {"patch test 3D, NURBS", false,
         [](Recorder& r) {
             linear_fields_on_rational_maps<3>(r, "hollow_sphere", 4, {5, 7, 9});
         }},
        {"patch test 3D, orientations", false, face_orientations},
        {"rigid motions", false,
         [](Recorder& r) {
             rigid_motions<2>(r, "plate_with_hole", 3);
             rigid_motions<3>(r, "twisted_box", 3);
             rigid_motions<3>(r, "cylinder_o_grid", 2);
         }},
    };
}

}  // namespace couture::verification
