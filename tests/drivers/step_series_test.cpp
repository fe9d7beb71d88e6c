#include <catch2/catch.hpp>
#include <filesystem>

#include "drivers/field_series.h"
#include "drivers/job_geometry.h"
#include "drivers/state_series.h"
#include "iga/core/log.h"
#include "io/atomic_file.h"
#include "io/vtk_reader.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::drivers;
using Catch::Matchers::Contains;
using tests::TemporaryFolder;

namespace fs = std::filesystem;

namespace {

const io::StateOrigin origin{"a.toml", "1", "2", "", ""};

io::Deck deck() {
    return io::parse_deck(
        "[geometry]\npart = \"box\"\n[material.rubber]\nmodel = \"neo_hookean\"\n"
        "shear_modulus = 3.0\nbulk_modulus = 20.0\n[output]\nevery = 2\ngauss_points = true\n"
        "[stepping]\nend = 2.0\n",
        "a&b.toml");
}

iga::ReferencePtr<3> box() {
    const io::AnyMultiPatch geometry = load_geometry(deck());
    return iga::make_reference<3>(
        std::make_shared<const iga::Space<3>>(std::get<iga::MultiPatch<3>>(geometry)));
}

/// The body, twice as long: its displacement is its position along x.
iga::AcceptedStep<3> stretched(const iga::ReferencePtr<3>& reference, int number) {
    iga::AcceptedStep<3> step;
    step.number = number;
    step.state.t = 0.1 * number;
    step.state.reference = reference;
    const iga::Patch<3>& patch = reference->space->geometry().patches[0];
    step.state.displacement = MatrixX::Zero(reference->space->n_dofs(), 3);
    for (Eigen::Index i = 0; i < patch.control_points().rows(); ++i) {
        step.state.displacement(reference->space->dofs(0)[i], 0) = patch.control_points()(i, 0);
    }
    return step;
}

/// The stretched body as its own reference.
iga::AcceptedStep<3> meshed_again(const iga::AcceptedStep<3>& step) {
    const iga::Space<3>& space = *step.state.reference->space;
    iga::MultiPatch<3> body = space.geometry();
    MatrixX points = body.patches[0].control_points();
    points.col(0) *= 2.0;
    body.patches[0] = iga::Patch<3>(body.patches[0].space(), points);
    iga::ReferenceConfiguration<3> reference;
    reference.space = std::make_shared<const iga::Space<3>>(body);
    reference.displacement = step.state.displacement;
    reference.gradient = MatrixX::Zero(space.n_dofs(), 9);
    reference.gradient.col(0).setOnes();
    iga::AcceptedStep<3> after = step;
    after.state.n_remeshings = 1;
    after.state.reference = std::make_shared<const iga::ReferenceConfiguration<3>>(reference);
    after.remeshing = iga::RemeshingReport{};
    return after;
}

StepSummary record(int number, bool is_remeshing) {
    StepSummary step;
    step.number = number;
    step.t = 0.1 * number;
    if (is_remeshing) {
        step.remeshing = iga::RemeshingReport{};
    }
    return step;
}

}  // namespace

TEST_CASE("StateSeries: a remeshing follows its step", "[drivers]") {
    const TemporaryFolder folder;
    const iga::ReferencePtr<3> reference = box();
    const StateSeries<3> series(folder.path() / "states", origin, reference);
    CHECK(series.read_all().empty());
    const iga::AcceptedStep<3> third = stretched(reference, 3);
    series.write(third);
    series.write(meshed_again(third));
    series.write(stretched(reference, 12345));
    series.write(stretched(reference, 4));
    const auto steps = series.read_all();
    REQUIRE(steps.size() == 4);
    CHECK(steps[0].number == 3);
    CHECK_FALSE(steps[0].remeshing);
    CHECK(steps[1].number == 3);
    CHECK(steps[1].remeshing);
    CHECK(steps[2].number == 4);
    CHECK(steps[3].number == 12345);
    CHECK(steps[3].state.displacement == third.state.displacement);
    CHECK(series.read(3, true).state.reference->gradient(0, 0) == 1.0);
    CHECK(series.clear() == 4);
    CHECK(fs::is_empty(folder.path() / "states"));
}

TEST_CASE("StateSeries: damaged files are named, newer ones than the last go", "[drivers]") {
    const TemporaryFolder folder;
    const iga::ReferencePtr<3> reference = box();
    const StateSeries<3> series(folder.path(), origin, reference);
    for (int i = 1; i <= 4; ++i) {
        series.write(stretched(reference, i));
    }
    io::write_text(folder.path() / "0002.h5", "x");
    io::write_text(folder.path() / "0004.h5", "x");
    io::write_text(folder.path() / "notes.txt", "x");
    log::clear_warnings();
    const auto steps = series.read_all();
    REQUIRE(steps.size() == 2);
    CHECK(steps[1].number == 3);
    const std::vector<std::string> warnings = log::warnings();
    log::clear_warnings();
    REQUIRE(warnings.size() == 3);
    CHECK_THAT(warnings[1], Contains("the states of steps 2 to 2 are missing"));
    CHECK_THAT(warnings[2], Contains("0004.h5: the first 512 bytes are not those of") &&
                                Contains("; this state is left out"));
    CHECK(fs::exists(folder.path() / "0002.h5"));
    CHECK_FALSE(fs::exists(folder.path() / "0004.h5"));
    CHECK(fs::exists(folder.path() / "notes.txt"));
}

TEST_CASE("FieldSeries: fields after a remeshing lie on the undeformed body", "[drivers]") {
    const TemporaryFolder folder;
    const io::Deck part = deck();
    const iga::ReferencePtr<3> reference = box();
    const FieldSeries<3> series(part, reference->space->geometry(), {}, folder.path());
    const iga::AcceptedStep<3> third = stretched(reference, 3);
    series.write(third);
    series.write(meshed_again(third));
    CHECK(series.has(record(3, false)));
    CHECK(series.has(record(3, true)));
    CHECK_FALSE(series.has(record(4, false)));
    for (const std::string& name : {std::string("a&b_0003"), std::string("a&b_gauss_0003")}) {
        const io::VtuMesh before = io::read_vtu(folder.path() / (name + ".vtu"));
        const io::VtuMesh after = io::read_vtu(folder.path() / (name + "_remeshed.vtu"));
        CHECK((before.points - after.points).norm() < 1e-12);
        REQUIRE(before.point_arrays.size() == after.point_arrays.size());
        for (std::size_t i = 0; i < before.point_arrays.size(); ++i) {
            CAPTURE(before.point_arrays[i].name);
            CHECK((before.point_arrays[i].rows - after.point_arrays[i].rows).norm() < 1e-8);
        }
    }
    series.write_lists({record(2, false), record(3, false), record(3, true)});
    const std::string list = io::read_text(folder.path() / "a&b.pvd");
    CHECK_THAT(list, Contains("file=\"a&amp;b_0003_remeshed.vtu\""));
    CHECK(list.find("0002") == std::string::npos);
    CHECK(list.find("0003.vtu") == std::string::npos);
    series.write_lists({record(3, false)});
    CHECK_THAT(io::read_text(folder.path() / "a&b.pvd"), Contains("file=\"a&amp;b_0003.vtu\""));
    io::write_text(folder.path() / "a&b_notes.vtu", "kept");
    series.clear();
    CHECK(fs::exists(folder.path() / "a&b_notes.vtu"));
    CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
}

TEST_CASE("FieldSeries: each n-th step, the last and remeshings are due", "[drivers]") {
    const io::Deck part = deck();
    const iga::ReferencePtr<3> reference = box();
    const FieldSeries<3> series(part, reference->space->geometry(), {}, "nowhere");
    CHECK_FALSE(series.is_due(record(3, false)));
    CHECK(series.is_due(record(3, true)));
    CHECK(series.is_due(record(4, false)));
    StepSummary last = record(5, false);
    last.t = 2.0;
    CHECK(series.is_due(last));
}
