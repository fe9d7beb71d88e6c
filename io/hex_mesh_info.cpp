#include "io/hex_mesh_info.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "iga/spline/shapes.h"

namespace couture::io {

namespace {

using Json = nlohmann::ordered_json;

iga::MultiPatch<3> elements_of(const meshing::PlacedLayout& mesh) {
    iga::MultiPatch<3> elements;
    for (const auto& nodes : mesh.layout.cuboids) {
        MatrixX corners(8, 3);
        for (int k = 0; k < 8; ++k) corners.row(k) = mesh.positions[nodes[k]].transpose();
        elements.patches.push_back(iga::make_multilinear<3>(corners));
    }
    return elements;
}

/// JSON has no infinity.
Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json to_json(const meshing::PlacedLayout& mesh) {
    const iga::MultiPatch<3> elements = elements_of(mesh);
    const meshing::QuadLayout boundary = meshing::layout_boundary(mesh.layout).layout;
    const double volume = iga::volume(elements);
    const MatrixX box = elements.bounding_box();
    const iga::QualitySummary<3> quality = iga::element_quality(elements);
    return {
        {"hexahedra", mesh.layout.n_cuboids()},
        {"points", mesh.layout.n_nodes},
        {"boundary_quads", boundary.n_quads()},
        {"boundary_euler_characteristic", boundary.euler_characteristic()},
        {"bounding_box",
         {{"low", {box(0, 0), box(1, 0), box(2, 0)}}, {"high", {box(0, 1), box(1, 1), box(2, 1)}}}},
        {"volume", volume},
        {"mean_edge", std::cbrt(volume / mesh.layout.n_cuboids())},
        {"min_scaled_jacobian", quality.min_scaled_jacobian},
        {"worst_hexahedron", quality.worst_patch},
        {"min_scaled_jacobian_at_corners", quality.min_at_corners},
        {"min_scaled_jacobian_at_gauss_points", quality.min_at_gauss_points},
        {"mean_scaled_jacobian", quality.mean_scaled_jacobian},
        {"max_shape_ratio", finite_or_null(quality.max_shape_ratio)},
        {"mean_shape_ratio", finite_or_null(quality.mean_shape_ratio)},
        {"max_angle_deviation", quality.max_angle_deviation},
        {"mean_angle_deviation", quality.mean_angle_deviation}};
}

/// "1.73205"; what JSON has no number for is infinite.
std::string number(const Json& value) {
    return value.is_null() ? "infinite" : fmt::format("{:.6g}", value.get<double>());
}

std::string point(const Json& x) {
    return fmt::format("({}, {}, {})", number(x[0]), number(x[1]), number(x[2]));
}

}  // namespace

bool is_hex_mesh_file(const std::filesystem::path& path) {
    if (path.extension() == ".vtk") return true;
    if (path.extension() != ".mesh") return false;
    std::ifstream file(path);
    std::string word;
    return file >> word && word.starts_with("MeshVersionFormatted");
}

iga::QualitySummary<3> hex_quality(const meshing::PlacedLayout& mesh) {
    return iga::element_quality(elements_of(mesh));
}

std::string hex_mesh_info_json(const meshing::PlacedLayout& mesh) { return to_json(mesh).dump(2); }

std::string hex_mesh_info_text(const std::string& name, const meshing::PlacedLayout& mesh) {
    const Json info = to_json(mesh);
    return fmt::format(
        "{}: {} hexahedra, {} points; boundary of {} quads, Euler characteristic {}\n"
        "bounding box: {} to {}\n"
        "volume: {:.12g}; edge of a cube as large as the mean hexahedron: {}\n"
        "scaled Jacobian: smallest {} (hexahedron {}), at corners {}, at Gauss points {}, mean {}\n"
        "shape ratio: largest {}, mean {}\n"
        "angle deviation: largest {}, mean {}",
        name, info["hexahedra"].get<int>(), info["points"].get<int>(),
        info["boundary_quads"].get<int>(), info["boundary_euler_characteristic"].get<int>(),
        point(info["bounding_box"]["low"]), point(info["bounding_box"]["high"]),
        info["volume"].get<double>(), number(info["mean_edge"]),
        number(info["min_scaled_jacobian"]), info["worst_hexahedron"].get<int>(),
        number(info["min_scaled_jacobian_at_corners"]),
        number(info["min_scaled_jacobian_at_gauss_points"]), number(info["mean_scaled_jacobian"]),
        number(info["max_shape_ratio"]), number(info["mean_shape_ratio"]),
        number(info["max_angle_deviation"]), number(info["mean_angle_deviation"]));
}

}  // namespace couture::io
