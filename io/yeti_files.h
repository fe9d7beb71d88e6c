#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/raw_splines.h"

namespace couture::io {

/// Reads a yeti model: nodes, elements and sets of the .inp, knots, degrees, spans and weights of
/// the .NB. Nodes and weights of an element are listed from its last function to its first. Node
/// sets become boundary sets: the outer sides all of whose nodes they hold, then edges, then
/// corners that hold nodes not yet covered; sets that hold all nodes of a patch, or other nodes
/// besides, are left out with a note. A pressure `*Dload` on face k of an element set (Uk.) makes
/// the set `<element set>_face<k>`. Loads, supports and materials are left out.
///
/// @param file, text  the .inp
/// @param nb_file, nb_text  the .NB
/// @throws FileError  with file and line
[[nodiscard]] RawSplines read_yeti(const std::string& file, std::string_view text,
                                   const std::string& nb_file, std::string_view nb_text);

/// Both texts of a yeti model.
struct YetiTexts {
    std::string inp;
    std::string nb;
};

/// Functions that meet at interfaces in exactly the same point share a node; boundary sets are node
/// sets.
///
/// @throws InputError  for surfaces in space, and for boundary sets that can't be told by their
///                     nodes
template <int d>
[[nodiscard]] YetiTexts to_yeti(const iga::MultiPatch<d>& multipatch);

}  // namespace couture::io
