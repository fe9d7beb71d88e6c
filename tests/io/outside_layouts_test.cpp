// A coarse mesh of cuboids that others drew for a public surface becomes a spline volume whose
// worst element is better than that of the others' own hexahedra.
#include <catch2/catch.hpp>
#include <cmath>

#include "iga/spline/shapes.h"
#include "iga/topology/element_quality.h"
#include "io/surface_reader.h"
#include "io/volumetric_layout_file.h"
#include "meshing/layout/place_layout.h"
#include "meshing/pipeline/solid_mesh.h"
#include "tests/data_folder.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// Each hexahedron as an element of its own.
iga::QualitySummary<3> hex_quality(const PlacedLayout& mesh) {
    iga::MultiPatch<3> elements;
    for (const auto& nodes : mesh.layout.cuboids) {
        MatrixX corners(8, 3);
        for (int k = 0; k < 8; ++k) corners.row(k) = mesh.positions[nodes[k]].transpose();
        elements.patches.push_back(iga::make_multilinear<3>(corners));
    }
    return iga::element_quality(elements);
}

}  // namespace

TEST_CASE("place_layout: a public layout becomes a certified volume whose worst element is better",
          "[io]") {
    const auto folder = test::data_folder();
    if (!folder) return;
    for (const std::string name : {"hepta"}) {
        INFO(name);
        const PlacedLayout hexes =
            io::read_volumetric_layout(*folder / "layouts" / (name + "_hex.vtk"));
        const iga::QualitySummary<3> theirs = hex_quality(hexes);
        SurfaceMesh mesh =
            make_surface_mesh(io::read_surface(*folder / "surfaces" / ("hexgen_" + name + ".off")));
        SolidMeshOptions options;
        options.element_size = std::cbrt(signed_volume(mesh) / hexes.layout.n_cuboids());
        const Features features = detect_features(mesh);
        const SolidMesh solid = mesh_solid(
            place_layout(mesh, features,
                         io::read_volumetric_layout(*folder / "layouts" / (name + "_layout.mesh"))),
            options);
        const LayoutVolumeReport& report = solid.volume->report;
        CHECK(report.parameterization.validity == iga::Validity::valid);
        CHECK(report.quality.min_scaled_jacobian > theirs.min_scaled_jacobian);
        CHECK(report.max_distance < 0.003 * bounding_box_diagonal(mesh));
    }
}
