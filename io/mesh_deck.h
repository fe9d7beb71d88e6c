#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "iga/core/types.h"
#include "io/units.h"
#include "meshing/pipeline/solid_mesh.h"
#include "meshing/surface/features.h"
#include "meshing/topology/pants.h"

namespace couture::io {

/// Which plane faces of a surface are taken off.
struct CapSelection {
    /// All that a part declares as caps.
    bool all = false;
    /// Of faces of a part.
    std::vector<std::string> names;
    /// On or near a face.
    std::vector<Vector3> points;
    /// Outward normals: all plane faces with one boundary loop that face this way, to a degree.
    std::vector<Vector3> normals;

    [[nodiscard]] bool is_empty() const {
        return !all && names.empty() && points.empty() && normals.empty();
    }
};

/// A cut that passes points of the surface, given as they are or as corners of a part.
struct CycleThrough {
    std::vector<Vector3> points;
    std::vector<std::string> corners;
};

/// A family of solids that are meshed alike (see family_members).
struct FamilySection {
    /// A table of members, or empty: a design of the part's parameters.
    std::filesystem::path parameters;
    /// Of the design star: 1 both ends of each parameter's range, 2 also half way to them.
    int level = 1;
    /// Name of the member whose layout is chosen and repeated; empty: the deck's own geometry.
    std::string reference;
    /// Those that are meshed beside the reference; empty: all.
    std::vector<std::string> members;
};

/// One job of meshing: a surface file or a part, and what is done with it.
struct MeshDeck {
    /// Empty: none was read.
    std::filesystem::path path;
    std::string text;
    std::string title;
    UnitSystem units;

    /// A surface file, or a part; exactly one is set.
    std::filesystem::path surface;
    std::string part;
    std::map<std::string, double> parameters;
    /// Of a part's triangles; 0: its own.
    double edge_length = 0.0;

    /// As in drivers::SurfaceInputOptions.
    bool fix = false;
    bool fill_holes = false;
    std::optional<int> shell;

    /// The last stage that is made.
    std::string stage = "pants";
    meshing::FeatureOptions features;
    CapSelection open;
    /// But for cycles_through.
    meshing::PantsOptions pants;
    std::vector<CycleThrough> cycles_through;
    /// From the stage layout on; its last stage and progress are not read.
    meshing::SolidMeshOptions solid;
    /// Templates beside the built-in ones; empty: none.
    std::filesystem::path templates;
    /// A coarse mesh of cuboids that is placed on the surface instead of templates; empty: none.
    std::filesystem::path layout;
    /// Decisions of another member of the family, to be repeated; empty: none.
    std::filesystem::path like;
    /// Nothing: one solid.
    std::optional<FamilySection> family;
};

/// Whether a deck describes a surface to be meshed: it has a section [meshing], or 'surface' in
/// [geometry].
///
/// @throws FileError, InputError  if it can't be read
[[nodiscard]] bool is_mesh_deck(const std::filesystem::path& path);

/// Reads and checks a deck for meshing by itself (the surface is not opened).
///
/// @param overrides  "section.key=value", see override_value
/// @throws FileError   if it can't be read
/// @throws InputError  with all that is wrong, as read_deck
[[nodiscard]] MeshDeck read_mesh_deck(const std::filesystem::path& path,
                                      const std::vector<std::string>& overrides = {});

/// The same for a text at hand.
[[nodiscard]] MeshDeck parse_mesh_deck(const std::string& text, const std::filesystem::path& path,
                                       const std::vector<std::string>& overrides = {});

}  // namespace couture::io
