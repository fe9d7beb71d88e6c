#include "tests/meshing/volume/sampled_layouts.h"

#include <cmath>
#include <numbers>

namespace couture::meshing {

namespace {

constexpr double core = 0.45;

Vector3 corner(int i) { return {1.0 * (i & 1), 1.0 * (i >> 1 & 1), 1.0 * (i >> 2 & 1)}; }

}  // namespace

LayoutSamples sample(const MappedLayout& body, int n_cells) {
    const LayoutBoundary boundary = layout_boundary(body.layout);
    const QuadLayout& layout = boundary.layout;
    LayoutSamples samples{layout,
                          std::vector<int>(layout.n_arcs(), n_cells),
                          std::vector<MatrixX>(layout.n_arcs()),
                          {},
                          std::vector<bool>(layout.n_arcs(), false)};
    const int n = n_cells + 1;
    for (int q = 0; q < layout.n_quads(); ++q) {
        const auto [cuboid, side] = boundary.sides[q];
        const auto& corners = side_corners(side);
        MatrixX points(3, n * n);
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                const double s = static_cast<double>(i) / n_cells;
                const double t = static_cast<double>(j) / n_cells;
                const Vector3 origin = corner(corners[0]);
                points.col(i + n * j) =
                    body.map(cuboid, origin + s * (corner(corners[1]) - origin) +
                                         t * (corner(corners[3]) - origin));
            }
        }
        for (int k = 0; k < 4; ++k) {
            const auto [arc, is_forward] = layout.sides(q)[k];
            const bool is_new = samples.arcs[arc].cols() == 0;
            if (is_new) samples.arcs[arc].resize(3, n);
            for (int i = 0; i < n; ++i) {
                const int place =
                    std::array<int, 4>{i, n - 1 + n * i, n * n - 1 - i, n * (n - 1 - i)}[k];
                auto own = samples.arcs[arc].col(is_forward ? i : n - 1 - i);
                if (is_new) {
                    own = points.col(place);
                } else {
                    points.col(place) = own;
                }
            }
        }
        samples.quads.push_back(points);
    }
    // Arcs that meet agree to the last bit, which sines of rounded angles do not.
    std::vector<int> known(layout.n_nodes(), -1);
    for (int arc = 0; arc < layout.n_arcs(); ++arc) {
        for (const bool is_end : {false, true}) {
            const int node = is_end ? layout.arcs()[arc].to : layout.arcs()[arc].from;
            if (known[node] < 0) known[node] = arc;
            const int first = known[node];
            const Vector3 point =
                samples.arcs[first].col(layout.arcs()[first].to == node ? n - 1 : 0);
            samples.arcs[arc].col(is_end ? n - 1 : 0) = point;
        }
    }
    for (int q = 0; q < layout.n_quads(); ++q) {
        for (int k = 0; k < 4; ++k) {
            const auto [arc, is_forward] = layout.sides(q)[k];
            for (int i = 0; i < n; ++i) {
                const int place =
                    std::array<int, 4>{i, n - 1 + n * i, n * n - 1 - i, n * (n - 1 - i)}[k];
                samples.quads[q].col(place) = samples.arcs[arc].col(is_forward ? i : n - 1 - i);
            }
        }
    }
    return samples;
}

MappedLayout mapped_box(std::array<int, 3> n, std::function<Vector3(const Vector3&)> map) {
    MappedLayout body;
    const auto node = [n](int i, int j, int k) { return i + (n[0] + 1) * (j + (n[1] + 1) * k); };
    body.layout.n_nodes = (n[0] + 1) * (n[1] + 1) * (n[2] + 1);
    for (int c = 0; c < n[0] * n[1] * n[2]; ++c) {
        const std::array<int, 3> at{c % n[0], c / n[0] % n[1], c / (n[0] * n[1])};
        std::array<int, 8> nodes{};
        for (int i = 0; i < 8; ++i) {
            nodes[i] = node(at[0] + (i & 1), at[1] + (i >> 1 & 1), at[2] + (i >> 2 & 1));
        }
        body.layout.cuboids.push_back(nodes);
        if (at[2] == 0) body.layout.sets["bottom"].push_back({c, 4});
    }
    body.map = [n, map = std::move(map)](int c, const Vector3& xi) {
        const Vector3 at(c % n[0], c / n[0] % n[1], c / (n[0] * n[1]));
        return map((at + xi).cwiseQuotient(Vector3(n[0], n[1], n[2])));
    };
    return body;
}

MappedLayout o_grid(int n, bool is_ring,
                    std::function<Vector3(double x, double y, double along)> place) {
    MappedLayout body;
    const int n_sections = is_ring ? n : n + 1;
    body.layout.n_nodes = 8 * n_sections;
    for (int segment = 0; segment < n; ++segment) {
        const int low = 8 * segment;
        const int high = 8 * ((segment + 1) % n_sections);
        // Corners of a square counter-clockwise.
        body.layout.cuboids.push_back({low, low + 1, low + 3, low + 2,  //
                                       high, high + 1, high + 3, high + 2});
        for (int k = 0; k < 4; ++k) {
            const int next = (k + 1) % 4;
            body.layout.cuboids.push_back({low + k, low + k + 4, low + next, low + next + 4,
                                           high + k, high + k + 4, high + next, high + next + 4});
            body.layout.sets["wall"].push_back({5 * segment + k + 1, 1});
        }
    }
    body.map = [n, place = std::move(place)](int c, const Vector3& xi) {
        const double along = (c / 5 + xi[2]) / n;
        const double half = core * std::numbers::sqrt2 / 2.0;
        if (c % 5 == 0) return place(half * (2.0 * xi[0] - 1.0), half * (2.0 * xi[1] - 1.0), along);
        const double angle = (c % 5 - 1 + xi[1]) * 0.5 * std::numbers::pi - 0.75 * std::numbers::pi;
        const double start = (c % 5 - 1) * 0.5 * std::numbers::pi - 0.75 * std::numbers::pi;
        const double end = start + 0.5 * std::numbers::pi;
        const double x = core * ((1.0 - xi[1]) * std::cos(start) + xi[1] * std::cos(end));
        const double y = core * ((1.0 - xi[1]) * std::sin(start) + xi[1] * std::sin(end));
        return place((1.0 - xi[0]) * x + xi[0] * std::cos(angle),
                     (1.0 - xi[0]) * y + xi[0] * std::sin(angle), along);
    };
    return body;
}

MappedLayout torus_of_20() {
    return o_grid(4, true, [](double x, double y, double along) {
        // Along runs clockwise seen from above, so that the frame is right-handed.
        const double angle = -2.0 * std::numbers::pi * along;
        const double r = torus_radius + tube_radius * x;
        return Vector3(r * std::cos(angle), r * std::sin(angle), tube_radius * y);
    });
}

}  // namespace couture::meshing
