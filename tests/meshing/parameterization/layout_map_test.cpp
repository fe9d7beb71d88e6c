#include "meshing/parameterization/layout_map.h"

#include <catch2/catch.hpp>
#include <numbers>

#include "iga/core/error.h"
#include "iga/core/timer.h"
#include "layout_surfaces.h"
#include "meshing/parameterization/map_samples.h"
#include "meshing/parameterization/node_relocation.h"
#include "meshing/parameterization/sheet_sizes.h"
#include "meshing/parameterization/symmetric_dirichlet.h"

using namespace couture;
using namespace couture::meshing;

namespace {

LayoutMap map_of(const LaidOutSurface& surface, double size, const LayoutMapOptions& options = {}) {
    const std::vector<int> sizes =
        sheet_sizes(surface.mesh, surface.embedding, {.target_size = size});
    return make_layout_map(surface.mesh, surface.embedding,
                           cells_of_arcs(surface.embedding.layout, sizes), options);
}

void check_descent(const LayoutMap& map) {
    const auto& energies = map.report.energies;
    CHECK(map.report.n_flipped == 0);
    CHECK(map.report.is_converged);
    for (std::size_t i = 1; i < energies.size(); ++i) CHECK(energies[i] <= energies[i - 1]);
}

}  // namespace

TEST_CASE("layout map: zzz", "[parameterization]") {
    for (int i = 0; i < 6; ++i) {
        const LaidOutSurface surface =
            i == 0   ? make_sphere_layout(12, Vector3::Zero())
            : i == 1 ? make_sphere_layout(12, Vector3(0.4, 0.3, 0.5))
            : i == 2 ? make_can_layout(12, 0.0)
            : i == 3 ? make_can_layout(12, 0.6)
            : i == 4 ? make_torus_layout(12, {0, 20, 50}, {0, 3, 6})
                     : make_tube_layout(12, true);
        Timer timer;
        const LayoutMap map = map_of(surface, 0.2);
        const auto& r = map.report;
        fmt::print("{}: {} faces {:.2f} s, energies {}\n", i, surface.mesh.n_faces(), timer.seconds(),
                   fmt::join(r.energies, " "));
        fmt::print("   size {} angle max {} mean {} area {} {}\n", r.cell_size,
                   r.distortion.largest_angle_change, r.distortion.mean_angle_change,
                   r.distortion.smallest_area_ratio, r.distortion.largest_area_ratio);
        check_descent(map);
        timer = Timer();
        const LayoutSamples samples = sample_layout_map(surface.mesh, surface.embedding, map);
        const double t_samples = timer.seconds();
        timer = Timer();
        const auto moved = relocate_nodes(surface.mesh, surface.embedding, samples);
        const auto& m = moved.report;
        fmt::print("   samples {:.3f} s relocate {:.3f} s inverted {} {} move {} energies {} conv {}\n", t_samples,
                   timer.seconds(), m.n_inverted_at_start, m.n_inverted, m.largest_move,
                   fmt::join(m.energies, " "), m.is_converged);
    }
}
