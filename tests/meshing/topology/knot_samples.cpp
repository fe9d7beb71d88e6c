#include "tests/meshing/topology/knot_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace couture::meshing {

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

// Rotation that takes a unit vector to another one the shortest way, applied to a third.
Vector3 carried(const Vector3& from, const Vector3& to, const Vector3& v) {
    return Eigen::Quaterniond::FromTwoVectors(from, to) * v;
}

}  // namespace

std::vector<Vector3> make_torus_knot(int p, int q, int n) {
    std::vector<Vector3> points;
    for (int i = 0; i < n; ++i) {
        const double t = two_pi * i / n;
        const double r = 3.0 + std::cos(q * t);
        points.emplace_back(r * std::cos(p * t), r * std::sin(p * t), std::sin(q * t));
    }
    return points;
}

std::vector<Vector3> make_figure_eight_knot(int n) {
    std::vector<Vector3> points;
    for (int i = 0; i < n; ++i) {
        const double t = two_pi * i / n;
        const double r = 2.0 + std::cos(2.0 * t);
        points.emplace_back(r * std::cos(3.0 * t), r * std::sin(3.0 * t), std::sin(4.0 * t));
    }
    return points;
}

KnottedSolid make_closed_tube(const std::vector<Vector3>& core, int n_around, double radius) {
    const int n = static_cast<int>(core.size());
    std::vector<Vector3> tangents;
    for (int i = 0; i < n; ++i) {
        tangents.push_back((core[(i + 1) % n] - core[(i + n - 1) % n]).normalized());
    }
    std::vector<Vector3> normals{tangents.front().unitOrthogonal()};
    for (int i = 1; i < n; ++i) {
        normals.push_back(carried(tangents[i - 1], tangents[i], normals.back()));
    }
    const Vector3 back = carried(tangents.back(), tangents.front(), normals.back());
    const Vector3& first = normals.front();
    const double turn = std::atan2(tangents.front().dot(first.cross(back)), first.dot(back));
    KnottedSolid solid;
    solid.cores = {core};
    for (int i = 0; i < n; ++i) {
        const Vector3 binormal = tangents[i].cross(normals[i]);
        for (int j = 0; j < n_around; ++j) {
            const double angle = two_pi * j / n_around - turn * i / n;
            solid.surface.points.emplace_back(
                core[i] + radius * (std::cos(angle) * normals[i] + std::sin(angle) * binormal));
        }
    }
    const auto at = [&](int i, int j) { return n_around * (i % n) + j % n_around; };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n_around; ++j) {
            solid.surface.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
            solid.surface.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
        }
    }
    return solid;
}

KnottedSolid make_trefoil_with_arch(int n_around, int n_along) {
    const double radius = 0.4;
    KnottedSolid solid = make_closed_tube(make_torus_knot(2, 3, n_along), n_around, radius);
    auto& [points, triangles] = solid.surface;
    const std::vector<Vector3> core = solid.cores.front();
    // The trefoil is farthest from its axis after a third of the way: quads on the outer side.
    const int middle = n_along / 3;
    const int from = middle - n_along / 30;
    const int to = middle + n_along / 30;
    const auto at = [&](int i, int j) { return n_around * i + j % n_around; };
    const auto distance = [&](int j) { return points[at(middle, j)].head<2>().norm(); };
    int outer = 0;
    for (int j = 0; j < n_around; ++j) outer = distance(j) > distance(outer) ? j : outer;
    const auto quad = [&](int i) {
        return std::array{at(i, outer), at(i, outer + 1), at(i + 1, outer + 1), at(i + 1, outer)};
    };
    const auto [a0, a1, a2, a3] = quad(from);
    const auto [b0, b1, b2, b3] = quad(to);
    const std::array start{a0, a1, a2, a3};
    const std::array end{b3, b2, b1, b0};
    const auto first_triangle = [&](int i) { return 2 * (n_around * i + outer % n_around); };
    triangles.erase(triangles.begin() + first_triangle(to),
                    triangles.begin() + first_triangle(to) + 2);
    triangles.erase(triangles.begin() + first_triangle(from),
                    triangles.begin() + first_triangle(from) + 2);

    Vector3 up = points[at(middle, outer)] - core[middle];
    up.normalize();
    constexpr int n_arch = 10;
    std::vector<Vector3>& loop = solid.cores.emplace_back();
    std::array<int, 4> ring = start;
    for (int s = 0; s <= n_arch; ++s) {
        const double t = static_cast<double>(s) / n_arch;
        std::array<int, 4> next = s == 0 ? start : end;
        Vector3 centre = Vector3::Zero();
        for (int k = 0; k < 4; ++k) {
            const Vector3 p = points[start[k]];
            const Vector3 q = points[end[k]];
            const Vector3 arch = (1.0 - t) * p + t * q + 3.0 * t * (1.0 - t) * (q - p).norm() * up;
            centre += 0.25 * arch;
            if (s == 0 || s == n_arch) continue;
            next[k] = static_cast<int>(points.size());
            points.push_back(arch);
        }
        loop.push_back(centre);
        for (int k = 0; k < 4 && s > 0; ++k) {
            const int l = (k + 1) % 4;
            triangles.push_back({ring[k], ring[l], next[l]});
            triangles.push_back({ring[k], next[l], next[k]});
        }
        ring = next;
    }
    for (int i = to; i >= from; --i) loop.push_back(core[i]);
    return solid;
}

double gauss_linking_number(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Vector3& p = a[i];
        const Vector3& q = a[(i + 1) % a.size()];
        for (std::size_t j = 0; j < b.size(); ++j) {
            const Vector3& r = b[j];
            const Vector3& s = b[(j + 1) % b.size()];
            const double volume = (s - r).cross(q - p).dot(r - p);
            if (volume == 0.0) continue;
            const std::array<Vector3, 4> n{(r - p).cross(s - p), (s - p).cross(s - q),
                                           (s - q).cross(r - q), (r - q).cross(r - p)};
            double angle = 0.0;
            for (int k = 0; k < 4; ++k) {
                const double cosine =
                    n[k].dot(n[(k + 1) % 4]) / (n[k].norm() * n[(k + 1) % 4].norm());
                angle += std::asin(std::clamp(cosine, -1.0, 1.0));
            }
            sum += (volume > 0.0 ? angle : -angle) / (2.0 * two_pi);
        }
    }
    return sum;
}

}  // namespace couture::meshing
