#include "drivers/rom_export_content.h"

#include <algorithm>

#include "iga/mechanics/kinematics.h"

namespace couture::drivers {

namespace {

/// Largest number of cells per element and direction.
constexpr int most_cells = 4;

void set_grids(io::ExportContent& content, const iga::Space<3>& space, int most_points) {
    for (content.n_cells = most_cells;; --content.n_cells) {
        content.grids =
            rom::make_sample_grids(space, rom::SampleRegion::outer_sides, content.n_cells);
        int n_points = 0;
        for (const rom::SampleGrid& grid : content.grids) {
            n_points += grid.n_points();
        }
        if (content.n_cells == 1 || n_points <= most_points) return;
    }
}

struct IsotropicConstants {
    double youngs_modulus = 0.0;
    double poissons_ratio = 0.0;
};

/// Of a stiffness that is isotropic.
IsotropicConstants isotropic_constants(const iga::ElasticStiffness& C) {
    const double lambda = C(0, 1);
    const double mu = C(5, 5);
    return {mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu), lambda / (2.0 * (lambda + mu))};
}

/// The parameter that sets only this value of the deck.
std::optional<int> parameter_of(const io::RomSection& section, const std::string& key) {
    for (std::size_t i = 0; i < section.parameters.size(); ++i) {
        const std::vector<std::string>& keys = section.parameters[i].keys;
        if (std::find(keys.begin(), keys.end(), key) != keys.end()) {
            return static_cast<int>(i);
        }
    }
    return {};
}

io::ExportModulus modulus_of(double value, std::optional<int> i_parameter,
                             const VectorX& reference) {
    return {i_parameter ? value / reference[*i_parameter] : value, i_parameter};
}

io::ExportMaterial export_material(const iga::Material& material, const io::RomSection& section,
                                   const VectorX& reference) {
    const std::string prefix = "material." + material.name + ".";
    const auto E = parameter_of(section, prefix + "youngs_modulus");
    const auto nu = parameter_of(section, prefix + "poissons_ratio");
    const IsotropicConstants constants = isotropic_constants(material.stiffness);
    return {material.stiffness, E || nu, modulus_of(constants.youngs_modulus, E, reference),
            modulus_of(constants.poissons_ratio, nu, reference)};
}

iga::ElasticStiffness stiffness_at(const io::ExportMaterial& material, const VectorX& point) {
    if (!material.follows_parameters) return material.stiffness;
    const auto value = [&](const io::ExportModulus& one) {
        return one.i_parameter ? one.value * point[*one.i_parameter] : one.value;
    };
    return iga::isotropic_stiffness(value(material.youngs_modulus), value(material.poissons_ratio));
}

std::string why_no_stress(const iga::Problem& problem) {
    if (!problem.temperatures.empty()) {
        return "the deck has temperatures, whose strains are not computed";
    }
    for (const iga::Material& material : problem.materials) {
        if (material.hyperelastic) {
            return "material '" + material.name + "' is not linear elastic";
        }
    }
    return {};
}

/// Compares with the deck's own materials at corners of the box.
std::string why_other_stiffness(const TrainedModel& trained,
                                const std::vector<io::ExportMaterial>& materials) {
    constexpr double rounding = 1e-9;
    const rom::ParameterSpace& space = trained.model().parameters();
    for (const double part : {0.0, 0.37, 1.0}) {
        const VectorX point = space.from_unit(VectorX::Constant(space.size(), part));
        const iga::Problem problem = trained.deck_at(point).problem;
        for (std::size_t i = 0; i < materials.size(); ++i) {
            const iga::ElasticStiffness& expected = problem.materials[i].stiffness;
            if ((stiffness_at(materials[i], point) - expected).norm() >
                rounding * expected.norm()) {
                return "material '" + problem.materials[i].name +
                       "' depends on parameters that are not Young's modulus or Poisson's ratio of "
                       "an isotropic material";
            }
        }
    }
    return {};
}

/// All but the grids.
io::ExportContent content_of(const TrainedModel& trained) {
    const rom::ReducedModel& model = trained.model();
    const VectorX& reference = model.parts().reference_point;
    const io::Deck deck = trained.deck_at(reference);
    io::ExportContent content;
    content.title = deck.title.empty() ? trained.path().stem().string() : deck.title;
    const auto [length, force, pressure] = deck.units.unit_names();
    content.length_unit = length;
    content.stress_unit = pressure;
    content.no_stress = why_no_stress(deck.problem);
    if (!content.no_stress.empty()) return content;
    for (const iga::Material& material : deck.problem.materials) {
        content.materials.push_back(export_material(material, trained.section(), reference));
    }
    content.no_stress = why_other_stiffness(trained, content.materials);
    content.material_of_patch = iga::materials_of_patches(deck.problem, model.space()->n_patches());
    return content;
}

}  // namespace

io::ExportContent page_content(const TrainedModel& trained, int most_points) {
    io::ExportContent content = content_of(trained);
    set_grids(content, *trained.model().space(), most_points);
    return content;
}

io::ExportContent volume_content(const TrainedModel& trained) {
    io::ExportContent content = content_of(trained);
    content.grids = rom::make_sample_grids(*trained.model().space(), rom::SampleRegion::volume);
    return content;
}

}  // namespace couture::drivers
