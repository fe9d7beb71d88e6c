#include "meshing/volume/shape_energy.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "iga/core/parallel.h"
#include "iga/spline/gauss.h"
#include "iga/topology/element_quality.h"
#include "meshing/volume/hexahedron_shape.h"

namespace couture::meshing {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int elements_per_chunk = 16;
/// Corners with a smaller inverse mean ratio count as singular in the starting geometry.
constexpr double singular_ratio = 1e-9;

/// Samples of an element in one direction: its ends, Gauss points, or evenly from end to end.
std::vector<double> sample_places(int kind, int n) {
    constexpr int gauss = 1;
    if (kind == gauss) return iga::gauss_rule(n).points;
    std::vector<double> places;
    for (int i = 0; i < n; ++i) places.push_back(i / (n - 1.0));
    return places;
}

/// See ShapeEnergy::PatchTables::corners_around.
///
/// @param has_ends  whether the first and the last sample of each direction are ends
std::vector<unsigned char> corners_around(const std::array<iga::BasisTable, 3>& tables,
                                          bool has_ends) {
    constexpr std::array<unsigned, 3> low_corners{0b01010101, 0b00110011, 0b00001111};
    const int n = tables[0].n_points * tables[1].n_points * tables[2].n_points;
    std::vector<unsigned char> result(n, 0b11111111);
    for (int q = 0; q < n && has_ends; ++q) {
        for (int k = 0, rest = q; k < 3; rest /= tables[k].n_points, ++k) {
            const int i = rest % tables[k].n_points;
            if (i == 0) result[q] &= low_corners[k];
            if (i + 1 == tables[k].n_points) result[q] &= ~low_corners[k];
        }
    }
    return result;
}

/// Coordinates times weight, and the weight.
using Row = Eigen::Array4d;

/// Starting threads takes longer than a few chunks do.
constexpr int min_parallel_chunks = 16;

void for_each(int n, const std::function<void(int)>& body) {
    if (n >= min_parallel_chunks) {
        parallel_for(n, body);
        return;
    }
    for (int i = 0; i < n; ++i) {
        body(i);
    }
}

}  // namespace

/// Sum factorisation on one element: values and derivatives at all samples of one kind, and the
/// transposed operation.
class ShapeEnergy::Element {
  public:
    struct Point {
        Row value, d0, d1, d2;
    };

    /// Moves to an element and evaluates the rows at its corners, and at its Gauss points or its
    /// dense samples.
    void load(const PatchTables& patch, int i_element, const MatrixX& points, bool is_dense) {
        patch_ = &patch;
        inner_kind_ = is_dense ? dense : gauss;
        for (int k = 0; k < 3; ++k) {
            element_[k] = i_element % patch.n_elements[k];
            i_element /= patch.n_elements[k];
            n_[k] = patch.tables[0][k].n_functions;
        }
        functions_.resize(n_[0] * n_[1] * n_[2]);
        rows_.resize(functions_.size());
        for (int i2 = 0, f = 0; i2 < n_[2]; ++i2) {
            for (int i1 = 0; i1 < n_[1]; ++i1) {
                for (int i0 = 0; i0 < n_[0]; ++i0, ++f) {
                    functions_[f] =
                        first(0) + i0 +
                        patch.n_basis[0] * (first(1) + i1 + patch.n_basis[1] * (first(2) + i2));
                    const double weight = patch.weights[functions_[f]];
                    rows_[f].head<3>() = weight * points.col(patch.dofs[functions_[f]]).array();
                    rows_[f][3] = weight;
                }
            }
        }
        forward(Kind::corners);
        forward(inner_kind_);
    }

    /// Visits the samples that count, but for those between singular corners only, as long as
    /// `visit` returns true.
    template <typename Visit>
    void for_each_sample(unsigned singular_corners, const Visit& visit) const {
        for (const Kind kind : {Kind::corners, inner_kind_}) {
            // Dense samples have the corners among them.
            if (kind == Kind::corners && inner_kind_ == dense) continue;
            const auto& corners_around = patch_->corners_around[kind];
            for (std::size_t q = 0; q < corners_around.size(); ++q) {
                if ((corners_around[q] & ~singular_corners) == 0) continue;
                if (!visit(kind, static_cast<int>(q))) return;
            }
        }
    }

    [[nodiscard]] int orientation() const { return patch_->orientation; }
    [[nodiscard]] int n_functions() const { return static_cast<int>(functions_.size()); }
    [[nodiscard]] std::vector<int> dofs() const {
        std::vector<int> result;
        for (const int function : functions_) {
            result.push_back(patch_->dofs[function]);
        }
        return result;
    }
    [[nodiscard]] int n_samples(unsigned singular_corners) const {
        int n = 0;
        for_each_sample(singular_corners, [&](Kind, int) { return ++n > 0; });
        return n;
    }

    [[nodiscard]] int n_samples_of(Kind kind) const {
        return static_cast<int>(points_[kind].size());
    }

    [[nodiscard]] Vector3 position(int kind, int q) const {
        const Row& value = points_[kind][q].value;
        return value.head<3>() / value[3];
    }
    [[nodiscard]] Matrix<3> jacobian(int kind, int q) const {
        const Point& p = points_[kind][q];
        const Eigen::Array3d x = p.value.head<3>() / p.value[3];
        Matrix<3> J;
        J.col(0) = (p.d0.head<3>() - x * p.d0[3]) / p.value[3];
        J.col(1) = (p.d1.head<3>() - x * p.d1[3]) / p.value[3];
        J.col(2) = (p.d2.head<3>() - x * p.d2[3]) / p.value[3];
        return J;
    }
    [[nodiscard]] Hexahedron corners() const {
        Hexahedron result;
        for (int q = 0; q < 8; ++q) {
            result.col(q) = position(Kind::corners, q);
        }
        return result;
    }
    /// Position of a sample in the patch's parameters.
    [[nodiscard]] Vector3 xi(int kind, int q) const {
        Vector3 result;
        for (int k = 0; k < 3; ++k) {
            const int n = patch_->tables[kind][k].n_points;
            const int i = q % n;
            q /= n;
            const double t = sample_places(kind, n)[i];
            result[k] = (1.0 - t) * patch_->breakpoints[k][element_[k]] +
                        t * patch_->breakpoints[k][element_[k] + 1];
        }
        return result;
    }

    void clear_gradient() {
        for (const Kind kind : {Kind::corners, inner_kind_}) {
            gradients_[kind].assign(points_[kind].size(),
                                    {Row::Zero(), Row::Zero(), Row::Zero(), Row::Zero()});
        }
    }
    void add_by_jacobian(int kind, int q, const Matrix<3>& by_J) {
        const Point& p = points_[kind][q];
        const double w = p.value[3];
        Point& g = gradients_[kind][q];
        g.d0.head<3>() += by_J.col(0).array() / w;
        g.d1.head<3>() += by_J.col(1).array() / w;
        g.d2.head<3>() += by_J.col(2).array() / w;
        g.value.head<3>() -= (by_J.col(0).array() * p.d0[3] + by_J.col(1).array() * p.d1[3] +
                              by_J.col(2).array() * p.d2[3]) /
                             (w * w);
    }
    void add_by_corner(int q, const Vector3& by_x) {
        gradients_[0][q].value.head<3>() += by_x.array() / points_[0][q].value[3];
    }
    /// Derivatives by the element's control points, 3 x n_functions.
    void write_gradient(Eigen::Ref<MatrixX> by_points) {
        std::fill(rows_.begin(), rows_.end(), Row::Zero());
        backward(Kind::corners);
        backward(inner_kind_);
        for (int f = 0; f < n_functions(); ++f) {
            by_points.col(f) = patch_->weights[functions_[f]] * rows_[f].head<3>().matrix();
        }
    }

  private:
    [[nodiscard]] int first(int k) const {
        return patch_->tables[0][k].first_function[element_[k]];
    }
    [[nodiscard]] const double* value(int kind, int k, int q) const {
        return patch_->tables[kind][k].value(element_[k], q);
    }
    [[nodiscard]] const double* derivative(int kind, int k, int q) const {
        return patch_->tables[kind][k].derivative(element_[k], q);
    }

    void resize(int kind) {
        for (int k = 0; k < 3; ++k) {
            q_[k] = patch_->tables[kind][k].n_points;
        }
        a_.resize(2 * q_[0] * n_[1] * n_[2]);
        b_.resize(3 * q_[0] * q_[1] * n_[2]);
        points_[kind].resize(q_[0] * q_[1] * q_[2]);
    }

    void forward(int kind) {
        resize(kind);
        for (int i12 = 0; i12 < n_[1] * n_[2]; ++i12) {
            for (int q = 0; q < q_[0]; ++q) {
                const double* N = value(kind, 0, q);
                const double* D = derivative(kind, 0, q);
                Row plain = Row::Zero();
                Row derived = Row::Zero();
                for (int i = 0; i < n_[0]; ++i) {
                    const Row& c = rows_[i + n_[0] * i12];
                    plain += N[i] * c;
                    derived += D[i] * c;
                }
                a_[2 * (q + q_[0] * i12)] = plain;
                a_[2 * (q + q_[0] * i12) + 1] = derived;
            }
        }
        for (int i2 = 0; i2 < n_[2]; ++i2) {
            for (int q1 = 0; q1 < q_[1]; ++q1) {
                const double* N = value(kind, 1, q1);
                const double* D = derivative(kind, 1, q1);
                for (int q0 = 0; q0 < q_[0]; ++q0) {
                    Row plain = Row::Zero();
                    Row by_0 = Row::Zero();
                    Row by_1 = Row::Zero();
                    for (int i = 0; i < n_[1]; ++i) {
                        const Row* a = &a_[2 * (q0 + q_[0] * (i + n_[1] * i2))];
                        plain += N[i] * a[0];
                        by_0 += N[i] * a[1];
                        by_1 += D[i] * a[0];
                    }
                    Row* b = &b_[3 * (q0 + q_[0] * (q1 + q_[1] * i2))];
                    b[0] = plain;
                    b[1] = by_0;
                    b[2] = by_1;
                }
            }
        }
        const int n_plane = q_[0] * q_[1];
        for (int q2 = 0; q2 < q_[2]; ++q2) {
            const double* N = value(kind, 2, q2);
            const double* D = derivative(kind, 2, q2);
            for (int q01 = 0; q01 < n_plane; ++q01) {
                Point p{Row::Zero(), Row::Zero(), Row::Zero(), Row::Zero()};
                for (int i = 0; i < n_[2]; ++i) {
                    const Row* b = &b_[3 * (q01 + n_plane * i)];
                    p.value += N[i] * b[0];
                    p.d0 += N[i] * b[1];
                    p.d1 += N[i] * b[2];
                    p.d2 += D[i] * b[0];
                }
                points_[kind][q01 + n_plane * q2] = p;
            }
        }
    }

    /// Adds the derivatives by the rows.
    void backward(int kind) {
        resize(kind);
        std::fill(a_.begin(), a_.end(), Row::Zero());
        std::fill(b_.begin(), b_.end(), Row::Zero());
        const int n_plane = q_[0] * q_[1];
        for (int q2 = 0; q2 < q_[2]; ++q2) {
            const double* N = value(kind, 2, q2);
            const double* D = derivative(kind, 2, q2);
            for (int q01 = 0; q01 < n_plane; ++q01) {
                const Point& g = gradients_[kind][q01 + n_plane * q2];
                for (int i = 0; i < n_[2]; ++i) {
                    Row* b = &b_[3 * (q01 + n_plane * i)];
                    b[0] += N[i] * g.value + D[i] * g.d2;
                    b[1] += N[i] * g.d0;
                    b[2] += N[i] * g.d1;
                }
            }
        }
        for (int i2 = 0; i2 < n_[2]; ++i2) {
            for (int q1 = 0; q1 < q_[1]; ++q1) {
                const double* N = value(kind, 1, q1);
                const double* D = derivative(kind, 1, q1);
                for (int q0 = 0; q0 < q_[0]; ++q0) {
                    const Row* b = &b_[3 * (q0 + q_[0] * (q1 + q_[1] * i2))];
                    for (int i = 0; i < n_[1]; ++i) {
                        Row* a = &a_[2 * (q0 + q_[0] * (i + n_[1] * i2))];
                        a[0] += N[i] * b[0] + D[i] * b[2];
                        a[1] += N[i] * b[1];
                    }
                }
            }
        }
        for (int i12 = 0; i12 < n_[1] * n_[2]; ++i12) {
            for (int q = 0; q < q_[0]; ++q) {
                const double* N = value(kind, 0, q);
                const double* D = derivative(kind, 0, q);
                const Row* a = &a_[2 * (q + q_[0] * i12)];
                for (int i = 0; i < n_[0]; ++i) {
                    rows_[i + n_[0] * i12] += N[i] * a[0] + D[i] * a[1];
                }
            }
        }
    }

    const PatchTables* patch_ = nullptr;
    std::array<int, 3> element_{};
    /// Functions and samples per direction.
    std::array<int, 3> n_{};
    std::array<int, 3> q_{};
    std::vector<int> functions_;
    std::vector<Row> rows_;
    std::vector<Row> a_;
    std::vector<Row> b_;
    Kind inner_kind_ = gauss;
    std::array<std::vector<Point>, n_kinds> points_;
    std::array<std::vector<Point>, n_kinds> gradients_;
};

ShapeEnergy::ShapeEnergy(const iga::MultiPatch<3>& geometry, const iga::DofMap& dofs,
                         const std::vector<int>& orientations, const std::vector<Vector3>& boxes,
                         int n_more_points)
    : n_dofs_(dofs.n_dofs) {
    MatrixX start(3, n_dofs_);
    for (int p = 0; p < geometry.n_patches(); ++p) {
        const iga::Patch<3>& patch = geometry.patches[p];
        PatchTables data;
        data.orientation = orientations[p];
        data.dofs = dofs.global[p];
        data.weights =
            patch.is_rational() ? patch.weights() : VectorX::Ones(patch.control_points().rows());
        int n_elements = 1;
        const Vector3 box =
            boxes.empty() ? Vector3::Ones() : Vector3(boxes[p] / std::cbrt(boxes[p].prod()));
        for (int k = 0; k < 3; ++k) {
            const iga::KnotVector& knots = patch.knots(k);
            data.n_basis[k] = knots.n_basis();
            data.n_elements[k] = knots.n_elements();
            data.breakpoints[k] = knots.breakpoints();
            n_elements *= knots.n_elements();
            const std::array<int, n_kinds> n_samples{2, knots.degree() + n_more_points,
                                                     2 * knots.degree() + 1};
            for (int kind = 0; kind < n_kinds; ++kind) {
                iga::BasisTable table =
                    tabulate(knots, data.breakpoints[k], sample_places(kind, n_samples[kind]));
                const std::size_t per_element = table.derivatives.size() / knots.n_elements();
                for (std::size_t i = 0; i < table.derivatives.size(); ++i) {
                    const std::size_t e = i / per_element;
                    table.derivatives[i] *=
                        (data.breakpoints[k][e + 1] - data.breakpoints[k][e]) / box[k];
                }
                data.tables[kind][k] = std::move(table);
            }
        }
        for (int kind = 0; kind < n_kinds; ++kind) {
            data.corners_around[kind] = corners_around(data.tables[kind], kind != gauss);
        }
        data.first_number = n_elements_;
        for (int e = 0; e < n_elements; e += elements_per_chunk) {
            chunks_.push_back(
                {p, e, std::min(e + elements_per_chunk, n_elements), n_elements_ + e});
        }
        n_elements_ += n_elements;
        for (std::size_t i = 0; i < data.dofs.size(); ++i) {
            start.col(data.dofs[i]) = patch.control_points().row(i).transpose();
        }
        patches_.push_back(std::move(data));
    }
    singular_corners_.assign(n_elements_, 0);
    is_dense_.assign(n_elements_, false);
    element_dofs_.resize(n_elements_);
    for_each(static_cast<int>(chunks_.size()), [&](int i) {
        const Chunk& chunk = chunks_[i];
        Element element;
        for (int e = chunk.first_element; e < chunk.last_element; ++e) {
            const int number = chunk.first_number + e - chunk.first_element;
            element.load(patches_[chunk.patch], e, start, false);
            element_dofs_[number] = element.dofs();
            for (int q = 0; q < 8; ++q) {
                if (std::abs(inverse_mean_ratio(element.jacobian(corners, q), 1)) <
                    singular_ratio) {
                    singular_corners_[number] |= 1U << q;
                }
            }
        }
    });
    set_reference(start);
}

double ShapeEnergy::value(const MatrixX& points, const ShapeMeasure& measure) const {
    return evaluate(points, measure, nullptr);
}

EnergyGradient ShapeEnergy::with_gradient(const MatrixX& points,
                                          const ShapeMeasure& measure) const {
    EnergyGradient result;
    result.value = evaluate(points, measure, &result.gradient);
    return result;
}

double ShapeEnergy::evaluate(const MatrixX& points, const ShapeMeasure& measure,
                             MatrixX* gradient) const {
    std::vector<double> values(n_elements_, 0.0);
    std::vector<MatrixX> gradients(gradient != nullptr ? n_elements_ : 0);
    for_each(static_cast<int>(chunks_.size()), [&](int i) {
        const Chunk& chunk = chunks_[i];
        Element element;
        for (int e = chunk.first_element; e < chunk.last_element; ++e) {
            const int number = chunk.first_number + e - chunk.first_element;
            const unsigned singular = singular_corners_[number];
            element.load(patches_[chunk.patch], e, points, is_dense_[number]);
            element.clear_gradient();
            const int n_samples = element.n_samples(singular);
            double sum = 0.0;
            element.for_each_sample(singular, [&](int kind, int q) {
                const SampleEnergy sample =
                    sample_energy(element.jacobian(kind, q), element.orientation(), measure,
                                  reference_volumes_[number]);
                sum += sample.value / n_samples;
                element.add_by_jacobian(kind, q, sample.by_J / n_samples);
                return sum < infinity;
            });
            if (measure.shape_ratio_weight > 0.0 && singular == 0 && sum < infinity) {
                const SmoothShapeRatio ratio =
                    smooth_shape_ratio(element.corners(), element.orientation());
                const double power = integer_power(ratio.value, measure.shape_ratio_power);
                sum += measure.shape_ratio_weight * power;
                for (int q = 0; q < 8 && power < infinity; ++q) {
                    element.add_by_corner(q, measure.shape_ratio_weight *
                                                 measure.shape_ratio_power * power / ratio.value *
                                                 ratio.gradient.col(q));
                }
            }
            values[number] = sum;
            if (gradient != nullptr && sum < infinity) {
                gradients[number].resize(3, element.n_functions());
                element.write_gradient(gradients[number]);
            }
        }
    });
    double total = 0.0;
    for (const double value : values) {
        total += value / n_elements_;
    }
    if (!std::isfinite(total)) {
        total = infinity;
    }
    if (gradient != nullptr) {
        *gradient = MatrixX::Zero(3, n_dofs_);
        for (int e = 0; e < n_elements_ && total < infinity; ++e) {
            for (std::size_t f = 0; f < element_dofs_[e].size(); ++f) {
                gradient->col(element_dofs_[e][f]) += gradients[e].col(f) / n_elements_;
            }
        }
    }
    return total;
}

ShapeSummary ShapeEnergy::summary(const MatrixX& points) const {
    std::vector<ShapeSummary> worst(chunks_.size());
    for_each(static_cast<int>(chunks_.size()), [&](int i) {
        const Chunk& chunk = chunks_[i];
        worst[i].min_inverse_mean_ratio = infinity;
        Element element;
        for (int e = chunk.first_element; e < chunk.last_element; ++e) {
            const int number = chunk.first_number + e - chunk.first_element;
            element.load(patches_[chunk.patch], e, points, is_dense_[number]);
            element.for_each_sample(singular_corners_[number], [&](int kind, int q) {
                const Matrix<3> J = element.jacobian(kind, q);
                worst[i].min_scaled_jacobian =
                    std::min(worst[i].min_scaled_jacobian,
                             element.orientation() * iga::scaled_jacobian<3>(J));
                const double ratio = inverse_mean_ratio(J, element.orientation());
                if (ratio < worst[i].min_inverse_mean_ratio) {
                    worst[i].min_inverse_mean_ratio = ratio;
                    worst[i].patch = chunk.patch;
                    worst[i].xi = element.xi(kind, q);
                }
                return true;
            });
            worst[i].max_shape_ratio =
                std::max(worst[i].max_shape_ratio, iga::shape_ratio(element.corners()));
        }
    });
    ShapeSummary result = worst[0];
    for (const ShapeSummary& other : worst) {
        const double shape = std::max(result.max_shape_ratio, other.max_shape_ratio);
        const double scaled = std::min(result.min_scaled_jacobian, other.min_scaled_jacobian);
        if (other.min_inverse_mean_ratio < result.min_inverse_mean_ratio) {
            result = other;
        }
        result.max_shape_ratio = shape;
        result.min_scaled_jacobian = scaled;
    }
    return result;
}

std::vector<double> ShapeEnergy::volumes(const MatrixX& points) const {
    std::vector<double> result(n_elements_, 0.0);
    for_each(static_cast<int>(chunks_.size()), [&](int i) {
        const Chunk& chunk = chunks_[i];
        Element element;
        for (int e = chunk.first_element; e < chunk.last_element; ++e) {
            element.load(patches_[chunk.patch], e, points, false);
            double sum = 0.0;
            int n = 0;
            for (; n < element.n_samples_of(gauss); ++n) {
                sum += element_size_cubed(element.jacobian(gauss, n));
            }
            result[chunk.first_number + e - chunk.first_element] = sum / n;
        }
    });
    return result;
}

VectorX ShapeEnergy::sizes(const MatrixX& points) const {
    const std::vector<double> cubes = volumes(points);
    VectorX sum = VectorX::Zero(n_dofs_);
    VectorX count = VectorX::Zero(n_dofs_);
    for (int e = 0; e < n_elements_; ++e) {
        for (const int dof : element_dofs_[e]) {
            sum[dof] += std::cbrt(cubes[e]);
            count[dof] += 1.0;
        }
    }
    return sum.cwiseQuotient(count);
}

bool ShapeEnergy::sample_densely(int patch, const std::vector<int>& elements) {
    bool is_new = false;
    for (const int e : elements) {
        const int number = patches_[patch].first_number + e;
        is_new = is_new || !is_dense_[number];
        is_dense_[number] = true;
    }
    return is_new;
}

std::vector<std::vector<int>> ShapeEnergy::elements_below(const MatrixX& points,
                                                          double limit) const {
    std::vector<char> is_below(n_elements_, 0);
    for_each(static_cast<int>(chunks_.size()), [&](int i) {
        const Chunk& chunk = chunks_[i];
        Element element;
        for (int e = chunk.first_element; e < chunk.last_element; ++e) {
            const int number = chunk.first_number + e - chunk.first_element;
            if (is_dense_[number]) continue;
            element.load(patches_[chunk.patch], e, points, true);
            element.for_each_sample(singular_corners_[number], [&](int kind, int q) {
                const double scaled =
                    element.orientation() * iga::scaled_jacobian<3>(element.jacobian(kind, q));
                is_below[number] = scaled < limit ? 1 : 0;
                return is_below[number] == 0;
            });
        }
    });
    std::vector<std::vector<int>> result(patches_.size());
    for (const Chunk& chunk : chunks_) {
        for (int e = chunk.first_element; e < chunk.last_element; ++e) {
            if (is_below[chunk.first_number + e - chunk.first_element] != 0) {
                result[chunk.patch].push_back(e);
            }
        }
    }
    return result;
}

void ShapeEnergy::set_reference(const MatrixX& points) { reference_volumes_ = volumes(points); }

}  // namespace couture::meshing
