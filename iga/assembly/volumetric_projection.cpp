#include "iga/assembly/volumetric_projection.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "iga/assembly/assembler.h"
#include "iga/core/error.h"
#include "iga/core/parallel.h"

namespace couture::iga {

namespace {

/// Functions of one direction: those of degree 0 are constants of the elements.
struct Direction {
    std::optional<KnotVector> knots;
    std::vector<double> breakpoints;
    BasisTable table;
    int n_functions = 0;

    [[nodiscard]] int per_element() const { return table.n_functions; }
};

/// One degree and one continuity less; at a kink of the space, where that would tear the functions,
/// they stay continuous.
Direction make_direction(const KnotVector& space, const QuadratureLine& line) {
    Direction direction;
    direction.breakpoints = space.breakpoints();
    const int degree = space.degree() - 1;
    if (degree == 0) {
        const std::size_t n_points =
            static_cast<std::size_t>(line.n_elements) * line.points_per_element;
        direction.table = {line.points_per_element,
                           1,
                           {},
                           std::vector<double>(n_points, 1.0),
                           std::vector<double>(n_points, 0.0)};
        for (int e = 0; e < line.n_elements; ++e) {
            direction.table.first_function.push_back(e);
        }
        direction.n_functions = line.n_elements;
        return direction;
    }
    std::vector<double> knots;
    for (std::size_t i = 0; i < space.breakpoints().size(); ++i) {
        const bool is_end = i == 0 || i + 1 == space.breakpoints().size();
        const int n = is_end ? degree + 1 : std::min(space.multiplicities()[i], degree);
        knots.insert(knots.end(), n, space.breakpoints()[i]);
    }
    direction.knots.emplace(degree, std::move(knots));
    direction.table = tabulate(*direction.knots, space.breakpoints(), line.unit_points);
    direction.n_functions = direction.knots->n_basis();
    return direction;
}

}  // namespace

template <int d>
struct VolumetricProjection<d>::PatchData {
    std::array<int, d> points_per_element{};
    std::array<int, d> n_elements{};
    std::array<Direction, d> directions;
    VectorX volumes;
    SparseMatrix mass;
    Eigen::SimplicialLDLT<SparseMatrix> factor;

    [[nodiscard]] int n_functions() const {
        int product = 1;
        for (const Direction& direction : directions) {
            product *= direction.n_functions;
        }
        return product;
    }
    [[nodiscard]] int n_all_elements() const {
        int product = 1;
        for (const int n : n_elements) {
            product *= n;
        }
        return product;
    }
    [[nodiscard]] std::array<int, d> element(int i) const {
        std::array<int, d> result;
        for (int k = 0; k < d; ++k) {
            result[k] = i % n_elements[k];
            i /= n_elements[k];
        }
        return result;
    }

    /// Calls body(number of the point in the patch, its position per direction) for the points of
    /// an element.
    template <typename Body>
    void for_points(const std::array<int, d>& e, const Body& body) const {
        const int n0 = n_elements[0] * points_per_element[0];
        const int n1 = n_elements[1] * points_per_element[1];
        const int m2 = d == 3 ? points_per_element[d - 1] : 1;
        std::array<int, d> q{};
        for (int q2 = 0; q2 < m2; ++q2) {
            for (int q1 = 0; q1 < points_per_element[1]; ++q1) {
                for (int q0 = 0; q0 < points_per_element[0]; ++q0) {
                    q[0] = q0;
                    q[1] = q1;
                    int number = (e[1] * points_per_element[1] + q1) * n0 +
                                 e[0] * points_per_element[0] + q0;
                    if constexpr (d == 3) {
                        q[2] = q2;
                        number += (e[2] * m2 + q2) * n0 * n1;
                    }
                    body(number, q);
                }
            }
        }
    }

    /// Numbers of the functions on an element, direction 0 fastest.
    [[nodiscard]] std::vector<int> functions_on(const std::array<int, d>& e) const {
        std::vector<int> result{0};
        int stride = 1;
        for (int k = 0; k < d; ++k) {
            const Direction& direction = directions[k];
            std::vector<int> longer;
            for (int i = 0; i < direction.per_element(); ++i) {
                for (const int before : result) {
                    longer.push_back(before + stride * (direction.table.first_function[e[k]] + i));
                }
            }
            result = std::move(longer);
            stride *= direction.n_functions;
        }
        return result;
    }

    /// Values of those functions at a point.
    void values_at(const std::array<int, d>& e, const std::array<int, d>& q,
                   std::vector<double>& values) const {
        values.assign(1, 1.0);
        std::vector<double> longer;
        for (int k = 0; k < d; ++k) {
            const double* N = directions[k].table.value(e[k], q[k]);
            longer.clear();
            for (int i = 0; i < directions[k].per_element(); ++i) {
                for (const double before : values) {
                    longer.push_back(before * N[i]);
                }
            }
            values.swap(longer);
        }
    }
};

template <int d>
VolumetricProjection<d>::VolumetricProjection(const SpacePtr<d>& space,
                                              std::optional<int> n_gauss_points,
                                              std::vector<VectorX> volumes)
    : space_(space), patches_(space->n_patches()) {
    for (int p = 0; p < space->n_patches(); ++p) {
        PatchData& patch = patches_[p];
        const TensorSpace<d>& tensor = space->tensor(p);
        patch.points_per_element = gauss_points<d>(tensor, n_gauss_points);
        patch.n_elements = tensor.n_elements();
        patch.volumes = std::move(volumes[p]);
        for (int k = 0; k < d; ++k) {
            patch.directions[k] = make_direction(
                tensor.knots[k], QuadratureLine(tensor.knots[k], patch.points_per_element[k]));
        }
        std::vector<Eigen::Triplet<double>> entries;
        std::vector<double> q;
        for (int i = 0; i < patch.n_all_elements(); ++i) {
            const std::array<int, d> e = patch.element(i);
            const std::vector<int> functions = patch.functions_on(e);
            MatrixX M = MatrixX::Zero(functions.size(), functions.size());
            patch.for_points(e, [&](int number, const std::array<int, d>& at) {
                patch.values_at(e, at, q);
                const Eigen::Map<const VectorX> values(q.data(), q.size());
                M += patch.volumes[number] * values * values.transpose();
            });
            for (std::size_t a = 0; a < functions.size(); ++a) {
                for (std::size_t b = 0; b < functions.size(); ++b) {
                    entries.emplace_back(functions[a], functions[b], M(a, b));
                }
            }
        }
        const int n = patch.n_functions();
        patch.mass.resize(n, n);
        patch.mass.setFromTriplets(entries.begin(), entries.end());
        patch.factor.compute(patch.mass);
        if (patch.factor.info() != Eigen::Success) {
            throw SolverError(
                "volumetric projection: the mass matrix of patch {} is singular; take at least "
                "'degree' Gauss points per direction",
                p);
        }
    }
}

template <int d>
VolumetricProjection<d>::VolumetricProjection(VolumetricProjection&&) noexcept = default;
template <int d>
VolumetricProjection<d>::~VolumetricProjection() = default;

template <int d>
int VolumetricProjection<d>::n_functions(int patch) const {
    return patches_[patch].n_functions();
}

template <int d>
bool VolumetricProjection<d>::is_elementwise(int patch) const {
    const auto& directions = patches_[patch].directions;
    return std::all_of(directions.begin(), directions.end(),
                       [](const Direction& one) { return !one.knots; });
}

template <int d>
const SparseMatrix& VolumetricProjection<d>::mass(int patch) const {
    return patches_[patch].mass;
}

template <int d>
VectorX VolumetricProjection<d>::project(int patch, const VectorX& values) const {
    const PatchData& here = patches_[patch];
    VectorX rhs = VectorX::Zero(here.n_functions());
    std::vector<double> q;
    for (int i = 0; i < here.n_all_elements(); ++i) {
        const std::array<int, d> e = here.element(i);
        const std::vector<int> functions = here.functions_on(e);
        here.for_points(e, [&](int number, const std::array<int, d>& at) {
            here.values_at(e, at, q);
            const double f = here.volumes[number] * values[number];
            for (std::size_t a = 0; a < functions.size(); ++a) {
                rhs[functions[a]] += f * q[a];
            }
        });
    }
    return here.factor.solve(rhs);
}

template <int d>
VectorX VolumetricProjection<d>::at_points(int patch, const VectorX& coefficients) const {
    const PatchData& here = patches_[patch];
    VectorX values(here.volumes.size());
    parallel_for(here.n_all_elements(), [&](int i) {
        const std::array<int, d> e = here.element(i);
        const std::vector<int> functions = here.functions_on(e);
        std::vector<double> q;
        here.for_points(e, [&](int number, const std::array<int, d>& at) {
            here.values_at(e, at, q);
            double sum = 0.0;
            for (std::size_t a = 0; a < functions.size(); ++a) {
                sum += coefficients[functions[a]] * q[a];
            }
            values[number] = sum;
        });
    });
    return values;
}

template <int d>
double VolumetricProjection<d>::value(int patch, const VectorX& coefficients,
                                      const Vector<d>& xi) const {
    const PatchData& here = patches_[patch];
    std::vector<int> functions{0};
    std::vector<double> values{1.0};
    int stride = 1;
    for (int k = 0; k < d; ++k) {
        const Direction& direction = here.directions[k];
        int first = 0;
        MatrixX N = MatrixX::Ones(1, 1);
        if (direction.knots) {
            first = direction.knots->find_span(xi[k]) - direction.knots->degree();
            N = basis_derivatives(*direction.knots, xi[k], 0);
        } else {
            const std::vector<double>& b = direction.breakpoints;
            first =
                static_cast<int>(std::upper_bound(b.begin() + 1, b.end() - 1, xi[k]) - b.begin()) -
                1;
        }
        std::vector<int> more_functions;
        std::vector<double> more_values;
        for (int i = 0; i < N.cols(); ++i) {
            for (std::size_t a = 0; a < functions.size(); ++a) {
                more_functions.push_back(functions[a] + stride * (first + i));
                more_values.push_back(values[a] * N(0, i));
            }
        }
        functions = std::move(more_functions);
        values = std::move(more_values);
        stride *= direction.n_functions;
    }
    double sum = 0.0;
    for (std::size_t a = 0; a < functions.size(); ++a) {
        sum += values[a] * coefficients[functions[a]];
    }
    return sum;
}

template <int d>
SparseMatrix VolumetricProjection<d>::coupling(int patch, const Buffer<double>& b) const {
    const PatchData& here = patches_[patch];
    const TensorSpace<d>& tensor = space_->tensor(patch);
    const std::vector<int>& dofs = space_->dofs(patch);
    const VectorX& weights = space_->weights(patch);
    const GeometryGrid<d> grid(space_->geometry().patches[patch], tensor, here.points_per_element);
    std::array<BasisTable, d> tables;
    for (int k = 0; k < d; ++k) {
        tables[k] =
            tabulate(tensor.knots[k], tensor.knots[k].breakpoints(), grid.line(k).unit_points);
    }
    const std::array<int, d> sizes = tensor.sizes();
    const int n0 = grid.line(0).n_points();
    const int m2 = d == 3 ? here.points_per_element[d - 1] : 1;
    const int n_layers = grid.n_planes() / m2;
    const int per_layer = here.n_all_elements() / n_layers;
    std::vector<std::vector<Eigen::Triplet<double>>> entries(n_layers);
    parallel_for(n_layers, [&](int layer) {
        std::vector<GeometryPlane<d>> planes(m2);
        for (int i = 0; i < m2; ++i) {
            grid.evaluate(layer * m2 + i, planes[i]);
        }
        std::vector<double> q;
        for (int i = layer * per_layer; i < (layer + 1) * per_layer; ++i) {
            const std::array<int, d> e = here.element(i);
            const std::vector<int> functions = here.functions_on(e);
            // The space's functions on the element.
            std::vector<int> rows{0};
            int stride = 1;
            for (int k = 0; k < d; ++k) {
                std::vector<int> longer;
                for (int a = 0; a < tables[k].n_functions; ++a) {
                    for (const int before : rows) {
                        longer.push_back(before + stride * (tables[k].first_function[e[k]] + a));
                    }
                }
                rows = std::move(longer);
                stride *= sizes[k];
            }
            MatrixX B = MatrixX::Zero(static_cast<Eigen::Index>(rows.size()) * d, functions.size());
            VectorX column(B.rows());
            here.for_points(e, [&](int number, const std::array<int, d>& at) {
                const GeometryPlane<d>& plane = planes[d == 3 ? at[d - 1] : 0];
                const int in_plane = (e[1] * here.points_per_element[1] + at[1]) * n0 +
                                     e[0] * here.points_per_element[0] + at[0];
                // b by parametric derivatives and the value of the homogeneous functions.
                Eigen::Matrix<double, d, d + 1> c;
                const bool is_rational = weights.size() > 0;
                const double W = is_rational ? plane.denominator[in_plane] : 1.0;
                const double* given = &b[static_cast<std::size_t>(number) * d * (d + 1)];
                for (int a = 0; a < d; ++a) {
                    c(a, d) = given[a * (d + 1) + d] / W;
                    for (int k = 0; k < d; ++k) {
                        double sum = 0.0;
                        for (int s = 0; s < d; ++s) {
                            sum += given[a * (d + 1) + s] *
                                   plane.inverse_jacobian[d * d * in_plane + d * k + s];
                        }
                        c(a, k) = sum / W;
                        if (is_rational) {
                            c(a, d) -= sum * plane.denominator_gradient[d * in_plane + k] / (W * W);
                        }
                    }
                }
                Eigen::Index row = 0;
                const int last = d == 3 ? tables[d - 1].n_functions : 1;
                for (int i2 = 0; i2 < last; ++i2) {
                    for (int i1 = 0; i1 < tables[1].n_functions; ++i1) {
                        for (int i0 = 0; i0 < tables[0].n_functions; ++i0, ++row) {
                            std::array<int, 3> local = {i0, i1, i2};
                            Vector<d + 1> N = Vector<d + 1>::Ones();
                            for (int k = 0; k < d; ++k) {
                                const double value = tables[k].value(e[k], at[k])[local[k]];
                                const double slope = tables[k].derivative(e[k], at[k])[local[k]];
                                for (int s = 0; s <= d; ++s) {
                                    N[s] *= s == k ? slope : value;
                                }
                            }
                            const double w = is_rational ? weights[rows[row]] : 1.0;
                            column.template segment<d>(d * row) = w * (c * N);
                        }
                    }
                }
                here.values_at(e, at, q);
                B.noalias() += column * Eigen::Map<const VectorX>(q.data(), q.size()).transpose();
            });
            for (Eigen::Index j = 0; j < B.cols(); ++j) {
                for (Eigen::Index r = 0; r < B.rows(); ++r) {
                    entries[layer].emplace_back(d * dofs[rows[r / d]] + r % d, functions[j],
                                                B(r, j));
                }
            }
        }
    });
    std::vector<Eigen::Triplet<double>> all;
    for (const auto& some : entries) {
        all.insert(all.end(), some.begin(), some.end());
    }
    SparseMatrix result(static_cast<Eigen::Index>(space_->n_dofs()) * d, here.n_functions());
    result.setFromTriplets(all.begin(), all.end());
    return result;
}

template class VolumetricProjection<2>;
template class VolumetricProjection<3>;

}  // namespace couture::iga
