#pragma once

#include "iga/distributed/communicator.h"
#include "iga/distributed/partition.h"
#include "iga/distributed/piece_space.h"

namespace couture::iga {

/// Functions that several ranks share: each is owned by one of them, whose numbers are consecutive.
/// Coefficients are either local, one row per function of the rank's pieces, or owned, one per
/// function that the rank owns.
class SharedNumbers {
  public:
    /// @param functions  of this rank's pieces
    /// @param owners  rank that owns each; it has the function too
    SharedNumbers(const Communicator& ranks, const std::vector<FunctionKey>& functions,
                  const std::vector<int>& owners);

    [[nodiscard]] int n_local() const { return static_cast<int>(numbers_.size()); }
    [[nodiscard]] int n_owned() const { return static_cast<int>(owned_.size()); }
    [[nodiscard]] int n_global() const { return n_global_; }
    [[nodiscard]] int first_owned() const { return first_owned_; }
    /// Number of each local function among all.
    [[nodiscard]] const std::vector<int>& numbers() const { return numbers_; }
    /// Local number of each owned function.
    [[nodiscard]] const std::vector<int>& owned() const { return owned_; }
    /// How many ranks have each local function.
    [[nodiscard]] const std::vector<int>& multiplicities() const { return multiplicities_; }

    /// Owned rows from the sum of all ranks' local ones. Collective, as the other.
    ///
    /// @param n  numbers per function, next to each other
    [[nodiscard]] VectorX add(const VectorX& local, int n) const;
    /// Local rows from the owned ones of all ranks.
    [[nodiscard]] VectorX spread(const VectorX& owned, int n) const;

    /// Rows that this rank sends to others in one `spread` and gets in one `add`.
    [[nodiscard]] std::int64_t n_sent() const;
    /// Ranks that it shares functions with.
    [[nodiscard]] int n_neighbours() const { return static_cast<int>(neighbours_.size()); }

  private:
    struct Neighbour {
        int rank;
        /// Owned rows that the other needs, local rows that it owns.
        std::vector<int> to;
        std::vector<int> from;
    };
    /// Sends each neighbour rows by one of its lists; what each sent, of the length of the other.
    [[nodiscard]] std::vector<VectorX> swap_with_neighbours(
        const VectorX& rows, int n, std::vector<int> Neighbour::*sent,
        std::vector<int> Neighbour::*received) const;

    int n_global_ = 0;
    int first_owned_ = 0;
    std::vector<int> numbers_;
    std::vector<int> owned_;
    std::vector<int> multiplicities_;
    std::vector<Neighbour> neighbours_;
};

/// A space whose elements are shared out to the ranks: this one's pieces, and how their functions
/// are numbered among all.
template <int d>
struct DistributedSpace {
    PieceSpace<d> pieces;
    SharedNumbers numbers;
    /// [rank]: its boxes.
    std::vector<std::vector<ElementBox<d>>> parts;
};

/// @throws InputError  if there are fewer elements than ranks
template <int d>
[[nodiscard]] DistributedSpace<d> distribute(RefinedGeometry<d>& geometry,
                                             const Communicator& ranks);
/// With the parts of another space on the same elements.
template <int d>
[[nodiscard]] DistributedSpace<d> distribute(RefinedGeometry<d>& geometry,
                                             const Communicator& ranks,
                                             std::vector<std::vector<ElementBox<d>>> parts,
                                             Functions functions = Functions::refined);

}  // namespace couture::iga
