#pragma once

#include <vector>

#include "iga/topology/multipatch.h"
#include "rom/parameter_space.h"
#include "rom/tensor_design.h"

namespace couture::rom {

/// The full solutions that a reduced model learns from: for each geometry its control points, for
/// each geometry and each combination of loads and materials its displacement.
///
/// Fields are vectors of 3 n_nodes numbers, 3 node + component (`iga::flatten`); the nodes are the
/// n_nodes functions of iga::Space<3>(reference), whose geometry the members' is
/// (isoparametric). Members have the signature and the weights of the reference.
///
/// Source: [Maquart19] Sec. 7.2.2, Eq. (7.4).
struct SnapshotSet {
    /// All, in the deck's order and units.
    ParameterSpace parameters;
    /// For each parameter the power of it that displacements are proportional to: 0 none, 1 (the
    /// intensity of all loads), -1 (all moduli). Such parameters are factored: not sampled.
    std::vector<int> factor_power;
    /// Values of all parameters for the reference member: those at which factored ones were kept.
    VectorX reference_point;
    /// Refined for the solves.
    iga::MultiPatch<3> reference;
    /// n_geometries x sampled geometry parameters, in the unit cube; 1 x 0 without any.
    MatrixX geometry_points;
    /// Designs of the sampled load parameters, then of the sampled material parameters, in the
    /// unit cube; a group without any is left out.
    std::vector<MatrixX> mechanics_factors;
    /// 3 n_nodes x n_geometries; a column of NaN: a geometry that was refused.
    MatrixX control_points;
    /// 3 n_nodes x (n_geometries * n_mechanics), mechanics fastest, at the reference values of the
    /// factored parameters; a column of NaN: a solve that was refused, all of a refused geometry.
    MatrixX displacements;

    [[nodiscard]] int n_nodes() const { return static_cast<int>(control_points.rows()) / 3; }
    [[nodiscard]] int n_geometries() const { return static_cast<int>(geometry_points.rows()); }
    /// Combinations of loads and materials.
    [[nodiscard]] int n_mechanics() const { return TensorDesign{mechanics_factors}.n_points(); }
    /// Geometry, loads, materials; groups without parameters left out.
    [[nodiscard]] TensorDesign design() const;
};

/// Positions of the parameters of a group that are sampled: not factored.
[[nodiscard]] std::vector<int> sampled_parameters(const ParameterSpace& parameters,
                                                  const std::vector<int>& factor_power,
                                                  ParameterGroup group);

/// Positions of the columns that were not refused: those without NaN.
[[nodiscard]] std::vector<int> accepted_columns(const MatrixX& fields);

/// Checks sizes, powers (a geometry parameter has none, a reference value with one is not zero),
/// that points lie in the unit cube, that columns are finite or all NaN, that nothing was solved on
/// a refused geometry, and that a geometry and a solve are left.
///
/// @throws InputError  naming the first parameter, point or column that breaks a rule
void check(const SnapshotSet& snapshots);

}  // namespace couture::rom
