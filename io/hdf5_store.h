#pragma once

#include <string>
#include <string_view>

#include "io/raw_splines.h"

namespace couture::io {

/// Reads a multipatch from the bytes of a Couture HDF5 file. Layout, version 1:
///
///   block of 512 bytes   text "Couture splines 1", the number of bytes that follow and their
///                        64-bit FNV-1a hash, then HDF5 (whose readers skip the block)
///   /                    attributes version, n_parameters, n_patches, signature, provenance
///   /patches/<i>         attribute degrees; knots_<k>; control_points (n x dimension);
///                        weights (n) for rational patches
///   /interfaces          n x (4 + 2 (d - 1)): first patch, first side, second patch, second side,
///                        axes, reversed
///   /boundary_sets/<i>   attribute name; n x (1 + d): patch, position (-1, 0, 1 per direction)
///
/// @throws FileError  if the hash does not fit (file cut or changed), something is missing, has
///                    another shape, or the signature is not that of what was read
[[nodiscard]] RawSplines read_hdf5(const std::string& file, std::string_view bytes);

/// The bytes of that file.
template <int d>
[[nodiscard]] std::string to_hdf5(const iga::MultiPatch<d>& multipatch);

}  // namespace couture::io
