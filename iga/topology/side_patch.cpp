#include "iga/topology/side_patch.h"

#include <Eigen/LU>
#include <utility>

namespace couture::iga {

namespace {

template <int d, int e>
std::array<int, e> free_directions(const std::array<End, d>& position) {
    std::array<int, e> result{};
    int n = 0;
    for (int k = 0; k < d && n < e; ++k) {
        if (position[k] == End::free) {
            result[n++] = k;
        }
    }
    return result;
}

template <int d, int e, std::size_t... i>
TensorSpace<e> pick(const TensorSpace<d>& space, const std::array<int, e>& directions,
                    std::index_sequence<i...>) {
    return {{space.knots[directions[i]]...}};
}

}  // namespace

template <int d, int e>
TensorSpace<e> entity_space(const TensorSpace<d>& space, const std::array<End, d>& position) {
    return pick<d, e>(space, free_directions<d, e>(position), std::make_index_sequence<e>());
}

template <int d, int e>
Patch<e> entity_patch(const Patch<d>& patch, const std::array<End, d>& position) {
    const std::vector<int> functions = functions_on<d>(patch.space(), position);
    MatrixX points(functions.size(), patch.dimension());
    VectorX weights(patch.is_rational() ? functions.size() : 0);
    for (std::size_t i = 0; i < functions.size(); ++i) {
        points.row(i) = patch.control_points().row(functions[i]);
        if (patch.is_rational()) {
            weights[i] = patch.weights()[functions[i]];
        }
    }
    return {entity_space<d, e>(patch.space(), position), std::move(points), std::move(weights)};
}

template <int d, int e>
Vector<d> entity_parameter(const TensorSpace<d>& space, const std::array<End, d>& position,
                           const Vector<e>& xi) {
    Vector<d> result;
    int n = 0;
    for (int k = 0; k < d; ++k) {
        result[k] = position[k] == End::low    ? space.knots[k].front()
                    : position[k] == End::high ? space.knots[k].back()
                                               : xi[n++];
    }
    return result;
}

template <int d>
int orientation(const Patch<d>& patch) {
    // The middle of the middle element.
    Vector<d> xi;
    for (int k = 0; k < d; ++k) {
        const std::vector<double>& breakpoints = patch.knots(k).breakpoints();
        const std::size_t middle = (breakpoints.size() - 1) / 2;
        xi[k] =
            0.5 * (breakpoints[middle] + breakpoints[middle + (breakpoints.size() > 1 ? 1 : 0)]);
    }
    const Matrix<d> J = patch.jacobian(xi);
    return J.determinant() < 0.0 ? -1 : 1;
}

#define COUTURE_INSTANTIATE(d, e)                                                                 \
    template Patch<e> entity_patch<d, e>(const Patch<d>&, const std::array<End, d>&);             \
    template TensorSpace<e> entity_space<d, e>(const TensorSpace<d>&, const std::array<End, d>&); \
    template Vector<d> entity_parameter<d, e>(const TensorSpace<d>&, const std::array<End, d>&,   \
                                              const Vector<e>&);
COUTURE_INSTANTIATE(2, 1)
COUTURE_INSTANTIATE(3, 1)
COUTURE_INSTANTIATE(3, 2)
#undef COUTURE_INSTANTIATE
template int orientation(const Patch<2>&);
template int orientation(const Patch<3>&);

}  // namespace couture::iga
