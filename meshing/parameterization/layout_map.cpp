#include "meshing/parameterization/layout_map.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "iga/core/error.h"
#include "meshing/parameterization/chart_vertices.h"
#include "meshing/parameterization/newton_system.h"
#include "meshing/parameterization/symmetric_dirichlet.h"
#include "meshing/surface/harmonic_map.h"
#include "meshing/surface/predicates.h"

namespace couture::meshing {

namespace {

constexpr double quantum = 0x1p-36;

Vector2 rounded(const Vector2& x) { return (x / quantum).array().round().matrix() * quantum; }

// Triangles are taken to be no flatter than this part of their longest edge.
constexpr double smallest_height = 1e-3;

/// A triangle of the surface in its own plane: first vertex at the origin, first edge along the
/// first axis.
struct FlatTriangle {
    // Columns: gradients of the vertices' hat functions.
    Matrix<2, 3> hats;
    double area;

    FlatTriangle(const Vector3& a, const Vector3& b, const Vector3& c) {
        const Vector3 ab = b - a;
        const Vector3 ac = c - a;
        const double longest = std::max({ab.norm(), ac.norm(), (c - b).norm()});
        const double x_b = std::max(ab.norm(), smallest_height * longest);
        const double x_c = ab.dot(ac) / x_b;
        const double y_c = std::max(ab.cross(ac).norm() / x_b, smallest_height * longest);
        area = 0.5 * x_b * y_c;
        hats.col(1) = Vector2(y_c, -x_c) / (x_b * y_c);
        hats.col(2) = Vector2(0.0, 1.0 / y_c);
        hats.col(0) = -hats.col(1) - hats.col(2);
    }
};

using Corners = std::array<Vector2, 3>;

/// Smallest t > 0 at which the triangle x + t d loses its area; infinite if there is none.
double first_degenerate(const Corners& x, const Corners& d) {
    const auto cross = [](const Vector2& a, const Vector2& b) {
        return a.x() * b.y() - a.y() * b.x();
    };
    const Vector2 x1 = x[1] - x[0];
    const Vector2 x2 = x[2] - x[0];
    const Vector2 d1 = d[1] - d[0];
    const Vector2 d2 = d[2] - d[0];
    const double c = cross(x1, x2);
    const double b = cross(x1, d2) + cross(d1, x2);
    const double a = cross(d1, d2);
    const double discriminant = b * b - 4.0 * a * c;
    if (discriminant < 0.0 || (a >= 0.0 && b >= 0.0)) {
        return std::numeric_limits<double>::infinity();
    }
    // Of c + b t + a t^2 with c > 0, without cancellation.
    const double root = std::sqrt(discriminant);
    const double t = b <= 0.0 ? 2.0 * c / (root - b) : -(b + root) / (2.0 * a);
    return t > 0.0 ? t : std::numeric_limits<double>::infinity();
}

/// The energy of maps of a surface to charts.
class MapEnergy {
  public:
    MapEnergy(const SurfaceMesh& mesh, const EmbeddedLayout& embedding, const LayoutCharts& charts,
              const LayoutMapOptions& options)
        : mesh_(mesh),
          vertices_(mesh, embedding, charts),
          options_(options),
          unknowns_(mesh.n_vertices(), {-1, -1}) {
        const std::vector<int> sheets = embedding.layout.sheets();
        for (const FaceHandle face : mesh.faces()) {
            const auto [a, b, c] = face_vertices(mesh, face);
            triangles_.push_back({a.idx(), b.idx(), c.idx()});
            flat_.emplace_back(mesh.point(a), mesh.point(b), mesh.point(c));
            total_area_ += flat_.back().area;
            const auto& sides = embedding.layout.sides(embedding.quad_of_face[face.idx()]);
            Vector2 lengths(1.0, 1.0);
            for (int k = 0; k < 2 && !options.cell_lengths.empty(); ++k) {
                lengths[k] = options.cell_lengths[sheets[sides[k].arc]];
            }
            lengths_.push_back(lengths);
        }
        for (int v = 0; v < static_cast<int>(mesh.n_vertices()); ++v) {
            for (int k = 0; k < 2; ++k) {
                if (!vertices_.is_fixed(v, k) && vertices_.chart(v) >= 0) {
                    unknowns_[v][k] = n_unknowns_++;
                }
            }
        }
    }

    [[nodiscard]] const ChartVertices& vertices() const { return vertices_; }
    [[nodiscard]] int n_faces() const { return static_cast<int>(triangles_.size()); }
    [[nodiscard]] double cell_size() const { return cell_size_; }

    [[nodiscard]] Corners corners(const std::vector<Vector2>& x, int face) const {
        Corners result;
        for (int k = 0; k < 3; ++k) {
            result[k] = vertices_.transition(face, k)(x[triangles_[face][k]]);
        }
        return result;
    }

    [[nodiscard]] NewtonSystem make_system() const {
        std::vector<NewtonSystem::Element> elements;
        for (const auto& triangle : triangles_) {
            NewtonSystem::Element& element = elements.emplace_back();
            for (int i = 0; i < 6; ++i) element[i] = unknowns_[triangle[i / 2]][i % 2];
        }
        return {n_unknowns_, std::move(elements)};
    }

    /// Total energy by the areas of triangles.
    [[nodiscard]] double value(const std::vector<Vector2>& x) const {
        double sum = 0.0;
        for (int f = 0; f < n_faces(); ++f) {
            const Matrix<2> F = gradient_of_map(x, f);
            sum += flat_[f].area * (distortion_of(F) + alignment(F, f));
        }
        return sum / total_area_;
    }

    /// Makes the cells' size that with the least energy; keeps it where the alignment forbids that.
    void fit_cell_size(const std::vector<Vector2>& x) {
        if (is_quadratic()) {
            fit_to_directions(x);
            return;
        }
        double squares = 0.0;
        double inverse_squares = 0.0;
        for (int f = 0; f < n_faces(); ++f) {
            const Matrix<2> F = gradient_of_map(x, f);
            const double det = F.determinant();
            squares += flat_[f].area * F.squaredNorm();
            inverse_squares += flat_[f].area * F.squaredNorm() / (det * det);
        }
        const double old_size = cell_size_;
        const double old_energy = value(x);
        cell_size_ *= std::pow(inverse_squares / squares, 0.25);
        if (is_aligned() && is_fitted_ && value(x) > old_energy) cell_size_ = old_size;
        is_fitted_ = true;
    }

    void assemble(const std::vector<Vector2>& x, NewtonSystem& system) const {
        system.set_zero();
        for (int f = 0; f < n_faces(); ++f) add_triangle(x, f, system);
    }

    /// The step of the points and its greatest length that leaves all triangles some area.
    [[nodiscard]] std::pair<std::vector<Vector2>, double> spread(const std::vector<Vector2>& x,
                                                                 const VectorX& step) const {
        std::vector<Vector2> d(x.size(), Vector2::Zero());
        for (std::size_t v = 0; v < x.size(); ++v) {
            for (int k = 0; k < 2; ++k) {
                if (unknowns_[v][k] >= 0) d[v][k] = step[unknowns_[v][k]];
            }
        }
        double largest = std::numeric_limits<double>::infinity();
        for (int f = 0; f < n_faces(); ++f) {
            Corners moved;
            for (int k = 0; k < 3; ++k) {
                moved[k] = turned(d[triangles_[f][k]], vertices_.transition(f, k).quarter_turns);
            }
            largest = std::min(largest, first_degenerate(corners(x, f), moved));
        }
        return {std::move(d), largest};
    }

    [[nodiscard]] int n_flipped(const std::vector<Vector2>& x) const {
        int n = 0;
        for (int f = 0; f < n_faces(); ++f) {
            const Corners c = corners(x, f);
            n += orientation(c[0], c[1], c[2]) > 0 ? 0 : 1;
        }
        return n;
    }

    [[nodiscard]] MapDistortion distortion(const std::vector<Vector2>& x) const {
        TriangleSoup soup;
        std::vector<Vector2> parameters;
        for (int f = 0; f < n_faces(); ++f) {
            const Corners c = corners(x, f);
            for (int k = 0; k < 3; ++k) {
                soup.points.push_back(mesh_.point(VertexHandle(triangles_[f][k])));
                parameters.emplace_back(lengths_[f].cwiseProduct(c[k]));
            }
            soup.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
        }
        return map_distortion(CutSurface(soup), parameters);
    }

    [[nodiscard]] double mean_angle_to_directions(const std::vector<Vector2>& x) const {
        if (!options_.directions) return 0.0;
        double sum = 0.0;
        for (int f = 0; f < n_faces(); ++f) {
            const Matrix<2> F = gradient_of_map(x, f);
            const Matrix<2> target = frame(f);
            const Vector2 u = F.row(0).transpose();
            const Vector2 u_c = target.row(0).transpose();
            sum +=
                flat_[f].area * std::abs(std::atan2(u_c.x() * u.y() - u_c.y() * u.x(), u_c.dot(u)));
        }
        return sum / total_area_;
    }

  private:
    [[nodiscard]] bool is_quadratic() const { return options_.route == LayoutMapRoute::quadratic; }
    [[nodiscard]] double alignment_weight() const {
        if (!options_.directions) return 0.0;
        return is_quadratic() ? 1.0 : options_.alignment_weight;
    }
    [[nodiscard]] bool is_aligned() const { return alignment_weight() > 0.0; }

    /// The size of cells of the least squares.
    void fit_to_directions(const std::vector<Vector2>& x) {
        double along = 0.0;
        double squares = 0.0;
        for (int f = 0; f < n_faces(); ++f) {
            const Matrix<2> F = gradient_of_map(x, f);
            along += flat_[f].area * F.cwiseProduct(frame(f)).sum();
            squares += flat_[f].area * F.squaredNorm();
        }
        if (along > 0.0) cell_size_ *= along / squares;
    }

    /// Rows: gradients of u and v in the triangle's plane, times the wanted length of a cell.
    [[nodiscard]] Matrix<2> gradient_of_map(const std::vector<Vector2>& x, int f) const {
        const Corners c = corners(x, f);
        Matrix<2, 3> uv;
        for (int k = 0; k < 3; ++k) uv.col(k) = c[k];
        return cell_size_ * lengths_[f].asDiagonal() * (uv * flat_[f].hats.transpose());
    }

    /// The directions as gradients of u and v.
    [[nodiscard]] Matrix<2> frame(int f) const {
        const double angle = options_.directions->angles[f];
        Matrix<2> rows;
        rows << std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle);
        return rows;
    }

    [[nodiscard]] double distortion_of(const Matrix<2>& F) const {
        return is_quadratic() ? 0.0 : symmetric_dirichlet(F);
    }

    [[nodiscard]] double alignment(const Matrix<2>& F, int f) const {
        return is_aligned() ? alignment_weight() * (F - frame(f)).squaredNorm() : 0.0;
    }

    /// Gradient of a triangle's energy by F and its Hessian by eigenvectors.
    struct Term {
        Matrix<2> gradient = Matrix<2>::Zero();
        std::array<Matrix<2>, 4> modes;
        std::array<double, 4> eigenvalues{};
    };
    [[nodiscard]] Term term(const Matrix<2>& F, int f) const {
        Term result;
        if (is_quadratic()) {
            for (int k = 0; k < 4; ++k) {
                result.modes[k].setZero();
                result.modes[k](k / 2, k % 2) = 1.0;
            }
        } else {
            const SymmetricDirichlet distortion(F);
            result = {distortion.gradient, distortion.modes, distortion.eigenvalues};
        }
        if (is_aligned()) {
            result.gradient += 2.0 * alignment_weight() * (F - frame(f));
            for (double& value : result.eigenvalues) value += 2.0 * alignment_weight();
        }
        return result;
    }

    void add_triangle(const std::vector<Vector2>& x, int f, NewtonSystem& system) const {
        const Term of_triangle = term(gradient_of_map(x, f), f);
        // d F / d x of a 2 x 2 matrix M, as six numbers: <M, dF> = row . dx.
        const auto pulled_back = [&](const Matrix<2>& M) {
            const Matrix<2, 3> of_corners =
                cell_size_ * (lengths_[f].asDiagonal() * M * flat_[f].hats);
            Vector<6> row;
            for (int k = 0; k < 3; ++k) {
                row.segment<2>(2 * k) =
                    turned(of_corners.col(k), -vertices_.transition(f, k).quarter_turns);
            }
            return row;
        };
        const double weight = flat_[f].area / total_area_;
        Matrix<6> hessian = Matrix<6>::Zero();
        for (int m = 0; m < 4; ++m) {
            const Vector<6> row = pulled_back(of_triangle.modes[m]);
            hessian.noalias() += (weight * of_triangle.eigenvalues[m]) * row * row.transpose();
        }
        system.add(f, weight * pulled_back(of_triangle.gradient), hessian);
    }

    const SurfaceMesh& mesh_;
    ChartVertices vertices_;
    const LayoutMapOptions& options_;
    std::vector<std::array<int, 3>> triangles_;
    std::vector<FlatTriangle> flat_;
    // Wanted lengths of a cell in the directions of a face's chart, times cell_size_.
    std::vector<Vector2> lengths_;
    std::vector<std::array<int, 2>> unknowns_;
    int n_unknowns_ = 0;
    double total_area_ = 0.0;
    double cell_size_ = 1.0;
    bool is_fitted_ = false;
};

/// Faces of each quad.
std::vector<std::vector<FaceHandle>> faces_of_quads(const SurfaceMesh& mesh,
                                                    const EmbeddedLayout& embedding) {
    std::vector<std::vector<FaceHandle>> faces(embedding.layout.n_quads());
    for (const FaceHandle face : mesh.faces()) {
        faces[embedding.quad_of_face[face.idx()]].push_back(face);
    }
    return faces;
}

/// The harmonic map of a quad to its chart, for each vertex of the piece.
std::vector<Vector2> map_quad(CutSurface& piece, const EmbeddedLayout& embedding,
                              const LayoutCharts& charts, int quad) {
    std::array<int, 4> corners{-1, -1, -1, -1};
    for (int v = 0; v < piece.n_vertices(); ++v) {
        for (int k = 0; k < 4; ++k) {
            const VertexHandle node = embedding.nodes[embedding.layout.quads()[quad][k]];
            if (piece.parent(v) == node.idx()) corners[k] = v;
        }
    }
    const auto [n_s, n_t] = charts.size(quad);
    try {
        HarmonicMap map = map_disc_to_polygon(piece, corners, rectangle_corners(n_s, n_t));
        if (!piece.splits().empty()) {
            throw InputError("{} edges join vertices of arcs; split them (split_layout_chords)",
                             piece.splits().size());
        }
        return std::move(map.parameters);
    } catch (const Error& error) {
        throw GeometryError("make_layout_map: quad of nodes {}: {}",
                            embedding.layout.quad_name(quad), error.what());
    }
}

/// All quads mapped on their own: one point per vertex, in its own chart.
std::vector<Vector2> harmonic_start(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                                    const LayoutCharts& charts, const ChartVertices& vertices) {
    std::vector<bool> is_seam(mesh.n_edges(), false);
    const std::vector<int> arcs = arcs_of_edges(mesh, embedding);
    for (std::size_t e = 0; e < arcs.size(); ++e) is_seam[e] = arcs[e] >= 0;
    const auto faces = faces_of_quads(mesh, embedding);
    std::vector<Vector2> x(mesh.n_vertices(), Vector2::Zero());
    for (int q = 0; q < embedding.layout.n_quads(); ++q) {
        if (faces[q].empty()) {
            throw TopologyError(
                "EmbeddedLayout: the quad of nodes {} has no face; each quad is a disc of faces",
                embedding.layout.quad_name(q));
        }
        CutSurface piece(mesh, faces[q], is_seam);
        const std::vector<Vector2> parameters = map_quad(piece, embedding, charts, q);
        for (int v = 0; v < piece.n_vertices(); ++v) {
            const int vertex = piece.parent(v);
            if (vertices.chart(vertex) == q) x[vertex] = rounded(parameters[v]);
        }
    }
    return x;
}

/// x + t d as far as it lowers the energy and flips nothing; false if no t does.
bool search_line(const MapEnergy& energy, const std::vector<Vector2>& d, double slope, double t,
                 double start, std::vector<Vector2>& x) {
    constexpr double sufficient = 1e-4;
    constexpr int max_halvings = 40;
    std::vector<Vector2> moved(x.size());
    for (int i = 0; i < max_halvings; ++i, t *= 0.5) {
        for (std::size_t v = 0; v < x.size(); ++v) moved[v] = rounded(x[v] + t * d[v]);
        if (energy.value(moved) <= start + sufficient * t * slope && energy.n_flipped(moved) == 0) {
            x = std::move(moved);
            return true;
        }
    }
    return false;
}

void minimise(MapEnergy& energy, const LayoutMapOptions& options, std::vector<Vector2>& x,
              LayoutMapReport& report) {
    NewtonSystem system = energy.make_system();
    for (int i = 0; i < options.max_iterations; ++i) {
        energy.assemble(x, system);
        const VectorX step = system.step();
        const double slope = system.gradient().dot(step);
        const auto [d, largest] = energy.spread(x, step);
        constexpr double cap = 0.8;
        const double start = energy.value(x);
        if (!search_line(energy, d, slope, std::min(1.0, cap * largest), start, x)) {
            // Nothing but rounding is left, or no descent.
            report.is_converged = -slope < options.tolerance * start;
            return;
        }
        energy.fit_cell_size(x);
        report.energies.push_back(energy.value(x));
        if (start - report.energies.back() < options.tolerance * start) {
            report.is_converged = true;
            return;
        }
    }
}

/// Least squares for one size of cells after the other.
void minimise_squares(MapEnergy& energy, const LayoutMapOptions& options, std::vector<Vector2>& x,
                      LayoutMapReport& report) {
    NewtonSystem system = energy.make_system();
    for (int i = 0; i < options.max_iterations && !report.is_converged; ++i) {
        energy.assemble(x, system);
        const std::vector<Vector2> d = energy.spread(x, system.step()).first;
        for (std::size_t v = 0; v < x.size(); ++v) x[v] = rounded(x[v] + d[v]);
        energy.fit_cell_size(x);
        const double before = report.energies.back();
        report.energies.push_back(energy.value(x));
        report.is_converged = before - report.energies.back() < options.tolerance * before;
    }
}

void check_options(const SurfaceMesh& mesh, const QuadLayout& layout,
                   const LayoutMapOptions& options) {
    const std::vector<int> sheets = layout.sheets();
    const std::size_t n_sheets =
        sheets.empty() ? 0 : *std::max_element(sheets.begin(), sheets.end()) + 1;
    const auto& lengths = options.cell_lengths;
    if (!lengths.empty() && lengths.size() != n_sheets) {
        throw InputError("make_layout_map: {} lengths of cells for {} sheets; give one for each",
                         lengths.size(), n_sheets);
    }
    for (std::size_t s = 0; s < lengths.size(); ++s) {
        if (!(lengths[s] > 0.0 && std::isfinite(lengths[s]))) {
            throw InputError(
                "make_layout_map: the cells of sheet {} have length {}; it must be positive", s,
                lengths[s]);
        }
    }
    if (options.route == LayoutMapRoute::quadratic && !options.directions) {
        throw InputError("make_layout_map: the quadratic route needs directions; there are none");
    }
    if (options.directions && options.directions->angles.size() != mesh.n_faces()) {
        throw InputError("make_layout_map: {} directions for {} faces; give one for each",
                         options.directions->angles.size(), mesh.n_faces());
    }
    if (!(options.alignment_weight >= 0.0)) {
        throw InputError("make_layout_map: alignment weight {}; it must not be negative",
                         options.alignment_weight);
    }
}

}  // namespace

int split_layout_chords(SurfaceMesh& mesh, EmbeddedLayout& embedding) {
    const std::vector<LayoutPlace> places = layout_places(mesh, embedding);
    const std::vector<int> arcs = arcs_of_edges(mesh, embedding);
    const auto is_on_arc = [&](VertexHandle v) {
        return places[v.idx()].node >= 0 || places[v.idx()].arc >= 0;
    };
    int n_splits = 0;
    for (int e = 0; e < static_cast<int>(arcs.size()); ++e) {
        const HalfedgeHandle halfedge = mesh.halfedge_handle(EdgeHandle(e), 0);
        if (arcs[e] >= 0 || mesh.is_boundary(EdgeHandle(e)) ||
            !is_on_arc(mesh.from_vertex_handle(halfedge)) ||
            !is_on_arc(mesh.to_vertex_handle(halfedge))) {
            continue;
        }
        const int quad = embedding.quad_of_face[mesh.face_handle(halfedge).idx()];
        split_edge(mesh, halfedge);
        embedding.quad_of_face.resize(mesh.n_faces(), quad);
        ++n_splits;
    }
    return n_splits;
}

LayoutMap make_layout_map(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                          std::vector<int> cells, const LayoutMapOptions& options) {
    check_options(mesh, embedding.layout, options);
    LayoutMap map{LayoutCharts(embedding.layout, std::move(cells)), {}, {}};
    MapEnergy energy(mesh, embedding, map.charts, options);
    std::vector<Vector2> x = harmonic_start(mesh, embedding, map.charts, energy.vertices());
    const int n_flipped = energy.n_flipped(x);
    if (n_flipped > 0) {
        throw GeometryError(
            "make_layout_map: rounding flips {} triangles of the harmonic maps; their shapes are "
            "too thin: remesh the surface or move the arcs",
            n_flipped);
    }
    energy.fit_cell_size(x);
    map.report.energies.push_back(energy.value(x));
    if (options.route == LayoutMapRoute::quadratic)
        minimise_squares(energy, options, x, map.report);
    if (options.route == LayoutMapRoute::aligned) minimise(energy, options, x, map.report);
    map.report.n_flipped = energy.n_flipped(x);
    map.report.cell_size = energy.cell_size();
    map.report.distortion = energy.distortion(x);
    map.report.mean_angle_to_directions = energy.mean_angle_to_directions(x);
    for (int f = 0; f < energy.n_faces(); ++f) map.corners.push_back(energy.corners(x, f));
    return map;
}

}  // namespace couture::meshing
