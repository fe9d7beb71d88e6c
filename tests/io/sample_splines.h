#pragma once

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include "io/spline_file.h"

namespace couture::test {

/// Numbers that no short decimal hits.
inline double odd(double x) { return x + 1e-3 * std::sin(37.0 * x + 1.0); }

/// A patch of the box [0, 1]^d shifted by `shift` along x, degrees 2, 1, (3), with odd coordinates.
template <int d>
iga::Patch<d> make_bent_box(double shift, bool is_rational) {
    const auto space = [] {
        if constexpr (d == 2) {
            return iga::TensorSpace<2>{{iga::KnotVector(2, {0, 0, 0, 1.0 / 3.0, 1, 1, 1}),
                                        iga::KnotVector::uniform(1, 2)}};
        } else {
            return iga::TensorSpace<3>{{iga::KnotVector(2, {0, 0, 0, 1.0 / 3.0, 1, 1, 1}),
                                        iga::KnotVector::uniform(1, 2),
                                        iga::KnotVector::uniform(3, 1)}};
        }
    }();
    MatrixX points(space.n_basis(), d);
    VectorX weights(space.n_basis());
    for (int i = 0; i < space.n_basis(); ++i) {
        const auto index = space.indices(i);
        double y = 0.0;
        for (int k = d - 1; k >= 0; --k) {
            points(i, k) = odd(space.knots[k].greville()[index[k]] + (k == 0 ? shift : 0.0));
            y = 3.0 * y + points(i, k) * (k == 0 ? 0.0 : 1.0);
        }
        weights[i] = 1.0 + 0.1 * std::sin(5.0 * y);
    }
    return {space, points, is_rational ? weights : VectorX{}};
}

/// Two such boxes that meet at x = 1: the second one seen through the side map `i_map`, entered by
/// its side `second_side`. Its control points on the interface are those of the first.
template <int d>
iga::MultiPatch<d> make_pair(std::size_t i_map, int second_side, bool is_rational) {
    const iga::Patch<d> first = make_bent_box<d>(0.0, is_rational);
    const iga::Patch<d> straight = make_bent_box<d>(1.0, is_rational);
    const iga::SideMap<d> map = iga::all_side_maps<d>()[i_map];
    // Direction k of the straight box is direction to[k] of the second patch, backwards if flip[k].
    const int normal = iga::side_direction(second_side);
    std::array<int, d> to{};
    std::array<bool, d> flip{};
    to[0] = normal;
    flip[0] = iga::side_is_high(second_side);
    for (int i = 0; i < d - 1; ++i) {
        to[i + 1] = map.axis[i] + (map.axis[i] >= normal ? 1 : 0);
        flip[i + 1] = map.reversed[i];
    }
    std::vector<iga::KnotVector> knots(d, straight.knots(0));
    for (int k = 0; k < d; ++k) {
        knots[to[k]] = flip[k] ? straight.knots(k).reversed() : straight.knots(k);
    }
    const iga::TensorSpace<d> space = [&] {
        if constexpr (d == 2) {
            return iga::TensorSpace<2>{{knots[0], knots[1]}};
        } else {
            return iga::TensorSpace<3>{{knots[0], knots[1], knots[2]}};
        }
    }();
    MatrixX points(space.n_basis(), d);
    VectorX weights(is_rational ? space.n_basis() : 0);
    for (int i = 0; i < space.n_basis(); ++i) {
        const auto index = straight.space().indices(i);
        std::array<int, d> there{};
        for (int k = 0; k < d; ++k) {
            there[to[k]] = flip[k] ? straight.knots(k).n_basis() - 1 - index[k] : index[k];
        }
        const int j = space.index(there);
        points.row(j) = straight.control_points().row(i);
        if (is_rational) {
            weights[j] = straight.weights()[i];
        }
    }
    iga::MultiPatch<d> result;
    result.patches = {first, iga::Patch<d>(space, points, weights)};
    result.interfaces = {{0, 1, 1, second_side, map}};
    result.boundary_sets["boundary_3"] = {iga::make_side<d>(0, 0)};
    result.boundary_sets["clamped"] = {iga::make_side<d>(0, 2),
                                       iga::make_side<d>(1, second_side ^ 1)};
    return result;
}

/// A folder of its own for files of tests, removed at the end.
class TemporaryFolder {
  public:
    TemporaryFolder()
        : path_(std::filesystem::temp_directory_path() /
                ("couture_io_" + std::to_string(::getpid()) + "_" +
                 std::to_string(reinterpret_cast<std::uintptr_t>(this)))) {
        std::filesystem::create_directories(path_);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code code;
        std::filesystem::remove_all(path_, code);
    }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

}  // namespace couture::test
