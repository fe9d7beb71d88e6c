#include "meshing/field/layout_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "meshing/field/aligned_field.h"
#include "meshing/field/layout_topology.h"

namespace couture::meshing {

namespace {

constexpr double exactly = std::numeric_limits<double>::infinity();

double sum_of_squares(const Connection& connection) {
    double sum = 0.0;
    for (const double x : connection.angles()) sum += x * x;
    return sum;
}

// Turns the field of each component by the mean of its offsets by length; these are what is left.
void turn_to_arcs(const SurfaceMesh& mesh, DirectionField& field, std::vector<ArcOffset>& offsets) {
    const std::vector<int> component = face_components(mesh);
    std::vector<double> sum(component.size(), 0.0);
    std::vector<double> length(component.size(), 0.0);
    for (const ArcOffset& arc : offsets) {
        const int c = component[arc.face.idx()];
        sum[c] += arc.length * arc.offset;
        length[c] += arc.length;
    }
    const auto mean = [&](int face) { return sum[component[face]] / length[component[face]]; };
    for (std::size_t f = 0; f < field.angles.size(); ++f) {
        field.angles[f] += mean(static_cast<int>(f));
    }
    for (ArcOffset& arc : offsets) arc.offset -= mean(arc.face.idx());
}

// Tagged ones and those of feature arcs.
std::vector<bool> feature_edges(const SurfaceMesh& mesh, const EmbeddedLayout& embedding) {
    std::vector<bool> is_feature(mesh.n_edges());
    for (const EdgeHandle edge : mesh.edges()) {
        is_feature[edge.idx()] = mesh.data(edge).feature >= 0;
    }
    for (int a = 0; a < embedding.layout.n_arcs(); ++a) {
        const auto& path = embedding.arcs[a];
        for (std::size_t i = 0; embedding.is_feature_arc[a] && i + 1 < path.size(); ++i) {
            is_feature[mesh.edge_handle(mesh.find_halfedge(path[i], path[i + 1])).idx()] = true;
        }
    }
    return is_feature;
}

constexpr double quarter = 0.5 * std::numbers::pi;

// For each edge how many quarter turns the chart on the right of its halfedge 0 is turned against
// the one on its left.
std::vector<int> chart_turns(const SurfaceMesh& mesh, const EmbeddedLayout& embedding) {
    std::vector<int> turns(mesh.n_edges(), 0);
    for (int a = 0; a < embedding.layout.n_arcs(); ++a) {
        if (embedding.layout.is_boundary_arc(a)) continue;
        const auto& [left, right] = embedding.layout.arc_quads(a);
        const int across = right.side + 2 - left.side;
        const auto& path = embedding.arcs[a];
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            const HalfedgeHandle h = mesh.find_halfedge(path[i], path[i + 1]);
            const EdgeHandle edge = mesh.edge_handle(h);
            turns[edge.idx()] = mesh.halfedge_handle(edge, 0) == h ? across : -across;
        }
    }
    return turns;
}

// Angles of first axes at the faces beside arcs, by the arcs themselves.
std::vector<std::pair<FaceHandle, double>> axes_at_arcs(const SurfaceMesh& mesh,
                                                        const EmbeddedLayout& embedding,
                                                        const FaceFrames& frames) {
    std::vector<std::pair<FaceHandle, double>> axes;
    for (int a = 0; a < embedding.layout.n_arcs(); ++a) {
        const auto& path = embedding.arcs[a];
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            HalfedgeHandle h = mesh.find_halfedge(path[i], path[i + 1]);
            for (const QuadLayout::ArcQuad& quad : embedding.layout.arc_quads(a)) {
                if (quad.quad >= 0) {
                    axes.emplace_back(mesh.face_handle(h), frames.angle(h) - quarter * quad.side);
                }
                h = mesh.opposite_halfedge_handle(h);
            }
        }
    }
    return axes;
}

}  // namespace

std::vector<double> chart_directions(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                                     const DirectionField& field) {
    const std::vector<int> turns = chart_turns(mesh, embedding);
    const DualTree tree = make_dual_tree(mesh);
    std::vector<double> angles = field.angles;
    std::vector<int> quarters(mesh.n_faces(), 0);
    for (const FaceHandle face : tree.order) {
        const HalfedgeHandle h = tree.crossed[face.idx()];
        if (!h.is_valid()) continue;
        const EdgeHandle edge = mesh.edge_handle(h);
        const int sign = mesh.halfedge_handle(edge, 0) == h ? 1 : -1;
        quarters[face.idx()] = quarters[mesh.face_handle(h).idx()] -
                               sign * (field.period_jumps[edge.idx()] + turns[edge.idx()]);
    }
    for (std::size_t f = 0; f < angles.size(); ++f) angles[f] += quarter * quarters[f];

    // Votes of the arcs' edges for the quarter turn of each component.
    const std::vector<int> component = face_components(mesh);
    std::vector<std::array<int, 4>> votes(angles.size(), {0, 0, 0, 0});
    for (const auto& [face, axis] : axes_at_arcs(mesh, embedding, FaceFrames(mesh))) {
        const auto n = std::lround((axis - angles[face.idx()]) / quarter);
        ++votes[component[face.idx()]][static_cast<std::size_t>((n % 4 + 4) % 4)];
    }
    for (std::size_t f = 0; f < angles.size(); ++f) {
        const auto& of_component = votes[component[f]];
        angles[f] += quarter * static_cast<double>(std::ranges::max_element(of_component) -
                                                   of_component.begin());
    }
    return angles;
}

LayoutField make_layout_field(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                              const LayoutFieldOptions& options) {
    const DualCycles cycles = make_dual_cycles(mesh);
    LayoutField result;
    result.topology = topology_of_layout(mesh, embedding, cycles);
    const Connection connection = trivial_connection(mesh, cycles, result.topology);
    result.report.topological_energy = sum_of_squares(connection);
    const DualTree tree = make_dual_tree(mesh, faces_at_arcs(mesh, embedding));
    result.field = integrate_connection(mesh, connection, 4, 0.0, tree);

    // Arcs first, whose quarter turns are known; then what is nearest to that field.
    auto offsets = offsets_of_arcs(mesh, embedding, connection, tree, 0.0);
    turn_to_arcs(mesh, result.field, offsets);
    std::vector<AngleTarget> targets;
    for (const ArcOffset& arc : offsets) {
        if (embedding.is_feature_arc[arc.arc] || embedding.layout.is_boundary_arc(arc.arc)) {
            targets.push_back({arc.face, arc.offset, exactly});
        }
    }
    result.field = align_field(mesh, std::move(result.field), targets);
    for (AngleTarget& target : targets) target.offset = 0.0;
    std::vector<char> is_held(mesh.n_faces(), 0);
    for (const AngleTarget& target : targets) is_held[target.face.idx()] = 1;
    const auto inside = feature_targets(mesh, result.field, feature_edges(mesh, embedding));
    for (const AngleTarget& target : inside) {
        if (is_held[target.face.idx()] == 0) targets.push_back(target);
    }
    const auto soft = principal_targets(mesh, result.field, options.principal_strength);
    targets.insert(targets.end(), soft.begin(), soft.end());
    result.field = align_field(mesh, std::move(result.field), targets);

    result.report.energy = sum_of_squares(field_curvature(mesh, result.field));
    for (const AngleTarget& edge :
         feature_targets(mesh, result.field, feature_edges(mesh, embedding))) {
        result.report.feature_angle = std::max(result.report.feature_angle, std::abs(edge.offset));
    }
    return result;
}

}  // namespace couture::meshing
