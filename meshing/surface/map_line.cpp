#include "meshing/surface/map_line.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "iga/core/error.h"
#include "meshing/surface/planar_map.h"
#include "meshing/surface/predicates.h"

namespace couture::meshing {

namespace {

// Sign of the way from a to b along the direction of the line; exact for points on the line.
int sign_along(const Vector2& direction, const Vector2& a, const Vector2& b) {
    const int axis = std::abs(direction.x()) >= std::abs(direction.y()) ? 0 : 1;
    const double sense = direction[axis] > 0.0 ? 1.0 : -1.0;
    return (sense * b[axis] > sense * a[axis]) - (sense * b[axis] < sense * a[axis]);
}

class Tracer {
  public:
    Tracer(const CutSurface& surface, std::span<const Vector2> parameters, int from, int to)
        : surface_(surface),
          parameters_(parameters),
          start_(parameters[from]),
          end_(parameters[to]),
          direction_(end_ - start_),
          from_(from),
          to_(to) {}

    std::vector<LineNode> run() {
        nodes_.push_back({from_, -1, 0.0});
        while (nodes_.back().vertex != to_) {
            if (nodes_.size() > static_cast<std::size_t>(surface_.n_halfedges())) fail();
            if (nodes_.back().vertex >= 0) {
                leave_vertex(nodes_.back().vertex);
            } else {
                cross_triangle(nodes_.back().halfedge);
            }
        }
        return nodes_;
    }

  private:
    [[nodiscard]] int side(int v) const { return orientation(start_, end_, parameters_[v]); }

    // From a vertex on the line.
    void leave_vertex(int v) {
        const int first = surface_.outgoing(v);
        for (int h = first; h >= 0;) {
            if (passes(v, surface_.target(h))) return;
            const int last = CutSurface::previous(h);
            if (surface_.twin(last) < 0 && passes(v, surface_.origin(last))) return;
            // Leaves through the edge across if its ends lie on either side.
            const int across = CutSurface::next(h);
            if (side(surface_.origin(across)) < 0 && side(surface_.target(across)) > 0) {
                add_crossing(across);
                return;
            }
            h = surface_.rotated(h);
            if (h == first) break;
        }
        fail();
    }

    // Whether the next vertex of the line is w, a neighbour of v.
    bool passes(int v, int w) {
        if (w != to_ && side(w) != 0) return false;
        if (sign_along(direction_, parameters_[v], parameters_[w]) <= 0) return false;
        nodes_.push_back({w, -1, 0.0});
        return true;
    }

    // Into the triangle behind an edge.
    void cross_triangle(int crossed) {
        const int h = surface_.twin(crossed);
        if (h < 0) fail();
        const int apex = surface_.target(CutSurface::next(h));
        const int apex_side = apex == to_ ? 0 : side(apex);
        if (apex_side == 0) {
            nodes_.push_back({apex, -1, 0.0});
        } else {
            add_crossing(apex_side > 0 ? CutSurface::next(h) : CutSurface::previous(h));
        }
    }

    void add_crossing(int h) {
        const auto distance = [&](int v) {
            const Vector2 x = parameters_[v] - start_;
            return std::abs(direction_.x() * x.y() - direction_.y() * x.x());
        };
        const double right = distance(surface_.origin(h));
        const double left = distance(surface_.target(h));
        nodes_.push_back({-1, h, right + left > 0.0 ? right / (right + left) : 0.5});
    }

    [[noreturn]] void fail() const {
        const LineNode& node = nodes_.back();
        const std::string place = node.vertex >= 0 ? fmt::format("vertex {}", node.vertex)
                                                   : fmt::format("the edge of vertices {} and {}",
                                                                 surface_.origin(node.halfedge),
                                                                 surface_.target(node.halfedge));
        throw GeometryError(
            "trace_line: the line from vertex {} at ({}, {}) to vertex {} at ({}, {}) leaves the "
            "map at {}; it must lie in the map's domain, and the map must be one-to-one",
            from_, start_.x(), start_.y(), to_, end_.x(), end_.y(), place);
    }

    const CutSurface& surface_;
    std::span<const Vector2> parameters_;
    Vector2 start_;
    Vector2 end_;
    Vector2 direction_;
    int from_;
    int to_;
    std::vector<LineNode> nodes_;
};

// Vertices nearer to the line than this part of its coordinates lie on it but for rounding.
constexpr double rounding = 1e-14;

// A node of the path to be: a vertex, or a point of the edge between two.
struct PathNode {
    int vertex = -1;
    int from = -1;
    int to = -1;
    double fraction = 0.0;
};

Vector2 between(std::span<const Vector2> parameters, int from, int to, double fraction) {
    return (1.0 - fraction) * parameters[from] + fraction * parameters[to];
}

// Whether a split of h there leaves only counter-clockwise triangles.
bool is_splittable(const CutSurface& surface, std::span<const Vector2> parameters, int h,
                   double fraction) {
    if (!(fraction > 0.0 && fraction < 1.0)) return false;
    const int u = surface.origin(h);
    const int v = surface.target(h);
    const Vector2 middle = between(parameters, u, v, fraction);
    const auto is_clear = [&](int side, int from, int to) {
        if (side < 0) return true;
        const Vector2& apex = parameters[surface.target(CutSurface::next(side))];
        return orientation(parameters[from], middle, apex) > 0 &&
               orientation(middle, parameters[to], apex) > 0;
    };
    return is_clear(h, u, v) && is_clear(surface.twin(h), v, u);
}

int split(CutSurface& surface, std::vector<Vector2>& parameters, int h, double fraction) {
    parameters.push_back(between(parameters, surface.origin(h), surface.target(h), fraction));
    return surface.split_edge(h, fraction);
}

// Leaves out what lies between two visits of a vertex.
void remove_loops(std::vector<PathNode>& path) {
    std::vector<PathNode> simple;
    for (const PathNode& node : path) {
        if (node.vertex >= 0) {
            const auto visit =
                std::find_if(simple.begin(), simple.end(),
                             [&](const PathNode& other) { return other.vertex == node.vertex; });
            if (visit != simple.end()) {
                simple.erase(visit + 1, simple.end());
                continue;
            }
        }
        simple.push_back(node);
    }
    path = std::move(simple);
}

// Puts the vertices of later splits between those of a path whose edges they split.
void follow_splits(const CutSurface& surface, std::size_t first_split, std::vector<int>& path) {
    for (std::size_t i = first_split; i < surface.splits().size(); ++i) {
        const auto& split = surface.splits()[i];
        for (std::size_t k = 0; k + 1 < path.size(); ++k) {
            if (std::minmax(path[k], path[k + 1]) != std::minmax(split.from, split.to)) continue;
            path.insert(path.begin() + static_cast<std::ptrdiff_t>(k) + 1, split.vertex);
            break;
        }
    }
}

void check_snap(const InsertLineOptions& options, const char* who) {
    if (!(options.snap_fraction >= 0.0 && options.snap_fraction <= 0.5)) {
        throw InputError("{}: snap fraction {}; it must lie in [0, 0.5]", who,
                         options.snap_fraction);
    }
}

int edge_of(const CutSurface& surface, int u, int v) {
    const int h = surface.find_halfedge(u, v);
    return h >= 0 ? h : surface.find_halfedge(v, u);
}

}  // namespace

std::vector<LineNode> trace_line(const CutSurface& surface, std::span<const Vector2> parameters,
                                 int from, int to) {
    for (const int v : {from, to}) {
        if (v < 0 || v >= surface.n_vertices() || surface.outgoing(v) < 0) {
            throw InputError(
                "trace_line: vertex {} has no triangles or does not exist; there are {}", v,
                surface.n_vertices());
        }
    }
    if (from == to || parameters[from] == parameters[to]) {
        throw InputError(
            "trace_line: both ends, vertices {} and {}, lie at ({}, {}); a line has two ends", from,
            to, parameters[from].x(), parameters[from].y());
    }
    return Tracer(surface, parameters, from, to).run();
}

std::vector<int> insert_line(CutSurface& surface, std::vector<Vector2>& parameters, int from,
                             int to, const InsertLineOptions& options) {
    check_snap(options, "insert_line");
    const Vector2 start = parameters[from];
    const Vector2 direction = parameters[to] - start;
    const double slack =
        rounding * direction.norm() * (start.cwiseAbs() + parameters[to].cwiseAbs()).maxCoeff();
    const auto is_on_line = [&](int v) {
        const Vector2 x = parameters[v] - start;
        return std::abs(direction.x() * x.y() - direction.y() * x.x()) <= slack;
    };
    std::vector<PathNode> path;
    for (const LineNode& node : trace_line(surface, parameters, from, to)) {
        if (node.vertex >= 0) {
            path.push_back({node.vertex, -1, -1, 0.0});
            continue;
        }
        const int right = surface.origin(node.halfedge);
        const int left = surface.target(node.halfedge);
        const double t = node.fraction;
        const int nearer = t <= 0.5 ? right : left;
        const bool is_close =
            std::min(t, 1.0 - t) < options.snap_fraction && !surface.is_boundary_vertex(nearer);
        if (is_close || is_on_line(nearer) ||
            !is_splittable(surface, parameters, node.halfedge, t)) {
            path.push_back({nearer, -1, -1, 0.0});
        } else {
            path.push_back({-1, right, left, t});
        }
    }
    remove_loops(path);
    for (PathNode& node : path) {
        if (node.vertex >= 0) continue;
        const int h = surface.find_halfedge(node.from, node.to);
        // Splits before it moved its triangles' corners.
        node.vertex = is_splittable(surface, parameters, h, node.fraction)
                          ? split(surface, parameters, h, node.fraction)
                          : (node.fraction <= 0.5 ? node.from : node.to);
    }
    remove_loops(path);
    std::vector<int> halfedges;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        halfedges.push_back(edge_of(surface, path[i].vertex, path[i + 1].vertex));
    }
    return halfedges;
}

int insert_point(CutSurface& surface, std::vector<Vector2>& parameters, const Vector2& point,
                 const InsertLineOptions& options) {
    check_snap(options, "insert_point");
    std::optional<MapPoint> place;
    {
        const PlanarMap map(surface, parameters);
        place = map.locate(point, 1e-12);
    }
    if (!place) {
        throw GeometryError("insert_point: ({}, {}) lies outside the map", point.x(), point.y());
    }
    const int first = 3 * place->face;
    // Corners from the heaviest to the lightest.
    std::array<int, 3> order{0, 1, 2};
    std::stable_sort(order.begin(), order.end(),
                     [&](int i, int j) { return place->weights[i] > place->weights[j]; });
    const auto weight = [&](int i) { return place->weights[order[i]]; };
    const int heaviest = surface.origin(first + order[0]);
    const auto is_small = [&](double w) { return w <= options.snap_fraction; };
    if (is_small(weight(1)) && is_small(weight(2))) return heaviest;
    const int h = first + (order[1] == (order[0] + 1) % 3 ? order[0] : order[1]);
    const double along = weight(1) / (weight(0) + weight(1));
    const double fraction = surface.origin(h) == heaviest ? along : 1.0 - along;
    if (!is_splittable(surface, parameters, h, fraction)) return heaviest;
    const int lightest = surface.origin(first + order[2]);
    const int on_edge = split(surface, parameters, h, fraction);
    if (is_small(weight(2))) return on_edge;
    const int spoke = surface.find_halfedge(on_edge, lightest);
    if (!is_splittable(surface, parameters, spoke, weight(2))) return on_edge;
    return split(surface, parameters, spoke, weight(2));
}

std::vector<int> insert_polyline(CutSurface& surface, std::vector<Vector2>& parameters,
                                 std::span<const Vector2> points,
                                 const InsertLineOptions& options) {
    if (points.size() < 2) {
        throw InputError("insert_polyline: {} points; a line has at least 2", points.size());
    }
    std::vector<int> vertices;
    for (const Vector2& point : points) {
        vertices.push_back(insert_point(surface, parameters, point, options));
    }
    std::vector<int> path{vertices.front()};
    for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
        const std::size_t n_splits = surface.splits().size();
        const std::vector<int> part =
            insert_line(surface, parameters, vertices[i], vertices[i + 1], options);
        follow_splits(surface, n_splits, path);
        for (const int h : part) {
            path.push_back(surface.origin(h) == path.back() ? surface.target(h)
                                                            : surface.origin(h));
        }
    }
    std::vector<int> halfedges;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        halfedges.push_back(edge_of(surface, path[i], path[i + 1]));
    }
    return halfedges;
}

}  // namespace couture::meshing
