#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "iga/topology/space.h"

namespace couture::io {

/// Names of the arrays that `write_vtu` adds.
constexpr const char* vtu_patch_array = "patch";
constexpr const char* vtu_weights_array = "RationalWeights";
constexpr const char* vtu_degrees_array = "HigherOrderDegrees";

/// Values given by coefficients on a space's functions, or one row per point.
struct PointArray {
    std::string name;
    /// n_dofs x components (write_points_vtu: n_points x components). Vectors with 2 components
    /// are written with a third one that is 0.
    MatrixX coefficients;
    /// Names of the components ("11", "22", ...), or empty.
    std::vector<std::string> components;
};

/// Values that are constant on each patch.
struct CellArray {
    std::string name;
    /// n_patches.
    VectorX values;
};

struct VtuOptions {
    /// Plain linear cells through sampled points instead of exact spline cells.
    bool linear = false;
    /// Linear cells per element and direction, at least 1; only for `linear`.
    int samples = 2;
    /// What the cell array "patch" holds for each patch; empty: its number.
    std::vector<int> patch_numbers = {};
    /// Write weights even where all are one: for a file that is part of one with weights.
    bool always_weights = false;
    /// Where the result comes from; kept in the file as the field data string "provenance".
    std::string provenance;
};

/// Writes fields on a multipatch as VTK XML: one rational Bezier cell per element, exactly the
/// spline in position and in values (VTK >= 9.1 and ParaView >= 5.10 read them). Cells of one patch
/// share their points, those of different patches do not. Left-handed patches are written with
/// their first direction reversed, so that no cell is inside out. The cell array "patch" holds the
/// patch number. Where a space has a lower degree than its geometry, cells have the higher of both.
/// The file appears whole or not at all; missing folders are made.
///
/// @throws InputError  if an array has the wrong number of rows, or a name that is empty, taken or
///                     reserved; if exact cells are asked for fields that do not share the weights
///                     of a rational patch (a space that does not contain its functions)
/// @throws FileError   if the file can't be written
template <int d>
void write_vtu(const std::filesystem::path& path, const iga::Space<d>& space,
               std::span<const PointArray> points, std::span<const CellArray> cells = {},
               const VtuOptions& options = {});

/// Writes values at single points (Gauss points, probes) as a mesh of vertices, or of the linear
/// cells that join them.
///
/// @param positions  n_points x 2 or 3
/// @param cells  point numbers of quads (4 each) or hexahedra (8 each) in VTK's order; empty:
///               vertices
/// @throws InputError, FileError  as `write_vtu`
void write_points_vtu(const std::filesystem::path& path, const MatrixX& positions,
                      std::span<const PointArray> arrays, const std::string& provenance = {},
                      std::span<const std::vector<int>> cells = {});

}  // namespace couture::io
