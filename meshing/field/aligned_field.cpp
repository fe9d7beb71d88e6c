#include "meshing/field/aligned_field.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "iga/core/error.h"
#include "iga/linalg/sparse_solver.h"
#include "meshing/surface/curvature.h"

namespace couture::meshing {

namespace {

// What is asked of each face together.
struct FaceTargets {
    std::vector<char> is_held;
    // Mean of the held ones; for others the sum of weights times offsets.
    VectorX offset;
    VectorX weight;
};

FaceTargets gather(const SurfaceMesh& mesh, std::span<const AngleTarget> targets) {
    const auto n = static_cast<Eigen::Index>(mesh.n_faces());
    FaceTargets faces{std::vector<char>(mesh.n_faces(), 0), VectorX::Zero(n), VectorX::Zero(n)};
    std::vector<int> n_held(mesh.n_faces(), 0);
    for (const auto& [face, offset, weight] : targets) {
        if (!(weight >= 0.0)) {
            throw InputError("align_field: weight {} at face {}; it must not be negative", weight,
                             face.idx());
        }
        if (std::isinf(weight)) ++n_held[face.idx()];
    }
    for (const auto& [face, offset, weight] : targets) {
        const int f = face.idx();
        if (n_held[f] > 0 && !std::isinf(weight)) continue;
        const double part = n_held[f] > 0 ? 1.0 / n_held[f] : weight;
        faces.offset[f] += part * offset;
        faces.weight[f] += part;
        faces.is_held[f] = n_held[f] > 0 ? 1 : 0;
    }
    return faces;
}

// Faces that are held so that the matrix is regular: one in each component without targets.
void hold_components(const SurfaceMesh& mesh, FaceTargets& targets) {
    const std::vector<int> component = face_components(mesh);
    std::vector<char> has_target(component.size(), 0);
    for (std::size_t f = 0; f < component.size(); ++f) {
        if (targets.weight[static_cast<Eigen::Index>(f)] > 0.0) has_target[component[f]] = 1;
    }
    for (std::size_t f = 0; f < component.size(); ++f) {
        if (has_target[component[f]] != 0) continue;
        has_target[component[f]] = 1;
        targets.is_held[f] = 1;
    }
}

// Offsets that make sum (x_ij + d_j - d_i)^2 + sum weight (d - offset)^2 least.
VectorX least_offsets(const SurfaceMesh& mesh, const Connection& connection,
                      const FaceTargets& targets) {
    const auto n = static_cast<Eigen::Index>(mesh.n_faces());
    VectorX held = VectorX::Zero(n);
    VectorX b = VectorX::Zero(n);
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index f = 0; f < n; ++f) {
        if (targets.is_held[f] != 0) {
            held[f] = targets.offset[f];
        } else {
            b[f] = targets.offset[f];
            entries.emplace_back(f, f, targets.weight[f]);
        }
    }
    for (const EdgeHandle edge : mesh.edges()) {
        if (mesh.is_boundary(edge)) continue;
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        const int i = mesh.face_handle(h).idx();
        const int j = mesh.face_handle(mesh.opposite_halfedge_handle(h)).idx();
        const double x = connection(mesh, h) + held[j] - held[i];
        b[i] += x;
        b[j] -= x;
        entries.emplace_back(i, i, 1.0);
        entries.emplace_back(j, j, 1.0);
        entries.emplace_back(std::max(i, j), std::min(i, j), -1.0);
    }
    if (std::ranges::count(targets.is_held, 0) == 0) return held;
    SparseMatrix lower(n, n);
    lower.setFromTriplets(entries.begin(), entries.end());
    const iga::BlockMatrix matrix = iga::to_symmetric_blocks(lower);
    iga::SolverOptions cholesky;
    cholesky.name = "cholmod";
    const auto solver = iga::make_linear_solver(cholesky);
    solver->factorize({matrix, targets.is_held, {}});
    MatrixX offsets;
    static_cast<void>(solver->solve(b, offsets));
    return held + offsets;
}

// Their principal curvatures are those of one of their sides.
std::vector<bool> vertices_on_features(const SurfaceMesh& mesh) {
    std::vector<bool> is_on_feature(mesh.n_vertices(), false);
    for (const EdgeHandle edge : mesh.edges()) {
        if (mesh.data(edge).feature < 0) continue;
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        is_on_feature[mesh.from_vertex_handle(h).idx()] = true;
        is_on_feature[mesh.to_vertex_handle(h).idx()] = true;
    }
    return is_on_feature;
}

}  // namespace

DirectionField align_field(const SurfaceMesh& mesh, DirectionField field,
                           std::span<const AngleTarget> targets) {
    FaceTargets faces = gather(mesh, targets);
    hold_components(mesh, faces);
    const VectorX offsets = least_offsets(mesh, field_curvature(mesh, field), faces);
    for (std::size_t f = 0; f < field.angles.size(); ++f) {
        field.angles[f] += offsets[static_cast<Eigen::Index>(f)];
    }
    return field;
}

double nearest_offset(const DirectionField& field, FaceHandle face, double angle) {
    return std::remainder(angle - field.angles[face.idx()],
                          2.0 * std::numbers::pi / field.symmetry);
}

std::vector<AngleTarget> principal_targets(const SurfaceMesh& mesh, const DirectionField& field,
                                           double strength) {
    const FaceFrames frames(mesh);
    const auto curvatures = principal_curvatures(mesh);
    const std::vector<bool> is_sharp = vertices_on_features(mesh);
    std::vector<AngleTarget> targets;
    for (const FaceHandle face : mesh.faces()) {
        const Vector3 x = frames.direction(face, 0.0);
        const Vector3 y = frames.direction(face, 0.5 * std::numbers::pi);
        Matrix<2> tensor = Matrix<2>::Zero();
        int n_corners = 0;
        const auto add = [&](double curvature, const Vector3& direction) {
            const Vector2 d(direction.dot(x), direction.dot(y));
            tensor += curvature * d * d.transpose();
        };
        for (const VertexHandle v : mesh.fv_range(face)) {
            if (is_sharp[v.idx()]) continue;
            const PrincipalCurvatures& k = curvatures[v.idx()];
            ++n_corners;
            add(k.minimum, k.minimum_direction);
            add(k.maximum, k.maximum_direction);
        }
        if (n_corners == 0) continue;
        const Eigen::SelfAdjointEigenSolver<Matrix<2>> axes(tensor / n_corners);
        const double anisotropy = axes.eigenvalues()[1] - axes.eigenvalues()[0];
        if (!(anisotropy > 0.0)) continue;
        const Vector2 axis = axes.eigenvectors().col(1);
        targets.push_back({face, nearest_offset(field, face, std::atan2(axis.y(), axis.x())),
                           strength * face_area(mesh, face) * anisotropy * anisotropy});
    }
    return targets;
}

std::vector<AngleTarget> feature_targets(const SurfaceMesh& mesh, const DirectionField& field,
                                         const std::vector<bool>& is_feature) {
    const FaceFrames frames(mesh);
    std::vector<AngleTarget> targets;
    for (const HalfedgeHandle h : mesh.halfedges()) {
        const EdgeHandle edge = mesh.edge_handle(h);
        if (mesh.is_boundary(h) || !(is_feature[edge.idx()] || mesh.is_boundary(edge))) continue;
        const FaceHandle face = mesh.face_handle(h);
        targets.push_back({face, nearest_offset(field, face, frames.angle(h)),
                           std::numeric_limits<double>::infinity()});
    }
    return targets;
}

}  // namespace couture::meshing
