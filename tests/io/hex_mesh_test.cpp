#include "io/hex_mesh.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "meshing/parts/parts.h"

using namespace couture;
using namespace couture::iga;
using namespace couture::io;
using Catch::Matchers::Contains;

namespace {

MultiPatch<3> part(const std::string& name) {
    return std::get<MultiPatch<3>>(meshing::make_part(name, {}));
}

/// Edges from the first corner along the local axes: positive for an element that is not inside
/// out.
double corner_determinant(const HexMesh& mesh, long element) {
    const auto node = [&](int a) -> Vector3 { return mesh.nodes.row(mesh.elements(element, a)); };
    Matrix<3> edges;
    edges << node(1) - node(0), node(3) - node(0), node(4) - node(0);
    return edges.determinant();
}

}  // namespace

TEST_CASE("make_hexahedra: nodes of degree 1 are the functions, corners in the order of Abaqus",
          "[io]") {
    const MultiPatch<3> box = refine<3>(part("box"), 1, std::array<int, 3>{2, 1, 1});
    const HexMesh mesh = make_hexahedra(Space<3>(box));
    CHECK(mesh.nodes == box.patches[0].control_points());
    REQUIRE(mesh.elements.rows() == 2);
    Eigen::MatrixXi expected(2, 8);
    expected << 0, 1, 4, 3, 6, 7, 10, 9, 1, 2, 5, 4, 7, 8, 11, 10;
    CHECK(mesh.elements == expected);
    CHECK(mesh.node_sets.at("x_low") == std::vector<int>{0, 3, 6, 9});
    CHECK(mesh.places[1].element == std::array<int, 3>{1, 0, 0});
    CHECK_FALSE(mesh.places[1].is_mirrored);
}

TEST_CASE("make_hexahedra: elements of a left-handed patch are not inside out", "[io]") {
    const MultiPatch<3> box = refine<3>(part("box"), 1, std::array<int, 3>{2, 3, 2});
    MultiPatch<3> mirrored = box;
    MatrixX points = box.patches[0].control_points();
    points.col(1) *= -1.0;
    mirrored.patches[0] = Patch<3>(box.patches[0].space(), points);
    const int degree = GENERATE(1, 2);
    for (const MultiPatch<3>& geometry : {box, mirrored}) {
        const HexMesh mesh =
            make_hexahedra(*make_hexahedral_space(geometry, degree, std::array<int, 3>{1, 1, 1}));
        REQUIRE(mesh.elements.rows() == 12);
        for (long e = 0; e < mesh.elements.rows(); ++e) {
            CHECK(corner_determinant(mesh, e) > 0.0);
        }
    }
}

TEST_CASE("make_hexahedra: patches share nodes, middles of edges lie on the geometry", "[io]") {
    MultiPatch<3> plate = part("plate_with_hole_3d");
    REQUIRE(plate.n_patches() > 1);
    const HexMesh mesh =
        make_hexahedra(*make_hexahedral_space(plate, 2, std::array<int, 3>{3, 3, 1}));
    CHECK(mesh.elements.cols() == 20);
    // Corners of one patch's neighbours are found once: no two nodes in one place.
    double nearest = 1.0;
    for (long i = 0; i < mesh.nodes.rows(); ++i) {
        for (long j = 0; j < i; ++j) {
            nearest = std::min(nearest, (mesh.nodes.row(i) - mesh.nodes.row(j)).norm());
        }
    }
    CHECK(nearest > 1e-3);
    const std::vector<int>& hole = mesh.node_sets.at("hole");
    CHECK(hole.size() > 20);
    for (const int node : hole) {
        CHECK(mesh.nodes.row(node).head(2).norm() == Approx(1.0).epsilon(1e-14));
    }
    // The middle of an edge lies between its ends in the numbering of Abaqus.
    for (long e = 0; e < mesh.elements.rows(); ++e) {
        const auto node = [&](int a) -> Vector3 { return mesh.nodes.row(mesh.elements(e, a)); };
        const std::array<std::array<int, 3>, 12> edges = {{{0, 1, 8},
                                                           {1, 2, 9},
                                                           {2, 3, 10},
                                                           {3, 0, 11},
                                                           {4, 5, 12},
                                                           {5, 6, 13},
                                                           {6, 7, 14},
                                                           {7, 4, 15},
                                                           {0, 4, 16},
                                                           {1, 5, 17},
                                                           {2, 6, 18},
                                                           {3, 7, 19}}};
        for (const auto& [from, to, middle] : edges) {
            const double length = (node(to) - node(from)).norm();
            CHECK((node(middle) - 0.5 * (node(from) + node(to))).norm() < 0.1 * length);
        }
    }
}

TEST_CASE("make_hexahedra: one brick of 20 nodes leaves out centres of faces and the middle",
          "[io]") {
    const MultiPatch<3> box = part("box");
    CHECK(make_hexahedra(*make_hexahedral_space(box, 2, {1, 1, 1})).nodes.rows() == 20);
    CHECK(make_hexahedra(*make_hexahedral_space(box, 2, {2, 1, 1})).nodes.rows() == 32);
}

TEST_CASE("make_hexahedra: spaces that are not hexahedra are named", "[io]") {
    const MultiPatch<3> box = part("box");
    CHECK_THROWS_WITH(make_hexahedra(Space<3>(refine<3>(box, 2, std::array<int, 3>{2, 2, 2}))),
                      "hexahedra: patch 0 has degree 2 with 4 functions on 2 elements; all "
                      "directions must have degree 1, or degree 2 with double interior knots");
    CHECK_THROWS_WITH(make_hexahedra(Space<3>(refine<3>(box, 3, std::array<int, 3>{1, 1, 1}))),
                      Contains("patch 0 has degree 3"));
    CHECK_THROWS_WITH(make_hexahedral_space(box, 3, {1, 1, 1}),
                      "hexahedra: degree = 3; must be 1 or 2");
}
