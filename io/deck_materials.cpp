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

void warn_implausible_modulus(const std::string& name, double modulus, const TomlPlace& place,
                              const UnitSystem& units) {
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
        log::warn(fmt::format(
            "{}: youngs_modulus = {:g} in units '{}' is {:g} GPa, which is implausible for "
            "'{}' (expected {:g} to {:g} GPa); is the unit right?",
            place.source, modulus, units.name(), pascal * 1e-9, name, range.low * 1e-9,
            range.high * 1e-9));
    }
}

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
    warn_implausible_modulus(material.name, *E, section.find("youngs_modulus")->place,
                             section.context().units);
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

}  // namespace

void read_materials(Section& top, iga::Problem& problem) {
    const bool is_elasticity = problem.physics == iga::Physics::elasticity;
    for_each_named(top, "material", [&](const std::string& name, Section& section) {
        iga::Material material;
        material.name = name;
        material.patches = section.patches();
        if (is_elasticity) {
            const std::string model = section.choice("model", {"linear_elastic", "orthotropic"})
                                          .value_or("linear_elastic");
            if (model == "orthotropic") {
                read_orthotropic(section, material);
            } else {
                read_isotropic(section, material);
            }
            read_expansion(section, material);
        } else {
            section.require("conductivity", "a number > 0");
            material.conductivity =
                section.number("conductivity", dimensions::conductivity, positive).value_or(1.0);
        }
        problem.materials.push_back(std::move(material));
    });
    if (problem.materials.empty() && top.find("material") == nullptr) {
        top.mistake("", fmt::format("the deck needs a material: a section [material.NAME] with {}",
                                    is_elasticity ? "'youngs_modulus' and 'poissons_ratio'"
                                                  : "'conductivity'"));
    }
}

}  // namespace couture::io
