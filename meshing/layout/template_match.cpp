#include "meshing/layout/template_match.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

// Steps of a search after which what was found so far must do.
constexpr long max_steps = 400'000;

std::pair<int, int> in_order(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

// What the wall of a template looks like to a search.
struct Wall {
    explicit Wall(const CuboidTemplate& shape)
        : boundary(wall_of(shape)), kinds(arc_kinds(shape, boundary)), cap_of_node() {
        const QuadLayout& layout = boundary.layout;
        around.resize(layout.n_nodes());
        std::vector<std::map<int, int>> next(layout.n_nodes());
        for (const auto& quad : layout.quads()) {
            for (int k = 0; k < 4; ++k) next[quad[k]][quad[(k + 1) % 4]] = quad[(k + 3) % 4];
        }
        for (int n = 0; n < layout.n_nodes(); ++n) {
            if (next[n].empty()) continue;
            int start = next[n].begin()->first;
            for (const auto& [from, to] : next[n]) {
                const bool is_first = std::ranges::none_of(
                    next[n], [&](const auto& step) { return step.second == from; });
                if (is_first) start = from;
            }
            around[n].push_back(start);
            for (auto step = next[n].find(start); step != next[n].end() && step->second != start;
                 step = next[n].find(step->second)) {
                around[n].push_back(step->second);
            }
        }
        cap_of_node.assign(layout.n_nodes(), -1);
        for (int c = 0; c < shape.n_caps(); ++c) {
            std::vector<int> loop = cap_pattern(shape, c).loop;
            std::ranges::reverse(loop);
            for (const int node : loop) cap_of_node[node] = c;
            loops.push_back(std::move(loop));
        }
        for (int a = 0; a < layout.n_arcs(); ++a) {
            if (kinds[a] != ArcKind::flat && !layout.is_boundary_arc(a)) ++n_edges;
        }
    }

    [[nodiscard]] ArcKind kind(int from, int to) const {
        return kinds[boundary.layout.find_arc(from, to)];
    }
    // Where a neighbour comes around a node.
    [[nodiscard]] int position(int node, int neighbour) const {
        const auto& list = around[node];
        return static_cast<int>(std::ranges::find(list, neighbour) - list.begin());
    }

    LayoutBoundary boundary;
    std::vector<ArcKind> kinds;
    // Neighbours counter-clockwise; at the boundary from the one that follows on the loop.
    std::vector<std::vector<int>> around;
    // The wall on the left.
    std::vector<std::vector<int>> loops;
    std::vector<int> cap_of_node;
    // Arcs inside that are made for sharp edges.
    int n_edges = 0;
};

class Search {
  public:
    Search(const SurfaceMesh& mesh, const PatchFeatures& patch, const CuboidTemplate& shape,
           const MatchOptions& options)
        : mesh_(mesh),
          patch_(patch),
          shape_(shape),
          options_(options),
          wall_(shape),
          image_(patch.nodes.size(), -1),
          path_(patch.curves.size()),
          cap_(patch.loops.size(), -1),
          is_used_(shape.layout.n_nodes, 0),
          is_cap_used_(shape.n_caps(), 0) {}

    std::vector<TemplateMatch> run() {
        if (static_cast<int>(patch_.loops.size()) == shape_.n_caps()) go_on();
        std::ranges::stable_sort(matches_, {}, &TemplateMatch::cost);
        if (static_cast<int>(matches_.size()) > options_.max_matches) {
            matches_.resize(options_.max_matches);
        }
        return std::move(matches_);
    }

  private:
    // Decides on what is undecided, in turn: curves with known ends, loops, corners.
    void go_on() {
        if (++n_steps_ > max_steps) return;
        int half_known = -1;
        for (int c = 0; c < static_cast<int>(patch_.curves.size()); ++c) {
            if (!path_[c].empty()) continue;
            const bool from = image_[patch_.curves[c].from] >= 0;
            const bool to = image_[patch_.curves[c].to] >= 0;
            if (from && to) return lay_curve(c, true);
            if ((from || to) && half_known < 0) half_known = c;
        }
        if (half_known >= 0)
            return lay_curve(half_known, image_[patch_.curves[half_known].from] >= 0);
        for (int l = 0; l < static_cast<int>(patch_.loops.size()); ++l) {
            const auto& nodes = patch_.loops[l].nodes;
            const bool is_open = std::ranges::any_of(nodes, [&](int n) { return image_[n] < 0; });
            if (is_open) return lay_loop(l);
        }
        for (int n = 0; n < static_cast<int>(patch_.nodes.size()); ++n) {
            if (image_[n] < 0) return lay_corner(n);
        }
        for (int l = 0; l < static_cast<int>(patch_.loops.size()); ++l) {
            if (cap_[l] < 0) return lay_empty_loop(l);
        }
        finish();
    }

    // All paths for a curve from the end that is known.
    void lay_curve(int c, bool forwards) {
        const PatchFeatures::Curve& curve = patch_.curves[c];
        const int start = forwards ? curve.from : curve.to;
        std::vector<int> path{image_[start]};
        extend(c, forwards, path);
    }

    void extend(int c, bool forwards, std::vector<int>& path) {
        if (++n_steps_ > max_steps) return;
        const PatchFeatures::Curve& curve = patch_.curves[c];
        const int end = forwards ? curve.to : curve.from;
        const int here = path.back();
        for (const int next : wall_.around[here]) {
            if (is_arc_used_.contains(in_order(here, next))) continue;
            if (wall_.boundary.layout.is_boundary_arc(wall_.boundary.layout.find_arc(here, next)) ||
                wall_.kind(here, next) != curve.kind) {
                continue;
            }
            const bool arrives = image_[end] >= 0 ? next == image_[end] : can_be(end, next);
            const bool passes = !is_used_[next] && wall_.cap_of_node[next] < 0;
            if (!arrives && !passes) continue;
            is_arc_used_.insert(in_order(here, next));
            path.push_back(next);
            if (arrives) close_curve(c, forwards, path);
            if (passes) {
                is_used_[next] = 1;
                extend(c, forwards, path);
                is_used_[next] = 0;
            }
            path.pop_back();
            is_arc_used_.erase(in_order(here, next));
        }
    }

    void close_curve(int c, bool forwards, const std::vector<int>& path) {
        const int end = forwards ? patch_.curves[c].to : patch_.curves[c].from;
        const bool is_new = image_[end] < 0;
        if (is_new && !assign(end, path.back())) return;
        path_[c] = path;
        if (!forwards) std::ranges::reverse(path_[c]);
        if (has_order(patch_.curves[c].from) && has_order(patch_.curves[c].to)) go_on();
        path_[c].clear();
        if (is_new) release(end);
    }

    // Whether a free node of the template may stand for a feature node.
    [[nodiscard]] bool can_be(int n, int node) const {
        if (is_used_[node]) return false;
        const int cap = wall_.cap_of_node[node];
        const int loop = patch_.nodes[n].loop;
        if ((cap >= 0) != (loop >= 0)) return false;
        if (loop >= 0 && (cap_[loop] >= 0 ? cap_[loop] != cap : is_cap_used_[cap] != 0)) {
            return false;
        }
        std::array<int, 3> missing{};
        for (const int end : patch_.nodes[n].curve_ends) {
            ++missing[static_cast<int>(patch_.curves[end / 2].kind)];
        }
        for (const int neighbour : wall_.around[node]) {
            const int arc = wall_.boundary.layout.find_arc(node, neighbour);
            if (!wall_.boundary.layout.is_boundary_arc(arc)) {
                --missing[static_cast<int>(wall_.kinds[arc])];
            }
        }
        return std::ranges::all_of(missing, [](int m) { return m <= 0; });
    }

    bool assign(int n, int node) {
        image_[n] = node;
        is_used_[node] = 1;
        const int loop = patch_.nodes[n].loop;
        if (loop < 0) return true;
        if (cap_[loop] < 0) {
            cap_[loop] = wall_.cap_of_node[node];
            is_cap_used_[cap_[loop]] = 1;
            first_on_[loop] = n;
        }
        if (has_loop_order(loop)) return true;
        release(n);
        return false;
    }

    void release(int n) {
        is_used_[image_[n]] = 0;
        image_[n] = -1;
        const int loop = patch_.nodes[n].loop;
        if (loop >= 0 && first_on_.contains(loop) && first_on_[loop] == n) {
            is_cap_used_[cap_[loop]] = 0;
            cap_[loop] = -1;
            first_on_.erase(loop);
        }
    }

    // Whether increasing places come around in order, starting anywhere.
    [[nodiscard]] static bool is_cyclic(const std::vector<int>& places) {
        int descents = 0;
        for (std::size_t k = 0; k < places.size(); ++k) {
            descents += places[k] > places[(k + 1) % places.size()] ? 1 : 0;
        }
        return descents <= 1;
    }

    [[nodiscard]] bool has_loop_order(int l) const {
        const auto& ring = wall_.loops[cap_[l]];
        std::vector<int> places;
        for (const int n : patch_.loops[l].nodes) {
            if (image_[n] < 0) continue;
            places.push_back(static_cast<int>(std::ranges::find(ring, image_[n]) - ring.begin()));
        }
        return is_cyclic(places);
    }

    [[nodiscard]] bool has_order(int n) const {
        std::vector<int> places;
        for (const int end : patch_.nodes[n].curve_ends) {
            const auto& path = path_[end / 2];
            if (path.empty()) continue;
            const int neighbour = end % 2 == 0 ? path[1] : path[path.size() - 2];
            places.push_back(wall_.position(image_[n], neighbour));
        }
        return patch_.nodes[n].loop >= 0 ? std::ranges::is_sorted(places) : is_cyclic(places);
    }

    // All places for the first node of a loop that has none.
    void lay_loop(int l) {
        for (const int n : patch_.loops[l].nodes) {
            if (image_[n] < 0) return lay_corner(n);
        }
    }

    void lay_corner(int n) {
        for (int node = 0; node < shape_.layout.n_nodes; ++node) {
            if (wall_.around[node].empty() || !can_be(n, node)) continue;
            if (!assign(n, node)) continue;
            go_on();
            release(n);
        }
    }

    void lay_empty_loop(int l) {
        for (int c = 0; c < shape_.n_caps(); ++c) {
            if (is_cap_used_[c]) continue;
            cap_[l] = c;
            is_cap_used_[c] = 1;
            go_on();
            is_cap_used_[c] = 0;
            cap_[l] = -1;
        }
    }

    void finish() {
        TemplateMatch match;
        match.caps = cap_;
        match.nodes = image_;
        match.curves = path_;
        const auto motion = best_motion();
        // A patch without sharp edges leaves all of them unused, whichever the template; then
        // cuboids count, since there will be one more below each of their outer sides.
        int n_unused_edges = patch_.nodes.empty() ? 2 * shape_.layout.n_cuboids() : wall_.n_edges;
        for (const auto& path : path_) n_unused_edges -= static_cast<int>(path.size()) - 1;
        match.cost = options_.cuboid_cost * shape_.layout.n_cuboids() +
                     options_.unused_edge_cost * n_unused_edges +
                     options_.misfit_cost * motion.second;
        add_turns(std::move(match), motion.first, 0);
    }

    // The motion and scaling of the template that brings its caps and nodes nearest to the patch's,
    // and the mean distance left.
    [[nodiscard]] std::pair<Eigen::Matrix4d, double> best_motion() const {
        std::vector<Vector3> from;
        std::vector<Vector3> to;
        const auto add = [&](const Vector3& a, const Vector3& b) {
            from.push_back(a);
            to.push_back(b);
        };
        for (std::size_t l = 0; l < patch_.loops.size(); ++l) {
            add(mean(template_loop(l)), mean(patch_loop(l)));
        }
        for (std::size_t n = 0; n < patch_.nodes.size(); ++n) {
            add(shape_.positions[image_[n]], mesh_.point(patch_.nodes[n].vertex));
        }
        if (patch_.nodes.empty()) {
            add_centre(from, to);
            for (std::size_t l = 0; l < patch_.loops.size(); ++l) {
                from.push_back(from[l] + outward(template_loop(l)));
                to.push_back(to[l] + outward(patch_loop(l)));
            }
        }
        const auto n = static_cast<Eigen::Index>(from.size());
        Eigen::Matrix3Xd source(3, n);
        Eigen::Matrix3Xd target(3, n);
        for (Eigen::Index i = 0; i < n; ++i) {
            source.col(i) = from[i];
            target.col(i) = to[i];
        }
        const Eigen::Matrix4d motion = Eigen::umeyama(source, target, true);
        double misfit = 0.0;
        double spread = 0.0;
        const Vector3 centre = target.rowwise().mean();
        for (Eigen::Index i = 0; i < n; ++i) {
            misfit += (target.col(i) - (motion * source.col(i).homogeneous()).head<3>()).norm();
            spread += (target.col(i) - centre).norm();
        }
        return {motion, spread > 0.0 ? misfit / spread : 0.0};
    }

    [[nodiscard]] std::vector<Vector3> template_loop(std::size_t l) const {
        std::vector<Vector3> points;
        for (const int node : wall_.loops[cap_[l]]) points.push_back(shape_.positions[node]);
        return points;
    }

    [[nodiscard]] std::vector<Vector3> patch_loop(std::size_t l) const {
        std::vector<Vector3> points;
        for (const VertexHandle v : patch_.loops[l].vertices) points.push_back(mesh_.point(v));
        return points;
    }

    [[nodiscard]] static Vector3 mean(const std::vector<Vector3>& points) {
        Vector3 sum = Vector3::Zero();
        for (const Vector3& x : points) sum += x;
        return sum / static_cast<double>(points.size());
    }

    // Normal of a loop with the wall on its left, out of the patch, as long as the radius of a
    // circle of its area.
    [[nodiscard]] static Vector3 outward(const std::vector<Vector3>& loop) {
        const Vector3 centre = mean(loop);
        Vector3 area = Vector3::Zero();
        for (std::size_t k = 0; k < loop.size(); ++k) {
            area -= 0.5 * (loop[k] - centre).cross(loop[(k + 1) % loop.size()] - centre);
        }
        return std::sqrt(area.norm() / std::numbers::pi) * area.stableNormalized();
    }

    // Of a patch without features: what tells its middle.
    void add_centre(std::vector<Vector3>& from, std::vector<Vector3>& to) const {
        Vector3 a = Vector3::Zero();
        for (const Vector3& x : shape_.positions) a += x;
        Vector3 b = Vector3::Zero();
        for (const Vector3& x : to) b += x;
        from.push_back(a / static_cast<double>(shape_.positions.size()));
        to.push_back(b / static_cast<double>(to.size()));
    }

    // Loops without feature nodes may be turned; the rest of the match is complete.
    void add_turns(TemplateMatch match, const Eigen::Matrix4d& motion, std::size_t l) {
        if (l == patch_.loops.size()) {
            matches_.push_back(std::move(match));
            return;
        }
        const auto& ring = wall_.loops[match.caps[l]];
        const std::size_t n = ring.size();
        const auto turned = [&](std::size_t start) {
            TemplateMatch copy = match;
            copy.loop_nodes.emplace_back();
            for (std::size_t k = 0; k < n; ++k) {
                copy.loop_nodes.back().push_back(ring[(start + k) % n]);
            }
            return copy;
        };
        if (!patch_.loops[l].nodes.empty()) {
            const auto at = std::ranges::find(ring, image_[patch_.loops[l].nodes[0]]);
            return add_turns(turned(at - ring.begin()), motion, l + 1);
        }
        for (std::size_t start = 0; start < n; ++start) {
            TemplateMatch copy = turned(start);
            copy.cost += options_.misfit_cost * turn_misfit(l, copy.loop_nodes.back(), motion);
            add_turns(std::move(copy), motion, l + 1);
        }
    }

    // How far evenly spread nodes of a loop are from where the motion brings the template's, over
    // the loop's mean radius and the number of loops.
    [[nodiscard]] double turn_misfit(std::size_t l, const std::vector<int>& nodes,
                                     const Eigen::Matrix4d& motion) const {
        const auto& vertices = patch_.loops[l].vertices;
        const Vector3 centre = mean(patch_loop(l));
        const Vector3 cap = mean(template_loop(l));
        const std::vector<int> places =
            even_places(mesh_, vertices, static_cast<int>(nodes.size()));
        double misfit = 0.0;
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            const Vector3 aim =
                (motion.topLeftCorner<3, 3>() * (shape_.positions[nodes[k]] - cap)).normalized();
            const Vector3 is = (mesh_.point(vertices[places[k]]) - centre).normalized();
            misfit += (aim - is).norm();
        }
        return misfit / static_cast<double>(nodes.size() * patch_.loops.size());
    }

    const SurfaceMesh& mesh_;
    const PatchFeatures& patch_;
    const CuboidTemplate& shape_;
    const MatchOptions& options_;
    Wall wall_;
    std::vector<int> image_;
    std::vector<std::vector<int>> path_;
    std::vector<int> cap_;
    std::vector<char> is_used_;
    std::vector<char> is_cap_used_;
    std::set<std::pair<int, int>> is_arc_used_;
    std::map<int, int> first_on_;
    std::vector<TemplateMatch> matches_;
    long n_steps_ = 0;
};

}  // namespace

std::vector<int> even_places(const SurfaceMesh& mesh, const std::vector<VertexHandle>& loop,
                             int n) {
    std::vector<double> length{0.0};
    for (std::size_t k = 0; k < loop.size(); ++k) {
        length.push_back(length.back() +
                         (mesh.point(loop[(k + 1) % loop.size()]) - mesh.point(loop[k])).norm());
    }
    std::vector<int> places;
    for (int i = 0; i < n; ++i) {
        const double aim = length.back() * i / n;
        const auto next = std::ranges::lower_bound(length, aim) - length.begin();
        const bool is_before = next > 0 && aim - length[next - 1] < length[next] - aim;
        const int nearest = static_cast<int>(is_before ? next - 1 : next);
        const int last = static_cast<int>(loop.size()) - (n - i);
        places.push_back(std::clamp(nearest, places.empty() ? 0 : places.back() + 1, last));
    }
    return places;
}

std::vector<TemplateMatch> match_template(const SurfaceMesh& mesh, const PatchFeatures& patch,
                                          const CuboidTemplate& shape,
                                          const MatchOptions& options) {
    return Search(mesh, patch, shape, options).run();
}

}  // namespace couture::meshing
