#include "iga/post/norms.h"

#include <cmath>

#include "iga/assembly/field_grid.h"
#include "iga/core/parallel.h"

namespace couture::iga {

template <int d>
ErrorNorms error_norms(const Field<d>& field, const ExactSolution<d>& exact,
                       std::optional<int> n_gauss_points) {
    const Space<d>& space = *field.space;
    std::vector<ErrorNorms> squares(space.n_patches());
    parallel_for(space.n_patches(), [&](int p) {
        const TensorSpace<d>& tensor = space.tensor(p);
        std::array<int, d> n;
        for (int k = 0; k < d; ++k) {
            n[k] = n_gauss_points.value_or(tensor.knots[k].degree() + 3);
        }
        const GeometryGrid<d> grid(space.geometry().patches[p], tensor, n);
        FieldGrid<d> values(field, p, grid);
        GeometryPlane<d> plane;
        ErrorNorms& sum = squares[p];
        for (int i = 0; i < grid.n_planes(); ++i) {
            grid.evaluate(i, plane);
            values.evaluate(i, plane);
            for (int q = 0; q < plane.n_points; ++q) {
                const Vector3 x(plane.x[3 * q], plane.x[3 * q + 1], plane.x[3 * q + 2]);
                const double weight = plane.quadrature_weight[q] * std::abs(plane.determinant[q]);
                const VectorX u = exact.value(x);
                const MatrixX grad_u = exact.gradient(x);
                sum.l2 += weight * (values.value(q) - u).squaredNorm();
                sum.h1 += weight * (values.gradient(q) - grad_u).squaredNorm();
                sum.l2_exact += weight * u.squaredNorm();
                sum.h1_exact += weight * grad_u.squaredNorm();
            }
        }
    });
    ErrorNorms total;
    for (const ErrorNorms& square : squares) {
        total.l2 += square.l2;
        total.h1 += square.h1;
        total.l2_exact += square.l2_exact;
        total.h1_exact += square.h1_exact;
    }
    return {std::sqrt(total.l2), std::sqrt(total.h1), std::sqrt(total.l2_exact),
            std::sqrt(total.h1_exact)};
}

template ErrorNorms error_norms(const Field<2>&, const ExactSolution<2>&, std::optional<int>);
template ErrorNorms error_norms(const Field<3>&, const ExactSolution<3>&, std::optional<int>);

}  // namespace couture::iga
