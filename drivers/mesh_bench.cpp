#include "drivers/mesh_bench.h"

#include <fmt/format.h>

#include <ctime>
#include <filesystem>

#include "drivers/mesh_stages.h"
#include "iga/core/log.h"
#include "iga/core/parallel.h"
#include "iga/topology/side_patch.h"
#include "io/mesh_deck.h"
#include "io/pants_file.h"
#include "meshing/volume/volumes_from_surfaces.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;

/// As drivers/decks/mesh_wheel_volume.toml.
constexpr const char* wheel_deck = R"([geometry]
part = "wheel"
[meshing]
element_size = 6.0
cycle = { length = 1.0, symmetry = 1.0, sharp = -0.75 }
[[meshing.loop]]
points = [[40.0, 20.71875, 0.0], [31.8, 31.8, 4.46875], [0.0, 45.0, 4.46875], [-31.8, 31.8, 4.46875], [-40.0, 20.71875, 0.0], [-31.8, 31.8, -4.46875], [0.0, 45.0, -4.46875], [31.8, 31.8, -4.46875]]
[[meshing.loop]]
points = [[40.0, -20.71875, 0.0], [31.8, -31.8, 4.46875], [0.0, -45.0, 4.46875], [-31.8, -31.8, 4.46875], [-40.0, -20.71875, 0.0], [-31.8, -31.8, -4.46875], [0.0, -45.0, -4.46875], [31.8, -31.8, -4.46875]]
)";

/// The reference of drivers/decks/pant_family.toml, or one of 2500 triangles.
std::string pant_deck(bool quick) {
    return fmt::format(
        "[geometry]\npart = \"pant\"\n[meshing]\nopen = \"caps\"\nedge_length = {}\n"
        "element_size = 10.0\n",
        quick ? 8.0 : 4.6);
}

/// Processor time of this process so far.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

int n_elements(const iga::MultiPatch<3>& volume) {
    int n = 0;
    for (const iga::Volume& patch : volume.patches) {
        n +=
            patch.knots(0).n_elements() * patch.knots(1).n_elements() * patch.knots(2).n_elements();
    }
    return n;
}

/// Runs a deck up to its stage.
MeshingRow measure_deck(const io::MeshDeck& deck, MeshStages& stages) {
    MeshingRow row{.part = deck.part, .task = "triangles to " + deck.stage};
    log::info(fmt::format("{}, {}", row.part, row.task));
    const double start = cpu_seconds();
    run_mesh_stages(deck, fs::path(), stages);
    row.cpu_seconds = cpu_seconds() - start;
    row.n_input = static_cast<int>(stages.mesh.n_faces());
    if (stages.solid->volume) {
        const meshing::LayoutVolume& made = *stages.solid->volume;
        row.n_patches = made.volume.n_patches();
        row.n_elements = n_elements(made.volume);
        row.min_scaled_jacobian = made.report.quality.min_scaled_jacobian;
    } else {
        const meshing::LayoutSamples& quads = *stages.solid->quads;
        row.n_patches = quads.layout.n_quads();
        for (int q = 0; q < row.n_patches; ++q) {
            row.n_elements += quads.n_cells[quads.layout.sides(q)[0].arc] *
                              quads.n_cells[quads.layout.sides(q)[1].arc];
        }
    }
    return row;
}

/// The volume again from the sides of its patches.
MeshingRow measure_surfaces(const std::string& part, const iga::MultiPatch<3>& volume) {
    std::vector<iga::Surface> surfaces;
    for (int p = 0; p < volume.n_patches(); ++p) {
        for (int side = 0; side < 6; ++side) {
            surfaces.push_back(
                iga::entity_patch<3, 2>(volume.patches[p], iga::make_side<3>(p, side).position));
        }
    }
    MeshingRow row{
        .part = part, .task = "surfaces to volume", .n_input = static_cast<int>(surfaces.size())};
    log::info(fmt::format("{}, {}", row.part, row.task));
    const double start = cpu_seconds();
    const auto made = meshing::volumes_from_surfaces(surfaces);
    row.cpu_seconds = cpu_seconds() - start;
    row.n_patches = made.volume.n_patches();
    row.n_elements = n_elements(made.volume);
    row.min_scaled_jacobian = made.report.parameterization.min_scaled_jacobian_after;
    return row;
}

/// A pant with two legs moved, cut and laid out as the reference was.
MeshingRow measure_member(io::MeshDeck deck, const MeshStages& reference) {
    const fs::path record = fs::temp_directory_path() /
                            fmt::format("couture_bench_{}.json", static_cast<long>(std::clock()));
    io::write_layout_record(record, *reference.record, reference.solid->cuboids.record, "");
    deck.like = record;
    deck.parameters["X1"] = 20.0;
    deck.parameters["Y3"] = 30.0;
    MeshStages stages;
    MeshingRow row = measure_deck(deck, stages);
    fs::remove(record);
    row.task = "family member";
    return row;
}

}  // namespace

std::vector<MeshingRow> measure_meshing(bool quick) {
    const int before = n_threads();
    set_n_threads(1);
    std::vector<MeshingRow> rows;
    const auto measure = [&](const std::string& text, const std::vector<std::string>& last,
                             MeshStages& stages) {
        io::MeshDeck deck = io::parse_mesh_deck(text, fs::path());
        for (const std::string& stage : last) {
            deck.stage = stage;
            rows.push_back(measure_deck(deck, stages));
        }
        return deck;
    };
    MeshStages stages;
    if (!quick) {
        (void)measure(wheel_deck, {"quads", "volume"}, stages);
        rows.push_back(measure_surfaces("wheel", stages.solid->volume->volume));
    }
    const io::MeshDeck pant = measure(pant_deck(quick), {"volume"}, stages);
    rows.push_back(measure_surfaces("pant", stages.solid->volume->volume));
    rows.push_back(measure_member(pant, stages));
    set_n_threads(before);
    return rows;
}

}  // namespace couture::drivers
