#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "iga/topology/dof_map.h"

namespace couture::iga {

/// A function of a multipatch by patch and number there, whatever part of it a process holds.
using FunctionKey = std::int64_t;

/// Which functions of different patches are one, without a table of all: what `make_dof_map`
/// joins, asked for one function at a time.
template <int d>
class JoinedFunctions {
  public:
    /// @param geometry  interfaces, and where it collapses
    /// @param spaces  of every patch; conforming across interfaces
    JoinedFunctions(const MultiPatch<d>& geometry, std::vector<TensorSpace<d>> spaces);

    [[nodiscard]] const TensorSpace<d>& tensor(int patch) const { return spaces_[patch]; }
    [[nodiscard]] int n_patches() const { return static_cast<int>(spaces_.size()); }
    /// The first, by patch and number, of all that are joined with function i of a patch. Keeps
    /// what it finds.
    [[nodiscard]] FunctionKey first(int patch, const std::array<int, d>& i);

    [[nodiscard]] FunctionKey key(int patch, const std::array<int, d>& i) const {
        return (static_cast<FunctionKey>(patch) << 32U) + spaces_[patch].index(i);
    }
    [[nodiscard]] static int patch_of(FunctionKey key) { return static_cast<int>(key >> 32U); }
    [[nodiscard]] static int function_of(FunctionKey key) {
        return static_cast<int>(key & 0xffffffff);
    }

  private:
    struct Place {
        int patch;
        std::array<int, d> i;
    };
    void collect_joined(const Place& place, std::vector<Place>& joined) const;

    std::vector<TensorSpace<d>> spaces_;
    /// [patch * sides + side]: the interface read from that side.
    std::vector<std::vector<Interface<d>>> interfaces_;
    std::vector<std::vector<CollapsedEntity<d>>> collapsed_;
    std::unordered_map<FunctionKey, FunctionKey> known_;
};

}  // namespace couture::iga
