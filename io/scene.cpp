#include "io/scene.h"

#include <algorithm>
#include <utility>

#include "iga/core/error.h"
#include "iga/spline/refine.h"
#include "io/sample_matrix.h"

namespace couture::io {

using iga::End;
using iga::PatchEntity;
using iga::Space;

namespace {

constexpr int samples_per_side = 32;
constexpr int fewest_samples = 2;
constexpr Color element_line_color{0.38, 0.41, 0.45};
constexpr double element_line_width = 1.0;

template <int d>
using Parameters = std::array<std::vector<double>, d>;

template <int d>
int samples_of(const Space<d>& space, int i_patch, int direction, const SceneOptions& options) {
    if (options.samples > 0) {
        return options.samples;
    }
    const int n_elements = space.tensor(i_patch).knots[direction].n_elements();
    return std::max(fewest_samples, (samples_per_side + n_elements - 1) / n_elements);
}

/// Parameters of the samples on an entity of a patch: one where it is fixed, those of all elements
/// where it is free.
template <int d>
Parameters<d> parameters_on(const Space<d>& space, const PatchEntity<d>& entity,
                            const SceneOptions& options) {
    Parameters<d> parameters;
    for (int k = 0; k < d; ++k) {
        const iga::KnotVector& knots = space.tensor(entity.patch).knots[k];
        if (entity.position[k] == End::free) {
            parameters[k] =
                sample_parameters(knots.breakpoints(), samples_of(space, entity.patch, k, options));
        } else {
            parameters[k] = {entity.position[k] == End::low ? knots.front() : knots.back()};
        }
    }
    return parameters;
}

/// A field at the grid of parameters, first direction fastest: points x components.
template <int d>
MatrixX sample_field(const Space<d>& space, int i_patch, const MatrixX& coefficients,
                     const Parameters<d>& parameters) {
    std::array<SparseMatrix, d> matrices;
    for (int k = 0; k < d; ++k) {
        matrices[k] = sample_matrix(space.tensor(i_patch).knots[k], parameters[k]);
    }
    const MatrixX rows = coefficients(space.dofs(i_patch), Eigen::all);
    const VectorX& weights = space.weights(i_patch);
    if (weights.size() == 0) {
        return iga::apply_kronecker<d>(matrices, rows);
    }
    const VectorX denominators = iga::apply_kronecker<d>(matrices, weights);
    return denominators.cwiseInverse().asDiagonal() *
           iga::apply_kronecker<d>(matrices, weights.asDiagonal() * rows);
}

/// Displaced points at the grid of parameters: points x 3.
template <int d>
MatrixX sample_points(const Space<d>& space, int i_patch, const SceneOptions& options,
                      const Parameters<d>& parameters) {
    const iga::Patch<d>& patch = space.geometry().patches[i_patch];
    std::array<SparseMatrix, d> matrices;
    for (int k = 0; k < d; ++k) {
        matrices[k] = sample_matrix(patch.knots(k), parameters[k]);
    }
    const MatrixX rows = iga::apply_kronecker<d>(matrices, patch.homogeneous());
    const int dimension = patch.dimension();
    MatrixX points = MatrixX::Zero(rows.rows(), 3);
    points.leftCols(dimension) =
        rows.col(dimension).cwiseInverse().asDiagonal() * rows.leftCols(dimension);
    if (options.displacement.size() > 0) {
        points.leftCols(dimension) +=
            options.displacement_scale *
            sample_field<d>(space, i_patch, options.displacement, parameters);
    }
    return points;
}

/// Two triangles for each cell of a grid of n_0 x n_1 points.
Eigen::MatrixXi grid_triangles(int n_0, int n_1) {
    Eigen::MatrixXi triangles(2 * (n_0 - 1) * (n_1 - 1), 3);
    int row = 0;
    for (int j = 0; j + 1 < n_1; ++j) {
        for (int i = 0; i + 1 < n_0; ++i) {
            const int corner = i + n_0 * j;
            triangles.row(row++) << corner, corner + 1, corner + n_0 + 1;
            triangles.row(row++) << corner, corner + n_0 + 1, corner + n_0;
        }
    }
    return triangles;
}

/// Entities with two free directions that are seen.
template <int d>
std::vector<PatchEntity<d>> visible_faces(const Space<d>& space) {
    if constexpr (d == 3) {
        return space.geometry().outer_sides();
    } else {
        std::vector<PatchEntity<d>> faces;
        for (int i = 0; i < space.n_patches(); ++i) {
            faces.push_back(iga::entities_of_patch<d>(i, d).front());
        }
        return faces;
    }
}

template <int d>
std::pair<int, int> free_directions(const PatchEntity<d>& face) {
    int first = 0;
    while (face.position[first] != End::free) {
        ++first;
    }
    int second = first + 1;
    while (face.position[second] != End::free) {
        ++second;
    }
    return {first, second};
}

template <int d>
SurfacePiece make_surface(const Space<d>& space, const PatchEntity<d>& face,
                          const SceneOptions& options) {
    const Parameters<d> parameters = parameters_on(space, face, options);
    const auto [first, second] = free_directions(face);
    SurfacePiece piece;
    piece.vertices = sample_points<d>(space, face.patch, options, parameters);
    piece.triangles = grid_triangles(static_cast<int>(parameters[first].size()),
                                     static_cast<int>(parameters[second].size()));
    if (options.values.size() > 0) {
        piece.values = sample_field<d>(space, face.patch, options.values, parameters);
    } else if (space.n_patches() > 1) {
        piece.color = part_color(face.patch);
    }
    return piece;
}

/// Lines on a face at the values of one of its directions: the ends, or the breakpoints between.
template <int d>
void append_lines(const Space<d>& space, const PatchEntity<d>& face, const SceneOptions& options,
                  std::vector<CurvePiece>& curves) {
    const auto [first, second] = free_directions(face);
    for (const int fixed : {first, second}) {
        const std::vector<double>& breakpoints =
            space.tensor(face.patch).knots[fixed].breakpoints();
        for (std::size_t i = 0; i < breakpoints.size(); ++i) {
            const bool is_end = i == 0 || i + 1 == breakpoints.size();
            if (!is_end && !options.element_lines) {
                continue;
            }
            Parameters<d> parameters = parameters_on(space, face, options);
            parameters[fixed] = {breakpoints[i]};
            CurvePiece curve;
            curve.points = sample_points<d>(space, face.patch, options, parameters);
            if (!is_end) {
                curve.color = element_line_color;
                curve.width = element_line_width;
            }
            curves.push_back(std::move(curve));
        }
    }
}

template <int d>
void check_input(const Space<d>& space, const SceneOptions& options) {
    const int n = space.n_dofs();
    const int dimension = space.geometry().dimension();
    const MatrixX& displacement = options.displacement;
    if (displacement.size() > 0 && (displacement.rows() != n || displacement.cols() != dimension)) {
        throw InputError("make_scene: the displacement is {} x {}; the space asks for {} x {}",
                         displacement.rows(), displacement.cols(), n, dimension);
    }
    if (options.values.size() > 0 && options.values.size() != n) {
        throw InputError("make_scene: {} values; the space has {} functions", options.values.size(),
                         n);
    }
    if (options.samples < 0) {
        throw InputError("make_scene: samples = {}; must be 0 (automatic) or more",
                         options.samples);
    }
}

}  // namespace

template <int d>
Scene make_scene(const Space<d>& space, const SceneOptions& options) {
    check_input(space, options);
    Scene scene;
    for (const PatchEntity<d>& face : visible_faces(space)) {
        scene.surfaces.push_back(make_surface(space, face, options));
        append_lines(space, face, options, scene.curves);
    }
    scene.legend = options.legend;
    scene.title = options.title;
    if (space.geometry().dimension() == 2) {
        scene.view_direction = -Vector3::UnitZ();
        scene.up = Vector3::UnitY();
    }
    return scene;
}

template Scene make_scene<2>(const Space<2>&, const SceneOptions&);
template Scene make_scene<3>(const Space<3>&, const SceneOptions&);

}  // namespace couture::io
