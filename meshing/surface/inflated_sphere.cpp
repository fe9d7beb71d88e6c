#include "meshing/surface/inflated_sphere.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include "iga/core/error.h"
#include "meshing/surface/cavity_center.h"
#include "meshing/surface/cube_sphere.h"

namespace couture::meshing {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest_default_hole = 0.02;
constexpr double default_radius = 0.9;

void require_positive(const char* what, double value) {
    if (!(value > 0.0) || !std::isfinite(value)) {
        throw InputError("inflate_sphere: {} is {}; it must be a positive number", what, value);
    }
}

void check(const TriangleSoup& wall, const InflationOptions& options) {
    if (wall.triangles.empty()) throw InputError("inflate_sphere: the wall has no triangles");
    const int n_points = static_cast<int>(wall.points.size());
    for (std::size_t t = 0; t < wall.triangles.size(); ++t) {
        for (const int v : wall.triangles[t]) {
            if (v >= 0 && v < n_points) continue;
            throw InputError("inflate_sphere: triangle {} has vertex {}; there are {} points", t, v,
                             n_points);
        }
    }
    for (std::size_t v = 0; v < wall.points.size(); ++v) {
        if (!wall.points[v].allFinite()) {
            throw InputError("inflate_sphere: point {} has coordinates that are not finite", v);
        }
    }
    if (options.center && !options.center->allFinite()) {
        throw InputError("inflate_sphere: the centre has coordinates that are not finite");
    }
    require_positive("the strain limit", options.strain_limit);
    if (options.radius) require_positive("the radius", *options.radius);
    if (options.hole_size) require_positive("the size of holes", *options.hole_size);
    if (options.outlet_strain_limit) {
        require_positive("the strain limit of outlets", *options.outlet_strain_limit);
    }
    for (const StrainRegion& region : options.regions) {
        require_positive("the strain limit of a region", region.strain_limit);
    }
}

TriangleTree make_tree(const TriangleSoup& wall) {
    std::vector<std::array<Vector3, 3>> triangles;
    for (const auto& [a, b, c] : wall.triangles) {
        triangles.push_back({wall.points[a], wall.points[b], wall.points[c]});
    }
    return TriangleTree(std::move(triangles));
}

double default_hole_size(const TriangleSoup& wall, double diagonal) {
    constexpr double part = 0.9;
    std::vector<double> lengths;
    for (const auto& triangle : wall.triangles) {
        for (int k = 0; k < 3; ++k) {
            lengths.push_back(
                (wall.points[triangle[k]] - wall.points[triangle[(k + 1) % 3]]).norm());
        }
    }
    const auto nth = lengths.begin() + static_cast<std::ptrdiff_t>(part * (lengths.size() - 1));
    std::ranges::nth_element(lengths, nth);
    return std::min(*nth, largest_default_hole * diagonal);
}

/// Where the sphere is dropped.
struct Start {
    Vector3 center = Vector3::Zero();
    double radius = 0.0;
};

Start find_start(const TriangleTree& wall, double ball_radius, const InflationOptions& options) {
    CavityPlace place;
    if (options.center) {
        place = {*options.center, std::sqrt(wall.nearest(*options.center).squared_distance)};
    } else if (const auto found = find_cavity_center(wall)) {
        place = *found;
    } else {
        throw GeometryError(
            "inflate_sphere: found no place from where three quarters of all directions meet the "
            "wall: it encloses no cavity. Give a centre, or close its openings");
    }
    const Vector3& c = place.position;
    const double radius = options.radius.value_or(default_radius * place.distance);
    if (radius + ball_radius > place.distance) {
        throw GeometryError(
            "inflate_sphere: the sphere at ({:g}, {:g}, {:g}) of radius {:g} is not inside: the "
            "wall is {:g} from its centre, and vertices are balls of radius {:g}. Take another "
            "centre, a smaller radius or smaller holes",
            c.x(), c.y(), c.z(), radius, place.distance, ball_radius);
    }
    return {c, radius};
}

std::vector<std::array<int, 2>> edges_of(const QuadMesh& mesh) {
    std::vector<std::array<int, 2>> edges;
    for (const auto& quad : mesh.quads) {
        for (int k = 0; k < 4; ++k) {
            // Each edge runs once in either direction.
            const int a = quad[k];
            const int b = quad[(k + 1) % 4];
            if (a < b) edges.push_back({a, b});
        }
    }
    return edges;
}

class Inflation {
  public:
    Inflation(const TriangleTree& wall, const Start& start, double ball_radius,
              const InflationOptions& options)
        : start_(start), options_(options), sphere_(make_cube_sphere(options.n_divisions)) {
        edges_ = edges_of(sphere_);
        edges_of_vertex_.resize(sphere_.points.size());
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            for (const int v : edges_[e]) edges_of_vertex_[v].push_back(static_cast<int>(e));
        }
        stopped_at_.assign(sphere_.points.size(), std::nullopt);
        stops_.assign(sphere_.points.size(), InflationStop::strain);
        for (const Vector3& direction : sphere_.points) {
            contacts_.push_back(contact_radius(wall, direction, ball_radius));
        }
    }

    void run() {
        for (std::size_t v = 0; v < contacts_.size(); ++v) {
            if (contacts_[v] < infinity) {
                events_.push({contacts_[v], Kind::contact, static_cast<int>(v), 0});
            }
        }
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            add_edge_event(static_cast<int>(e), start_.radius);
        }
        while (!events_.empty()) {
            const Event event = events_.top();
            events_.pop();
            if (event.kind == Kind::contact) {
                if (!stopped_at_[event.number]) {
                    stop(event.number, event.radius, InflationStop::contact);
                }
            } else if (event.n_moving == n_moving(event.number)) {
                for (const int v : edges_[event.number]) {
                    if (!stopped_at_[v]) stop(v, event.radius, InflationStop::strain);
                }
            }
        }
    }

    [[nodiscard]] InflatedSphere result() const {
        InflatedSphere result{.mesh = sphere_,
                              .center = start_.center,
                              .radius = start_.radius,
                              .stops = stops_,
                              .edges = edges_,
                              .strains = {},
                              .n_free = 0};
        for (std::size_t v = 0; v < sphere_.points.size(); ++v) {
            result.mesh.points[v] = start_.center + *stopped_at_[v] * sphere_.points[v];
        }
        for (const auto& [a, b] : edges_) {
            const double length = (result.mesh.points[a] - result.mesh.points[b]).norm();
            const double initial = start_.radius * (sphere_.points[a] - sphere_.points[b]).norm();
            result.strains.push_back(length / initial - 1.0);
        }
        result.n_free = static_cast<int>(std::ranges::count(contacts_, infinity));
        return result;
    }

    /// The smallest radius at which a vertex meets the wall.
    [[nodiscard]] double nearest_contact() const { return *std::ranges::min_element(contacts_); }

  private:
    enum class Kind { contact, strain };
    struct Event {
        double radius;
        Kind kind;
        /// Of a vertex or an edge.
        int number;
        /// Ends of the edge that still moved when this was computed.
        int n_moving;

        // The queue gives the largest first.
        bool operator<(const Event& other) const {
            return std::tie(other.radius, other.kind, other.number) <
                   std::tie(radius, kind, number);
        }
    };

    /// Where the vertex meets the wall: where its line does, if its ball, once it has touched the
    /// wall, does not leave it before, as it would behind a hole; else where its ball touches.
    [[nodiscard]] double contact_radius(const TriangleTree& wall, const Vector3& direction,
                                        double ball_radius) const {
        constexpr int n_samples = 8;
        const Vector3 from = start_.center + start_.radius * direction;
        const auto touch = wall.first_contact(from, direction, ball_radius);
        if (!touch) return infinity;
        const auto hit = wall.first_contact(from, direction, 0.0);
        bool is_wall = hit.has_value();
        for (int k = 1; k < n_samples && is_wall; ++k) {
            const Vector3 point = from + (*touch + (*hit - *touch) * k / n_samples) * direction;
            is_wall = wall.nearest(point).squared_distance <= ball_radius * ball_radius;
        }
        return start_.radius + (is_wall ? *hit : *touch);
    }

    void stop(int vertex, double radius, InflationStop why) {
        stopped_at_[vertex] = radius;
        stops_[vertex] = why;
        for (const int e : edges_of_vertex_[vertex]) add_edge_event(e, radius);
    }

    [[nodiscard]] int n_moving(int edge) const {
        return (stopped_at_[edges_[edge][0]] ? 0 : 1) + (stopped_at_[edges_[edge][1]] ? 0 : 1);
    }

    void add_edge_event(int edge, double radius) {
        const int n = n_moving(edge);
        if (n > 0) events_.push({limit_radius(edge, radius), Kind::strain, edge, n});
    }

    /// The radius from which the edge is longer than `strain` allows.
    [[nodiscard]] double radius_at(int edge, double strain) const {
        auto [a, b] = edges_[edge];
        const double chord = (sphere_.points[a] - sphere_.points[b]).norm();
        const double length = (1.0 + strain) * start_.radius * chord;
        if (n_moving(edge) == 2) return length / chord;
        if (stopped_at_[b]) std::swap(a, b);
        // R^2 + S^2 - 2 R S cos = length^2, the end at S being at rest.
        const double S = *stopped_at_[a];
        const double cosine = sphere_.points[a].dot(sphere_.points[b]);
        const double height = S * sphere_.points[a].cross(sphere_.points[b]).norm();
        if (length < height) return -infinity;
        return S * cosine + std::sqrt(length * length - height * height);
    }

    /// Of the middle of an edge.
    [[nodiscard]] Path path_of(int edge) const {
        Path path{start_.center, Vector3::Zero()};
        for (const int v : edges_[edge]) {
            if (stopped_at_[v]) {
                path.base += 0.5 * *stopped_at_[v] * sphere_.points[v];
            } else {
                path.direction += 0.5 * sphere_.points[v];
            }
        }
        return path;
    }

    [[nodiscard]] double limit_at(int edge, const Vector3& middle) const {
        for (const StrainRegion& region : options_.regions) {
            if (contains(region.shape, middle)) return region.strain_limit;
        }
        const auto [a, b] = edges_[edge];
        const bool is_outlet = contacts_[a] == infinity || contacts_[b] == infinity;
        return is_outlet ? options_.outlet_strain_limit.value_or(options_.strain_limit)
                         : options_.strain_limit;
    }

    /// The first radius from this one on at which the edge is at the limit of where it is.
    [[nodiscard]] double limit_radius(int edge, double radius) const {
        const Path path = path_of(edge);
        std::vector<double> borders{radius};
        for (const StrainRegion& region : options_.regions) {
            if (const auto inside = time_inside(region.shape, path)) {
                for (const double border : *inside) {
                    if (border > radius && border < infinity) borders.push_back(border);
                }
            }
        }
        std::ranges::sort(borders);
        for (std::size_t i = 0; i < borders.size(); ++i) {
            const bool is_last = i + 1 == borders.size();
            const double end = is_last ? infinity : borders[i + 1];
            const double sample = is_last ? borders[i] + start_.radius : 0.5 * (borders[i] + end);
            const double limit = limit_at(edge, path.base + sample * path.direction);
            const double reached = std::max(borders[i], radius_at(edge, limit));
            if (reached <= end) return reached;
        }
        return infinity;
    }

    Start start_;
    const InflationOptions& options_;
    /// Points are directions.
    QuadMesh sphere_;
    std::vector<std::array<int, 2>> edges_;
    std::vector<std::vector<int>> edges_of_vertex_;
    /// Distance from the centre at which each vertex meets the wall; infinity if it never does.
    std::vector<double> contacts_;
    std::vector<std::optional<double>> stopped_at_;
    std::vector<InflationStop> stops_;
    std::priority_queue<Event> events_;
};

}  // namespace

int InflatedSphere::n_contacts() const {
    return static_cast<int>(std::ranges::count(stops, InflationStop::contact));
}

double InflatedSphere::max_strain() const { return *std::ranges::max_element(strains); }

InflatedSphere inflate_sphere(const TriangleSoup& wall, const InflationOptions& options) {
    check(wall, options);
    const TriangleTree tree = make_tree(wall);
    const auto [low, high] = tree.box();
    const double ball_radius =
        0.5 * options.hole_size.value_or(default_hole_size(wall, (high - low).norm()));
    if (!(ball_radius > 0.0)) {
        throw GeometryError("inflate_sphere: the triangles of the wall are points; there is none");
    }
    const Start start = find_start(tree, ball_radius, options);
    Inflation inflation(tree, start, ball_radius, options);
    inflation.run();
    InflatedSphere result = inflation.result();
    if (result.n_contacts() > 0) return result;
    const Vector3& c = start.center;
    if (result.n_free == static_cast<int>(result.stops.size())) {
        throw GeometryError(
            "inflate_sphere: from ({:g}, {:g}, {:g}) no vertex meets the wall; the centre must lie "
            "inside",
            c.x(), c.y(), c.z());
    }
    throw GeometryError(
        "inflate_sphere: from ({:g}, {:g}, {:g}) all vertices were held by strained edges before "
        "any met the wall; the nearest one would do so at radius {:g}, strained by {:.3g}. Raise "
        "the strain limit above, or begin with a larger radius",
        c.x(), c.y(), c.z(), inflation.nearest_contact(),
        inflation.nearest_contact() / start.radius - 1.0);
}

}  // namespace couture::meshing
