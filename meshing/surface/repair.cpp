#include "meshing/surface/repair.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "iga/core/error.h"
#include "meshing/surface/soup_sides.h"

namespace couture::meshing {

namespace {

constexpr std::size_t max_places = 10;

void check(const TriangleSoup& soup) {
    const int n_points = static_cast<int>(soup.points.size());
    for (int v = 0; v < n_points; ++v) {
        const Vector3& p = soup.points[v];
        if (!p.allFinite()) {
            throw InputError("repair_surface: point {} is ({}, {}, {}); coordinates must be finite",
                             v, p.x(), p.y(), p.z());
        }
    }
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        const auto [a, b, c] = soup.triangles[t];
        if (std::min({a, b, c}) < 0 || std::max({a, b, c}) >= n_points) {
            throw InputError(
                "repair_surface: triangle {} has vertices {}, {}, {}; they must be numbers below "
                "{}",
                t, a, b, c, n_points);
        }
    }
}

void add_place(std::vector<SurfacePlace>& places, std::vector<int> triangles,
               const Vector3& position) {
    if (places.size() < max_places) places.push_back({std::move(triangles), position});
}

/// The three vertices, ascending.
std::array<int, 3> sorted(std::array<int, 3> triangle) {
    std::sort(triangle.begin(), triangle.end());
    return triangle;
}

/// Whether the vertices run around as their numbers ascend.
bool is_even(const std::array<int, 3>& t) {
    return (t[0] < t[1] && t[1] < t[2]) || (t[1] < t[2] && t[2] < t[0]) ||
           (t[2] < t[0] && t[0] < t[1]);
}

/// Of copies that run both ways: whether others leave an odd number of most edges to them.
bool closes_surface(const TriangleSoup& soup, const std::vector<SoupSide>& sides, int triangle,
                    std::size_t n_copies) {
    int n_odd = 0;
    for (int i = 0; i < 3; ++i) {
        const int a = soup.triangles[triangle][i];
        const int b = soup.triangles[triangle][(i + 1) % 3];
        const SoupSide key{std::min(a, b), std::max(a, b), 0, true};
        const auto [first, last] =
            std::equal_range(sides.begin(), sides.end(), key, [](const auto& s, const auto& t) {
                return std::array{s.low, s.high} < std::array{t.low, t.high};
            });
        const std::size_t n_others = static_cast<std::size_t>(last - first) - n_copies;
        if (n_others % 2 == 1) ++n_odd;
    }
    return n_odd >= 2;
}

void keep(TriangleSoup& soup, const std::vector<bool>& is_kept, std::vector<int>& source) {
    std::size_t next = 0;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        if (!is_kept[t]) continue;
        soup.triangles[next] = soup.triangles[t];
        source[next++] = source[t];
    }
    soup.triangles.resize(next);
    source.resize(next);
}

}  // namespace

Vector3 centroid(const TriangleSoup& soup, int triangle) {
    const auto [a, b, c] = soup.triangles[triangle];
    return (soup.points[a] + soup.points[b] + soup.points[c]) / 3.0;
}

std::vector<int> first_equal_points(std::span<const Vector3> points) {
    const auto key = [&](int i) {
        const Vector3& p = points[i];
        return std::make_tuple(p.x(), p.y(), p.z());
    };
    std::vector<int> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        return std::tuple_cat(key(a), std::make_tuple(a)) <
               std::tuple_cat(key(b), std::make_tuple(b));
    });
    std::vector<int> result(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool is_equal = i > 0 && key(order[i]) == key(order[i - 1]);
        result[order[i]] = is_equal ? result[order[i - 1]] : order[i];
    }
    return result;
}

std::vector<int> drop_bad_triangles(TriangleSoup& soup, RepairReport& report) {
    std::vector<int> source(soup.triangles.size());
    std::iota(source.begin(), source.end(), 0);
    std::vector<bool> is_kept(soup.triangles.size(), true);
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        const auto [a, b, c] = soup.triangles[t];
        if (a != b && b != c && c != a) continue;
        is_kept[t] = false;
        ++report.n_degenerate;
        add_place(report.degenerate, {static_cast<int>(t)}, centroid(soup, static_cast<int>(t)));
    }
    keep(soup, is_kept, source);

    // Copies stand together, the first one first.
    std::vector<int> order(soup.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int s, int t) {
        return std::tuple(sorted(soup.triangles[s]), s) < std::tuple(sorted(soup.triangles[t]), t);
    });
    is_kept.assign(soup.triangles.size(), true);
    std::optional<std::vector<SoupSide>> sides;
    for (std::size_t i = 0; i < order.size();) {
        std::size_t end = i + 1;
        bool is_mixed = false;
        while (end < order.size() &&
               sorted(soup.triangles[order[end]]) == sorted(soup.triangles[order[i]])) {
            is_mixed |= is_even(soup.triangles[order[end]]) != is_even(soup.triangles[order[i]]);
            ++end;
        }
        if (end - i > 1) {
            if (is_mixed && !sides) sides = sorted_sides(soup);
            const bool keeps_one = !is_mixed || closes_surface(soup, *sides, order[i], end - i);
            std::vector<int> copies;
            for (std::size_t k = i; k < end; ++k) {
                copies.push_back(source[order[k]]);
                is_kept[order[k]] = keeps_one && k == i;
                report.n_duplicates += is_kept[order[k]] ? 0 : 1;
            }
            add_place(report.duplicates, std::move(copies), centroid(soup, order[i]));
        }
        i = end;
    }
    keep(soup, is_kept, source);
    return source;
}

std::vector<int> orient_alike(TriangleSoup& soup) {
    struct Link {
        int to;
        bool is_turned;
    };
    // Up to three neighbours each.
    std::vector<std::array<Link, 3>> links(soup.triangles.size());
    std::vector<int> n_links(soup.triangles.size(), 0);
    const auto sides = sorted_sides(soup);
    for (const auto& edge : edges_of(sides)) {
        if (edge.size() != 2 || edge[0].triangle == edge[1].triangle) continue;
        const bool is_turned = edge[0].is_forward == edge[1].is_forward;
        const int s = edge[0].triangle;
        const int t = edge[1].triangle;
        links[s][n_links[s]++] = {t, is_turned};
        links[t][n_links[t]++] = {s, is_turned};
    }
    std::vector<int> turned;
    std::vector<std::optional<bool>> is_turned(soup.triangles.size());
    std::vector<int> component;
    for (std::size_t start = 0; start < soup.triangles.size(); ++start) {
        if (is_turned[start]) continue;
        is_turned[start] = false;
        component.assign(1, static_cast<int>(start));
        std::size_t n_turned = 0;
        bool is_orientable = true;
        for (std::size_t i = 0; i < component.size(); ++i) {
            const int t = component[i];
            n_turned += *is_turned[t] ? 1 : 0;
            for (int k = 0; k < n_links[t]; ++k) {
                const bool wanted = *is_turned[t] != links[t][k].is_turned;
                std::optional<bool>& other = is_turned[links[t][k].to];
                if (!other) {
                    other = wanted;
                    component.push_back(links[t][k].to);
                }
                is_orientable &= *other == wanted;
            }
        }
        if (!is_orientable) continue;
        const bool turns_others = 2 * n_turned > component.size();
        for (const int t : component) {
            if (*is_turned[t] == turns_others) continue;
            std::swap(soup.triangles[t][1], soup.triangles[t][2]);
            turned.push_back(t);
        }
    }
    std::sort(turned.begin(), turned.end());
    return turned;
}

RepairedSurface repair_surface(const TriangleSoup& soup) {
    check(soup);
    RepairedSurface result;
    result.soup = soup;
    const std::vector<int> first = first_equal_points(soup.points);
    for (auto& triangle : result.soup.triangles) {
        for (int& vertex : triangle) vertex = first[vertex];
    }
    for (std::size_t v = 0; v < first.size(); ++v) {
        result.report.n_merged += first[v] == static_cast<int>(v) ? 0 : 1;
    }
    result.source = drop_bad_triangles(result.soup, result.report);
    if (result.soup.triangles.empty()) {
        throw GeometryError(
            "repair_surface: none of {} triangles is left: {} had a point twice, {} lay on another "
            "one; a surface has at least one",
            soup.triangles.size(), result.report.n_degenerate, result.report.n_duplicates);
    }
    result.report.n_unused = drop_unused_points(result.soup) - result.report.n_merged;
    result.turned = orient_alike(result.soup);
    result.report.n_turned = static_cast<int>(result.turned.size());
    for (const int t : result.turned) {
        add_place(result.report.turned, {result.source[t]}, centroid(result.soup, t));
    }
    return result;
}

}  // namespace couture::meshing
