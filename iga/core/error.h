#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace couture {

/// Base of everything that Couture throws. Messages read "who: what is wrong with its values; the
/// rule; where, or what to do next".
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;

    template <typename... Args>
    explicit Error(fmt::format_string<Args...> format, Args&&... args) requires(sizeof...(Args) > 0)
        : std::runtime_error(fmt::format(format, std::forward<Args>(args)...)) {}
};

/// The caller or the deck is wrong.
class InputError : public Error {
  public:
    using Error::Error;
};

/// A shape is wrong: a folded patch, a point outside.
class GeometryError : public Error {
  public:
    using Error::Error;
};

/// Combinatorics are wrong: interfaces that do not conform, a set that does not exist.
class TopologyError : public Error {
  public:
    using Error::Error;
};

/// A system could not be solved: singular, out of memory, no convergence.
class SolverError : public Error {
  public:
    using Error::Error;
};

/// A file is missing, malformed or cannot be written.
class FileError : public Error {
  public:
    using Error::Error;
};

}  // namespace couture
