#include "meshing/topology/homology_basis.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "iga/core/error.h"
#include "meshing/topology/tree_cotree.h"

namespace couture::meshing {

namespace {

std::vector<int> sum_of(const std::vector<int>& a, const std::vector<int>& b, int sign) {
    std::vector<int> sum(a);
    for (std::size_t k = 0; k < b.size(); ++k) sum[k] += sign * b[k];
    return sum;
}

// Path in a forest of triangles from one to another, as the halfedges crossed.
std::vector<int> forest_path(const CutSurface& surface,
                             const std::vector<std::vector<int>>& crossings, int from, int to) {
    // Halfedge through which a triangle was entered, seen from the one before it.
    std::vector<int> entered(surface.n_faces(), -2);
    entered[from] = -1;
    std::vector<int> stack{from};
    while (!stack.empty() && entered[to] == -2) {
        const int face = stack.back();
        stack.pop_back();
        for (const int h : crossings[face]) {
            const int neighbour = CutSurface::face(surface.twin(h));
            if (entered[neighbour] != -2) continue;
            entered[neighbour] = h;
            stack.push_back(neighbour);
        }
    }
    std::vector<int> path;
    for (int face = to; entered[face] >= 0; face = CutSurface::face(entered[face])) {
        path.push_back(entered[face]);
    }
    std::reverse(path.begin(), path.end());
    return path;
}

}  // namespace

std::vector<int> AnnotatedSurface::class_of(const std::vector<int>& path) const {
    std::vector<int> sum(rank, 0);
    for (const int h : path) {
        if (annotation[h] != 0) sum = sum_of(sum, classes[annotation[h]], 1);
    }
    return sum;
}

AnnotatedLoop AnnotatedSurface::make_loop(std::vector<int> path) const {
    AnnotatedLoop loop;
    for (const int h : path) {
        loop.length += surface.length(h);
        loop.vertices.push_back(surface.origin(h));
    }
    loop.homology_class = class_of(path);
    loop.path = std::move(path);
    return loop;
}

int AnnotatedSurface::number(const std::vector<int>& homology_class) {
    const auto [entry, is_new] =
        number_of_class.try_emplace(homology_class, static_cast<int>(classes.size()));
    if (is_new) classes.push_back(homology_class);
    return entry->second;
}

void AnnotatedSurface::split_edge(int h) {
    const std::vector<int> zero(rank, 0);
    const auto value = [&](int halfedge) { return classes[annotation[halfedge]]; };
    const int twin = surface.twin(h);
    const std::vector<int> along = value(h);
    // The first half keeps the annotation; the sum around each of the new triangles must be 0.
    struct Side {
        int halfedge;
        std::vector<int> first_half;
        std::vector<int> second_half;
        std::vector<int> behind;
        std::vector<int> apex_to_middle;
    };
    std::vector<Side> sides{{h, along, zero, value(CutSurface::next(h)),
                             sum_of(value(CutSurface::previous(h)), along, 1)}};
    if (twin >= 0) {
        sides.push_back({twin, zero, sum_of(zero, along, -1), value(CutSurface::next(twin)),
                         value(CutSurface::previous(twin))});
    }
    int added = surface.n_halfedges();
    surface.split_edge(h);
    annotation.resize(surface.n_halfedges(), 0);
    for (const Side& side : sides) {
        annotation[side.halfedge] = number(side.first_half);
        annotation[CutSurface::next(side.halfedge)] = number(sum_of(zero, side.apex_to_middle, -1));
        annotation[added] = number(side.second_half);
        annotation[added + 1] = number(side.behind);
        annotation[added + 2] = number(side.apex_to_middle);
        added += 3;
    }
}

void AnnotatedSurface::split_chords() {
    for (int h = 0; h < surface.n_halfedges(); ++h) {
        if (surface.is_chord(h)) split_edge(h);
    }
}

CutSurface close_with_caps(const CutSurface& surface) {
    TriangleSoup soup;
    for (int v = 0; v < surface.n_vertices(); ++v) soup.points.push_back(surface.point(v));
    for (int f = 0; f < surface.n_faces(); ++f) soup.triangles.push_back(surface.triangle(f));
    for (const auto& loop : surface.boundary_loops()) {
        Vector3 centre = Vector3::Zero();
        double length = 0.0;
        for (const int h : loop) {
            centre += 0.5 * surface.length(h) *
                      (surface.point(surface.origin(h)) + surface.point(surface.target(h)));
            length += surface.length(h);
        }
        const int apex = static_cast<int>(soup.points.size());
        soup.points.emplace_back(centre / length);
        for (const int h : loop) {
            soup.triangles.push_back({surface.target(h), surface.origin(h), apex});
        }
    }
    return CutSurface(soup);
}

HomologyBasis make_homology_basis(CutSurface surface) {
    HomologyBasis basis;
    for (int h = 0; h < surface.n_halfedges(); ++h) {
        if (surface.twin(h) < 0) {
            throw TopologyError(
                "homology basis: the surface has a boundary at the edge of vertices {} and {}; "
                "close it first",
                surface.origin(h), surface.target(h));
        }
    }
    const auto component = surface.face_components();
    const auto stray = std::find(component.begin(), component.end(), 1);
    if (stray != component.end()) {
        throw TopologyError(
            "homology basis: triangle {} is not connected with triangle 0; a surface must be in "
            "one piece",
            stray - component.begin());
    }
    basis.genus = (2 - surface.euler_characteristic()) / 2;
    const int rank = 2 * basis.genus;

    int root = 0;
    while (root < surface.n_vertices() && surface.outgoing(root) < 0) ++root;
    const TreeCotree tree_cotree = make_tree_cotree(surface, {&root, 1});
    const ShortestPaths& tree = tree_cotree.tree;
    const std::vector<int>& generators = tree_cotree.generators;
    if (static_cast<int>(generators.size()) != rank) {
        throw TopologyError("homology basis: {} loops for genus {}; there must be twice as many",
                            generators.size(), basis.genus);
    }

    std::vector<std::vector<int>> change(surface.n_halfedges());
    for (int i = 0; i < rank; ++i) {
        const int h = generators[i];
        // b_i: along h, back to the tree's root and out again, without the common part.
        std::vector<int> out = tree.path_to(surface.origin(h));
        std::vector<int> in = tree.path_to(surface.target(h));
        std::size_t n_common = 0;
        while (n_common < std::min(out.size(), in.size()) && out[n_common] == in[n_common]) {
            ++n_common;
        }
        auto& loop = basis.loops.emplace_back();
        loop.push_back(h);
        for (std::size_t k = in.size(); k-- > n_common;) loop.push_back(surface.twin(in[k]));
        loop.insert(loop.end(), out.begin() + static_cast<std::ptrdiff_t>(n_common), out.end());

        // b*_i: across h from right to left, and back through the cotree.
        auto& dual = basis.dual_loops.emplace_back();
        dual.push_back(surface.twin(h));
        const auto path = forest_path(surface, tree_cotree.cotree, CutSurface::face(h),
                                      CutSurface::face(surface.twin(h)));
        dual.insert(dual.end(), path.begin(), path.end());
        // Crossing a halfedge from right to left counts +1 for it: it is crossed from its triangle.
        for (const int crossed : dual) {
            for (const int side : {crossed, surface.twin(crossed)}) {
                change[side].resize(rank, 0);
                change[side][i] += side == crossed ? -1 : 1;
            }
        }
    }
    AnnotatedSurface& annotated = basis.annotated;
    annotated.rank = rank;
    annotated.number(std::vector<int>(rank, 0));
    annotated.annotation.assign(surface.n_halfedges(), 0);
    for (int h = 0; h < surface.n_halfedges(); ++h) {
        if (!change[h].empty()) annotated.annotation[h] = annotated.number(change[h]);
    }
    annotated.surface = std::move(surface);
    return basis;
}

}  // namespace couture::meshing
