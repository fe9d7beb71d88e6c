#include "meshing/field/layout_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

}  // namespace

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
