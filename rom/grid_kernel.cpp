#include "rom/grid_kernel.h"

#include <algorithm>

#include "iga/spline/bspline_basis.h"

namespace couture::rom {

LineTable::LineTable(const iga::KnotVector& knots, const std::vector<double>& parameters)
    : n_active(knots.degree() + 1) {
    first = knots.find_span(parameters.front()) - knots.degree();
    n_functions = knots.find_span(parameters.back()) + 1 - first;
    for (const double xi : parameters) {
        const int span = knots.find_span(xi);
        starts.push_back(span - knots.degree() - first);
        const MatrixX rows = iga::basis_derivatives(knots, span, xi, 1);
        for (int j = 0; j < n_active; ++j) {
            values.push_back(rows(0, j));
            derivatives.push_back(rows(1, j));
        }
    }
}

namespace {

/// Lanes computed per point: 1 if none is idle.
double waste(int n_points) {
    return static_cast<double>((n_points + n_lanes - 1) / n_lanes * n_lanes) / n_points;
}

/// Across 0, across 1, along: the latter with the fewest idle lanes, then the longest; the shorter
/// of the others is done first.
std::array<int, 3> order_of(const std::array<int, 3>& sizes) {
    std::array<int, 3> order = {0, 1, 2};
    const auto is_better = [&](int a, int b) {
        return waste(sizes[a]) != waste(sizes[b]) ? waste(sizes[a]) < waste(sizes[b])
                                                  : sizes[a] > sizes[b];
    };
    std::swap(order[2], *std::min_element(order.begin(), order.end(), is_better));
    if (sizes[order[0]] < sizes[order[1]]) {
        std::swap(order[0], order[1]);
    }
    return order;
}

}  // namespace

GridKernel::GridKernel(const iga::Space<3>& space, const SampleGrid& grid) : patch_(grid.patch) {
    const iga::TensorSpace<3>& tensor = space.tensor(patch_);
    const std::array<int, 3> n = grid.sizes();
    const std::array<int, 3> point_strides = {1, n[0], n[0] * n[1]};
    directions_ = order_of(n);
    orientation_ = directions_[1] == (directions_[0] + 1) % 3 ? 1.0 : -1.0;
    for (int k = 0; k < 3; ++k) {
        strides_[k] = point_strides[directions_[k]];
        tables_.emplace_back(tensor.knots[directions_[k]], grid.parameters[directions_[k]]);
    }
    n_along_ = tables_[2].n_points();
    make_blocks();

    const VectorX& weights = space.weights(patch_);
    for (int i1 = 0; i1 < tables_[1].n_functions; ++i1) {
        for (int i0 = 0; i0 < tables_[0].n_functions; ++i0) {
            for (int i2 = 0; i2 < tables_[2].n_functions; ++i2) {
                std::array<int, 3> index{};
                index[directions_[0]] = tables_[0].first + i0;
                index[directions_[1]] = tables_[1].first + i1;
                index[directions_[2]] = tables_[2].first + i2;
                const int function = tensor.index(index);
                dofs_.push_back(space.dofs(patch_)[function]);
                if (weights.size() > 0) {
                    weights_.push_back(weights[function]);
                }
            }
        }
    }
    if (!weights_.empty()) {
        make_denominators();
    }
}

void GridKernel::make_blocks() {
    const LineTable& along = tables_[2];
    for (int first = 0; first < n_along_; first += n_lanes) {
        const int last = std::min(first + n_lanes, n_along_) - 1;
        Block block{along.starts[first], along.starts[last] + along.n_active - along.starts[first],
                    along_values_.size()};
        along_values_.resize(block.first_table + block.n_functions, Lanes{});
        along_derivatives_.resize(block.first_table + block.n_functions, Lanes{});
        for (int lane = 0; lane < n_lanes; ++lane) {
            // Idle lanes repeat the last point.
            const int i = std::min(first + lane, last);
            for (int j = 0; j < along.n_active; ++j) {
                const std::size_t place = block.first_table + along.starts[i] - block.start + j;
                along_values_[place][lane] = along.value(i)[j];
                along_derivatives_[place][lane] = along.derivative(i)[j];
            }
        }
        blocks_.push_back(block);
    }
}

void GridKernel::gather(const double* control_points, const double* displacement,
                        Buffer<double>& net) const {
    net.resize(n_fields * dofs_.size());
    for (std::size_t i = 0; i < dofs_.size(); ++i) {
        const double* X = control_points + 3 * static_cast<std::size_t>(dofs_[i]);
        const double* U = displacement + 3 * static_cast<std::size_t>(dofs_[i]);
        const double weight = weights_.empty() ? 1.0 : weights_[i];
        double* out = &net[n_fields * i];
        for (int c = 0; c < 3; ++c) {
            out[c] = weight * X[c];
            out[3 + c] = weight * U[c];
        }
    }
}

void GridKernel::contract_along(const Block& block, const Buffer<double>& net,
                                Buffer<Lanes>& out) const {
    const int n_lines = tables_[0].n_functions * tables_[1].n_functions;
    const int n_functions = tables_[2].n_functions;
    out.resize(2 * static_cast<std::size_t>(n_lines) * n_fields);
    const Lanes* N = &along_values_[block.first_table];
    const Lanes* dN = &along_derivatives_[block.first_table];
    Lanes* values = out.data();
    Lanes* derivatives = values + static_cast<std::size_t>(n_lines) * n_fields;
    for (int line = 0; line < n_lines; ++line) {
        const double* in =
            &net[(static_cast<std::size_t>(line) * n_functions + block.start) * n_fields];
        std::array<Lanes, n_fields> value{};
        std::array<Lanes, n_fields> derivative{};
        for (int j = 0; j < block.n_functions; ++j, in += n_fields) {
            for (int c = 0; c < n_fields; ++c) {
                value[c] += in[c] * N[j];
                derivative[c] += in[c] * dN[j];
            }
        }
        for (int c = 0; c < n_fields; ++c) {
            values[line * n_fields + c] = value[c];
            derivatives[line * n_fields + c] = derivative[c];
        }
    }
}

void GridKernel::contract_across_1(int i_point, const Buffer<Lanes>& in, Buffer<Lanes>& out) const {
    const LineTable& table = tables_[1];
    const int width = tables_[0].n_functions * n_fields;
    const std::size_t derivatives = static_cast<std::size_t>(table.n_functions) * width;
    out.resize(3 * static_cast<std::size_t>(width));
    const double* N = table.value(i_point);
    const double* dN = table.derivative(i_point);
    const Lanes* value = &in[static_cast<std::size_t>(table.starts[i_point]) * width];
    const Lanes* along = value + derivatives;
    for (int i = 0; i < width; ++i) {
        Lanes sum{};
        Lanes across{};
        Lanes slope{};
        for (int j = 0; j < table.n_active; ++j) {
            const Lanes v = value[j * width + i];
            sum += N[j] * v;
            across += dN[j] * v;
            slope += N[j] * along[j * width + i];
        }
        out[i] = sum;
        out[width + i] = across;
        out[2 * width + i] = slope;
    }
}

GridKernel::FieldLanes GridKernel::contract_across_0(int i_point, const Buffer<Lanes>& in) const {
    const LineTable& table = tables_[0];
    const int width = table.n_functions * n_fields;
    const double* N = table.value(i_point);
    const double* dN = table.derivative(i_point);
    const Lanes* value = &in[static_cast<std::size_t>(table.starts[i_point]) * n_fields];
    FieldLanes out{};
    for (int j = 0; j < table.n_active; ++j, value += n_fields) {
        for (int c = 0; c < n_fields; ++c) {
            out[0][c] += N[j] * value[c];
            out[1][c] += dN[j] * value[c];
            out[2][c] += N[j] * value[width + c];
            out[3][c] += N[j] * value[2 * width + c];
        }
    }
    return out;
}

void GridKernel::divide(FieldLanes& fields, std::size_t i_denominator) const {
    const std::array<Lanes, 4>& W = denominators_[i_denominator];
    for (int c = 0; c < n_fields; ++c) {
        fields[0][c] *= W[0];
        for (int k = 1; k < 4; ++k) {
            fields[k][c] = fields[k][c] * W[0] - fields[0][c] * W[k];
        }
    }
}

PointLanes GridKernel::to_point(const FieldLanes& fields) const {
    PointLanes point;
    for (int c = 0; c < 3; ++c) {
        point.x[c] = fields[0][c];
        point.u[c] = fields[0][3 + c];
    }
    // J[i][k] = dx_i / dxi_k; the order of the xi does not matter for du/dx.
    const auto J = [&](int i, int k) { return fields[1 + k][i]; };
    std::array<std::array<Lanes, 3>, 3> cofactor;
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            const int i1 = (i + 1) % 3;
            const int i2 = (i + 2) % 3;
            const int k1 = (k + 1) % 3;
            const int k2 = (k + 2) % 3;
            cofactor[i][k] = J(i1, k1) * J(i2, k2) - J(i1, k2) * J(i2, k1);
        }
    }
    const Lanes det =
        J(0, 0) * cofactor[0][0] + J(0, 1) * cofactor[0][1] + J(0, 2) * cofactor[0][2];
    point.det_J = orientation_ * det;
    const Lanes inverse_det = 1.0 / det;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            Lanes sum = fields[1][3 + i] * cofactor[j][0];
            sum += fields[2][3 + i] * cofactor[j][1];
            sum += fields[3][3 + i] * cofactor[j][2];
            point.H[3 * i + j] = sum * inverse_det;
        }
    }
    return point;
}

void GridKernel::make_denominators() {
    // The weights as a displacement of ones: with all weights 1 the kernel gives W itself.
    std::vector<double> weights;
    std::swap(weights, weights_);
    std::vector<int> dofs(weights.size());
    for (std::size_t i = 0; i < dofs.size(); ++i) {
        dofs[i] = static_cast<int>(i);
    }
    std::swap(dofs, dofs_);
    std::vector<double> field(3 * weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        field[3 * i] = weights[i];
    }
    Buffer<double> net;
    Buffer<Lanes> lines;
    Buffer<Lanes> rows;
    gather(field.data(), field.data(), net);
    for (const Block& block : blocks_) {
        contract_along(block, net, lines);
        for (int i1 = 0; i1 < tables_[1].n_points(); ++i1) {
            contract_across_1(i1, lines, rows);
            for (int i0 = 0; i0 < tables_[0].n_points(); ++i0) {
                const FieldLanes W = contract_across_0(i0, rows);
                const Lanes inverse = 1.0 / W[0][0];
                denominators_.push_back(
                    {inverse, W[1][0] * inverse, W[2][0] * inverse, W[3][0] * inverse});
            }
        }
    }
    std::swap(dofs, dofs_);
    std::swap(weights, weights_);
}

}  // namespace couture::rom
