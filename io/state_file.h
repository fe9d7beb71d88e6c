#pragma once

#include <filesystem>
#include <string>

#include "iga/solve/load_stepping.h"

namespace couture::io {

/// What the states of one run have in common and those of another deck do not.
struct StateOrigin {
    /// Name of the deck, for messages.
    std::string deck;
    /// Hash of Deck::model_text.
    std::string model_hash;
    /// Of the undeformed geometry.
    std::string signature;
    /// Name and hash of the geometry's file; empty for built-in parts.
    std::string geometry_file;
    std::string geometry_hash;
};

/// Writes an accepted step, so that a run can go on from it as if it had not stopped. Layout,
/// version 1:
///
///   block of 512 bytes   as that of spline files (io/hdf5_store.h), "Couture state 1"
///   /record              bytes: JSON with all numbers and texts, every digit kept
///   /displacement        n_dofs x d
///   /direction           as it is; 0 x 0 without one
///   /reference           only after a remeshing: geometry (bytes of a Couture HDF5 spline file),
///                        displacement (n_dofs x d), gradient (n_dofs x 9)
///
/// The file appears whole or not at all.
///
/// @throws FileError  if it can't be written
template <int d>
void write_state(const std::filesystem::path& path, const iga::AcceptedStep<d>& step,
                 const StateOrigin& origin);

/// @param undeformed  reference of states that no remeshing went before
/// @throws FileError   if the file was cut or changed, or is no state
/// @throws InputError  if it is of another model, geometry file or signature than `origin`: names
///                     both
template <int d>
[[nodiscard]] iga::AcceptedStep<d> read_state(const std::filesystem::path& path,
                                              const iga::ReferencePtr<d>& undeformed,
                                              const StateOrigin& origin);

}  // namespace couture::io
