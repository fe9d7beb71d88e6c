#pragma once

#include <optional>
#include <string>

#include "io/surface_reader.h"
#include "meshing/parts/part_surface.h"
#include "meshing/surface/fix_surface.h"
#include "meshing/surface/repair.h"
#include "meshing/topology/solid_check.h"

namespace couture::io {

/// A surface with all that was done to it and found.
struct DescribedSurface {
    /// As it was named.
    std::string name;
    /// What was read; its triangles are those before repair.
    SurfaceFile file;
    /// What was built, if it is a part; repair leaves its triangles as they are.
    std::optional<meshing::PartSurface> part;
    meshing::RepairReport repair;
    std::optional<meshing::FixReport> fix;
    /// Number of the shell that was taken alone, if it was the wall of a cavity: the body is what
    /// lies inside the cavity.
    std::optional<int> former_cavity;
    /// Shells turned outwards behind the repair.
    int n_shells_turned = 0;
    /// Repaired.
    meshing::TriangleSoup soup;
    meshing::SurfaceCheck check;
};

/// What `couture info FILE` prints of a surface: format, points, edges, triangles, Euler
/// characteristic; whether it is closed; components with genus and boundaries; area, volume (of
/// closed surfaces), bounding box, edges, smallest angle; sharp edges at 40 degrees, feature
/// curves, corners and smooth faces; of a solid cavities and Betti numbers; of a part its corners
/// by name, with positions; what reading, repair and fixing changed; problems with places.
/// Components, features and the like are left out where the surface is no oriented manifold.
[[nodiscard]] std::string surface_info_text(const DescribedSurface& surface);

/// The same for machines: one JSON object, indented by two. What is unknown is null.
[[nodiscard]] std::string surface_info_json(const DescribedSurface& surface);

/// That the inside of a cavity was taken for a body, with its number.
[[nodiscard]] std::string describe_former_cavity(const DescribedSurface& surface);

/// What reading, repair and fixing changed, one line each; empty if nothing was.
[[nodiscard]] std::vector<std::string> describe_changes(const DescribedSurface& surface);

}  // namespace couture::io
