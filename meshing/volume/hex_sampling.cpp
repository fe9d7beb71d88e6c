#include "meshing/volume/hex_sampling.h"

#include <Eigen/SparseCholesky>

#include "iga/core/error.h"
#include "iga/topology/dof_map.h"
#include "meshing/volume/coons.h"
#include "meshing/volume/volume_points.h"

namespace couture::meshing {

using iga::MultiPatch;

namespace {

/// Only the certificate.
constexpr ParameterizationOptions no_moves{.max_rounds = 0, .max_untangling_rounds = 0};
/// Sides of grids meet within this part of the size.
constexpr double border_tolerance = 1e-9;

iga::TensorSpace<3> grid_space(const std::array<int, 3>& n) {
    return {{iga::KnotVector::uniform(1, n[0] - 1), iga::KnotVector::uniform(1, n[1] - 1),
             iga::KnotVector::uniform(1, n[2] - 1)}};
}

// As it is if certified, else with inner points moved.
SampledHexahedra mended(MultiPatch<3> hexahedra) {
    const auto here = parameterize_volume(hexahedra, no_moves);
    if (here.report.validity <= iga::Validity::degenerate) {
        return {std::move(hexahedra), here.report, false};
    }
    auto better = parameterize_volume(hexahedra);
    return {std::move(better.volume), better.report, true};
}

iga::Volume sampled(const iga::Volume& patch, std::optional<int> n_points) {
    std::array<int, 3> n{};
    for (int k = 0; k < 3; ++k) n[k] = n_points.value_or(patch.knots(k).n_basis());
    const iga::TensorSpace<3> space = grid_space(n);
    MatrixX points(space.n_basis(), 3);
    for (int i = 0; i < space.n_basis(); ++i) {
        const std::array<int, 3> at = space.indices(i);
        Vector3 xi;
        for (int k = 0; k < 3; ++k) {
            const double first = patch.knots(k).front();
            const double last = patch.knots(k).back();
            // Both ends exactly.
            xi[k] = at[k] + 1 == n[k] ? last : first + (last - first) * at[k] / (n[k] - 1);
        }
        points.row(i) = patch.point(xi).transpose();
    }
    return {space, std::move(points)};
}

// Inner points of one patch in the middle of their six neighbours.
iga::Volume smoothed(const iga::Volume& patch) {
    const iga::TensorSpace<3>& space = patch.space();
    const std::array<int, 3> n = space.sizes();
    const auto is_inner = [&](const std::array<int, 3>& at) {
        for (int k = 0; k < 3; ++k) {
            if (at[k] == 0 || at[k] + 1 == n[k]) return false;
        }
        return true;
    };
    std::vector<int> number(space.n_basis(), -1);
    int n_inner = 0;
    for (int i = 0; i < space.n_basis(); ++i) {
        if (is_inner(space.indices(i))) number[i] = n_inner++;
    }
    if (n_inner == 0) return patch;
    MatrixX points = patch.control_points();
    MatrixX right = MatrixX::Zero(n_inner, 3);
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < space.n_basis(); ++i) {
        if (number[i] < 0) continue;
        entries.emplace_back(number[i], number[i], 6.0);
        for (int side = 0; side < 6; ++side) {
            auto at = space.indices(i);
            at[side / 2] += side % 2 == 0 ? -1 : 1;
            const int other = space.index(at);
            if (number[other] >= 0) {
                entries.emplace_back(number[i], number[other], -1.0);
            } else {
                right.row(number[i]) += points.row(other);
            }
        }
    }
    SparseMatrix matrix(n_inner, n_inner);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const MatrixX inner = Eigen::SimplicialLDLT<SparseMatrix>(matrix).solve(right);
    for (int i = 0; i < space.n_basis(); ++i) {
        if (number[i] >= 0) points.row(i) = inner.row(number[i]);
    }
    return {space, std::move(points)};
}

}  // namespace

SampledHexahedra sample_hexahedra(const MultiPatch<3>& volume, std::optional<int> n_points) {
    if (n_points && *n_points < 2) {
        throw InputError("sample_hexahedra: {} points per direction; there must be 2 or more",
                         *n_points);
    }
    MultiPatch<3> hexahedra{{}, volume.interfaces, volume.boundary_sets};
    std::vector<iga::TensorSpace<3>> spaces;
    for (const auto& patch : volume.patches) {
        hexahedra.patches.push_back(sampled(patch, n_points));
        spaces.push_back(hexahedra.patches.back().space());
    }
    const iga::DofMap dofs = iga::make_dof_map<3>(hexahedra, spaces);
    return mended(with_points(hexahedra, dofs, points_of(hexahedra, dofs)));
}

SampledHexahedra hexahedra_between(const std::array<MatrixX, 6>& sides,
                                   const std::array<int, 3>& n) {
    for (int k = 0; k < 3; ++k) {
        if (n[k] < 2) {
            throw InputError(
                "hexahedra_between: {} points in direction {}; there must be 2 or more", n[k], k);
        }
    }
    const iga::TensorSpace<3> space = grid_space(n);
    MatrixX net = MatrixX::Constant(space.n_basis(), 3, std::nan(""));
    double size = 0.0;
    for (int side = 0; side < 6; ++side) {
        const auto functions = iga::functions_on<3>(space, iga::make_side<3>(0, side).position);
        if (sides[side].rows() != 3 || sides[side].cols() != static_cast<long>(functions.size()) ||
            !sides[side].allFinite()) {
            throw InputError("hexahedra_between: side {} has {} points; there must be {}, finite",
                             side, sides[side].cols(), functions.size());
        }
        size = std::max(
            size, (sides[side].rowwise().maxCoeff() - sides[side].rowwise().minCoeff()).norm());
        for (std::size_t i = 0; i < functions.size(); ++i) {
            const auto point = sides[side].col(static_cast<long>(i)).transpose();
            auto row = net.row(functions[i]);
            if (!row.hasNaN()) {
                if ((row - point).norm() > border_tolerance * size) {
                    throw InputError(
                        "hexahedra_between: side {} is {:.3g} away from another one on a common "
                        "edge; sides must meet",
                        side, (row - point).norm());
                }
                continue;
            }
            row = point;
        }
    }
    MultiPatch<3> coons;
    coons.patches.push_back(iga::Volume(space, fill_coons<3>(space, std::move(net))));
    MultiPatch<3> laplace;
    laplace.patches.push_back(smoothed(coons.patches[0]));
    const auto report = parameterize_volume(laplace, no_moves).report;
    if (report.validity == iga::Validity::valid) return {std::move(laplace), report, false};
    return mended(std::move(coons));
}

}  // namespace couture::meshing
