#pragma once

#include <map>
#include <optional>
#include <set>

#include "iga/distributed/element_box.h"
#include "iga/distributed/joined_functions.h"
#include "iga/mechanics/problem.h"
#include "iga/topology/space.h"

namespace couture::iga {

/// A space on some boxes of elements only, with the functions that do not vanish there.
template <int d>
struct PieceSpace {
    /// Its patches are the boxes, its boundary sets the parts of the whole's that lie on them;
    /// without interfaces.
    SpacePtr<d> space;
    std::vector<ElementBox<d>> boxes;
    /// Of each function: the first of those that are joined with it.
    std::vector<FunctionKey> functions;
};

/// Which functions on the elements of a refined geometry.
enum class Functions {
    refined,  ///< those of the refinement
    linear    ///< of degree 1 on the same elements, for multigrid
};

/// A multipatch to be refined, of which pieces are made that together are `refine` of it: the
/// functions and the map of a piece are those of the whole, without the whole being made.
template <int d>
class RefinedGeometry {
  public:
    /// As `refine(MultiPatch)`.
    RefinedGeometry(MultiPatch<d> geometry, std::optional<int> degree,
                    std::optional<std::array<int, d>> n_elements);

    [[nodiscard]] const MultiPatch<d>& geometry() const { return geometry_; }
    [[nodiscard]] const TensorSpace<d>& tensor(int patch,
                                               Functions functions = Functions::refined) const {
        return kind(functions).joined.tensor(patch);
    }
    [[nodiscard]] std::array<int, d> n_elements(int patch) const {
        return tensor(patch).n_elements();
    }
    /// Point of the geometry in the middle of a box.
    [[nodiscard]] Vector3 middle(const ElementBox<d>& box) const;
    /// Element that contains a parameter.
    [[nodiscard]] std::array<int, d> find_element(int patch, const Vector<d>& xi) const;
    /// Element in the middle of a function's support.
    [[nodiscard]] std::array<int, d> middle_element(FunctionKey function,
                                                    Functions functions) const;

    /// @param boxes  disjoint
    [[nodiscard]] PieceSpace<d> make_space(std::vector<ElementBox<d>> boxes,
                                           Functions functions = Functions::refined);
    /// The elements beside each entity of some boundary sets, each entity whole on a box of its
    /// own; other sets are empty there.
    ///
    /// @param near  only entities on which one of these functions lies; null: all
    [[nodiscard]] PieceSpace<d> make_layers(const std::set<std::string>& sets,
                                            Functions functions = Functions::refined,
                                            const std::vector<FunctionKey>* near = nullptr);

  private:
    struct Kind {
        JoinedFunctions<d> joined;
        /// [patch][direction][function].
        std::vector<std::array<std::vector<int>, d>> middle_elements;
    };
    [[nodiscard]] const Kind& kind(Functions functions) const {
        return kinds_[static_cast<std::size_t>(functions)];
    }
    void add_kind(std::vector<TensorSpace<d>> spaces);
    [[nodiscard]] PieceSpace<d> make_space_with(std::vector<ElementBox<d>> boxes,
                                                std::map<std::string, BoundarySet<d>> sets,
                                                Functions functions);
    [[nodiscard]] Patch<d> make_piece(const ElementBox<d>& box) const;
    [[nodiscard]] std::map<std::string, BoundarySet<d>> sets_on(
        const std::vector<ElementBox<d>>& boxes) const;

    MultiPatch<d> geometry_;
    std::vector<Kind> kinds_;
    /// [patch][direction]: from the geometry's functions to the refined ones, by rows.
    std::vector<std::array<Eigen::SparseMatrix<double, Eigen::RowMajor>, d>> refinements_;
};

/// Functions of degree 1 on pieces to the pieces' refined ones: the value at the Greville point
/// (within the outermost elements of a piece continued). Functions that several boxes have get the
/// mean. `refined` and `linear` have the same boxes.
template <int d>
[[nodiscard]] SparseMatrix prolongation_from_linear(const RefinedGeometry<d>& geometry,
                                                    const PieceSpace<d>& refined,
                                                    const PieceSpace<d>& linear);

/// What a problem is on pieces: what holds for patches holds for their boxes.
template <int d>
[[nodiscard]] Problem on_pieces(const Problem& problem, const std::vector<ElementBox<d>>& boxes);

}  // namespace couture::iga
