#include "meshing/pipeline/solid_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "iga/core/error.h"
#include "meshing/parameterization/map_samples.h"
#include "meshing/parameterization/sample_grid.h"
#include "meshing/parameterization/sheet_sizes.h"
#include "meshing/volume/layout_cells.h"

namespace couture::meshing {

namespace {

void check_options(const SolidMeshOptions& options) {
    if (!(options.element_size >= 0.0) || !std::isfinite(options.element_size)) {
        throw InputError("mesh: element size {}; it must not be negative", options.element_size);
    }
    if (!(options.tolerance > 0.0) || !std::isfinite(options.tolerance)) {
        throw InputError("mesh: tolerance {}; it must be positive", options.tolerance);
    }
    if (options.min_elements < 1) {
        throw InputError("mesh: {} elements at least; it must be 1 or more", options.min_elements);
    }
    if (!(options.alignment >= 0.0) || !std::isfinite(options.alignment)) {
        throw InputError("mesh: alignment {}; it must not be negative", options.alignment);
    }
    if (options.max_relocations < 0) {
        throw InputError("mesh: {} relocations at most; it must not be negative",
                         options.max_relocations);
    }
    if (options.samples_per_element < 2) {
        throw InputError("mesh: {} samples per element; splines need 2 or more",
                         options.samples_per_element);
    }
    if (options.n_points && *options.n_points < 2) {
        throw InputError("mesh: {} points per direction; hexahedra need 2 or more",
                         *options.n_points);
    }
}

// Elements of each sheet of the volume: the median of the wanted lengths of its arcs on the
// surface, weighted by these lengths, over the wanted size.
std::vector<int> elements_by_size(const CuboidDecomposition& cuboids, const LayoutCells& cells,
                                  const SolidMeshOptions& options) {
    const double size = options.element_size > 0.0 ? options.element_size
                                                   : bounding_box_diagonal(cuboids.mesh) / 20.0;
    const std::vector<double> lengths = cuboids.arc_lengths.empty()
                                            ? arc_lengths(cuboids.mesh, cuboids.surface)
                                            : cuboids.arc_lengths;
    std::vector<std::vector<double>> of_sheet(cells.n_sheets());
    const QuadLayout& layout = cuboids.surface.layout;
    for (int a = 0; a < layout.n_arcs(); ++a) {
        const QuadLayout::Arc& arc = layout.arcs()[a];
        of_sheet[cells.sheets[cells.find_edge(arc.from, arc.to)]].push_back(lengths[a]);
    }
    std::vector<int> elements;
    for (std::vector<double>& sheet : of_sheet) {
        std::ranges::sort(sheet);
        double half = 0.0;
        for (const double l : sheet) half += 0.5 * l;
        double median = 0.0;
        for (const double l : sheet) {
            median = l;
            half -= l;
            if (half <= 0.0) break;
        }
        constexpr double most_of_sheet = 1e6;
        elements.push_back(
            std::max(options.min_elements,
                     static_cast<int>(std::min(std::round(median / size), most_of_sheet))));
    }
    return elements;
}

std::vector<int> cells_of_surface(const QuadLayout& layout, const LayoutCells& cells,
                                  const std::vector<int>& elements) {
    std::vector<int> of_arcs;
    for (const QuadLayout::Arc& arc : layout.arcs()) {
        of_arcs.push_back(elements[cells.sheets[cells.find_edge(arc.from, arc.to)]]);
    }
    return of_arcs;
}

// Wanted lengths of cells, next to each other, of the surface's sheets; none if all are the same.
std::vector<double> wanted_lengths(const CuboidDecomposition& cuboids, const LayoutCells& cells) {
    const auto& [elements, base] = std::tie(cuboids.record.elements, cuboids.record.base_elements);
    if (base.size() != elements.size()) return {};
    const QuadLayout& layout = cuboids.surface.layout;
    const std::vector<int> sheets = layout.sheets();
    std::vector<double> lengths(1 + std::ranges::max(sheets));
    for (int a = 0; a < layout.n_arcs(); ++a) {
        const QuadLayout::Arc& arc = layout.arcs()[a];
        const int sheet = cells.sheets[cells.find_edge(arc.from, arc.to)];
        lengths[sheets[a]] = static_cast<double>(base[sheet]) / elements[sheet];
    }
    return lengths;
}

// @throws InputError  if there are more elements than can be worked on
void check_n_elements(const LayoutCells& cells, const std::vector<int>& elements,
                      double element_size) {
    constexpr double most_elements = 2e6;
    double n_elements = 0.0;
    for (const std::array<int, 12>& edges : cells.cuboid_edges) {
        double product = 1.0;
        for (const int k : {0, 4, 8}) product *= elements[cells.sheets[edges[k]]];
        n_elements += product;
    }
    if (n_elements > most_elements) {
        throw InputError(
            "mesh: an element size of {:.3g} makes {:.3g} elements, at most {:.0g} are; take a "
            "larger one",
            element_size, n_elements, most_elements);
    }
}

// Decides on elements, on how nodes are placed and on names of outer sides.
void complete_record(CuboidDecomposition& cuboids, const LayoutCells& cells,
                     const SolidMeshOptions& options) {
    cuboids.record.elements = elements_by_size(cuboids, cells, options);
    cuboids.record.base_elements = cuboids.record.elements;
    check_n_elements(cells, cuboids.record.elements, options.element_size);
    // Cells weigh by their area where splines are to come near the surface, not where they have a
    // size of their own or the lengths that an outside layout gives them.
    const bool has_lengths = options.element_size > 0.0 || !cuboids.arc_lengths.empty();
    cuboids.record.area_part = has_lengths ? 0.0 : NodeRelocationOptions{}.area_part;
    if (!options.faces) return;
    for (auto& [name, sides] : name_outer_sides(cuboids, *options.faces)) {
        std::vector<CuboidSide>& set = cuboids.volume.sets[name];
        set.insert(set.end(), sides.begin(), sides.end());
    }
    cuboids.record.sets = cuboids.volume.sets;
}

// In words, where the grid turns against the surface.
std::string place_of_worst(const SurfaceMesh& mesh, const LayoutSamples& samples) {
    const std::optional<TurnedCorner> worst = worst_turned_corner(samples, mesh);
    if (!worst) return "";
    return fmt::format(", the worst near ({:.6g}, {:.6g}, {:.6g}) in the quad of nodes {}",
                       worst->place.x(), worst->place.y(), worst->place.z(),
                       samples.layout.quad_name(worst->quad));
}

// Wanted lengths of the cells of each arc, next to each other: of an outside layout those that its
// arcs have there, else those of the sheets; none if all are the same.
std::vector<double> cell_lengths_of_arcs(const SolidMesh& solid,
                                         const std::vector<double>& of_sheets) {
    const QuadLayout& layout = solid.cuboids.surface.layout;
    const std::vector<double>& lengths = solid.cuboids.arc_lengths;
    const std::vector<int> sheets = layout.sheets();
    std::vector<double> of_arcs;
    for (int a = 0; a < layout.n_arcs(); ++a) {
        if (!lengths.empty()) {
            of_arcs.push_back(lengths[a] / solid.mapped_quads->n_cells[a]);
        } else if (!of_sheets.empty()) {
            of_arcs.push_back(of_sheets[sheets[a]]);
        }
    }
    return of_arcs;
}

// Quads of the map with their nodes in better places. The map turns none over, but large ones may
// be on a surface that bends: then smaller ones make the start.
RelocatedSamples relocate(const SolidMesh& solid, const std::vector<double>& cell_lengths,
                          const SolidMeshOptions& options) {
    const SurfaceMesh& mesh = solid.cuboids.mesh;
    const EmbeddedLayout& surface = solid.cuboids.surface;
    NodeRelocationOptions relocation;
    relocation.cell_lengths = cell_lengths_of_arcs(solid, cell_lengths);
    relocation.max_iterations = options.max_relocations;
    relocation.area_part = solid.cuboids.record.area_part;
    relocation.tolerance = options.node_tolerance;
    RelocatedSamples relocated = relocate_nodes(mesh, surface, *solid.mapped_quads, relocation);
    for (int n = 2; n <= 4 && relocated.report.n_inverted > 0; n *= 2) {
        const RelocatedSamples small = relocate_nodes(
            mesh, surface, sample_layout_map(mesh, surface, *solid.map, n), relocation);
        if (small.report.n_inverted > 0) continue;
        relocated = relocate_nodes(mesh, surface, coarsen_samples(small.samples, n), relocation);
    }
    return relocated;
}

void make_quads(SolidMesh& solid, const std::vector<double>& cell_lengths,
                const SolidMeshOptions& options) {
    RelocatedSamples relocated = relocate(solid, cell_lengths, options);
    if (relocated.report.n_inverted > 0) {
        throw GeometryError(
            "mesh: {} corners of quads stay turned over on the surface{}: the cuboids are too "
            "distorted there. Look at the stages layout and map; other cuts ([meshing] cycle, "
            "loop) or templates help, other places of a layout's nodes, or smaller elements",
            relocated.report.n_inverted, place_of_worst(solid.cuboids.mesh, relocated.samples));
    }
    solid.relocation = relocated.report;
    solid.quads = std::move(relocated.samples);
    solid.quad_quality = quad_quality(to_quad_mesh(*solid.quads), solid.cuboids.mesh);
}

LayoutVolumeOptions volume_options(const SolidMesh& solid, const SolidMeshOptions& options) {
    LayoutVolumeOptions volume = options.volume;
    volume.n_elements = solid.cuboids.record.elements;
    return volume;
}

LayoutSamples fine_samples(const SolidMesh& solid, const SolidMeshOptions& options) {
    return refine_samples(solid.cuboids.mesh, solid.cuboids.surface, *solid.quads,
                          options.samples_per_element);
}

LayoutSurfaces fit_surfaces(const SolidMesh& solid, const SolidMeshOptions& options) {
    return make_layout_surfaces(solid.cuboids.volume, fine_samples(solid, options),
                                volume_options(solid, options));
}

LayoutVolume fit_volume(const SolidMesh& solid, const SolidMeshOptions& options) {
    return make_layout_volume(solid.cuboids.volume, fine_samples(solid, options),
                              volume_options(solid, options));
}

// For each quad the mean edge length of its triangles, taken as equilateral, weighted by their
// area: the thin ones that arcs cut off count little.
std::vector<double> triangle_sizes(const SurfaceMesh& mesh, const EmbeddedLayout& surface) {
    std::vector<double> areas(surface.layout.n_quads(), 0.0);
    std::vector<double> sizes(areas.size(), 0.0);
    for (const FaceHandle face : mesh.faces()) {
        const int quad = surface.quad_of_face[face.idx()];
        const double area = face_area(mesh, face);
        areas[quad] += area;
        sizes[quad] += area * std::sqrt(4.0 / std::numbers::sqrt3 * area);
    }
    for (std::size_t q = 0; q < sizes.size(); ++q) sizes[q] /= areas[q];
    return sizes;
}

// Lengths of a quad's cell along sides 0 and 1: means of its two edges each.
std::array<double, 2> cell_lengths(const LayoutSamples& samples, int quad,
                                   const std::array<int, 2>& cell) {
    const int n_s = samples.n_cells[samples.layout.sides(quad)[0].arc];
    const MatrixX& points = samples.quads[quad];
    const int at = cell[1] * (n_s + 1) + cell[0];
    const auto length = [&](int a, int b) { return (points.col(a) - points.col(b)).norm(); };
    return {0.5 * (length(at, at + 1) + length(at + n_s + 1, at + n_s + 2)),
            0.5 * (length(at, at + n_s + 1) + length(at + 1, at + n_s + 2))};
}

// More elements in the sheets of quads and sharp arcs whose splines are too far from the surface,
// as far as the order of the distance asks for: p + 1, or 1 where elements are so short that they
// follow the surface's facets, less than two of its triangles or edges; none becomes shorter than
// half of them. False if all are near enough or short. Of a quad's two directions that in which the
// cell at the largest distance is longer gets them, or both if it is not twice as long.
bool add_elements(SolidMesh& solid, const LayoutCells& cells, const SolidMeshOptions& options) {
    const VolumeDistance distance =
        volume_distance(fit_surfaces(solid, options).surfaces, solid.cuboids);
    const QuadLayout& layout = solid.cuboids.surface.layout;
    const std::vector<double> lengths = arc_lengths(solid.cuboids.mesh, solid.cuboids.surface);
    const std::vector<double> sizes = triangle_sizes(solid.cuboids.mesh, solid.cuboids.surface);
    constexpr double most_facets = 2.0;
    constexpr double least_part = 0.5;
    constexpr double most_growth = 2.0;
    std::vector<double> growth(cells.n_sheets(), 1.0);
    const auto grow = [&](int a, double length, double size, double excess) {
        const QuadLayout::Arc& arc = layout.arcs()[a];
        const int order = length < most_facets * size ? 1 : options.volume.degree + 1;
        const double wanted = std::pow(excess, 1.0 / order);
        const double possible = length / (least_part * size);
        double& of_sheet = growth[cells.sheets[cells.find_edge(arc.from, arc.to)]];
        of_sheet = std::max(of_sheet, std::min({wanted, possible, most_growth}));
    };
    for (int q = 0; q < layout.n_quads(); ++q) {
        const auto& sides = layout.sides(q);
        const auto along = cell_lengths(*solid.quads, q, distance.worst_elements[q]);
        for (int k = 0; k < 4; ++k) {
            if (2.0 * along[k % 2] < along[1 - k % 2]) continue;
            grow(sides[k].arc, along[k % 2], sizes[q], distance.of_quads[q] / options.tolerance);
        }
    }
    for (int a = 0; a < layout.n_arcs(); ++a) {
        const auto n_edges = static_cast<double>(solid.cuboids.surface.arcs[a].size() - 1);
        const double length = lengths[a] / solid.quads->n_cells[a];
        grow(a, length, lengths[a] / n_edges, distance.of_arcs[a] / (0.5 * options.tolerance));
    }
    bool is_any = false;
    for (int sheet = 0; sheet < cells.n_sheets(); ++sheet) {
        int& n = solid.cuboids.record.elements[sheet];
        const int wanted = static_cast<int>(std::ceil(n * growth[sheet] - 1e-9));
        is_any = is_any || wanted > n;
        n = wanted;
    }
    return is_any;
}

bool is_folded(const LayoutVolume& volume) {
    return volume.report.parameterization.validity != iga::Validity::valid;
}

bool is_poor(const LayoutVolume& volume) {
    constexpr double poor = 0.2;
    return is_folded(volume) || volume.report.quality.min_scaled_jacobian < poor;
}

// Moves the nodes of a poor volume on, each time by a tolerance ten times smaller, and keeps the
// best: badly shaped elements beside blunt edges depend on where exactly the nodes stopped.
void improve_volume(SolidMesh& solid, const LayoutMapOptions& map, SolidMeshOptions options,
                    const std::function<void(std::string_view)>& say) {
    constexpr int max_tries = 2;
    const auto rank = [](const LayoutVolume& volume) {
        return std::pair(volume.report.parameterization.validity == iga::Validity::valid,
                         volume.report.quality.min_scaled_jacobian);
    };
    SolidMesh other = solid;
    for (int i = 0; i < max_tries && is_poor(*solid.volume); ++i) {
        say("moving nodes on, for better elements");
        options.node_tolerance *= 0.1;
        make_quads(other, map.cell_lengths, options);
        other.volume = fit_volume(other, options);
        if (rank(*other.volume) > rank(*solid.volume)) solid = other;
    }
}

}  // namespace

SolidMesh mesh_solid(CuboidDecomposition cuboids, const SolidMeshOptions& options) {
    check_options(options);
    const auto say = [&](std::string_view what) {
        if (options.progress) options.progress(what);
    };
    SolidMesh solid;
    solid.cuboids = std::move(cuboids);
    SurfaceMesh& mesh = solid.cuboids.mesh;
    EmbeddedLayout& surface = solid.cuboids.surface;
    const LayoutCells cells = make_layout_cells(solid.cuboids.volume);
    const bool chooses_elements = solid.cuboids.record.elements.empty();
    if (chooses_elements) complete_record(solid.cuboids, cells, options);
    const std::vector<int>& elements = solid.cuboids.record.elements;
    if (static_cast<int>(elements.size()) != cells.n_sheets()) {
        throw TopologyError(
            "mesh: numbers of elements for {} sheets of cuboids were recorded, but there are {}; "
            "the record was made with other templates",
            elements.size(), cells.n_sheets());
    }
    if (options.last == SolidStage::layout) return solid;

    split_layout_chords(mesh, surface);
    LayoutMapOptions map_options;
    map_options.route = options.route;
    // Nodes move on from here.
    map_options.tolerance = 1e-4;
    if (options.last == SolidStage::field || options.alignment > 0.0 ||
        options.route == LayoutMapRoute::quadratic) {
        say("making the cross field");
        solid.field = make_layout_field(mesh, surface);
        map_options.alignment_weight = options.alignment;
        map_options.directions =
            FaceDirections{chart_directions(mesh, surface, solid.field->field)};
    }
    if (options.last == SolidStage::field) return solid;

    const bool adds_elements = chooses_elements && options.element_size == 0.0;
    constexpr int max_rounds = 8;
    const auto map_surface = [&] {
        map_options.cell_lengths = wanted_lengths(solid.cuboids, cells);
        solid.map = make_layout_map(mesh, surface,
                                    cells_of_surface(surface.layout, cells, elements), map_options);
    };
    // Numbers of elements of the rounds before the last one.
    std::vector<std::vector<int>> fewer;
    for (int round = 0;; ++round) {
        say(round == 0 ? "mapping the surface" : "mapping the surface with more elements");
        map_surface();
        const int n_flipped = solid.map->report.n_flipped;
        if (n_flipped == 0) solid.mapped_quads = sample_layout_map(mesh, surface, *solid.map);
        if (options.last == SolidStage::map) return solid;
        if (n_flipped > 0) {
            throw GeometryError(
                "mesh: {} triangles of the quadratic map are flipped, so that it has no quads: "
                "look "
                "at the stage map, or take parameterization = \"aligned\", which flips none",
                n_flipped);
        }
        say("moving nodes");
        make_quads(solid, map_options.cell_lengths, options);
        if (options.last == SolidStage::quads) return solid;
        if (!adds_elements || round == max_rounds) break;
        fewer.push_back(elements);
        if (!add_elements(solid, cells, options)) {
            fewer.pop_back();
            break;
        }
    }

    if (options.last == SolidStage::surfaces) {
        say("fitting splines");
        solid.surfaces = fit_surfaces(solid, options);
        return solid;
    }
    say("fitting splines and filling the volume");
    solid.volume = fit_volume(solid, options);
    if (chooses_elements && is_poor(*solid.volume))
        improve_volume(solid, map_options, options, say);
    // Small elements fold beside sharp edges that no arc runs along, where large ones round them.
    while (is_folded(*solid.volume) && !fewer.empty()) {
        say("going back to fewer elements, as these fold");
        solid.cuboids.record.elements = fewer.back();
        fewer.pop_back();
        map_surface();
        if (solid.map->report.n_flipped > 0) continue;
        solid.mapped_quads = sample_layout_map(mesh, surface, *solid.map);
        make_quads(solid, map_options.cell_lengths, options);
        solid.volume = fit_volume(solid, options);
    }
    solid.distance = volume_distance(solid.volume->volume, solid.cuboids);
    if (options.last == SolidStage::volume) return solid;

    say("sampling hexahedra");
    solid.hexes = sample_hexahedra(solid.volume->volume, options.n_points);
    return solid;
}

}  // namespace couture::meshing
