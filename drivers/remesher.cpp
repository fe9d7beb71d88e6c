#include "drivers/remesher.h"

#include <memory>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "meshing/pipeline/remesh_solid.h"
#include "meshing/volume/optimize_volume.h"

namespace couture::drivers {

namespace {

using meshing::BoundaryFeatures;

iga::MultiPatch<3> slide(const iga::MultiPatch<3>& deformed, const BoundaryFeatures& features) {
    meshing::OptimizedVolume better = meshing::optimize_volume(deformed, features);
    log::info(fmt::format("new mesh: {} rounds, boundary moved by {:.3g}, volume by {:.2e}",
                          better.report.rounds, better.report.boundary_distance,
                          better.report.volume_change));
    return std::move(better.volume);
}

iga::MultiPatch<3> from_surface(const iga::MultiPatch<3>& deformed,
                                const BoundaryFeatures& features) {
    meshing::RemeshedSolid again = meshing::remesh_solid(deformed, features);
    log::info(
        fmt::format("new mesh: from {} triangles, nodes moved by up to {:.3g}, then {} rounds; "
                    "boundary moved by "
                    "{:.2e}, sharp edges by {:.2e} of the diagonal, volume by {:.2e}",
                    again.n_triangles, again.relocation.largest_move, again.optimization.rounds,
                    again.distance.surface, again.distance.features, again.volume_change));
    return std::move(again.volume);
}

// Says at the start what would fail at each remeshing.
void check_surface_mesher(const io::Deck& deck, const iga::MultiPatch<3>& geometry,
                          const BoundaryFeatures& features) {
    try {
        meshing::check_remeshable(geometry, features);
    } catch (const Error& error) {
        throw InputError("{}", io::located_in(deck, deck.remeshing->source, "mesher",
                                              fmt::format("mesher = \"surface\": {}; or take "
                                                          "mesher = \"slide\"",
                                                          error.what())));
    }
}

}  // namespace

template <int d>
iga::Remeshing<d> make_remeshing(const io::Deck& deck, const iga::MultiPatch<d>& geometry) {
    if (!deck.remeshing) {
        return {};
    }
    if constexpr (d == 2) {
        throw InputError("{}", io::located_in(deck, deck.remeshing->source, "",
                                              "[remeshing] needs a volume, the geometry is plane; "
                                              "leave it out"));
    } else {
        const io::RemeshingOptions& asked = *deck.remeshing;
        iga::Remeshing<3> remeshing;
        remeshing.times = asked.times;
        remeshing.shape_ratio = asked.shape_ratio;
        remeshing.scaled_jacobian = asked.scaled_jacobian;
        remeshing.angle_deviation = asked.angle_deviation;
        remeshing.on_failure = asked.on_failure;
        remeshing.transfer = asked.transfer;
        remeshing.max_remeshings = asked.max_remeshings;
        const auto features = std::make_shared<const BoundaryFeatures>(geometry);
        if (asked.mesher == io::Mesher::surface) check_surface_mesher(deck, geometry, *features);
        const auto mesher = asked.mesher == io::Mesher::surface ? from_surface : slide;
        remeshing.mesh = [features, mesher](const iga::MultiPatch<3>& deformed) {
            return mesher(deformed, *features);
        };
        return remeshing;
    }
}

template iga::Remeshing<2> make_remeshing(const io::Deck&, const iga::MultiPatch<2>&);
template iga::Remeshing<3> make_remeshing(const io::Deck&, const iga::MultiPatch<3>&);

}  // namespace couture::drivers
