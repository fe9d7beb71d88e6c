#include "meshing/topology/cell_complex.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "iga/core/error.h"

namespace couture::meshing {

CellComplex::CellComplex(std::vector<BoundaryOperator> boundaries)
    : boundaries_(std::move(boundaries)) {
    if (boundaries_.empty()) {
        throw TopologyError("CellComplex: there are no boundary operators; give at least one");
    }
    for (std::size_t k = 0; k < boundaries_.size(); ++k) {
        const auto& columns = boundaries_[k].columns;
        if (k > 0 && boundaries_[k].n_rows != static_cast<int>(boundaries_[k - 1].columns.size())) {
            throw TopologyError(
                "CellComplex: the boundary operator of dimension {} has {} rows, but there are {} "
                "cells of dimension {}; they must be equal",
                k + 1, boundaries_[k].n_rows, boundaries_[k - 1].columns.size(), k);
        }
        for (std::size_t j = 0; j < columns.size(); ++j) {
            int previous = -1;
            for (const auto& entry : columns[j]) {
                if (entry.row <= previous || entry.row >= boundaries_[k].n_rows) {
                    throw TopologyError(
                        "CellComplex: cell {} of dimension {} lists cell {} of dimension {}; rows "
                        "must ascend and be below {}",
                        j, k + 1, entry.row, k, boundaries_[k].n_rows);
                }
                previous = entry.row;
            }
            // Boundary of the boundary; that of an edge: the sum of its ends.
            std::map<int, int> sum;
            for (const auto& entry : columns[j]) {
                if (k == 0) {
                    sum[0] += entry.value;
                    continue;
                }
                for (const auto& inner : boundaries_[k - 1].columns[entry.row]) {
                    sum[inner.row] += entry.value * inner.value;
                }
            }
            for (const auto& [row, value] : sum) {
                if (value == 0) continue;
                throw TopologyError(
                    "CellComplex: the boundary of the boundary of cell {} of dimension {} is not "
                    "zero ({} times cell {} of dimension {}); its sides must close",
                    j, k + 1, value, row, k == 0 ? 0 : k - 1);
            }
        }
    }
}

int CellComplex::n_cells(int dimension) const {
    return dimension == 0 ? boundaries_.front().n_rows
                          : static_cast<int>(boundary(dimension).columns.size());
}

int CellComplex::euler_characteristic() const {
    int sum = 0;
    for (int k = 0; k <= dimension(); ++k) sum += k % 2 == 0 ? n_cells(k) : -n_cells(k);
    return sum;
}

namespace {

using Entry = BoundaryOperator::Entry;

// A cell as a cycle of vertices (an edge, a face), in the form that all who share it find: smallest
// vertex first, then the smaller of its neighbours.
struct Cycle {
    std::vector<int> vertices;
    int sign = 1;
};

Cycle to_canonical(std::vector<int> cycle) {
    std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
    if (cycle.size() == 2 || cycle[1] < cycle.back()) return {std::move(cycle), 1};
    std::reverse(cycle.begin() + 1, cycle.end());
    return {std::move(cycle), -1};
}

// Numbers edges and faces as they come.
class ComplexBuilder {
  public:
    explicit ComplexBuilder(int dimension) : boundaries_(dimension) {}

    Entry edge(int from, int to) {
        const auto key = std::minmax(from, to);
        const auto [place, is_new] =
            edges_.try_emplace({key.first, key.second}, static_cast<int>(edges_.size()));
        if (is_new) {
            std::vector<Entry> ends{{vertex(key.first), -1}, {vertex(key.second), 1}};
            add(0, std::move(ends));
        }
        return {place->second, from < to ? 1 : -1};
    }

    Entry face(const std::vector<int>& corners) {
        const auto [cycle, sign] = to_canonical(corners);
        auto sorted = cycle;
        std::sort(sorted.begin(), sorted.end());
        const auto [place, is_new] =
            faces_.try_emplace(sorted, cycle, static_cast<int>(faces_.size()));
        if (place->second.first != cycle) {
            throw TopologyError(
                "CellComplex: a face with vertices {}, {}, {}, {} is also there as {}, {}, {}, {}; "
                "cells that share the vertices of a face must share its edges",
                cycle[0], cycle[1], cycle[2], cycle.back(), place->second.first[0],
                place->second.first[1], place->second.first[2], place->second.first.back());
        }
        if (is_new) {
            std::vector<Entry> sides;
            for (std::size_t i = 0; i < cycle.size(); ++i) {
                sides.push_back(edge(cycle[i], cycle[(i + 1) % cycle.size()]));
            }
            add(1, std::move(sides));
        }
        return {place->second.second, sign};
    }

    void add(int operator_index, std::vector<Entry> entries) {
        std::sort(entries.begin(), entries.end(),
                  [](const Entry& a, const Entry& b) { return a.row < b.row; });
        boundaries_[operator_index].columns.push_back(std::move(entries));
    }

    CellComplex finish() {
        boundaries_[0].n_rows = static_cast<int>(vertices_.size());
        for (std::size_t k = 1; k < boundaries_.size(); ++k) {
            boundaries_[k].n_rows = static_cast<int>(boundaries_[k - 1].columns.size());
        }
        return CellComplex(std::move(boundaries_));
    }

    // All vertices before the cells, so that they are numbered in ascending order.
    template <std::size_t n>
    void number_vertices(std::span<const std::array<int, n>> cells) {
        if (cells.empty()) {
            throw TopologyError("CellComplex: there are no cells; give at least one");
        }
        for (std::size_t i = 0; i < cells.size(); ++i) {
            auto sorted = cells[i];
            std::sort(sorted.begin(), sorted.end());
            const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
            if (sorted[0] < 0 || twice != sorted.end()) {
                throw InputError(
                    "CellComplex: cell {} has vertex {}{}; vertices must be different numbers, not "
                    "negative",
                    i, sorted[0] < 0 ? sorted[0] : *twice, sorted[0] < 0 ? "" : " twice");
            }
            for (const int v : cells[i]) vertices_.emplace(v, 0);
        }
        int n_vertices = 0;
        for (auto& [vertex, number] : vertices_) number = n_vertices++;
    }

  private:
    int vertex(int v) const { return vertices_.at(v); }

    std::map<int, int> vertices_;
    std::map<std::pair<int, int>, int> edges_;
    // Sorted vertices to the cycle and the number.
    std::map<std::vector<int>, std::pair<std::vector<int>, int>> faces_;
    std::vector<BoundaryOperator> boundaries_;
};

template <std::size_t n>
CellComplex make_face_complex(std::span<const std::array<int, n>> faces) {
    ComplexBuilder builder(2);
    builder.number_vertices(faces);
    for (const auto& face : faces) builder.face({face.begin(), face.end()});
    return builder.finish();
}

// Sides as seen from outside, counter-clockwise.
template <std::size_t n, std::size_t n_sides, std::size_t n_corners>
CellComplex make_volume_complex(std::span<const std::array<int, n>> cells,
                                const std::array<std::array<int, n_corners>, n_sides>& sides) {
    ComplexBuilder builder(3);
    builder.number_vertices(cells);
    for (const auto& cell : cells) {
        std::vector<Entry> entries;
        for (const auto& side : sides) {
            std::vector<int> corners;
            for (const int i : side) corners.push_back(cell[i]);
            entries.push_back(builder.face(corners));
        }
        builder.add(2, std::move(entries));
    }
    return builder.finish();
}

}  // namespace

CellComplex make_triangle_complex(std::span<const std::array<int, 3>> triangles) {
    return make_face_complex(triangles);
}

CellComplex make_quad_complex(std::span<const std::array<int, 4>> quads) {
    return make_face_complex(quads);
}

CellComplex make_tetrahedron_complex(std::span<const std::array<int, 4>> tetrahedra) {
    constexpr std::array<std::array<int, 3>, 4> sides{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
    return make_volume_complex(tetrahedra, sides);
}

CellComplex make_hexahedron_complex(std::span<const std::array<int, 8>> hexahedra) {
    constexpr std::array<std::array<int, 4>, 6> sides{
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    return make_volume_complex(hexahedra, sides);
}

CellComplex boundary_complex(const CellComplex& complex) {
    const int top = complex.dimension();
    std::vector<int> n_cofaces(complex.n_cells(top - 1), 0);
    for (const auto& column : complex.boundary(top).columns) {
        for (const auto& entry : column) ++n_cofaces[entry.row];
    }
    std::vector<bool> is_kept(n_cofaces.size());
    for (std::size_t i = 0; i < n_cofaces.size(); ++i) is_kept[i] = n_cofaces[i] == 1;
    if (top < 2 || std::find(is_kept.begin(), is_kept.end(), true) == is_kept.end()) {
        throw TopologyError(
            "boundary_complex: none of the {} cells of dimension {} bounds exactly one cell of "
            "dimension {}; the complex is closed or has no dimension above 1",
            is_kept.size(), top - 1, top);
    }
    std::vector<BoundaryOperator> boundaries(top - 1);
    for (int k = top - 1; k >= 1; --k) {
        std::vector<bool> is_row_kept(complex.n_cells(k - 1), false);
        const auto& columns = complex.boundary(k).columns;
        for (std::size_t j = 0; j < columns.size(); ++j) {
            if (!is_kept[j]) continue;
            for (const auto& entry : columns[j]) is_row_kept[entry.row] = true;
        }
        std::vector<int> number(is_row_kept.size(), -1);
        int n_rows = 0;
        for (std::size_t i = 0; i < number.size(); ++i) {
            if (is_row_kept[i]) number[i] = n_rows++;
        }
        boundaries[k - 1].n_rows = n_rows;
        for (std::size_t j = 0; j < columns.size(); ++j) {
            if (!is_kept[j]) continue;
            auto& column = boundaries[k - 1].columns.emplace_back();
            for (const auto& entry : columns[j]) {
                column.push_back({number[entry.row], entry.value});
            }
        }
        is_kept = std::move(is_row_kept);
    }
    return CellComplex(std::move(boundaries));
}

namespace {

// Non-zero entries of a column modulo a prime, rows ascending.
struct ModularEntry {
    int row;
    std::int64_t value;
};
using ModularColumn = std::vector<ModularEntry>;

std::int64_t inverse(std::int64_t value, std::int64_t prime) {
    // Fermat: value^(prime - 2).
    std::int64_t result = 1;
    for (std::int64_t exponent = prime - 2; exponent > 0; exponent /= 2) {
        if (exponent % 2 == 1) result = result * value % prime;
        value = value * value % prime;
    }
    return result;
}

// a - factor b
ModularColumn subtract(const ModularColumn& a, const ModularColumn& b, std::int64_t factor,
                       std::int64_t prime) {
    ModularColumn result;
    result.reserve(a.size() + b.size());
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() || j < b.size()) {
        if (j == b.size() || (i < a.size() && a[i].row < b[j].row)) {
            result.push_back(a[i++]);
            continue;
        }
        std::int64_t value = prime - factor * b[j].value % prime;
        const int row = b[j++].row;
        if (i < a.size() && a[i].row == row) value += a[i++].value;
        value %= prime;
        if (value != 0) result.push_back({row, value});
    }
    return result;
}

// Ranks of all boundary operators by elimination of columns on their last rows. From the top down:
// a row that was a pivot of operator k + 1 is a column of operator k that reduces to zero.
std::vector<int> boundary_ranks(const CellComplex& complex, std::int64_t prime) {
    std::vector<int> ranks(complex.dimension() + 2, 0);
    std::vector<bool> is_known_zero(complex.n_cells(complex.dimension()), false);
    for (int k = complex.dimension(); k >= 1; --k) {
        const BoundaryOperator& boundary = complex.boundary(k);
        std::vector<ModularColumn> column_of_pivot(boundary.n_rows);
        std::vector<bool> is_pivot(boundary.n_rows, false);
        for (std::size_t j = 0; j < boundary.columns.size(); ++j) {
            if (is_known_zero[j]) continue;
            ModularColumn column;
            for (const auto& entry : boundary.columns[j]) {
                const std::int64_t value = (entry.value % prime + prime) % prime;
                if (value != 0) column.push_back({entry.row, value});
            }
            while (!column.empty() && is_pivot[column.back().row]) {
                // Pivots are scaled to 1.
                column = subtract(column, column_of_pivot[column.back().row], column.back().value,
                                  prime);
            }
            if (column.empty()) continue;
            const std::int64_t scale = inverse(column.back().value, prime);
            for (auto& entry : column) entry.value = entry.value * scale % prime;
            const int pivot = column.back().row;
            is_pivot[pivot] = true;
            column_of_pivot[pivot] = std::move(column);
            ++ranks[k];
        }
        is_known_zero = std::move(is_pivot);
    }
    return ranks;
}

bool is_prime(std::int64_t n) {
    if (n < 2) return false;
    for (std::int64_t d = 2; d * d <= n; ++d) {
        if (n % d == 0) return false;
    }
    return true;
}

}  // namespace

std::vector<int> betti_numbers(const CellComplex& complex, std::int64_t prime) {
    if (prime >= (std::int64_t{1} << 31) || !is_prime(prime)) {
        throw InputError("betti_numbers: the modulus is {}; it must be a prime below 2^31", prime);
    }
    const auto ranks = boundary_ranks(complex, prime);
    std::vector<int> betti;
    for (int k = 0; k <= complex.dimension(); ++k) {
        betti.push_back(complex.n_cells(k) - ranks[k] - ranks[k + 1]);
    }
    return betti;
}

std::vector<int> betti_numbers(const CellComplex& complex) {
    constexpr std::int64_t first = 2147483647;
    constexpr std::int64_t second = 2147483629;
    const auto betti = betti_numbers(complex, first);
    const auto again = betti_numbers(complex, second);
    for (std::size_t k = 0; k < betti.size(); ++k) {
        if (betti[k] == again[k]) continue;
        throw TopologyError(
            "betti_numbers: b_{} is {} modulo {} and {} modulo {}; the complex has torsion of one "
            "of these orders, the smaller number holds",
            k, betti[k], first, again[k], second);
    }
    return betti;
}

void check_volume_boundary(const CellComplex& volume) {
    const int chi = volume.euler_characteristic();
    const int chi_boundary = boundary_complex(volume).euler_characteristic();
    if (2 * chi == chi_boundary) return;
    throw TopologyError(
        "check_volume_boundary: chi of the volume is {}, of its boundary {}; a 3-manifold has "
        "twice the first: some volumes touch only along an edge or at a vertex",
        chi, chi_boundary);
}

}  // namespace couture::meshing
