#include "meshing/parameterization/sheet_sizes.h"

#include <algorithm>
#include <cmath>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

// The smallest length such that no less than half of the total lies in lengths up to it.
double weighted_median(std::vector<double> lengths) {
    std::sort(lengths.begin(), lengths.end());
    double total = 0.0;
    for (const double length : lengths) total += length;
    double sum = 0.0;
    for (const double length : lengths) {
        sum += length;
        if (2.0 * sum >= total) return length;
    }
    return lengths.back();
}

}  // namespace

std::vector<double> arc_lengths(const SurfaceMesh& mesh, const EmbeddedLayout& embedding) {
    std::vector<double> lengths;
    for (const auto& path : embedding.arcs) {
        double length = 0.0;
        for (std::size_t i = 1; i < path.size(); ++i) {
            length += (mesh.point(path[i]) - mesh.point(path[i - 1])).norm();
        }
        lengths.push_back(length);
    }
    return lengths;
}

std::vector<int> sheet_sizes(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                             const SheetSizeOptions& options) {
    if (!(options.target_size >= 0.0) || options.min_cells < 1) {
        throw InputError(
            "sheet_sizes: target size {} and at least {} cells; the size must not be negative, the "
            "least number must be 1 or more",
            options.target_size, options.min_cells);
    }
    const std::vector<int> sheets = embedding.layout.sheets();
    const std::vector<double> lengths = arc_lengths(mesh, embedding);
    std::vector<std::vector<double>> of_sheet;
    for (std::size_t a = 0; a < sheets.size(); ++a) {
        of_sheet.resize(std::max<std::size_t>(of_sheet.size(), sheets[a] + 1));
        of_sheet[sheets[a]].push_back(lengths[a]);
    }
    std::vector<int> sizes;
    for (const auto& some : of_sheet) {
        const double n =
            options.target_size > 0.0 ? weighted_median(some) / options.target_size : 0.0;
        sizes.push_back(std::max(options.min_cells, static_cast<int>(std::lround(n))));
    }
    return sizes;
}

std::vector<int> cells_of_arcs(const QuadLayout& layout, std::span<const int> cells_of_sheets) {
    const std::vector<int> sheets = layout.sheets();
    const int n_sheets = sheets.empty() ? 0 : *std::max_element(sheets.begin(), sheets.end()) + 1;
    if (static_cast<int>(cells_of_sheets.size()) != n_sheets) {
        throw InputError("cells_of_arcs: {} numbers of cells for {} sheets; give one for each",
                         cells_of_sheets.size(), n_sheets);
    }
    for (int s = 0; s < n_sheets; ++s) {
        if (cells_of_sheets[s] < 1) {
            throw InputError("cells_of_arcs: sheet {} has {} cells; there must be 1 or more", s,
                             cells_of_sheets[s]);
        }
    }
    std::vector<int> cells;
    for (const int sheet : sheets) cells.push_back(cells_of_sheets[sheet]);
    return cells;
}

}  // namespace couture::meshing
