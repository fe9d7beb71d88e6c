#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "rom/gradient_sampler.h"
#include "rom/member_volume.h"

namespace couture::rom {

/// A value and its derivatives by all parameters, units of the deck.
struct Measure {
    double value = 0.0;
    VectorX gradient;
};

/// A limited quantity over the sample points, as a multiple of its limit.
struct LimitedMeasure {
    /// At the worst point.
    double largest = 0.0;
    /// smooth_maximum.
    Measure smooth;
};

struct MassLimits {
    /// Of the largest von Mises stress and of the largest displacement; nothing: without limit.
    std::optional<double> von_mises = std::nullopt;
    std::optional<double> displacement = std::nullopt;
};

/// Mass of members and what is limited in them.
class MemberMeasures {
  public:
    /// The problem at a point of the parameters.
    using ProblemOf = std::function<iga::Problem(const VectorX& point)>;

    /// @param model       outlives this
    /// @param problem_of  an elastic solid
    /// @param densities   mass per volume of each patch at a point (ones for the volume); do not
    ///                    depend on the parameters
    /// @param grids       points where largest values are looked for
    MemberMeasures(const ReducedModel& model, ProblemOf problem_of, VectorX densities,
                   const std::vector<SampleGrid>& grids);

    [[nodiscard]] const ReducedModel& model() const { return model_; }

    struct At {
        Measure mass;
        std::optional<LimitedMeasure> von_mises;
        std::optional<LimitedMeasure> displacement;
    };
    /// @param columns    parameters that derivatives are wanted for; the others are 0
    /// @param sharpness  of the smooth maxima of multiples of the limits
    [[nodiscard]] At at(const VectorX& point, const MassLimits& limits,
                        const std::vector<int>& columns, double sharpness) const;

  private:
    [[nodiscard]] std::vector<std::optional<ProblemChange>> changes(
        const VectorX& point, const iga::Problem& problem, const std::vector<int>& columns) const;

    const ReducedModel& model_;
    ProblemOf problem_of_;
    VectorX densities_;
    MemberVolume volume_;
    GradientSampler sampler_;
};

struct MassOptions {
    int n_starts = 8;
    /// Of the starts after the first: a Latin hypercube.
    std::uint64_t seed = 1;
};

/// Where a search began and ended.
struct MassSearch {
    /// All parameters, units of the deck.
    VectorX start;
    VectorX point;
    double mass = 0.0;
    /// Largest values of what has a limit.
    std::optional<double> von_mises;
    std::optional<double> displacement;
    /// By how much of a limit the worst largest value is above it; at most `mass_tolerance` if
    /// the limits hold.
    double violation = 0.0;
    int n_evaluations = 0;
};

struct MassMinimum {
    /// In the order of the starts.
    std::vector<MassSearch> searches;
    /// The lightest within the limits; if no search ended within them that of the least violation.
    int best = 0;
    bool is_feasible = false;
};

/// Of the limits.
constexpr double mass_tolerance = 1e-6;

/// The lightest member in the box of the parameters whose largest values are within limits: local
/// searches from several starts, each with smooth maxima that come nearer to the largest values in
/// three steps and never fall below them. A search that leaves the limits violated goes to the
/// least violation, and from there on if that is none.
///
/// @param point    the first start; parameters that are not free stay there
/// @param free     positions of those that are, at least one
/// @throws InputError  without a limit or free parameters, for limits that are not positive, for
///                     fewer than one start
[[nodiscard]] MassMinimum minimize_mass(const MemberMeasures& measures, const VectorX& point,
                                        const std::vector<int>& free, const MassLimits& limits,
                                        const MassOptions& options = {});

}  // namespace couture::rom
