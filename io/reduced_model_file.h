#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "rom/reduced_model.h"

namespace couture::io {

/// A reduced model with where it comes from.
struct ReducedModelFile {
    rom::ReducedModel model;
    /// Text of the deck that it was trained by: materials, supports and loads.
    std::string deck;
    /// Anything more, by name (the program's version is kept without being asked for).
    std::map<std::string, std::string> provenance;
};

/// Writes a reduced model. Layout, version 2 (n_values is 3 n_nodes, or 6 n_nodes if stacked):
///
///   block of 512 bytes   as that of spline files (io/hdf5_store.h), "Couture rom 2"
///   /record              bytes: JSON with parameters and their units, options, calibration,
///                        provenance, and the numbers of the parts
///   /deck                bytes
///   /reference           bytes of a Couture HDF5 spline file
///   /geometry, /displacement
///       gram             n_modes x n_modes
///   /models/<i>
///       mean             n_values x 1
///       modes            n_values x n_modes
///       singular_values  n x 1, all that were computed
///       coefficients     n_points x n_modes, at the points of the design
///       design/<g>       points of each factor, n_g x d_g, in the unit cube
///       lengths          n_modes x n_inputs, nuggets n_modes x 1, of kriging
///       leave_one_out    n_points x n_modes, residuals; for readers other than this program
///   /amplitude           if there is one: coefficients, design, lengths, nuggets, leave_one_out as
///   above
///
/// Equal models make equal files. The file appears whole or not at all.
///
/// @throws FileError  if it can't be written
void write_reduced_model(const std::filesystem::path& path, const ReducedModelFile& content);

/// @return a model that evaluates to the same bits as the one written
/// @throws FileError  if the file was cut or changed, is no reduced model, or of another version
[[nodiscard]] ReducedModelFile read_reduced_model(const std::filesystem::path& path);

}  // namespace couture::io
