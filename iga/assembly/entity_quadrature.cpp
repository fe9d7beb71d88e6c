#include "iga/assembly/entity_quadrature.h"

#include <Eigen/Geometry>

#include "iga/core/error.h"
#include "iga/spline/gauss.h"
#include "iga/topology/side_patch.h"

namespace couture::iga {

namespace {

template <int d, int e>
void visit(const Space<d>& space, const PatchEntity<d>& entity, std::optional<int> n_gauss_points,
           const std::function<void(const EntityPoint<d>&)>& body) {
    const Patch<d>& patch = space.geometry().patches[entity.patch];
    if (patch.dimension() != d) {
        throw GeometryError(
            "patch {} has {} parameters but {} coordinates; integrals need equal "
            "numbers",
            entity.patch, d, patch.dimension());
    }
    const Patch<e> map = entity_patch<d, e>(patch, entity.position);
    const TensorSpace<e> functions =
        entity_space<d, e>(space.tensor(entity.patch), entity.position);
    const std::vector<int> on = functions_on<d>(space.tensor(entity.patch), entity.position);
    const VectorX& all_weights = space.weights(entity.patch);
    VectorX weights(all_weights.size() > 0 ? on.size() : 0);
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
        weights[i] = all_weights[on[i]];
    }
    const double sign = entity.is_side() ? outward_sign(entity.side()) * orientation(patch) : 0.0;

    std::array<int, e> n_points;
    std::array<int, e> n_per_element;
    int n_all = 1;
    for (int k = 0; k < e; ++k) {
        n_per_element[k] = n_gauss_points.value_or(functions.knots[k].degree() + 1);
        n_points[k] = functions.knots[k].n_elements() * n_per_element[k];
        n_all *= n_points[k];
    }
    EntityPoint<d> point;
    for (int q = 0; q < n_all; ++q) {
        Vector<e> xi;
        double weight = 1.0;
        int rest = q;
        for (int k = 0; k < e; ++k) {
            const int i = rest % n_points[k];
            rest /= n_points[k];
            const GaussRule& rule = gauss_rule(n_per_element[k]);
            const std::vector<double>& breakpoints = functions.knots[k].breakpoints();
            const int element = i / n_per_element[k];
            const double length = breakpoints[element + 1] - breakpoints[element];
            xi[k] = breakpoints[element] + length * rule.points[i % n_per_element[k]];
            weight *= length * rule.weights[i % n_per_element[k]];
        }
        const VectorX x = map.point(xi);
        const MatrixX J = map.jacobian(xi);
        point.x.setZero();
        point.x.head(d) = x;
        point.normal.setZero();
        point.sign = sign;
        point.parameter_weight = weight;
        point.tangents = MatrixX::Zero(3, e);
        point.tangents.topRows(d) = J;
        if constexpr (e == 2) {
            const Vector3 area = Vector3(J.col(0)).cross(Vector3(J.col(1)));
            point.weight = weight * area.norm();
            if (area.norm() > 0.0) {
                point.normal = sign * area.normalized();
            }
        } else {
            const double length = J.col(0).norm();
            point.weight = weight * length;
            if (d == 2 && length > 0.0) {
                point.normal = sign / length * Vector3(J(1, 0), -J(0, 0), 0.0);
            }
        }
        PointBasis<e> basis = evaluate_basis(functions, weights, xi);
        point.dofs.resize(basis.functions.size());
        for (std::size_t i = 0; i < basis.functions.size(); ++i) {
            point.dofs[i] = space.dofs(entity.patch)[on[basis.functions[i]]];
        }
        point.values = std::move(basis.values);
        point.gradients = std::move(basis.gradients);
        body(point);
    }
}

}  // namespace

template <int d>
void for_entity_points(const Space<d>& space, const PatchEntity<d>& entity,
                       std::optional<int> n_gauss_points,
                       const std::function<void(const EntityPoint<d>&)>& body) {
    if constexpr (d == 3) {
        if (entity.dimension() == 2) {
            return visit<d, 2>(space, entity, n_gauss_points, body);
        }
    }
    if (entity.dimension() == 1) {
        return visit<d, 1>(space, entity, n_gauss_points, body);
    }
    EntityPoint<d> corner;
    const Patch<d>& patch = space.geometry().patches[entity.patch];
    const int function = functions_on<d>(patch.space(), entity.position).front();
    corner.x.head(patch.dimension()) = patch.control_points().row(function).transpose();
    corner.dofs = space.dofs_on(entity);
    corner.values = VectorX::Ones(1);
    body(corner);
}

template void for_entity_points(const Space<2>&, const PatchEntity<2>&, std::optional<int>,
                                const std::function<void(const EntityPoint<2>&)>&);
template void for_entity_points(const Space<3>&, const PatchEntity<3>&, std::optional<int>,
                                const std::function<void(const EntityPoint<3>&)>&);

}  // namespace couture::iga
