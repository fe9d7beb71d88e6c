#include "iga/distributed/piece_space.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "iga/assembly/assembler.h"
#include "iga/assembly/form_operator.h"
#include "iga/distributed/partition.h"
#include "iga/topology/interface_match.h"
#include "tests/iga/distributed/sample_bodies.h"

namespace couture::iga {

namespace {

/// Pieces of a refined body, and the whole.
template <int d>
struct Split {
    RefinedGeometry<d> geometry;
    Space<d> whole;
    std::vector<PieceSpace<d>> pieces;

    Split(const MultiPatch<d>& body, int degree, std::array<int, d> n_elements, int n_parts)
        : geometry(body, degree, n_elements), whole(refine<d>(body, degree, n_elements)) {
        std::vector<std::array<int, d>> n;
        for (int p = 0; p < body.n_patches(); ++p) {
            n.push_back(geometry.n_elements(p));
        }
        const auto parts = partition<d>(
            n, [&](const ElementBox<d>& box) { return geometry.middle(box); }, n_parts);
        for (const auto& boxes : parts) {
            pieces.push_back(geometry.make_space(boxes));
        }
    }

    /// Number in the whole space of a piece's function.
    [[nodiscard]] int whole_dof(FunctionKey key) const {
        return whole.dofs(JoinedFunctions<d>::patch_of(key))[JoinedFunctions<d>::function_of(key)];
    }
    [[nodiscard]] VectorX on_piece(const PieceSpace<d>& piece, const VectorX& u, int n) const {
        VectorX local(static_cast<Eigen::Index>(piece.functions.size()) * n);
        for (std::size_t i = 0; i < piece.functions.size(); ++i) {
            local.segment(static_cast<Eigen::Index>(i) * n, n) =
                u.segment(static_cast<Eigen::Index>(whole_dof(piece.functions[i])) * n, n);
        }
        return local;
    }
    void add_from_piece(const PieceSpace<d>& piece, const VectorX& local, int n,
                        VectorX& sum) const {
        for (std::size_t i = 0; i < piece.functions.size(); ++i) {
            sum.segment(static_cast<Eigen::Index>(whole_dof(piece.functions[i])) * n, n) +=
                local.segment(static_cast<Eigen::Index>(i) * n, n);
        }
    }
};

template <int d>
void check_split(const MultiPatch<d>& body, int degree, std::array<int, d> n_elements,
                 int n_parts) {
    const Split<d> split(body, degree, n_elements, n_parts);
    std::srand(5);

    SECTION("functions are joined as in the whole") {
        std::map<FunctionKey, int> dof_of;
        for (const PieceSpace<d>& piece : split.pieces) {
            std::vector<int> dofs;
            for (const FunctionKey key : piece.functions) {
                dof_of[key] = split.whole_dof(key);
                dofs.push_back(dof_of[key]);
            }
            std::sort(dofs.begin(), dofs.end());
            CHECK(std::adjacent_find(dofs.begin(), dofs.end()) == dofs.end());
        }
        CHECK(dof_of.size() == static_cast<std::size_t>(split.whole.n_dofs()));
    }

    SECTION("maps and fields are those of the whole") {
        const VectorX u = VectorX::Random(split.whole.n_dofs());
        for (const PieceSpace<d>& piece : split.pieces) {
            const VectorX local = split.on_piece(piece, u, 1);
            for (std::size_t b = 0; b < piece.boxes.size(); ++b) {
                const auto p = static_cast<int>(b);
                const TensorSpace<d>& part = piece.space->tensor(p);
                for (int trial = 0; trial < 5; ++trial) {
                    Vector<d> xi;
                    for (int k = 0; k < d; ++k) {
                        const double t = 0.5 + 0.5 * Vector<1>::Random()[0];
                        xi[k] = (1.0 - t) * part.knots[k].front() + t * part.knots[k].back();
                    }
                    const int patch = piece.boxes[b].patch;
                    CHECK((piece.space->geometry().patches[b].point(xi) -
                           body.patches[patch].point(xi))
                              .norm() < 1e-12);
                    const auto here = evaluate_basis(part, piece.space->weights(p), xi);
                    const auto there =
                        evaluate_basis(split.whole.tensor(patch), split.whole.weights(patch), xi);
                    double value = 0.0;
                    double expected = 0.0;
                    for (std::size_t i = 0; i < here.functions.size(); ++i) {
                        value += here.values[i] * local[piece.space->dofs(p)[here.functions[i]]];
                        expected +=
                            there.values[i] * u[split.whole.dofs(patch)[there.functions[i]]];
                    }
                    CHECK(value == Approx(expected).margin(1e-12));
                }
            }
        }
    }

    SECTION("shares of a matrix add up to the whole, with and without it") {
        const BilinearForm<d> form = scalar_form<d>(1.0, 2.0);
        const VectorX u = VectorX::Random(split.whole.n_dofs());
        const VectorX expected = assemble(split.whole, form) * u;
        VectorX by_matrix = VectorX::Zero(u.size());
        VectorX by_operator = VectorX::Zero(u.size());
        for (const PieceSpace<d>& piece : split.pieces) {
            const VectorX local = split.on_piece(piece, u, 1);
            split.add_from_piece(piece, assemble(*piece.space, form) * local, 1, by_matrix);
            split.add_from_piece(piece, FormOperator<d>(*piece.space, form) * local, 1,
                                 by_operator);
        }
        CHECK((by_matrix - expected).norm() < 1e-12 * expected.norm());
        CHECK((by_operator - expected).norm() < 1e-12 * expected.norm());
    }

    SECTION("layers beside a set have all of its functions") {
        Split<d> mutable_split = split;
        for (const auto& [name, set] : body.boundary_sets) {
            const PieceSpace<d> layers = mutable_split.geometry.make_layers({name});
            std::set<int> expected;
            std::set<int> found;
            for (const PatchEntity<d>& entity : set) {
                const std::vector<int> dofs = split.whole.dofs_on(entity);
                expected.insert(dofs.begin(), dofs.end());
            }
            for (const PatchEntity<d>& entity : layers.space->geometry().boundary_set(name)) {
                for (const int dof : layers.space->dofs_on(entity)) {
                    found.insert(split.whole_dof(layers.functions[dof]));
                }
            }
            CHECK(found == expected);
        }
    }

    SECTION("linear functions are prolonged to linear functions") {
        RefinedGeometry<d> geometry = split.geometry;
        for (const PieceSpace<d>& piece : split.pieces) {
            const PieceSpace<d> linear = geometry.make_space(piece.boxes, Functions::linear);
            const SparseMatrix P = prolongation_from_linear(geometry, piece, linear);
            const VectorX ones = P * VectorX::Ones(P.cols());
            CHECK((ones - VectorX::Ones(P.rows())).cwiseAbs().maxCoeff() < 1e-12);
        }
    }
}

}  // namespace

TEST_CASE("pieces of a box of three volumes turned against each other") {
    check_split<3>(three_turned_boxes(), 2, {4, 3, 3}, 5);
}

TEST_CASE("pieces of a rational annulus closed in itself") {
    check_split<2>(ring_of_two(), 3, {5, 4}, 4);
}

TEST_CASE("pieces of a sphere's sector with collapsed sides") {
    check_split<3>(collapsed_wedge(), 2, {3, 4, 2}, 3);
}

TEST_CASE("problem on pieces: what holds for patches holds for their boxes") {
    Problem problem;
    problem.materials = {make_isotropic("steel", 1.0, 0.3), make_isotropic("rubber", 2.0, 0.4)};
    problem.materials[0].patches = {0, 2};
    problem.materials[1].patches = {1};
    problem.body_forces.emplace_back();
    const std::vector<ElementBox<3>> boxes = {{2, {}, {1, 1, 1}}, {0, {}, {1, 1, 1}}};
    const Problem pieces = on_pieces<3>(problem, boxes);
    REQUIRE(pieces.materials.size() == 1);
    CHECK(pieces.materials[0].name == "steel");
    CHECK(pieces.materials[0].patches == PatchList{0, 1});
    REQUIRE(pieces.body_forces.size() == 1);
    CHECK(pieces.body_forces[0].patches.empty());
}

}  // namespace couture::iga
