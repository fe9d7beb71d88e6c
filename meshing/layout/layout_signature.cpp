#include "meshing/layout/layout_signature.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"
#include "iga/core/text_hash.h"

namespace couture::meshing {

std::vector<std::array<int, 3>> cuboid_sheets(const VolumetricLayout& layout) {
    // Directions of cuboids are joined over the arcs that they have.
    DisjointSets directions(static_cast<std::size_t>(3) * layout.n_cuboids());
    std::map<std::pair<int, int>, int> direction_of_arc;
    for (int c = 0; c < layout.n_cuboids(); ++c) {
        for (int i = 0; i < 8; ++i) {
            for (int k = 0; k < 3; ++k) {
                if ((i >> k & 1) == 1) continue;
                const std::pair<int, int> arc =
                    std::minmax({layout.cuboids[c][i], layout.cuboids[c][i | 1 << k]});
                directions.join(direction_of_arc.emplace(arc, 3 * c + k).first->second, 3 * c + k);
            }
        }
    }
    std::map<int, int> number;
    std::vector<std::array<int, 3>> sheets(layout.n_cuboids());
    for (int i = 0; i < 3 * layout.n_cuboids(); ++i) {
        const int next = static_cast<int>(number.size());
        sheets[i / 3][i % 3] = number.emplace(directions.find(i), next).first->second;
    }
    return sheets;
}

std::string layout_signature(const VolumetricLayout& layout, const std::vector<int>& n_cells) {
    std::size_t n_sheets = 0;
    for (const auto& sheets : cuboid_sheets(layout)) {
        for (const int sheet : sheets) n_sheets = std::max<std::size_t>(n_sheets, sheet + 1);
    }
    if (n_cells.size() != n_sheets) {
        throw InputError("layout_signature: elements of {} sheets; the layout has {}",
                         n_cells.size(), n_sheets);
    }
    for (std::size_t i = 0; i < n_sheets; ++i) {
        if (n_cells[i] < 1) {
            throw InputError("layout_signature: sheet {} has {} elements; it needs at least 1", i,
                             n_cells[i]);
        }
    }
    std::string text = fmt::format("nodes {} cells {}\n", layout.n_nodes, fmt::join(n_cells, " "));
    for (const auto& nodes : layout.cuboids) {
        fmt::format_to(std::back_inserter(text), "{}\n", fmt::join(nodes, " "));
    }
    for (const auto& [name, sides] : layout.sets) {
        fmt::format_to(std::back_inserter(text), "set {} of {}\n", name, sides.size());
        std::vector<CuboidSide> sorted = sides;
        std::ranges::sort(sorted);
        for (const CuboidSide& side : sorted) {
            fmt::format_to(std::back_inserter(text), "{} {}\n", side.cuboid, side.side);
        }
    }
    return text_hash(text);
}

}  // namespace couture::meshing
