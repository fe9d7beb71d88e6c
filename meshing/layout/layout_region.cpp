#include "meshing/layout/layout_region.h"

#include <algorithm>
#include <numeric>
#include <queue>

#include <Eigen/LU>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

// Quads that hang together through arcs that are not drawn, in ascending order.
std::vector<std::vector<int>> connected_quads(const QuadLayout& layout, std::vector<int> among,
                                              const std::vector<bool>& is_drawn) {
    std::vector<char> is_free(layout.n_quads(), 0);
    for (const int q : among) is_free[q] = 1;
    std::vector<std::vector<int>> components;
    for (const int first : among) {
        if (!is_free[first]) continue;
        std::vector<int> quads{first};
        is_free[first] = 0;
        for (std::size_t k = 0; k < quads.size(); ++k) {
            for (const QuadLayout::Side& side : layout.sides(quads[k])) {
                if (is_drawn[side.arc]) continue;
                for (const QuadLayout::ArcQuad& place : layout.arc_quads(side.arc)) {
                    if (place.quad < 0 || !is_free[place.quad]) continue;
                    is_free[place.quad] = 0;
                    quads.push_back(place.quad);
                }
            }
        }
        std::ranges::sort(quads);
        components.push_back(std::move(quads));
    }
    return components;
}

int find(std::vector<int>& parent, int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

// The other quad at a side of a quad, with its side.
QuadLayout::ArcQuad across(const QuadLayout& layout, int quad, int side) {
    const QuadLayout::Side& s = layout.sides(quad)[side];
    return layout.arc_quads(s.arc)[s.is_forward ? 1 : 0];
}

}  // namespace

LayoutRegion::LayoutRegion(const QuadLayout& layout, std::vector<int> quads,
                           const std::vector<bool>& is_drawn)
    : layout_(&layout), quads_(std::move(quads)) {
    number_places(is_drawn);
    find_loops(is_drawn);
}

void LayoutRegion::number_places(const std::vector<bool>& is_drawn) {
    std::vector<int> local(layout_->n_quads(), -1);
    for (std::size_t i = 0; i < quads_.size(); ++i) local[quads_[i]] = static_cast<int>(i);
    std::vector<int> parent(4 * quads_.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto join = [&](int a, int b) { parent[find(parent, a)] = find(parent, b); };
    int n_inner_sides = 0;
    for (std::size_t i = 0; i < quads_.size(); ++i) {
        for (int k = 0; k < 4; ++k) {
            if (is_drawn[layout_->sides(quads_[i])[k].arc]) continue;
            const QuadLayout::ArcQuad other = across(*layout_, quads_[i], k);
            if (other.quad < 0) continue;
            ++n_inner_sides;
            const int first = 4 * static_cast<int>(i);
            const int second = 4 * local[other.quad];
            join(first + k, second + (other.side + 1) % 4);
            join(first + (k + 1) % 4, second + other.side);
        }
    }
    n_arcs_ = static_cast<int>(4 * quads_.size()) - n_inner_sides / 2;
    std::vector<int> number(parent.size(), -1);
    places_.resize(quads_.size());
    for (std::size_t i = 0; i < quads_.size(); ++i) {
        for (int k = 0; k < 4; ++k) {
            int& n = number[find(parent, static_cast<int>(4 * i) + k)];
            if (n < 0) {
                n = static_cast<int>(node_.size());
                node_.push_back(layout_->quads()[quads_[i]][k]);
            }
            places_[i][k] = n;
        }
    }
    inner_neighbours_.resize(node_.size());
    for (std::size_t i = 0; i < quads_.size(); ++i) {
        for (int k = 0; k < 4; ++k) {
            const QuadLayout::Side& side = layout_->sides(quads_[i])[k];
            if (is_drawn[side.arc] || across(*layout_, quads_[i], k).quad < 0) continue;
            inner_neighbours_[places_[i][k]].push_back(places_[i][(k + 1) % 4]);
        }
    }
    for (auto& neighbours : inner_neighbours_) std::ranges::sort(neighbours);
}

void LayoutRegion::find_loops(const std::vector<bool>& is_drawn) {
    loop_of_.assign(node_.size(), -1);
    index_on_loop_.assign(node_.size(), -1);
    const auto is_boundary = [&](int quad, int side) {
        return is_drawn[layout_->sides(quad)[side].arc] || across(*layout_, quad, side).quad < 0;
    };
    for (std::size_t i = 0; i < quads_.size(); ++i) {
        for (int k = 0; k < 4; ++k) {
            if (!is_boundary(quads_[i], k) || loop_of_[places_[i][k]] >= 0) continue;
            std::vector<Place> loop;
            Place place{quads_[i], k};
            do {
                loop.push_back(place);
                // The next boundary side around the end of this one.
                place.side = (place.side + 1) % 4;
                while (!is_boundary(place.quad, place.side)) {
                    const QuadLayout::ArcQuad other = across(*layout_, place.quad, place.side);
                    place = {other.quad, (other.side + 1) % 4};
                }
            } while (place.quad != quads_[i] || place.side != k);
            for (std::size_t n = 0; n < loop.size(); ++n) {
                const auto local = std::ranges::lower_bound(quads_, loop[n].quad) - quads_.begin();
                const int here = places_[local][loop[n].side];
                loop_of_[here] = static_cast<int>(loops_.size());
                index_on_loop_[here] = static_cast<int>(n);
            }
            loops_.push_back(std::move(loop));
        }
    }
}

int LayoutRegion::euler_characteristic() const {
    return static_cast<int>(node_.size()) - n_arcs_ + static_cast<int>(quads_.size());
}

LayoutRegion::Place LayoutRegion::place_of(int place) const {
    return loops_.at(loop_of_[place]).at(index_on_loop_[place]);
}

// The paths of fewest arcs inside from a place to those of is_end, one for each of these.
std::vector<LayoutRegion::Path> LayoutRegion::paths_from(int start,
                                                         const std::vector<char>& is_end) const {
    std::vector<int> before(node_.size(), -1);
    std::vector<int> depth(node_.size(), -1);
    depth[start] = 0;
    std::vector<int> queue{start};
    std::vector<Path> paths;
    for (std::size_t k = 0; k < queue.size(); ++k) {
        const int here = queue[k];
        if (!paths.empty() && depth[here] + 1 >= static_cast<int>(paths[0].size())) break;
        for (const int next : inner_neighbours_[here]) {
            if (depth[next] >= 0) continue;
            depth[next] = depth[here] + 1;
            before[next] = here;
            if (is_end[next]) {
                Path path{next};
                while (path.back() != start) path.push_back(before[path.back()]);
                std::ranges::reverse(path);
                paths.push_back(std::move(path));
            } else if (loop_of_[next] < 0) {
                queue.push_back(next);
            }
        }
    }
    return paths;
}

std::vector<LayoutRegion::Path> LayoutRegion::paths_between_loops() const {
    std::vector<Path> all;
    std::size_t fewest = node_.size() + 1;
    for (int start = 0; start < static_cast<int>(node_.size()); ++start) {
        if (loop_of_[start] < 0) continue;
        std::vector<char> is_end(node_.size());
        for (std::size_t n = 0; n < node_.size(); ++n) is_end[n] = loop_of_[n] > loop_of_[start];
        for (Path& path : paths_from(start, is_end)) {
            if (path.size() < fewest) all.clear();
            if (path.size() > fewest) continue;
            fewest = path.size();
            all.push_back(std::move(path));
        }
    }
    return all;
}

LayoutRegion::Path LayoutRegion::dividing_path() const {
    std::vector<char> is_end(node_.size());
    for (std::size_t n = 0; n < node_.size(); ++n) is_end[n] = loop_of_[n] >= 0;
    Path best;
    int unbalance = 0;
    for (int start = 0; start < static_cast<int>(node_.size()); ++start) {
        if (loop_of_[start] < 0) continue;
        for (Path& path : paths_from(start, is_end)) {
            if (!best.empty() && path.size() > best.size()) continue;
            const int here = std::abs(2 * quads_left_of(path) - static_cast<int>(quads_.size()));
            if (best.empty() || path.size() < best.size() || here < unbalance) {
                best = std::move(path);
                unbalance = here;
            }
        }
    }
    if (best.empty()) throw TopologyError("layout: a region has no arc inside that divides it");
    return best;
}

// Quads of a disc left of a path that divides it.
int LayoutRegion::quads_left_of(const Path& path) const {
    std::vector<bool> is_cut(layout_->n_arcs(), false);
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        is_cut[layout_->find_arc(node_[path[k]], node_[path[k + 1]])] = true;
    }
    // Copies of a node on the boundary have arcs of their own, so cut arcs are those of the path.
    int start = -1;
    for (std::size_t i = 0; i < quads_.size(); ++i) {
        for (int k = 0; k < 4; ++k) {
            if (places_[i][k] == path[0] && places_[i][(k + 1) % 4] == path[1]) {
                start = static_cast<int>(i);
            }
        }
    }
    std::vector<char> is_seen(quads_.size(), 0);
    std::vector<int> stack{start};
    is_seen[start] = 1;
    int n = 0;
    while (!stack.empty()) {
        const int i = stack.back();
        stack.pop_back();
        ++n;
        for (int k = 0; k < 4; ++k) {
            const int arc = layout_->sides(quads_[i])[k].arc;
            const int from = places_[i][k];
            const int to = places_[i][(k + 1) % 4];
            if (is_cut[arc] || !std::ranges::binary_search(inner_neighbours_[from], to)) continue;
            const QuadLayout::ArcQuad other = across(*layout_, quads_[i], k);
            const auto local = std::ranges::lower_bound(quads_, other.quad) - quads_.begin();
            if (is_seen[local]) continue;
            is_seen[local] = 1;
            stack.push_back(static_cast<int>(local));
        }
    }
    return n;
}

std::vector<Vector2> LayoutRegion::tutte_embedding(std::span<const Vector2> polygon) const {
    std::vector<Vector2> points(node_.size(), Vector2::Zero());
    std::vector<int> unknown(node_.size(), -1);
    int n = 0;
    for (std::size_t p = 0; p < node_.size(); ++p) {
        if (loop_of_[p] >= 0) {
            points[p] = polygon[index_on_loop_[p]];
        } else {
            unknown[p] = n++;
        }
    }
    if (n == 0) return points;
    MatrixX matrix = MatrixX::Zero(n, n);
    MatrixX rhs = MatrixX::Zero(n, 2);
    for (std::size_t p = 0; p < node_.size(); ++p) {
        if (unknown[p] < 0) continue;
        for (const int neighbour : inner_neighbours_[p]) {
            matrix(unknown[p], unknown[p]) += 1.0;
            if (unknown[neighbour] >= 0) {
                matrix(unknown[p], unknown[neighbour]) -= 1.0;
            } else {
                rhs.row(unknown[p]) += points[neighbour].transpose();
            }
        }
    }
    const MatrixX solution = matrix.partialPivLu().solve(rhs);
    for (std::size_t p = 0; p < node_.size(); ++p) {
        if (unknown[p] >= 0) points[p] = solution.row(unknown[p]).transpose();
    }
    return points;
}

std::vector<LayoutRegion> LayoutRegion::parts(const std::vector<bool>& is_drawn) const {
    std::vector<LayoutRegion> regions;
    for (std::vector<int>& quads : connected_quads(*layout_, quads_, is_drawn)) {
        regions.emplace_back(*layout_, std::move(quads), is_drawn);
    }
    return regions;
}

std::vector<LayoutRegion> layout_regions(const QuadLayout& layout,
                                         const std::vector<bool>& is_drawn) {
    std::vector<int> all(layout.n_quads());
    std::iota(all.begin(), all.end(), 0);
    std::vector<LayoutRegion> regions;
    for (std::vector<int>& quads : connected_quads(layout, all, is_drawn)) {
        regions.emplace_back(layout, std::move(quads), is_drawn);
    }
    return regions;
}

}  // namespace couture::meshing
