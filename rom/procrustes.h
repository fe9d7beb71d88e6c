#pragma once

#include <optional>
#include <vector>

#include "iga/core/types.h"

namespace couture::rom {

/// What may be done to a member before its shape is compared with others.
enum class Alignment {
    /// Nothing: place and size count as shape.
    none,
    /// Turned and moved, never mirrored.
    rigid,
    /// Also scaled.
    similarity,
};

/// x -> scale * rotation * x + translation.
struct Similarity {
    Matrix<3> rotation = Matrix<3>::Identity();
    double scale = 1.0;
    Vector3 translation = Vector3::Zero();

    /// @param points  n x 3
    [[nodiscard]] MatrixX apply(const MatrixX& points) const;
    /// First `other`, then this.
    [[nodiscard]] Similarity after(const Similarity& other) const;
    [[nodiscard]] Similarity inverse() const;
};

/// Root of the mean squared distance of points from those of the same number. n x 3 both.
[[nodiscard]] double rms_distance(const MatrixX& a, const MatrixX& b);

/// Root of the mean squared distance of points from their centroid.
[[nodiscard]] double shape_size(const MatrixX& points);

/// The rotation (no reflection) and translation that bring points nearest to a target in the sense
/// of squares, by the SVD of their covariance.
///
/// @param points, target  n x 3, point by point the same places
/// @param scale  that the points are given first; 1: their own size
///
/// Source: [Kabsch78]; [Schonemann66].
[[nodiscard]] Similarity fit_rigid(const MatrixX& points, const MatrixX& target,
                                   double scale = 1.0);

/// Whether a mirror image of the points would fit the target much better: with less than half the
/// distance.
[[nodiscard]] bool fits_mirrored(const MatrixX& points, const MatrixX& target);

struct AlignmentOptions {
    Alignment alignment = Alignment::rigid;
    /// Where the aligned population stands; nothing: where the member nearest to the mean does.
    std::optional<int> reference = std::nullopt;
    /// Done when the mean moves by less than this part of its size.
    double tolerance = 1e-14;
    int max_iterations = 1000;
};

/// A population in which members differ by shape only.
struct AlignedPopulation {
    /// n_points x 3 each.
    std::vector<MatrixX> shapes;
    MatrixX mean;
    /// That bring the members as they were given there; that of the reference is the identity.
    std::vector<Similarity> motions;
    int reference = 0;
    int n_iterations = 0;
    bool has_converged = true;
};

/// Generalised Procrustes alignment: members are fitted to their mean by rigid motions until it
/// stays. With `similarity` all are first given the same size, the mean of theirs.
///
/// @param shapes  n_points x 3 each, all alike
/// @throws InputError  for no members, members without points, of different numbers of points, with
///                     coordinates that are not finite, without extent where sizes are to be made
///                     equal; a reference that does not exist
///
/// Source: [Gower75]; [DrydenMardia16] Sec. 7.3-7.4; rigid motions out: [Maquart19] Sec. 5.1.2.
[[nodiscard]] AlignedPopulation align_population(const std::vector<MatrixX>& shapes,
                                                 const AlignmentOptions& options = {});

}  // namespace couture::rom
