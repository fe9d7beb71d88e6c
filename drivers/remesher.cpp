#include "drivers/remesher.h"

#include <memory>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "meshing/volume/optimize_volume.h"

namespace couture::drivers {

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
        const auto features = std::make_shared<const meshing::BoundaryFeatures>(geometry);
        remeshing.mesh = [features](const iga::MultiPatch<3>& deformed) {
            meshing::OptimizedVolume better = meshing::optimize_volume(deformed, *features);
            log::info(fmt::format("new mesh: {} rounds, boundary moved by {:.3g}, volume by {:.2e}",
                                  better.report.rounds, better.report.boundary_distance,
                                  better.report.volume_change));
            return std::move(better.volume);
        };
        return remeshing;
    }
}

template iga::Remeshing<2> make_remeshing(const io::Deck&, const iga::MultiPatch<2>&);
template iga::Remeshing<3> make_remeshing(const io::Deck&, const iga::MultiPatch<3>&);

}  // namespace couture::drivers
