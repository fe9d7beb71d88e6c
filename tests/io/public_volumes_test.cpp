#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "io/spline_file.h"
#include "tests/data_folder.h"

using namespace couture;

namespace {

struct Expected {
    const char* file;
    int n_patches;
    int n_interfaces;
    int lowest_degree;
    int highest_degree;
    bool is_rational;
};

// Counts of the files' own lists and of the sketches of their authors.
constexpr Expected volumes[] = {
    {"gsElasticity_terrific.xml", 15, 24, 2, 2, false},
    {"gismo_fichera.xml", 7, 9, 1, 1, false},
    {"gismo_twisted_fichera.xml", 7, 9, 1, 3, false},
    {"gsElasticity_bicepsLeftMP.xml", 5, 8, 2, 3, false},
    {"gismo_GshapedVolume.xml", 1, 0, 2, 2, false},
    {"gismo_cylinder.xml", 1, 1, 1, 2, true},
    {"mfem_pipe-nurbs.mesh", 4, 4, 2, 2, true},
    {"mfem_ball-nurbs.mesh", 7, 18, 4, 4, true},
    {"mfem_two-cubes-nurbs.mesh", 2, 1, 1, 1, false},
    {"mfem_two-cubes-nurbs-rot.mesh", 2, 1, 1, 1, false},
    {"mfem_two-cubes-nurbs-autoedge.mesh", 2, 1, 1, 1, false},
    {"geopdes_geo_sphere.txt", 7, 18, 4, 4, true},
    {"yeti_elephantTrunk.inp", 1, 0, 1, 2, true},
    {"yeti_volumetricBeam.inp", 1, 0, 1, 1, false},
};

iga::MultiPatch<3> read_volume(const std::filesystem::path& folder, const std::string& name) {
    const io::SplineFile file = io::read_splines(folder / "volumes" / name);
    return std::get<iga::MultiPatch<3>>(file.multipatch);
}

// Coordinates in the files have 13 to 15 digits.
constexpr double file_digits = 1e-11;

}  // namespace

TEST_CASE("read_splines: public volumes have their patches, interfaces and degrees", "[io]") {
    const auto folder = test::data_folder();
    if (!folder) {
        return;
    }
    const Expected expected = GENERATE(from_range(std::begin(volumes), std::end(volumes)));
    INFO(expected.file);
    const iga::MultiPatch<3> multipatch = read_volume(*folder, expected.file);
    CHECK(multipatch.n_patches() == expected.n_patches);
    CHECK(static_cast<int>(multipatch.interfaces.size()) == expected.n_interfaces);
    int lowest = iga::max_degree;
    int highest = 0;
    bool is_rational = false;
    for (const iga::Patch<3>& patch : multipatch.patches) {
        for (const int degree : patch.space().degrees()) {
            lowest = std::min(lowest, degree);
            highest = std::max(highest, degree);
        }
        is_rational |= patch.is_rational();
    }
    CHECK(lowest == expected.lowest_degree);
    CHECK(highest == expected.highest_degree);
    CHECK(is_rational == expected.is_rational);
}

TEST_CASE("read_splines: the eight orientations of two cubes are one body", "[io]") {
    const auto folder = test::data_folder();
    if (!folder) {
        return;
    }
    for (const char letter : std::string("abcdefgh")) {
        const iga::MultiPatch<3> cubes =
            read_volume(*folder, std::string("geopdes_geo_2cubes") + letter + ".txt");
        INFO(letter);
        REQUIRE(cubes.interfaces.size() == 1);
        CHECK((cubes.interfaces[0].map == iga::SideMap<3>::identity()) == (letter == 'a'));
        CHECK(iga::volume(cubes) == Approx(1.0).epsilon(file_digits));
        CHECK(cubes.outer_sides().size() == 10);
        // "x = 0" and so on.
        CHECK(cubes.boundary_sets.size() == 6);
        CHECK(cubes.boundary_set("x_0").size() == 1);
        CHECK(cubes.boundary_set("z_1").size() == 2);
    }
}

TEST_CASE("read_splines: volumes of balls and pipes are those of their formulas", "[io]") {
    const auto folder = test::data_folder();
    if (!folder) {
        return;
    }
    const double ball = 4.0 / 3.0 * std::numbers::pi;
    CHECK(iga::volume(read_volume(*folder, "mfem_ball-nurbs.mesh")) == Approx(ball).epsilon(1e-9));
    CHECK(iga::volume(read_volume(*folder, "geopdes_geo_sphere.txt")) ==
          Approx(ball).epsilon(1e-9));
    // Between radii 0.5 and 1, height 4; weights with 12 digits.
    CHECK(iga::volume(read_volume(*folder, "gismo_cylinder.xml")) ==
          Approx(3.0 * std::numbers::pi).epsilon(1e-9));
    CHECK(iga::volume(read_volume(*folder, "gismo_fichera.xml")) == Approx(7.0));
    CHECK(iga::volume(read_volume(*folder, "mfem_two-cubes-nurbs-rot.mesh")) == Approx(2.0));
    // A disc of radius 1 and height 10; weights with 9 digits.
    CHECK(iga::volume(read_volume(*folder, "yeti_elephantTrunk.inp")) ==
          Approx(10.0 * std::numbers::pi).epsilon(1e-7));
}

TEST_CASE("read_splines: boundaries of files become sets", "[io]") {
    const auto folder = test::data_folder();
    if (!folder) {
        return;
    }
    CHECK(read_volume(*folder, "mfem_ball-nurbs.mesh").boundary_set("boundary_1").size() == 6);
    CHECK(read_volume(*folder, "geopdes_geo_sphere.txt").boundary_set("boundary_1").size() == 6);
    const iga::MultiPatch<3> beam = read_volume(*folder, "yeti_volumetricBeam.inp");
    CHECK(beam.boundary_set("CPonX0") == iga::BoundarySet<3>{iga::make_side<3>(0, 0)});
    CHECK(beam.boundary_set("EltPAtch1_face3") == iga::BoundarySet<3>{iga::make_side<3>(0, 2)});
}

TEST_CASE("read_splines: the duck is a closed shell of six surfaces in space", "[io]") {
    const auto folder = test::data_folder();
    if (!folder) {
        return;
    }
    const io::SplineFile file = io::read_splines(*folder / "volumes" / "gismo_duck_BRep.xml");
    const auto& duck = std::get<iga::MultiPatch<2>>(file.multipatch);
    CHECK(file.format == "G+Smo XML");
    CHECK(duck.n_patches() == 6);
    CHECK(duck.dimension() == 3);
    CHECK(duck.interfaces.size() == 12);
    CHECK(duck.outer_sides().empty());
    // The file numbers the sides of patches 2 to 5 otherwise than their control points run.
    REQUIRE_FALSE(file.notes.empty());
    CHECK_THAT(file.notes[0], Catch::Matchers::Contains("sides of the listed interfaces"));
}
