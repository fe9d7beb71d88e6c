#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "drivers/deck_check.h"
#include "iga/distributed/distributed_space.h"
#include "iga/topology/locator.h"
#include "io/deck.h"
#include "io/vtk_writer.h"

namespace couture::drivers {

/// A checked deck whose elements are shared out to ranks.
template <int d>
struct DistributedJob {
    const iga::Communicator& ranks;
    const io::Deck& deck;
    std::filesystem::path folder;
    GeometryCertificate certificate;
    /// Of the probes, in the patches of the geometry.
    std::vector<std::optional<iga::Location<d>>> locations;
    iga::RefinedGeometry<d>& geometry;
    const iga::DistributedSpace<d>& space;
    iga::Problem on_pieces;

    /// A place on this rank's pieces; nothing if another rank has its element.
    [[nodiscard]] std::optional<iga::Location<d>> here(const iga::Location<d>& place) const;

    /// Writes fields of this rank's pieces as "STEM_pieces/STEM_NNNN.vtu", and what joins those of
    /// all ranks as "STEM.pvtu". Collective. @return the latter
    std::filesystem::path write_pieces(const std::string& stem,
                                       std::span<const io::PointArray> arrays) const;
};

}  // namespace couture::drivers
