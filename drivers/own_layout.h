#pragma once

#include "drivers/prepared_surface.h"
#include "io/mesh_deck.h"
#include "meshing/layout/cuboid_template.h"
#include "meshing/layout/place_layout.h"
#include "meshing/layout/volumetric_layout.h"

namespace couture::drivers {

/// The built-in templates, and those of the file that a deck names.
///
/// @throws as io::add_templates
[[nodiscard]] meshing::TemplateLibrary template_library(const io::MeshDeck& deck);

/// A coarse mesh of cuboids that a deck names.
struct OwnLayout {
    /// Of one that is written by hand the nodes of the boundary lie on the surface, at features
    /// where these are near.
    meshing::PlacedLayout placed;
    /// One that is written by hand keeps the cuboids that it has.
    meshing::PlaceLayoutOptions options = {};
};

/// @param mesh       gets vertices where nodes come to feature curves (meshing::snap_nodes)
/// @param landmarks  the corners of a part that nodes may lie at
/// @throws InputError  if the surface is open, and as io::read_named_layout and meshing::snap_nodes
/// @throws FileError   as io::read_volumetric_layout
[[nodiscard]] OwnLayout read_own_layout(const io::MeshDeck& deck, meshing::SurfaceMesh& mesh,
                                        const meshing::Features& features,
                                        const meshing::Landmarks& landmarks);

}  // namespace couture::drivers
