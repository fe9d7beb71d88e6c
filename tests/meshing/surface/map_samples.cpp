#include "tests/meshing/surface/map_samples.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/meshing/surface/surface_samples.h"

namespace couture::meshing {

TriangleSoup make_jittered_square(int n, unsigned seed) {
    TriangleSoup soup = make_square(n);
    std::mt19937 generator(seed);
    for (Vector3& point : soup.points) {
        for (int axis = 0; axis < 2; ++axis) {
            const double step = 0.4 * (generator() / 4294967296.0 - 0.5) / n;
            if (point[axis] > 0.0 && point[axis] < 1.0) point[axis] += step;
        }
    }
    return soup;
}

TriangleSoup make_bumpy_square(int n, double height) {
    TriangleSoup soup = make_square(n);
    for (Vector3& p : soup.points) {
        p.z() = height * std::sin(7.0 * p.x()) * std::cos(5.0 * p.y()) + p.x() * p.y();
    }
    return soup;
}

TriangleSoup make_finger(int n_around, int n_along, double radius, double length) {
    TriangleSoup soup = make_tube(n_around, n_along, radius, length);
    const int tip = static_cast<int>(soup.points.size());
    soup.points.emplace_back(0.0, 0.0, length * (1.0 + 1.0 / n_along));
    for (int j = 0; j < n_around; ++j) {
        soup.triangles.push_back(
            {n_around * n_along + j, n_around * n_along + (j + 1) % n_around, tip});
    }
    return soup;
}

std::vector<int> square_corner_vertices(int n) {
    const TriangleSoup soup = make_square(n);
    std::vector<int> corners;
    for (const Vector3& corner :
         {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(1, 1, 0), Vector3(0, 1, 0)}) {
        const auto found = std::find(soup.points.begin(), soup.points.end(), corner);
        corners.push_back(static_cast<int>(found - soup.points.begin()));
    }
    return corners;
}

std::vector<int> path_between_boundaries(const CutSurface& surface, int from_loop, int to_loop) {
    const auto loops = surface.boundary_loops();
    std::vector<char> is_target(surface.n_vertices(), 0);
    for (const int h : loops[to_loop]) is_target[surface.origin(h)] = 1;
    std::vector<int> arrival(surface.n_vertices(), -1);
    std::vector<char> is_seen(surface.n_vertices(), 0);
    std::vector<int> queue;
    for (const int h : loops[from_loop]) {
        is_seen[surface.origin(h)] = 1;
        queue.push_back(surface.origin(h));
    }
    for (std::size_t i = 0; i < queue.size(); ++i) {
        const int first = surface.outgoing(queue[i]);
        for (int h = first; h >= 0;) {
            const int v = surface.target(h);
            if (is_seen[v] == 0 && surface.twin(h) >= 0) {
                is_seen[v] = 1;
                arrival[v] = h;
                if (is_target[v] != 0) {
                    std::vector<int> path;
                    for (int w = v; arrival[w] >= 0; w = surface.origin(arrival[w])) {
                        path.push_back(arrival[w]);
                    }
                    std::reverse(path.begin(), path.end());
                    return path;
                }
                if (!surface.is_boundary_vertex(v)) queue.push_back(v);
            }
            h = surface.rotated(h);
            if (h == first) break;
        }
    }
    return {};
}

std::vector<int> spread_corners(const CutSurface& disc, int n) {
    const auto loop = disc.boundary_loops().front();
    double length = 0.0;
    for (const int h : loop) length += disc.length(h);
    std::vector<int> corners;
    double along = 0.0;
    for (const int h : loop) {
        if (along >= length * static_cast<double>(corners.size()) / n) {
            corners.push_back(disc.origin(h));
        }
        along += disc.length(h);
        if (static_cast<int>(corners.size()) == n) break;
    }
    return corners;
}

}  // namespace couture::meshing
