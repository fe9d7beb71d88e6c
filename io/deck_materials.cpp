#include <algorithm>
#include <array>
#include <cctype>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "io/deck_readers.h"

namespace couture::io {

namespace {

struct KnownMaterial {
    const char* part_of_name;
    /// Range of Young's modulus, Pa.
    double low;
    double high;
};
/// Handbook ranges, widened.
constexpr std::array<KnownMaterial, 8> known_materials = {{{"steel", 150e9, 250e9},
                                                           {"alumin", 55e9, 85e9},
                                                           {"titan", 80e9, 140e9},
                                                           {"copper", 100e9, 150e9},
                                                           {"brass", 80e9, 140e9},
                                                           {"magnesium", 35e9, 55e9},
                                                           {"concrete", 5e9, 70e9},
                                                           {"rubber", 1e5, 5e8}}};
/// Softer than gels, stiffer than diamond.
constexpr KnownMaterial any_material = {"", 1e3, 1.3e12};
/// Above this Poisson's ratio displacement elements of low degree lock.
constexpr double nearly_incompressible = 0.495;
/// Beyond this nothing solid expands, 1/K.
constexpr double large_expansion = 1e-3;

}  // namespace

void warn_implausible_modulus(const std::string& name, const std::string& what, double modulus,
                              const TomlPlace& place, const UnitSystem& units) {
    std::string lower = name;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    KnownMaterial range = any_material;
    for (const KnownMaterial& known : known_materials) {
        if (lower.find(known.part_of_name) != std::string::npos) {
            range = known;
        }
    }
    const double pascal = modulus * units.scale(dimensions::pressure);
    if (pascal < range.low || pascal > range.high) {
        log::warn(
            fmt::format("{}: {} = {:g} in units '{}' is {:g} GPa, which is implausible for "
                        "'{}' (expected {:g} to {:g} GPa); is the unit right?",
                        place.source, what, modulus, units.name(), pascal * 1e-9, name,
                        range.low * 1e-9, range.high * 1e-9));
    }
}

namespace {

void read_isotropic(Section& section, iga::Material& material) {
    section.require("youngs_modulus", "a pressure > 0");
    section.require("poissons_ratio", "a number in (-1, 0.5)");
    const auto E = section.number("youngs_modulus", dimensions::pressure, positive);
    const auto nu = section.number("poissons_ratio", dimensions::none,
                                   {.low = -1.0, .high = 0.5, .is_open = true});
    if (!E || !nu) {
        return;
    }
    material.stiffness = iga::isotropic_stiffness(*E, *nu);
    warn_implausible_modulus(material.name, "youngs_modulus", *E,
                             section.find("youngs_modulus")->place, section.context().units);
    if (*nu < 0.0 || *nu > nearly_incompressible) {
        log::warn(fmt::format("{}: poissons_ratio = {:g} of '{}' is {}",
                              section.find("poissons_ratio")->place.source, *nu, material.name,
                              *nu < 0.0 ? "negative: such materials are rare"
                                        : "nearly incompressible: elements of low degree lock"));
    }
}

void read_orthotropic(Section& section, iga::Material& material) {
    section.require("youngs_moduli", "three pressures E_1, E_2, E_3");
    section.require("poissons_ratios", "three numbers nu_23, nu_13, nu_12");
    section.require("shear_moduli", "three pressures G_23, G_13, G_12");
    const auto E = section.numbers("youngs_moduli", dimensions::pressure, {3}, positive);
    const auto nu = section.numbers("poissons_ratios", dimensions::none, {3});
    const auto G = section.numbers("shear_moduli", dimensions::pressure, {3}, positive);
    if (E.empty() || nu.empty() || G.empty()) {
        return;
    }
    try {
        material.stiffness = iga::orthotropic_stiffness(
            {{E[0], E[1], E[2]}, {nu[0], nu[1], nu[2]}, {G[0], G[1], G[2]}});
    } catch (const InputError& error) {
        section.mistake("", fmt::format("{}: {}", section.title(), error.what()));
    }
}

void read_expansion(Section& section, iga::Material& material) {
    const TomlNode* node = section.find("thermal_expansion");
    if (node == nullptr) {
        return;
    }
    if (node->kind == TomlNode::Kind::array) {
        material.thermal_expansion =
            section.vector("thermal_expansion", dimensions::expansion).value_or(Vector3::Zero());
    } else {
        material.thermal_expansion.setConstant(
            section.number("thermal_expansion", dimensions::expansion).value_or(0.0));
    }
    if (material.thermal_expansion.cwiseAbs().maxCoeff() > large_expansion) {
        log::warn(fmt::format("{}: thermal_expansion of '{}' is above {:g} per kelvin",
                              node->place.source, material.name, large_expansion));
    }
}

const std::vector<std::string> models = {"linear_elastic", "orthotropic", "neo_hookean",
                                         "neo_hookean_logarithmic", "saint_venant_kirchhoff"};

void read_elastic(Section& section, iga::Material& material) {
    const std::string model = section.choice("model", models).value_or("linear_elastic");
    if (model == "linear_elastic") {
        read_isotropic(section, material);
    } else if (model == "orthotropic") {
        read_orthotropic(section, material);
    } else {
        read_hyperelastic(section,
                          model == "neo_hookean" ? iga::StoredEnergy::neo_hookean
                          : model == "saint_venant_kirchhoff"
                              ? iga::StoredEnergy::saint_venant_kirchhoff
                              : iga::StoredEnergy::neo_hookean_logarithmic,
                          material);
        return;
    }
    read_expansion(section, material);
}

/// All materials are hyperelastic or none.
void check_mixture(Section& top, const iga::Problem& problem) {
    const auto is_hyperelastic = [](const iga::Material& material) {
        return material.hyperelastic.has_value();
    };
    const auto first =
        std::find_if(problem.materials.begin(), problem.materials.end(), is_hyperelastic);
    const auto linear =
        std::find_if_not(problem.materials.begin(), problem.materials.end(), is_hyperelastic);
    if (first == problem.materials.end() || linear == problem.materials.end()) {
        return;
    }
    top.context().mistakes.add(
        top.find("material")->find(linear->name)->place,
        fmt::format("[material.{}] is linear, [material.{}] hyperelastic; give all materials of a "
                    "deck a hyperelastic 'model', or none",
                    linear->name, first->name));
}

}  // namespace

void read_materials(Section& top, iga::Problem& problem) {
    const bool is_elasticity = problem.physics == iga::Physics::elasticity;
    for_each_named(top, "material", [&](const std::string& name, Section& section) {
        iga::Material material;
        material.name = name;
        material.patches = section.patches();
        if (is_elasticity) {
            read_elastic(section, material);
            material.density = section.number("density", dimensions::density, positive);
        } else {
            section.require("conductivity", "a number > 0");
            material.conductivity =
                section.number("conductivity", dimensions::conductivity, positive).value_or(1.0);
        }
        problem.materials.push_back(std::move(material));
    });
    check_mixture(top, problem);
    top.context().is_hyperelastic =
        !problem.materials.empty() && problem.materials.front().hyperelastic.has_value();
    if (problem.materials.empty() && top.find("material") == nullptr) {
        top.mistake("", fmt::format("the deck needs a material: a section [material.NAME] with {}",
                                    is_elasticity ? "'youngs_modulus' and 'poissons_ratio'"
                                                  : "'conductivity'"));
    }
}

}  // namespace couture::io
