#include "drivers/rom_plan.h"

#include "rom/designs.h"
#include "rom/tensor_design.h"

namespace couture::drivers {

namespace {

MatrixX geometry_design(const io::RomSection& section, int n_parameters) {
    if (n_parameters == 0) return MatrixX::Zero(1, 0);
    switch (section.design) {
        case io::GeometryDesign::star:
            return rom::star_design(n_parameters, section.level);
        case io::GeometryDesign::full:
            return rom::full_design(n_parameters, section.n_samples);
        case io::GeometryDesign::random:
            return rom::random_design(n_parameters, section.n_samples, section.seed);
        case io::GeometryDesign::sobol:
            return rom::sobol_design(n_parameters, section.n_samples);
        case io::GeometryDesign::lhs:
            return rom::latin_hypercube_design(n_parameters, section.n_samples, section.seed);
        case io::GeometryDesign::smolyak:
            return rom::smolyak_design(n_parameters, section.level, rom::NestedRule::equidistant);
        case io::GeometryDesign::clenshaw_curtis:
            break;
    }
    return rom::smolyak_design(n_parameters, section.level, rom::NestedRule::clenshaw_curtis);
}

// All combinations of the levels of some parameters.
MatrixX level_design(const io::RomSection& section, const std::vector<int>& positions) {
    if (positions.empty()) return MatrixX::Zero(1, 0);
    rom::TensorDesign design;
    for (const int position : positions) {
        design.factors.push_back(rom::full_design(1, section.parameters[position].n_levels));
    }
    return design.points();
}

}  // namespace

VectorX RomPlan::point(int i_geometry, int i_load, int i_material) const {
    VectorX unit = VectorX::Constant(space.size(), 0.5);
    const auto fill = [&](const std::vector<int>& positions, const MatrixX& points, int row) {
        for (std::size_t k = 0; k < positions.size(); ++k) {
            unit[positions[k]] = points(row, static_cast<Eigen::Index>(k));
        }
    };
    fill(geometry, geometry_points, i_geometry);
    fill(load, load_points, i_load);
    fill(material, material_points, i_material);
    return space.from_unit(unit);
}

void RomPlan::add_geometries(const MatrixX& points) {
    MatrixX all(geometry_points.rows() + points.rows(), geometry_points.cols());
    all << geometry_points, points;
    geometry_points = std::move(all);
}

RomPlan make_rom_plan(const io::RomSection& section) {
    RomPlan plan{section.space(),
                 section.inputs(rom::ParameterGroup::geometry),
                 section.inputs(rom::ParameterGroup::load),
                 section.inputs(rom::ParameterGroup::material),
                 {},
                 {},
                 {}};
    plan.geometry_points = geometry_design(section, static_cast<int>(plan.geometry.size()));
    plan.load_points = level_design(section, plan.load);
    plan.material_points = level_design(section, plan.material);
    return plan;
}

RomPlan make_validation_plan(const io::RomSection& section, int n_points, std::uint64_t seed) {
    RomPlan plan{section.space(), {}, {}, {}, {}, {}, {}};
    for (int i = 0; i < plan.space.size(); ++i) plan.geometry.push_back(i);
    plan.geometry_points = rom::latin_hypercube_design(plan.space.size(), n_points, seed);
    plan.load_points = MatrixX::Zero(1, 0);
    plan.material_points = MatrixX::Zero(1, 0);
    return plan;
}

}  // namespace couture::drivers
