#include "drivers/job_summary.h"

#include "iga/core/parallel.h"
#include "iga/core/text_hash.h"

namespace couture::drivers {

template <int d>
Summary describe_job(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                     const GeometryCertificate& certificate) {
    Summary summary;
    summary.deck = deck.path.string();
    summary.deck_hash = text_hash(deck.text);
    summary.title = deck.title;
    summary.units = deck.units.name();
    summary.signature = iga::signature(geometry);
    summary.certificate = certificate;
    summary.dimension = d;
    summary.n_patches = geometry.n_patches();
    summary.n_interfaces = static_cast<int>(geometry.interfaces.size());
    summary.n_control_points = geometry.n_control_points();
    summary.n_threads = n_threads();
    return summary;
}

template Summary describe_job(const io::Deck&, const iga::MultiPatch<2>&,
                              const GeometryCertificate&);
template Summary describe_job(const io::Deck&, const iga::MultiPatch<3>&,
                              const GeometryCertificate&);

}  // namespace couture::drivers
