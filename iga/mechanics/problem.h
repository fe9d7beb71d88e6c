#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "iga/core/function.h"
#include "iga/mechanics/elastic_constants.h"
#include "iga/mechanics/hyperelastic.h"

namespace couture::iga {

enum class Physics { elasticity, poisson };

/// How a plane problem stands for a solid. Axisymmetric: x is the radius, y the axis; integrals
/// go over the whole ring (2 pi r), so resultants and energies are those of the full body.
enum class Kinematics { solid, plane_strain, plane_stress, axisymmetric };

/// Patches that a material or a load holds for; empty: all.
using PatchList = std::vector<int>;

struct Material {
    std::string name;
    PatchList patches;
    /// Elasticity.
    ElasticStiffness stiffness = ElasticStiffness::Zero();
    /// Finite strain; nothing: linear elasticity with `stiffness`.
    std::optional<Hyperelastic> hyperelastic;
    /// Strain per degree along the axes.
    Vector3 thermal_expansion = Vector3::Zero();
    /// Mass per volume, force time^2 / length^4.
    std::optional<double> density;
    /// Poisson: flux = -conductivity * gradient.
    double conductivity = 1.0;
};

/// Common to conditions and loads.
struct Entry {
    /// Where it was written ("part.toml:14"), for messages; may be empty.
    std::string source;
};

/// A factor over time, linear between the times of a table and constant beyond its ends.
struct Amplitude {
    std::string name;
    /// Increasing, at least one.
    std::vector<double> times;
    /// As many.
    std::vector<double> values;

    [[nodiscard]] double operator()(double t) const;
};

/// What may belong to one load case.
struct CaseEntry : Entry {
    /// Empty: acts in every case.
    std::string load_case;
    /// Its values name t. Else, in a run over time, they grow linearly from 0 to what they are.
    bool follows_time = false;
    /// Multiplies the values instead of growing linearly.
    std::optional<Amplitude> amplitude;
};

/// Prescribed displacement on a named set; for Poisson the value is component 0.
struct Support : CaseEntry {
    std::string on;
    /// Nothing: free in that direction.
    std::array<std::optional<Function>, 3> components;
    /// Displacement along the outward normal; each side of the set must be plane (0: symmetry).
    std::optional<Function> normal;
};

/// Force per area in the axes' directions; for Poisson the inward flux is component 0. On a set of
/// edges: force per length.
struct Traction : CaseEntry {
    std::string on;
    std::array<Function, 3> components;
};

/// Force per area against the outward normal.
struct Pressure : CaseEntry {
    std::string on;
    Function value;
    /// At finite strain: acts on the deformed side, along its normal. Else on the undeformed one.
    bool follows_body = true;
};

/// Force per volume; for Poisson the source is component 0.
struct BodyForce : CaseEntry {
    PatchList patches;
    std::array<Function, 3> components;
};

/// A concentrated force at a point of the body, or at each corner of a named set of corners.
struct PointLoad : CaseEntry {
    std::string on;
    std::optional<Vector3> at;
    Vector3 force = Vector3::Zero();
};

enum class Spread {
    traction,       ///< uniform traction; a moment as the traction linear in position
    control_points  ///< equally on the control points
};

/// Total force and total moment about the set's centroid on a named set of sides.
struct Resultant : CaseEntry {
    std::string on;
    Vector3 force = Vector3::Zero();
    Vector3 moment = Vector3::Zero();
    Spread spread = Spread::traction;
};

/// Springs to the ground: traction = -stiffness * displacement, along the normal and in the axes'
/// directions, per area, in every load case.
struct Foundation : Entry {
    std::string on;
    std::optional<Function> normal;
    std::array<std::optional<Function>, 3> components;
};

/// Temperature above the strain-free state.
struct Temperature : CaseEntry {
    PatchList patches;
    Function change;
};

/// What is solved on a multipatch; independent of its discretisation.
struct Problem {
    Physics physics = Physics::elasticity;
    Kinematics kinematics = Kinematics::solid;
    /// Of plane strain and plane stress: all integrals are multiplied by it.
    double thickness = 1.0;
    std::vector<Material> materials;
    std::vector<Support> supports;
    std::vector<Foundation> foundations;
    std::vector<Traction> tractions;
    std::vector<Pressure> pressures;
    std::vector<BodyForce> body_forces;
    std::vector<PointLoad> point_loads;
    std::vector<Resultant> resultants;
    std::vector<Temperature> temperatures;
    /// Combination -> load case -> factor.
    std::map<std::string, std::map<std::string, double>> combinations;
    /// Names of the load cases in order of appearance; one unnamed case if none is named.
    [[nodiscard]] std::vector<std::string> load_cases() const;
};

/// The problem with the values that it has at time t of a run from 0 to `end`.
[[nodiscard]] Problem at_time(const Problem& problem, double t, double end);

/// An isotropic elastic material for all patches. @throws InputError  as `isotropic_stiffness`
[[nodiscard]] Material make_isotropic(const std::string& name, double youngs_modulus,
                                      double poissons_ratio);

/// Holds the components that are given at these values.
[[nodiscard]] Support make_support(const std::string& on, std::optional<double> x,
                                   std::optional<double> y, std::optional<double> z = {});

/// No displacement along the normal of a set of plane sides.
[[nodiscard]] Support make_symmetry(const std::string& on);

[[nodiscard]] Pressure make_pressure(const std::string& on, double value);

}  // namespace couture::iga
