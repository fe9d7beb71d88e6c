#include "meshing/surface/point_grid.h"

#include <algorithm>
#include <cmath>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

std::uint64_t hash_of(const std::array<std::int64_t, 3>& cell) {
    std::uint64_t hash = 0;
    for (const std::int64_t c : cell) {
        hash = (hash ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15ULL;
        hash ^= hash >> 29U;
    }
    return hash;
}

}  // namespace

PointGrid::PointGrid(double cell) : cell_(cell) {
    if (!(cell > 0.0) || !std::isfinite(cell)) {
        throw InputError("PointGrid: cells of length {}; it must be positive", cell);
    }
}

void PointGrid::add(const Vector3& point) { cells_[hash_of(cell_of(point))].push_back(point); }

double PointGrid::distance(const Vector3& x) const {
    const Cell centre = cell_of(x);
    double nearest = cell_;
    for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
            for (int k = -1; k <= 1; ++k) {
                const auto cell =
                    cells_.find(hash_of({centre[0] + i, centre[1] + j, centre[2] + k}));
                if (cell == cells_.end()) continue;
                for (const Vector3& point : cell->second) {
                    nearest = std::min(nearest, (point - x).norm());
                }
            }
        }
    }
    return nearest;
}

PointGrid::Cell PointGrid::cell_of(const Vector3& x) const {
    return {static_cast<std::int64_t>(std::floor(x[0] / cell_)),
            static_cast<std::int64_t>(std::floor(x[1] / cell_)),
            static_cast<std::int64_t>(std::floor(x[2] / cell_))};
}

}  // namespace couture::meshing
