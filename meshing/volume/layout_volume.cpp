#include "meshing/volume/layout_volume.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "iga/core/error.h"
#include "meshing/topology/cell_complex.h"
#include "meshing/volume/inner_nodes.h"
#include "meshing/volume/layout_nets.h"
#include "meshing/volume/optimize_volume.h"

namespace couture::meshing {

namespace {

// Samples of an edge or face of the layout, in its own frame.
struct CellSamples {
    MatrixX points;
    std::array<int, 2> n{};
    /// Arc or quad of the samples.
    int source = -1;
};

std::vector<iga::KnotVector> knots_of_edges(const LayoutCells& cells,
                                            const LayoutVolumeOptions& options) {
    if (!options.knots.empty()) {
        if (options.knots.size() != cells.edges.size()) {
            throw InputError(
                "make_layout_volume: {} knot vectors; give none, or one for each of the {} edges",
                options.knots.size(), cells.edges.size());
        }
        return options.knots;
    }
    const auto& given = options.n_elements;
    if (given.size() != 1 && given.size() != static_cast<std::size_t>(cells.n_sheets())) {
        throw InputError(
            "make_layout_volume: {} numbers of elements; give one, or one for each of the {} "
            "sheets",
            given.size(), cells.n_sheets());
    }
    for (const int n : given) {
        if (n < 1) {
            throw InputError("make_layout_volume: {} elements in a sheet; must be at least 1", n);
        }
    }
    std::vector<iga::KnotVector> result;
    for (const int sheet : cells.sheets) {
        result.push_back(
            iga::KnotVector::uniform(options.degree, given[given.size() == 1 ? 0 : sheet]));
    }
    return result;
}

void check_counts(const LayoutSamples& samples) {
    const auto n_arcs = static_cast<std::size_t>(samples.layout.n_arcs());
    const auto n_quads = static_cast<std::size_t>(samples.layout.n_quads());
    if (samples.n_cells.size() != n_arcs || samples.arcs.size() != n_arcs ||
        samples.quads.size() != n_quads) {
        throw InputError(
            "make_layout_volume: numbers of cells for {} arcs, points for {} arcs and {} quads; "
            "the samples' layout has {} arcs and {} quads",
            samples.n_cells.size(), samples.arcs.size(), samples.quads.size(), n_arcs, n_quads);
    }
}

// The arcs' samples by the layout's edges; arcs and edges both run from the smaller node.
std::vector<CellSamples> samples_of_edges(const LayoutCells& cells, const LayoutSamples& samples,
                                          const std::vector<iga::KnotVector>& knots) {
    std::vector<CellSamples> result(cells.edges.size());
    const QuadLayout& layout = samples.layout;
    for (int arc = 0; arc < layout.n_arcs(); ++arc) {
        const auto& [from, to] = layout.arcs()[arc];
        const int edge = cells.find_edge(from, to);
        if (edge < 0) {
            throw TopologyError(
                "make_layout_volume: arc {} of the samples joins nodes {} and {}, which no cuboid "
                "does",
                arc, from, to);
        }
        const int n = samples.n_cells[arc];
        const MatrixX& points = samples.arcs[arc];
        if (n < 1 || points.rows() != 3 || points.cols() != n + 1 || !points.allFinite()) {
            throw InputError(
                "make_layout_volume: arc {} has {} cells and {} points; there must be one more "
                "than cells, all finite",
                arc, n, points.cols());
        }
        if (n < 2 * knots[edge].n_elements()) {
            throw InputError(
                "make_layout_volume: arc {} from node {} to {} has {} cells for {} spline "
                "elements; there must be 2 or more each: sample finer, or take fewer elements",
                arc, from, to, n, knots[edge].n_elements());
        }
        result[edge] = {points, {n + 1, 1}, arc};
    }
    return result;
}

// Border points must be those of the arcs.
void check_border(const LayoutCells& cells, const CellSamples& samples, int face,
                  const std::vector<CellSamples>& edges) {
    const auto& [nodes, face_edges, sides] = cells.faces[face];
    const auto [n, m] = samples.n;
    for (int k = 0; k < 4; ++k) {
        const auto& arc = edges[face_edges[k]];
        const int size = k < 2 ? n : m;
        const bool is_forward =
            cells.edges[face_edges[k]].from == nodes[std::array<int, 4>{0, 2, 0, 1}[k]];
        bool is_same = arc.points.cols() == size;
        for (int i = 0; is_same && i < size; ++i) {
            const int place = k < 2 ? i + n * (k == 0 ? 0 : m - 1) : (k == 2 ? 0 : n - 1) + n * i;
            is_same = arc.points.col(is_forward ? i : size - 1 - i) == samples.points.col(place);
        }
        if (!is_same) {
            throw InputError(
                "make_layout_volume: quad {} and arc {} of the samples have other points on their "
                "common border; they must have the same",
                samples.source, arc.source);
        }
    }
}

// Outer faces by their nodes, ascending.
std::map<std::array<int, 4>, int> outer_faces(const LayoutCells& cells) {
    std::map<std::array<int, 4>, int> face_of_nodes;
    for (std::size_t f = 0; f < cells.faces.size(); ++f) {
        if (cells.faces[f].sides.size() != 1) continue;
        auto nodes = cells.faces[f].nodes;
        std::ranges::sort(nodes);
        face_of_nodes[nodes] = static_cast<int>(f);
    }
    return face_of_nodes;
}

// The quads' samples by the layout's faces.
std::vector<CellSamples> samples_of_faces(const LayoutCells& cells, const LayoutSamples& samples,
                                          const std::vector<CellSamples>& edges) {
    const auto face_of_nodes = outer_faces(cells);
    std::vector<CellSamples> result(cells.faces.size());
    const QuadLayout& layout = samples.layout;
    for (int q = 0; q < layout.n_quads(); ++q) {
        const auto& corners = layout.quads()[q];
        auto nodes = corners;
        std::ranges::sort(nodes);
        const auto place = face_of_nodes.find(nodes);
        if (place == face_of_nodes.end() || result[place->second].source >= 0) {
            throw TopologyError(
                "make_layout_volume: quad {} of the samples with nodes {} is no outer side of a "
                "cuboid, or is there twice",
                q, fmt::join(corners, ", "));
        }
        const auto& face = cells.faces[place->second];
        const std::array<int, 2> n{samples.n_cells[layout.sides(q)[0].arc] + 1,
                                   samples.n_cells[layout.sides(q)[1].arc] + 1};
        if (samples.quads[q].rows() != 3 || samples.quads[q].cols() != n[0] * n[1] ||
            !samples.quads[q].allFinite()) {
            throw InputError(
                "make_layout_volume: quad {} has {} points; its arcs ask for {} x {}, all finite",
                q, samples.quads[q].cols(), n[0], n[1]);
        }
        const auto map = map_of_nodes(face.nodes, {corners[0], corners[1], corners[3], corners[2]});
        auto& own = result[place->second];
        own.points = samples.quads[q](Eigen::all, grid_places(map, n));
        own.n = {n[map.axis[0]], n[map.axis[1]]};
        own.source = q;
        check_border(cells, own, place->second, edges);
    }
    if (layout.n_quads() != static_cast<int>(face_of_nodes.size())) {
        throw TopologyError(
            "make_layout_volume: the samples have {} quads, the layout {} outer sides; they must "
            "be the same",
            layout.n_quads(), face_of_nodes.size());
    }
    return result;
}

// Distances of samples from splines, collected.
class Distances {
  public:
    explicit Distances(LayoutFitReport& report) : report_(report) {}

    void add(const SplineFit& fit, const CellSamples& samples, bool is_arc) {
        sum_ += fit.sum_of_squares;
        n_ += samples.points.cols();
        report_.rms_distance = std::sqrt(sum_ / static_cast<double>(n_));
        if (fit.max_distance > report_.max_distance) {
            report_.max_distance = fit.max_distance;
            report_.worst_arc = is_arc ? samples.source : -1;
            report_.worst_quad = is_arc ? -1 : samples.source;
        }
    }

  private:
    LayoutFitReport& report_;
    double sum_ = 0.0;
    long n_ = 0;
};

// Nets of all boundary cells; nodes inside are 0.
LayoutNets fit_boundary(const VolumetricLayout& layout, const LayoutCells& cells,
                        const LayoutSamples& samples, const LayoutVolumeOptions& options,
                        LayoutFitReport& report) {
    LayoutNets nets;
    nets.knots = knots_of_edges(cells, options);
    check_counts(samples);
    const auto edges = samples_of_edges(cells, samples, nets.knots);
    const auto faces = samples_of_faces(cells, samples, edges);
    nets.nodes = MatrixX::Zero(layout.n_nodes, 3);
    nets.edges.resize(cells.edges.size());
    nets.faces.resize(cells.faces.size());
    std::vector<bool> is_given(layout.n_nodes, false);
    Distances distances(report);
    for (std::size_t e = 0; e < cells.edges.size(); ++e) {
        if (edges[e].source < 0) continue;
        SplineFit fit = fit_curve(nets.knots[e], edges[e].points, options.fit);
        distances.add(fit, edges[e], true);
        nets.edges[e] = std::move(fit.control_points);
        for (const bool is_end : {false, true}) {
            const int node = is_end ? cells.edges[e].to : cells.edges[e].from;
            const auto row = nets.edges[e].row(is_end ? nets.edges[e].rows() - 1 : 0);
            if (is_given[node] && nets.nodes.row(node) != row) {
                throw InputError(
                    "make_layout_volume: arcs of the samples end at different points in node {}, "
                    "one of them arc {}",
                    node, edges[e].source);
            }
            nets.nodes.row(node) = row;
            is_given[node] = true;
        }
    }
    for (int f = 0; f < static_cast<int>(cells.faces.size()); ++f) {
        if (faces[f].source < 0) continue;
        const iga::TensorSpace<2> space = face_space(cells, nets.knots, f);
        const MatrixX border = with_border(cells, nets, f, MatrixX::Zero(space.n_basis(), 3));
        SplineFit fit = fit_surface(space, border, faces[f].points, faces[f].n, options.fit);
        distances.add(fit, faces[f], false);
        nets.faces[f] = std::move(fit.control_points);
    }
    return nets;
}

void add_inner_nodes(const VolumetricLayout& layout, const LayoutCells& cells,
                     const ParameterizationOptions& options, LayoutNets& nets) {
    std::vector<bool> is_outer(layout.n_nodes, false);
    for (const auto& [nodes, face] : outer_faces(cells)) {
        for (const int node : nodes) is_outer[node] = true;
    }
    if (std::ranges::find(is_outer, false) == is_outer.end()) return;
    nets.nodes = place_inner_nodes(layout, cells, nets.nodes, is_outer, options);
}

// The surface of a quad whose nodes go round.
iga::Surface surface_of_quad(const LayoutCells& cells, const LayoutNets& nets, int face,
                             const std::array<int, 4>& nodes) {
    const auto map =
        map_of_nodes({nodes[0], nodes[1], nodes[3], nodes[2]}, cells.faces[face].nodes);
    const iga::TensorSpace<2> own = face_space(cells, nets.knots, face);
    const auto knots = [&](int direction) {
        const iga::KnotVector& along = own.knots[map.axis[direction]];
        return map.reversed[direction] ? along.reversed() : along;
    };
    MatrixX points(own.n_basis(), 3);
    const auto places = grid_places(map, own.sizes());
    for (std::size_t i = 0; i < places.size(); ++i) {
        points.row(static_cast<long>(i)) = nets.faces[face].row(places[i]);
    }
    return {iga::TensorSpace<2>{{knots(0), knots(1)}}, std::move(points)};
}

// With straight inner edges; if that stays folded, with inner edges that are bent as those around.
ParameterizedVolume fill_volume(const VolumetricLayout& layout, const LayoutCells& cells,
                                LayoutNets nets, const ParameterizationOptions& options) {
    ParameterizedVolume straight =
        parameterize_volume(make_multipatch(layout, cells, nets), options);
    if (straight.report.validity == iga::Validity::valid) return straight;
    bend_edges(cells, nets);
    ParameterizedVolume bent = parameterize_volume(make_multipatch(layout, cells, nets), options);
    const auto rank = [](const ParameterizationReport& report) {
        return std::pair(report.validity, -report.min_scaled_jacobian_after);
    };
    return rank(bent.report) < rank(straight.report) ? bent : straight;
}

}  // namespace

LayoutSurfaces make_layout_surfaces(const VolumetricLayout& layout, const LayoutSamples& samples,
                                    const LayoutVolumeOptions& options) {
    const LayoutCells cells = make_layout_cells(layout);
    LayoutSurfaces result;
    const LayoutNets nets = fit_boundary(layout, cells, samples, options, result.report);
    const auto face_of_nodes = outer_faces(cells);
    for (const auto& nodes : samples.layout.quads()) {
        auto sorted = nodes;
        std::ranges::sort(sorted);
        result.surfaces.patches.push_back(
            surface_of_quad(cells, nets, face_of_nodes.at(sorted), nodes));
    }
    return result;
}

LayoutVolume make_layout_volume(const VolumetricLayout& layout, const LayoutSamples& samples,
                                const LayoutVolumeOptions& options) {
    const LayoutCells cells = make_layout_cells(layout);
    const CellComplex complex = make_hexahedron_complex(layout.cuboids);
    check_volume_boundary(complex);
    LayoutVolumeReport report;
    report.euler_characteristic = complex.euler_characteristic();
    LayoutNets nets = fit_boundary(layout, cells, samples, options, report);
    add_inner_nodes(layout, cells, options.parameterization, nets);
    auto [volume, parameterization] = fill_volume(layout, cells, nets, options.parameterization);
    if (options.slide_boundary && parameterization.validity == iga::Validity::valid) {
        volume = optimize_volume(volume, BoundaryFeatures(volume), {.hold_reentrant_edges = false})
                     .volume;
    }
    report.parameterization = parameterization;
    report.quality = iga::element_quality(volume);
    return {std::move(volume), report};
}

}  // namespace couture::meshing
