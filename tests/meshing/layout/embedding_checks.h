#pragma once

#include <catch2/catch.hpp>

#include <set>

#include "meshing/layout/embedded_layout.h"

namespace couture::meshing {

// Every quad is a disc whose boundary passes its four corners in order.
inline void check_embedding(const SurfaceMesh& mesh, const EmbeddedLayout& embedded) {
    const QuadLayout& layout = embedded.layout;
    std::set<int> inner;
    for (int a = 0; a < layout.n_arcs(); ++a) {
        const auto& path = embedded.arcs[a];
        REQUIRE(path.size() >= 2);
        CHECK(path.front() == embedded.nodes[layout.arcs()[a].from]);
        CHECK(path.back() == embedded.nodes[layout.arcs()[a].to]);
        for (std::size_t k = 0; k + 1 < path.size(); ++k) {
            const auto h = mesh.find_halfedge(path[k], path[k + 1]);
            REQUIRE(h.is_valid());
            const int left = embedded.quad_of_face[mesh.face_handle(h).idx()];
            const int right =
                embedded.quad_of_face[mesh.face_handle(mesh.opposite_halfedge_handle(h)).idx()];
            CHECK(left == layout.arc_quads(a)[0].quad);
            CHECK(right == layout.arc_quads(a)[1].quad);
            if (k > 0) CHECK(inner.insert(path[k].idx()).second);
        }
    }
    std::vector<int> chi(layout.n_quads(), 0);
    std::set<std::pair<int, int>> vertices;
    std::set<std::pair<int, int>> edges;
    for (const auto face : mesh.faces()) {
        const int q = embedded.quad_of_face[face.idx()];
        REQUIRE(q >= 0);
        ++chi[q];
        for (const auto v : mesh.fv_range(face)) vertices.insert({q, v.idx()});
        for (const auto e : mesh.fe_range(face)) edges.insert({q, e.idx()});
    }
    for (const auto& [q, v] : vertices) ++chi[q];
    for (const auto& [q, e] : edges) --chi[q];
    for (int q = 0; q < layout.n_quads(); ++q) CHECK(chi[q] == 1);
}

}  // namespace couture::meshing
