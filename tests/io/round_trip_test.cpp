#include <algorithm>
#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "io/atomic_file.h"
#include "io/spline_file.h"
#include "tests/io/sample_splines.h"

using namespace couture;
using Catch::Matchers::Contains;

namespace {

// Control points times weights are rounded once on writing and once on reading.
constexpr double rounding = 4e-16;

template <int d>
std::vector<iga::Interface<d>> ordered(std::vector<iga::Interface<d>> interfaces) {
    for (iga::Interface<d>& interface : interfaces) {
        if (std::pair(interface.first_patch, interface.first_side) >
            std::pair(interface.second_patch, interface.second_side)) {
            interface = {interface.second_patch, interface.second_side, interface.first_patch,
                         interface.first_side, interface.map.inverse()};
        }
    }
    std::sort(interfaces.begin(), interfaces.end(), [](const auto& a, const auto& b) {
        return std::pair(a.first_patch, a.first_side) < std::pair(b.first_patch, b.first_side);
    });
    return interfaces;
}

template <int d>
void expect_equal(const iga::MultiPatch<d>& found, const iga::MultiPatch<d>& expected,
                  double tolerance) {
    REQUIRE(found.n_patches() == expected.n_patches());
    for (int i = 0; i < found.n_patches(); ++i) {
        const iga::Patch<d>& a = found.patches[i];
        const iga::Patch<d>& b = expected.patches[i];
        CHECK(a.space() == b.space());
        CHECK(a.weights() == b.weights());
        CHECK((a.control_points() - b.control_points()).cwiseAbs().maxCoeff() <=
              tolerance * b.control_points().cwiseAbs().maxCoeff());
    }
    CHECK(ordered(found.interfaces) == ordered(expected.interfaces));
    REQUIRE(found.boundary_sets.size() == expected.boundary_sets.size());
    for (const auto& [name, set] : expected.boundary_sets) {
        iga::BoundarySet<d> a = found.boundary_set(name);
        iga::BoundarySet<d> b = set;
        std::sort(a.begin(), a.end());
        std::sort(b.begin(), b.end());
        CHECK(a == b);
    }
}

template <int d>
iga::MultiPatch<d> read_back(const std::filesystem::path& path,
                             const iga::MultiPatch<d>& multipatch) {
    io::write_splines(path, multipatch);
    const io::SplineFile file = io::read_splines(path);
    return std::get<iga::MultiPatch<d>>(file.multipatch);
}

template <int d>
void expect_round_trips(const std::string& extension) {
    const test::TemporaryFolder folder;
    for (std::size_t i_map = 0; i_map < iga::all_side_maps<d>().size(); ++i_map) {
        for (const int side : {0, 3, 2 * d - 1}) {
            for (const bool is_rational : {false, true}) {
                iga::MultiPatch<d> expected = test::make_pair<d>(i_map, side, is_rational);
                if (extension == ".mesh") {
                    // Names become numbers there.
                    auto clamped = expected.boundary_sets.extract("clamped");
                    clamped.key() = "boundary_1";
                    expected.boundary_sets.insert(std::move(clamped));
                }
                INFO(extension << " map " << i_map << " side " << side << " rational "
                               << is_rational);
                const bool is_weighted = extension == ".txt" && is_rational;
                expect_equal(read_back(folder / ("pair" + extension), expected), expected,
                             is_weighted ? rounding : 0.0);
            }
        }
    }
}

iga::MultiPatch<2> make_surface_in_space() {
    const iga::Patch<2> flat = test::make_bent_box<2>(0.0, true);
    MatrixX points(flat.control_points().rows(), 3);
    points.leftCols(2) = flat.control_points();
    points.col(2).setConstant(1.0 / 3.0);
    iga::MultiPatch<2> result;
    result.patches = {iga::Patch<2>(flat.space(), points, flat.weights())};
    return result;
}

}  // namespace

TEST_CASE("write_splines: what is read back equals what was written in all orientations", "[io]") {
    const std::string extension = GENERATE(".xml", ".mesh", ".txt", ".inp", ".h5");
    expect_round_trips<2>(extension);
    expect_round_trips<3>(extension);
}

TEST_CASE("write_splines: surfaces in space are kept or refused", "[io]") {
    const test::TemporaryFolder folder;
    const iga::MultiPatch<2> surface = make_surface_in_space();
    for (const std::string extension : {".xml", ".txt", ".h5"}) {
        expect_equal(read_back(folder / ("s" + extension), surface), surface,
                     extension == ".txt" ? rounding : 0.0);
    }
    CHECK_THROWS_WITH(io::write_splines(folder / "s.mesh", surface),
                      Contains("surfaces in space") && Contains(".xml, .txt or .h5"));
    CHECK_THROWS_WITH(io::write_splines(folder / "s.inp", surface),
                      Contains("surfaces in space") && Contains(".xml, .txt or .h5"));
    CHECK_FALSE(std::filesystem::exists(folder / "s.mesh"));
}

TEST_CASE("write_splines: edge sets are kept or refused", "[io]") {
    const test::TemporaryFolder folder;
    iga::MultiPatch<3> multipatch = test::make_pair<3>(2, 0, false);
    iga::PatchEntity<3> edge;
    edge.position = {iga::End::low, iga::End::high, iga::End::free};
    multipatch.boundary_sets["edge"] = {edge};
    for (const std::string extension : {".h5", ".inp"}) {
        expect_equal(read_back(folder / ("e" + extension), multipatch), multipatch, 0.0);
    }
    for (const std::string extension : {".xml", ".mesh", ".txt"}) {
        CHECK_THROWS_WITH(
            io::write_splines(folder / ("e" + extension), multipatch),
            Contains("boundary set 'edge' holds patch 0 edge 0:low 1:high") && Contains(".h5"));
    }
}

TEST_CASE("write_splines: MFEM says which number a name became", "[io]") {
    const test::TemporaryFolder folder;
    log::clear_warnings();
    log::set_level(log::Level::quiet);
    const iga::MultiPatch<3> found =
        read_back(folder / "pair.mesh", test::make_pair<3>(5, 2, true));
    log::set_level(log::Level::progress);
    CHECK(found.boundary_sets.count("boundary_3") == 1);
    CHECK(found.boundary_set("boundary_1").size() == 2);
    REQUIRE(log::warnings().size() == 1);
    CHECK_THAT(log::warnings()[0], Contains("set 'clamped' is attribute 1"));
    log::clear_warnings();
}

TEST_CASE("write_splines: an unknown extension names those that are known", "[io]") {
    const test::TemporaryFolder folder;
    CHECK_THROWS_WITH(io::write_splines(folder / "a.step", make_surface_in_space()),
                      Contains("unknown extension '.step'") && Contains(".mesh"));
    CHECK_THROWS_WITH(io::write_splines(folder / "a.xml", iga::MultiPatch<3>{}),
                      Contains("no patches"));
}
