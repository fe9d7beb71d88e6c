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
}

// Elements of each sheet of the volume: the median of the lengths of its arcs on the surface,
// weighted by these lengths, over the wanted size.
std::vector<int> elements_by_size(const CuboidDecomposition& cuboids, const LayoutCells& cells,
                                  const SolidMeshOptions& options) {
    const double size = options.element_size > 0.0 ? options.element_size
                                                   : bounding_box_diagonal(cuboids.mesh) / 20.0;
    const std::vector<double> lengths = arc_lengths(cuboids.mesh, cuboids.surface);
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
        elements.push_back(
            std::max(options.min_elements, static_cast<int>(std::lround(median / size))));
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

// Decides on elements and on names of outer sides.
void complete_record(CuboidDecomposition& cuboids, const LayoutCells& cells,
                     const SolidMeshOptions& options) {
    cuboids.record.elements = elements_by_size(cuboids, cells, options);
    if (!options.faces) return;
    for (auto& [name, sides] : name_outer_sides(cuboids, *options.faces)) {
        std::vector<CuboidSide>& set = cuboids.volume.sets[name];
        set.insert(set.end(), sides.begin(), sides.end());
    }
    cuboids.record.sets = cuboids.volume.sets;
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
    if (solid.cuboids.record.elements.empty()) complete_record(solid.cuboids, cells, options);
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

    say("mapping the surface");
    solid.map = make_layout_map(mesh, surface, cells_of_surface(surface.layout, cells, elements),
                                map_options);
    const int n_flipped = solid.map->report.n_flipped;
    if (n_flipped == 0) solid.mapped_quads = sample_layout_map(mesh, surface, *solid.map);
    if (options.last == SolidStage::map) return solid;
    if (n_flipped > 0) {
        throw GeometryError(
            "mesh: {} triangles of the quadratic map are flipped, so that it has no quads: look at "
            "the stage map, or take parameterization = \"aligned\", which flips none",
            n_flipped);
    }

    say("moving nodes");
    NodeRelocationOptions relocation;
    relocation.max_iterations = options.max_relocations;
    RelocatedSamples relocated = relocate_nodes(mesh, surface, *solid.mapped_quads, relocation);
    if (relocated.report.n_inverted > 0) {
        throw GeometryError(
            "mesh: {} corners of quads stay turned over on the surface: the cuboids are too "
            "distorted there. Look at the stages layout and map; other cuts ([meshing] cycle, "
            "loop) "
            "or templates help, or smaller elements",
            relocated.report.n_inverted);
    }
    solid.relocation = relocated.report;
    solid.quads = std::move(relocated.samples);
    solid.quad_quality = quad_quality(to_quad_mesh(*solid.quads), mesh);
    if (options.last == SolidStage::quads) return solid;

    say("fitting splines and filling the volume");
    LayoutVolumeOptions volume = options.volume;
    volume.n_elements = elements;
    solid.volume = make_layout_volume(
        solid.cuboids.volume,
        refine_samples(mesh, surface, *solid.quads, options.samples_per_element), volume);
    solid.distance = volume_distance(solid.volume->volume, solid.cuboids);
    return solid;
}

}  // namespace couture::meshing
