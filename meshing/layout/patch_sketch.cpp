#include "meshing/layout/patch_sketch.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <set>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

Vector3 middle_of(const SurfaceMesh& mesh, const std::vector<VertexHandle>& vertices) {
    double length = 0.0;
    const auto step = [&](std::size_t k) {
        return (mesh.point(vertices[k + 1]) - mesh.point(vertices[k])).norm();
    };
    for (std::size_t k = 0; k + 1 < vertices.size(); ++k) length += step(k);
    double left = 0.5 * length;
    for (std::size_t k = 0; k + 1 < vertices.size(); ++k) {
        const double l = step(k);
        if (left <= l && l > 0.0) {
            return mesh.point(vertices[k]) +
                   left / l * (mesh.point(vertices[k + 1]) - mesh.point(vertices[k]));
        }
        left -= l;
    }
    return mesh.point(vertices.back());
}

// Names of the nodes, or curves, of two sketches.
struct Names {
    template <typename Items>
    Names(const Items& first_items, const Items& second_items) {
        for (const auto& item : first_items) first.insert(item.name);
        for (const auto& item : second_items) second.insert(item.name);
    }
    // A name that only one of the two sketches has does not count.
    [[nodiscard]] bool may_be_same(const std::string& a, const std::string& b) const {
        if (a == b) return true;
        return a.empty() ? !first.contains(b) : b.empty() && !second.contains(a);
    }

    std::set<std::string> first;
    std::set<std::string> second;
};

class Matcher {
  public:
    Matcher(const PatchSketch& first, const PatchSketch& second)
        : first_(first),
          second_(second),
          node_names_(first.nodes, second.nodes),
          curve_names_(first.curves, second.curves),
          is_taken_(second.nodes.size(), 0) {
        match_.nodes.assign(first.nodes.size(), -1);
        match_.curves.assign(first.curves.size(), -1);
        match_.is_reversed.assign(first.curves.size(), false);
    }

    SketchMatch run() {
        check_counts();
        for (int n = 0; n < static_cast<int>(first_.nodes.size()); ++n) {
            if (match_.nodes[n] < 0) match_part(n);
        }
        return std::move(match_);
    }

  private:
    void check_counts() const {
        bool is_same = first_.nodes.size() == second_.nodes.size() &&
                       first_.curves.size() == second_.curves.size() &&
                       first_.loops.size() == second_.loops.size();
        for (std::size_t l = 0; is_same && l < first_.loops.size(); ++l) {
            is_same = first_.loops[l].size() == second_.loops[l].size();
        }
        if (is_same) return;
        const auto text = [](const PatchSketch& sketch) {
            std::vector<std::size_t> on_loops;
            for (const auto& loop : sketch.loops) on_loops.push_back(loop.size());
            const auto n_corners =
                std::ranges::count_if(sketch.nodes, [](const auto& node) { return node.loop < 0; });
            return fmt::format("{} sharp edges, {} corners inside and {}", sketch.curves.size(),
                               n_corners,
                               on_loops.empty() ? std::string("no boundary loops")
                                                : fmt::format("boundary loops that {} of them meet",
                                                              fmt::join(on_loops, ", ")));
        };
        throw TopologyError("features don't match the reference: {}; the reference has {}",
                            text(second_), text(first_));
    }

    // The part of the first sketch that hangs together with a node: the nearest way to lay it.
    void match_part(int node) {
        const PatchSketch::Node& seed = first_.nodes[node];
        double least = std::numeric_limits<double>::infinity();
        std::optional<SketchMatch> best;
        const SketchMatch before = match_;
        for (int m = 0; m < static_cast<int>(second_.nodes.size()); ++m) {
            if (is_taken_[m] != 0) continue;
            const int n_turns = seed.loop >= 0 ? 1 : static_cast<int>(seed.curve_ends.size());
            for (int turn = 0; turn < n_turns; ++turn) {
                match_ = before;
                misfit_ = 0.0;
                if (!lay(node, m, turn) || misfit_ >= least) continue;
                least = misfit_;
                best = match_;
            }
        }
        if (!best) throw_no_partner(node);
        match_ = std::move(*best);
        for (const int m : match_.nodes) {
            if (m >= 0) is_taken_[m] = 1;
        }
    }

    [[noreturn]] void throw_no_partner(int node) const {
        const Vector3& x = first_.nodes[node].place;
        std::string name = first_.nodes[node].name;
        for (const int end : first_.nodes[node].curve_ends) {
            if (name.empty()) name = first_.curves[end / 2].name;
        }
        throw TopologyError(
            "features don't match the reference: the sharp edges that hang together with {}the "
            "place near ({:.6g}, {:.6g}, {:.6g}) meet in another way, or bend the other way",
            name.empty() ? "" : fmt::format("'{}' at ", name), x.x(), x.y(), x.z());
    }

    // Lays a node on another, and what hangs on it. Curve end i on end i + turn.
    bool lay(int n, int m, int turn) {
        std::vector<std::array<int, 3>> waiting{{n, m, turn}};
        while (!waiting.empty()) {
            const auto [a, b, t] = waiting.back();
            waiting.pop_back();
            if (match_.nodes[a] >= 0) {
                if (match_.nodes[a] != b) return false;
                continue;
            }
            if (!lay_node(a, b) || !lay_ends(a, b, t, waiting)) return false;
            if (first_.nodes[a].loop >= 0) lay_loop(a, b, waiting);
        }
        return true;
    }

    bool lay_node(int a, int b) {
        const PatchSketch::Node& first = first_.nodes[a];
        const PatchSketch::Node& second = second_.nodes[b];
        const bool fits = first.loop == second.loop &&
                          first.curve_ends.size() == second.curve_ends.size() &&
                          node_names_.may_be_same(first.name, second.name) && is_taken_[b] == 0 &&
                          std::ranges::find(match_.nodes, b) == match_.nodes.end();
        if (!fits) return false;
        match_.nodes[a] = b;
        misfit_ += (first.place - second.place).squaredNorm();
        return true;
    }

    bool lay_ends(int a, int b, int turn, std::vector<std::array<int, 3>>& waiting) {
        const auto& ends = first_.nodes[a].curve_ends;
        const auto& others = second_.nodes[b].curve_ends;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const int end = ends[i];
            const int other = others[(i + turn) % others.size()];
            if (!lay_curve(end, other)) return false;
            const int far = end ^ 1;
            const int far_other = other ^ 1;
            const int next = far % 2 == 0 ? first_.curves[far / 2].from : first_.curves[far / 2].to;
            const int next_other = far_other % 2 == 0 ? second_.curves[far_other / 2].from
                                                      : second_.curves[far_other / 2].to;
            const auto place = position(first_.nodes[next], far);
            const auto place_other = position(second_.nodes[next_other], far_other);
            const auto n = static_cast<int>(second_.nodes[next_other].curve_ends.size());
            const int next_turn = ((place_other - place) % n + n) % n;
            if (second_.nodes[next_other].loop >= 0 && next_turn != 0) return false;
            waiting.push_back({next, next_other, next_turn});
        }
        return true;
    }

    static int position(const PatchSketch::Node& node, int end) {
        return static_cast<int>(std::ranges::find(node.curve_ends, end) - node.curve_ends.begin());
    }

    bool lay_curve(int end, int other) {
        const bool is_reversed = end % 2 != other % 2;
        const int c = end / 2;
        const int d = other / 2;
        if (match_.curves[c] >= 0) {
            return match_.curves[c] == d && match_.is_reversed[c] == is_reversed;
        }
        if (first_.curves[c].kind != second_.curves[d].kind ||
            !curve_names_.may_be_same(first_.curves[c].name, second_.curves[d].name) ||
            std::ranges::find(match_.curves, d) != match_.curves.end()) {
            return false;
        }
        match_.curves[c] = d;
        match_.is_reversed[c] = is_reversed;
        misfit_ += (first_.curves[c].middle - second_.curves[d].middle).squaredNorm();
        return true;
    }

    // The next node on the same loop.
    void lay_loop(int a, int b, std::vector<std::array<int, 3>>& waiting) const {
        const auto next = [](const std::vector<int>& loop, int node) {
            const auto at = std::ranges::find(loop, node) - loop.begin();
            return loop[static_cast<std::size_t>(at + 1) % loop.size()];
        };
        const int l = first_.nodes[a].loop;
        waiting.push_back({next(first_.loops[l], a), next(second_.loops[l], b), 0});
    }

    const PatchSketch& first_;
    const PatchSketch& second_;
    Names node_names_;
    Names curve_names_;
    SketchMatch match_;
    std::vector<char> is_taken_;
    double misfit_ = 0.0;
};

}  // namespace

PatchSketch sketch_patch(const SurfaceMesh& mesh, const PatchFeatures& patch) {
    PatchSketch sketch;
    for (const auto& node : patch.nodes) {
        sketch.nodes.push_back({node.name, node.loop, node.curve_ends, mesh.point(node.vertex)});
    }
    for (const auto& curve : patch.curves) {
        sketch.curves.push_back(
            {curve.name, curve.from, curve.to, curve.kind, middle_of(mesh, curve.vertices)});
    }
    for (const auto& loop : patch.loops) sketch.loops.push_back(loop.nodes);
    return sketch;
}

SketchMatch match_sketches(const PatchSketch& first, const PatchSketch& second) {
    return Matcher(first, second).run();
}

PatchFeatures in_order_of(const PatchSketch& sketch, const SketchMatch& match,
                          const PatchFeatures& patch) {
    PatchFeatures result;
    for (std::size_t n = 0; n < sketch.nodes.size(); ++n) {
        result.nodes.push_back(patch.nodes[match.nodes[n]]);
        result.nodes.back().curve_ends = sketch.nodes[n].curve_ends;
    }
    for (std::size_t c = 0; c < sketch.curves.size(); ++c) {
        PatchFeatures::Curve& curve = result.curves.emplace_back(patch.curves[match.curves[c]]);
        curve.from = sketch.curves[c].from;
        curve.to = sketch.curves[c].to;
        if (match.is_reversed[c]) std::ranges::reverse(curve.vertices);
    }
    result.loops = patch.loops;
    for (std::size_t l = 0; l < result.loops.size(); ++l) {
        result.loops[l].nodes = sketch.loops[l];
    }
    return result;
}

}  // namespace couture::meshing
