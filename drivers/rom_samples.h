#pragma once

#include <memory>

#include "drivers/rom_plan.h"
#include "iga/linalg/sparse_solver.h"
#include "iga/topology/space.h"
#include "io/deck.h"
#include "io/snapshot_store.h"

namespace couture::drivers {

/// Why there are no reduced models of plane geometries, and what to do.
inline constexpr const char* rom_needs_volume =
    "reduced models are made of volumes; this geometry lies in the plane: take the solid (for "
    "example \"plate_with_hole_3d\")";

/// Something deforms the body: a load, a prescribed displacement or a temperature.
[[nodiscard]] bool moves(const io::Deck& deck);

/// Members of a deck's family and their solutions, each made from its parameters and the reference
/// member alone, whatever else was made before.
class RomSamples {
  public:
    /// @param path, overrides  the deck, with a section [rom]
    /// @throws what read_deck throws; InputError for a deck without [rom], in the plane, or with
    ///         several load cases
    RomSamples(const std::filesystem::path& path, const std::vector<std::string>& overrides);

    [[nodiscard]] const io::Deck& deck() const { return deck_; }
    [[nodiscard]] const std::string& text() const { return text_; }
    [[nodiscard]] const std::vector<std::string>& overrides() const { return overrides_; }
    [[nodiscard]] const io::RomSection& section() const { return *deck_.rom; }
    [[nodiscard]] const RomPlan& plan() const { return plan_; }
    /// The deck has no loads: members are meshed, not solved.
    [[nodiscard]] bool is_geometry_only() const { return !moves(deck_); }
    /// Takes over the geometries that were added to a store of the deck's design.
    void take_added(const io::SnapshotStore& store);
    /// From now on other points than the deck's design.
    void use(RomPlan plan) {
        plan_ = std::move(plan);
        n_added_ = 0;
    }
    /// What snapshots depend on, as JSON: model, design, files, version of the program.
    [[nodiscard]] std::string job() const;

    /// The deck with the parameters at a point. @param point  in their units
    /// @throws InputError  naming the point, for values that the deck can't have
    [[nodiscard]] io::Deck deck_at(const VectorX& point) const;

    /// The space of the member in the middle of all ranges; the store's, if it has one.
    /// @throws what meshing, building and check_deck throw
    [[nodiscard]] iga::SpacePtr<3> make_reference(io::SnapshotStore& store) const;

    /// The space of another member.
    ///
    /// @throws GeometryError  also for a folded member
    [[nodiscard]] iga::SpacePtr<3> make_member(const VectorX& point,
                                               const io::SnapshotStore& store) const;

    /// Displacements of a member, 3 n_nodes x n_loads, unknown 3 * node + component: linear
    /// statics, all loads with one factorization, or the end of each run over time; 0 without
    /// loads.
    ///
    /// @param points  of the parameters, one for each load, in their units
    /// @throws what the solvers throw; SolverError for a run that does not reach its end
    [[nodiscard]] MatrixX solve(const iga::SpacePtr<3>& member, const std::vector<VectorX>& points);

    /// As `solve` of linear problems, in the space of some fields: no factorization.
    ///
    /// @param fields  3 n_nodes x n_fields
    [[nodiscard]] MatrixX project(const iga::SpacePtr<3>& member,
                                  const std::vector<VectorX>& points, const MatrixX& fields) const;

    /// Checks that displacements are proportional to each factored load and inversely to each
    /// factored modulus, whatever the rest.
    ///
    /// @throws InputError  naming the parameter and the condition that does not hold
    void check_factored(const iga::SpacePtr<3>& reference) const;

    /// Checks that a part has the same geometry at both ends of a periodic parameter. Meshed and
    /// listed members are not compared.
    ///
    /// @throws InputError  naming the parameter and the largest difference
    void check_periodic(const iga::SpacePtr<3>& reference) const;

    /// The member in the middle of all ranges, and with one geometric parameter at an end, up to
    /// its surface where it is meshed: for those that can't be made a warning says why.
    ///
    /// @throws InputError  if the one in the middle can't be made
    void check_ends() const;

  private:
    [[nodiscard]] io::Deck parsed_deck(const VectorX& point, std::vector<std::string> more) const;
    // With the member's own geometry, of a listed one its file.
    [[nodiscard]] io::Deck deck_of_member(const VectorX& point) const;
    // Problems whose loads alone differ are one with several load cases.
    [[nodiscard]] std::vector<iga::Problem> linear_problems(
        const std::vector<VectorX>& points) const;
    [[nodiscard]] MatrixX solve_linear(const iga::SpacePtr<3>& member, const iga::Problem& problem);

    std::filesystem::path path_;
    std::vector<std::string> overrides_;
    std::string text_;
    io::Deck deck_;
    RomPlan plan_;
    // The last of its geometries, which the job knows nothing of.
    int n_added_ = 0;
    // Its pattern and order are those of all members.
    std::unique_ptr<iga::LinearSolver> solver_;
};

/// "R1 = 11 mm, load = 140 N".
[[nodiscard]] std::string describe_point(const rom::ParameterSpace& space, const VectorX& point);

}  // namespace couture::drivers
