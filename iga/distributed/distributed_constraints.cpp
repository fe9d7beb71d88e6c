#include "iga/distributed/distributed_constraints.h"

#include <unordered_map>

#include "iga/assembly/elasticity.h"
#include "iga/assembly/loads.h"

namespace couture::iga {

namespace {

/// Number of each of the pieces' functions among those of the layers, or -1.
template <int d>
std::vector<int> numbers_among(const PieceSpace<d>& pieces, const PieceSpace<d>& layers) {
    std::unordered_map<FunctionKey, int> number;
    for (std::size_t i = 0; i < layers.functions.size(); ++i) {
        number[layers.functions[i]] = static_cast<int>(i);
    }
    std::vector<int> result;
    for (const FunctionKey function : pieces.functions) {
        const auto found = number.find(function);
        result.push_back(found == number.end() ? -1 : found->second);
    }
    return result;
}

template <typename Entries>
void add_names(const Entries& entries, std::set<std::string>& names) {
    for (const auto& entry : entries) {
        names.insert(entry.on);
    }
}

}  // namespace

template <int d>
Constraints<d> constraints_on(RefinedGeometry<d>& geometry, const PieceSpace<d>& pieces,
                              const Problem& problem, const std::vector<std::string>& load_cases,
                              Functions functions) {
    std::set<std::string> names;
    add_names(problem.supports, names);
    for (const std::string& name : names) {
        (void)geometry.geometry().boundary_set(name);
    }
    const PieceSpace<d> layers = geometry.make_layers(names, functions, &pieces.functions);
    const Constraints<d> all = make_constraints(*layers.space, problem, load_cases);
    const int nc = all.n_components;
    const int n = pieces.space->n_dofs();
    Constraints<d> result;
    result.n_components = nc;
    result.is_fixed.assign(static_cast<std::size_t>(n) * nc, 0);
    result.support.assign(result.is_fixed.size(), -1);
    result.values = MatrixX::Zero(static_cast<Eigen::Index>(n) * nc, all.values.cols());
    const std::vector<int> number = numbers_among(pieces, layers);
    for (int i = 0; i < n; ++i) {
        if (number[i] < 0) {
            continue;
        }
        for (int a = 0; a < nc; ++a) {
            const int here = nc * i + a;
            const int there = nc * number[i] + a;
            result.is_fixed[here] = all.is_fixed[there];
            result.support[here] = all.support[there];
            result.values.row(here) = all.values.row(there);
        }
        if (const auto frame = all.frames.find(number[i]); frame != all.frames.end()) {
            result.frames[i] = frame->second;
        }
    }
    return result;
}

template <int d>
void require_held(const MultiPatch<d>& geometry, const Problem& problem) {
    const Space<d> space(geometry);
    require_held(space, problem, make_constraints(space, problem, problem.load_cases()),
                 assemble_foundations(space, problem));
}

template <int d>
MatrixX loads_on(RefinedGeometry<d>& geometry, const PieceSpace<d>& pieces,
                 const std::vector<char>& is_owner, const Problem& problem,
                 const Problem& on_pieces, const std::string& load_case,
                 std::optional<int> n_gauss_points) {
    Problem by_elements = on_pieces;
    by_elements.resultants.clear();
    by_elements.point_loads.clear();
    MatrixX f = assemble_loads(*pieces.space, by_elements, load_case, n_gauss_points);

    Problem concentrated;
    concentrated.physics = problem.physics;
    concentrated.kinematics = problem.kinematics;
    concentrated.thickness = problem.thickness;
    concentrated.resultants = problem.resultants;
    std::set<std::string> names;
    add_names(problem.resultants, names);
    for (const PointLoad& load : problem.point_loads) {
        if (!load.at) {
            concentrated.point_loads.push_back(load);
            names.insert(load.on);
            continue;
        }
        const Location<d> place = locate_load(geometry.geometry(), load);
        const std::array<int, d> element = geometry.find_element(place.patch, place.xi);
        for (std::size_t b = 0; b < pieces.boxes.size(); ++b) {
            if (acts_in(load, load_case) && pieces.boxes[b].patch == place.patch &&
                pieces.boxes[b].contains(element)) {
                add_force<d>(*pieces.space, {static_cast<int>(b), place.xi}, load.force, f);
            }
        }
    }
    if (names.empty()) {
        return f;
    }
    const PieceSpace<d> layers = geometry.make_layers(names);
    const MatrixX on_layers =
        assemble_loads(*layers.space, concentrated, load_case, n_gauss_points);
    const std::vector<int> number = numbers_among(pieces, layers);
    for (std::size_t i = 0; i < number.size(); ++i) {
        if (number[i] >= 0 && is_owner[i] != 0) {
            f.row(static_cast<Eigen::Index>(i)) += on_layers.row(number[i]);
        }
    }
    return f;
}

#define COUTURE_INSTANTIATE(d)                                                                     \
    template Constraints<d> constraints_on(RefinedGeometry<d>&, const PieceSpace<d>&,              \
                                           const Problem&, const std::vector<std::string>&,        \
                                           Functions);                                             \
    template void require_held(const MultiPatch<d>&, const Problem&);                              \
    template MatrixX loads_on(RefinedGeometry<d>&, const PieceSpace<d>&, const std::vector<char>&, \
                              const Problem&, const Problem&, const std::string&,                  \
                              std::optional<int>);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::iga
