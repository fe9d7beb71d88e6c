#include "drivers/remesher.h"

#include "iga/core/error.h"

namespace couture::drivers {

template <int d>
iga::Remeshing<d> make_remeshing(const io::Deck& deck, const iga::MultiPatch<d>& /*geometry*/) {
    if (!deck.remeshing) {
        return {};
    }
    throw InputError("{}", io::located_in(deck, deck.remeshing->source, "",
                                          "remeshing is not available in this version; leave "
                                          "[remeshing] out"));
}

template iga::Remeshing<2> make_remeshing(const io::Deck&, const iga::MultiPatch<2>&);
template iga::Remeshing<3> make_remeshing(const io::Deck&, const iga::MultiPatch<3>&);

}  // namespace couture::drivers
