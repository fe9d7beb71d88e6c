#include "meshing/pipeline/solid_mesh.h"

#include <algorithm>
#include <cmath>

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

// Decides on elements and on names of outer sides.
void complete_record(CuboidDecomposition& cuboids, const LayoutCells& cells,
                     const SolidMeshOptions& options) {
    cuboids.record.elements = elements_by_size(cuboids, cells, options);
    check_n_elements(cells, cuboids.record.elements, options.element_size);
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

// Nodes in better places.
void make_quads(SolidMesh& solid, const SolidMeshOptions& options) {
    const SurfaceMesh& mesh = solid.cuboids.mesh;
    const EmbeddedLayout& surface = solid.cuboids.surface;
    NodeRelocationOptions relocation;
    relocation.max_iterations = options.max_relocations;
    const std::vector<double>& lengths = solid.cuboids.arc_lengths;
    for (std::size_t a = 0; a < lengths.size(); ++a) {
        relocation.cell_lengths.push_back(lengths[a] / solid.mapped_quads->n_cells[a]);
    }
    RelocatedSamples relocated = relocate_nodes(mesh, surface, *solid.mapped_quads, relocation);
    if (relocated.report.n_inverted > 0) {
        throw GeometryError(
            "mesh: {} corners of quads stay turned over on the surface{}: the cuboids are too "
            "distorted there. Look at the stages layout and map; other cuts ([meshing] cycle, "
            "loop) or templates help, other places of a layout's nodes, or smaller elements",
            relocated.report.n_inverted, place_of_worst(mesh, relocated.samples));
    }
    solid.relocation = relocated.report;
    solid.quads = std::move(relocated.samples);
    solid.quad_quality = quad_quality(to_quad_mesh(*solid.quads), mesh);
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

LayoutVolume fit_volume(const SolidMesh& solid, const SolidMeshOptions& options,
                        const ParameterizationOptions& parameterization) {
    LayoutVolumeOptions volume = volume_options(solid, options);
    volume.parameterization = parameterization;
    return make_layout_volume(solid.cuboids.volume, fine_samples(solid, options), volume);
}

double mean_edge_length(const SurfaceMesh& mesh) {
    double sum = 0.0;
    for (const EdgeHandle edge : mesh.edges()) sum += mesh.calc_edge_length(edge);
    return sum / static_cast<double>(mesh.n_edges());
}

// Mean length of the cells along each arc.
std::vector<double> cell_lengths(const LayoutSamples& quads) {
    std::vector<double> lengths;
    for (const MatrixX& arc : quads.arcs) {
        const auto n = arc.cols() - 1;
        const double length = (arc.rightCols(n) - arc.leftCols(n)).colwise().norm().sum();
        lengths.push_back(length / static_cast<double>(n));
    }
    return lengths;
}

// More elements in the sheets of quads and sharp arcs whose splines are too far from the surface,
// as far as the order of the distance asks for, but none shorter than the surface's triangles,
// whose facets they would follow; false if all are near enough or short. Of a quad's two directions
// that with the longer cells gets them, or both if neither has cells twice as long.
bool add_elements(SolidMesh& solid, const LayoutCells& cells, const SolidMeshOptions& options) {
    const VolumeDistance distance = volume_distance(
        fit_volume(solid, options, {.max_rounds = 0, .max_untangling_rounds = 0}).volume,
        solid.cuboids);
    const QuadLayout& layout = solid.cuboids.surface.layout;
    const std::vector<double> lengths = cell_lengths(*solid.quads);
    const double least_length = mean_edge_length(solid.cuboids.mesh);
    constexpr double most_growth = 2.0;
    std::vector<double> growth(cells.n_sheets(), 1.0);
    const auto grow = [&](int a, double excess) {
        const QuadLayout::Arc& arc = layout.arcs()[a];
        const double wanted = std::pow(excess, 1.0 / (options.volume.degree + 1));
        const double possible = lengths[a] / least_length;
        double& of_sheet = growth[cells.sheets[cells.find_edge(arc.from, arc.to)]];
        of_sheet = std::max(of_sheet, std::min({wanted, possible, most_growth}));
    };
    for (int q = 0; q < layout.n_quads(); ++q) {
        const auto& sides = layout.sides(q);
        const std::array<double, 2> along{std::max(lengths[sides[0].arc], lengths[sides[2].arc]),
                                          std::max(lengths[sides[1].arc], lengths[sides[3].arc])};
        for (int k = 0; k < 4; ++k) {
            if (2.0 * along[k % 2] < along[1 - k % 2]) continue;
            grow(sides[k].arc, distance.of_quads[q] / options.tolerance);
        }
    }
    for (int a = 0; a < layout.n_arcs(); ++a) {
        grow(a, distance.of_arcs[a] / (0.5 * options.tolerance));
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
    constexpr int max_rounds = 4;
    for (int round = 0;; ++round) {
        say(round == 0 ? "mapping the surface" : "mapping the surface with more elements");
        solid.map = make_layout_map(mesh, surface,
                                    cells_of_surface(surface.layout, cells, elements), map_options);
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
        make_quads(solid, options);
        if (options.last == SolidStage::quads) return solid;
        if (!adds_elements || round == max_rounds || !add_elements(solid, cells, options)) break;
    }

    if (options.last == SolidStage::surfaces) {
        say("fitting splines");
        solid.surfaces = fit_surfaces(solid, options);
        return solid;
    }
    say("fitting splines and filling the volume");
    solid.volume = fit_volume(solid, options, options.volume.parameterization);
    solid.distance = volume_distance(solid.volume->volume, solid.cuboids);
    if (options.last == SolidStage::volume) return solid;

    say("sampling hexahedra");
    solid.hexes = sample_hexahedra(solid.volume->volume, options.n_points);
    return solid;
}

}  // namespace couture::meshing
