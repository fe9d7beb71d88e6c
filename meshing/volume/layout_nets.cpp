#include "meshing/volume/layout_nets.h"

#include "meshing/volume/coons.h"

namespace couture::meshing {

namespace {

// Knots of a cuboid's direction: those of its first edge, backwards where that runs against it.
iga::KnotVector cuboid_knots(const VolumetricLayout& layout, const LayoutCells& cells,
                             const std::vector<iga::KnotVector>& knots, int cuboid, int direction) {
    const int edge = cells.cuboid_edges[cuboid][4 * direction];
    const bool is_forward = layout.cuboids[cuboid][0] == cells.edges[edge].from;
    return is_forward ? knots[edge] : knots[edge].reversed();
}

MatrixX straight_edge(const LayoutCells& cells, const LayoutNets& nets, int edge) {
    return straight_net(nets.knots[edge], nets.nodes.row(cells.edges[edge].from),
                        nets.nodes.row(cells.edges[edge].to));
}

// For each edge those that face it in a face of the layout, with whether they run against it.
std::vector<std::vector<std::pair<int, bool>>> facing_edges(const LayoutCells& cells) {
    std::vector<std::vector<std::pair<int, bool>>> facing(cells.edges.size());
    for (const auto& face : cells.faces) {
        for (const int k : {0, 2}) {
            const int a = face.edges[k];
            const int b = face.edges[k + 1];
            const bool is_reversed = cells.runs_against_sheet[a] != cells.runs_against_sheet[b];
            facing[a].emplace_back(b, is_reversed);
            facing[b].emplace_back(a, is_reversed);
        }
    }
    return facing;
}

iga::Volume make_patch(const VolumetricLayout& layout, const LayoutCells& cells,
                       const LayoutNets& nets, int cuboid) {
    const iga::TensorSpace<3> space{{cuboid_knots(layout, cells, nets.knots, cuboid, 0),
                                     cuboid_knots(layout, cells, nets.knots, cuboid, 1),
                                     cuboid_knots(layout, cells, nets.knots, cuboid, 2)}};
    MatrixX net = MatrixX::Zero(space.n_basis(), nets.nodes.cols());
    for (int side = 0; side < 6; ++side) {
        const int face = cells.cuboid_faces[cuboid][side];
        const auto [a, b] = iga::tangential_directions<3>(side);
        const std::array<int, 2> sizes{space.knots[a].n_basis(), space.knots[b].n_basis()};
        const auto functions =
            iga::functions_on<3>(space, iga::make_side<3>(cuboid, side).position);
        const auto places = grid_places(
            map_of_nodes(cells.faces[face].nodes, side_nodes(layout, {cuboid, side})), sizes);
        for (std::size_t i = 0; i < places.size(); ++i) {
            net.row(functions[places[i]]) = nets.faces[face].row(static_cast<long>(i));
        }
    }
    net = fill_coons<3>(space, std::move(net));
    return net.cols() == 4 ? iga::Volume::from_homogeneous(space, net, true)
                           : iga::Volume(space, std::move(net));
}

}  // namespace

iga::TensorSpace<2> face_space(const LayoutCells& cells, const std::vector<iga::KnotVector>& knots,
                               int face) {
    const auto& [nodes, edges, sides] = cells.faces[face];
    // The first direction leaves the smallest node, as does the second: both run as their edges.
    return {{knots[edges[0]], knots[edges[2]]}};
}

MatrixX with_border(const LayoutCells& cells, const LayoutNets& nets, int face, MatrixX net) {
    const auto& [nodes, edges, sides] = cells.faces[face];
    const iga::TensorSpace<2> space = face_space(cells, nets.knots, face);
    const auto [n, m] = space.sizes();
    for (int k = 0; k < 4; ++k) {
        const MatrixX& edge = nets.edges[edges[k]];
        const int from = k < 2 ? nodes[k == 0 ? 0 : 2] : nodes[k == 2 ? 0 : 1];
        const bool is_forward = cells.edges[edges[k]].from == from;
        const int size = k < 2 ? n : m;
        for (int i = 0; i < size; ++i) {
            const int row =
                k < 2 ? space.index({i, k == 0 ? 0 : m - 1}) : space.index({k == 2 ? 0 : n - 1, i});
            net.row(row) = edge.row(is_forward ? i : size - 1 - i);
        }
    }
    return net;
}

void bend_edges(const LayoutCells& cells, LayoutNets& nets) {
    // More change nothing that a start would need.
    constexpr int n_rounds = 50;
    const auto n_edges = static_cast<int>(cells.edges.size());
    nets.edges.resize(n_edges);
    std::vector<bool> is_given(n_edges);
    std::vector<MatrixX> bends(n_edges);
    for (int e = 0; e < n_edges; ++e) {
        const MatrixX straight = straight_edge(cells, nets, e);
        is_given[e] = nets.edges[e].rows() > 0;
        bends[e] = is_given[e] ? nets.edges[e] - straight : MatrixX(0.0 * straight);
    }
    const auto facing = facing_edges(cells);
    for (int round = 0; round < n_rounds; ++round) {
        for (int e = 0; e < n_edges; ++e) {
            if (is_given[e]) continue;
            MatrixX sum = 0.0 * bends[e];
            for (const auto& [other, is_reversed] : facing[e]) {
                sum += is_reversed ? MatrixX(bends[other].colwise().reverse()) : bends[other];
            }
            bends[e] = sum / static_cast<double>(facing[e].size());
        }
    }
    for (int e = 0; e < n_edges; ++e) {
        if (!is_given[e]) nets.edges[e] = straight_edge(cells, nets, e) + bends[e];
    }
}

iga::MultiPatch<3> make_multipatch(const VolumetricLayout& layout, const LayoutCells& cells,
                                   LayoutNets nets) {
    nets.edges.resize(cells.edges.size());
    nets.faces.resize(cells.faces.size());
    for (int e = 0; e < static_cast<int>(cells.edges.size()); ++e) {
        if (nets.edges[e].rows() == 0) nets.edges[e] = straight_edge(cells, nets, e);
    }
    iga::MultiPatch<3> result;
    for (int f = 0; f < static_cast<int>(cells.faces.size()); ++f) {
        if (nets.faces[f].rows() == 0) {
            const iga::TensorSpace<2> space = face_space(cells, nets.knots, f);
            const MatrixX border =
                with_border(cells, nets, f, MatrixX::Zero(space.n_basis(), nets.nodes.cols()));
            nets.faces[f] = fill_coons<2>(space, border);
        }
        const auto& sides = cells.faces[f].sides;
        if (sides.size() == 2) {
            result.interfaces.push_back(
                {sides[0].cuboid, sides[0].side, sides[1].cuboid, sides[1].side,
                 map_of_nodes(side_nodes(layout, sides[0]), side_nodes(layout, sides[1]))});
        }
    }
    for (int c = 0; c < layout.n_cuboids(); ++c) {
        result.patches.push_back(make_patch(layout, cells, nets, c));
    }
    for (const auto& [name, sides] : layout.sets) {
        for (const auto& side : sides) {
            result.boundary_sets[name].push_back(iga::make_side<3>(side.cuboid, side.side));
        }
    }
    return result;
}

}  // namespace couture::meshing
