#include "io/raw_splines.h"

#include "iga/core/error.h"

namespace couture::io {

iga::KnotVector make_knots(const std::string& where, int degree, std::vector<double> knots) {
    try {
        return {degree, std::move(knots)};
    } catch (const InputError& error) {
        throw FileError("{}: {}", where, error.what());
    }
}

template <int d>
long count_control_points(const std::string& where, const std::array<int, d>& n_basis) {
    long product = 1;
    for (const int n : n_basis) {
        product *= n;
        if (product > max_count) {
            throw FileError("{}: the patch has more than {} control points; expected at most that",
                            where, max_count);
        }
    }
    return product;
}

template <int d>
iga::Patch<d> make_patch(const std::string& where, iga::TensorSpace<d> space,
                         MatrixX control_points, VectorX weights) {
    try {
        return {std::move(space), std::move(control_points), std::move(weights)};
    } catch (const InputError& error) {
        throw FileError("{}: {}", where, error.what());
    }
}

template <int d>
iga::Interface<d> make_interface(const std::string& where, const iga::PatchEntity<d>& first,
                                 const iga::PatchEntity<d>& second,
                                 const std::array<int, d>& direction_map,
                                 const std::array<bool, d>& keeps_sense) {
    const int first_normal = iga::side_direction(first.side());
    const int second_normal = iga::side_direction(second.side());
    iga::Interface<d> result{first.patch, first.side(), second.patch, second.side(), {}};
    std::array<bool, d> is_taken{};
    for (int k = 0, i = 0; k < d; ++k) {
        const int target = direction_map[k];
        if (target < 0 || target >= d || is_taken[target] ||
            (k == first_normal) != (target == second_normal)) {
            throw FileError(
                "{}: interface of {} and {}: direction {} is sent to direction {}; expected a "
                "permutation that sends normal {} to normal {}",
                where, first.name(), second.name(), k, target, first_normal, second_normal);
        }
        is_taken[target] = true;
        if (k != first_normal) {
            result.map.axis[i] = target - (target > second_normal ? 1 : 0);
            result.map.reversed[i] = !keeps_sense[k];
            ++i;
        }
    }
    return result;
}

template <int d>
void expect_sides_only(const iga::MultiPatch<d>& multipatch, const std::string& format) {
    for (const auto& [name, set] : multipatch.boundary_sets) {
        for (const iga::PatchEntity<d>& entity : set) {
            if (!entity.is_side()) {
                throw InputError(
                    "write_splines: boundary set '{}' holds {}; {} knows sets of whole sides only; "
                    "write .h5 or yeti .inp, or drop the set",
                    name, entity.name(), format);
            }
        }
    }
}

#define COUTURE_INSTANTIATE(d)                                                                    \
    template long count_control_points<d>(const std::string&, const std::array<int, d>&);         \
    template iga::Patch<d> make_patch(const std::string&, iga::TensorSpace<d>, MatrixX, VectorX); \
    template iga::Interface<d> make_interface<d>(                                                 \
        const std::string&, const iga::PatchEntity<d>&, const iga::PatchEntity<d>&,               \
        const std::array<int, d>&, const std::array<bool, d>&);                                   \
    template void expect_sides_only(const iga::MultiPatch<d>&, const std::string&);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::io
