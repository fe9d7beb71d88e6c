#pragma once

#include <optional>
#include <vector>

#include "iga/core/types.h"
#include "rom/procrustes.h"

namespace couture::rom {

/// How the shapes of a population vary: their mean and orthonormal modes around it (principal
/// component analysis).
struct ShapeModel {
    Alignment alignment = Alignment::rigid;
    /// n_points x 3, where the reference was given.
    MatrixX mean;
    /// 3 n_points x n_modes, orthonormal; coordinates point by point as in (1.15). As many as there
    /// are directions of variation, at most n_members - 1.
    MatrixX modes;
    /// Of the coefficients of the members, falling; n_modes.
    VectorX standard_deviations;
    /// n_modes x n_members, Eq. (1.19) with the mean taken off; each row sums to 0.
    MatrixX coefficients;
    /// That bring the members as they were given to where the model is.
    std::vector<Similarity> motions;
    int reference = 0;
    int n_iterations = 0;
    bool has_converged = true;
    /// Members whose mirror image would fit the mean much better.
    std::vector<int> mirrored_members;

    [[nodiscard]] int n_points() const { return static_cast<int>(mean.rows()); }
    [[nodiscard]] int n_modes() const { return static_cast<int>(modes.cols()); }
    [[nodiscard]] int n_members() const { return static_cast<int>(coefficients.cols()); }
};

/// @param shapes  points of isotopological meshes, or control points of splines: n_points x 3
///                each, of all members in the same order
/// @throws InputError  for fewer than 2 members, members that are all equal, and what
///                     align_population throws
///
/// Source: [Maquart19] Sec. 1.3.2, 5.2.1, Eq. (1.15)-(1.19). Differs: the mean is taken off first,
/// so that modes say how shapes vary; there the first one is "homogeneous to a shape".
[[nodiscard]] ShapeModel make_shape_model(const std::vector<MatrixX>& shapes,
                                          const AlignmentOptions& options = {});

/// A member and how far it is: root mean square over points.
struct NearMember {
    int member = -1;
    double distance = 0.0;
};

/// A shape in the basis of a model.
struct ShapeProjection {
    /// That brings the shape to the mean.
    Similarity motion;
    /// Eq. (1.20), the mean taken off; n_modes.
    VectorX coefficients;
    /// Coefficients over standard deviations.
    VectorX scores;
    /// mean + sum of modes times coefficients, where the model is: n_points x 3.
    MatrixX points;
    /// From the shape, which has been moved there: root mean square over points, and the largest.
    double distance = 0.0;
    double max_distance = 0.0;
    /// Of the shape from the mean.
    double distance_to_mean = 0.0;
    /// Up to three members whose coefficients are nearest to those of the shape.
    std::vector<NearMember> nearest;
};

/// @param points  n_points x 3
/// @param n_modes  the first ones, 1 to model.n_modes()
/// @throws InputError  for another number of points, coordinates that are not finite, another
/// number
///                     of modes
///
/// Source: [Maquart19] Eq. (1.20), Sec. 5.2.3.1.
[[nodiscard]] ShapeProjection project_shape(const ShapeModel& model, const MatrixX& points,
                                            int n_modes);

/// A member that there was not: mean + sum of modes times coefficients, n_points x 3.
///
/// @param coefficients  of the first modes
/// @throws InputError  if there are fewer modes or one is not finite
///
/// Source: [Maquart19] Eq. (1.18), Sec. 5.2.3.1.
[[nodiscard]] MatrixX virtual_member(const ShapeModel& model, const VectorX& coefficients);

/// One mode as displacements of the points: n_points x 3, of norm 1.
[[nodiscard]] MatrixX mode_shape(const ShapeModel& model, int i_mode);

}  // namespace couture::rom
