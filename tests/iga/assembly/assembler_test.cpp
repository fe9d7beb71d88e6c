#include "iga/assembly/assembler.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "iga/assembly/elasticity.h"
#include "iga/assembly/sparsity.h"
#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/spline/gauss.h"
#include "iga/spline/refine.h"
#include "iga/spline/shapes.h"

using namespace couture;
using namespace couture::iga;

namespace {

/// Sum factorization and the naive sum add the same numbers in another order.
constexpr double rounding = 1e-13;

/// Row by row: the integral by a plain loop over all quadrature points of the patch.
template <int d>
MatrixX naive_matrix(const Space<d>& space, const BilinearForm<d>& form) {
    const int nc = form.n_components;
    MatrixX K = MatrixX::Zero(space.n_dofs() * nc, space.n_dofs() * nc);
    for (int p = 0; p < space.n_patches(); ++p) {
        const TensorSpace<d>& tensor = space.tensor(p);
        const Patch<d>& map = space.geometry().patches[p];
        std::array<int, d> n_points;
        int n_all = 1;
        for (int k = 0; k < d; ++k) {
            n_points[k] = tensor.knots[k].n_elements() * (tensor.knots[k].degree() + 1);
            n_all *= n_points[k];
        }
        for (int q = 0; q < n_all; ++q) {
            Vector<d> xi;
            double weight = 1.0;
            int rest = q;
            for (int k = 0; k < d; ++k) {
                const int n = tensor.knots[k].degree() + 1;
                const int i = rest % n_points[k];
                rest /= n_points[k];
                const double first = tensor.knots[k].breakpoints()[i / n];
                const double length = tensor.knots[k].breakpoints()[i / n + 1] - first;
                xi[k] = first + length * gauss_rule(n).points[i % n];
                weight *= length * gauss_rule(n).weights[i % n];
            }
            const PointBasis<d> basis = evaluate_basis(tensor, space.weights(p), xi);
            const Matrix<d> J = map.jacobian(xi);
            const Eigen::Matrix<double, Eigen::Dynamic, d> gradients =
                basis.gradients * J.inverse();
            Vector3 x = Vector3::Zero();
            x.head(d) = map.point(xi);
            std::vector<double> A(form.size(), 0.0);
            form.coefficients(p, x, A.data());
            weight *= std::abs(J.determinant());
            const auto slot = [&](std::size_t i, int s) {
                return s < d ? gradients(static_cast<Eigen::Index>(i), s) : basis.values[i];
            };
            for (std::size_t i = 0; i < basis.functions.size(); ++i) {
                for (std::size_t j = 0; j < basis.functions.size(); ++j) {
                    for (int a = 0; a < nc; ++a) {
                        for (int b = 0; b < nc; ++b) {
                            double sum = 0.0;
                            for (int s = 0; s <= d; ++s) {
                                for (int t = 0; t <= d; ++t) {
                                    sum += A[((a * nc + b) * (d + 1) + s) * (d + 1) + t] *
                                           slot(i, s) * slot(j, t);
                                }
                            }
                            K(space.dofs(p)[basis.functions[i]] * nc + a,
                              space.dofs(p)[basis.functions[j]] * nc + b) += weight * sum;
                        }
                    }
                }
            }
        }
    }
    return K;
}

template <int d>
MatrixX dense(const BlockMatrix& matrix) {
    return matrix * MatrixX::Identity(matrix.n_unknowns(), matrix.n_unknowns());
}

template <int d>
void check_against_naive(const Space<d>& space, const BilinearForm<d>& form) {
    const MatrixX expected = naive_matrix(space, form);
    const MatrixX obtained = dense<d>(assemble(space, form));
    CHECK((obtained - expected).cwiseAbs().maxCoeff() < rounding * expected.cwiseAbs().maxCoeff());
}

Problem elastic(Kinematics kinematics) {
    Problem problem;
    problem.kinematics = kinematics;
    Material material;
    material.stiffness = orthotropic_stiffness({{3.0, 2.0, 1.0}, {0.2, 0.1, 0.3}, {0.7, 0.5, 0.9}});
    problem.materials = {material};
    return problem;
}

MultiPatch<3> curved_volume(int degree) {
    // A quarter ring, bent and refined unevenly, in degrees that differ by direction.
    MultiPatch<3> part;
    Patch<3> patch = make_extrusion(make_quarter_annulus(1.0, 2.0), Vector3(0.3, 0.1, 1.5));
    std::array<Refinement, 3> refinements = {refine(patch.knots(0), degree, 3),
                                             refine(patch.knots(1), std::max(degree, 2), 2),
                                             refine(patch.knots(2), degree, 2)};
    patch = refine<3>(patch, refinements);
    if (degree > 1) {
        // Uneven spans, and a double knot in the last direction.
        patch = refine<3>(patch, {insert_knots(patch.knots(0), std::vector<double>{0.25}),
                                  insert_knots(patch.knots(1), std::vector<double>{}),
                                  insert_knots(patch.knots(2), std::vector<double>{0.5})});
    }
    part.patches.push_back(patch);
    return part;
}

}  // namespace

TEST_CASE("assemble: scalar matrices equal the plain sum over points", "[assembly]") {
    const int degree = GENERATE(1, 2, 3, 4);
    const Space<3> space(curved_volume(degree));
    check_against_naive(space, scalar_form<3>(1.7, 0.0));
    check_against_naive(space, scalar_form<3>(0.4, 2.3));
}

TEST_CASE("assemble: B-splines below the degree of a rational map have no denominator",
          "[assembly]") {
    MultiPatch<2> plane;
    plane.patches = {make_quarter_annulus(1.0, 2.0)};
    const Space<2> lower(plane, {{{KnotVector::uniform(1, 3), KnotVector::uniform(1, 4)}}});
    REQUIRE(lower.weights(0).size() == 0);
    check_against_naive(lower, scalar_form<2>(1.7, 0.0));
    check_against_naive(lower, scalar_form<2>(0.4, 2.3));
    MultiPatch<3> solid;
    solid.patches = {make_extrusion(make_quarter_annulus(1.0, 2.0), Vector3(0.3, 0.1, 1.5))};
    const KnotVector linear = KnotVector::uniform(1, 3);
    const Space<3> lower_solid(solid, {{{linear, linear, linear}}});
    check_against_naive(lower_solid, scalar_form<3>(1.7, 0.0));
    check_against_naive(lower_solid, stiffness_form<3>(elastic(Kinematics::solid), 1));
}

TEST_CASE("assemble: high degrees take the run-time kernels", "[assembly]") {
    MultiPatch<3> part;
    Patch<3> box = make_box<3>(Vector3(1.0, 2.0, 0.5));
    part.patches = {refine<3>(
        box, {refine(box.knots(0), 1, 2), refine(box.knots(1), 2, 1), refine(box.knots(2), 8, 1)})};
    check_against_naive(Space<3>(part), scalar_form<3>(1.0, 0.5));
    part.patches = {refine<3>(
        box, {refine(box.knots(0), 5, 1), refine(box.knots(1), 1, 2), refine(box.knots(2), 4, 2)})};
    check_against_naive(Space<3>(part), scalar_form<3>(1.0, 0.0));
}

TEST_CASE("assemble: orthotropic elasticity equals the plain sum", "[assembly]") {
    const int degree = GENERATE(1, 2, 3);
    const Space<3> space(curved_volume(degree));
    check_against_naive(space, stiffness_form<3>(elastic(Kinematics::solid), 1));
}

TEST_CASE("assemble: plane and axisymmetric elasticity equal the plain sum", "[assembly]") {
    const Kinematics kinematics =
        GENERATE(Kinematics::plane_strain, Kinematics::plane_stress, Kinematics::axisymmetric);
    const int degree = GENERATE(2, 3, 5);
    MultiPatch<2> part;
    Patch<2> patch = make_quarter_annulus(1.0, 2.0);
    part.patches = {
        refine<2>(patch, {refine(patch.knots(0), degree, 3), refine(patch.knots(1), degree, 2)})};
    const Space<2> space(part);
    check_against_naive(space, stiffness_form<2>(elastic(kinematics), 1));
}

TEST_CASE("assemble: patches in any orientation add up, also glued to themselves", "[assembly]") {
    // Two boxes that share a face, the second turned and left-handed, and a third on both.
    const Patch<3> base = make_box<3>(Vector3(1.0, 1.0, 1.0));
    const Patch<3> first = refine<3>(
        base,
        {refine(base.knots(0), 2, 2), refine(base.knots(1), 2, 3), refine(base.knots(2), 2, 2)});
    for (const SideMap<3>& map : all_side_maps<3>()) {
        MultiPatch<3> part;
        part.patches.push_back(first);
        // The neighbour at x > 1: its direction 2 runs away from the interface, its tangents
        // follow the map.
        const TensorSpace<3>& t = first.space();
        std::array<int, 2> tangent_of_second{};
        tangent_of_second[map.axis[0]] = 1;
        tangent_of_second[map.axis[1]] = 2;
        const TensorSpace<3> second_space{
            {t.knots[tangent_of_second[0]], t.knots[tangent_of_second[1]], t.knots[0]}};
        MatrixX points(second_space.n_basis(), 3);
        for (int i = 0; i < second_space.n_basis(); ++i) {
            const std::array<int, 3> index = second_space.indices(i);
            std::array<int, 3> source{};
            source[0] = index[2];
            for (int k = 0; k < 2; ++k) {
                const int on_second = index[map.axis[k]];
                const int n = second_space.knots[map.axis[k]].n_basis();
                source[1 + k] = map.reversed[k] ? n - 1 - on_second : on_second;
            }
            points.row(i) = first.control_points().row(t.index(source));
            points(i, 0) += 1.0 + 0.2 * points(i, 0);
        }
        part.patches.emplace_back(second_space, points);
        part.interfaces.push_back({0, 1, 1, 4, map});
        check(part);
        check_against_naive(Space<3>(part), scalar_form<3>(1.0, 0.5));
    }
    // A ring of one patch.
    MultiPatch<2> ring;
    Curve inner = make_arc(1.0, 0.0, 2.0 * 3.14159265358979323846);
    Curve outer = make_arc(2.0, 0.0, 2.0 * 3.14159265358979323846);
    ring.patches = {make_ruled(inner, outer)};
    ring.interfaces = {{0, 0, 0, 1, SideMap<2>::identity()}};
    check_against_naive(Space<2>(ring), scalar_form<2>(1.0, 1.0));
}

TEST_CASE("assemble: the same bits for one and two threads", "[assembly]") {
    const Space<3> space(curved_volume(3));
    const BilinearForm<3> form = stiffness_form<3>(elastic(Kinematics::solid), 1);
    const int before = n_threads();
    set_n_threads(1);
    const BlockMatrix one = assemble(space, form);
    set_n_threads(2);
    const BlockMatrix two = assemble(space, form);
    set_n_threads(before);
    CHECK(one.columns == two.columns);
    CHECK(std::equal(one.values.begin(), one.values.end(), two.values.begin()));
}

TEST_CASE("assemble: rigid motions have no energy, exactly six of them", "[assembly]") {
    const Space<3> space(curved_volume(2));
    const MatrixX K = dense<3>(assemble(space, stiffness_form<3>(elastic(Kinematics::solid), 1)));
    const VectorX eigenvalues =
        Eigen::SelfAdjointEigenSolver<MatrixX>(K, Eigen::EigenvaluesOnly).eigenvalues();
    const double scale = eigenvalues[eigenvalues.size() - 1];
    CHECK(std::abs(eigenvalues[5]) < 1e-13 * scale);
    CHECK(eigenvalues[6] > 1e-8 * scale);
}

TEST_CASE("assemble: a folded patch is named with place and value", "[assembly]") {
    MatrixX corners(4, 2);
    corners << 0, 0, 1, 0, 0, 1, 0.2, 0.1;
    MultiPatch<2> part;
    part.patches = {make_multilinear<2>(corners)};
    const Space<2> space(refine<2>(part, std::nullopt, std::array<int, 2>{4, 4}));
    CHECK_THROWS_AS(assemble(space, scalar_form<2>(1.0, 0.0)), GeometryError);
    CHECK_THROWS_WITH(assemble(space, scalar_form<2>(1.0, 0.0)),
                      Catch::Matchers::Contains("patch 0 is folded: det J = ") &&
                          Catch::Matchers::Contains("at parameter ("));
}

TEST_CASE("make_pattern: one row per function, symmetric half, all neighbours", "[assembly]") {
    const Space<3> space(curved_volume(2));
    const BlockMatrix pattern = make_pattern(space, 3);
    const TensorSpace<3>& tensor = space.tensor(0);
    std::int64_t expected = 0;
    std::array<NeighbourRange, 3> ranges = {
        neighbours(tensor.knots[0]), neighbours(tensor.knots[1]), neighbours(tensor.knots[2])};
    for (int i = 0; i < tensor.n_basis(); ++i) {
        const std::array<int, 3> index = tensor.indices(i);
        std::int64_t n = 1;
        for (int k = 0; k < 3; ++k) {
            n *= ranges[k].last[index[k]] - ranges[k].first[index[k]] + 1;
        }
        expected += n;
    }
    CHECK(pattern.n_blocks() == (expected + tensor.n_basis()) / 2);
}
