#pragma once

#include <string>
#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::verification {

/// What is wrong with a surface besides being open at its outlets.
enum class ScanDefect {
    none,
    /// Every 20th triangle twice, half of them with points of their own, and every 7th turned over.
    duplicates,
    /// Triangles that stand on edges of two others and on single vertices; and the duplicates.
    non_manifold,
    /// Every 300th triangle is missing, and no two triangles share points.
    holes,
};

[[nodiscard]] std::string to_string(ScanDefect defect);

/// A cavity as medical scans show it.
struct SyntheticAneurysm {
    std::string name;
    int n_outlets = 0;
    ScanDefect defect = ScanDefect::none;
    /// mm.
    meshing::TriangleSoup surface;
    /// Where the outlets begin: places on the dome about their axes.
    std::vector<Vector3> outlets;
};

/// Number `number` of a population without end: a dome of three unequal radii of 3 to 7 mm, with a
/// smaller bleb on it, and 1 to 3 bent vessels, open at their ends; all about the origin, the first
/// vessel below. Numbers k and k + 12 have outlets and defect alike. The same on every machine.
///
/// @param cell  mm, side of the cubes that the surface is found in
/// @throws InputError  for a negative number
[[nodiscard]] SyntheticAneurysm make_synthetic_aneurysm(int number, double cell = 0.4);

}  // namespace couture::verification
