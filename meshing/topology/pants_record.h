#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "meshing/topology/pants.h"

namespace couture::meshing {

/// Named points of a part that mean the same on every member of its family: corners, and points
/// along its feature curves.
struct Landmarks {
    std::map<std::string, Vector3> corners;
    /// Equally many points on each curve, evenly spaced.
    std::map<std::string, std::vector<Vector3>> curves;
    /// Names of those among them that are closed: they may start anywhere.
    std::set<std::string> closed_curves;
};

/// What was decided on one member of a family, to be repeated on the others, whatever their meshes.
struct PantsRecord {
    Vector3 box_min = Vector3::Zero();
    Vector3 box_max = Vector3::Zero();
    Landmarks landmarks;
    /// One component of the surface: the outside of a solid or a wall of a cavity.
    struct Shell {
        int genus = 0;
        /// Of its box.
        Vector3 center = Vector3::Zero();
    };
    std::vector<Shell> shells;
    struct Curve {
        PantsCurveKind kind = PantsCurveKind::cycle;
        /// Of boundary loops: the cap's, or empty.
        std::string name;
        /// Its vertices, with the normals of the surface.
        GuideLoop shape;
    };
    /// As in PantsDecomposition.
    std::vector<Curve> curves;
    std::vector<std::vector<CurveSide>> patches;
    /// For each patch.
    std::vector<int> shell_of_patch;
};

[[nodiscard]] PantsRecord record_pants(const SurfaceMesh& mesh, const PantsDecomposition& pants,
                                       const Landmarks& landmarks);

/// Cuts another member of the family as the first one was: the same curves in the same order and
/// direction around the same patches, from corresponding places on. The shape of each curve is
/// carried over by the boxes and by what the two members' landmarks have in common, and then pulled
/// tight; boundary loops are told by their names, or else by where they lie, shells by genus and
/// where they lie.
///
/// @param boundary_names  as PantsOptions::boundary_names
/// @param width           as PantsOptions::loop_width
/// @throws TopologyError  if the surface has other shells or other boundary loops, or if a curve
///                        can't be followed or ends up in another way around: says which
[[nodiscard]] PantsDecomposition replay_pants(SurfaceMesh& mesh, const PantsRecord& record,
                                              const std::vector<std::string>& boundary_names,
                                              const Landmarks& landmarks, double width = 0.05);

}  // namespace couture::meshing
