#include "meshing/surface/harmonic_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "meshing/surface/divided_map.h"
#include "meshing/surface/predicates.h"

namespace couture::meshing {

namespace {

// The boundary of a disc from its first corner on, divided into sides.
struct Sides {
    std::vector<int> halfedges;
    // For each halfedge.
    std::vector<int> side;
    // First halfedge of each side, and their number.
    std::vector<std::size_t> begin;
};

std::vector<int> disc_boundary(const CutSurface& disc, const char* who) {
    const auto loops = disc.boundary_loops();
    const auto components = disc.face_components();
    const int n_components =
        components.empty() ? 0 : *std::max_element(components.begin(), components.end()) + 1;
    if (n_components != 1 || loops.size() != 1 || disc.euler_characteristic() != 1) {
        throw TopologyError(
            "{}: the piece has {} components, {} boundaries and Euler characteristic {}; a disc "
            "has 1, 1 and 1: cut it open first",
            who, n_components, loops.size(), disc.euler_characteristic());
    }
    return loops.front();
}

Sides divide_boundary(const CutSurface& disc, std::span<const int> corners, const char* who) {
    const std::vector<int> loop = disc_boundary(disc, who);
    const std::size_t n = loop.size();
    std::vector<int> position(disc.n_vertices(), -1);
    for (std::size_t i = 0; i < n; ++i) position[disc.origin(loop[i])] = static_cast<int>(i);
    for (std::size_t k = 0; k < corners.size(); ++k) {
        if (corners[k] < 0 || corners[k] >= disc.n_vertices() || position[corners[k]] < 0) {
            throw InputError(
                "{}: corner {} is vertex {}, which does not lie on the boundary; corners are "
                "boundary vertices",
                who, k, corners[k]);
        }
    }
    const std::size_t start = position[corners.front()];
    std::vector<std::size_t> begin;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        begin.push_back((position[corners[k]] + n - start) % n);
        if (k > 0 && begin[k] <= begin[k - 1]) {
            throw InputError(
                "{}: corner {} (vertex {}) does not follow corner {} (vertex {}) along the "
                "boundary; name different vertices counter-clockwise, with the surface on the left",
                who, k, corners[k], k - 1, corners[k - 1]);
        }
    }
    begin.push_back(n);
    Sides sides;
    sides.begin = begin;
    for (std::size_t k = 0; k + 1 < begin.size(); ++k) {
        for (std::size_t i = begin[k]; i < begin[k + 1]; ++i) {
            sides.halfedges.push_back(loop[(start + i) % n]);
            sides.side.push_back(static_cast<int>(k));
        }
    }
    for (const int h : sides.halfedges) {
        if (!(disc.length(h) > 0.0)) {
            throw GeometryError(
                "{}: the boundary edge from vertex {} to {} has no length, so that both would "
                "share a parameter; merge them first",
                who, disc.origin(h), disc.target(h));
        }
    }
    return sides;
}

void check_convex(std::span<const Vector2> polygon, std::size_t n_corners, const char* who) {
    const std::size_t n = polygon.size();
    if (n < 3 || n_corners != n) {
        throw InputError(
            "{}: {} corners for a polygon of {}; there must be as many, and at least 3", who,
            n_corners, n);
    }
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t next = (k + 1) % n;
        if (orientation(polygon[k], polygon[next], polygon[(k + 2) % n]) <= 0 ||
            (k > 0 && next > 0 && orientation(polygon[0], polygon[k], polygon[next]) <= 0)) {
            throw InputError(
                "{}: the polygon does not turn left at its corner {} = ({}, {}); it must be "
                "strictly convex and counter-clockwise",
                who, next, polygon[next].x(), polygon[next].y());
        }
    }
}

// Lengths along a side at the start of each of its halfedges, and in all, over the whole length.
std::vector<double> arc_fractions(const CutSurface& disc, std::span<const int> halfedges) {
    std::vector<double> fractions{0.0};
    for (const int h : halfedges) fractions.push_back(fractions.back() + disc.length(h));
    for (double& fraction : fractions) fraction /= fractions.back();
    fractions.back() = 1.0;
    return fractions;
}

std::span<const int> side_of(const Sides& sides, std::size_t k) {
    return std::span(sides.halfedges).subspan(sides.begin[k], sides.begin[k + 1] - sides.begin[k]);
}

// Splits the chords that join two vertices of one side, of those sides that `is_straight` takes;
// finds the sides anew, since splits move edges of the boundary to other halfedges. Returns the
// number of splits.
template <typename IsStraight>
int split_chords_of_sides(CutSurface& disc, Sides& sides, std::span<const int> corners,
                          const IsStraight& is_straight, const char* who) {
    std::vector<std::array<int, 2>> sides_of(disc.n_vertices(), {-1, -1});
    for (std::size_t i = 0; i < sides.halfedges.size(); ++i) {
        if (!is_straight(sides.side[i])) continue;
        sides_of[disc.origin(sides.halfedges[i])][0] = sides.side[i];
        sides_of[disc.target(sides.halfedges[i])][1] = sides.side[i];
    }
    const auto share_side = [&](int u, int v) {
        if (static_cast<std::size_t>(std::max(u, v)) >= sides_of.size()) return false;
        for (const int side : sides_of[u]) {
            if (side >= 0 && (side == sides_of[v][0] || side == sides_of[v][1])) return true;
        }
        return false;
    };
    const std::size_t n_before = disc.splits().size();
    for (int h = 0; h < disc.n_halfedges(); ++h) {
        if (disc.twin(h) >= 0 && share_side(disc.origin(h), disc.target(h))) disc.split_edge(h);
    }
    sides = divide_boundary(disc, corners, who);
    return static_cast<int>(disc.splits().size() - n_before);
}

struct Triangulation {
    std::vector<std::array<int, 3>> triangles;
    std::vector<Vector3> points;
    explicit Triangulation(const CutSurface& surface) {
        for (int f = 0; f < surface.n_faces(); ++f) triangles.push_back(surface.triangle(f));
        for (int v = 0; v < surface.n_vertices(); ++v) points.push_back(surface.point(v));
    }
};

std::vector<Vector2> to_parameters(const MatrixX& values) {
    std::vector<Vector2> parameters(values.rows());
    for (Eigen::Index v = 0; v < values.rows(); ++v) parameters[v] = values.row(v).transpose();
    return parameters;
}

int n_flipped(const CutSurface& disc, const std::vector<Vector2>& parameters) {
    return static_cast<int>(flipped_triangles(disc, parameters).size());
}

// Inner parameters for a boundary that is in place, by the routes in turn.
HarmonicMap map_inside(const CutSurface& disc, const Sides& sides,
                       const std::vector<Vector2>& boundary, const HarmonicMapOptions& options,
                       HarmonicMapReport report, const char* who) {
    HarmonicMap map{boundary, report};
    const Triangulation triangulation(disc);
    HarmonicProblem problem;
    problem.triangles = triangulation.triangles;
    problem.points = triangulation.points;
    problem.is_fixed.assign(disc.n_vertices(), 0);
    problem.values = MatrixX::Zero(disc.n_vertices(), 2);
    for (const int h : sides.halfedges) {
        problem.is_fixed[disc.origin(h)] = 1;
        problem.values.row(disc.origin(h)) = boundary[disc.origin(h)].transpose();
    }
    const auto attempt = [&](HarmonicWeights weights) {
        problem.weights = weights;
        const HarmonicSolution solution = solve_harmonic(problem);
        map.report.residual = std::max(map.report.residual, solution.residual);
        map.parameters = to_parameters(solution.values);
        return n_flipped(disc, map.parameters);
    };
    const auto finish = [&](MapRoute route) {
        map.report.route = route;
        map.report.distortion = map_distortion(disc, map.parameters);
        return std::move(map);
    };
    if (options.weights == HarmonicWeights::mean_value) {
        map.report.n_flipped_mean_value = attempt(HarmonicWeights::mean_value);
        if (map.report.n_flipped_mean_value == 0) return finish(MapRoute::mean_value);
    }
    map.report.n_flipped_uniform = attempt(HarmonicWeights::uniform);
    if (map.report.n_flipped_uniform == 0) return finish(MapRoute::uniform);
    map.report.n_divisions = map_by_division(disc, sides.halfedges, sides.side, map.parameters);
    const std::vector<int> flipped = flipped_triangles(disc, map.parameters);
    if (!flipped.empty()) {
        const int f = flipped.front();
        const auto [a, b, c] = disc.triangle(f);
        throw GeometryError(
            "{}: {} triangles are flipped after mean value weights ({}), uniform weights ({}) and "
            "{} divisions, first triangle {} (vertices {}, {}, {}); refine the surface there, or "
            "cut it into rounder pieces",
            who, flipped.size(), map.report.n_flipped_mean_value, map.report.n_flipped_uniform,
            map.report.n_divisions, f, a, b, c);
    }
    return finish(MapRoute::divided);
}

// Multiples of this have sums below 4 width without rounding.
double quantum_of(double width) { return std::ldexp(1.0, std::ilogb(width) - 40); }

double rounded(double value, double quantum) { return std::round(value / quantum) * quantum; }

// Throws unless the right side of a seam, upwards, has the points of the left one, downwards.
void check_seam(const CutSurface& disc, std::span<const int> right, std::span<const int> left,
                const char* who) {
    bool is_matching = right.size() == left.size();
    for (std::size_t i = 0; is_matching && i <= right.size(); ++i) {
        const std::size_t n = left.size();
        const int a = i < n ? disc.target(left[n - 1 - i]) : disc.origin(left.front());
        const int b = i < n ? disc.origin(right[i]) : disc.target(right.back());
        is_matching = disc.point(a) == disc.point(b);
    }
    if (!is_matching) {
        throw GeometryError(
            "{}: the sides of the seam, {} edges from vertex {} and {} edges to vertex {}, don't "
            "match point by point; name the corners as they were returned when the piece was "
            "opened, and split no seam edge after it",
            who, right.size(), disc.origin(right.front()), left.size(), disc.target(left.back()));
    }
}

// Both copies of each vertex of an opened annulus' seam, the one on the left side of the rectangle
// first; upwards, ends included.
std::vector<std::pair<int, int>> matching_seam(const CutSurface& disc, const Sides& sides,
                                               const char* who) {
    const auto right = side_of(sides, 1);
    const auto left = side_of(sides, 3);
    check_seam(disc, right, left, who);
    std::vector<std::pair<int, int>> seam;
    for (std::size_t i = 0; i < right.size(); ++i) {
        seam.emplace_back(disc.target(left[left.size() - 1 - i]), disc.origin(right[i]));
    }
    seam.emplace_back(disc.origin(left.front()), disc.target(right.back()));
    return seam;
}

// An opened annulus' lower and upper side in place; zero elsewhere, but for the corners.
std::vector<Vector2> parameters_of_ends(const CutSurface& disc, const Sides& sides, double width,
                                        double height) {
    const std::vector<Vector2> rectangle = rectangle_corners(width, height);
    std::vector<Vector2> parameters(disc.n_vertices(), Vector2::Zero());
    for (const std::size_t k : {0U, 2U}) {
        const auto side = side_of(sides, k);
        const std::vector<double> fractions = arc_fractions(disc, side);
        for (std::size_t i = 0; i < side.size(); ++i) {
            parameters[disc.origin(side[i])] =
                rectangle[k] + fractions[i] * (rectangle[k + 1] - rectangle[k]);
        }
        parameters[disc.target(side.back())] = rectangle[k + 1];
    }
    return parameters;
}

// An opened annulus with its seam on straight sides.
AnnulusMap map_straight(CutSurface& disc, const std::array<int, 4>& corners, double width,
                        double height, const HarmonicMapOptions& options, HarmonicMapReport report,
                        const char* who) {
    Sides sides = divide_boundary(disc, corners, who);
    report.n_split_chords += split_chords_of_sides(
        disc, sides, corners, [](int) { return true; }, who);
    const auto seam = matching_seam(disc, sides, who);
    std::vector<Vector2> parameters = parameters_of_ends(disc, sides, width, height);
    const std::vector<double> heights = arc_fractions(disc, side_of(sides, 1));
    for (std::size_t i = 0; i < seam.size(); ++i) {
        parameters[seam[i].first] = {0.0, heights[i] * height};
        parameters[seam[i].second] = {width, heights[i] * height};
    }
    return {map_inside(disc, sides, parameters, options, report, who), width, false};
}

}  // namespace

std::vector<Vector2> square_corners() { return rectangle_corners(1.0, 1.0); }

std::vector<Vector2> rectangle_corners(double width, double height) {
    if (!(width > 0.0 && height > 0.0 && std::isfinite(width) && std::isfinite(height))) {
        throw InputError("rectangle_corners: width {} and height {}; both must be positive", width,
                         height);
    }
    return {{0.0, 0.0}, {width, 0.0}, {width, height}, {0.0, height}};
}

std::vector<Vector2> regular_polygon_corners(int n) {
    if (n < 3) throw InputError("regular_polygon_corners: {} corners; there must be 3 or more", n);
    std::vector<Vector2> corners;
    for (int k = 0; k < n; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / n;
        corners.emplace_back(std::cos(angle), std::sin(angle));
    }
    return corners;
}

HarmonicMap map_disc_to_polygon(CutSurface& disc, std::span<const int> corners,
                                std::span<const Vector2> polygon,
                                const HarmonicMapOptions& options) {
    const char* who = "map_disc_to_polygon";
    check_convex(polygon, corners.size(), who);
    Sides sides = divide_boundary(disc, corners, who);
    HarmonicMapReport report;
    report.n_split_chords = split_chords_of_sides(
        disc, sides, corners, [](int) { return true; }, who);
    std::vector<Vector2> parameters(disc.n_vertices(), Vector2::Zero());
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const auto side = side_of(sides, k);
        const std::vector<double> fractions = arc_fractions(disc, side);
        const Vector2& start = polygon[k];
        const Vector2& end = polygon[(k + 1) % polygon.size()];
        for (std::size_t i = 0; i < side.size(); ++i) {
            const double t = fractions[i];
            parameters[disc.origin(side[i])] = start + t * (end - start);
        }
    }
    return map_inside(disc, sides, parameters, options, report, who);
}

HarmonicMap map_disc_to_circle(CutSurface& disc, int start, const HarmonicMapOptions& options) {
    const char* who = "map_disc_to_circle";
    const std::array corners{start};
    Sides sides = divide_boundary(disc, corners, who);
    const std::vector<double> fractions = arc_fractions(disc, sides.halfedges);
    std::vector<Vector2> parameters(disc.n_vertices(), Vector2::Zero());
    for (std::size_t i = 0; i < sides.halfedges.size(); ++i) {
        const double angle = 2.0 * std::numbers::pi * fractions[i];
        parameters[disc.origin(sides.halfedges[i])] = {std::cos(angle), std::sin(angle)};
        // Every edge is a side of its own.
        sides.side[i] = static_cast<int>(i);
    }
    return map_inside(disc, sides, parameters, options, {}, who);
}

std::array<int, 4> open_annulus(CutSurface& annulus, std::span<const int> path) {
    const auto loops = annulus.boundary_loops();
    if (loops.size() != 2 || annulus.euler_characteristic() != 0) {
        throw TopologyError(
            "open_annulus: the piece has {} boundaries and Euler characteristic {}; an annulus has "
            "2 and 0",
            loops.size(), annulus.euler_characteristic());
    }
    std::vector<int> loop_of(annulus.n_vertices(), -1);
    for (std::size_t i = 0; i < loops.size(); ++i) {
        for (const int h : loops[i]) loop_of[annulus.origin(h)] = static_cast<int>(i);
    }
    const auto describe = [&](int v) {
        return fmt::format(
            "vertex {} on {}", v,
            loop_of[v] < 0 ? std::string("no boundary") : fmt::format("boundary {}", loop_of[v]));
    };
    if (path.empty()) throw TopologyError("open_annulus: the path is empty");
    const int start = annulus.origin(path.front());
    const int end = annulus.target(path.back());
    if (loop_of[start] < 0 || loop_of[end] < 0 || loop_of[start] == loop_of[end]) {
        throw TopologyError(
            "open_annulus: the path runs from {} to {}; it must join the two boundaries",
            describe(start), describe(end));
    }
    std::vector<char> is_met(annulus.n_vertices(), 0);
    for (std::size_t i = 0; i < path.size(); ++i) {
        const int v = annulus.origin(path[i]);
        const bool is_joined = i == 0 || annulus.target(path[i - 1]) == v;
        if (!is_joined || annulus.twin(path[i]) < 0 || is_met[v] != 0 ||
            (i > 0 && loop_of[v] >= 0)) {
            throw TopologyError(
                "open_annulus: halfedge {} of the path (from vertex {}) {}; the path must be "
                "simple, joined and inside but for its ends",
                i, v,
                !is_joined                  ? "does not start where the one before it ends"
                : annulus.twin(path[i]) < 0 ? "lies on the boundary"
                : is_met[v] != 0            ? "returns to a vertex"
                                            : "touches a boundary");
        }
        is_met[v] = 1;
    }
    // The path's own halfedges end up on the right-hand side of the rectangle, their twins on the
    // left-hand side.
    const int first_twin = annulus.twin(path.front());
    const int last_twin = annulus.twin(path.back());
    annulus.slice(path);
    return {annulus.target(first_twin), annulus.origin(path.front()), annulus.target(path.back()),
            annulus.origin(last_twin)};
}

AnnulusMap map_opened_annulus(CutSurface& disc, const std::array<int, 4>& corners, double width,
                              double height, bool is_periodic, const HarmonicMapOptions& options) {
    const char* who = "map_opened_annulus";
    if (!is_periodic) return map_straight(disc, corners, width, height, options, {}, who);
    const double quantum = quantum_of(width);
    const double period = rounded(width, quantum);
    Sides sides = divide_boundary(disc, corners, who);
    HarmonicMapReport report;
    report.n_split_chords = split_chords_of_sides(
        disc, sides, corners, [](int side) { return side % 2 == 0; }, who);
    const auto seam = matching_seam(disc, sides, who);
    const std::vector<Vector2> ends = parameters_of_ends(disc, sides, period, height);

    const Triangulation triangulation(disc);
    HarmonicProblem problem;
    problem.triangles = triangulation.triangles;
    problem.points = triangulation.points;
    problem.weights = options.weights;
    problem.is_fixed.assign(disc.n_vertices(), 0);
    problem.values = MatrixX::Zero(disc.n_vertices(), 2);
    problem.original.resize(disc.n_vertices());
    problem.jump = Vector2(period, 0.0);
    for (const std::size_t k : {0U, 2U}) {
        for (const int h : side_of(sides, k)) problem.is_fixed[disc.origin(h)] = 1;
    }
    for (int v = 0; v < disc.n_vertices(); ++v) {
        problem.values.row(v) = ends[v].transpose();
        problem.original[v] = v;
    }
    for (const auto& [original, copy] : seam) {
        problem.original[copy] = original;
        problem.is_fixed[copy] = 0;
    }
    problem.is_fixed[corners[3]] = 1;

    const HarmonicSolution solution = solve_harmonic(problem);
    report.residual = solution.residual;
    std::vector<Vector2> parameters = to_parameters(solution.values);
    for (const auto& [original, copy] : seam) {
        parameters[original].x() = rounded(parameters[original].x(), quantum);
        parameters[copy] = parameters[original] + Vector2(period, 0.0);
    }
    const int n = n_flipped(disc, parameters);
    if (n > 0) return map_straight(disc, corners, period, height, options, report, who);
    const bool is_mean_value = options.weights == HarmonicWeights::mean_value;
    (is_mean_value ? report.n_flipped_mean_value : report.n_flipped_uniform) = 0;
    report.route = is_mean_value ? MapRoute::mean_value : MapRoute::uniform;
    report.distortion = map_distortion(disc, parameters);
    return {{std::move(parameters), report}, period, true};
}

HarmonicMap map_opened_pant(CutSurface& disc, const std::array<int, 8>& corners, double width,
                            double height, const HarmonicMapOptions& options) {
    const char* who = "map_opened_pant";
    // Chords within a straight side of the rectangle are those to split.
    const std::array outline{corners[0], corners[1], corners[4], corners[5]};
    Sides straight = divide_boundary(disc, outline, who);
    HarmonicMapReport report;
    report.n_split_chords = split_chords_of_sides(
        disc, straight, outline, [](int) { return true; }, who);
    const Sides sides = divide_boundary(disc, corners, who);
    // Each side part on the right has its like on the left.
    std::array<double, 4> heights{};
    for (int k = 1; k <= 3; ++k) {
        const auto right = side_of(sides, k);
        const auto left = side_of(sides, 8 - k);
        double length = 0.0;
        for (const int h : right) length += 0.5 * disc.length(h);
        for (const int h : left) length += 0.5 * disc.length(h);
        heights[k] = heights[k - 1] + length;
        if (k != 2) check_seam(disc, right, left, who);
    }
    for (double& y : heights) y *= height / heights[3];
    heights[3] = height;
    std::vector<Vector2> outline_points = rectangle_corners(width, height);
    const std::array<Vector2, 9> ends{
        outline_points[0],          outline_points[1],        Vector2(width, heights[1]),
        Vector2(width, heights[2]), outline_points[2],        outline_points[3],
        Vector2(0.0, heights[2]),   Vector2(0.0, heights[1]), outline_points[0]};
    std::vector<Vector2> parameters(disc.n_vertices(), Vector2::Zero());
    for (int k = 0; k < 8; ++k) {
        const auto side = side_of(sides, k);
        const std::vector<double> fractions = arc_fractions(disc, side);
        for (std::size_t i = 0; i < side.size(); ++i) {
            parameters[disc.origin(side[i])] = ends[k] + fractions[i] * (ends[k + 1] - ends[k]);
        }
    }
    // Both copies of a seam vertex at the same height, to the last bit.
    for (const int k : {1, 3}) {
        const auto right = side_of(sides, k);
        const auto left = side_of(sides, 8 - k);
        for (std::size_t i = 1; i < right.size(); ++i) {
            parameters[disc.origin(left[left.size() - i])].y() =
                parameters[disc.origin(right[i])].y();
        }
    }
    return map_inside(disc, straight, parameters, options, report, who);
}

}  // namespace couture::meshing
