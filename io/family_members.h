#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/mesh_deck.h"

namespace couture::io {

struct FamilyMember {
    /// Also of its files: letters, digits, '_', '-' and '.'.
    std::string name;
    /// In the units of the deck; those left out are the deck's.
    std::map<std::string, double> parameters;
    /// If members are given as files: triangles, or a spline volume.
    std::filesystem::path surface;
    std::filesystem::path volume;
};

/// A table of members: a head line with the names of parameters, and `name`, `surface` or `volume`
/// with files beside it; a line for each member, cells parted by commas. Members without names are
/// called after their files, or member_1, ...
///
/// @throws FileError   if the file can't be read
/// @throws InputError  for what is wrong in it, with its line
[[nodiscard]] std::vector<FamilyMember> read_member_table(const std::filesystem::path& path);

/// The members that the section [family] of a deck lists, the reference first, the others in their
/// order.
///
/// Of a file: a head line with the names of parameters, and `name`, or `surface` with files beside
/// it; a line for each member, cells parted by commas. Without names they are member_1, ... With
/// no reference among them it is the deck's own [geometry], called reference.
///
/// Of the design star: that reference, and for each parameter of the part members at both ends of
/// its range (PARAMETER_low, _high), at level 2 also half way to them (_low_half, _high_half).
///
/// If the section names some members, only these and the reference.
///
/// @param deck  with a family
/// @throws FileError   if the file can't be read
/// @throws InputError  for what is wrong in it, with its line; for a reference or members that it
///                     does not list, and for a design of what is no part or lacks ranges
[[nodiscard]] std::vector<FamilyMember> family_members(const MeshDeck& deck);

}  // namespace couture::io
