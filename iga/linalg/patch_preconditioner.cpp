#include "iga/linalg/patch_preconditioner.h"

#include <algorithm>
#include <cmath>

#include "iga/core/parallel.h"

namespace couture::iga {

namespace {

/// Values at unknowns, 0 at number -1.
VectorX gather(const VectorX& all, const std::vector<int>& unknowns) {
    VectorX result(static_cast<Eigen::Index>(unknowns.size()));
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
        result[static_cast<Eigen::Index>(i)] = unknowns[i] >= 0 ? all[unknowns[i]] : 0.0;
    }
    return result;
}

void scatter(const VectorX& some, const std::vector<int>& unknowns, VectorX& all) {
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
        if (unknowns[i] >= 0) {
            all[unknowns[i]] = some[static_cast<Eigen::Index>(i)];
        }
    }
}

void mask(const std::vector<int>& unknowns, VectorX& values) {
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
        if (unknowns[i] < 0) {
            values[static_cast<Eigen::Index>(i)] = 0.0;
        }
    }
}

/// What is needed to walk through a box by slabs normal to a direction.
struct Slabs {
    int n = 0;
    std::array<int, 2> sizes{};
    Eigen::Index stride = 0;
    std::array<Eigen::Index, 2> strides{};

    Slabs(const BoxSolver& box, int normal) {
        const std::array<Eigen::Index, 3> all{1, box.size(0),
                                              static_cast<Eigen::Index>(box.size(0)) * box.size(1)};
        const auto [t0, t1] = other_directions(normal);
        n = box.size(normal);
        stride = all[normal];
        sizes = {box.size(t0), box.size(t1)};
        strides = {all[t0], all[t1]};
    }

    using Stride = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
    [[nodiscard]] Eigen::Map<const MatrixX, 0, Stride> of(const VectorX& values, int i) const {
        return {values.data() + i * stride, sizes[0], sizes[1], Stride(strides[1], strides[0])};
    }
    [[nodiscard]] Eigen::Map<MatrixX, 0, Stride> of(VectorX& values, int i) const {
        return {values.data() + i * stride, sizes[0], sizes[1], Stride(strides[1], strides[0])};
    }
};

VectorX diagonal_of(const BlockMatrix& matrix) {
    const int nc = matrix.block_size;
    VectorX diagonal(matrix.n_unknowns());
    for (int row = 0; row < matrix.n_rows; ++row) {
        const double* block = matrix.find(row, row);
        for (int c = 0; c < nc; ++c) {
            diagonal[row * nc + c] = block[c * nc + c];
        }
    }
    return diagonal;
}

/// Columns of a univariate matrix that belong to a box.
auto inner_columns(const MatrixX& matrix, const BoxSolver& box, int direction) {
    return matrix.middleCols(box.first(direction), box.size(direction));
}

}  // namespace

PatchPreconditioner::PatchPreconditioner(const BlockMatrix& matrix,
                                         const std::vector<char>& is_fixed,
                                         const PatchStructure& structure)
    : PatchPreconditioner(
          [&] {
              std::vector<std::vector<PatchCoefficients>> coefficients;
              for (std::size_t p = 0; p < structure.patches.size(); ++p) {
                  coefficients.push_back(
                      patch_coefficients(matrix, structure, static_cast<int>(p)));
              }
              return coefficients;
          }(),
          diagonal_of(matrix), is_fixed, structure) {}

PatchPreconditioner::PatchPreconditioner(
    const std::vector<std::vector<PatchCoefficients>>& coefficients, const VectorX& diagonal,
    const std::vector<char>& is_fixed, const PatchStructure& structure)
    : structure_(structure) {
    const int nc = static_cast<int>(coefficients.front().size());
    make_interiors(coefficients, is_fixed);
    make_faces(is_fixed, nc);
    make_scaling(diagonal, nc);
}

std::shared_ptr<const Eigenbasis> PatchPreconditioner::eigenbasis(
    const std::shared_ptr<const Univariate>& functions, bool without_first, bool without_last) {
    for (const KnownBasis& known : known_bases_) {
        if (known.functions == functions && known.without_first == without_first &&
            known.without_last == without_last) {
            return known.basis;
        }
    }
    known_bases_.push_back({functions, without_first, without_last,
                            std::make_shared<const Eigenbasis>(
                                make_eigenbasis(*functions, without_first, without_last))});
    return known_bases_.back().basis;
}

void PatchPreconditioner::make_interiors(
    const std::vector<std::vector<PatchCoefficients>>& coefficients,
    const std::vector<char>& is_fixed) {
    const int nc = static_cast<int>(coefficients.front().size());
    for (std::size_t p = 0; p < structure_.patches.size(); ++p) {
        const int patch = static_cast<int>(p);
        const PatchFunctions& functions = structure_.patches[p];
        for (int c = 0; c < nc; ++c) {
            const auto is_free = [&](int f) {
                const int dof = functions.dofs[f];
                return structure_.places[dof] == Place::interior && is_fixed[dof * nc + c] == 0;
            };
            std::array<std::shared_ptr<const Eigenbasis>, 3> bases;
            for (int k = 0; k < 3; ++k) {
                // A side of which nothing is free is left out of the box.
                std::array<bool, 2> is_closed{};
                for (int end = 0; end < 2 && 2 * k < structure_.n_sides; ++end) {
                    const std::vector<int> side = structure_.functions_on_side(patch, 2 * k + end);
                    is_closed[end] = std::none_of(side.begin(), side.end(), is_free);
                }
                bases[k] = eigenbasis(functions.directions[k], is_closed[0], is_closed[1]);
            }
            Interior interior{patch, c, coefficients[p][c], BoxSolver(bases, coefficients[p][c]),
                              {},    {}};
            interior.unknowns.reserve(interior.solver.size());
            const BoxSolver& box = interior.solver;
            for (int i2 = box.first(2); i2 < box.first(2) + box.size(2); ++i2) {
                for (int i1 = box.first(1); i1 < box.first(1) + box.size(1); ++i1) {
                    for (int i0 = box.first(0); i0 < box.first(0) + box.size(0); ++i0) {
                        const int f = functions.index({i0, i1, i2});
                        interior.unknowns.push_back(is_free(f) ? functions.dofs[f] * nc + c : -1);
                    }
                }
            }
            interiors_.push_back(std::move(interior));
        }
    }
}

void PatchPreconditioner::make_faces(const std::vector<char>& is_fixed, int nc) {
    for (const Meeting& meeting : structure_.meetings) {
        for (int c = 0; c < nc; ++c) {
            Face face;
            face.sides = meeting.side;
            const auto is_free = [&](int dof) {
                return structure_.places[dof] == Place::face && is_fixed[dof * nc + c] == 0;
            };
            for (int s = 0; s < 2; ++s) {
                face.interiors[s] = meeting.patch[s] * nc + c;
                const std::vector<int>& dofs = structure_.patches[meeting.patch[s]].dofs;
                for (const int f :
                     structure_.functions_on_side(meeting.patch[s], meeting.side[s])) {
                    face.unknowns[s].push_back(is_free(dofs[f]) ? dofs[f] * nc + c : -1);
                }
            }
            const PatchFunctions& first = structure_.patches[meeting.patch[0]];
            const std::array<int, 2> tangential = other_directions(side_direction(meeting.side[0]));
            const std::array<int, 2> sizes{first.size(tangential[0]), first.size(tangential[1])};
            for (int k = 0; k < 2; ++k) {
                std::array<bool, 2> is_closed{};
                for (int end = 0; end < 2 && 2 * tangential[k] < structure_.n_sides; ++end) {
                    is_closed[end] = true;
                    for (int i = 0; i < sizes[1 - k]; ++i) {
                        const int j = end == 0 ? 0 : sizes[k] - 1;
                        const int entry = k == 0 ? j + sizes[0] * i : i + sizes[0] * j;
                        is_closed[end] = is_closed[end] && face.unknowns[0][entry] < 0;
                    }
                }
                face.bases[k] =
                    eigenbasis(first.directions[tangential[k]], is_closed[0], is_closed[1]);
            }
            const Eigen::Index n0 = face.bases[0]->size();
            const Eigen::Index n1 = face.bases[1]->size();
            VectorX eigenvalues = VectorX::Zero(n0 * n1);
            for (int s = 0; s < 2; ++s) {
                const Interior& interior = interiors_[face.interiors[s]];
                const std::array<int, 2> own = other_directions(side_direction(face.sides[s]));
                std::array<double, 2> stretch{};
                for (int k = 0; k < 2; ++k) {
                    stretch[k] = interior.coefficients.stretch[own[s == 0 ? k : meeting.axis[k]]];
                }
                VectorX of_modes(n0 * n1);
                for (Eigen::Index j = 0; j < n1; ++j) {
                    for (Eigen::Index i = 0; i < n0; ++i) {
                        of_modes[i + n0 * j] = stretch[0] * face.bases[0]->values[i] +
                                               stretch[1] * face.bases[1]->values[j];
                    }
                }
                eigenvalues += schur_values(interior, face.sides[s], of_modes);
            }
            shift_zeros(eigenvalues);
            face.inverses = eigenvalues.cwiseInverse().reshaped(n0, n1);
            for (int s = 0; s < 2; ++s) {
                interiors_[face.interiors[s]].faces.emplace_back(static_cast<int>(faces_.size()),
                                                                 s);
            }
            faces_.push_back(std::move(face));
        }
    }
}

VectorX PatchPreconditioner::schur_values(const Interior& interior, int side,
                                          const VectorX& tangential) const {
    const int normal = side_direction(side);
    const Univariate& functions = *structure_.patches[interior.patch].directions[normal];
    const BoxSolver& box = interior.solver;
    const int end = side_is_high(side) ? functions.size() - 1 : 0;
    const double stretch = interior.coefficients.stretch[normal];
    const MatrixX& U = box.basis(normal).vectors;
    const Eigen::Index n = box.size(normal);
    const VectorX k = U.transpose() * functions.stiffness.col(end).segment(box.first(normal), n);
    const VectorX m = U.transpose() * functions.mass.col(end).segment(box.first(normal), n);
    const Eigen::ArrayXd values = stretch * box.basis(normal).values.array();
    VectorX result(tangential.size());
    for (Eigen::Index i = 0; i < tangential.size(); ++i) {
        const double shift = tangential[i] + interior.coefficients.reaction;
        double value = stretch * functions.stiffness(end, end) + shift * functions.mass(end, end);
        if (n > 0) {
            const double floor = 1e-300;
            value -=
                ((stretch * k + shift * m).array().square() / (values + shift).max(floor)).sum();
        }
        result[i] = std::max(value, 0.0);
    }
    return result;
}

void PatchPreconditioner::make_scaling(const VectorX& diagonal_of_A, int nc) {
    VectorX diagonal = VectorX::Zero(diagonal_of_A.size());
    for (const Interior& interior : interiors_) {
        const PatchFunctions& functions = structure_.patches[interior.patch];
        std::array<VectorX, 3> K;
        std::array<VectorX, 3> M;
        for (int k = 0; k < 3; ++k) {
            K[k] = functions.directions[k]->stiffness.diagonal();
            M[k] = functions.directions[k]->mass.diagonal();
        }
        const auto& [a, reaction] = interior.coefficients;
        std::array<int, 3> i{};
        for (i[2] = 0; i[2] < functions.size(2); ++i[2]) {
            for (i[1] = 0; i[1] < functions.size(1); ++i[1]) {
                for (i[0] = 0; i[0] < functions.size(0); ++i[0]) {
                    const double m0 = M[0][i[0]];
                    const double m1 = M[1][i[1]];
                    const double m2 = M[2][i[2]];
                    diagonal[functions.dofs[functions.index(i)] * nc + interior.component] +=
                        a[0] * K[0][i[0]] * m1 * m2 + a[1] * m0 * K[1][i[1]] * m2 +
                        a[2] * m0 * m1 * K[2][i[2]] + reaction * m0 * m1 * m2;
                }
            }
        }
    }
    scaling_.resize(diagonal.size());
    for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
        const double ratio = diagonal_of_A[i] / diagonal[i];
        scaling_[i] = ratio > 0.0 && std::isfinite(ratio) ? std::sqrt(ratio) : 1.0;
    }
}

VectorX PatchPreconditioner::couple_to_side(const Interior& interior, int side,
                                            const VectorX& values) const {
    const int normal = side_direction(side);
    const auto [t0, t1] = other_directions(normal);
    const PatchFunctions& functions = structure_.patches[interior.patch];
    const BoxSolver& box = interior.solver;
    const Slabs slabs(box, normal);
    const Univariate& own = *functions.directions[normal];
    const int end = side_is_high(side) ? own.size() - 1 : 0;
    const auto& [a, reaction] = interior.coefficients;
    MatrixX by_stiffness = MatrixX::Zero(slabs.sizes[0], slabs.sizes[1]);
    MatrixX by_mass = by_stiffness;
    for (int i = 0; i < slabs.n; ++i) {
        const double m = own.mass(end, i + box.first(normal));
        if (m != 0.0) {
            by_stiffness += own.stiffness(end, i + box.first(normal)) * slabs.of(values, i);
            by_mass += m * slabs.of(values, i);
        }
    }
    const Univariate& u0 = *functions.directions[t0];
    const Univariate& u1 = *functions.directions[t1];
    const auto M0 = inner_columns(u0.mass, box, t0);
    const auto M1 = inner_columns(u1.mass, box, t1);
    const auto K0 = inner_columns(u0.stiffness, box, t0);
    const auto K1 = inner_columns(u1.stiffness, box, t1);
    const MatrixX left =
        M0 * (a[normal] * by_stiffness + reaction * by_mass) + a[t0] * (K0 * by_mass);
    const MatrixX right = a[t1] * (M0 * by_mass);
    const MatrixX result = left * M1.transpose() + right * K1.transpose();
    return result.reshaped();
}

void PatchPreconditioner::subtract_from_interior(const Interior& interior, int side,
                                                 const VectorX& of_side, VectorX& values) const {
    const int normal = side_direction(side);
    const auto [t0, t1] = other_directions(normal);
    const PatchFunctions& functions = structure_.patches[interior.patch];
    const BoxSolver& box = interior.solver;
    const Slabs slabs(box, normal);
    const Univariate& own = *functions.directions[normal];
    const int end = side_is_high(side) ? own.size() - 1 : 0;
    const auto& [a, reaction] = interior.coefficients;
    const Univariate& u0 = *functions.directions[t0];
    const Univariate& u1 = *functions.directions[t1];
    const auto M0 = inner_columns(u0.mass, box, t0);
    const auto M1 = inner_columns(u1.mass, box, t1);
    const auto K0 = inner_columns(u0.stiffness, box, t0);
    const auto K1 = inner_columns(u1.stiffness, box, t1);
    const Eigen::Map<const MatrixX> z(of_side.data(), u0.size(), u1.size());
    const MatrixX zM1 = z * M1;
    const MatrixX mass = M0.transpose() * zM1;
    const MatrixX by_stiffness = a[normal] * mass;
    const MatrixX by_mass =
        reaction * mass + a[t0] * (K0.transpose() * zM1) + a[t1] * (M0.transpose() * (z * K1));
    for (int i = 0; i < slabs.n; ++i) {
        const double m = own.mass(end, i + box.first(normal));
        if (m != 0.0) {
            slabs.of(values, i) -=
                own.stiffness(end, i + box.first(normal)) * by_stiffness + m * by_mass;
        }
    }
}

VectorX PatchPreconditioner::apply(const VectorX& r) const {
    const VectorX scaled = r.cwiseQuotient(scaling_);
    VectorX result = VectorX::Zero(r.size());
    const int n_interiors = static_cast<int>(interiors_.size());
    // Boxes are worked on one after the other by all threads unless there are many.
    const auto for_interiors = [&](const std::function<void(int)>& body) {
        constexpr int boxes_per_thread = 4;
        if (n_interiors >= boxes_per_thread * n_threads()) {
            parallel_for(n_interiors, body);
        } else {
            for (int i = 0; i < n_interiors; ++i) {
                body(i);
            }
        }
    };
    std::vector<VectorX> values(n_interiors);
    for_interiors([&](int i) {
        const Interior& interior = interiors_[i];
        values[i] = gather(scaled, interior.unknowns);
        interior.solver.solve(values[i]);
        mask(interior.unknowns, values[i]);
    });
    if (!faces_.empty()) {
        parallel_for(static_cast<int>(faces_.size()), [&](int i) {
            const Face& face = faces_[i];
            // The second side may run through the functions in another order.
            VectorX residual = gather(scaled, face.unknowns[0]);
            for (int s = 0; s < 2; ++s) {
                const Interior& interior = interiors_[face.interiors[s]];
                const VectorX coupling =
                    couple_to_side(interior, face.sides[s], values[face.interiors[s]]);
                for (std::size_t k = 0; k < face.unknowns[s].size(); ++k) {
                    if (face.unknowns[s][k] >= 0) {
                        result[face.unknowns[s][k]] += coupling[static_cast<Eigen::Index>(k)];
                    }
                }
            }
            residual -= gather(result, face.unknowns[0]);
            const Eigenbasis& b0 = *face.bases[0];
            const Eigenbasis& b1 = *face.bases[1];
            const PatchFunctions& first = structure_.patches[interiors_[face.interiors[0]].patch];
            const auto [t0, t1] = other_directions(side_direction(face.sides[0]));
            Eigen::Map<MatrixX> plane(residual.data(), first.size(t0), first.size(t1));
            auto inner = plane.block(b0.first, b1.first, b0.size(), b1.size());
            const MatrixX modes =
                (b0.vectors.transpose() * inner * b1.vectors).cwiseProduct(face.inverses);
            inner = b0.vectors * modes * b1.vectors.transpose();
            scatter(residual, face.unknowns[0], result);
        });
        for_interiors([&](int i) {
            const Interior& interior = interiors_[i];
            if (interior.faces.empty()) {
                return;
            }
            VectorX correction = VectorX::Zero(values[i].size());
            for (const auto& [face, s] : interior.faces) {
                subtract_from_interior(interior, faces_[face].sides[s],
                                       gather(result, faces_[face].unknowns[s]), correction);
            }
            mask(interior.unknowns, correction);
            interior.solver.solve(correction);
            mask(interior.unknowns, correction);
            values[i] += correction;
        });
    }
    for (int i = 0; i < n_interiors; ++i) {
        scatter(values[i], interiors_[i].unknowns, result);
    }
    return result.cwiseQuotient(scaling_);
}

std::size_t PatchPreconditioner::memory() const {
    std::size_t n = static_cast<std::size_t>(scaling_.size()) * sizeof(double);
    for (const Interior& interior : interiors_) {
        n += interior.unknowns.size() * (sizeof(int) + 2 * sizeof(double));
    }
    return n;
}

}  // namespace couture::iga
