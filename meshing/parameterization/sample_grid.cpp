#include "meshing/parameterization/sample_grid.h"

#include "meshing/parameterization/layout_charts.h"

namespace couture::meshing {

SampleGrid make_sample_grid(const QuadLayout& layout, const std::vector<int>& cells) {
    const LayoutCharts charts(layout, cells);
    SampleGrid grid;
    grid.n_points = layout.n_nodes();
    for (int a = 0; a < layout.n_arcs(); ++a) {
        auto& arc = grid.arcs.emplace_back();
        arc.push_back(layout.arcs()[a].from);
        for (int i = 1; i < cells[a]; ++i) arc.push_back(grid.n_points++);
        arc.push_back(layout.arcs()[a].to);
    }
    for (int q = 0; q < layout.n_quads(); ++q) {
        const auto [n_s, n_t] = grid.sizes.emplace_back(charts.size(q));
        auto& numbers = grid.quads.emplace_back((n_s + 1) * (n_t + 1), -1);
        for (int k = 0; k < 4; ++k) {
            const QuadLayout::Side side = layout.sides(q)[k];
            const int n = cells[side.arc];
            const Vector2 start = charts.corner(q, k);
            const Vector2 step = turned({1.0, 0.0}, k);
            for (int i = 0; i <= n; ++i) {
                const Vector2 at = start + i * step;
                numbers[static_cast<int>(at.y()) * (n_s + 1) + static_cast<int>(at.x())] =
                    grid.arcs[side.arc][side.is_forward ? i : n - i];
            }
        }
        for (int& number : numbers) {
            if (number < 0) number = grid.n_points++;
        }
    }
    return grid;
}

MatrixX to_points(const LayoutSamples& samples, const SampleGrid& grid) {
    MatrixX points(3, grid.n_points);
    for (std::size_t a = 0; a < grid.arcs.size(); ++a) {
        for (std::size_t i = 0; i < grid.arcs[a].size(); ++i) {
            points.col(grid.arcs[a][i]) = samples.arcs[a].col(static_cast<int>(i));
        }
    }
    for (std::size_t q = 0; q < grid.quads.size(); ++q) {
        for (std::size_t i = 0; i < grid.quads[q].size(); ++i) {
            points.col(grid.quads[q][i]) = samples.quads[q].col(static_cast<int>(i));
        }
    }
    return points;
}

LayoutSamples to_samples(const EmbeddedLayout& embedding, std::vector<int> cells,
                         const SampleGrid& grid, const MatrixX& points) {
    LayoutSamples samples;
    samples.layout = embedding.layout;
    samples.n_cells = std::move(cells);
    samples.is_feature_arc = embedding.is_feature_arc;
    for (const auto& arc : grid.arcs) samples.arcs.emplace_back(points(Eigen::all, arc));
    for (const auto& quad : grid.quads) samples.quads.emplace_back(points(Eigen::all, quad));
    return samples;
}

QuadMesh to_quad_mesh(const LayoutSamples& samples) {
    const SampleGrid grid = make_sample_grid(samples.layout, samples.n_cells);
    const MatrixX points = to_points(samples, grid);
    QuadMesh mesh;
    // Nodes on no quad lie inside a volume.
    std::vector<int> number(grid.n_points, -1);
    const auto number_of = [&](int point) {
        if (number[point] < 0) {
            number[point] = static_cast<int>(mesh.points.size());
            mesh.points.emplace_back(points.col(point));
        }
        return number[point];
    };
    for (std::size_t q = 0; q < grid.quads.size(); ++q) {
        const auto [n_s, n_t] = grid.sizes[q];
        for (int j = 0; j < n_t; ++j) {
            for (int i = 0; i < n_s; ++i) {
                const int at = j * (n_s + 1) + i;
                const auto& numbers = grid.quads[q];
                mesh.quads.push_back({number_of(numbers[at]), number_of(numbers[at + 1]),
                                      number_of(numbers[at + n_s + 2]),
                                      number_of(numbers[at + n_s + 1])});
            }
        }
    }
    return mesh;
}

}  // namespace couture::meshing
