#include "iga/distributed/piece_space.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "iga/spline/refine.h"
#include "iga/topology/refined_spaces.h"

namespace couture::iga {

namespace {

/// Middle of each function's support, as number of an element.
std::vector<int> middle_elements(const KnotVector& knots) {
    std::vector<int> first(knots.n_basis(), knots.n_elements());
    std::vector<int> last(knots.n_basis(), 0);
    for (int e = 0; e < knots.n_elements(); ++e) {
        const int span = knots.span_of_element(e);
        for (int i = span - knots.degree(); i <= span; ++i) {
            first[i] = std::min(first[i], e);
            last[i] = std::max(last[i], e);
        }
    }
    for (int i = 0; i < knots.n_basis(); ++i) {
        first[i] = (first[i] + last[i]) / 2;
    }
    return first;
}

/// First function of the whole that does not vanish on a box.
template <int d>
std::array<int, d> first_function(const TensorSpace<d>& tensor, const ElementBox<d>& box) {
    std::array<int, d> first;
    for (int k = 0; k < d; ++k) {
        first[k] = tensor.knots[k].span_of_element(box.first[k]) - tensor.knots[k].degree();
    }
    return first;
}

template <int d>
TensorSpace<d> restricted(const TensorSpace<d>& tensor, const ElementBox<d>& box) {
    TensorSpace<d> result = tensor;
    for (int k = 0; k < d; ++k) {
        result.knots[k] = tensor.knots[k].restricted(box.first[k], box.end[k]);
    }
    return result;
}

}  // namespace

template <int d>
RefinedGeometry<d>::RefinedGeometry(MultiPatch<d> geometry, std::optional<int> degree,
                                    std::optional<std::array<int, d>> n_elements)
    : geometry_(std::move(geometry)) {
    std::vector<TensorSpace<d>> spaces = refined_spaces<d>(geometry_, degree, n_elements);
    std::vector<TensorSpace<d>> linear = spaces;
    for (int p = 0; p < geometry_.n_patches(); ++p) {
        refinements_.emplace_back();
        for (int k = 0; k < d; ++k) {
            KnotVector& knots = linear[p].knots[k];
            refinements_.back()[k] =
                prolongation_to(geometry_.patches[p].knots(k), knots).prolongation;
            std::vector<double> simple = knots.breakpoints();
            simple.insert(simple.begin(), knots.front());
            simple.push_back(knots.back());
            knots = KnotVector(1, std::move(simple));
        }
    }
    add_kind(std::move(spaces));
    add_kind(std::move(linear));
}

template <int d>
void RefinedGeometry<d>::add_kind(std::vector<TensorSpace<d>> spaces) {
    std::vector<std::array<std::vector<int>, d>> middles(spaces.size());
    for (std::size_t p = 0; p < spaces.size(); ++p) {
        for (int k = 0; k < d; ++k) {
            middles[p][k] = middle_elements(spaces[p].knots[k]);
        }
    }
    kinds_.push_back({JoinedFunctions<d>(geometry_, std::move(spaces)), std::move(middles)});
}

template <int d>
Vector3 RefinedGeometry<d>::middle(const ElementBox<d>& box) const {
    Vector<d> xi;
    for (int k = 0; k < d; ++k) {
        const std::vector<double>& breakpoints = tensor(box.patch).knots[k].breakpoints();
        xi[k] = 0.5 * (breakpoints[box.first[k]] + breakpoints[box.end[k]]);
    }
    Vector3 x = Vector3::Zero();
    const Patch<d>& patch = geometry_.patches[box.patch];
    x.head(patch.dimension()) = patch.point(xi);
    return x;
}

template <int d>
std::array<int, d> RefinedGeometry<d>::find_element(int patch, const Vector<d>& xi) const {
    std::array<int, d> element;
    for (int k = 0; k < d; ++k) {
        element[k] = tensor(patch).knots[k].find_element(xi[k]);
    }
    return element;
}

template <int d>
std::array<int, d> RefinedGeometry<d>::middle_element(FunctionKey function,
                                                      Functions functions) const {
    const int patch = JoinedFunctions<d>::patch_of(function);
    std::array<int, d> i =
        tensor(patch, functions).indices(JoinedFunctions<d>::function_of(function));
    for (int k = 0; k < d; ++k) {
        i[k] = kind(functions).middle_elements[patch][k][i[k]];
    }
    return i;
}

template <int d>
Patch<d> RefinedGeometry<d>::make_piece(const ElementBox<d>& box) const {
    const Patch<d>& patch = geometry_.patches[box.patch];
    TensorSpace<d> space = restricted(tensor(box.patch), box);
    const std::array<int, d> first = first_function(tensor(box.patch), box);
    std::array<SparseMatrix, d> rows;
    for (int k = 0; k < d; ++k) {
        rows[k] = refinements_[box.patch][k].middleRows(first[k], space.knots[k].n_basis());
    }
    return Patch<d>::from_homogeneous(
        std::move(space), apply_kronecker<d>(rows, patch.homogeneous()), patch.is_rational());
}

template <int d>
std::map<std::string, BoundarySet<d>> RefinedGeometry<d>::sets_on(
    const std::vector<ElementBox<d>>& boxes) const {
    std::map<std::string, BoundarySet<d>> sets;
    for (const auto& [name, entities] : geometry_.boundary_sets) {
        BoundarySet<d>& set = sets[name];
        for (const PatchEntity<d>& entity : entities) {
            const std::array<int, d> n = n_elements(entity.patch);
            for (std::size_t b = 0; b < boxes.size(); ++b) {
                bool lies_on = boxes[b].patch == entity.patch;
                for (int k = 0; k < d && lies_on; ++k) {
                    lies_on = entity.position[k] == End::free ||
                              (entity.position[k] == End::low ? boxes[b].first[k] == 0
                                                              : boxes[b].end[k] == n[k]);
                }
                if (lies_on) {
                    set.push_back({static_cast<int>(b), entity.position});
                }
            }
        }
    }
    return sets;
}

template <int d>
PieceSpace<d> RefinedGeometry<d>::make_space(std::vector<ElementBox<d>> boxes,
                                             Functions functions) {
    std::map<std::string, BoundarySet<d>> sets = sets_on(boxes);
    return make_space_with(std::move(boxes), std::move(sets), functions);
}

template <int d>
PieceSpace<d> RefinedGeometry<d>::make_layers(const std::set<std::string>& sets,
                                              Functions functions,
                                              const std::vector<FunctionKey>* near) {
    std::unordered_set<FunctionKey> wanted;
    if (near != nullptr) {
        wanted.insert(near->begin(), near->end());
    }
    JoinedFunctions<d>& joined = kinds_[static_cast<std::size_t>(functions)].joined;
    const auto is_wanted = [&](const PatchEntity<d>& entity) {
        const TensorSpace<d>& space = tensor(entity.patch, functions);
        const std::vector<int> on = functions_on<d>(space, entity.position);
        return near == nullptr || std::any_of(on.begin(), on.end(), [&](int function) {
                   return wanted.contains(joined.first(entity.patch, space.indices(function)));
               });
    };
    std::vector<ElementBox<d>> boxes;
    std::map<PatchEntity<d>, int> box_of;
    std::map<std::string, BoundarySet<d>> layers;
    for (const auto& [name, entities] : geometry_.boundary_sets) {
        BoundarySet<d>& layer = layers[name];
        if (!sets.contains(name)) {
            continue;
        }
        for (const PatchEntity<d>& entity : entities) {
            if (!is_wanted(entity)) {
                continue;
            }
            const auto [box, is_new] = box_of.try_emplace(entity, static_cast<int>(boxes.size()));
            if (is_new) {
                const std::array<int, d> n = n_elements(entity.patch);
                ElementBox<d>& beside = boxes.emplace_back(ElementBox<d>{entity.patch, {}, n});
                for (int k = 0; k < d; ++k) {
                    if (entity.position[k] == End::low) {
                        beside.end[k] = 1;
                    } else if (entity.position[k] == End::high) {
                        beside.first[k] = n[k] - 1;
                    }
                }
            }
            layer.push_back({box->second, entity.position});
        }
    }
    return make_space_with(std::move(boxes), std::move(layers), functions);
}

template <int d>
PieceSpace<d> RefinedGeometry<d>::make_space_with(std::vector<ElementBox<d>> boxes,
                                                  std::map<std::string, BoundarySet<d>> sets,
                                                  Functions functions) {
    PieceSpace<d> result;
    MultiPatch<d> pieces;
    pieces.boundary_sets = std::move(sets);
    std::vector<TensorSpace<d>> spaces;
    DofMap map;
    std::unordered_map<FunctionKey, int> numbers;
    JoinedFunctions<d>& joined = kinds_[static_cast<std::size_t>(functions)].joined;
    for (const ElementBox<d>& box : boxes) {
        pieces.patches.push_back(make_piece(box));
        const TensorSpace<d>& whole = tensor(box.patch, functions);
        const std::array<int, d> first = first_function(whole, box);
        const TensorSpace<d>& space = spaces.emplace_back(restricted(whole, box));
        std::vector<int>& dofs = map.global.emplace_back();
        dofs.reserve(space.n_basis());
        for (int function = 0; function < space.n_basis(); ++function) {
            std::array<int, d> i = space.indices(function);
            for (int k = 0; k < d; ++k) {
                i[k] += first[k];
            }
            const FunctionKey key = joined.first(box.patch, i);
            const auto [number, is_new] = numbers.try_emplace(key, map.n_dofs);
            if (is_new) {
                result.functions.push_back(key);
                ++map.n_dofs;
            }
            dofs.push_back(number->second);
        }
    }
    result.space =
        std::make_shared<const Space<d>>(std::move(pieces), std::move(spaces), std::move(map));
    result.boxes = std::move(boxes);
    return result;
}

namespace {

/// Rows: functions from `first` on; columns: functions of degree 1 on the same elements.
std::vector<std::array<std::pair<int, double>, 2>> linear_weights(const KnotVector& whole,
                                                                  int first_function, int n,
                                                                  int first_element,
                                                                  int end_element) {
    const std::vector<double> greville = whole.greville();
    const std::vector<double>& breakpoints = whole.breakpoints();
    std::vector<std::array<std::pair<int, double>, 2>> rows;
    for (int i = 0; i < n; ++i) {
        const double xi = greville[first_function + i];
        const int e = std::clamp(whole.find_element(xi), first_element, end_element - 1);
        const double t = (xi - breakpoints[e]) / (breakpoints[e + 1] - breakpoints[e]);
        rows.push_back(
            {std::pair(e - first_element, 1.0 - t), std::pair(e - first_element + 1, t)});
    }
    return rows;
}

}  // namespace

template <int d>
SparseMatrix prolongation_from_linear(const RefinedGeometry<d>& geometry,
                                      const PieceSpace<d>& refined, const PieceSpace<d>& linear) {
    std::vector<Eigen::Triplet<double>> entries;
    VectorX times = VectorX::Zero(refined.space->n_dofs());
    for (std::size_t b = 0; b < refined.boxes.size(); ++b) {
        const ElementBox<d>& box = refined.boxes[b];
        const auto piece = static_cast<int>(b);
        const TensorSpace<d>& fine = refined.space->tensor(piece);
        const TensorSpace<d>& coarse = linear.space->tensor(piece);
        const std::array<int, d> first = first_function(geometry.tensor(box.patch), box);
        std::array<std::vector<std::array<std::pair<int, double>, 2>>, d> rows;
        for (int k = 0; k < d; ++k) {
            rows[k] = linear_weights(geometry.tensor(box.patch).knots[k], first[k],
                                     fine.knots[k].n_basis(), box.first[k], box.end[k]);
        }
        for (int function = 0; function < fine.n_basis(); ++function) {
            const std::array<int, d> i = fine.indices(function);
            const int row = refined.space->dofs(piece)[function];
            times[row] += 1.0;
            for (int corner = 0; corner < (1 << d); ++corner) {
                double weight = 1.0;
                std::array<int, d> j;
                for (int k = 0; k < d; ++k) {
                    const auto& [column, share] = rows[k][i[k]][(corner >> k) & 1];
                    j[k] = column;
                    weight *= share;
                }
                if (weight != 0.0) {
                    entries.emplace_back(row, linear.space->dofs(piece)[coarse.index(j)], weight);
                }
            }
        }
    }
    SparseMatrix result(refined.space->n_dofs(), linear.space->n_dofs());
    result.setFromTriplets(entries.begin(), entries.end());
    return times.cwiseInverse().asDiagonal() * result;
}

template <int d>
Problem on_pieces(const Problem& problem, const std::vector<ElementBox<d>>& boxes) {
    Problem result = problem;
    const auto restrict_entries = [&](auto& entries) {
        std::erase_if(entries, [&](auto& entry) {
            if (entry.patches.empty()) {
                return false;
            }
            PatchList pieces;
            for (std::size_t b = 0; b < boxes.size(); ++b) {
                if (std::find(entry.patches.begin(), entry.patches.end(), boxes[b].patch) !=
                    entry.patches.end()) {
                    pieces.push_back(static_cast<int>(b));
                }
            }
            entry.patches = std::move(pieces);
            return entry.patches.empty();
        });
    };
    restrict_entries(result.materials);
    restrict_entries(result.body_forces);
    restrict_entries(result.temperatures);
    return result;
}

template SparseMatrix prolongation_from_linear(const RefinedGeometry<2>&, const PieceSpace<2>&,
                                               const PieceSpace<2>&);
template SparseMatrix prolongation_from_linear(const RefinedGeometry<3>&, const PieceSpace<3>&,
                                               const PieceSpace<3>&);
template class RefinedGeometry<2>;
template class RefinedGeometry<3>;
template Problem on_pieces<2>(const Problem&, const std::vector<ElementBox<2>>&);
template Problem on_pieces<3>(const Problem&, const std::vector<ElementBox<3>>&);

}  // namespace couture::iga
