#include "meshing/surface/cut_surface.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

#include "iga/core/error.h"

namespace couture::meshing {

CutSurface::CutSurface(const TriangleSoup& soup) : points_(soup.points) {
    const int n_faces = static_cast<int>(soup.triangles.size());
    origin_.reserve(3 * soup.triangles.size());
    for (const auto& triangle : soup.triangles) {
        origin_.insert(origin_.end(), triangle.begin(), triangle.end());
    }
    struct Entry {
        int low, high, halfedge;
    };
    std::vector<Entry> entries;
    entries.reserve(origin_.size());
    for (int h = 0; h < n_halfedges(); ++h) {
        const auto [low, high] = std::minmax({origin(h), target(h)});
        entries.push_back({low, high, h});
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return std::array{a.low, a.high, a.halfedge} < std::array{b.low, b.high, b.halfedge};
    });
    twin_.assign(origin_.size(), -1);
    for (std::size_t i = 0; i < entries.size();) {
        std::size_t end = i + 1;
        while (end < entries.size() && entries[end].low == entries[i].low &&
               entries[end].high == entries[i].high) {
            ++end;
        }
        const int h = entries[i].halfedge;
        if (end - i > 2 || (end - i == 2 && origin(h) == origin(entries[i + 1].halfedge))) {
            throw TopologyError(
                "CutSurface: triangles {} and {} run along the edge of vertices {} and {} in the "
                "same direction, or there are more than two; repair the surface first",
                h / 3, entries[i + 1].halfedge / 3, entries[i].low, entries[i].high);
        }
        if (end - i == 2) {
            twin_[h] = entries[i + 1].halfedge;
            twin_[entries[i + 1].halfedge] = h;
        }
        i = end;
    }
    parent_.resize(points_.size());
    for (int v = 0; v < n_vertices(); ++v) parent_[v] = v;
    parent_face_.resize(n_faces);
    for (int f = 0; f < n_faces; ++f) parent_face_[f] = f;
    original_ = parent_;
    link_outgoing();
}

CutSurface::CutSurface(const SurfaceMesh& mesh, std::span<const FaceHandle> faces,
                       const std::vector<bool>& is_seam) {
    std::vector<int> local_face(mesh.n_faces(), -1);
    for (std::size_t i = 0; i < faces.size(); ++i) {
        local_face[faces[i].idx()] = static_cast<int>(i);
        parent_face_.push_back(faces[i].idx());
    }
    // Local halfedge of a mesh halfedge: by the position of its edge in the face.
    const auto local_halfedge = [&](HalfedgeHandle halfedge) {
        const FaceHandle face = mesh.face_handle(halfedge);
        if (!face.is_valid() || local_face[face.idx()] < 0) return -1;
        int position = 0;
        for (HalfedgeHandle h = mesh.halfedge_handle(face); h != halfedge;
             h = mesh.next_halfedge_handle(h)) {
            ++position;
        }
        return 3 * local_face[face.idx()] + position;
    };
    origin_.assign(3 * faces.size(), -1);
    twin_.assign(3 * faces.size(), -1);
    std::vector<int> parent_vertex(3 * faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        HalfedgeHandle halfedge = mesh.halfedge_handle(faces[i]);
        for (int k = 0; k < 3; ++k, halfedge = mesh.next_halfedge_handle(halfedge)) {
            const std::size_t h = 3 * i + k;
            parent_vertex[h] = mesh.from_vertex_handle(halfedge).idx();
            if (is_seam[mesh.edge_handle(halfedge).idx()]) continue;
            twin_[h] = local_halfedge(mesh.opposite_halfedge_handle(halfedge));
        }
    }
    // One vertex for each fan of corners that are joined across edges that are no seams.
    for (int h = 0; h < n_halfedges(); ++h) {
        if (origin_[h] >= 0) continue;
        const int v = n_vertices();
        points_.push_back(mesh.point(VertexHandle(parent_vertex[h])));
        parent_.push_back(parent_vertex[h]);
        int corner = h;
        do {
            origin_[corner] = v;
            corner = rotated(corner);
        } while (corner >= 0 && corner != h);
        if (corner == h) continue;
        for (corner = h; twin_[corner] >= 0;) {
            corner = next(twin_[corner]);
            origin_[corner] = v;
        }
    }
    original_.resize(points_.size());
    std::iota(original_.begin(), original_.end(), 0);
    link_outgoing();
}

void CutSurface::link_outgoing() {
    outgoing_.assign(points_.size(), -1);
    for (int h = 0; h < n_halfedges(); ++h) {
        if (outgoing_[origin(h)] < 0 || twin_[h] < 0) outgoing_[origin(h)] = h;
    }
}

int CutSurface::find_halfedge(int u, int v) const {
    const int first = outgoing_[u];
    for (int h = first; h >= 0;) {
        if (target(h) == v) return h;
        h = rotated(h);
        if (h == first) break;
    }
    return -1;
}

std::vector<int> CutSurface::with_splits(std::span<const int> vertices) const {
    std::map<std::pair<int, int>, int> middle;
    for (const Split& split : splits_) middle[std::minmax(split.from, split.to)] = split.vertex;
    std::vector<int> refined;
    const std::function<void(int, int)> add = [&](int from, int to) {
        const auto split = middle.find(std::minmax(from, to));
        if (split == middle.end()) {
            refined.push_back(from);
            return;
        }
        add(from, split->second);
        add(split->second, to);
    };
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        add(vertices[k], vertices[(k + 1) % vertices.size()]);
    }
    return refined;
}

int CutSurface::split_edge(int h, double fraction) {
    assert(fraction > 0.0 && fraction < 1.0);
    const int from = origin(h);
    const int to = target(h);
    const int opposite = twin_[h];
    const int middle = n_vertices();
    points_.push_back((1.0 - fraction) * points_[from] + fraction * points_[to]);
    parent_.push_back(-1);
    original_.push_back(middle);
    splits_.push_back({from, to, fraction, middle});

    // Side: s runs from -> to. Its triangle keeps the first half; the new one gets the second half
    // and the edge behind it.
    const auto split_side = [&](int s) {
        const int end = target(s);
        const int behind = next(s);
        const int apex = origin(previous(s));
        const int added = n_halfedges();
        origin_.insert(origin_.end(), {middle, end, apex});
        twin_.insert(twin_.end(), {-1, twin_[behind], behind});
        if (twin_[behind] >= 0) twin_[twin_[behind]] = added + 1;
        if (outgoing_[end] == behind) outgoing_[end] = added + 1;
        origin_[behind] = middle;
        twin_[behind] = added + 2;
        parent_face_.push_back(parent_face_[face(s)]);
        return added;
    };
    const int second = split_side(h);
    outgoing_.push_back(second);
    if (opposite >= 0) {
        const int opposite_second = split_side(opposite);
        twin_[h] = opposite_second;
        twin_[opposite_second] = h;
        twin_[opposite] = second;
        twin_[second] = opposite;
    }
    return middle;
}

void CutSurface::split_chords() {
    // New vertices lie inside, so that splits make no further chords; but they move edges to new
    // halfedges, which are looked at as well.
    for (int h = 0; h < n_halfedges(); ++h) {
        if (is_chord(h)) split_edge(h);
    }
}

void CutSurface::split_vertex(int v, std::vector<int>& outgoing) {
    // Each fan starts at a halfedge on the boundary.
    bool is_first = true;
    for (const int start : outgoing) {
        if (twin_[start] >= 0) continue;
        int copy = v;
        if (!is_first) {
            copy = n_vertices();
            points_.push_back(points_[v]);
            parent_.push_back(parent_[v]);
            original_.push_back(original_[v]);
            outgoing_.push_back(-1);
        }
        is_first = false;
        for (int h = start; h >= 0; h = rotated(h)) origin_[h] = copy;
        outgoing_[copy] = start;
    }
}

void CutSurface::slice(std::span<const int> path) {
    if (path.empty()) return;
    std::vector<int> vertices;
    for (const int h : path) vertices.insert(vertices.end(), {origin(h), target(h)});
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<std::vector<int>> fans(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const int first = outgoing_[vertices[i]];
        for (int h = first; h >= 0;) {
            fans[i].push_back(h);
            h = rotated(h);
            if (h == first) break;
        }
    }
    for (const int h : path) {
        assert(twin_[h] >= 0);
        twin_[twin_[h]] = -1;
        twin_[h] = -1;
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) split_vertex(vertices[i], fans[i]);
}

std::vector<std::vector<int>> CutSurface::boundary_loops() const {
    std::vector<std::vector<int>> loops;
    std::vector<bool> is_seen(origin_.size(), false);
    for (int start = 0; start < n_halfedges(); ++start) {
        if (twin_[start] >= 0 || is_seen[start]) continue;
        auto& loop = loops.emplace_back();
        for (int h = start; !is_seen[h]; h = outgoing_[target(h)]) {
            is_seen[h] = true;
            loop.push_back(h);
        }
    }
    return loops;
}

std::vector<int> CutSurface::face_components() const {
    std::vector<int> component(n_faces(), -1);
    int n_components = 0;
    std::vector<int> stack;
    for (int start = 0; start < n_faces(); ++start) {
        if (component[start] >= 0) continue;
        component[start] = n_components;
        stack.push_back(start);
        while (!stack.empty()) {
            const int f = stack.back();
            stack.pop_back();
            for (int h = 3 * f; h < 3 * f + 3; ++h) {
                if (twin_[h] < 0 || component[face(twin_[h])] >= 0) continue;
                component[face(twin_[h])] = n_components;
                stack.push_back(face(twin_[h]));
            }
        }
        ++n_components;
    }
    return component;
}

int CutSurface::euler_characteristic() const {
    int n_used = 0;
    for (const int h : outgoing_) n_used += h >= 0;
    int n_sides = 0;
    for (const int h : twin_) n_sides += h >= 0 ? 1 : 2;
    return n_used - n_sides / 2 + n_faces();
}

}  // namespace couture::meshing
