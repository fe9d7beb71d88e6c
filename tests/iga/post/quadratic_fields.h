#pragma once

#include <memory>

#include "iga/topology/field.h"
#include "tests/iga/topology/test_patches.h"

namespace couture::iga {

/// Two unit boxes in a row along x, joined; degree 2 or more, equal elements.
template <int d>
MultiPatch<d> make_two_boxes(int degree, int n_elements) {
    MultiPatch<d> part;
    part.patches = {make_unit_box<d>(degree, n_elements),
                    make_unit_box<d>(degree, n_elements, Vector<d>::Unit(0))};
    part.interfaces = {{0, 1, 1, 0, SideMap<d>::identity()}};
    return part;
}

/// The field u_a = a_a + B_ak x_k + C_akl x_k x_l on such boxes, exactly: coefficients are polar
/// forms at the knots behind each function. `quadratic[a]` is symmetric.
///
/// Source: [PieglTiller97] Eq. (5.39) and below, for degree 2; products of directions multiply.
template <int d>
Field<d> make_quadratic_field(const SpacePtr<d>& space, const VectorX& value, const MatrixX& linear,
                              const std::vector<Matrix<d>>& quadratic) {
    Field<d> field{space, MatrixX::Zero(space->n_dofs(), value.size())};
    for (int p = 0; p < space->n_patches(); ++p) {
        const TensorSpace<d>& tensor = space->tensor(p);
        // The box is moved by whole units along x.
        const double offset = static_cast<double>(p);
        for (int i = 0; i < tensor.n_basis(); ++i) {
            const std::array<int, d> index = tensor.indices(i);
            Vector<d> x;
            Matrix<d> xx;
            Vector<d> square;
            for (int k = 0; k < d; ++k) {
                const KnotVector& knots = tensor.knots[k];
                const double shift = k == 0 ? offset : 0.0;
                const int n = knots.degree();
                double sum = 0.0;
                double pairs = 0.0;
                for (int j = 1; j <= n; ++j) {
                    const double t = shift + knots.knots()[index[k] + j];
                    pairs += t * sum;
                    sum += t;
                }
                x[k] = sum / n;
                square[k] = 2.0 * pairs / (n * (n - 1));
            }
            xx = x * x.transpose();
            xx.diagonal() = square;
            for (Eigen::Index a = 0; a < value.size(); ++a) {
                field.coefficients(space->dofs(p)[i], a) =
                    value[a] + linear.row(a).dot(x) + quadratic[a].cwiseProduct(xx).sum();
            }
        }
    }
    return field;
}

/// Fixed coefficients of such a field with `n_components` components.
template <int d>
struct QuadraticFunction {
    explicit QuadraticFunction(int n_components)
        : constant(n_components), linear(n_components, d), quadratic(n_components) {
        for (int a = 0; a < n_components; ++a) {
            constant[a] = 0.5 - 0.3 * a;
            for (int k = 0; k < d; ++k) {
                linear(a, k) = 0.2 * (a + 1) - 0.35 * k;
                for (int l = 0; l < d; ++l) {
                    quadratic[a](k, l) = 0.1 * (k + l + 1) - 0.25 * a;
                }
            }
        }
    }
    [[nodiscard]] VectorX value(const Vector3& x) const {
        VectorX result = constant + linear * x.head<d>();
        for (Eigen::Index a = 0; a < result.size(); ++a) {
            result[a] += x.head<d>().dot(quadratic[a] * x.head<d>());
        }
        return result;
    }
    [[nodiscard]] MatrixX gradient(const Vector3& x) const {
        MatrixX result = linear;
        for (Eigen::Index a = 0; a < result.rows(); ++a) {
            result.row(a) += 2.0 * (quadratic[a] * x.head<d>()).transpose();
        }
        return result;
    }
    [[nodiscard]] Field<d> field_on(const SpacePtr<d>& space) const {
        return make_quadratic_field<d>(space, constant, linear, quadratic);
    }

    VectorX constant;
    MatrixX linear;
    std::vector<Matrix<d>> quadratic;
};

}  // namespace couture::iga
