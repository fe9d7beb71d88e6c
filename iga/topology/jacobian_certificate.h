#pragma once

#include <limits>
#include <string>
#include <vector>

#include "iga/topology/multipatch.h"

namespace couture::iga {

/// From the best to the worst.
enum class Validity {
    valid,       ///< det J has one sign everywhere (proven)
    degenerate,  ///< zero on collapsed sides, arcs or corners, one sign elsewhere (proven)
    undecided,   ///< neither was proven after the last subdivision
    folded       ///< det J changes sign (a point is shown)
};

/// What is known of det J of one patch. `orientation` is +1, or -1 for a left-handed patch;
/// minima are of orientation * det J.
template <int d>
struct PatchCertificate {
    Validity validity = Validity::undecided;
    int orientation = 1;
    /// Smallest Bernstein coefficient found: a lower bound of orientation * det J (of
    /// w^(d+1) det J for rational patches).
    double min_coefficient = 0.0;
    /// Smallest sampled orientation * det J and where.
    double min_jacobian = std::numeric_limits<double>::infinity();
    Vector<d> min_xi = Vector<d>::Zero();
    /// Elements (first direction fastest) that are undecided or folded.
    std::vector<int> unproven;
};

/// Proves the sign of det J of a patch whose dimension is d.
///
/// det J of a Bezier element has degree 3p - 1 per direction (2p - 1 in the plane): its Bernstein
/// coefficients come from products of the derivatives' coefficients. Rational patches:
/// w^(d+1) det J = det [X_xi; X_eta; X_zeta; X] of the homogeneous rows. All positive: valid; a
/// corner not positive: folded; else the element is halved, up to `max_depth` times.
template <int d>
[[nodiscard]] PatchCertificate<d> certify(const Patch<d>& patch, int max_depth = 4);

/// "valid", "left-handed", "folded", ...
[[nodiscard]] std::string to_string(Validity validity);

}  // namespace couture::iga
