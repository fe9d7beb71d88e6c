#include "iga/core/error.h"
#include "iga/core/log.h"
#include "io/deck_readers.h"

namespace couture::io {

namespace {

/// Above this Poisson's ratio displacement elements lock when the volumetric energy is integrated
/// in full.
constexpr double nearly_incompressible = 0.49;

struct Moduli {
    double shear = 0.0;
    double bulk = 0.0;
};

/// Shear and bulk modulus from either pair; nothing after a mistake.
std::optional<Moduli> read_moduli(Section& section) {
    const bool has_moduli = section.has("shear_modulus") || section.has("bulk_modulus");
    const bool has_engineering = section.has("youngs_modulus") || section.has("poissons_ratio");
    if (has_moduli == has_engineering) {
        section.mistake("", fmt::format("{} needs either 'shear_modulus' and 'bulk_modulus', or "
                                        "'youngs_modulus' and 'poissons_ratio'",
                                        section.title()));
        return {};
    }
    if (has_moduli) {
        section.require("shear_modulus", "a pressure > 0");
        section.require("bulk_modulus", "a pressure > 0");
        const auto mu = section.number("shear_modulus", dimensions::pressure, positive);
        const auto kappa = section.number("bulk_modulus", dimensions::pressure, positive);
        return mu && kappa ? std::optional<Moduli>({*mu, *kappa}) : std::nullopt;
    }
    section.require("youngs_modulus", "a pressure > 0");
    section.require("poissons_ratio", "a number in (-1, 0.5)");
    const auto E = section.number("youngs_modulus", dimensions::pressure, positive);
    const auto nu = section.number("poissons_ratio", dimensions::none,
                                   {.low = -1.0, .high = 0.5, .is_open = true});
    if (!E || !nu) {
        return {};
    }
    return Moduli{*E / (2.0 * (1.0 + *nu)), *E / (3.0 * (1.0 - 2.0 * *nu))};
}

}  // namespace

void read_hyperelastic(Section& section, iga::StoredEnergy energy, iga::Material& material) {
    // Also after a mistake: the deck's loads are read as those of a hyperelastic one.
    material.hyperelastic = iga::Hyperelastic{energy, 1.0, 1.0};
    if (section.has("thermal_expansion")) {
        section.mistake("thermal_expansion",
                        fmt::format("{}: hyperelastic materials have no thermal strain; leave "
                                    "'thermal_expansion' out",
                                    section.title()));
    }
    const std::optional<Moduli> moduli = read_moduli(section);
    if (!moduli) {
        return;
    }
    const auto [mu, kappa] = *moduli;
    try {
        material.hyperelastic = iga::make_hyperelastic(energy, mu, kappa);
    } catch (const InputError& error) {
        section.mistake("", fmt::format("{}: {}", section.title(), error.what()));
        return;
    }
    const double E = 9.0 * kappa * mu / (3.0 * kappa + mu);
    const double nu = (3.0 * kappa - 2.0 * mu) / (6.0 * kappa + 2.0 * mu);
    const bool is_engineering = section.has("youngs_modulus");
    const std::string key = is_engineering ? "youngs_modulus" : "shear_modulus";
    const TomlPlace& place = section.find(key)->place;
    warn_implausible_modulus(material.name,
                             is_engineering ? key : "Young's modulus from 'shear_modulus'", E,
                             place, section.context().units);
    if (nu < 0.0) {
        log::warn(
            fmt::format("{}: Poisson's ratio {:.4g} of '{}' is negative: such materials are rare",
                        place.source, nu, material.name));
    }
    if (nu > nearly_incompressible && section.context().is_integrated_in_full) {
        log::warn(
            fmt::format("{}: '{}' is nearly incompressible (Poisson's ratio {:.6g}) and "
                        "volumetric = 'full' locks; take 'automatic' or 'projected'",
                        place.source, material.name, nu));
    }
}

}  // namespace couture::io
