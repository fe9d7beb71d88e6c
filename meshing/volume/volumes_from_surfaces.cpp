#include "meshing/volume/volumes_from_surfaces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "iga/core/error.h"
#include "iga/spline/refine.h"
#include "iga/topology/snap_knots.h"
#include "meshing/volume/coons.h"
#include "meshing/volume/layout_nets.h"
#include "meshing/volume/six_faces.h"

namespace couture::meshing {

namespace {

using Quad = std::array<int, 4>;

/// Points per direction at which surfaces are compared and enclosed volumes summed.
constexpr int n_samples = 9;
/// Knots this close together are one: files keep some digits only.
constexpr double knot_tolerance = 1e-8;
/// Borders this close together, in parts of the size of the whole, agree but for rounding.
constexpr double rounding = 1e-12;

// Numbers of points, equal where they are within a tolerance of the first of their kind.
class PointNumbers {
  public:
    explicit PointNumbers(double tolerance) : tolerance_(tolerance) {}

    int number(const Vector3& x) {
        const Cell cell = cell_of(x);
        for (int i = 0; i < 27; ++i) {
            const auto place =
                cells_.find({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1});
            if (place == cells_.end()) continue;
            for (const int known : place->second) {
                if ((points_[known] - x).norm() <= tolerance_) return known;
            }
        }
        cells_[cell].push_back(static_cast<int>(points_.size()));
        points_.push_back(x);
        return static_cast<int>(points_.size()) - 1;
    }
    [[nodiscard]] int size() const { return static_cast<int>(points_.size()); }

  private:
    using Cell = std::array<long, 3>;
    [[nodiscard]] Cell cell_of(const Vector3& x) const {
        return {std::lround(std::floor(x[0] / tolerance_)),
                std::lround(std::floor(x[1] / tolerance_)),
                std::lround(std::floor(x[2] / tolerance_))};
    }

    double tolerance_;
    std::vector<Vector3> points_;
    std::map<Cell, std::vector<int>> cells_;
};

// A surface over the unit square with its corners, and samples on a grid.
struct Face {
    int surface = 0;
    iga::Surface patch;
    /// At (0, 0), (1, 0), (0, 1), (1, 1).
    Quad nodes{};
    MatrixX samples;
    /// Volume of the cone over it from the middle of the whole, in its own orientation.
    double cone = 0.0;
};

iga::Surface over_unit_square(const iga::Surface& surface) {
    iga::TensorSpace<2> space = surface.space();
    for (auto& knots : space.knots) knots = knots.rescaled(0.0, 1.0);
    return {space, surface.control_points(), surface.weights()};
}

Face make_face(int number, const iga::Surface& surface, const Vector3& middle,
               PointNumbers& points) {
    Face face{number, over_unit_square(surface), {}, MatrixX(3, n_samples * n_samples)};
    for (int i = 0; i < face.samples.cols(); ++i) {
        const Vector2 xi(i % n_samples, i / n_samples);
        face.samples.col(i) = face.patch.point(xi / (n_samples - 1));
    }
    for (int k = 0; k < 4; ++k) {
        face.nodes[k] =
            points.number(face.samples.col((n_samples - 1) * ((k & 1) + n_samples * (k >> 1))));
    }
    for (int j = 0; j + 1 < n_samples; ++j) {
        for (int i = 0; i + 1 < n_samples; ++i) {
            const int at = i + n_samples * j;
            const Vector3 a = face.samples.col(at) - middle;
            const Vector3 b = face.samples.col(at + 1) - middle;
            const Vector3 c = face.samples.col(at + n_samples + 1) - middle;
            const Vector3 d = face.samples.col(at + n_samples) - middle;
            face.cone += (a.dot(b.cross(c)) + a.dot(c.cross(d))) / 6.0;
        }
    }
    return face;
}

// The faces that can bound volumes: four corners, each once.
std::vector<Face> make_faces(std::span<const iga::Surface> surfaces, double tolerance,
                             SurfacesReport& report) {
    Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
    Vector3 high = -low;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (surfaces[i].dimension() != 3) {
            throw InputError(
                "volumes_from_surfaces: surface {} lies in the plane; all must lie in "
                "space",
                i);
        }
        low = low.cwiseMin(surfaces[i].control_points().colwise().minCoeff().transpose());
        high = high.cwiseMax(surfaces[i].control_points().colwise().maxCoeff().transpose());
    }
    const double distance = tolerance * (high - low).norm();
    PointNumbers points(distance);
    std::map<Quad, int> face_of_nodes;
    std::vector<Face> faces;
    for (int i = 0; i < static_cast<int>(surfaces.size()); ++i) {
        Face face = make_face(i, surfaces[i], 0.5 * (low + high), points);
        Quad nodes = face.nodes;
        std::ranges::sort(nodes);
        if (std::ranges::adjacent_find(nodes) != nodes.end()) {
            report.collapsed.push_back(i);
            continue;
        }
        const auto [place, is_new] = face_of_nodes.try_emplace(nodes, faces.size());
        if (is_new) {
            faces.push_back(std::move(face));
            continue;
        }
        const Face& original = faces[place->second];
        const auto places =
            grid_places(map_of_nodes(original.nodes, face.nodes), {n_samples, n_samples});
        const MatrixX difference = face.samples(Eigen::all, places) - original.samples;
        report.duplicates.push_back({i, original.surface, difference.colwise().norm().maxCoeff()});
    }
    return faces;
}

Quad cycle_of(const Face& face) {
    return {face.nodes[0], face.nodes[1], face.nodes[3], face.nodes[2]};
}

// +1 where a face's own normal points out of a cuboid on one of its sides.
int outward(const Face& face, const VolumetricLayout& layout, const CuboidSide& side) {
    const Quad outside = layout.nodes_of(side);
    const Quad own = cycle_of(face);
    const auto at = std::ranges::find(own, outside[0]) - own.begin();
    return own[(at + 1) % 4] == outside[1] ? 1 : -1;
}

double enclosed_volume(const std::vector<Face>& faces, const SixFaces& cuboid) {
    const VolumetricLayout alone{0, {cuboid.nodes}, {}};
    double volume = 0.0;
    for (int side = 0; side < 6; ++side) {
        const Face& face = faces[cuboid.faces[side]];
        volume += outward(face, alone, {0, side}) * face.cone;
    }
    return volume;
}

// Right-handed cuboids, at most one on each side of a face: the smaller one.
std::vector<SixFaces> choose_cuboids(const std::vector<Face>& faces, SurfacesReport& report) {
    std::vector<Quad> quads;
    for (const Face& face : faces) quads.push_back(cycle_of(face));
    struct Candidate {
        SixFaces cuboid;
        double volume;
    };
    std::vector<Candidate> candidates;
    for (SixFaces& cuboid : find_six_faces(quads)) {
        const double volume = enclosed_volume(faces, cuboid);
        candidates.push_back({volume < 0.0 ? mirrored(cuboid) : cuboid, std::abs(volume)});
    }
    std::ranges::stable_sort(candidates, {}, &Candidate::volume);
    std::map<std::pair<int, int>, int> taken;
    std::vector<SixFaces> chosen;
    for (const auto& [cuboid, volume] : candidates) {
        const VolumetricLayout alone{0, {cuboid.nodes}, {}};
        std::array<std::pair<int, int>, 6> keys;
        for (int side = 0; side < 6; ++side) {
            const int face = cuboid.faces[side];
            keys[side] = {face, outward(faces[face], alone, {0, side})};
        }
        if (std::ranges::any_of(keys, [&](const auto& key) { return taken.contains(key); })) {
            auto& surfaces = report.enclosing.emplace_back();
            for (int side = 0; side < 6; ++side) surfaces[side] = faces[cuboid.faces[side]].surface;
            continue;
        }
        for (const auto& key : keys) taken[key] = 1;
        chosen.push_back(cuboid);
    }
    std::ranges::sort(chosen, {}, &SixFaces::faces);
    return chosen;
}

// Faces in their frames of a layout.
class SurfaceNets {
  public:
    SurfaceNets(const LayoutCells& cells, std::vector<const Face*> faces)
        : cells_(cells), faces_(std::move(faces)) {
        is_rational_ =
            std::ranges::any_of(faces_, [](const Face* face) { return face->patch.is_rational(); });
        find_knots();
    }

    LayoutNets run(int n_nodes, double size, SurfacesReport& report) {
        for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
            nets_.faces.push_back(own_net(f));
        }
        scale_weights(n_nodes);
        average_nodes(n_nodes);
        average_edges(size, report);
        for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
            MatrixX& net = nets_.faces[f];
            const MatrixX change = with_border(cells_, nets_, f, net) - net;
            net += fill_coons<2>(face_space(cells_, nets_.knots, f), change);
            net = with_border(cells_, nets_, f, std::move(net));
        }
        return std::move(nets_);
    }

  private:
    // Directions of the cells' face k on the surface.
    [[nodiscard]] iga::SideMap<3> map(int f) const {
        return map_of_nodes(cells_.faces[f].nodes, faces_[f]->nodes);
    }

    // Common knots of each sheet, in the direction of its smallest edge.
    void find_knots() {
        std::vector<std::optional<iga::KnotVector>> sheets(cells_.n_sheets());
        const auto add = [&](int sheet, iga::KnotVector knots) {
            auto& common = sheets[sheet];
            if (common) knots = iga::snap_knots(knots, *common, knot_tolerance);
            common = common ? iga::common_refinement(*common, knots) : knots;
        };
        for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
            const auto own = map(f);
            for (int k = 0; k < 2; ++k) {
                const int edge = cells_.faces[f].edges[2 * k];
                const iga::KnotVector& knots = faces_[f]->patch.knots(own.axis[k]);
                const bool is_reversed = own.reversed[k] != cells_.runs_against_sheet[edge];
                add(cells_.sheets[edge], is_reversed ? knots.reversed() : knots);
            }
        }
        for (int sheet = 0; sheet < cells_.n_sheets(); ++sheet) {
            if (cells_.is_twisted_sheet[sheet]) add(sheet, sheets[sheet]->reversed());
        }
        for (std::size_t e = 0; e < cells_.edges.size(); ++e) {
            const iga::KnotVector& knots = *sheets[cells_.sheets[e]];
            nets_.knots.push_back(cells_.runs_against_sheet[e] ? knots.reversed() : knots);
        }
    }

    // The surface's control points in the common basis and the face's frame.
    [[nodiscard]] MatrixX own_net(int f) const {
        const auto own = map(f);
        const iga::Surface& patch = faces_[f]->patch;
        iga::TensorSpace<2> snapped = patch.space();
        iga::TensorSpace<2> space = patch.space();
        for (int k = 0; k < 2; ++k) {
            const iga::KnotVector& knots = nets_.knots[cells_.faces[f].edges[2 * k]];
            const int axis = own.axis[k];
            space.knots[axis] = own.reversed[k] ? knots.reversed() : knots;
            snapped.knots[axis] =
                iga::snap_knots(snapped.knots[axis], space.knots[axis], knot_tolerance);
        }
        const iga::Surface fine = iga::refine_to<2>(
            iga::Surface(snapped, patch.control_points(), patch.weights()), space);
        const MatrixX rows = is_rational_ ? fine.homogeneous() : fine.control_points();
        return rows(grid_places(own, space.sizes()), Eigen::all);
    }

    [[nodiscard]] std::array<int, 4> corner_rows(int f) const {
        const auto [n, m] = face_space(cells_, nets_.knots, f).sizes();
        return {0, n - 1, n * (m - 1), n * m - 1};
    }

    // Weights of a surface count up to a factor: those of a node are to be the same.
    void scale_weights(int n_nodes) {
        if (!is_rational_) return;
        std::vector<double> weights(n_nodes, 0.0);
        std::vector<bool> is_done(faces_.size(), false);
        const auto settle = [&](int f) {
            for (int k = 0; k < 4; ++k) {
                const double weight = weights[cells_.faces[f].nodes[k]];
                const double own = nets_.faces[f](corner_rows(f)[k], 3);
                if (weight > 0.0) {
                    if (weight != own) nets_.faces[f] *= weight / own;
                    break;
                }
            }
            for (int k = 0; k < 4; ++k) {
                weights[cells_.faces[f].nodes[k]] = nets_.faces[f](corner_rows(f)[k], 3);
            }
            is_done[f] = true;
        };
        const auto touches = [&](int f) {
            return std::ranges::any_of(cells_.faces[f].nodes,
                                       [&](int node) { return weights[node] > 0.0; });
        };
        // Face after face that touches those before; a new piece starts with its own weights.
        for (int start = 0; start < static_cast<int>(faces_.size()); ++start) {
            if (is_done[start]) continue;
            settle(start);
            for (bool grows = true; grows;) {
                grows = false;
                for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
                    if (is_done[f] || !touches(f)) continue;
                    settle(f);
                    grows = true;
                }
            }
        }
    }

    // Means of what the surfaces have; the first one's to the last bit where all agree.
    void average_nodes(int n_nodes) {
        const long columns = nets_.faces[0].cols();
        MatrixX first = MatrixX::Zero(n_nodes, columns);
        MatrixX sum = first;
        VectorX count = VectorX::Zero(n_nodes);
        for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
            for (int k = 0; k < 4; ++k) {
                const int node = cells_.faces[f].nodes[k];
                const auto row = nets_.faces[f].row(corner_rows(f)[k]);
                if (count[node] == 0.0) first.row(node) = row;
                sum.row(node) += row - first.row(node);
                count[node] += 1.0;
            }
        }
        nets_.nodes = first;
        for (int i = 0; i < n_nodes; ++i) {
            if (count[i] > 0.0) nets_.nodes.row(i) += sum.row(i) / count[i];
        }
    }

    // Border k of a face (see LayoutCells::Face) in the direction of its edge.
    [[nodiscard]] MatrixX border(int f, int k) const {
        const auto [n, m] = face_space(cells_, nets_.knots, f).sizes();
        const auto& [nodes, edges, sides] = cells_.faces[f];
        MatrixX rows =
            k < 2 ? MatrixX(nets_.faces[f].middleRows(k == 0 ? 0 : n * (m - 1), n))
                  : MatrixX(nets_.faces[f](Eigen::seqN(k == 2 ? 0 : n - 1, m, n), Eigen::all));
        const int from = nodes[std::array<int, 4>{0, 2, 0, 1}[k]];
        if (cells_.edges[edges[k]].from != from) rows = rows.colwise().reverse().eval();
        return rows;
    }

    void average_edges(double size, SurfacesReport& report) {
        const std::size_t n_edges = cells_.edges.size();
        std::vector<std::vector<MatrixX>> borders(n_edges);
        for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
            for (int k = 0; k < 4; ++k) borders[cells_.faces[f].edges[k]].push_back(border(f, k));
        }
        for (std::size_t e = 0; e < n_edges; ++e) {
            MatrixX mean = borders[e][0];
            for (const MatrixX& other : borders[e]) {
                mean += (other - borders[e][0]) / static_cast<double>(borders[e].size());
            }
            mean.row(0) = nets_.nodes.row(cells_.edges[e].from);
            mean.row(mean.rows() - 1) = nets_.nodes.row(cells_.edges[e].to);
            double gap = 0.0;
            for (const MatrixX& other : borders[e]) {
                gap = std::max(gap, (in_space(other) - in_space(mean)).rowwise().norm().maxCoeff());
            }
            if (gap > rounding * size) ++report.n_fitted_edges;
            report.max_edge_gap = std::max(report.max_edge_gap, gap);
            nets_.edges.push_back(std::move(mean));
        }
    }

    [[nodiscard]] MatrixX in_space(const MatrixX& rows) const {
        if (!is_rational_) return rows;
        return rows.col(3).cwiseInverse().asDiagonal() * rows.leftCols(3);
    }

    const LayoutCells& cells_;
    std::vector<const Face*> faces_;
    bool is_rational_ = false;
    LayoutNets nets_;
};

}  // namespace

VolumesFromSurfaces volumes_from_surfaces(std::span<const iga::Surface> surfaces,
                                          const SurfacesOptions& options) {
    if (surfaces.empty()) {
        throw InputError("volumes_from_surfaces: there are no surfaces");
    }
    if (!(options.tolerance > 0.0 && options.tolerance < 0.1)) {
        throw InputError("volumes_from_surfaces: tolerance = {}; it must lie between 0 and 0.1",
                         options.tolerance);
    }
    VolumesFromSurfaces result;
    SurfacesReport& report = result.report;
    const std::vector<Face> faces = make_faces(surfaces, options.tolerance, report);
    const std::vector<SixFaces> cuboids = choose_cuboids(faces, report);
    if (cuboids.empty()) {
        throw TopologyError(
            "volumes_from_surfaces: no six of the {} surfaces bound a volume ({} of them have two "
            "corners in one, {} repeat others); corners must meet within {} of the size",
            surfaces.size(), report.collapsed.size(), report.duplicates.size(), options.tolerance);
    }
    VolumetricLayout layout;
    std::vector<bool> is_used(faces.size(), false);
    for (const auto& [nodes, six] : cuboids) {
        layout.cuboids.push_back(nodes);
        layout.n_nodes = std::max(layout.n_nodes, *std::ranges::max_element(nodes) + 1);
        auto& own = result.surfaces.emplace_back();
        for (int side = 0; side < 6; ++side) {
            own[side] = faces[six[side]].surface;
            is_used[six[side]] = true;
        }
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (!is_used[f]) report.unused.push_back(faces[f].surface);
    }
    const LayoutCells cells = make_layout_cells(layout);
    std::vector<const Face*> of_cells;
    MatrixX box(3, 2);
    for (const auto& face : cells.faces) {
        const auto& [cuboid, side] = face.sides[0];
        of_cells.push_back(&faces[cuboids[cuboid].faces[side]]);
        const MatrixX& samples = of_cells.back()->samples;
        box.col(0) = of_cells.size() == 1 ? Vector3(samples.rowwise().minCoeff())
                                          : box.col(0).cwiseMin(samples.rowwise().minCoeff());
        box.col(1) = of_cells.size() == 1 ? Vector3(samples.rowwise().maxCoeff())
                                          : box.col(1).cwiseMax(samples.rowwise().maxCoeff());
    }
    LayoutNets nets = SurfaceNets(cells, std::move(of_cells))
                          .run(layout.n_nodes, (box.col(1) - box.col(0)).norm(), report);
    auto [volume, parameterization] = parameterize_volume(
        make_multipatch(layout, cells, std::move(nets)), options.parameterization);
    result.volume = std::move(volume);
    report.parameterization = parameterization;
    return result;
}

}  // namespace couture::meshing
