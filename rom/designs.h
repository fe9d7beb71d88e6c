#pragma once

#include <cstdint>

#include "iga/core/types.h"

namespace couture::rom {

/// Designs of experiments in the unit cube: n_points x n_parameters matrices. The same arguments
/// give the same points on every machine.

/// The sparse grid populated along the axes only: the centre, then for each axis both its ends
/// (level 1: 2 d + 1 points), at level 2 also the points half way to them (4 d + 1), from low to
/// high.
///
/// @throws InputError  for a level that is neither 1 nor 2
///
/// Source: [Maquart19] Fig. 5.5.
[[nodiscard]] MatrixX star_design(int n_parameters, int level);

/// All combinations of n equidistant values on each axis, the last axis fastest.
///
/// @param n_per_axis  at least 1 (the middle)
[[nodiscard]] MatrixX full_design(int n_parameters, int n_per_axis);

/// Independent uniform points.
[[nodiscard]] MatrixX random_design(int n_parameters, int n_points, std::uint64_t seed);

/// Independent points of the standard normal distribution, which are not in the unit cube: uniform
/// ones by the transform of [BoxMuller58].
[[nodiscard]] MatrixX normal_design(int n_parameters, int n_points, std::uint64_t seed);

/// Points of the Sobol sequence, without the origin.
[[nodiscard]] MatrixX sobol_design(int n_parameters, int n_points);

/// A Latin hypercube (each of n equal parts of each axis holds one point, in its middle) whose
/// points are far apart: pairs of coordinates are exchanged while that lowers phi_15.
///
/// Source: [MorrisMitchell95] Eq. (2), p = 15.
[[nodiscard]] MatrixX latin_hypercube_design(int n_parameters, int n_points, std::uint64_t seed);

enum class NestedRule {
    /// 1, 3, 5, 9, ... equidistant points: contains the star.
    equidistant,
    clenshaw_curtis,
};

/// The sparse grid of nested rules: all points whose levels on the axes sum up to at most `level`.
/// The centre is first.
///
/// Source: [Smolyak63]; [GerstnerGriebel98] Sec. 3.
[[nodiscard]] MatrixX smolyak_design(int n_parameters, int level, NestedRule rule);

}  // namespace couture::rom
