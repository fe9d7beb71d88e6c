#include "drivers/rom_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "iga/core/error.h"
#include "io/did_you_mean.h"
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
        case io::GeometryDesign::list:
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

struct ListedMembers {
    std::vector<io::FamilyMember> members;
    // In the unit cube, n x parameters of the geometry.
    MatrixX points;
};

ListedMembers read_list(const std::filesystem::path& path, const rom::ParameterSpace& space,
                        const std::vector<int>& positions) {
    ListedMembers list{io::read_member_table(path), {}};
    const std::string name = path.filename().string();
    const auto n_parameters = static_cast<Eigen::Index>(positions.size());
    list.points.resize(static_cast<Eigen::Index>(list.members.size()), n_parameters);
    std::vector<std::string> names;
    for (const int position : positions) names.push_back(space.parameters()[position].name);
    const io::FamilyMember& first = list.members.front();
    for (const auto& [column, value] : first.parameters) {
        if (std::ranges::find(names, column) == names.end()) {
            const std::string help = io::did_you_mean(column, names);
            throw InputError(
                "{}: column '{}' is no [[rom.parameter]] of the geometry{} There are "
                "{}",
                name, column, help.empty() ? "." : help, io::quoted_list(names));
        }
    }
    for (Eigen::Index k = 0; k < n_parameters; ++k) {
        const rom::Parameter& parameter = space.parameters()[positions[k]];
        for (std::size_t i = 0; i < list.members.size(); ++i) {
            const auto found = list.members[i].parameters.find(parameter.name);
            if (found == list.members[i].parameters.end()) {
                throw InputError(
                    "{}: no column '{}'; [rom] needs one for each parameter of the "
                    "geometry",
                    name, parameter.name);
            }
            if (found->second < parameter.lower || found->second > parameter.upper) {
                throw InputError("{}: member '{}' has {} = {}, out of its range [{}, {}]", name,
                                 list.members[i].name, parameter.name, found->second,
                                 parameter.lower, parameter.upper);
            }
            list.points(static_cast<Eigen::Index>(i), k) =
                (found->second - parameter.lower) / (parameter.upper - parameter.lower);
        }
    }
    if (first.surface.empty() && first.volume.empty()) list.members.clear();
    return list;
}

}  // namespace

const io::FamilyMember* RomPlan::member_at(const VectorX& point) const {
    constexpr double rounding = 1e-9;
    const VectorX unit = space.to_unit(point);
    for (std::size_t i = 0; i < listed.size(); ++i) {
        double distance = 0.0;
        for (std::size_t k = 0; k < geometry.size(); ++k) {
            // Validation plans have other groups behind.
            if (space.parameters()[geometry[k]].group != rom::ParameterGroup::geometry) continue;
            distance = std::max(distance, std::abs(unit[geometry[k]] -
                                                   geometry_points(static_cast<Eigen::Index>(i),
                                                                   static_cast<Eigen::Index>(k))));
        }
        if (distance <= rounding) return &listed[i];
    }
    return nullptr;
}

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

std::string RomPlan::geometries_text() const {
    const std::string projected =
        n_projected > 0 ? fmt::format(" ({} projected)", n_projected) : "";
    return fmt::format("{} geometries{}", n_geometries(), projected);
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
                 {},
                 {},
                 0,
                 0,
                 {}};
    plan.reference = plan.space.centre();
    if (section.design == io::GeometryDesign::list) {
        ListedMembers list = read_list(section.members, plan.space, plan.geometry);
        plan.geometry_points = std::move(list.points);
        plan.listed = std::move(list.members);
        constexpr double middle = 0.5;
        Eigen::Index nearest = 0;
        (plan.geometry_points.array() - middle).matrix().rowwise().norm().minCoeff(&nearest);
        VectorX unit = VectorX::Constant(plan.space.size(), middle);
        unit(plan.geometry) = plan.geometry_points.row(nearest).transpose();
        plan.reference = plan.space.from_unit(unit);
    } else {
        plan.geometry_points = geometry_design(section, static_cast<int>(plan.geometry.size()));
    }
    if (!plan.geometry.empty() && plan.n_geometries() < 2) {
        throw InputError(
            "{}: the design has {} geometry; a model with {} parameters of the geometry needs 2 at "
            "least, and some for each of them to be of use",
            section.source, plan.n_geometries(), plan.geometry.size());
    }
    plan.first_projected = plan.n_geometries();
    if (section.n_projected > 0) {
        if (plan.geometry.empty()) {
            throw InputError(
                "{}: 'projected' adds geometries, but no parameter changes the geometry",
                section.source);
        }
        plan.n_projected = section.n_projected;
        // Where the design is the same sequence, it goes on.
        plan.add_geometries(rom::sobol_design(static_cast<int>(plan.geometry.size()),
                                              plan.first_projected + plan.n_projected)
                                .bottomRows(plan.n_projected));
    }
    plan.load_points = level_design(section, plan.load);
    plan.material_points = level_design(section, plan.material);
    return plan;
}

RomPlan make_validation_plan(const io::RomSection& section, int n_points, std::uint64_t seed) {
    RomPlan plan{section.space(), {}, {}, {}, {}, {}, {}, {}, 0, 0, {}};
    for (int i = 0; i < plan.space.size(); ++i) plan.geometry.push_back(i);
    plan.reference = make_rom_plan(section).reference;
    std::optional<ListedMembers> list;
    const std::vector<int> positions = section.inputs(rom::ParameterGroup::geometry);
    if (section.design == io::GeometryDesign::list) {
        if (section.validation.empty()) {
            throw InputError(
                "{}: members that are listed are compared with others that are: write 'validation' "
                "= a table like 'members'",
                section.source);
        }
        list = read_list(section.validation, plan.space, positions);
        n_points = static_cast<int>(list->points.rows());
    }
    plan.geometry_points = rom::latin_hypercube_design(plan.space.size(), n_points, seed);
    if (list) {
        plan.geometry_points(Eigen::all, positions) = list->points;
        plan.listed = std::move(list->members);
    }
    plan.load_points = MatrixX::Zero(1, 0);
    plan.material_points = MatrixX::Zero(1, 0);
    return plan;
}

}  // namespace couture::drivers
