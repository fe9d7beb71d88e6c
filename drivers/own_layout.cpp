#include "drivers/own_layout.h"

#include "iga/core/error.h"
#include "io/named_layout_file.h"
#include "io/template_file.h"
#include "io/volumetric_layout_file.h"
#include "meshing/layout/snap_nodes.h"
#include "meshing/topology/invariants.h"

namespace couture::drivers {

using namespace meshing;

TemplateLibrary template_library(const io::MeshDeck& deck) {
    TemplateLibrary library = io::built_in_templates();
    if (!deck.templates.empty()) io::add_templates(deck.templates, library);
    return library;
}

OwnLayout read_own_layout(const io::MeshDeck& deck, SurfaceMesh& mesh, const Features& features,
                          const Landmarks& landmarks) {
    const int n_boundaries = compute_invariants(mesh).n_boundaries;
    if (n_boundaries > 0) {
        throw InputError(
            "mesh: a layout of one's own ([meshing] layout, --layout) needs a closed surface, this "
            "one has {} boundary loops; leave out what opens caps, or fill the holes",
            n_boundaries);
    }
    if (deck.layout.extension() != ".toml") return {io::read_volumetric_layout(deck.layout)};
    const io::NamedLayout layout =
        io::read_named_layout(deck.layout, landmarks.corners, deck.units);
    constexpr double relative_tolerance = 0.01;
    const double tolerance =
        layout.tolerance.value_or(relative_tolerance * bounding_box_diagonal(mesh));
    return {snap_nodes(mesh, features, layout.placed, layout.placed.layout.node_names, tolerance),
            {.most_reach = tolerance, .divides_sheets = false}};
}

}  // namespace couture::drivers
