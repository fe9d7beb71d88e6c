#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/mesh_deck.h"
#include "io/surface_info.h"
#include "meshing/layout/layout_record.h"
#include "meshing/parts/part_surface.h"
#include "meshing/pipeline/outer_side_names.h"
#include "meshing/surface/caps.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::drivers {

/// The surface of a job of meshing, oriented, with its caps taken off.
struct PreparedSurface {
    meshing::SurfaceMesh mesh;
    /// What the deck names, if it is a part.
    std::optional<meshing::PartSurface> part;
    /// The closed surface, if it was closed: that of the part or file with its smooth faces.
    std::optional<meshing::NamedFaces> faces;
    /// Of each vertex of the mesh the number on the closed surface; empty if nothing was opened.
    std::vector<int> closed_vertices;
    /// Of its boundary loops (meshing::boundary_loops): the cap's, or empty.
    std::vector<std::string> boundary_names;
    /// Of the surface's own; none if it was open from the start.
    std::optional<meshing::ClosingCaps> caps;
    /// Of parts; files have none.
    meshing::Landmarks landmarks;
    /// The deck's `like`.
    std::optional<meshing::MemberRecord> record;
};

/// Reads or builds the surface that a deck names, and checks it.
///
/// @throws what load_surface throws; InputError  for a part that is to be repaired
[[nodiscard]] io::DescribedSurface read_surface(const io::MeshDeck& deck);

/// That surface, opened: it opens the caps that it asks for; if it asks
/// for none and is to be cut like another member, those of a part that were open there.
///
/// @param problems_file  see make_checked_mesh
/// @throws what read_surface, read_member_record, make_checked_mesh and open_caps throw; InputError
/// for names of caps
///         that the part does not have
[[nodiscard]] PreparedSurface prepare_surface(const io::MeshDeck& deck,
                                              const std::filesystem::path& problems_file);

/// Features of the prepared surface; those of a part have its names.
[[nodiscard]] meshing::Features find_features(const io::MeshDeck& deck, PreparedSurface& surface);

/// Options of the decomposition, with the corners that its cycles pass.
///
/// @throws InputError  for a corner that the part does not have: the nearest, and all
[[nodiscard]] meshing::PantsOptions pants_options(const io::MeshDeck& deck,
                                                  const PreparedSurface& surface);

}  // namespace couture::drivers
