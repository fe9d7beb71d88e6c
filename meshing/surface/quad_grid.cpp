#include "meshing/surface/quad_grid.h"

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

void check_count(int n, bool is_closed, const char* direction) {
    const int least = is_closed ? 3 : 1;
    if (n < least) {
        throw InputError("extract_quad_grid: {} quads along {}; there must be {} or more{}", n,
                         direction, least, is_closed ? " in a closed direction" : "");
    }
}

}  // namespace

QuadMesh extract_quad_grid(const PlanarMap& map, const Vector2& low, const Vector2& high,
                           const QuadGridOptions& options) {
    check_count(options.n_u, options.is_closed_u, "u");
    check_count(options.n_v, options.is_closed_v, "v");
    if (!(low.x() < high.x() && low.y() < high.y())) {
        throw InputError("extract_quad_grid: [{}, {}] x [{}, {}]; low must lie below high", low.x(),
                         high.x(), low.y(), high.y());
    }
    const int n_u = options.n_u;
    const int n_v = options.n_v;
    // Exact at both ends.
    const auto between = [](double a, double b, int i, int n) {
        return i == n ? b : a + (b - a) * (static_cast<double>(i) / n);
    };
    std::vector<Vector3> grid;
    for (int j = 0; j <= n_v; ++j) {
        for (int i = 0; i <= n_u; ++i) {
            grid.push_back(map.point_at(
                {between(low.x(), high.x(), i, n_u), between(low.y(), high.y(), j, n_v)}));
        }
    }
    const auto at = [&](int i, int j) -> const Vector3& { return grid[(n_u + 1) * j + i]; };
    Vector3 box_low = grid.front();
    Vector3 box_high = grid.front();
    for (const Vector3& point : grid) {
        box_low = box_low.cwiseMin(point);
        box_high = box_high.cwiseMax(point);
    }
    const double tolerance = options.weld_tolerance * (box_high - box_low).norm();
    const auto check_pair = [&](int i, int j, int other_i, int other_j) {
        const double gap = (at(i, j) - at(other_i, other_j)).norm();
        if (gap > tolerance) {
            throw GeometryError(
                "extract_quad_grid: points ({}, {}) and ({}, {}) of the grid are {:.3g} apart; "
                "sides that are closed must have the same points: map the two copies of the seam "
                "alike, or leave the grid open",
                i, j, other_i, other_j, gap);
        }
    };
    if (options.is_closed_u) {
        for (int j = 0; j <= n_v; ++j) check_pair(0, j, n_u, j);
    }
    if (options.is_closed_v) {
        for (int i = 0; i <= n_u; ++i) check_pair(i, 0, i, n_v);
    }
    const int n_columns = options.is_closed_u ? n_u : n_u + 1;
    const int n_rows = options.is_closed_v ? n_v : n_v + 1;
    QuadMesh mesh;
    for (int j = 0; j < n_rows; ++j) {
        for (int i = 0; i < n_columns; ++i) mesh.points.push_back(at(i, j));
    }
    const auto number = [&](int i, int j) { return n_columns * (j % n_rows) + i % n_columns; };
    for (int j = 0; j < n_v; ++j) {
        for (int i = 0; i < n_u; ++i) {
            mesh.quads.push_back(
                {number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)});
        }
    }
    return mesh;
}

}  // namespace couture::meshing
