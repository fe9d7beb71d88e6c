#include "drivers/remesher.h"

#include "iga/core/error.h"

namespace couture::drivers {

namespace {

/// What meshes the deformed body again.
template <int d>
std::function<iga::MultiPatch<d>(const iga::MultiPatch<d>&)> make_mesher(
    const io::Deck& deck, const iga::MultiPatch<d>& /*geometry*/) {
    throw InputError("{}", io::located_in(deck, deck.remeshing->source, "",
                                          "remeshing is not available in this version; leave "
                                          "[remeshing] out"));
}

}  // namespace

template <int d>
iga::Remeshing<d> make_remeshing(const io::Deck& deck, const iga::MultiPatch<d>& geometry) {
    iga::Remeshing<d> remeshing;
    if (!deck.remeshing) {
        return remeshing;
    }
    const io::RemeshingOptions& options = *deck.remeshing;
    remeshing.mesh = make_mesher<d>(deck, geometry);
    remeshing.times = options.times;
    remeshing.shape_ratio = options.shape_ratio;
    remeshing.scaled_jacobian = options.scaled_jacobian;
    remeshing.angle_deviation = options.angle_deviation;
    remeshing.on_failure = options.on_failure;
    remeshing.max_remeshings = options.max_remeshings;
    return remeshing;
}

template iga::Remeshing<2> make_remeshing(const io::Deck&, const iga::MultiPatch<2>&);
template iga::Remeshing<3> make_remeshing(const io::Deck&, const iga::MultiPatch<3>&);

}  // namespace couture::drivers
