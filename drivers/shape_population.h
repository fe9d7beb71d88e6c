#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "iga/topology/multipatch.h"
#include "io/raw_surface.h"

namespace couture::drivers {

/// What all members of a population share: how their points hang together.
struct ShapeConnectivity {
    /// "quad mesh", "triangle mesh", "polygon mesh" or "volume".
    std::string kind;
    /// Of a volume that of iga::signature, else a hash of the polygons.
    std::string signature;
    int n_points = 0;
    /// A mesh; its points are those of the member that it was read from.
    io::RawSurface polygons;
    /// A volume, likewise; shared control points count once, by the numbers in `numbers`.
    std::optional<iga::MultiPatch<3>> volume;
    /// [patch][control point]
    std::vector<std::vector<int>> numbers;

    /// The mesh, or volume, with other points: n_points x 3.
    [[nodiscard]] io::RawSurface mesh_with(const MatrixX& points) const;
    [[nodiscard]] iga::MultiPatch<3> volume_with(const MatrixX& points) const;
};

struct ShapeMember {
    std::string name;
    std::filesystem::path file;
    /// n_points x 3.
    MatrixX points;
};

/// Members that can be compared point by point.
struct ShapePopulation {
    ShapeConnectivity connectivity;
    std::vector<ShapeMember> members;
    /// Of a family that which the others were made like.
    std::optional<int> reference;
};

/// Reads members and checks that they are isotopological.
///
/// @param inputs  surface files (polygons as they are; no STL, whose triangles share no points),
///                spline files of volumes, or one folder of a family's run (NAME_members.json and
///                MEMBER_volume.xml of those that are done), or its deck: then out/NAME
/// @throws FileError   for files and folders that can't be read
/// @throws InputError  for the first member whose connectivity, signature or weights differ from
///                     the first one's; for a file given twice; for surfaces of splines
[[nodiscard]] ShapePopulation read_shape_population(const std::vector<std::string>& inputs);

/// One more, to be compared with these. @throws  as read_shape_population
[[nodiscard]] ShapeMember read_shape_member(const ShapePopulation& population,
                                            const std::filesystem::path& file);

}  // namespace couture::drivers
