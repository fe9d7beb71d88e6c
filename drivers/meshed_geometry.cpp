#include "drivers/meshed_geometry.h"

#include "iga/core/error.h"
#include "iga/topology/jacobian_certificate.h"

namespace couture::drivers {

io::MeshDeck member_mesh_deck(const io::Deck& deck, const std::filesystem::path& like) {
    const std::string name = deck.geometry.mesh.filename().string();
    io::MeshDeck mesh = io::read_mesh_deck(deck.geometry.mesh);
    mesh.family.reset();
    mesh.stage = "volume";
    mesh.solid.node_tolerance = meshing::family_node_tolerance;
    if (!like.empty()) mesh.like = like;
    if (mesh.part.empty() && !deck.geometry.parameters.empty()) {
        throw InputError(
            "{}: [geometry.parameters] are of a part; {} names none, but the surface {}",
            deck.geometry.source, name, mesh.surface.string());
    }
    if (!deck.geometry.surface.empty()) {
        if (!mesh.part.empty()) {
            throw InputError("{}: 'surface' replaces that of {}, which has none, but the part {}",
                             deck.geometry.source, name, mesh.part);
        }
        mesh.surface = deck.geometry.surface;
    }
    for (const auto& [parameter, value] : deck.geometry.parameters) {
        mesh.parameters[parameter] = value;
    }
    if (mesh.units.name() != deck.units.name()) {
        throw InputError("{}: the deck's units are \"{}\", those of {} are \"{}\"; write the same",
                         deck.geometry.source, deck.units.name(), name, mesh.units.name());
    }
    return mesh;
}

MeshStages mesh_geometry(const io::Deck& deck, const std::filesystem::path& like) {
    const std::string name = deck.geometry.mesh.filename().string();
    MeshStages stages = run_mesh_stages(member_mesh_deck(deck, like), {});
    const auto& report = stages.solid->volume->report.parameterization;
    if (report.validity != iga::Validity::valid) {
        throw GeometryError("{}: the volume is {} in patch {}; try smaller elements or other cuts",
                            name, iga::to_string(report.validity), report.worst_patch);
    }
    return stages;
}

}  // namespace couture::drivers
