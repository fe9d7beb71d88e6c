#pragma once

#include <string>
#include <vector>

#include "io/spline_file.h"

namespace couture::io {

/// What the reader of a format hands over: as the file says it, indices in range, the geometry
/// not yet checked.
struct RawSplines {
    AnyMultiPatch multipatch;
    /// False: interfaces are to be found.
    bool lists_interfaces = false;
    std::vector<std::string> notes;
};

/// Numbers that a file holds at most of one kind; far above what fits the memory of today.
constexpr int max_count = 100'000'000;

/// The knot vector. @throws FileError  beginning with `where` if a rule is broken
[[nodiscard]] iga::KnotVector make_knots(const std::string& where, int degree,
                                         std::vector<double> knots);

/// Number of control points. @throws FileError  beginning with `where` if above max_count
template <int d>
[[nodiscard]] long count_control_points(const std::string& where,
                                        const std::array<int, d>& n_basis);

/// The patch. @throws FileError  beginning with `where` if a rule is broken
template <int d>
[[nodiscard]] iga::Patch<d> make_patch(const std::string& where, iga::TensorSpace<d> space,
                                       MatrixX control_points, VectorX weights);

/// The interface whose side map sends direction k of the first patch to direction
/// `direction_map[k]` of the second, backwards unless `keeps_sense[k]`. Normals are not looked at.
///
/// @throws FileError  beginning with `where` if the map does not send tangents to tangents
template <int d>
[[nodiscard]] iga::Interface<d> make_interface(const std::string& where,
                                               const iga::PatchEntity<d>& first,
                                               const iga::PatchEntity<d>& second,
                                               const std::array<int, d>& direction_map,
                                               const std::array<bool, d>& keeps_sense);

/// Sets hold sides only. @throws InputError  naming the set, its first other entity, and `format`
template <int d>
void expect_sides_only(const iga::MultiPatch<d>& multipatch, const std::string& format);

}  // namespace couture::io
