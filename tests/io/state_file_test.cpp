#include "io/state_file.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "tests/io/temporary_folder.h"

using namespace couture;
using namespace couture::io;
using Catch::Matchers::Contains;

namespace {

const StateOrigin origin{"part.toml", "0123456789abcdef", "5555", "part.xml", "7777"};

iga::MultiPatch<2> square() {
    iga::MultiPatch<2> part;
    MatrixX points(4, 2);
    points << 0.0, 0.0, 1.0 / 3.0, 0.0, 0.0, 0.1, 1.0 / 3.0, 0.1;
    const iga::KnotVector linear(1, {0.0, 0.0, 1.0, 1.0});
    part.patches = {iga::Patch<2>({{linear, linear}}, points)};
    part.boundary_sets["low"] = {iga::make_side<2>(0, 0)};
    return part;
}

/// Numbers that no short text holds.
MatrixX some_matrix(Eigen::Index rows, Eigen::Index columns) {
    return (MatrixX::Random(rows, columns).array() / 3.0).matrix();
}

iga::AcceptedStep<2> some_step() {
    iga::AcceptedStep<2> step;
    step.state.t = 0.1 + 0.2;
    step.state.next_step = 1.0 / 3.0;
    step.state.work = -2.0 / 7.0;
    step.state.time_direction = 0.7;
    step.state.displacement_scale = 1.0 / 11.0;
    step.state.n_steps = 12;
    step.state.n_remeshings = 2;
    step.state.last_remeshing = 0.1;
    step.state.watches_quality = false;
    step.state.reference = iga::make_reference<2>(std::make_shared<const iga::Space<2>>(square()));
    step.state.displacement = some_matrix(4, 2);
    step.state.direction = some_matrix(4, 2);
    step.number = 12;
    step.step = 0.1;
    step.n_cuts = 3;
    step.newton.converged = true;
    step.newton.iterations = 5;
    step.newton.residuals = {1.0, 1e-5, 1.0 / 3e12};
    step.newton.min_det_F = 0.9;
    step.energy = 1.0 / 9.0;
    step.applied_force = Vector3(1.0, 2.0, 1.0 / 3.0);
    step.reactions["low"] = Vector3(-1.0, 0.1, 0.0);
    return step;
}

}  // namespace

TEST_CASE("state file: everything comes back with every digit", "[io]") {
    const TemporaryFolder folder;
    iga::AcceptedStep<2> step = some_step();
    // Not meshed again: the reference is the undeformed body at hand.
    step.state.n_remeshings = 0;
    write_state<2>(folder / "states/0012.h5", step, origin);
    const iga::AcceptedStep<2> back =
        read_state<2>(folder / "states/0012.h5", step.state.reference, origin);
    CHECK(back.state.reference == step.state.reference);
    CHECK(back.state.t == step.state.t);
    CHECK(back.state.next_step == step.state.next_step);
    CHECK(back.state.work == step.state.work);
    CHECK(back.state.time_direction == step.state.time_direction);
    CHECK(back.state.displacement_scale == step.state.displacement_scale);
    CHECK(back.state.n_steps == 12);
    CHECK(back.state.n_remeshings == 0);
    CHECK(back.state.last_remeshing == 0.1);
    CHECK_FALSE(back.state.watches_quality);
    CHECK(back.state.displacement == step.state.displacement);
    CHECK(back.state.direction == step.state.direction);
    CHECK(back.number == 12);
    CHECK(back.step == step.step);
    CHECK(back.n_cuts == 3);
    CHECK(back.newton.iterations == 5);
    CHECK(back.newton.residuals == step.newton.residuals);
    CHECK(back.newton.min_det_F == 0.9);
    CHECK(back.energy == step.energy);
    CHECK(back.applied_force == step.applied_force);
    CHECK(back.reactions == step.reactions);
    CHECK_FALSE(back.remeshing);
}

TEST_CASE("state file: the reference of a body that was meshed again", "[io]") {
    const TemporaryFolder folder;
    iga::AcceptedStep<2> step = some_step();
    iga::ReferenceConfiguration<2> reference = *step.state.reference;
    reference.displacement = some_matrix(4, 2);
    reference.gradient = some_matrix(4, 9);
    step.state.reference = std::make_shared<const iga::ReferenceConfiguration<2>>(reference);
    step.remeshing = iga::RemeshingReport{};
    step.remeshing->cause = "time";
    step.remeshing->energy_transferred = 1.0 / 3.0;
    step.remeshing->reactions_after["low"] = Vector3(1.0, 2.0, 3.0);
    write_state<2>(folder / "0012.h5", step, origin);
    const iga::AcceptedStep<2> back = read_state<2>(folder / "0012.h5", {}, origin);
    const iga::ReferenceConfiguration<2>& found = *back.state.reference;
    CHECK(found.displacement == reference.displacement);
    CHECK(found.gradient == reference.gradient);
    CHECK(iga::signature(found.space->geometry()) == iga::signature(square()));
    CHECK(found.space->geometry().patches[0].control_points() ==
          square().patches[0].control_points());
    CHECK(found.space->geometry().boundary_sets.count("low") == 1);
    REQUIRE(back.remeshing);
    CHECK(back.remeshing->cause == "time");
    CHECK(back.remeshing->energy_transferred == 1.0 / 3.0);
    CHECK(back.remeshing->reactions_after == step.remeshing->reactions_after);
}

TEST_CASE("state file: a new mesh of the undeformed body comes back", "[io]") {
    const TemporaryFolder folder;
    const iga::AcceptedStep<2> step = some_step();
    REQUIRE(step.state.reference->is_undeformed());
    REQUIRE(step.state.n_remeshings > 0);
    write_state<2>(folder / "0012.h5", step, origin);
    const iga::AcceptedStep<2> back = read_state<2>(folder / "0012.h5", {}, origin);
    REQUIRE(back.state.reference);
    CHECK(back.state.reference->is_undeformed());
    CHECK(back.state.n_remeshings == 2);
    CHECK(back.state.reference->space->geometry().patches[0].control_points() ==
          square().patches[0].control_points());
    CHECK(back.state.displacement == step.state.displacement);
}

TEST_CASE("state file: another deck, geometry or signature is named with both", "[io]") {
    const TemporaryFolder folder;
    const iga::AcceptedStep<2> step = some_step();
    write_state<2>(folder / "0012.h5", step, origin);
    const auto error_with = [&](const StateOrigin& other) {
        try {
            static_cast<void>(read_state<2>(folder / "0012.h5", step.state.reference, other));
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    CHECK(error_with(origin) == "no error");
    StateOrigin other = origin;
    other.deck = "new.toml";
    CHECK(error_with(other) == "no error");
    other.model_hash = "fedcba9876543210";
    CHECK_THAT(error_with(other),
               Contains("is a state of another deck: model hash 0123456789abcdef of 'part.toml' "
                        "there, fedcba9876543210 of 'new.toml' here; resume with the deck"));
    other = origin;
    other.geometry_hash = "8888";
    CHECK_THAT(error_with(other), Contains("geometry file part.xml (7777) of 'part.toml' there"));
    other = origin;
    other.signature = "6666";
    CHECK_THAT(error_with(other), Contains("signature 5555 of 'part.toml' there, 6666"));
}

TEST_CASE("state file: cut or changed anywhere, it is refused", "[io]") {
    const TemporaryFolder folder;
    const iga::AcceptedStep<2> step = some_step();
    const auto path = folder / "0012.h5";
    write_state<2>(path, step, origin);
    const std::string whole = read_text(path);
    const auto read = [&] { static_cast<void>(read_state<2>(path, step.state.reference, origin)); };
    for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 50) {
        write_text(path, whole.substr(0, size));
        CHECK_THROWS_AS(read(), FileError);
    }
    for (std::size_t i = 0; i < whole.size(); i += 1 + whole.size() / 50) {
        // What follows the first line's end of the block is padding.
        if (i > 50 && i < 512) {
            continue;
        }
        std::string changed = whole;
        changed[i] = static_cast<char>(changed[i] ^ 1);
        write_text(path, changed);
        CHECK_THROWS_AS(read(), FileError);
    }
    write_text(path, whole);
    CHECK_NOTHROW(read());
}
