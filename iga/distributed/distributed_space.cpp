#include "iga/distributed/distributed_space.h"

#include <petscsys.h>

#include <algorithm>
#include <limits>

#include "iga/core/error.h"

namespace couture::iga {

namespace {

/// Sends `to[r]` to and receives `from[r]` from each of the neighbours; sizes are known.
void swap_rows(const std::vector<int>& ranks, const std::vector<VectorX>& to,
               std::vector<VectorX>& from) {
    constexpr int tag = 18;
    std::vector<MPI_Request> requests(2 * ranks.size(), MPI_REQUEST_NULL);
    for (std::size_t r = 0; r < ranks.size(); ++r) {
        MPI_Irecv(from[r].data(), static_cast<int>(from[r].size()), MPI_DOUBLE, ranks[r], tag,
                  MPI_COMM_WORLD, &requests[2 * r]);
        MPI_Isend(to[r].data(), static_cast<int>(to[r].size()), MPI_DOUBLE, ranks[r], tag,
                  MPI_COMM_WORLD, &requests[2 * r + 1]);
    }
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

VectorX pick(const VectorX& rows, const std::vector<int>& which, int n) {
    VectorX result(static_cast<Eigen::Index>(which.size()) * n);
    for (std::size_t i = 0; i < which.size(); ++i) {
        result.segment(static_cast<Eigen::Index>(i) * n, n) =
            rows.segment(static_cast<Eigen::Index>(which[i]) * n, n);
    }
    return result;
}

/// Row i goes to row which[i]; the inverse of `pick`.
void place(const VectorX& rows, const std::vector<int>& which, int n, VectorX& result) {
    for (std::size_t i = 0; i < which.size(); ++i) {
        result.segment(static_cast<Eigen::Index>(which[i]) * n, n) =
            rows.segment(static_cast<Eigen::Index>(i) * n, n);
    }
}

}  // namespace

SharedNumbers::SharedNumbers(const Communicator& ranks, const std::vector<FunctionKey>& functions,
                             const std::vector<int>& owners) {
    const int n = static_cast<int>(functions.size());
    std::vector<std::vector<FunctionKey>> wanted(ranks.size());
    std::vector<std::vector<int>> wanted_local(ranks.size());
    std::vector<std::pair<FunctionKey, int>> own;
    for (int i = 0; i < n; ++i) {
        if (owners[i] == ranks.rank()) {
            own.emplace_back(functions[i], i);
        } else {
            wanted[owners[i]].push_back(functions[i]);
            wanted_local[owners[i]].push_back(i);
        }
    }
    std::sort(own.begin(), own.end());
    const std::int64_t n_all = ranks.sum(static_cast<std::int64_t>(own.size()));
    if (n_all > std::numeric_limits<int>::max() / 3) {
        throw SolverError(
            "{} functions are more than PETSc numbers with 32 bits for three components ({}); take "
            "fewer 'elements' in [discretization]",
            n_all, std::numeric_limits<int>::max() / 3);
    }
    n_global_ = static_cast<int>(n_all);
    first_owned_ = static_cast<int>(ranks.sum_before(static_cast<std::int64_t>(own.size())));
    numbers_.assign(n, -1);
    for (std::size_t i = 0; i < own.size(); ++i) {
        owned_.push_back(own[i].second);
        numbers_[own[i].second] = first_owned_ + static_cast<int>(i);
    }

    const std::vector<std::vector<FunctionKey>> asked = ranks.exchange(wanted);
    std::vector<std::vector<FunctionKey>> answers(ranks.size());
    std::vector<std::vector<int>> to(ranks.size());
    ranks.together([&] {
        for (int r = 0; r < ranks.size(); ++r) {
            for (const FunctionKey key : asked[r]) {
                const auto found = std::lower_bound(own.begin(), own.end(), std::pair(key, 0));
                if (found == own.end() || found->first != key) {
                    throw SolverError("rank {} does not have a function that it owns",
                                      ranks.rank());
                }
                to[r].push_back(static_cast<int>(found - own.begin()));
                answers[r].push_back(first_owned_ + to[r].back());
            }
        }
    });
    const std::vector<std::vector<FunctionKey>> found = ranks.exchange(answers);
    for (int r = 0; r < ranks.size(); ++r) {
        for (std::size_t i = 0; i < found[r].size(); ++i) {
            numbers_[wanted_local[r][i]] = static_cast<int>(found[r][i]);
        }
        if (!to[r].empty() || !wanted_local[r].empty()) {
            neighbours_.push_back({r, std::move(to[r]), std::move(wanted_local[r])});
        }
    }
    const VectorX times = spread(add(VectorX::Ones(n), 1), 1);
    for (int i = 0; i < n; ++i) {
        multiplicities_.push_back(static_cast<int>(std::lround(times[i])));
    }
}

VectorX SharedNumbers::add(const VectorX& local, int n) const {
    VectorX result = pick(local, owned_, n);
    const std::vector<VectorX> received =
        swap_with_neighbours(local, n, &Neighbour::from, &Neighbour::to);
    for (std::size_t r = 0; r < neighbours_.size(); ++r) {
        for (std::size_t i = 0; i < neighbours_[r].to.size(); ++i) {
            result.segment(static_cast<Eigen::Index>(neighbours_[r].to[i]) * n, n) +=
                received[r].segment(static_cast<Eigen::Index>(i) * n, n);
        }
    }
    return result;
}

VectorX SharedNumbers::spread(const VectorX& owned, int n) const {
    VectorX result(static_cast<Eigen::Index>(numbers_.size()) * n);
    place(owned, owned_, n, result);
    const std::vector<VectorX> received =
        swap_with_neighbours(owned, n, &Neighbour::to, &Neighbour::from);
    for (std::size_t r = 0; r < neighbours_.size(); ++r) {
        place(received[r], neighbours_[r].from, n, result);
    }
    return result;
}

std::vector<VectorX> SharedNumbers::swap_with_neighbours(
    const VectorX& rows, int n, std::vector<int> Neighbour::*sent,
    std::vector<int> Neighbour::*received) const {
    std::vector<int> ranks;
    std::vector<VectorX> to;
    std::vector<VectorX> from;
    for (const Neighbour& other : neighbours_) {
        ranks.push_back(other.rank);
        to.push_back(pick(rows, other.*sent, n));
        from.emplace_back(static_cast<Eigen::Index>((other.*received).size()) * n);
    }
    swap_rows(ranks, to, from);
    return from;
}

std::int64_t SharedNumbers::n_sent() const {
    std::int64_t n = 0;
    for (const Neighbour& other : neighbours_) {
        n += static_cast<std::int64_t>(other.to.size());
    }
    return n;
}

template <int d>
DistributedSpace<d> distribute(RefinedGeometry<d>& geometry, const Communicator& ranks) {
    std::vector<std::vector<ElementBox<d>>> parts;
    ranks.together([&] {
        std::vector<std::array<int, d>> n_elements;
        for (int p = 0; p < geometry.geometry().n_patches(); ++p) {
            n_elements.push_back(geometry.n_elements(p));
        }
        parts = partition<d>(
            n_elements, [&](const ElementBox<d>& box) { return geometry.middle(box); },
            ranks.size());
    });
    return distribute<d>(geometry, ranks, std::move(parts));
}

template <int d>
DistributedSpace<d> distribute(RefinedGeometry<d>& geometry, const Communicator& ranks,
                               std::vector<std::vector<ElementBox<d>>> parts, Functions functions) {
    PieceSpace<d> pieces;
    std::vector<int> owners;
    ranks.together([&] {
        pieces = geometry.make_space(parts[ranks.rank()], functions);
        // A function belongs to the rank of the element in the middle of its support.
        std::vector<std::vector<std::pair<int, ElementBox<d>>>> boxes(
            geometry.geometry().n_patches());
        for (std::size_t r = 0; r < parts.size(); ++r) {
            for (const ElementBox<d>& box : parts[r]) {
                boxes[box.patch].emplace_back(static_cast<int>(r), box);
            }
        }
        for (const FunctionKey function : pieces.functions) {
            const std::array<int, d> element = geometry.middle_element(function, functions);
            for (const auto& [rank, box] : boxes[JoinedFunctions<d>::patch_of(function)]) {
                if (box.contains(element)) {
                    owners.push_back(rank);
                }
            }
        }
    });
    SharedNumbers numbers(ranks, pieces.functions, owners);
    return {std::move(pieces), std::move(numbers), std::move(parts)};
}

template DistributedSpace<2> distribute(RefinedGeometry<2>&, const Communicator&);
template DistributedSpace<3> distribute(RefinedGeometry<3>&, const Communicator&);
template DistributedSpace<2> distribute(RefinedGeometry<2>&, const Communicator&,
                                        std::vector<std::vector<ElementBox<2>>>, Functions);
template DistributedSpace<3> distribute(RefinedGeometry<3>&, const Communicator&,
                                        std::vector<std::vector<ElementBox<3>>>, Functions);

}  // namespace couture::iga
