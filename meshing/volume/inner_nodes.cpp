#include "meshing/volume/inner_nodes.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <limits>

#include "meshing/volume/layout_nets.h"

namespace couture::meshing {

namespace {

/// Depth behind the boundary in parts of the shortest edge there.
constexpr double depth = 0.35;

// The other nodes in the middle of their neighbours.
MatrixX spread(const LayoutCells& cells, MatrixX nodes, const std::vector<bool>& is_given) {
    std::vector<int> number(nodes.rows(), -1);
    int n = 0;
    for (int i = 0; i < nodes.rows(); ++i) {
        if (!is_given[i]) number[i] = n++;
    }
    if (n == 0) return nodes;
    std::vector<Eigen::Triplet<double>> entries;
    MatrixX right = MatrixX::Zero(n, 3);
    const auto add = [&](int node, int other) {
        if (number[node] < 0) return;
        entries.emplace_back(number[node], number[node], 1.0);
        if (number[other] >= 0) {
            entries.emplace_back(number[node], number[other], -1.0);
        } else {
            right.row(number[node]) += nodes.row(other);
        }
    };
    for (const auto& [from, to] : cells.edges) {
        add(from, to);
        add(to, from);
    }
    SparseMatrix matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const MatrixX inner = Eigen::SimplicialLDLT<SparseMatrix>(matrix).solve(right);
    for (int i = 0; i < nodes.rows(); ++i) {
        if (number[i] >= 0) nodes.row(i) = inner.row(number[i]);
    }
    return nodes;
}

// Unit vectors into the body at the nodes of the boundary.
MatrixX inward_normals(const VolumetricLayout& layout, const LayoutCells& cells,
                       const MatrixX& nodes) {
    MatrixX normals = MatrixX::Zero(nodes.rows(), 3);
    for (const auto& face : cells.faces) {
        if (face.sides.size() != 1) continue;
        const auto corners = layout.nodes_of(face.sides[0]);
        for (int k = 0; k < 4; ++k) {
            const Vector3 x = nodes.row(corners[k]);
            const Vector3 after = nodes.row(corners[(k + 1) % 4]).transpose() - x;
            const Vector3 before = nodes.row(corners[(k + 3) % 4]).transpose() - x;
            normals.row(corners[k]) += before.cross(after).normalized().transpose();
        }
    }
    normals.rowwise().normalize();
    return normals;
}

// Nodes next to the boundary lie behind it, the others in the middle of their neighbours.
MatrixX offset(const VolumetricLayout& layout, const LayoutCells& cells, MatrixX nodes,
               const std::vector<bool>& is_given) {
    VectorX shortest = VectorX::Constant(nodes.rows(), std::numeric_limits<double>::infinity());
    for (const auto& [from, to] : cells.edges) {
        if (!is_given[from] || !is_given[to]) continue;
        const double length = (nodes.row(to) - nodes.row(from)).norm();
        shortest[from] = std::min(shortest[from], length);
        shortest[to] = std::min(shortest[to], length);
    }
    const MatrixX normals = inward_normals(layout, cells, nodes);
    MatrixX sum = MatrixX::Zero(nodes.rows(), 3);
    std::vector<int> count(nodes.rows(), 0);
    const auto add = [&](int node, int other) {
        if (is_given[node] || !is_given[other]) return;
        sum.row(node) += nodes.row(other) + depth * shortest[other] * normals.row(other);
        ++count[node];
    };
    for (const auto& [from, to] : cells.edges) {
        add(from, to);
        add(to, from);
    }
    std::vector<bool> is_placed = is_given;
    for (int i = 0; i < nodes.rows(); ++i) {
        if (count[i] == 0) continue;
        nodes.row(i) = sum.row(i) / count[i];
        is_placed[i] = true;
    }
    return spread(cells, std::move(nodes), is_placed);
}

}  // namespace

MatrixX place_inner_nodes(const VolumetricLayout& layout, const LayoutCells& cells,
                          const MatrixX& nodes, const std::vector<bool>& is_given,
                          const ParameterizationOptions& options) {
    MatrixX best = nodes;
    double best_jacobian = -std::numeric_limits<double>::infinity();
    for (const MatrixX& start :
         {spread(cells, nodes, is_given), offset(layout, cells, nodes, is_given)}) {
        LayoutNets straight;
        straight.knots.assign(cells.edges.size(), iga::KnotVector::uniform(1, 1));
        straight.nodes = start;
        const auto [volume, report] =
            parameterize_volume(make_multipatch(layout, cells, straight), options);
        // Cuboids that are bent by more than half a turn can't be straight: then what is unfolded
        // in vain is worse than the start.
        const bool is_unfolded = report.min_scaled_jacobian_after > 0.0;
        if (!is_unfolded && best_jacobian <= 0.0) best = start;
        if (report.min_scaled_jacobian_after <= best_jacobian) continue;
        best_jacobian = report.min_scaled_jacobian_after;
        if (!is_unfolded) continue;
        for (int c = 0; c < layout.n_cuboids(); ++c) {
            for (int i = 0; i < 8; ++i) {
                best.row(layout.cuboids[c][i]) = volume.patches[c].control_points().row(i);
            }
        }
    }
    return best;
}

}  // namespace couture::meshing
