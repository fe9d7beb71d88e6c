#include "drivers/rom_samples.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "drivers/deck_check.h"
#include "drivers/job_geometry.h"
#include "drivers/meshed_geometry.h"
#include "drivers/prepared_surface.h"
#include "iga/assembly/constraints.h"
#include "iga/assembly/loads.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/text_hash.h"
#include "iga/solve/linear_static.h"
#include "iga/solve/load_stepping.h"
#include "iga/solve/static_system.h"
#include "iga/topology/jacobian_certificate.h"
#include "io/atomic_file.h"
#include "io/pants_file.h"
#include "rom/galerkin.h"
#include "rom/member_geometry.h"

namespace couture::drivers {

namespace {

// Entries of a problem's loads of one kind, put into a case of their own.
template <typename Load>
void add_case(std::vector<Load>& all, const std::vector<Load>& more, const std::string& name) {
    for (const Load& load : more) {
        all.push_back(load);
        all.back().load_case = name;
    }
}

void add_loads(iga::Problem& all, const iga::Problem& more, const std::string& name) {
    add_case(all.tractions, more.tractions, name);
    add_case(all.pressures, more.pressures, name);
    add_case(all.body_forces, more.body_forces, name);
    add_case(all.point_loads, more.point_loads, name);
    add_case(all.resultants, more.resultants, name);
    add_case(all.temperatures, more.temperatures, name);
}

iga::Problem without_loads(iga::Problem problem) {
    problem.tractions.clear();
    problem.pressures.clear();
    problem.body_forces.clear();
    problem.point_loads.clear();
    problem.resultants.clear();
    problem.temperatures.clear();
    return problem;
}

iga::MultiPatch<3> as_volume(io::AnyMultiPatch geometry, const io::Deck& deck) {
    auto* volume = std::get_if<iga::MultiPatch<3>>(&geometry);
    if (volume == nullptr) {
        throw InputError("{}: {}", deck.geometry.source, rom_needs_volume);
    }
    return std::move(*volume);
}

void require_valid(const iga::MultiPatch<3>& geometry) {
    for (int p = 0; p < geometry.n_patches(); ++p) {
        const auto certificate = iga::certify(geometry.patches[p]);
        if (certificate.validity != iga::Validity::valid) {
            throw GeometryError("patch {} is {}; det J must be proven positive everywhere", p,
                                iga::to_string(certificate.validity));
        }
    }
}

// Proportional within rounding.
bool is_multiple(const MatrixX& a, double factor, const MatrixX& b) {
    constexpr double rounding = 1e-11;
    return (a - factor * b).norm() <= rounding * std::max(a.norm(), (factor * b).norm());
}

// @throws InputError  if no reduced model can be made of a deck
const io::RomSection& checked_section(const io::Deck& deck) {
    const std::string name = deck.path.filename().string();
    if (!deck.rom) {
        throw InputError(
            "{}: has no section [rom]; a reduced model needs one with its [[rom.parameter]]", name);
    }
    if (deck.problem.load_cases().size() > 1 || !deck.problem.combinations.empty()) {
        throw InputError(
            "{}: has {} load cases and {} combinations; a reduced model is of one: write a deck "
            "for "
            "each, or make the loads parameters",
            name, deck.problem.load_cases().size(), deck.problem.combinations.size());
    }
    if (deck.rom->n_projected > 0 && (deck.is_hyperelastic() || !moves(deck))) {
        throw InputError("{}: 'projected': {}", deck.rom->source,
                         deck.is_hyperelastic()
                             ? "solutions at finite strain are not projected; take more 'samples'"
                             : "the deck has no loads, nothing is solved; take more 'samples'");
    }
    return *deck.rom;
}

std::string describe_value(const rom::Parameter& parameter, double value) {
    return fmt::format("{} = {:.6g}{}{}", parameter.name, value, parameter.unit.empty() ? "" : " ",
                       parameter.unit);
}

}  // namespace

bool moves(const io::Deck& deck) {
    // Expressions are asked at a place where none of the usual ones vanishes.
    const Vector3 place(0.31, 0.73, 1.17);
    const auto is_displaced = [&](const iga::Support& support) {
        const auto is_not_zero = [&](const std::optional<Function>& value) {
            return value && (*value)(place, 1.0) != 0.0;
        };
        return is_not_zero(support.normal) ||
               std::any_of(support.components.begin(), support.components.end(), is_not_zero);
    };
    const iga::Problem& problem = deck.problem;
    const bool is_pushed = !problem.tractions.empty() || !problem.pressures.empty() ||
                           !problem.body_forces.empty() || !problem.point_loads.empty() ||
                           !problem.resultants.empty() || !problem.temperatures.empty();
    return is_pushed || std::any_of(problem.supports.begin(), problem.supports.end(), is_displaced);
}

std::string describe_point(const rom::ParameterSpace& space, const VectorX& point) {
    std::vector<std::string> values;
    for (int i = 0; i < space.size(); ++i) {
        values.push_back(describe_value(space.parameters()[i], point[i]));
    }
    return fmt::format("{}", fmt::join(values, ", "));
}

RomSamples::RomSamples(const std::filesystem::path& path, const std::vector<std::string>& overrides)
    : path_(path),
      overrides_(overrides),
      text_(io::read_text(path)),
      deck_(io::parse_deck(text_, path, overrides)),
      plan_(make_rom_plan(checked_section(deck_))),
      solver_(iga::make_linear_solver(deck_.solver)) {}

void RomSamples::take_added(const io::SnapshotStore& store) {
    plan_ = make_rom_plan(section());
    const MatrixX added = store.added_points(static_cast<int>(plan_.geometry.size()));
    n_added_ = static_cast<int>(added.rows());
    plan_.add_geometries(added);
}

std::string RomSamples::job() const {
    const auto hash_of = [](const std::filesystem::path& file) {
        return file.empty() ? std::string() : text_hash(io::read_text(file));
    };
    nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
    for (const io::RomParameter& one : deck_.rom->parameters) {
        parameters.push_back({{"name", one.parameter.name},
                              {"keys", one.keys},
                              {"unit", one.parameter.unit},
                              {"range", {one.parameter.lower, one.parameter.upper}},
                              {"factored", one.is_factored},
                              {"periodic", one.parameter.is_periodic}});
    }
    const auto rows = [](const MatrixX& points) {
        nlohmann::ordered_json list = nlohmann::ordered_json::array();
        for (Eigen::Index i = 0; i < points.rows(); ++i) {
            const VectorX row = points.row(i);
            list.push_back(std::vector<double>(row.begin(), row.end()));
        }
        return list;
    };
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    for (const io::FamilyMember& member : plan_.listed) {
        files.push_back(hash_of(member.surface.empty() ? member.volume : member.surface));
    }
    nlohmann::ordered_json job = {
        {"program", "couture " COUTURE_VERSION},
        {"model", text_hash(deck_.model_text)},
        {"geometry file", hash_of(deck_.geometry.file)},
        {"meshing deck", hash_of(deck_.geometry.mesh)},
        {"parameters", parameters},
        {"geometry points", rows(plan_.geometry_points.topRows(plan_.n_geometries() - n_added_))},
        {"load points", rows(plan_.load_points)},
        {"material points", rows(plan_.material_points)}};
    if (!files.empty()) job["members"] = files;
    return job.dump(1) + "\n";
}

io::Deck RomSamples::parsed_deck(const VectorX& point, std::vector<std::string> more) const {
    std::vector<std::string> all = overrides_;
    for (std::string& one : deck_.rom->overrides(point)) all.push_back(std::move(one));
    for (std::string& one : more) all.push_back(std::move(one));
    try {
        return io::parse_deck(text_, path_, all);
    } catch (const InputError& error) {
        throw InputError("{}: at {}: {}", path_.filename().string(),
                         describe_point(plan_.space, point), error.what());
    }
}

io::Deck RomSamples::deck_at(const VectorX& point) const { return parsed_deck(point, {}); }

io::Deck RomSamples::deck_of_member(const VectorX& point) const {
    if (plan_.listed.empty()) return deck_at(point);
    const io::FamilyMember* member = plan_.member_at(point);
    if (member == nullptr) {
        throw InputError("{}: no member of {} is at {}", section().source,
                         section().members.filename().string(), describe_point(plan_.space, point));
    }
    const bool is_surface = !member->surface.empty();
    const auto path = std::filesystem::absolute(is_surface ? member->surface : member->volume);
    return parsed_deck(point, {(is_surface ? "geometry.surface=" : "geometry.file=") +
                               nlohmann::json(path.string()).dump()});
}

iga::SpacePtr<3> RomSamples::make_reference(io::SnapshotStore& store) const {
    if (auto reference = store.reference()) {
        return std::make_shared<const iga::Space<3>>(std::move(*reference));
    }
    const io::Deck deck = deck_of_member(plan_.reference);
    iga::MultiPatch<3> geometry;
    if (deck.geometry.mesh.empty()) {
        geometry = as_volume(load_geometry(deck), deck);
    } else {
        MeshStages stages = mesh_geometry(deck);
        if (!stages.record) {
            throw InputError(
                "{}: its volume follows a layout of its own, which other members can't repeat; "
                "leave 'layout' out of {}",
                deck.geometry.source, deck.geometry.mesh.filename().string());
        }
        io::write_layout_record(store.record_file(), *stages.record, stages.solid->cuboids.record,
                                "reference of a reduced model");
        io::AnyMultiPatch volume = std::move(stages.solid->volume->volume);
        add_deck_sets(deck.geometry, volume);
        geometry = as_volume(std::move(volume), deck);
    }
    if (!is_geometry_only()) check_deck<3>(deck, geometry);
    auto space = make_space<3>(deck, geometry);
    require_valid(space->geometry());
    store.write_reference(space->geometry());
    return space;
}

iga::SpacePtr<3> RomSamples::make_member(const VectorX& point,
                                         const io::SnapshotStore& store) const {
    const io::Deck deck = deck_of_member(point);
    iga::MultiPatch<3> geometry;
    if (deck.geometry.mesh.empty()) {
        geometry = as_volume(load_geometry(deck), deck);
    } else {
        io::AnyMultiPatch volume =
            std::move(mesh_geometry(deck, store.record_file()).solid->volume->volume);
        add_deck_sets(deck.geometry, volume);
        geometry = as_volume(std::move(volume), deck);
    }
    auto space = make_space<3>(deck, geometry);
    require_valid(space->geometry());
    return space;
}

std::vector<iga::Problem> RomSamples::linear_problems(const std::vector<VectorX>& points) const {
    std::vector<iga::Problem> problems;
    for (const VectorX& point : points) problems.push_back(deck_at(point).problem);
    const bool moves_supports = std::any_of(
        deck_.rom->parameters.begin(), deck_.rom->parameters.end(), [](const auto& parameter) {
            return !parameter.keys.empty() && parameter.keys.front().starts_with("displacement.");
        });
    if (moves_supports || problems.size() == 1) return problems;
    iga::Problem all = without_loads(problems.front());
    for (std::size_t l = 0; l < problems.size(); ++l) {
        add_loads(all, problems[l], fmt::format("load {}", l));
    }
    return {all};
}

MatrixX RomSamples::solve(const iga::SpacePtr<3>& member, const std::vector<VectorX>& points) {
    MatrixX result(3L * member->n_dofs(), static_cast<Eigen::Index>(points.size()));
    if (is_geometry_only()) return MatrixX::Zero(result.rows(), result.cols());
    if (!deck_.is_hyperelastic()) {
        Eigen::Index column = 0;
        for (const iga::Problem& problem : linear_problems(points)) {
            const MatrixX some = solve_linear(member, problem);
            result.middleCols(column, some.cols()) = some;
            column += some.cols();
        }
        return result;
    }
    for (std::size_t l = 0; l < points.size(); ++l) {
        const io::Deck deck = deck_at(points[l]);
        MatrixX displacement;
        const auto report = iga::follow_loads<3>(
            iga::make_start<3>(member), deck.problem, deck.stepping,
            [&](const iga::AcceptedStep<3>& step) { displacement = step.state.displacement; });
        if (!report.finished) {
            throw SolverError("the run stopped at t = {:.6g} of {:.6g}: {}", report.t,
                              deck.stepping.end, report.reason);
        }
        result.col(static_cast<Eigen::Index>(l)) = iga::flatten(displacement);
    }
    return result;
}

MatrixX RomSamples::solve_linear(const iga::SpacePtr<3>& member, const iga::Problem& problem) {
    iga::LinearStaticOptions options;
    options.solver = deck_.solver;
    options.n_gauss_points = deck_.discretization.n_gauss_points;
    options.reused_solver = solver_.get();
    const auto result = iga::solve_linear_static<3>(member, problem, options);
    MatrixX displacements(3L * member->n_dofs(), static_cast<Eigen::Index>(result.cases.size()));
    for (std::size_t l = 0; l < result.cases.size(); ++l) {
        displacements.col(static_cast<Eigen::Index>(l)) =
            iga::flatten(result.cases[l].displacement.coefficients);
    }
    return displacements;
}

MatrixX RomSamples::project(const iga::SpacePtr<3>& member, const std::vector<VectorX>& points,
                            const MatrixX& fields) const {
    MatrixX result(3L * member->n_dofs(), static_cast<Eigen::Index>(points.size()));
    Eigen::Index column = 0;
    for (const iga::Problem& problem : linear_problems(points)) {
        const MatrixX some = rom::projected_displacements(*member, fields, problem,
                                                          deck_.discretization.n_gauss_points);
        result.middleCols(column, some.cols()) = some;
        column += some.cols();
    }
    return result;
}

void RomSamples::check_factored(const iga::SpacePtr<3>& reference) const {
    const VectorX centre = plan_.space.centre();
    const auto& points = deck_.discretization.n_gauss_points;
    const auto loads_of = [&](const iga::Problem& problem) {
        return iga::assemble_loads<3>(*reference, problem, problem.load_cases().front(), points);
    };
    const auto foundations_of = [&](const iga::Problem& problem) {
        return MatrixX(VectorX(iga::assemble_foundations<3>(*reference, problem, points) *
                               VectorX::Ones(3L * reference->n_dofs())));
    };
    for (int i = 0; i < plan_.space.size(); ++i) {
        const io::RomParameter& parameter = deck_.rom->parameters[i];
        if (!parameter.is_factored) continue;
        const auto refuse = [&](const std::string& why) {
            throw InputError("{}: '{}' can't be factored: {}; leave 'factored' out",
                             parameter.source, parameter.parameter.name, why);
        };
        if (deck_.is_hyperelastic()) refuse("the materials are hyperelastic");
        const bool is_load = parameter.parameter.group == rom::ParameterGroup::load;
        const iga::Problem middle = deck_at(centre).problem;
        const auto constraints = iga::make_constraints<3>(*reference, middle, middle.load_cases());
        if (!constraints.values.isZero(0.0)) refuse("supports are displaced");
        if (!middle.temperatures.empty()) refuse("there are thermal strains");
        for (const double end : {0.0, 1.0}) {
            VectorX point = centre;
            point[i] = end == 0.0 ? parameter.parameter.lower : parameter.parameter.upper;
            const iga::Problem problem = deck_at(point).problem;
            const double ratio = point[i] / centre[i];
            if (!is_multiple(loads_of(problem), is_load ? ratio : 1.0, loads_of(middle))) {
                refuse(is_load ? "not all loads are proportional to it" : "loads depend on it");
            }
            const double stiffness_ratio = is_load ? 1.0 : ratio;
            if (!is_multiple(foundations_of(problem), stiffness_ratio, foundations_of(middle))) {
                refuse("foundations are not proportional to it");
            }
            for (std::size_t m = 0; m < problem.materials.size(); ++m) {
                if (!is_multiple(problem.materials[m].stiffness, stiffness_ratio,
                                 middle.materials[m].stiffness)) {
                    refuse(fmt::format("the stiffness of material '{}' is not proportional to it",
                                       problem.materials[m].name));
                }
            }
        }
    }
}

void RomSamples::check_periodic(const iga::SpacePtr<3>& reference) const {
    if (!deck_.geometry.mesh.empty() || !plan_.listed.empty()) return;
    for (int i = 0; i < plan_.space.size(); ++i) {
        const rom::Parameter& one = plan_.space.parameters()[i];
        if (!one.is_periodic) continue;
        const auto field_at = [&](double value) {
            VectorX point = plan_.space.centre();
            point[i] = value;
            const io::Deck deck = deck_at(point);
            return rom::to_field(
                *reference, make_space<3>(deck, as_volume(load_geometry(deck), deck))->geometry());
        };
        const double difference = (field_at(one.lower) - field_at(one.upper)).cwiseAbs().maxCoeff();
        constexpr double rounding = 1e-6;
        if (difference > rounding * reference->geometry().size()) {
            throw InputError(
                "{}: '{}' is periodic, but control points at {} and {} differ by up to {:.3g}; "
                "give one whole period as range, or leave 'periodic' out",
                deck_.rom->parameters[i].source, one.name, one.lower, one.upper, difference);
        }
    }
}

void RomSamples::check_ends() const {
    const auto make = [&](const VectorX& point) {
        const io::Deck deck = deck_of_member(point);
        if (deck.geometry.mesh.empty()) {
            require_valid(as_volume(load_geometry(deck), deck));
        } else {
            static_cast<void>(prepare_surface(member_mesh_deck(deck), {}));
        }
    };
    if (!plan_.listed.empty()) return;
    make(plan_.reference);
    for (const int i : plan_.geometry) {
        const rom::Parameter& one = plan_.space.parameters()[i];
        for (const double end : {one.lower, one.upper}) {
            VectorX point = plan_.reference;
            point[i] = end;
            try {
                make(point);
            } catch (const Error& error) {
                log::warn(fmt::format("rom: there is no member at {}, all others in the middle: {}",
                                      describe_value(one, end), error.what()));
            }
        }
    }
}

}  // namespace couture::drivers
