#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/mesh_deck.h"
#include "io/picture.h"
#include "meshing/parts/part_surface.h"
#include "meshing/pipeline/solid_mesh.h"
#include "meshing/surface/features.h"
#include "meshing/surface/surface_mesh.h"
#include "meshing/topology/invariants.h"
#include "meshing/topology/pants_record.h"

namespace couture::drivers {

/// The stages of meshing, in order.
enum class MeshStage {
    surface,
    features,
    loops,
    pants,
    layout,
    field,
    map,
    quads,
    surfaces,
    volume,
    hexes
};

/// @throws InputError  for a name that is no stage: names the nearest and lists all
[[nodiscard]] MeshStage read_mesh_stage(const std::string& name);
[[nodiscard]] std::string to_string(MeshStage stage);

/// What the stages made of a surface.
struct MeshStages {
    /// If the deck names one.
    std::optional<meshing::PartSurface> part;
    meshing::SurfaceMesh mesh;
    meshing::SurfaceInvariants invariants;
    std::string surface_name;
    meshing::Features features;
    std::optional<meshing::PantsDecomposition> pants;
    /// What was decided, for other members of the family.
    std::optional<meshing::PantsRecord> record;
    /// From the stage layout on.
    std::optional<meshing::SolidMesh> solid;
};

/// Runs the stages of a deck up to the one that it names. Says what it does once a second.
///
/// @param problems_file  see make_checked_mesh
/// @throws what the stages throw
[[nodiscard]] MeshStages run_mesh_stages(const io::MeshDeck& deck,
                                         const std::filesystem::path& problems_file);
/// The same into `stages`, which hold what was made up to a stage that throws.
void run_mesh_stages(const io::MeshDeck& deck, const std::filesystem::path& problems_file,
                     MeshStages& stages);

/// The last stage that was made and can be drawn; nothing if there is no surface.
[[nodiscard]] std::optional<MeshStage> reached_stage(const MeshStages& stages);

/// Draws a stage; not the map.
///
/// @throws FileError  if it can't be written
void write_stage_picture(const std::filesystem::path& path, const MeshStages& stages,
                         MeshStage stage);

/// The picture of a stage that was run; of the field only if it was made.
[[nodiscard]] io::Scene stage_scene(const MeshStages& stages, MeshStage stage);

/// Writes what a stage shows as STEM.vtp, and with `png` as STEM.png.
///
/// surface: Gaussian curvature and its class, principal curvatures; features: curves and smooth
/// faces; loops: handle (kind 1) and tunnel loops (kind 4); pants: patches and all cuts (kind 0
/// boundary, 1 handle, 2 cycle). Later ones: see write_solid_stage.
///
/// @return the files
/// @throws FileError  if one can't be written
std::vector<std::filesystem::path> write_mesh_stage(const std::filesystem::path& stem,
                                                    const MeshStages& stages, MeshStage stage,
                                                    bool png, const std::string& provenance);

}  // namespace couture::drivers
