#include "iga/assembly/form_operator.h"

#include <catch2/catch.hpp>
#include <random>

#include "iga/assembly/assembler.h"
#include "iga/assembly/elasticity.h"
#include "iga/assembly/partial_assembly.h"
#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"

using namespace couture;
using namespace couture::iga;
using Catch::Matchers::Contains;

namespace {

constexpr double rounding = 1e-13;

VectorX random_vector(int n, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    return VectorX::NullaryExpr(n, [&]() { return uniform(generator); });
}

template <int d>
Space<d> make_space(std::vector<Patch<d>> patches, int degree, int n_elements) {
    MultiPatch<d> part;
    part.patches = std::move(patches);
    find_interfaces(part);
    std::vector<TensorSpace<d>> spaces;
    for (const Patch<d>& patch : part.patches) {
        TensorSpace<d> tensor = patch.space();
        int n = n_elements;
        for (KnotVector& knots : tensor.knots) {
            // Another number of elements in each direction of a single patch.
            knots = KnotVector::uniform(degree, n, knots.front(), knots.back());
            n += part.n_patches() == 1 ? 1 : 0;
        }
        spaces.push_back(tensor);
    }
    return {std::move(part), std::move(spaces)};
}

Volume annulus() { return make_extrusion(make_quarter_annulus(1.0, 2.0), Vector3(0.0, 0.0, 1.0)); }

template <int d>
BilinearForm<d> elastic_form(Kinematics kinematics, int n_patches) {
    Problem problem;
    problem.kinematics = kinematics;
    Material material;
    material.name = "unit";
    material.stiffness = isotropic_stiffness(1.0, 0.3);
    problem.materials = {material};
    return stiffness_form<d>(problem, n_patches);
}

template <int d>
void check_against_matrix(const Space<d>& space, const BilinearForm<d>& form) {
    const BlockMatrix matrix = assemble(space, form);
    const FormOperator<d> by_form(space, form);
    REQUIRE(by_form.n_unknowns() == matrix.n_unknowns());
    const VectorX u = random_vector(matrix.n_unknowns(), 7);
    const VectorX expected = matrix * u;
    CHECK((by_form * u - expected).norm() < 100 * rounding * expected.norm());

    const MatrixX blocks = by_form.diagonal_blocks();
    const int nc = form.n_components;
    double error = 0.0;
    for (int i = 0; i < matrix.n_rows; ++i) {
        const double* block = matrix.find(i, i);
        for (int k = 0; k < nc * nc; ++k) {
            error = std::max(error, std::abs(block[k] - blocks(i * nc + k / nc, k % nc)));
        }
    }
    CHECK(error < 100 * rounding * blocks.cwiseAbs().maxCoeff());
    const MatrixX diagonals = by_form.diagonal_blocks(true);
    for (int i = 0; i < blocks.rows(); ++i) {
        CHECK(diagonals(i, i % nc) == Approx(blocks(i, i % nc)).epsilon(1e-12));
        CHECK(diagonals.row(i).cwiseAbs().sum() == std::abs(diagonals(i, i % nc)));
    }

    // Every third function.
    std::vector<int> functions;
    for (int i = 0; i < space.n_dofs(); i += 3) {
        functions.push_back(i);
    }
    const BlockMatrix some = assemble_between(space, form, functions);
    REQUIRE(some.n_rows == static_cast<int>(functions.size()));
    std::int64_t n_found = 0;
    error = 0.0;
    for (int i = 0; i < some.n_rows; ++i) {
        for (int j = i; j < some.n_rows; ++j) {
            const double* here = some.find(i, j);
            const double* there = matrix.find(functions[i], functions[j]);
            REQUIRE((here == nullptr) == (there == nullptr));
            if (here == nullptr) {
                continue;
            }
            ++n_found;
            for (int k = 0; k < nc * nc; ++k) {
                error = std::max(error, std::abs(here[k] - there[k]));
            }
        }
    }
    CHECK(n_found == some.n_blocks());
    CHECK(error < 100 * rounding * blocks.cwiseAbs().maxCoeff());
}

}  // namespace

TEST_CASE("FormOperator: products and parts of the matrix are those of the assembled one",
          "[assembly]") {
    SECTION("elasticity, rational, every degree") {
        const int degree = GENERATE(1, 2, 3, 4, 5);
        const Space<3> space = make_space<3>({annulus()}, degree, 2);
        check_against_matrix(space, elastic_form<3>(Kinematics::solid, 1));
    }
    SECTION("elasticity on two patches") {
        const Space<3> space = make_space<3>(
            {make_box<3>(Vector3(1.0, 2.0, 1.5)),
             Volume(make_box<3>(Vector3::Ones()).space(),
                    [] {
                        MatrixX points = make_box<3>(Vector3(1.0, 2.0, 1.5)).control_points();
                        points.col(0).array() += 1.0;
                        return points;
                    }())},
            2, 3);
        REQUIRE(space.n_dofs() < 2 * space.tensor(0).n_basis());
        check_against_matrix(space, elastic_form<3>(Kinematics::solid, 2));
    }
    SECTION("with values, in the plane") {
        const Space<2> space = make_space<2>({make_quarter_annulus(1.0, 2.0)}, 3, 4);
        check_against_matrix(space, scalar_form<2>(2.0, 3.0));
        check_against_matrix(space, elastic_form<2>(Kinematics::plane_strain, 1));
        check_against_matrix(space, elastic_form<2>(Kinematics::axisymmetric, 1));
    }
    SECTION("Poisson in space") {
        check_against_matrix(make_space<3>({annulus()}, 2, 3), scalar_form<3>(2.0, 0.0));
    }
    SECTION("coefficients that vary") {
        BilinearForm<3> form = scalar_form<3>(1.0, 0.0);
        form.varies = true;
        form.coefficients = [](int, const Vector3& x, double* A) {
            for (int s = 0; s < 3; ++s) {
                A[s * 4 + s] = 1.0 + x[0] * x[1];
            }
            A[0 * 4 + 1] = A[1 * 4 + 0] = 0.3 * x[2];
        };
        check_against_matrix(make_space<3>({annulus()}, 2, 3), form);
    }
}

TEST_CASE("FormOperator: the same bits for any number of threads", "[assembly]") {
    const Space<3> space = make_space<3>({annulus()}, 2, 6);
    const FormOperator<3> by_form(space, elastic_form<3>(Kinematics::solid, 1));
    const VectorX u = random_vector(by_form.n_unknowns(), 3);
    const int before = n_threads();
    set_n_threads(1);
    const VectorX one = by_form * u;
    set_n_threads(3);
    const VectorX three = by_form * u;
    set_n_threads(before);
    CHECK((one - three).isZero(0.0));
}

TEST_CASE("FormOperator: mean coefficients are those of the matrix", "[assembly]") {
    const Space<3> space = make_space<3>({annulus()}, 2, 8);
    const BilinearForm<3> form = elastic_form<3>(Kinematics::solid, 1);
    const FormOperator<3> by_form(space, form);
    const auto means = by_form.mean_coefficients();
    const auto expected = patch_coefficients(assemble(space, form), make_patch_structure(space), 0);
    REQUIRE(means.size() == 1);
    REQUIRE(means[0].size() == 3);
    // The matrix' means are taken over the inner functions only.
    constexpr double part_of_borders = 0.05;
    for (int c = 0; c < 3; ++c) {
        for (int k = 0; k < 3; ++k) {
            CHECK(means[0][c].stretch[k] ==
                  Approx(expected[c].stretch[k]).epsilon(part_of_borders));
        }
    }
}

TEST_CASE("assemble_multilinear: energies of linear displacements are exact", "[assembly]") {
    const Space<3> space = make_space<3>({make_box<3>(Vector3(1.0, 2.0, 1.5))}, 2, 6);
    const CoarseFunctions coarse = make_coarse_functions(space, 3, 100);
    const BlockMatrix matrix =
        assemble_multilinear(space, elastic_form<3>(Kinematics::solid, 1), coarse);
    REQUIRE(matrix.n_rows == coarse.n_nodes);
    const std::array<int, 3>& n = coarse.n_elements[0];
    REQUIRE(coarse.n_nodes == (n[0] + 1) * (n[1] + 1) * (n[2] + 1));
    // u_x = x: strain 1 along x.
    VectorX u = VectorX::Zero(matrix.n_unknowns());
    for (int node = 0; node < coarse.n_nodes; ++node) {
        u[3 * coarse.nodes_of_patch[0][node]] = static_cast<double>(node % (n[0] + 1)) / n[0];
    }
    const double volume = 3.0;
    CHECK(u.dot(VectorX(matrix * u)) ==
          Approx(volume * isotropic_stiffness(1.0, 0.3)(0, 0)).epsilon(1e-12));
    const VectorX rigid = VectorX::Ones(matrix.n_unknowns());
    CHECK(VectorX(matrix * rigid).norm() < 1e-12);
}

TEST_CASE("FormOperator: a folded patch is refused", "[assembly]") {
    Volume box = make_box<3>(Vector3::Ones());
    MatrixX points = box.control_points();
    // The last corner far behind the first.
    points.row(points.rows() - 1).setConstant(-2.0);
    const Space<3> space = make_space<3>({Volume(box.space(), points)}, 1, 3);
    CHECK_THROWS_WITH(FormOperator<3>(space, elastic_form<3>(Kinematics::solid, 1)),
                      Contains("patch 0 is folded: det J = "));
}
