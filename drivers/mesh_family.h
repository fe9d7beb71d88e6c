#pragma once

#include "drivers/commands/commands.h"
#include "io/mesh_deck.h"

namespace couture::drivers {

/// Meshes the members of a deck's family: chooses cuts and layout on the reference, repeats them on
/// the others. Writes FOLDER/MEMBER_volume.xml for each, FOLDER/REFERENCE_layout.json,
/// FOLDER/NAME_members.json with what became of the members so far, and with `png`
/// FOLDER/NAME_family.png with a small picture of each; prints a table or JSON
/// (mesh_family_schema.md).
///
/// A member fails if its features don't match the reference's, if its volume folds or has another
/// signature, or if its named features don't lie where the reference has them: it is reported, a
/// picture of the stage that it reached written as MEMBER_failed_STAGE.png, no volume, and the
/// others go on. With `resume` members that an earlier run has done are taken from their files.
/// Half way between neighbours in the list, and between each and the reference, det J is certified.
///
/// @param deck  with a family
/// @return the exit code: 1 if a member or a midpoint failed
/// @throws what family_members and read_family_progress throw, and what stops the reference
///
/// Source: [Maquart19] Sec. 5.1, 6.3.4.
int mesh_family(const io::MeshDeck& deck, const MeshOptions& options, const CommonOptions& common);

}  // namespace couture::drivers
