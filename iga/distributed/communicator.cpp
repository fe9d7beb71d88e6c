#include "iga/distributed/communicator.h"

#include <fmt/core.h>
#include <petscsys.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <new>
#include <thread>

#include "iga/core/error.h"
#include "iga/linalg/petsc_session.h"

namespace couture::iga {

namespace {

enum class Kind : int { none, input, geometry, topology, solver, file, other };

Kind kind_of(const std::exception& error) {
    if (dynamic_cast<const InputError*>(&error) != nullptr) {
        return Kind::input;
    }
    if (dynamic_cast<const GeometryError*>(&error) != nullptr) {
        return Kind::geometry;
    }
    if (dynamic_cast<const TopologyError*>(&error) != nullptr) {
        return Kind::topology;
    }
    if (dynamic_cast<const SolverError*>(&error) != nullptr ||
        dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
        return Kind::solver;
    }
    return dynamic_cast<const FileError*>(&error) != nullptr ? Kind::file : Kind::other;
}

[[noreturn]] void throw_kind(Kind kind, const std::string& message) {
    switch (kind) {
        case Kind::input:
            throw InputError("{}", message);
        case Kind::geometry:
            throw GeometryError("{}", message);
        case Kind::topology:
            throw TopologyError("{}", message);
        case Kind::solver:
            throw SolverError("{}", message);
        case Kind::file:
            throw FileError("{}", message);
        default:
            throw std::runtime_error(message);
    }
}

int environment_number(const char* name) {
    const char* text = std::getenv(name);
    return text == nullptr ? 0 : std::atoi(text);
}

}  // namespace

bool is_distributed_run() {
    return environment_number("OMPI_COMM_WORLD_SIZE") > 1 || environment_number("PMI_SIZE") > 1;
}

int rank_of_run() {
    return std::max(environment_number("OMPI_COMM_WORLD_RANK"), environment_number("PMI_RANK"));
}

Communicator::Communicator() {
    start_petsc();
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

int Communicator::size_here() const {
    MPI_Comm here = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &here);
    int n = 1;
    MPI_Comm_size(here, &n);
    MPI_Comm_free(&here);
    return n;
}

MatrixX Communicator::sum(const MatrixX& values) const {
    MatrixX result(values.rows(), values.cols());
    MPI_Allreduce(values.data(), result.data(), static_cast<int>(values.size()), MPI_DOUBLE,
                  MPI_SUM, MPI_COMM_WORLD);
    return result;
}

namespace {

template <typename Number>
Number reduce(Number value, MPI_Datatype type, MPI_Op operation) {
    Number result{};
    MPI_Allreduce(&value, &result, 1, type, operation, MPI_COMM_WORLD);
    return result;
}

}  // namespace

double Communicator::sum(double value) const { return reduce(value, MPI_DOUBLE, MPI_SUM); }

std::int64_t Communicator::sum(std::int64_t value) const {
    return reduce(value, MPI_INT64_T, MPI_SUM);
}

double Communicator::max(double value) const { return reduce(value, MPI_DOUBLE, MPI_MAX); }

std::int64_t Communicator::sum_before(std::int64_t value) const {
    std::int64_t result = 0;
    MPI_Exscan(&value, &result, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    return rank_ == 0 ? 0 : result;
}

std::vector<double> Communicator::gather(double value) const {
    std::vector<double> result(size_);
    MPI_Allgather(&value, 1, MPI_DOUBLE, result.data(), 1, MPI_DOUBLE, MPI_COMM_WORLD);
    return result;
}

std::string Communicator::from(int rank, const std::string& text) const {
    auto length = static_cast<int>(text.size());
    MPI_Bcast(&length, 1, MPI_INT, rank, MPI_COMM_WORLD);
    std::string result = text;
    result.resize(length);
    MPI_Bcast(result.data(), length, MPI_CHAR, rank, MPI_COMM_WORLD);
    return result;
}

std::vector<std::vector<std::int64_t>> Communicator::exchange(
    const std::vector<std::vector<std::int64_t>>& to) const {
    std::vector<int> n_to(size_);
    std::vector<int> n_from(size_);
    for (int r = 0; r < size_; ++r) {
        n_to[r] = static_cast<int>(to[r].size());
    }
    MPI_Alltoall(n_to.data(), 1, MPI_INT, n_from.data(), 1, MPI_INT, MPI_COMM_WORLD);
    std::vector<std::vector<std::int64_t>> from(size_);
    std::vector<MPI_Request> requests;
    constexpr int tag = 17;
    for (int r = 0; r < size_; ++r) {
        from[r].resize(n_from[r]);
        if (n_from[r] > 0) {
            MPI_Irecv(from[r].data(), n_from[r], MPI_INT64_T, r, tag, MPI_COMM_WORLD,
                      &requests.emplace_back());
        }
    }
    for (int r = 0; r < size_; ++r) {
        if (n_to[r] > 0) {
            MPI_Isend(to[r].data(), n_to[r], MPI_INT64_T, r, tag, MPI_COMM_WORLD,
                      &requests.emplace_back());
        }
    }
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    return from;
}

void Communicator::together(const std::function<void()>& body) const {
    std::string message;
    Kind kind = Kind::none;
    try {
        body();
    } catch (const std::bad_alloc&) {
        kind = Kind::solver;
        message = "out of memory; take fewer elements, a lower degree or more ranks";
    } catch (const std::exception& error) {
        kind = kind_of(error);
        message = error.what();
    }
    const int mine = kind == Kind::none ? size_ : rank_;
    int first = size_;
    MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (first == size_) {
        return;
    }
    int code = static_cast<int>(kind);
    MPI_Bcast(&code, 1, MPI_INT, first, MPI_COMM_WORLD);
    throw_kind(static_cast<Kind>(code), from(first, message));
}

void Communicator::end_unless_all_failed(const std::string& message, int exit_code,
                                         double seconds) const {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    constexpr std::chrono::milliseconds pause(20);
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    int all_are_here = 0;
    while (true) {
        MPI_Test(&request, &all_are_here, MPI_STATUS_IGNORE);
        if (all_are_here != 0) {
            return;
        }
        if (std::chrono::steady_clock::now() > end) {
            fmt::print(stderr, "couture: rank {}: {}\n", rank_, message);
            MPI_Abort(MPI_COMM_WORLD, exit_code);
        }
        std::this_thread::sleep_for(pause);
    }
}

}  // namespace couture::iga
