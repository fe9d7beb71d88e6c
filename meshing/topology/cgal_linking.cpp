#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "iga/core/error.h"
#include "meshing/topology/linking.h"

namespace couture::meshing {

namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel::FT;

// The mean of up to three mesh points, moved by an infinitesimal `push`.
struct LoopPoint {
    std::array<int, 3> vertices{-1, -1, -1};
    int n = 0;
    bool is_pushed = false;
    Vector3 push = Vector3::Zero();
    // Rounded.
    Vector3 value = Vector3::Zero();
};

struct Segment {
    int loop;
    LoopPoint a;
    LoopPoint b;
    // Box in the projection.
    double low[2];
    double high[2];
};

template <typename T>
using Triple = std::array<T, 3>;

template <typename T>
T determinant_of(const Triple<T>& a, const Triple<T>& b, const Triple<T>& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

template <typename T>
Triple<T> minus(const Triple<T>& a, const Triple<T>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// Signs of the determinants that tell how two segments cross when seen along a direction.
class CrossingSigns {
  public:
    CrossingSigns(const CutSurface& surface, const Vector3& direction)
        : surface_(surface), direction_(direction) {
        for (int v = 0; v < surface.n_vertices(); ++v) {
            largest_ = std::max(largest_, surface.point(v).cwiseAbs().maxCoeff());
        }
    }

    // Sign of det(direction, q - p, r - p).
    [[nodiscard]] int turn(const LoopPoint& p, const LoopPoint& q, const LoopPoint& r) const {
        const Vector3 u = q.value - p.value;
        const Vector3 v = r.value - p.value;
        const double value = direction_.dot(u.cross(v));
        if (std::abs(value) > bound(u.norm(), v.norm())) return value > 0.0 ? 1 : -1;
        return first_order(p, q, r, [&](const auto& a, const auto& b, const auto& c) {
            return determinant_of(exact(direction_), minus(b, a), minus(c, a));
        });
    }
    // Sign of det(direction, b - a, d - c).
    [[nodiscard]] int sense(const Segment& ab, const Segment& cd) const {
        const Vector3 u = ab.b.value - ab.a.value;
        const Vector3 v = cd.b.value - cd.a.value;
        const double value = direction_.dot(u.cross(v));
        if (std::abs(value) > bound(u.norm(), v.norm())) return value > 0.0 ? 1 : -1;
        const auto base = minus(exact(ab.b), exact(ab.a));
        return first_order(cd.a, cd.b, cd.b, [&](const auto& c, const auto& d, const auto&) {
            return determinant_of(exact(direction_), base, minus(d, c));
        });
    }
    // Sign of det(c - a, b - a, d - c).
    [[nodiscard]] int volume(const Segment& ab, const Segment& cd) const {
        const Vector3 u = cd.a.value - ab.a.value;
        const Vector3 v = ab.b.value - ab.a.value;
        const Vector3 w = cd.b.value - cd.a.value;
        const double value = u.dot(v.cross(w));
        const double error = bound(v.norm(), w.norm()) * (u.norm() + v.norm() + w.norm()) +
                             rounding * largest_ * v.norm() * w.norm();
        if (std::abs(value) > error) return value > 0.0 ? 1 : -1;
        const auto start = exact(ab.a);
        const auto base = minus(exact(ab.b), start);
        return first_order(cd.a, cd.b, cd.b, [&](const auto& c, const auto& d, const auto&) {
            return determinant_of(minus(c, start), base, minus(d, c));
        });
    }

  private:
    // Far above the rounding of a few sums and products.
    static constexpr double rounding = 1e-14;

    [[nodiscard]] double bound(double u, double v) const {
        return rounding * (largest_ * (u + v) + u * v);
    }
    static Triple<Exact> exact(const Vector3& v) { return {Exact(v[0]), Exact(v[1]), Exact(v[2])}; }
    [[nodiscard]] Triple<Exact> exact(const LoopPoint& point) const {
        Triple<Exact> sum{Exact(0), Exact(0), Exact(0)};
        for (int k = 0; k < point.n; ++k) {
            const auto vertex = exact(surface_.point(point.vertices[k]));
            for (int i = 0; i < 3; ++i) sum[i] += vertex[i];
        }
        for (auto& x : sum) x /= point.n;
        return sum;
    }
    // Sign of a function of three points that is affine in the one that is pushed.
    template <typename Function>
    [[nodiscard]] int first_order(const LoopPoint& p, const LoopPoint& q, const LoopPoint& r,
                                  const Function& value) const {
        const auto a = exact(p);
        const auto b = exact(q);
        const auto c = exact(r);
        const Exact at_rest = value(a, b, c);
        const auto sign = [](const Exact& x) { return static_cast<int>(CGAL::sign(x)); };
        if (sign(at_rest) != 0) return sign(at_rest);
        const auto moved = [&](const LoopPoint& point, Triple<Exact> x) {
            const auto push = exact(point.push);
            for (int i = 0; point.is_pushed && i < 3; ++i) x[i] += push[i];
            return x;
        };
        return sign(value(moved(p, a), moved(q, b), moved(r, c)) - at_rest);
    }

    const CutSurface& surface_;
    Vector3 direction_;
    double largest_ = 0.0;
};

LoopPoint mean_of(const CutSurface& surface, std::initializer_list<int> vertices) {
    LoopPoint point;
    for (const int v : vertices) {
        point.vertices[point.n++] = v;
        point.value += surface.point(v);
    }
    point.value /= point.n;
    return point;
}

Vector3 unit_normal(const CutSurface& surface, int face) {
    const auto [a, b, c] = surface.triangle(face);
    const Vector3 normal =
        (surface.point(b) - surface.point(a)).cross(surface.point(c) - surface.point(a));
    const double norm = normal.norm();
    return norm > 0.0 ? Vector3(normal / norm) : Vector3::Zero();
}

std::vector<Segment> primal_segments(const HomologyBasis& basis) {
    const CutSurface& surface = basis.annotated.surface;
    std::vector<Segment> segments;
    for (std::size_t i = 0; i < basis.loops.size(); ++i) {
        for (const int h : basis.loops[i]) {
            segments.push_back({.loop = static_cast<int>(i),
                                .a = mean_of(surface, {surface.origin(h)}),
                                .b = mean_of(surface, {surface.target(h)}),
                                .low = {},
                                .high = {}});
        }
    }
    return segments;
}

std::vector<Segment> dual_segments(const HomologyBasis& basis) {
    const CutSurface& surface = basis.annotated.surface;
    std::vector<Segment> segments;
    for (std::size_t j = 0; j < basis.dual_loops.size(); ++j) {
        for (const int h : basis.dual_loops[j]) {
            const int from = CutSurface::face(h);
            const int to = CutSurface::face(surface.twin(h));
            const auto centre = [&](int face) {
                const auto [a, b, c] = surface.triangle(face);
                return mean_of(surface, {a, b, c});
            };
            LoopPoint middle = mean_of(surface, {surface.origin(h), surface.target(h)});
            if (h == basis.dual_loops[j].front()) {
                middle.is_pushed = true;
                middle.push = unit_normal(surface, from) + unit_normal(surface, to);
            }
            const auto add = [&](const LoopPoint& a, const LoopPoint& b) {
                segments.push_back(
                    {.loop = static_cast<int>(j), .a = a, .b = b, .low = {}, .high = {}});
            };
            add(centre(from), middle);
            add(middle, centre(to));
        }
    }
    return segments;
}

// Boxes in a plane across the direction.
void find_boxes(std::vector<Segment>& segments, const Vector3& u, const Vector3& v, double margin) {
    for (Segment& segment : segments) {
        const Vector3* axes[2] = {&u, &v};
        for (int k = 0; k < 2; ++k) {
            const double a = axes[k]->dot(segment.a.value);
            const double b = axes[k]->dot(segment.b.value);
            segment.low[k] = std::min(a, b) - margin;
            segment.high[k] = std::max(a, b) + margin;
        }
    }
}

// The linking numbers seen along a direction; nothing if it is not in general position.
std::optional<IntegerMatrix> linking_matrix(const HomologyBasis& basis,
                                            std::vector<Segment>& primal,
                                            std::vector<Segment>& dual, const Vector3& direction) {
    const CrossingSigns signs(basis.annotated.surface, direction);
    const Vector3 u = direction.unitOrthogonal();
    const Vector3 v = direction.cross(u);
    double largest = 0.0;
    for (int i = 0; i < basis.annotated.surface.n_vertices(); ++i) {
        largest = std::max(largest, basis.annotated.surface.point(i).norm());
    }
    find_boxes(primal, u, v, 1e-13 * largest);
    find_boxes(dual, u, v, 1e-13 * largest);
    std::sort(dual.begin(), dual.end(),
              [](const Segment& a, const Segment& b) { return a.low[0] < b.low[0]; });
    double widest = 0.0;
    for (const Segment& cd : dual) widest = std::max(widest, cd.high[0] - cd.low[0]);

    IntegerMatrix linking(basis.loops.size(), std::vector<long long>(basis.loops.size(), 0));
    for (const Segment& ab : primal) {
        auto cd = std::lower_bound(
            dual.begin(), dual.end(), ab.low[0] - widest,
            [](const Segment& segment, double low) { return segment.low[0] < low; });
        for (; cd != dual.end() && cd->low[0] <= ab.high[0]; ++cd) {
            if (cd->high[0] < ab.low[0] || cd->high[1] < ab.low[1] || cd->low[1] > ab.high[1]) {
                continue;
            }
            const int at_c = signs.turn(ab.a, ab.b, cd->a);
            const int at_d = signs.turn(ab.a, ab.b, cd->b);
            if (at_c == 0 || at_d == 0) return std::nullopt;
            if (at_c == at_d) continue;
            const int at_a = signs.turn(ab.a, cd->a, cd->b);
            const int at_b = signs.turn(ab.b, cd->a, cd->b);
            if (at_a == 0 || at_b == 0) return std::nullopt;
            if (at_a == at_b) continue;
            const int sense = signs.sense(ab, *cd);
            const int volume = signs.volume(ab, *cd);
            if (sense == 0 || volume == 0) return std::nullopt;
            // The first one lies above the second.
            if (volume * sense < 0) linking[ab.loop][cd->loop] += sense;
        }
    }
    return linking;
}

}  // namespace

IntegerMatrix linking_projector(const HomologyBasis& basis) {
    if (basis.genus == 0) return {};
    std::vector<Segment> primal = primal_segments(basis);
    std::vector<Segment> dual = dual_segments(basis);
    std::mt19937 random(12345);
    constexpr int n_tries = 20;
    std::optional<IntegerMatrix> linking;
    for (int i = 0; i < n_tries && !linking; ++i) {
        // mt19937 gives the same numbers everywhere, distributions don't.
        const auto coordinate = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
        Vector3 direction = Vector3::Zero();
        while (direction.norm() < 0.1)
            direction = Vector3(coordinate(), coordinate(), coordinate());
        linking = linking_matrix(basis, primal, dual, direction.normalized());
    }
    if (!linking) {
        throw TopologyError(
            "linking numbers: loops on the surface touch in space in each of {} projections; the "
            "surface intersects itself or has triangles without area: repair it first",
            n_tries);
    }
    const auto trace = [&] {
        long long sum = 0;
        for (std::size_t i = 0; i < linking->size(); ++i) sum += (*linking)[i][i];
        return sum;
    };
    if (trace() < 0) {
        for (auto& row : *linking) {
            for (auto& entry : row) entry = -entry;
        }
    }
    if (trace() != basis.genus || multiply(*linking, *linking) != *linking) {
        throw TopologyError(
            "linking numbers: the matrix of {} loops is no projector of trace {} (its trace is "
            "{}); the surface intersects itself, or the caps that close its holes cut through it",
            basis.loops.size(), basis.genus, trace());
    }
    return *linking;
}

}  // namespace couture::meshing
