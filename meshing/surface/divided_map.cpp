#include "meshing/surface/divided_map.h"

#include <algorithm>
#include <array>
#include <limits>
#include <queue>
#include <utility>

#include "meshing/surface/harmonic_function.h"
#include "meshing/surface/predicates.h"

namespace couture::meshing {

namespace {

// A disc that is bounded by halfedges on the sides of a convex polygon.
struct Piece {
    std::vector<int> faces;
    std::vector<int> boundary;
    std::vector<int> sides;
};

class Divider {
  public:
    Divider(const CutSurface& surface, std::vector<Vector2>& parameters)
        : surface_(surface),
          parameters_(parameters),
          region_(surface.n_faces(), 0),
          place_(surface.n_vertices(), -1) {}

    int run(Piece whole) {
        int n_divisions = 0;
        for (const int side : whole.sides) n_sides_ = std::max(n_sides_, side + 1);
        std::vector<Piece> stack;
        stack.push_back(std::move(whole));
        while (!stack.empty()) {
            const Piece piece = std::move(stack.back());
            stack.pop_back();
            open(piece);
            const std::vector<int> flipped = map(piece);
            if (!flipped.empty() && piece.faces.size() > 1) {
                std::vector<Piece> parts = piece.boundary.size() == 3
                                               ? divide_triangle(piece)
                                               : divide(piece, dividing_path(flipped));
                n_divisions += parts.empty() ? 0 : 1;
                for (Piece& part : parts) stack.push_back(std::move(part));
            }
            close();
        }
        return n_divisions;
    }

  private:
    // Vertices of the piece by local numbers: neighbours, sides of those on the boundary.
    struct Node {
        int vertex;
        std::array<int, 2> sides{-1, -1};
        std::vector<int> neighbours;
        [[nodiscard]] bool is_boundary() const { return sides[0] >= 0; }
    };

    int local(int v) {
        if (place_[v] < 0) {
            place_[v] = static_cast<int>(nodes_.size());
            nodes_.push_back({v, {-1, -1}, {}});
        }
        return place_[v];
    }

    void open(const Piece& piece) {
        nodes_.clear();
        triangles_.clear();
        for (const int f : piece.faces) {
            const auto [a, b, c] = surface_.triangle(f);
            triangles_.push_back({local(a), local(b), local(c)});
        }
        // Each edge inside once from either end; those on the boundary not at all: no path may
        // follow it.
        for (const int f : piece.faces) {
            for (int h = 3 * f; h < 3 * f + 3; ++h) {
                if (!is_inner(h)) continue;
                nodes_[local(surface_.origin(h))].neighbours.push_back(local(surface_.target(h)));
            }
        }
        for (std::size_t i = 0; i < piece.boundary.size(); ++i) {
            nodes_[local(surface_.origin(piece.boundary[i]))].sides[1] = piece.sides[i];
            nodes_[local(surface_.target(piece.boundary[i]))].sides[0] = piece.sides[i];
        }
    }

    void close() {
        for (const Node& node : nodes_) place_[node.vertex] = -1;
    }

    [[nodiscard]] bool is_inner(int h) const {
        const int twin = surface_.twin(h);
        return twin >= 0 && region_[CutSurface::face(twin)] == region_[CutSurface::face(h)];
    }

    // The mean value map of the piece; returns the triangles that it flips, by local numbers.
    std::vector<int> map(const Piece& piece) {
        HarmonicProblem problem;
        std::vector<Vector3> points;
        const auto n = static_cast<Eigen::Index>(nodes_.size());
        problem.values = MatrixX::Zero(n, 2);
        for (Eigen::Index i = 0; i < n; ++i) {
            points.push_back(surface_.point(nodes_[i].vertex));
            problem.is_fixed.push_back(nodes_[i].is_boundary() ? 1 : 0);
            problem.values.row(i) = parameters_[nodes_[i].vertex].transpose();
        }
        problem.triangles = triangles_;
        problem.points = points;
        const MatrixX values = solve_harmonic(problem).values;
        for (Eigen::Index i = 0; i < n; ++i) {
            if (!nodes_[i].is_boundary()) parameters_[nodes_[i].vertex] = values.row(i);
        }
        std::vector<int> flipped;
        for (std::size_t i = 0; i < piece.faces.size(); ++i) {
            const auto [a, b, c] = surface_.triangle(piece.faces[i]);
            if (orientation(parameters_[a], parameters_[b], parameters_[c]) <= 0) {
                flipped.push_back(static_cast<int>(i));
            }
        }
        return flipped;
    }

    [[nodiscard]] bool share_side(int i, int j) const {
        for (const int side : nodes_[i].sides) {
            if (side == nodes_[j].sides[0] || side == nodes_[j].sides[1]) return true;
        }
        return false;
    }

    // Number of edges from the nearest start; -1 where none leads.
    [[nodiscard]] std::vector<int> depths(const std::vector<int>& starts) const {
        std::vector<int> depth(nodes_.size(), -1);
        for (const int i : starts) depth[i] = 0;
        std::vector<int> queue = starts;
        for (std::size_t next = 0; next < queue.size(); ++next) {
            for (const int j : nodes_[queue[next]].neighbours) {
                if (depth[j] >= 0) continue;
                depth[j] = depth[queue[next]] + 1;
                queue.push_back(j);
            }
        }
        return depth;
    }

    // Cheapest path from a node through inner nodes to a boundary node that `is_end` accepts,
    // its nodes in order; empty if there is none. Infinite cost: never enter.
    template <typename IsEnd>
    [[nodiscard]] std::vector<int> path_from(int start, const std::vector<double>& cost,
                                             const IsEnd& is_end) const {
        const double infinite = std::numeric_limits<double>::infinity();
        std::vector<double> distance(nodes_.size(), infinite);
        std::vector<int> before(nodes_.size(), -1);
        using Entry = std::pair<double, int>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> heap;
        distance[start] = 0.0;
        heap.emplace(0.0, start);
        while (!heap.empty()) {
            const auto [d, i] = heap.top();
            heap.pop();
            if (d > distance[i]) continue;
            if (i != start && nodes_[i].is_boundary()) {
                if (!is_end(i)) continue;
                std::vector<int> path;
                for (int j = i; j >= 0; j = before[j]) path.push_back(j);
                std::reverse(path.begin(), path.end());
                return path;
            }
            for (const int j : nodes_[i].neighbours) {
                const double longer = d + cost[j];
                if (!(longer < distance[j])) continue;
                distance[j] = longer;
                before[j] = i;
                heap.emplace(longer, j);
            }
        }
        return {};
    }

    // Vertices of an edge path between two sides; no edge joins two of them but the path's.
    [[nodiscard]] std::vector<int> dividing_path(const std::vector<int>& flipped) const {
        const int n = static_cast<int>(nodes_.size());
        std::vector<int> boundary;
        for (int i = 0; i < n; ++i) {
            if (!nodes_[i].is_boundary()) continue;
            boundary.push_back(i);
            for (const int j : nodes_[i].neighbours) {
                if (nodes_[j].is_boundary() && !share_side(i, j)) return to_vertices({i, j});
            }
        }
        const std::vector<int> depth = depths(boundary);
        std::vector<int> seeds;
        for (const int f : flipped) {
            for (const int i : triangles_[f]) seeds.push_back(i);
        }
        // The deepest first.
        std::sort(seeds.begin(), seeds.end(),
                  [&](int i, int j) { return std::pair(-depth[i], i) < std::pair(-depth[j], j); });
        seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
        if (depth[seeds.front()] > 0) {
            const std::vector<int> path = path_through(seeds.front());
            if (!path.empty()) return to_vertices(path);
        }
        seeds.insert(seeds.end(), boundary.begin(), boundary.end());
        const std::vector<double> cost(n, 1.0);
        for (const int i : seeds) {
            if (!nodes_[i].is_boundary()) continue;
            const auto path =
                path_from(i, cost, [&](int end) { return end != i && !share_side(i, end); });
            if (!path.empty()) return to_vertices(path);
        }
        return {};
    }

    // From the boundary to an inner node and on to another side, away from the first half.
    [[nodiscard]] std::vector<int> path_through(int middle) const {
        std::vector<double> cost(nodes_.size(), 1.0);
        const auto first = path_from(middle, cost, [](int) { return true; });
        if (first.empty()) return {};
        const std::vector<int> distance = depths({first.begin() + 1, first.end()});
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            cost[i] =
                distance[i] > 0 ? 1.0 + 8.0 / distance[i] : std::numeric_limits<double>::infinity();
        }
        const int start = first.back();
        const auto second =
            path_from(middle, cost, [&](int end) { return !share_side(start, end); });
        if (second.empty()) return {};
        // The shortest way within both halves has no short cuts.
        for (double& c : cost) c = std::numeric_limits<double>::infinity();
        for (const int i : first) cost[i] = 1.0;
        for (const int i : second) cost[i] = 1.0;
        return path_from(start, cost, [&](int end) { return end == second.back(); });
    }

    [[nodiscard]] std::vector<int> to_vertices(const std::vector<int>& path) const {
        std::vector<int> vertices;
        vertices.reserve(path.size());
        for (const int i : path) vertices.push_back(nodes_[i].vertex);
        return vertices;
    }

    void lay_straight(const std::vector<int>& path) {
        std::vector<double> length{0.0};
        for (std::size_t i = 1; i < path.size(); ++i) {
            const double step = (surface_.point(path[i]) - surface_.point(path[i - 1])).norm();
            length.push_back(length.back() + step);
        }
        // By count where the lengths say nothing.
        const bool is_uniform = !(length.back() > 0.0);
        const Vector2 start = parameters_[path.front()];
        const Vector2 end = parameters_[path.back()];
        for (std::size_t i = 1; i + 1 < path.size(); ++i) {
            const double t = is_uniform
                                 ? static_cast<double>(i) / static_cast<double>(path.size() - 1)
                                 : length[i] / length.back();
            parameters_[path[i]] = (1.0 - t) * start + t * end;
        }
    }

    [[nodiscard]] std::vector<int> halfedges_along(const std::vector<int>& path) const {
        std::vector<int> along;
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            along.push_back(surface_.find_halfedge(path[i], path[i + 1]));
        }
        return along;
    }

    // What is reached from the left of halfedges without crossing them becomes a new region; the
    // faces of it, ascending.
    std::vector<int> claim_left(const std::vector<int>& along) {
        std::vector<int> cut = along;
        for (const int h : along) cut.push_back(surface_.twin(h));
        std::sort(cut.begin(), cut.end());
        const int old_region = region_[CutSurface::face(along.front())];
        const int region = ++n_regions_;
        std::vector<int> faces{CutSurface::face(along.front())};
        region_[faces.front()] = region;
        for (std::size_t i = 0; i < faces.size(); ++i) {
            for (int h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h) {
                const int twin = surface_.twin(h);
                if (twin < 0 || region_[CutSurface::face(twin)] != old_region ||
                    std::binary_search(cut.begin(), cut.end(), h)) {
                    continue;
                }
                region_[CutSurface::face(twin)] = region;
                faces.push_back(CutSurface::face(twin));
            }
        }
        std::sort(faces.begin(), faces.end());
        return faces;
    }

    // The faces of a piece that are still in its region become a new one.
    std::vector<int> claim_rest(const Piece& piece, int old_region) {
        const int region = ++n_regions_;
        std::vector<int> faces;
        for (const int f : piece.faces) {
            if (region_[f] != old_region) continue;
            region_[f] = region;
            faces.push_back(f);
        }
        return faces;
    }

    // In two along a path that is laid straight; nothing if there is none.
    std::vector<Piece> divide(const Piece& piece, const std::vector<int>& path) {
        if (path.empty()) return {};
        lay_straight(path);
        const std::vector<int> along = halfedges_along(path);
        const int old_region = region_[piece.faces.front()];
        Piece left;
        Piece right;
        left.faces = claim_left(along);
        right.faces = claim_rest(piece, old_region);
        // The boundary from the end of the path to its start belongs to the left piece, the rest
        // to the right one.
        const int side = n_sides_++;
        const std::size_t n = piece.boundary.size();
        const auto position_of = [&](int vertex) {
            std::size_t i = 0;
            while (surface_.origin(piece.boundary[i]) != vertex) ++i;
            return i;
        };
        const std::size_t start = position_of(path.front());
        const std::size_t end = position_of(path.back());
        for (std::size_t i = end; i != start; i = (i + 1) % n) {
            add_side(left, piece.boundary[i], piece.sides[i]);
        }
        for (const int h : along) add_side(left, h, side);
        for (std::size_t i = start; i != end; i = (i + 1) % n) {
            add_side(right, piece.boundary[i], piece.sides[i]);
        }
        for (auto h = along.rbegin(); h != along.rend(); ++h) {
            add_side(right, surface_.twin(*h), side);
        }
        return {std::move(right), std::move(left)};
    }

    // A piece with three boundary vertices a, b, c has no path between sides. The third vertex of
    // the triangle at a, b goes where each part gets area by its number of triangles, so that
    // nested triangles don't shrink exponentially; a path from there to c is laid straight.
    std::vector<Piece> divide_triangle(const Piece& piece) {
        const int bottom = piece.boundary[0];
        const int a = surface_.origin(bottom);
        const int b = surface_.target(bottom);
        const int c = surface_.target(piece.boundary[1]);
        const int apex = surface_.target(CutSurface::next(bottom));
        std::vector<double> cost(nodes_.size(), 1.0);
        const int end = place_[c];
        const std::vector<int> path =
            to_vertices(path_from(place_[apex], cost, [&](int i) { return i == end; }));
        if (path.empty()) return {};
        const std::vector<int> along = halfedges_along(path);
        const int old_region = region_[piece.faces.front()];
        region_[CutSurface::face(bottom)] = ++n_regions_;
        Piece left;
        Piece right;
        left.faces = claim_left(along);
        right.faces = claim_rest(piece, old_region);
        const auto n_left = static_cast<double>(left.faces.size());
        const auto n_right = static_cast<double>(right.faces.size());
        parameters_[apex] = (n_right * parameters_[a] + n_left * parameters_[b] + parameters_[c]) /
                            (n_left + n_right + 1.0);
        lay_straight(path);
        const int side = n_sides_;
        n_sides_ += 3;
        for (const int h : along) add_side(left, h, side);
        add_side(left, piece.boundary[2], piece.sides[2]);
        add_side(left, surface_.twin(CutSurface::previous(bottom)), side + 1);
        for (auto h = along.rbegin(); h != along.rend(); ++h) {
            add_side(right, surface_.twin(*h), side);
        }
        add_side(right, surface_.twin(CutSurface::next(bottom)), side + 2);
        add_side(right, piece.boundary[1], piece.sides[1]);
        return {std::move(right), std::move(left)};
    }

    static void add_side(Piece& piece, int halfedge, int side) {
        piece.boundary.push_back(halfedge);
        piece.sides.push_back(side);
    }

    const CutSurface& surface_;
    std::vector<Vector2>& parameters_;
    std::vector<int> region_;
    int n_regions_ = 0;
    int n_sides_ = 0;
    std::vector<int> place_;
    std::vector<Node> nodes_;
    std::vector<std::array<int, 3>> triangles_;
};

}  // namespace

int map_by_division(const CutSurface& disc, std::span<const int> boundary,
                    std::span<const int> sides, std::vector<Vector2>& parameters) {
    Piece whole;
    for (int f = 0; f < disc.n_faces(); ++f) whole.faces.push_back(f);
    whole.boundary.assign(boundary.begin(), boundary.end());
    whole.sides.assign(sides.begin(), sides.end());
    return Divider(disc, parameters).run(std::move(whole));
}

}  // namespace couture::meshing
