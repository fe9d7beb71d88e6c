#include "meshing/topology/pants_record.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "iga/core/error.h"
#include "meshing/topology/invariants.h"
#include "meshing/topology/member_warp.h"

namespace couture::meshing {

namespace {

// Genus and centre of the box of each component.
std::vector<PantsRecord::Shell> measure_shells(const SurfaceMesh& mesh) {
    std::vector<PantsRecord::Shell> shells;
    for (const SurfaceInvariants& shell : component_invariants(mesh)) {
        shells.push_back({.genus = shell.genus});
    }
    std::vector<Eigen::AlignedBox3d> box(shells.size());
    const std::vector<int> component = face_components(mesh);
    for (const auto face : mesh.faces()) {
        for (const VertexHandle v : face_vertices(mesh, face)) {
            box[component[face.idx()]].extend(mesh.point(v));
        }
    }
    for (std::size_t s = 0; s < shells.size(); ++s) shells[s].center = box[s].center();
    return shells;
}

GuideLoop shape_of(const SurfaceMesh& mesh, const SurfaceCurve& curve) {
    GuideLoop samples;
    for (const VertexHandle vertex : curve.vertices) {
        samples.points.push_back(mesh.point(vertex));
        samples.normals.push_back(vertex_normal(mesh, vertex));
    }
    return samples;
}

// For each boundary of the record the loop of the member: by name, else the nearest.
std::vector<int> match_boundaries(const PantsRecord& record, const SurfaceMesh& mesh,
                                  const std::vector<std::string>& names, const MemberWarp& warp) {
    std::vector<const PantsRecord::Curve*> wanted;
    for (const auto& curve : record.curves) {
        if (curve.kind == PantsCurveKind::boundary) wanted.push_back(&curve);
    }
    const auto loops = boundary_loops(mesh);
    if (loops.size() != wanted.size()) {
        std::string open_there;
        for (const PantsRecord::Curve* curve : wanted) {
            open_there += fmt::format("{}{}", open_there.empty() ? ": " : ", ",
                                      curve->name.empty() ? "one without a name" : curve->name);
        }
        throw TopologyError(
            "replay: the surface has {} boundary loops, the recorded one has {}{}; open the same "
            "caps (--open, --open-at, --open-facing)",
            loops.size(), wanted.size(), open_there);
    }
    std::vector<char> is_taken(loops.size(), 0);
    std::vector<int> order;
    for (std::size_t b = 0; b < wanted.size(); ++b) {
        int match = -1;
        double least = std::numeric_limits<double>::infinity();
        const auto& points = wanted[b]->shape.points;
        Vector3 center = Vector3::Zero();
        for (const Vector3& x : points) center += warp(x) / static_cast<double>(points.size());
        for (std::size_t k = 0; k < loops.size(); ++k) {
            if (is_taken[k] != 0) continue;
            const std::string name = k < names.size() ? names[k] : std::string();
            if (name != wanted[b]->name) continue;
            const double distance = (loops[k].center - center).norm();
            if (distance < least) {
                least = distance;
                match = static_cast<int>(k);
            }
        }
        if (match < 0) {
            throw TopologyError("replay: no boundary loop of the surface is the cap '{}'",
                                wanted[b]->name);
        }
        is_taken[match] = 1;
        order.push_back(match);
    }
    return order;
}

// "1", or of several shells "1 + 0".
std::string genera(const std::vector<PantsRecord::Shell>& shells) {
    std::string text;
    for (const auto& shell : shells) {
        text += fmt::format("{}{}", text.empty() ? "" : " + ", shell.genus);
    }
    return text;
}

// For each shell of the member that of the record with the same genus that is nearest.
std::vector<int> match_shells(const PantsRecord& record, const SurfaceMesh& mesh,
                              const MemberWarp& warp) {
    const auto shells = measure_shells(mesh);
    std::vector<int> partner(shells.size(), -1);
    for (std::size_t r = 0; r < record.shells.size(); ++r) {
        const Vector3 center = warp(record.shells[r].center);
        int match = -1;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t s = 0; s < shells.size(); ++s) {
            const double distance = (shells[s].center - center).norm();
            if (partner[s] >= 0 || shells[s].genus != record.shells[r].genus) continue;
            if (distance >= least) continue;
            least = distance;
            match = static_cast<int>(s);
        }
        if (match >= 0) partner[match] = static_cast<int>(r);
    }
    if (shells.size() != record.shells.size() ||
        std::find(partner.begin(), partner.end(), -1) != partner.end()) {
        throw TopologyError("replay: the surface has genus {}, the recorded one has {}",
                            genera(shells), genera(record.shells));
    }
    return partner;
}

// Brings the patches into the order of the record.
void order_patches(PantsDecomposition& pants, const PantsRecord& record,
                   const std::vector<int>& shell_of_record) {
    std::vector<int> number(pants.patches.size(), -1);
    for (std::size_t p = 0; p < pants.patches.size(); ++p) {
        pants.patches[p].shell = shell_of_record[pants.patches[p].shell];
        std::size_t known = 0;
        while (known < record.patches.size() &&
               !(record.patches[known] == pants.patches[p].boundary &&
                 record.shell_of_patch[known] == pants.patches[p].shell)) {
            ++known;
        }
        if (known == record.patches.size()) {
            std::string sides;
            for (const CurveSide& side : pants.patches[p].boundary) {
                sides += fmt::format(" {}{}", side.curve, side.is_left ? " left" : " right");
            }
            throw TopologyError(
                "replay: a patch is bounded by the curves{}, which is none of the recorded ones; "
                "the curves don't run around the same parts as on the recorded member",
                sides);
        }
        number[p] = static_cast<int>(known);
    }
    std::vector<PantsPatch> patches(pants.patches.size());
    for (std::size_t p = 0; p < patches.size(); ++p) patches[number[p]] = pants.patches[p];
    pants.patches = std::move(patches);
    for (int& patch : pants.patch_of_face) patch = number[patch];
}

// Places along a closed polygon.
class ClosedPolygon {
  public:
    explicit ClosedPolygon(std::vector<Vector3> points) : points_(std::move(points)) {
        for (std::size_t k = 0; k < points_.size(); ++k) {
            gone_.push_back(gone_.back() + (points_[(k + 1) % points_.size()] - points_[k]).norm());
        }
    }
    [[nodiscard]] double length() const { return gone_.back(); }
    [[nodiscard]] double length_up_to(std::size_t point) const { return gone_[point]; }
    // @param way  from the first point on, in [0, 2 length)
    [[nodiscard]] Vector3 at(double way) const {
        if (way >= length()) way -= length();
        const auto after = std::ranges::upper_bound(gone_, way) - gone_.begin();
        const auto k = std::min<std::size_t>(after - 1, points_.size() - 1);
        const double step = gone_[k + 1] - gone_[k];
        const double t = step > 0.0 ? (way - gone_[k]) / step : 0.0;
        return (1.0 - t) * points_[k] + t * points_[(k + 1) % points_.size()];
    }

  private:
    std::vector<Vector3> points_;
    std::vector<double> gone_{0.0};
};

// Lets a closed curve start where it runs nearest to one of the same direction.
void align_start(const SurfaceMesh& mesh, std::vector<VertexHandle>& vertices,
                 const std::vector<Vector3>& like) {
    constexpr int n_places = 16;
    std::vector<Vector3> points;
    for (const VertexHandle v : vertices) points.push_back(mesh.point(v));
    const ClosedPolygon curve(std::move(points));
    const ClosedPolygon wanted(like);
    double least = std::numeric_limits<double>::infinity();
    std::size_t start = 0;
    for (std::size_t s = 0; s < vertices.size(); ++s) {
        double sum = 0.0;
        for (int k = 0; k < n_places; ++k) {
            const double part = static_cast<double>(k) / n_places;
            sum += (curve.at(curve.length_up_to(s) + part * curve.length()) -
                    wanted.at(part * wanted.length()))
                       .squaredNorm();
        }
        if (sum >= least) continue;
        least = sum;
        start = s;
    }
    std::rotate(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(start),
                vertices.end());
}

// Whether tori were cut: one that was not has a patch without boundary.
bool has_cut_tori(const PantsRecord& record) {
    for (std::size_t p = 0; p < record.patches.size(); ++p) {
        const bool is_torus = record.shells[record.shell_of_patch[p]].genus == 1;
        if (is_torus && record.patches[p].empty()) return false;
    }
    return true;
}

}  // namespace

PantsRecord record_pants(const SurfaceMesh& mesh, const PantsDecomposition& pants,
                         const Landmarks& landmarks) {
    PantsRecord record;
    const auto [low, high] = surface_box(mesh);
    record.box_min = low;
    record.box_max = high;
    record.landmarks = landmarks;
    record.shells = measure_shells(mesh);
    for (const PantsCurve& curve : pants.curves) {
        record.curves.push_back(
            {.kind = curve.kind, .name = curve.name, .shape = shape_of(mesh, curve.curve)});
    }
    for (const PantsPatch& patch : pants.patches) {
        record.patches.push_back(patch.boundary);
        record.shell_of_patch.push_back(patch.shell);
    }
    return record;
}

PantsDecomposition replay_pants(SurfaceMesh& mesh, const PantsRecord& record,
                                const std::vector<std::string>& boundary_names,
                                const Landmarks& landmarks, double width) {
    const MemberWarp warp(record, mesh, landmarks);
    const std::vector<int> shell_of_record = match_shells(record, mesh, warp);
    PantsOptions options;
    options.loop_width = width;
    options.only_given_loops = true;
    options.cuts_tori = has_cut_tori(record);
    options.boundary_names = boundary_names;
    options.boundary_order = match_boundaries(record, mesh, boundary_names, warp);
    for (const auto& curve : record.curves) {
        if (curve.kind == PantsCurveKind::boundary) continue;
        GuideLoop& guide = options.loops.emplace_back(curve.shape);
        for (Vector3& x : guide.points) x = warp(x);
    }
    PantsDecomposition pants = decompose_into_pants(mesh, options);
    for (std::size_t c = 0; c < record.curves.size(); ++c) {
        if (pants.curves[c].kind == record.curves[c].kind) continue;
        throw TopologyError("replay: curve {} is a {} here and was a {} on the recorded member", c,
                            to_string(pants.curves[c].kind), to_string(record.curves[c].kind));
    }
    for (std::size_t c = 0; c < record.curves.size(); ++c) {
        std::vector<Vector3> like = record.curves[c].shape.points;
        for (Vector3& x : like) x = warp(x);
        align_start(mesh, pants.curves[c].curve.vertices, like);
    }
    order_patches(pants, record, shell_of_record);
    return pants;
}

}  // namespace couture::meshing
