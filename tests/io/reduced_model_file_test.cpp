#include "io/reduced_model_file.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "iga/spline/shapes.h"
#include "io/atomic_file.h"
#include "io/hdf5_store.h"
#include "rom/designs.h"
#include "tests/io/temporary_folder.h"

using namespace couture;
using namespace couture::io;
using Catch::Matchers::Contains;

namespace {

iga::MultiPatch<3> quarter_ring() {
    iga::MultiPatch<3> part;
    part.patches = {
        iga::make_extrusion(iga::make_quarter_annulus(1.0, 2.0), Vector3(0.0, 0.0, 1.5))};
    part.boundary_sets["end"] = {iga::make_side<3>(0, 4)};
    return iga::refine<3>(part, 2, std::array<int, 3>{2, 2, 1});
}

/// Random fields: a family that nothing makes simpler.
rom::SnapshotSet random_family() {
    using Group = rom::ParameterGroup;
    rom::SnapshotSet set{
        rom::ParameterSpace({{"radius \"r\"", Group::geometry, "mm", 0.1, 1.0 / 3.0},
                             {"force", Group::load, "kN", 1.0, 2.0},
                             {"tilt", Group::load, "", -1.0, 1.0},
                             {"modulus", Group::material, "MPa", 1e5, 3e5}}),
        {0, 1, 0, -1},
        Vector<4>(0.2, 1.5, 0.1, 2e5),
        quarter_ring(),
        rom::full_design(1, 4),
        {rom::full_design(1, 3)},
        {},
        {}};
    const int n = 3 * iga::Space<3>(set.reference).n_dofs();
    set.control_points = rom::random_design(4, n, 1).array() - 0.5;
    set.displacements = rom::random_design(12, n, 2).array() - 0.5;
    return set;
}

const VectorX somewhere = Vector<4>(0.25, 1.7, 0.3, 1.2e5);

ReducedModelFile trained(const rom::ReducedModelOptions& options) {
    ReducedModelFile file{rom::ReducedModel(random_family(), options),
                          "[rom]\n# deck \xc3\xa9\n",
                          {{"host", "a"}, {"geometries", "4"}}};
    file.model.set_calibration(
        {.geometry = 1.0 / 3.0, .displacement = 1.7, .von_mises = 2.0, .n_points = 20});
    return file;
}

void check_equal(const rom::ReducedModel& a, const rom::ReducedModel& b) {
    const rom::Evaluation first = a.evaluate(somewhere);
    const rom::Evaluation second = b.evaluate(somewhere);
    CHECK(first.control_points == second.control_points);
    CHECK(first.displacement == second.displacement);
    CHECK(a.gradient(somewhere).displacement == b.gradient(somewhere).displacement);
    const rom::ErrorEstimates one = a.errors(somewhere);
    const rom::ErrorEstimates two = b.errors(somewhere);
    CHECK(one.geometry.total == two.geometry.total);
    CHECK(one.displacement.relative == two.displacement.relative);
    CHECK(one.displacement.leave_one_out == two.displacement.leave_one_out);
    CHECK(one.von_mises == two.von_mises);
}

}  // namespace

TEST_CASE("reduced model file: read back it evaluates to the same bits", "[io]") {
    const TemporaryFolder folder;
    rom::ReducedModelOptions options;
    options.basis = GENERATE(rom::BasisKind::separate, rom::BasisKind::stacked);
    options.product = GENERATE(rom::ModeProduct::l2, rom::ModeProduct::euclidean);
    options.n_modes = 5;
    options.kriging.trend = rom::Trend::linear;
    options.kriging.correlation = rom::CorrelationKind::gaussian;
    const ReducedModelFile written = trained(options);
    write_reduced_model(folder / "part.rom", written);
    const ReducedModelFile read = read_reduced_model(folder / "part.rom");
    check_equal(written.model, read.model);
    CHECK(read.deck == written.deck);
    CHECK(read.provenance == written.provenance);
    const rom::ReducedModelParts& parts = read.model.parts();
    CHECK(parts.parameters.parameters()[0].name == "radius \"r\"");
    CHECK(parts.parameters.parameters()[1].unit == "kN");
    CHECK(parts.parameters.parameters()[0].upper == 1.0 / 3.0);
    CHECK(parts.factor_power == std::vector<int>{0, 1, 0, -1});
    CHECK(parts.options.n_modes == 5);
    CHECK(parts.options.kriging.trend == rom::Trend::linear);
    CHECK(parts.calibration.n_points == 20);
    CHECK(iga::signature(parts.reference) == iga::signature(quarter_ring()));
    CHECK(parts.models[0].basis().singular_values ==
          written.model.parts().models[0].basis().singular_values);
    CHECK(parts.models[0].missing_modes() == written.model.parts().models[0].missing_modes());
}

TEST_CASE("reduced model file: with an amplitude", "[io]") {
    const TemporaryFolder folder;
    rom::SnapshotSet set = random_family();
    for (Eigen::Index j = 1; j < set.displacements.cols(); ++j) {
        set.displacements.col(j) = (1.0 + static_cast<double>(j)) * set.displacements.col(0);
    }
    const ReducedModelFile written{rom::ReducedModel(set, {}), "", {}};
    REQUIRE(written.model.parts().amplitude);
    write_reduced_model(folder / "part.rom", written);
    check_equal(written.model, read_reduced_model(folder / "part.rom").model);
}

TEST_CASE("reduced model file: equal models make equal files", "[io]") {
    const TemporaryFolder folder;
    write_reduced_model(folder / "a.rom", trained({}));
    write_reduced_model(folder / "b.rom", trained({}));
    write_reduced_model(folder / "c.rom", read_reduced_model(folder / "a.rom"));
    CHECK(read_text(folder / "a.rom") == read_text(folder / "b.rom"));
    CHECK(read_text(folder / "a.rom") == read_text(folder / "c.rom"));
}

TEST_CASE("reduced model file: without inputs", "[io]") {
    rom::SnapshotSet set = random_family();
    set.parameters = rom::ParameterSpace({{"force", rom::ParameterGroup::load, "", 1.0, 2.0}});
    set.factor_power = {1};
    set.reference_point = VectorX::Constant(1, 1.5);
    set.geometry_points = MatrixX(1, 0);
    set.mechanics_factors.clear();
    set.control_points = MatrixX(set.control_points.leftCols(1));
    set.displacements = MatrixX(set.displacements.leftCols(1));
    const TemporaryFolder folder;
    const ReducedModelFile written{rom::ReducedModel(set, {}), "", {}};
    write_reduced_model(folder / "part.rom", written);
    const VectorX point = VectorX::Constant(1, 1.2);
    CHECK(read_reduced_model(folder / "part.rom").model.evaluate(point).displacement ==
          written.model.evaluate(point).displacement);
}

TEST_CASE("reduced model file: cut, changed, strange and later files are refused", "[io]") {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "part.rom";
    write_reduced_model(path, trained({}));
    const std::string bytes = read_text(path);
    SECTION("cut") {
        write_text(path, bytes.substr(0, bytes.size() - 100));
        CHECK_THROWS_WITH(read_reduced_model(path), Contains("the file was cut or changed"));
    }
    SECTION("changed") {
        std::string changed = bytes;
        changed[changed.size() / 2] ^= 1;
        write_text(path, changed);
        CHECK_THROWS_WITH(read_reduced_model(path), Contains("the file was cut or changed"));
    }
    SECTION("of another kind") {
        write_text(path, "a text");
        CHECK_THROWS_WITH(read_reduced_model(path), Contains("expected 'Couture rom'"));
    }
    SECTION("of a later version") {
        std::string later = bytes;
        later.replace(0, 13, "Couture rom 3");
        write_text(path, later);
        CHECK_THROWS_AS(read_reduced_model(path), FileError);
        CHECK_THROWS_WITH(read_reduced_model(path), Contains("version"));
    }
    SECTION("whole, but with the content of another kind") {
        const std::string splines = to_hdf5<3>(quarter_ring());
        const std::size_t end = splines.find('\n');
        std::string block = "Couture rom 2" + splines.substr(end, 512 - end);
        block.resize(512, '\0');
        write_text(path, block + splines.substr(512));
        CHECK_THROWS_WITH(read_reduced_model(path), Contains("there is no data set 'record'"));
    }
    SECTION("not there") { CHECK_THROWS_AS(read_reduced_model(folder / "other.rom"), FileError); }
}
