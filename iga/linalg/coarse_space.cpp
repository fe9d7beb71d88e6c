#include "iga/linalg/coarse_space.h"

#include <algorithm>
#include <cmath>

#include "iga/core/parallel.h"
#include "iga/linalg/cholmod_solver.h"
#include "iga/topology/dof_map.h"

namespace couture::iga {

namespace {

/// Rows of A that are multiplied before their products are added to the coarse matrix.
constexpr int rows_per_batch = 16384;
constexpr int rows_per_task = 256;
/// The coarse solution needs no refinement beyond this.
constexpr double coarse_tolerance = 1e-6;

/// A sparse row of blocks that grows.
struct BlockRow {
    std::vector<int> columns;
    std::vector<double> values;
};

/// Finds the place of a column in the row that is being worked on, in constant time.
class Slots {
  public:
    explicit Slots(int n_columns) : slot_(n_columns, -1) {}

    void open(const BlockRow& row) {
        for (std::size_t k = 0; k < row.columns.size(); ++k) {
            slot_[row.columns[k]] = static_cast<int>(k);
        }
    }
    void close(const BlockRow& row) {
        for (const int column : row.columns) {
            slot_[column] = -1;
        }
    }
    double* block(BlockRow& row, int column, int n_values) {
        int& slot = slot_[column];
        if (slot < 0) {
            slot = static_cast<int>(row.columns.size());
            row.columns.push_back(column);
            row.values.resize(row.values.size() + n_values, 0.0);
        }
        return &row.values[static_cast<std::size_t>(slot) * n_values];
    }

  private:
    std::vector<int> slot_;
};

}  // namespace

template <int d>
CoarseFunctions make_coarse_functions(const Space<d>& space, int elements_per_node,
                                      int n_elements_max) {
    const auto n_coarse = [&](const KnotVector& knots) {
        const int wanted = (knots.n_elements() + elements_per_node - 1) / elements_per_node;
        return std::clamp(wanted, 1, std::min(n_elements_max, knots.n_elements()));
    };
    std::vector<TensorSpace<d>> grids;
    for (int p = 0; p < space.n_patches(); ++p) {
        TensorSpace<d> grid = space.tensor(p);
        for (KnotVector& knots : grid.knots) {
            knots = KnotVector::uniform(1, n_coarse(knots), knots.front(), knots.back());
        }
        grids.push_back(grid);
    }
    const DofMap nodes = make_dof_map(space.geometry(), grids);
    CoarseFunctions result;
    result.n_nodes = nodes.n_dofs;
    result.nodes_of_patch = nodes.global;
    std::vector<std::vector<std::pair<int, double>>> entries(space.n_dofs());
    for (int p = 0; p < space.n_patches(); ++p) {
        const TensorSpace<d>& tensor = space.tensor(p);
        std::array<std::vector<double>, d> places;
        for (int k = 0; k < d; ++k) {
            const KnotVector& knots = tensor.knots[k];
            for (const double xi : knots.greville()) {
                places[k].push_back((xi - knots.front()) / (knots.back() - knots.front()) *
                                    grids[p].knots[k].n_elements());
            }
        }
        for (int f = 0; f < tensor.n_basis(); ++f) {
            auto& of_function = entries[space.dofs(p)[f]];
            if (!of_function.empty()) {
                continue;
            }
            const std::array<int, d> i = tensor.indices(f);
            for (int corner = 0; corner < 1 << d; ++corner) {
                std::array<int, d> node;
                double weight = 1.0;
                for (int k = 0; k < d; ++k) {
                    const double t = places[k][i[k]];
                    const int element =
                        std::min(static_cast<int>(t), grids[p].knots[k].n_elements() - 1);
                    const bool is_high = (corner >> k & 1) == 1;
                    node[k] = element + (is_high ? 1 : 0);
                    weight *= is_high ? t - element : 1.0 - (t - element);
                }
                if (weight > 0.0) {
                    of_function.emplace_back(nodes.global[p][grids[p].index(node)], weight);
                }
            }
        }
        auto& n_elements = result.n_elements.emplace_back(std::array<int, 3>{1, 1, 1});
        std::ranges::copy(grids[p].n_elements(), n_elements.begin());
        auto& of_sides = result.nodes_on_side.emplace_back();
        auto& functions_of_sides = result.functions_on_side.emplace_back();
        for (int side = 0; side < n_sides<d>; ++side) {
            const auto position = make_side<d>(p, side).position;
            of_sides.push_back(functions_on<d>(grids[p], position));
            functions_of_sides.push_back(functions_on<d>(tensor, position));
            for (int& node : of_sides.back()) {
                node = nodes.global[p][node];
            }
            for (int& function : functions_of_sides.back()) {
                function = space.dofs(p)[function];
            }
        }
    }
    result.begin.push_back(0);
    for (const auto& of_function : entries) {
        for (const auto& [node, weight] : of_function) {
            result.nodes.push_back(node);
            result.weights.push_back(weight);
        }
        result.begin.push_back(static_cast<std::int64_t>(result.nodes.size()));
    }
    return result;
}

template CoarseFunctions make_coarse_functions(const Space<2>&, int, int);
template CoarseFunctions make_coarse_functions(const Space<3>&, int, int);

CoarseSpace::CoarseSpace(const BlockMatrix& matrix, const std::vector<char>& is_fixed,
                         const MatrixX& translations, CoarseFunctions functions)
    : functions_(std::move(functions)),
      block_size_(matrix.block_size),
      is_fixed_(is_fixed),
      translations_(translations) {
    find_fixed_nodes();
    matrix_ = std::make_unique<BlockMatrix>(galerkin(matrix));
    factorize();
}

CoarseSpace::CoarseSpace(CoarseFunctions functions, BlockMatrix coarse,
                         const std::vector<char>& is_fixed, const MatrixX& translations)
    : functions_(std::move(functions)),
      block_size_(coarse.block_size),
      is_fixed_(is_fixed),
      translations_(translations),
      matrix_(std::make_unique<BlockMatrix>(std::move(coarse))) {
    find_fixed_nodes();
    factorize();
}

void CoarseSpace::find_fixed_nodes() {
    const int nc = block_size_;
    const int n_rows = static_cast<int>(functions_.begin.size()) - 1;
    is_turned_.assign(n_rows, 0);
    for (int i = 0; i < n_rows && translations_.size() > 0; ++i) {
        is_turned_[i] = translations_.middleRows(i * nc, nc).isIdentity() ? 0 : 1;
    }
    is_node_fixed_.assign(static_cast<std::size_t>(functions_.n_nodes) * nc, 0);
    for (std::size_t p = 0; p < functions_.nodes_on_side.size(); ++p) {
        for (std::size_t side = 0; side < functions_.nodes_on_side[p].size(); ++side) {
            for (int c = 0; c < nc; ++c) {
                const std::vector<int>& on_side = functions_.functions_on_side[p][side];
                if (std::all_of(on_side.begin(), on_side.end(),
                                [&](int i) { return is_fixed_[i * nc + c] != 0; })) {
                    for (const int node : functions_.nodes_on_side[p][side]) {
                        is_node_fixed_[node * nc + c] = 1;
                    }
                }
            }
        }
    }
}

void CoarseSpace::factorize() {
    const int nc = block_size_;
    // Nodes all of whose functions are fixed otherwise.
    for (int node = 0; node < functions_.n_nodes; ++node) {
        const double* diagonal = matrix_->find(node, node);
        for (int c = 0; c < nc; ++c) {
            if (!(diagonal[c * nc + c] > 0.0)) {
                is_node_fixed_[node * nc + c] = 1;
            }
        }
    }
    SolverOptions options;
    options.tolerance = coarse_tolerance;
    solver_ = make_cholmod_solver(options);
    solver_->factorize({*matrix_, is_node_fixed_, {}});
}

MatrixX CoarseSpace::block(int i) const {
    const int nc = block_size_;
    MatrixX result = is_turned_[i] != 0 ? MatrixX(translations_.middleRows(i * nc, nc))
                                        : MatrixX(MatrixX::Identity(nc, nc));
    for (int c = 0; c < nc; ++c) {
        if (is_fixed_[i * nc + c] != 0) {
            result.row(c).setZero();
        }
    }
    return result;
}

BlockMatrix CoarseSpace::galerkin(const BlockMatrix& A) const {
    const int nc = block_size_;
    const int n_values = nc * nc;
    // Blocks of P that are not the identity.
    std::vector<MatrixX> odd_blocks;
    std::vector<int> odd_block(A.n_rows, -1);
    for (int i = 0; i < A.n_rows; ++i) {
        const MatrixX own = block(i);
        if (!own.isIdentity(0.0)) {
            odd_block[i] = static_cast<int>(odd_blocks.size());
            odd_blocks.push_back(own);
        }
    }
    using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, 3>;
    std::vector<BlockRow> coarse(functions_.n_nodes);
    for (int first = 0; first < A.n_rows; first += rows_per_batch) {
        const int last = std::min(first + rows_per_batch, A.n_rows);
        // The half of A that is stored, its diagonal halved, times P.
        std::vector<BlockRow> products(last - first);
        std::vector<std::vector<int>> rows_of_node(functions_.n_nodes);
        parallel_for((last - first + rows_per_task - 1) / rows_per_task, [&](int task) {
            Slots slots(functions_.n_nodes);
            const int begin = first + task * rows_per_task;
            for (int row = begin; row < std::min(begin + rows_per_task, last); ++row) {
                BlockRow& product = products[row - first];
                for (std::int64_t e = A.row_begin[row]; e < A.row_begin[row + 1]; ++e) {
                    const int column = A.columns[e];
                    Block value = Eigen::Map<const Block>(&A.values[e * n_values], nc, nc);
                    if (column == row) {
                        value *= 0.5;
                    }
                    if (odd_block[column] >= 0) {
                        value = (value * odd_blocks[odd_block[column]]).eval();
                    }
                    for (std::int64_t k = functions_.begin[column];
                         k < functions_.begin[column + 1]; ++k) {
                        double* to = slots.block(product, functions_.nodes[k], n_values);
                        for (int v = 0; v < n_values; ++v) {
                            to[v] += functions_.weights[k] * value.data()[v];
                        }
                    }
                }
                slots.close(product);
                if (odd_block[row] >= 0) {
                    const MatrixX own = odd_blocks[odd_block[row]].transpose();
                    for (std::size_t k = 0; k < product.columns.size(); ++k) {
                        Eigen::Map<Block> value(&product.values[k * n_values], nc, nc);
                        value = (own * value).eval();
                    }
                }
            }
        });
        for (int row = first; row < last; ++row) {
            for (std::int64_t k = functions_.begin[row]; k < functions_.begin[row + 1]; ++k) {
                rows_of_node[functions_.nodes[k]].push_back(row);
            }
        }
        std::vector<int> touched;
        for (int node = 0; node < functions_.n_nodes; ++node) {
            if (!rows_of_node[node].empty()) {
                touched.push_back(node);
            }
        }
        parallel_for(static_cast<int>(touched.size()), [&](int t) {
            Slots slots(functions_.n_nodes);
            BlockRow& own = coarse[touched[t]];
            slots.open(own);
            for (const int row : rows_of_node[touched[t]]) {
                double weight = 0.0;
                for (std::int64_t k = functions_.begin[row]; k < functions_.begin[row + 1]; ++k) {
                    weight += functions_.nodes[k] == touched[t] ? functions_.weights[k] : 0.0;
                }
                const BlockRow& product = products[row - first];
                for (std::size_t k = 0; k < product.columns.size(); ++k) {
                    double* to = slots.block(own, product.columns[k], n_values);
                    for (int v = 0; v < n_values; ++v) {
                        to[v] += weight * product.values[k * n_values + v];
                    }
                }
            }
        });
    }
    // P^T A P is what was added up plus its transpose.
    std::vector<std::vector<std::pair<int, Block>>> upper(functions_.n_nodes);
    for (int node = 0; node < functions_.n_nodes; ++node) {
        upper[node].emplace_back(node, Block::Zero(nc, nc));
        for (std::size_t k = 0; k < coarse[node].columns.size(); ++k) {
            const int column = coarse[node].columns[k];
            const Block value = Eigen::Map<const Block>(&coarse[node].values[k * n_values], nc, nc);
            if (column == node) {
                upper[node].emplace_back(node, value + value.transpose());
            } else if (column > node) {
                upper[node].emplace_back(column, value);
            } else {
                upper[column].emplace_back(node, value.transpose());
            }
        }
    }
    BlockMatrix result;
    result.block_size = nc;
    result.n_rows = functions_.n_nodes;
    result.row_begin.push_back(0);
    for (auto& row : upper) {
        std::stable_sort(row.begin(), row.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [column, value] : row) {
            if (static_cast<std::int64_t>(result.columns.size()) == result.row_begin.back() ||
                result.columns.back() != column) {
                result.columns.push_back(column);
                result.values.resize(result.columns.size() * n_values, 0.0);
                std::fill_n(result.values.end() - n_values, n_values, 0.0);
            }
            for (int v = 0; v < n_values; ++v) {
                *(result.values.end() - n_values + v) += value.data()[v];
            }
        }
        result.row_begin.push_back(result.n_blocks());
    }
    return result;
}

VectorX CoarseSpace::apply(const VectorX& r) const {
    const int nc = block_size_;
    const int n_rows = static_cast<int>(functions_.begin.size()) - 1;
    MatrixX b = MatrixX::Zero(matrix_->n_unknowns(), 1);
    VectorX own(nc);
    for (int i = 0; i < n_rows; ++i) {
        if (is_turned_[i] != 0) {
            own = block(i).transpose() * r.segment(i * nc, nc);
        } else {
            for (int c = 0; c < nc; ++c) {
                own[c] = is_fixed_[i * nc + c] != 0 ? 0.0 : r[i * nc + c];
            }
        }
        for (std::int64_t k = functions_.begin[i]; k < functions_.begin[i + 1]; ++k) {
            b.col(0).segment(functions_.nodes[k] * nc, nc) += functions_.weights[k] * own;
        }
    }
    MatrixX x;
    static_cast<void>(solver_->solve(b, x));
    VectorX result = VectorX::Zero(r.size());
    for (int i = 0; i < n_rows; ++i) {
        own.setZero();
        for (std::int64_t k = functions_.begin[i]; k < functions_.begin[i + 1]; ++k) {
            own += functions_.weights[k] * x.col(0).segment(functions_.nodes[k] * nc, nc);
        }
        if (is_turned_[i] != 0) {
            result.segment(i * nc, nc) = block(i) * own;
        } else {
            for (int c = 0; c < nc; ++c) {
                result[i * nc + c] = is_fixed_[i * nc + c] != 0 ? 0.0 : own[c];
            }
        }
    }
    return result;
}

std::size_t CoarseSpace::memory() const {
    return matrix_->memory() + functions_.nodes.size() * (sizeof(int) + sizeof(double));
}

}  // namespace couture::iga
