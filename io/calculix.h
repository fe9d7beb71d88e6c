#pragma once

#include <string>
#include <vector>

#include "iga/mechanics/problem.h"
#include "io/hex_mesh.h"

namespace couture::io {

/// A displacement or force of one node in one direction.
struct NodalValue {
    int node = 0;
    int component = 0;
    double value = 0.0;
};

/// A static run at finite strain from 0 to time 1, in which forces and prescribed displacements
/// grow linearly.
struct CalculixModel {
    HexMesh mesh;
    /// 20 nodes: with 2 x 2 x 2 points instead of 3 x 3 x 3.
    bool is_reduced = false;
    /// `StoredEnergy::neo_hookean`: C10 = mu / 2, D1 = 2 / kappa.
    iga::Hyperelastic material;
    std::vector<NodalValue> displacements;
    std::vector<NodalValue> forces;
    /// Of time; the first one where increments are automatic.
    double increment = 0.1;
    bool is_automatic = false;
};

/// The discrete problem of a space of degree 1 as `follow_loads` solves it: prescribed
/// displacements and dead loads as consistent nodal forces.
///
/// @throws InputError  for what the model can't say: other spaces and materials, several materials,
///                     slanted symmetry, foundations, pressures that follow the body
[[nodiscard]] CalculixModel make_calculix_model(const iga::SpacePtr<3>& space,
                                                const iga::Problem& problem);

/// Input of CalculiX (and Abaqus), for `write_text`. Results of the last increment are printed:
/// displacements and reactions of all nodes, coordinates and stresses of all integration points.
///
/// @throws InputError  for nodes that don't exist, or another stored energy
[[nodiscard]] std::string to_calculix(const CalculixModel& model, const std::string& title);

/// A mesh alone: nodes, elements, and boundary sets as sets of nodes; names in capitals, what is
/// no letter or digit as an underscore.
[[nodiscard]] std::string to_calculix(const HexMesh& mesh, const std::string& title);

}  // namespace couture::io
