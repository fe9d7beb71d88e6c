#include "meshing/parameterization/node_relocation.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "iga/core/error.h"
#include "meshing/parameterization/newton_system.h"
#include "meshing/parameterization/surface_slide.h"
#include "meshing/parameterization/symmetric_dirichlet.h"

namespace couture::meshing {

namespace {

/// A corner of a cell: three of its points, and its edges along s and t as their combinations.
struct CellCorner {
    std::array<int, 3> points;
    Matrix<3, 2> edges;
    // Place in the quad's grid of the cell's first corner, and one row on.
    int quad;
    int first;
    int above;
    // Wanted lengths of its edges.
    Vector2 lengths;
};

std::vector<CellCorner> cell_corners(const EmbeddedLayout& embedding, const SampleGrid& grid,
                                     const std::vector<double>& cell_lengths) {
    // Positions among the cell's corners, counter-clockwise, of each corner's three points.
    constexpr int members[4][3] = {{0, 1, 3}, {0, 1, 2}, {3, 2, 1}, {3, 2, 0}};
    constexpr int along_t[4][3] = {{-1, 0, 1}, {0, -1, 1}, {0, 1, -1}, {1, 0, -1}};
    const std::vector<int> sheets = embedding.layout.sheets();
    std::vector<CellCorner> corners;
    for (int q = 0; q < embedding.layout.n_quads(); ++q) {
        const auto [n_s, n_t] = grid.sizes[q];
        Vector2 lengths(1.0, 1.0);
        for (int k = 0; k < 2 && !cell_lengths.empty(); ++k) {
            lengths[k] = cell_lengths[sheets[embedding.layout.sides(q)[k].arc]];
        }
        for (int cell = 0; cell < n_s * n_t; ++cell) {
            const int first = cell / n_s * (n_s + 1) + cell % n_s;
            const int above = first + n_s + 1;
            const std::array<int, 4> places{first, first + 1, above + 1, above};
            for (int k = 0; k < 4; ++k) {
                CellCorner& corner = corners.emplace_back();
                for (int i = 0; i < 3; ++i) {
                    corner.points[i] = grid.quads[q][places[members[k][i]]];
                    corner.edges(i, 1) = along_t[k][i];
                }
                corner.edges.col(0) = Vector3(-1.0, 1.0, 0.0);
                corner.quad = q;
                corner.first = first;
                corner.above = above;
                corner.lengths = lengths;
            }
        }
    }
    return corners;
}

/// The energy of the grid's cells.
class CellEnergy {
  public:
    CellEnergy(const EmbeddedLayout& embedding, const SampleGrid& grid, const SurfaceSlide& slide,
               const std::vector<double>& cell_lengths)
        : corners_(cell_corners(embedding, grid, cell_lengths)),
          unknowns_(grid.n_points, {-1, -1}) {
        for (int i = 0; i < grid.n_points; ++i) {
            for (int k = 0; k < slide.n_directions(i); ++k) unknowns_[i][k] = n_unknowns_++;
        }
    }

    [[nodiscard]] NewtonSystem make_system() const {
        std::vector<NewtonSystem::Element> elements;
        for (const CellCorner& corner : corners_) {
            NewtonSystem::Element& element = elements.emplace_back();
            for (int i = 0; i < 6; ++i) element[i] = unknowns_[corner.points[i / 2]][i % 2];
        }
        return {n_unknowns_, std::move(elements)};
    }

    [[nodiscard]] int n_inverted(const SurfaceSlide::State& state) const {
        int n = 0;
        for (const CellCorner& corner : corners_) {
            n += gradient(state, corner).determinant() > 0.0 ? 0 : 1;
        }
        return n;
    }

    [[nodiscard]] double value(const SurfaceSlide::State& state) const {
        double sum = 0.0;
        for (const CellCorner& corner : corners_) {
            sum += symmetric_dirichlet(gradient(state, corner));
        }
        return sum / static_cast<double>(corners_.size());
    }

    /// Makes the size of cells that with the least energy.
    void fit_cell_size(const SurfaceSlide::State& state) {
        double squares = 0.0;
        double inverse_squares = 0.0;
        for (const CellCorner& corner : corners_) {
            const Matrix<2> F = gradient(state, corner);
            const double det = F.determinant();
            squares += F.squaredNorm();
            inverse_squares += F.squaredNorm() / (det * det);
        }
        cell_size_ *= std::pow(squares / inverse_squares, 0.25);
    }

    void assemble(const SurfaceSlide::State& state, NewtonSystem& system) const {
        system.set_zero();
        const double weight = 1.0 / static_cast<double>(corners_.size());
        for (std::size_t c = 0; c < corners_.size(); ++c) {
            const CellCorner& corner = corners_[c];
            const Matrix<3, 2> plane = tangent_plane(state, corner);
            const SymmetricDirichlet term(gradient(state, corner));
            Matrix<6> hessian = Matrix<6>::Zero();
            for (int m = 0; m < 4; ++m) {
                const Vector<6> row = pulled_back(state, corner, plane * term.modes[m]);
                hessian.noalias() += (weight * term.eigenvalues[m]) * row * row.transpose();
            }
            system.add(static_cast<int>(c),
                       weight * pulled_back(state, corner, plane * term.gradient), hessian);
        }
    }

    /// Of the corner with the most.
    [[nodiscard]] double largest(const SurfaceSlide::State& state) const {
        double most = 0.0;
        for (const CellCorner& corner : corners_) {
            most = std::max(most, symmetric_dirichlet(gradient(state, corner)));
        }
        return most;
    }

    /// The sum of squared lengths, which no inverted cell disturbs, of the corners whose energy is
    /// not below a limit (inverted ones have an infinite one), and so many rings of cells around
    /// them; all other points are held.
    void assemble_lengths(const SurfaceSlide::State& state, double limit, int n_rings,
                          NewtonSystem& system) const {
        system.set_zero();
        // Beside 1 for a point's own stiffness.
        constexpr double held = 1e8;
        const std::vector<bool> is_near = near_bad(state, limit, n_rings);
        for (std::size_t c = 0; c < corners_.size(); ++c) {
            const CellCorner& corner = corners_[c];
            if (!is_near[c]) {
                system.add(static_cast<int>(c), Vector<6>::Zero(), held * Matrix<6>::Identity());
                continue;
            }
            const Matrix<3, 2> plane = tangent_plane(state, corner);
            Matrix<6> hessian = Matrix<6>::Zero();
            for (int m = 0; m < 4; ++m) {
                Matrix<2> unit = Matrix<2>::Zero();
                unit(m / 2, m % 2) = 1.0;
                const Vector<6> row = pulled_back(state, corner, plane * unit);
                hessian += row * row.transpose();
            }
            system.add(static_cast<int>(c),
                       pulled_back(state, corner, plane * gradient(state, corner)), hessian);
        }
    }

    /// The points' moves, and the part of them that moves none farther than its cells are long.
    [[nodiscard]] std::pair<MatrixX, double> moves(const SurfaceSlide::State& state,
                                                   const VectorX& step) const {
        MatrixX moves = MatrixX::Zero(3, state.points.cols());
        for (std::size_t i = 0; i < unknowns_.size(); ++i) {
            for (int k = 0; k < 2; ++k) {
                if (unknowns_[i][k] < 0) continue;
                moves.col(static_cast<int>(i)) +=
                    step[unknowns_[i][k]] * state.directions[i].col(k);
            }
        }
        double part = 1.0;
        for (const CellCorner& corner : corners_) {
            const auto length = [&](int i, int j) {
                return (state.points.col(corner.points[i]) - state.points.col(corner.points[j]))
                    .norm();
            };
            const double room = std::max({length(0, 1), length(1, 2), length(0, 2)});
            for (const int point : corner.points) {
                part = std::min(part, room / std::max(moves.col(point).norm(), 1e-300));
            }
        }
        return {std::move(moves), part};
    }

  private:
    [[nodiscard]] Matrix<3, 2> scaled_edges(const CellCorner& corner) const {
        return corner.edges * corner.lengths.cwiseInverse().asDiagonal() / cell_size_;
    }

    /// The derivatives by its points' directions of what has the derivative M by the edges that the
    /// wanted cell's become.
    [[nodiscard]] Vector<6> pulled_back(const SurfaceSlide::State& state, const CellCorner& corner,
                                        const Matrix<3, 2>& M) const {
        const Matrix<3> of_points = M * scaled_edges(corner).transpose();
        Vector<6> row;
        for (int i = 0; i < 3; ++i) {
            row.segment<2>(2 * i) =
                state.directions[corner.points[i]].transpose() * of_points.col(i);
        }
        return row;
    }

    /// Which corners share a point with one whose energy is not below a limit, or with one of
    /// these, and so on.
    [[nodiscard]] std::vector<bool> near_bad(const SurfaceSlide::State& state, double limit,
                                             int n_rings) const {
        std::vector<bool> is_near(corners_.size());
        for (std::size_t c = 0; c < corners_.size(); ++c) {
            is_near[c] = !(symmetric_dirichlet(gradient(state, corners_[c])) < limit);
        }
        for (int ring = 0; ring < n_rings; ++ring) {
            std::vector<bool> has_point(unknowns_.size(), false);
            for (std::size_t c = 0; c < corners_.size(); ++c) {
                for (const int point : corners_[c].points) {
                    if (is_near[c]) has_point[point] = true;
                }
            }
            for (std::size_t c = 0; c < corners_.size(); ++c) {
                for (const int point : corners_[c].points) {
                    if (has_point[point]) is_near[c] = true;
                }
            }
        }
        return is_near;
    }

    [[nodiscard]] static Matrix<3, 2> tangent_plane(const SurfaceSlide::State& state,
                                                    const CellCorner& corner) {
        const MatrixX& normals = state.normals[corner.quad];
        const Vector3 normal = (normals.col(corner.first) + normals.col(corner.first + 1) +
                                normals.col(corner.above) + normals.col(corner.above + 1))
                                   .normalized();
        Matrix<3, 2> plane;
        plane.col(0) = normal.unitOrthogonal();
        plane.col(1) = normal.cross(Vector3(plane.col(0)));
        return plane;
    }

    /// The map from the wanted cell to the tangent plane.
    [[nodiscard]] Matrix<2> gradient(const SurfaceSlide::State& state,
                                     const CellCorner& corner) const {
        Matrix<3> points;
        for (int i = 0; i < 3; ++i) points.col(i) = state.points.col(corner.points[i]);
        return tangent_plane(state, corner).transpose() * (points * scaled_edges(corner));
    }

    std::vector<CellCorner> corners_;
    std::vector<std::array<int, 2>> unknowns_;
    int n_unknowns_ = 0;
    double cell_size_ = 1.0;
};

/// Steps towards short edges around inverted corners, in ever wider rings, until there are none;
/// false if some are left.
bool untangle(const CellEnergy& energy, const SurfaceSlide& slide, NewtonSystem& system,
              SurfaceSlide::State& state) {
    constexpr int max_steps = 40;
    constexpr int steps_per_ring = 4;
    for (int i = 0; i < max_steps && energy.n_inverted(state) > 0; ++i) {
        energy.assemble_lengths(state, std::numeric_limits<double>::infinity(),
                                1 + i / steps_per_ring, system);
        const auto [moves, part] = energy.moves(state, system.step());
        state = slide.placed(state.points + part * moves);
    }
    return energy.n_inverted(state) == 0;
}

/// The system's step, or the longest of some parts of it with the energy falling.
///
/// @return that part; 0 if there is none
double take_step(const CellEnergy& energy, const SurfaceSlide& slide, NewtonSystem& system,
                 SurfaceSlide::State& state) {
    const auto [moves, longest] = energy.moves(state, system.step());
    const double start = energy.value(state);
    constexpr int max_halvings = 12;
    double part = 1.0;
    for (int i = 0; i < max_halvings; ++i, part *= 0.5) {
        SurfaceSlide::State moved = slide.placed(state.points + part * longest * moves);
        if (energy.value(moved) < start) {
            state = std::move(moved);
            return part;
        }
    }
    return 0.0;
}

/// Evens out the cells around the worst corners, and goes down from there; false if that does not
/// end below the start.
bool escape(const CellEnergy& energy, const SurfaceSlide& slide, NewtonSystem& system,
            SurfaceSlide::State& state) {
    constexpr int max_rings = 3;
    constexpr int max_steps = 5;
    const double limit = 0.5 * energy.largest(state);
    for (int n_rings = 1; n_rings <= max_rings; ++n_rings) {
        energy.assemble_lengths(state, limit, n_rings, system);
        const auto [moves, longest] = energy.moves(state, system.step());
        SurfaceSlide::State moved = slide.placed(state.points + longest * moves);
        if (energy.n_inverted(moved) > 0) continue;
        for (int i = 0; i < max_steps; ++i) {
            energy.assemble(moved, system);
            if (take_step(energy, slide, system, moved) == 0.0) break;
        }
        if (!(energy.value(moved) < energy.value(state))) continue;
        state = std::move(moved);
        return true;
    }
    return false;
}

/// One step with the energy falling; false if there is none.
bool step_down(const CellEnergy& energy, const SurfaceSlide& slide, NewtonSystem& system,
               SurfaceSlide::State& state) {
    energy.assemble(state, system);
    const double part = take_step(energy, slide, system, state);
    // The planes of cells turn as their points move, which the derivatives leave out: beside nearly
    // inverted corners they may not lead down.
    constexpr double stuck = 0.1;
    return (part < stuck && escape(energy, slide, system, state)) || part > 0.0;
}

void minimise(CellEnergy& energy, const SurfaceSlide& slide, const NodeRelocationOptions& options,
              NewtonSystem& system, SurfaceSlide::State& state, NodeRelocationReport& report) {
    energy.fit_cell_size(state);
    report.energies.push_back(energy.value(state));
    for (int i = 0; i < options.max_iterations && !report.is_converged; ++i) {
        const double start = report.energies.back();
        if (!step_down(energy, slide, system, state)) {
            // As far as the surface's facets allow.
            report.is_converged = true;
            return;
        }
        energy.fit_cell_size(state);
        report.energies.push_back(energy.value(state));
        report.is_converged = start - report.energies.back() < options.tolerance * start;
    }
}

}  // namespace

RelocatedSamples relocate_nodes(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                                const LayoutSamples& samples,
                                const NodeRelocationOptions& options) {
    const SampleGrid grid = make_sample_grid(embedding.layout, samples.n_cells);
    const SurfaceSlide slide(mesh, embedding, grid);
    CellEnergy energy(embedding, grid, slide, options.cell_lengths);
    NewtonSystem system = energy.make_system();
    SurfaceSlide::State state = slide.placed(to_points(samples, grid));
    const MatrixX start = state.points;
    RelocatedSamples result{samples, {}};
    NodeRelocationReport& report = result.report;
    report.n_inverted_at_start = energy.n_inverted(state);
    if (!untangle(energy, slide, system, state)) {
        report.n_inverted = report.n_inverted_at_start;
        return result;
    }
    minimise(energy, slide, options, system, state, report);
    for (int n = 0; n < embedding.layout.n_nodes(); ++n) {
        report.largest_move =
            std::max(report.largest_move, (state.points.col(n) - start.col(n)).norm());
    }
    result.samples = to_samples(embedding, samples.n_cells, grid, state.points);
    return result;
}

LayoutSamples refine_samples(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                             const LayoutSamples& samples, int n) {
    if (n < 1)
        throw InputError("refine_samples: {} parts of each cell; there must be 1 or more", n);
    std::vector<int> cells = samples.n_cells;
    for (int& count : cells) count *= n;
    const SampleGrid grid = make_sample_grid(embedding.layout, cells);
    MatrixX points(3, grid.n_points);
    const auto blend = [&](const MatrixX& old, int n_s, int i, int j) {
        const int a = std::min(i / n, n_s - 1);
        const int n_rows = static_cast<int>(old.cols()) / (n_s + 1);
        const int b = std::min(j / n, n_rows - 2);
        const double x = static_cast<double>(i) / n - a;
        const double y = static_cast<double>(j) / n - b;
        const int at = b * (n_s + 1) + a;
        return Vector3((1.0 - y) * ((1.0 - x) * old.col(at) + x * old.col(at + 1)) +
                       y * ((1.0 - x) * old.col(at + n_s + 1) + x * old.col(at + n_s + 2)));
    };
    for (int q = 0; q < embedding.layout.n_quads(); ++q) {
        const int width = grid.sizes[q][0] + 1;
        for (std::size_t p = 0; p < grid.quads[q].size(); ++p) {
            const int i = static_cast<int>(p) % width;
            const int j = static_cast<int>(p) / width;
            points.col(grid.quads[q][p]) = blend(samples.quads[q], grid.sizes[q][0] / n, i, j);
        }
    }
    const SurfaceSlide slide(mesh, embedding, grid);
    return to_samples(embedding, std::move(cells), grid, slide.placed(points).points);
}

}  // namespace couture::meshing
