#include "drivers/distributed_job.h"

#include <fmt/format.h>

#include <algorithm>

#include "drivers/result_files.h"
#include "io/pvtu_writer.h"

namespace couture::drivers {

template <int d>
std::optional<iga::Location<d>> DistributedJob<d>::here(const iga::Location<d>& place) const {
    const std::array<int, d> element = geometry.find_element(place.patch, place.xi);
    const std::vector<iga::ElementBox<d>>& boxes = space.pieces.boxes;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        if (boxes[b].patch == place.patch && boxes[b].contains(element)) {
            return iga::Location<d>{static_cast<int>(b), place.xi};
        }
    }
    return {};
}

template <int d>
std::filesystem::path DistributedJob<d>::write_pieces(
    const std::string& stem, std::span<const io::PointArray> arrays) const {
    const auto piece_name = [&](int rank) {
        return fmt::format("{}_pieces/{}_{:04}.vtu", stem, stem, rank);
    };
    io::VtuOptions options;
    options.linear = deck.output.linear;
    options.provenance = provenance<d>(deck, geometry.geometry(), certificate);
    const auto& patches = geometry.geometry().patches;
    options.always_weights = std::any_of(patches.begin(), patches.end(),
                                         [](const auto& patch) { return patch.is_rational(); });
    for (const iga::ElementBox<d>& box : space.pieces.boxes) {
        options.patch_numbers.push_back(box.patch);
    }
    const std::filesystem::path path = folder / (stem + ".pvtu");
    ranks.together([&] {
        io::write_vtu<d>(folder / piece_name(ranks.rank()), *space.pieces.space, arrays, {},
                         options);
    });
    ranks.together([&] {
        if (ranks.rank() == 0) {
            std::vector<std::string> pieces;
            for (int r = 0; r < ranks.size(); ++r) {
                pieces.push_back(piece_name(r));
            }
            io::write_pvtu(path, pieces, arrays, options);
        }
    });
    return path;
}

template struct DistributedJob<2>;
template struct DistributedJob<3>;

}  // namespace couture::drivers
