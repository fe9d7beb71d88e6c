#include "meshing/topology/shells.h"
#include "meshing/surface/soup_sides.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <string>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"

namespace couture::meshing {

namespace {

double winding_number(const TriangleSoup& soup, std::span<const int> triangles,
                      const Vector3& point) {
    double sum = 0.0;
    for (const int t : triangles) {
        const auto [i, j, k] = soup.triangles[t];
        const Vector3 a = soup.points[i] - point;
        const Vector3 b = soup.points[j] - point;
        const Vector3 c = soup.points[k] - point;
        const double la = a.norm();
        const double lb = b.norm();
        const double lc = c.norm();
        const double volume = a.dot(b.cross(c));
        const double rest = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        // On the triangle itself the half space's sign is rounding: take neither.
        constexpr double rounding = 1e-12;
        if (rest <= 0.0 && std::abs(volume) <= rounding * la * lb * lc) continue;
        sum += std::atan2(volume, rest);
    }
    return sum / (2.0 * std::numbers::pi);
}

// A shell with what is needed to compare it with others.
struct Candidate {
    Shell shell;
    std::vector<int> vertices;
    Vector3 low, high;

    [[nodiscard]] std::string name() const {
        const Vector3 center = 0.5 * (low + high);
        return fmt::format(
            "the shell of triangle {} (centre ({:.4g}, {:.4g}, {:.4g}), size "
            "{:.4g} x {:.4g} x {:.4g})",
            shell.triangles.front(), center.x(), center.y(), center.z(), high.x() - low.x(),
            high.y() - low.y(), high.z() - low.z());
    }
};

void check_closed(const TriangleSoup& soup) {
    const std::vector<SoupSide> sides = sorted_sides(soup);
    for (const auto& edge : edges_of(sides)) {
        if (edge.size() == 2 && edge[0].is_forward != edge[1].is_forward) continue;
        const Vector3 middle = 0.5 * (soup.points[edge[0].low] + soup.points[edge[0].high]);
        throw TopologyError(
            "make_solid: the edge of vertices {} and {} at ({:.4g}, {:.4g}, {:.4g}) has {} "
            "triangles{}; the boundary of a solid has two on each edge, in opposite directions: "
            "repair it, or close its holes",
            edge[0].low, edge[0].high, middle.x(), middle.y(), middle.z(), edge.size(),
            edge.size() == 2 ? " in the same direction" : "");
    }
}

std::vector<Candidate> make_candidates(const TriangleSoup& soup) {
    DisjointSets sets(soup.points.size());
    for (const auto& [a, b, c] : soup.triangles) {
        sets.join(a, b);
        sets.join(a, c);
    }
    std::vector<Candidate> candidates;
    std::vector<int> number(soup.points.size(), -1);
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        int& i = number[sets.find(soup.triangles[t][0])];
        if (i < 0) {
            i = static_cast<int>(candidates.size());
            candidates.emplace_back();
        }
        candidates[i].shell.triangles.push_back(static_cast<int>(t));
    }
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
        const int i = number[sets.find(static_cast<int>(v))];
        if (i >= 0) candidates[i].vertices.push_back(static_cast<int>(v));
    }
    for (auto& candidate : candidates) {
        candidate.low = candidate.high = soup.points[candidate.vertices.front()];
        for (const int v : candidate.vertices) {
            candidate.low = candidate.low.cwiseMin(soup.points[v]);
            candidate.high = candidate.high.cwiseMax(soup.points[v]);
        }
        double volume = 0.0;
        const Vector3& origin = soup.points[candidate.vertices.front()];
        for (const int t : candidate.shell.triangles) {
            const auto [a, b, c] = soup.triangles[t];
            volume += (soup.points[a] - origin)
                          .dot((soup.points[b] - origin).cross(soup.points[c] - origin)) /
                      6.0;
        }
        const double diagonal = (candidate.high - candidate.low).norm();
        if (!(std::abs(volume) > 1e-14 * diagonal * diagonal * diagonal)) {
            throw GeometryError("make_solid: {} has volume {:.3g}; a shell must enclose some",
                                candidate.name(), volume);
        }
        candidate.shell.volume = std::abs(volume);
        candidate.shell.is_reversed = volume < 0.0;
        const int n_faces = static_cast<int>(candidate.shell.triangles.size());
        const int chi = static_cast<int>(candidate.vertices.size()) - n_faces / 2;
        if (chi > 2 || chi % 2 != 0) {
            throw TopologyError(
                "make_solid: {} has Euler characteristic {}; a closed surface has 2 - 2 genus: "
                "parts of it touch at a vertex",
                candidate.name(), chi);
        }
        candidate.shell.genus = (2 - chi) / 2;
    }
    return candidates;
}

// Whether the inner shell lies inside the outer one, by some of its vertices.
bool is_inside(const TriangleSoup& soup, const Candidate& inner, const Candidate& outer) {
    if ((inner.low.array() < outer.low.array()).any() ||
        (inner.high.array() > outer.high.array()).any()) {
        return false;
    }
    constexpr std::size_t n_tries = 8;
    constexpr double tolerance = 1e-6;
    int n_inside = 0;
    int n_tried = 0;
    const std::size_t step = std::max<std::size_t>(inner.vertices.size() / n_tries, 1);
    for (std::size_t i = 0; i < inner.vertices.size(); i += step, ++n_tried) {
        const Vector3& point = soup.points[inner.vertices[i]];
        const double winding = std::abs(winding_number(soup, outer.shell.triangles, point));
        const bool is_on = std::abs(winding - std::round(winding)) > tolerance;
        if (!is_on && winding > 0.5) ++n_inside;
        if (is_on || (n_inside != 0 && n_inside != n_tried + 1)) {
            throw GeometryError(
                "make_solid: {} crosses or touches {} near ({:.4g}, {:.4g}, {:.4g}); shells must "
                "keep apart",
                inner.name(), outer.name(), point.x(), point.y(), point.z());
        }
    }
    return n_inside > 0;
}

}  // namespace

double winding_number(const TriangleSoup& soup, const Vector3& point) {
    std::vector<int> triangles(soup.triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) triangles[i] = static_cast<int>(i);
    return winding_number(soup, triangles, point);
}

std::vector<NestedShell> nest_shells(const TriangleSoup& soup) {
    check_closed(soup);
    const auto candidates = make_candidates(soup);
    std::vector<NestedShell> nested;
    for (const auto& candidate : candidates) {
        nested.push_back({.shell = candidate.shell, .low = candidate.low, .high = candidate.high});
    }
    // A shell lies in larger ones only.
    std::vector<int> order(candidates.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int i, int j) {
        return candidates[i].shell.volume > candidates[j].shell.volume;
    });
    for (std::size_t k = 0; k < order.size(); ++k) {
        NestedShell& shell = nested[order[k]];
        for (std::size_t l = 0; l < k; ++l) {
            if (!is_inside(soup, candidates[order[k]], candidates[order[l]])) continue;
            ++shell.depth;
            shell.parent = order[l];
        }
        shell.shell.is_cavity = shell.depth % 2 == 1;
        if (shell.shell.is_cavity) shell.shell.is_reversed = !shell.shell.is_reversed;
    }
    return nested;
}

Solid make_solid(const TriangleSoup& soup) {
    if (soup.triangles.empty()) {
        throw TopologyError("make_solid: there are no triangles; a solid needs a closed boundary");
    }
    check_closed(soup);
    auto candidates = make_candidates(soup);
    const std::size_t outer = std::max_element(candidates.begin(), candidates.end(),
                                               [](const Candidate& a, const Candidate& b) {
                                                   return a.shell.volume < b.shell.volume;
                                               }) -
                              candidates.begin();
    Solid solid;
    solid.shells.push_back(candidates[outer].shell);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (i == outer) continue;
        if (!is_inside(soup, candidates[i], candidates[outer])) {
            throw TopologyError(
                "make_solid: {} lies outside {}; one solid has one outer shell: mesh the parts one "
                "by one",
                candidates[i].name(), candidates[outer].name());
        }
        for (std::size_t j = 0; j < candidates.size(); ++j) {
            if (j == outer || j == i || !is_inside(soup, candidates[i], candidates[j])) continue;
            throw TopologyError(
                "make_solid: {} lies in the cavity of {}; a solid in a cavity is a second one: "
                "mesh the parts one by one",
                candidates[i].name(), candidates[j].name());
        }
        Shell shell = candidates[i].shell;
        shell.is_cavity = true;
        // The normals of a cavity point into it.
        shell.is_reversed = !shell.is_reversed;
        solid.shells.push_back(std::move(shell));
    }
    solid.betti = {1, 0, static_cast<int>(solid.shells.size()) - 1};
    for (const Shell& shell : solid.shells) {
        solid.volume += shell.is_cavity ? -shell.volume : shell.volume;
        solid.euler_characteristic += 1 - shell.genus;
        solid.betti[1] += shell.genus;
    }
    return solid;
}

}  // namespace couture::meshing
