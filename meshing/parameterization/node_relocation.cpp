#include "meshing/parameterization/node_relocation.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

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
    std::vector<CellCorner> corners;
    for (int q = 0; q < embedding.layout.n_quads(); ++q) {
        const auto [n_s, n_t] = grid.sizes[q];
        const auto& sides = embedding.layout.sides(q);
        // Part of the way from one side to the opposite one.
        const auto between = [&](int side, int opposite, double part) {
            if (cell_lengths.empty()) return 1.0;
            return (1.0 - part) * cell_lengths[sides[side].arc] +
                   part * cell_lengths[sides[opposite].arc];
        };
        for (int cell = 0; cell < n_s * n_t; ++cell) {
            const int first = cell / n_s * (n_s + 1) + cell % n_s;
            const int above = first + n_s + 1;
            const Vector2 lengths(between(0, 2, (cell / n_s + 0.5) / n_t),
                                  between(3, 1, (cell % n_s + 0.5) / n_s));
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
    CellEnergy(const SurfaceMesh& mesh, const EmbeddedLayout& embedding, const SampleGrid& grid,
               const SurfaceSlide& slide, const NodeRelocationOptions& options)
        : corners_(cell_corners(embedding, grid, options.cell_lengths)),
          area_part_(options.area_part),
          unknowns_(grid.n_points, {-1, -1}) {
        for (const FaceHandle face : mesh.faces()) area_ += face_area(mesh, face);
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
            const Matrix<2> F = gradient(state, corner);
            sum += weight(corner, F.determinant()) * symmetric_dirichlet(F);
        }
        return sum;
    }

    /// Makes the size of cells that with the least energy.
    void fit_cell_size(const SurfaceSlide::State& state) {
        double squares = 0.0;
        double inverse_squares = 0.0;
        for (const CellCorner& corner : corners_) {
            const Matrix<2> F = gradient(state, corner);
            const double det = F.determinant();
            const double weighted = weight(corner, det) * F.squaredNorm();
            squares += weighted;
            inverse_squares += weighted / (det * det);
        }
        cell_size_ *= std::pow(squares / inverse_squares, 0.25);
    }

    /// @param is_free  points that may move
    void assemble(const SurfaceSlide::State& state, const std::vector<bool>& is_free,
                  NewtonSystem& system) const {
        system.set_zero();
        for (std::size_t c = 0; c < corners_.size(); ++c) {
            const SymmetricDirichlet term(gradient(state, corners_[c]), cell_weight(),
                                          area_weight(corners_[c]));
            add(state, static_cast<int>(c), is_free, term.gradient, term.modes, term.eigenvalues,
                system);
        }
    }

    /// The smallest Jacobian determinant of a corner.
    [[nodiscard]] double min_jacobian(const SurfaceSlide::State& state) const {
        double smallest = std::numeric_limits<double>::infinity();
        for (const CellCorner& corner : corners_) {
            smallest = std::min(smallest, gradient(state, corner).determinant());
        }
        return smallest;
    }

    /// The mean of |F|^2 (1 + 1 / chi^2), chi = (det F + sqrt(det F^2 + width^2)) / 2: finite for
    /// inverted corners too, near to the symmetric Dirichlet energy for others.
    ///
    /// Source: [Escobar03] (the regularised determinant).
    [[nodiscard]] double regularised_value(const SurfaceSlide::State& state, double width) const {
        double sum = 0.0;
        for (const CellCorner& corner : corners_) {
            const Matrix<2> F = gradient(state, corner);
            const double chi = regularised(F.determinant(), width).first;
            sum += F.squaredNorm() * (1.0 + 1.0 / (chi * chi));
        }
        return sum / static_cast<double>(corners_.size());
    }

    /// Its gradient, and the part of its Hessian that is positive for sure.
    void assemble_regularised(const SurfaceSlide::State& state, double width,
                              const std::vector<bool>& is_free, NewtonSystem& system) const {
        system.set_zero();
        for (std::size_t c = 0; c < corners_.size(); ++c) {
            const Matrix<2> F = gradient(state, corners_[c]);
            const auto [chi, slope] = regularised(F.determinant(), width);
            Matrix<2> cofactor;
            cofactor << F(1, 1), -F(1, 0), -F(0, 1), F(0, 0);
            const double inverse_square = 1.0 / (chi * chi);
            const double n = static_cast<double>(corners_.size());
            const double squares = F.squaredNorm() / n;
            std::array<Matrix<2>, 5> modes;
            std::array<double, 5> eigenvalues;
            eigenvalues.fill(2.0 * (1.0 + inverse_square) / n);
            for (int m = 0; m < 4; ++m) {
                modes[m].setZero();
                modes[m](m / 2, m % 2) = 1.0;
            }
            modes[4] = cofactor;
            eigenvalues[4] = 6.0 * squares * slope * slope * inverse_square * inverse_square;
            add(state, static_cast<int>(c), is_free,
                2.0 * (1.0 + inverse_square) / n * F -
                    (2.0 * squares * slope * inverse_square / chi) * cofactor,
                modes, eigenvalues, system);
        }
    }

    /// Holds the points of cells that are steeper than allowed; whether there were free ones.
    bool hold_steep(const SurfaceSlide::State& state, const std::vector<double>& least_cosines,
                    std::vector<bool>& is_free) const {
        const std::vector<double> cosines = steepness(state);
        bool is_any = false;
        for (std::size_t cell = 0; cell < cosines.size(); ++cell) {
            if (cosines[cell] >= least_cosines[cell]) continue;
            for (std::size_t k = 4 * cell; k < 4 * cell + 4; ++k) {
                for (const int point : corners_[k].points) {
                    is_any = is_any || is_free[point];
                    is_free[point] = false;
                }
            }
        }
        return is_any;
    }

    /// For each cell the smallest cosine of the angles between its normal and the surface's in its
    /// corners.
    [[nodiscard]] std::vector<double> steepness(const SurfaceSlide::State& state) const {
        std::vector<double> cosines;
        for (std::size_t first = 0; first < corners_.size(); first += 4) {
            const CellCorner& cell = corners_[first];
            const MatrixX& normals = state.normals[cell.quad];
            const Vector3 normal = cell_normal(state, cell);
            double least = 1.0;
            for (const int at : {cell.first, cell.first + 1, cell.above, cell.above + 1}) {
                least = std::min(least, normal.dot(normals.col(at)));
            }
            cosines.push_back(least);
        }
        return cosines;
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
    /// Of a corner in the energy: for it being one of all, and for its share of the area.
    [[nodiscard]] double weight(const CellCorner& corner, double det) const {
        return cell_weight() + area_weight(corner) * det;
    }
    [[nodiscard]] double cell_weight() const {
        return (1.0 - area_part_) / static_cast<double>(corners_.size());
    }
    /// For each unit of the determinant.
    [[nodiscard]] double area_weight(const CellCorner& corner) const {
        constexpr double n_corners_of_cell = 4.0;
        return area_part_ * cell_size_ * cell_size_ * corner.lengths.prod() /
               (n_corners_of_cell * area_);
    }

    /// chi and its derivative.
    [[nodiscard]] static std::pair<double, double> regularised(double det, double width) {
        const double root = std::sqrt(det * det + width * width);
        // Without cancellation.
        const double chi = det > 0.0 ? 0.5 * (det + root) : 0.5 * width * width / (root - det);
        return {chi, chi / root};
    }

    /// Adds a corner's gradient and Hessian (eigenvalues times outer squares of modes) with respect
    /// to F; points that may not move are left out.
    template <std::size_t n>
    void add(const SurfaceSlide::State& state, int c, const std::vector<bool>& is_free,
             const Matrix<2>& of_F, const std::array<Matrix<2>, n>& modes,
             const std::array<double, n>& eigenvalues, NewtonSystem& system) const {
        const CellCorner& corner = corners_[c];
        const Matrix<3, 2> plane = tangent_plane(state, corner);
        const Matrix<3, 2> edges = scaled_edges(corner);
        Vector<6> free;
        for (int i = 0; i < 6; ++i) free[i] = is_free[corner.points[i / 2]] ? 1.0 : 0.0;
        const auto pulled_back = [&](const Matrix<2>& M) {
            const Matrix<3> of_points = plane * M * edges.transpose();
            Vector<6> row;
            for (int i = 0; i < 3; ++i) {
                row.segment<2>(2 * i) =
                    state.directions[corner.points[i]].transpose() * of_points.col(i);
            }
            return Vector<6>(free.cwiseProduct(row));
        };
        Matrix<6> hessian = (Vector<6>::Ones() - free).asDiagonal().toDenseMatrix();
        hessian /= static_cast<double>(corners_.size());
        for (std::size_t m = 0; m < n; ++m) {
            const Vector<6> row = pulled_back(modes[m]);
            hessian.noalias() += eigenvalues[m] * row * row.transpose();
        }
        system.add(c, pulled_back(of_F), hessian);
    }

    [[nodiscard]] Matrix<3, 2> scaled_edges(const CellCorner& corner) const {
        return corner.edges * corner.lengths.cwiseInverse().asDiagonal() / cell_size_;
    }

    [[nodiscard]] static Vector3 cell_normal(const SurfaceSlide::State& state,
                                             const CellCorner& corner) {
        const MatrixX& normals = state.normals[corner.quad];
        return (normals.col(corner.first) + normals.col(corner.first + 1) +
                normals.col(corner.above) + normals.col(corner.above + 1))
            .normalized();
    }

    [[nodiscard]] static Matrix<3, 2> tangent_plane(const SurfaceSlide::State& state,
                                                    const CellCorner& corner) {
        const Vector3 normal = cell_normal(state, corner);
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
    double area_part_;
    std::vector<std::array<int, 2>> unknowns_;
    int n_unknowns_ = 0;
    double area_ = 0.0;
    double cell_size_ = 1.0;
};

/// Points that may move, and how steep cells may become: a cell whose corners slide down a finger
/// of the surface, off its tip, has less energy but leaves the tip out.
struct Hold {
    std::vector<bool> is_free;
    std::vector<double> least_cosines;
};

Hold make_hold(const CellEnergy& energy, const SurfaceSlide::State& state) {
    constexpr double least_cosine = 0.7;
    Hold hold{std::vector<bool>(state.directions.size(), true), energy.steepness(state)};
    for (double& cosine : hold.least_cosines) cosine = std::min(cosine - 1e-6, least_cosine);
    return hold;
}

struct LineSearch {
    SurfaceSlide::State state;
    /// Of the longest step.
    double part = 0.0;
};

/// The largest part of the moves, halved again and again, at which the value is lower.
template <typename Value>
std::optional<LineSearch> search_along(const SurfaceSlide& slide, const SurfaceSlide::State& state,
                                       const MatrixX& moves, const Value& value) {
    const double start = value(state);
    constexpr int max_halvings = 12;
    double part = 1.0;
    for (int i = 0; i < max_halvings; ++i, part *= 0.5) {
        SurfaceSlide::State moved = slide.placed(state.points + part * moves);
        if (value(moved) < start) return LineSearch{std::move(moved), part};
    }
    return std::nullopt;
}

/// A Newton step along which a value falls. Steps that would make cells too steep are taken again
/// with these held.
///
/// @return the part of the step that was taken; 0 if there is none
template <typename Assemble, typename Value>
double step_down(const CellEnergy& energy, const SurfaceSlide& slide, NewtonSystem& system,
                 const Assemble& assemble, const Value& value, SurfaceSlide::State& state,
                 Hold& hold) {
    while (true) {
        assemble(state, hold.is_free);
        const auto [moves, longest] = energy.moves(state, system.step());
        std::optional<LineSearch> found = search_along(slide, state, longest * moves, value);
        if (!found) return 0.0;
        if (energy.hold_steep(found->state, hold.least_cosines, hold.is_free)) continue;
        state = std::move(found->state);
        return found->part;
    }
}

double newton_step(const CellEnergy& energy, const SurfaceSlide& slide, NewtonSystem& system,
                   SurfaceSlide::State& state, Hold& hold) {
    return step_down(
        energy, slide, system,
        [&](const SurfaceSlide::State& at, const std::vector<bool>& is_free) {
            energy.assemble(at, is_free, system);
        },
        [&](const SurfaceSlide::State& at) { return energy.value(at); }, state, hold);
}

/// @param width  see CellEnergy::regularised_value
double regularised_step(const CellEnergy& energy, const SurfaceSlide& slide, double width,
                        NewtonSystem& system, SurfaceSlide::State& state, Hold& hold) {
    return step_down(
        energy, slide, system,
        [&](const SurfaceSlide::State& at, const std::vector<bool>& is_free) {
            energy.assemble_regularised(at, width, is_free, system);
        },
        [&](const SurfaceSlide::State& at) { return energy.regularised_value(at, width); }, state,
        hold);
}

/// Lowers the regularised energy until no corner is inverted; false if some are left.
bool untangle(const CellEnergy& energy, const SurfaceSlide& slide, NewtonSystem& system,
              SurfaceSlide::State& state) {
    constexpr int max_steps = 100;
    constexpr double least_width = 0.02;
    if (energy.n_inverted(state) == 0) return true;
    Hold hold = make_hold(energy, state);
    for (int i = 0; i < max_steps && energy.n_inverted(state) > 0; ++i) {
        const double width = std::max(least_width, -energy.min_jacobian(state));
        if (regularised_step(energy, slide, width, system, state, hold) == 0.0) break;
    }
    return energy.n_inverted(state) == 0;
}

/// Goes down by the regularised energy, which the worst corners don't rule, and from there by the
/// energy itself; false if that does not end below the start.
bool escape(const CellEnergy& energy, const SurfaceSlide& slide, NewtonSystem& system,
            SurfaceSlide::State& state, const Hold& hold) {
    constexpr int max_steps = 5;
    for (const double width : {0.1, 0.3, 1.0}) {
        SurfaceSlide::State moved = state;
        Hold moved_hold = hold;
        for (int i = 0; i < max_steps; ++i) {
            regularised_step(energy, slide, width, system, moved, moved_hold);
        }
        for (int i = 0; i < max_steps; ++i) {
            newton_step(energy, slide, system, moved, moved_hold);
        }
        if (energy.value(moved) < energy.value(state)) {
            state = std::move(moved);
            return true;
        }
    }
    return false;
}

/// One step with the energy falling; false if there is none.
bool descend(const CellEnergy& energy, const SurfaceSlide& slide, NewtonSystem& system,
             SurfaceSlide::State& state, Hold& hold) {
    const double part = newton_step(energy, slide, system, state, hold);
    // The planes of cells turn as their points move, which the derivatives leave out: beside nearly
    // inverted corners they may not lead down.
    constexpr double stuck = 0.05;
    return (part < stuck && escape(energy, slide, system, state, hold)) || part > 0.0;
}

void minimise(CellEnergy& energy, const SurfaceSlide& slide, const NodeRelocationOptions& options,
              NewtonSystem& system, SurfaceSlide::State& state, NodeRelocationReport& report) {
    energy.fit_cell_size(state);
    Hold hold = make_hold(energy, state);
    report.energies.push_back(energy.value(state));
    for (int i = 0; i < options.max_iterations && !report.is_converged; ++i) {
        const double start = report.energies.back();
        if (!descend(energy, slide, system, state, hold)) {
            // As far as the surface's facets allow.
            report.is_converged = true;
            return;
        }
        energy.fit_cell_size(state);
        report.energies.push_back(energy.value(state));
        report.is_converged = start - report.energies.back() < options.tolerance * start;
    }
}

/// Moves the points of cells along curves by what moved those of the curve, less and less towards
/// the cell's opposite edge.
///
/// @param n      parts of each cell
/// @param moved  the same points where they belong
void follow_curves(const SurfaceSlide& slide, const SampleGrid& grid, int n, const MatrixX& moved,
                   MatrixX& points) {
    for (std::size_t q = 0; q < grid.quads.size(); ++q) {
        const auto [n_s, n_t] = grid.sizes[q];
        // What a point of the border does to one so many parts of cells away.
        const auto follow = [&, width = n_s + 1](int i, int j, int distance) {
            const int point = grid.quads[q][j * width + i];
            if (slide.n_directions(point) != 1 || distance >= n) return Vector3(Vector3::Zero());
            return Vector3((1.0 - static_cast<double>(distance) / n) *
                           (moved.col(point) - points.col(point)));
        };
        for (int j = 1; j < n_t; ++j) {
            for (int i = 1; i < n_s; ++i) {
                points.col(grid.quads[q][j * (n_s + 1) + i]) +=
                    follow(i, 0, j) + follow(i, n_t, n_t - j) + follow(0, j, i) +
                    follow(n_s, j, n_s - i);
            }
        }
    }
}

}  // namespace

RelocatedSamples relocate_nodes(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                                const LayoutSamples& samples,
                                const NodeRelocationOptions& options) {
    const auto n_lengths = static_cast<int>(options.cell_lengths.size());
    if (n_lengths > 0 && n_lengths != embedding.layout.n_arcs()) {
        throw InputError("relocate_nodes: {} lengths of cells for {} arcs; give none or all",
                         n_lengths, embedding.layout.n_arcs());
    }
    if (!(options.area_part >= 0.0 && options.area_part <= 1.0)) {
        throw InputError("relocate_nodes: area_part = {}; it must lie in [0, 1]",
                         options.area_part);
    }
    const SampleGrid grid = make_sample_grid(embedding.layout, samples.n_cells);
    const SurfaceSlide slide(mesh, embedding, grid);
    CellEnergy energy(mesh, embedding, grid, slide, options);
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
    follow_curves(slide, grid, n, slide.placed(points).points, points);
    return to_samples(embedding, std::move(cells), grid, slide.placed(points).points);
}

LayoutSamples coarsen_samples(const LayoutSamples& samples, int n) {
    LayoutSamples result = samples;
    for (std::size_t a = 0; a < samples.arcs.size(); ++a) {
        int& n_cells = result.n_cells[a];
        if (n < 1 || n_cells % n != 0) {
            throw InputError(
                "coarsen_samples: {} cells along arc {}, {} of them to be joined; the second "
                "number must be positive and divide the first",
                n_cells, a, n);
        }
        n_cells /= n;
        result.arcs[a] = samples.arcs[a](Eigen::all, Eigen::seqN(0, n_cells + 1, n)).eval();
    }
    for (int q = 0; q < samples.layout.n_quads(); ++q) {
        const auto& sides = samples.layout.sides(q);
        const int n_s = result.n_cells[sides[0].arc];
        const int n_t = result.n_cells[sides[1].arc];
        std::vector<int> places;
        for (int j = 0; j <= n_t; ++j) {
            for (int i = 0; i <= n_s; ++i) places.push_back(n * (j * (n * n_s + 1) + i));
        }
        result.quads[q] = samples.quads[q](Eigen::all, places).eval();
    }
    return result;
}

}  // namespace couture::meshing
