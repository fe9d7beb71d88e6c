#include "drivers/shape_population.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "iga/core/error.h"
#include "iga/core/text_hash.h"
#include "iga/topology/dof_map.h"
#include "io/atomic_file.h"
#include "io/spline_file.h"
#include "io/surface_reader.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;

struct ReadShape {
    ShapeConnectivity connectivity;
    MatrixX points;
};

/// Takes points off that no polygon has (of lines in the same file).
void drop_unused(io::RawSurface& surface) {
    std::vector<int> numbers(surface.points.size(), -1);
    for (const int corner : surface.corners) numbers[corner] = 0;
    std::vector<Vector3> points;
    for (std::size_t v = 0; v < numbers.size(); ++v) {
        if (numbers[v] < 0) continue;
        numbers[v] = static_cast<int>(points.size());
        points.push_back(surface.points[v]);
    }
    surface.points = std::move(points);
    for (int& corner : surface.corners) corner = numbers[corner];
}

std::string kind_of(const io::RawSurface& surface) {
    const auto all_have = [&](std::size_t n) {
        for (std::size_t i = 0; i < surface.n_polygons(); ++i) {
            if (surface.polygon(i).size() != n) return false;
        }
        return true;
    };
    return all_have(4) ? "quad mesh" : all_have(3) ? "triangle mesh" : "polygon mesh";
}

ReadShape read_mesh(const fs::path& file) {
    if (io::lower_case(file.extension().string()) == ".stl") {
        throw InputError(
            "shape: {}: the triangles of STL files share no points, so members can't be compared; "
            "give them as .ply, .obj, .off or .vtp with equal numbering",
            file.string());
    }
    ReadShape shape;
    io::RawSurface& surface = shape.connectivity.polygons;
    surface = io::read_polygons(file);
    drop_unused(surface);
    shape.connectivity.kind = kind_of(surface);
    shape.connectivity.n_points = static_cast<int>(surface.points.size());
    shape.connectivity.signature =
        text_hash(fmt::format("{} {} {}", surface.points.size(), fmt::join(surface.first, ","),
                              fmt::join(surface.corners, ",")));
    shape.points.resize(shape.connectivity.n_points, 3);
    for (Eigen::Index v = 0; v < shape.points.rows(); ++v) {
        shape.points.row(v) = surface.points[v].transpose();
    }
    return shape;
}

ReadShape read_volume(const fs::path& file) {
    const io::AnyMultiPatch splines = io::read_splines(file).multipatch;
    const auto* volume = std::get_if<iga::MultiPatch<3>>(&splines);
    if (volume == nullptr) {
        throw InputError("shape: {}: holds surfaces; members are volumes, or meshes of polygons",
                         file.string());
    }
    ReadShape shape;
    ShapeConnectivity& connectivity = shape.connectivity;
    std::vector<iga::TensorSpace<3>> spaces;
    for (const iga::Volume& patch : volume->patches) spaces.push_back(patch.space());
    const iga::DofMap map = iga::make_dof_map(*volume, spaces);
    connectivity.kind = "volume";
    connectivity.signature = iga::signature(*volume);
    connectivity.n_points = map.n_dofs;
    connectivity.numbers = map.global;
    connectivity.volume = *volume;
    shape.points.resize(map.n_dofs, 3);
    for (int i = volume->n_patches() - 1; i >= 0; --i) {
        const MatrixX& points = volume->patches[i].control_points();
        for (Eigen::Index k = points.rows() - 1; k >= 0; --k) {
            shape.points.row(map.global[i][k]) = points.row(k);
        }
    }
    return shape;
}

ReadShape read_shape(const fs::path& file) {
    if (io::is_surface_file(file)) return read_mesh(file);
    if (io::is_spline_file(file)) return read_volume(file);
    throw InputError(
        "shape: {}: is neither a mesh of polygons (.vtp, .obj, .off, .ply) nor a spline volume "
        "(.xml, .mesh, .txt, .inp, .h5)",
        file.string());
}

constexpr const char* rule = "members of a population must be isotopological";

void check_meshes(const io::RawSurface& first, const std::string& first_file,
                  const io::RawSurface& second, const std::string& file) {
    if (first.points.size() != second.points.size() || first.n_polygons() != second.n_polygons()) {
        throw InputError("shape: {}: {} points and {} polygons; {} has {} and {}; {}", file,
                         second.points.size(), second.n_polygons(), first_file, first.points.size(),
                         first.n_polygons(), rule);
    }
    for (std::size_t i = 0; i < first.n_polygons(); ++i) {
        if (std::ranges::equal(first.polygon(i), second.polygon(i))) continue;
        throw InputError("shape: {}: polygon {} has the points {}; in {} it has {}; {}", file, i,
                         fmt::join(second.polygon(i), " "), first_file,
                         fmt::join(first.polygon(i), " "), rule);
    }
}

void check_volumes(const ShapeConnectivity& first, const std::string& first_file,
                   const ShapeConnectivity& second, const std::string& file) {
    if (first.signature != second.signature) {
        throw InputError("shape: {}: signature {}, that of {} is {}; {}", file, second.signature,
                         first_file, first.signature, rule);
    }
    if (first.numbers != second.numbers) {
        throw InputError(
            "shape: {}: other control points coincide than in {} (a side or edge is collapsed); {}",
            file, first_file, rule);
    }
    constexpr double tolerance = 1e-9;
    for (int i = 0; i < first.volume->n_patches(); ++i) {
        const VectorX& a = first.volume->patches[i].weights();
        const VectorX& b = second.volume->patches[i].weights();
        if (a.size() == b.size() && (a.size() == 0 || a.isApprox(b, tolerance))) continue;
        throw InputError(
            "shape: {}: the weights of patch {} are not those of {}; members are compared by "
            "their control points, so weights must be equal",
            file, i, first_file);
    }
}

void check_equal(const ShapeConnectivity& first, const fs::path& first_file,
                 const ShapeConnectivity& second, const fs::path& file) {
    if (first.kind != second.kind) {
        throw InputError("shape: {}: is a {}, {} a {}; {}", file.string(), second.kind,
                         first_file.string(), first.kind, rule);
    }
    if (first.volume) {
        check_volumes(first, first_file.string(), second, file.string());
    } else {
        check_meshes(first.polygons, first_file.string(), second.polygons, file.string());
    }
}

/// Names of a family's members and their files, the reference first.
std::vector<ShapeMember> family_files(const fs::path& folder) {
    std::vector<fs::path> lists;
    constexpr std::string_view ending = "_members.json";
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().filename().string().ends_with(ending)) lists.push_back(entry.path());
    }
    if (lists.size() != 1) {
        throw InputError(
            "shape: {}: {} files NAME_members.json; the folder of a family's run (couture mesh "
            "FAMILY.toml) has one. Other members are given as files",
            folder.string(), lists.empty() ? "no" : std::to_string(lists.size()));
    }
    std::vector<ShapeMember> members;
    try {
        const auto list = nlohmann::json::parse(io::read_text(lists[0]));
        for (const auto& member : list.at("members")) {
            if (member.at("status") != "done") continue;
            const std::string name = member.at("name");
            members.push_back({name, folder / (name + "_volume.xml"), {}});
        }
    } catch (const nlohmann::json::exception& error) {
        throw FileError("{}: is no list of the members of a family: {}", lists[0].string(),
                        error.what());
    }
    return members;
}

/// The folder of a family, if that is what was given.
std::optional<fs::path> family_folder(const std::vector<std::string>& inputs) {
    if (inputs.size() != 1) return {};
    const fs::path input = inputs[0];
    if (fs::is_directory(input)) return input;
    if (input.extension() != ".toml") return {};
    if (!fs::exists(input)) throw FileError("{}: no such deck", input.string());
    const fs::path folder = fs::path("out") / input.stem();
    if (!fs::is_directory(folder)) {
        throw FileError(
            "shape: {}: no results of this family in {}; make them first by couture mesh {}, or "
            "give the folder where they are",
            input.string(), folder.string(), input.string());
    }
    return folder;
}

/// File names without ending, or whole where these are not unique.
std::vector<ShapeMember> named_files(const std::vector<std::string>& inputs) {
    std::map<std::string, int> uses;
    for (const std::string& input : inputs) ++uses[fs::path(input).stem().string()];
    std::vector<ShapeMember> members;
    for (const std::string& input : inputs) {
        if (std::ranges::count(inputs, input) > 1) {
            throw InputError("shape: {} is given more than once", input);
        }
        if (fs::is_directory(input)) {
            throw InputError("shape: {} is a folder; one folder of a family can be given, or files",
                             input);
        }
        const std::string stem = fs::path(input).stem().string();
        members.push_back({uses[stem] == 1 ? stem : input, input, {}});
    }
    return members;
}

}  // namespace

io::RawSurface ShapeConnectivity::mesh_with(const MatrixX& points) const {
    io::RawSurface mesh = polygons;
    for (Eigen::Index v = 0; v < points.rows(); ++v) mesh.points[v] = points.row(v).transpose();
    return mesh;
}

iga::MultiPatch<3> ShapeConnectivity::volume_with(const MatrixX& points) const {
    iga::MultiPatch<3> result = *volume;
    for (int i = 0; i < result.n_patches(); ++i) {
        iga::Volume& patch = result.patches[i];
        MatrixX own(patch.control_points().rows(), 3);
        for (Eigen::Index k = 0; k < own.rows(); ++k) own.row(k) = points.row(numbers[i][k]);
        patch = iga::Volume(patch.space(), std::move(own), patch.weights());
    }
    return result;
}

ShapePopulation read_shape_population(const std::vector<std::string>& inputs) {
    ShapePopulation population;
    const auto folder = family_folder(inputs);
    population.members = folder ? family_files(*folder) : named_files(inputs);
    if (folder) population.reference = 0;
    for (std::size_t j = 0; j < population.members.size(); ++j) {
        ShapeMember& member = population.members[j];
        ReadShape shape = read_shape(member.file);
        member.points = std::move(shape.points);
        if (j == 0) {
            population.connectivity = std::move(shape.connectivity);
        } else {
            check_equal(population.connectivity, population.members[0].file, shape.connectivity,
                        member.file);
        }
    }
    if (population.members.size() < 2) {
        throw InputError("shape: {} member{}; a population has 2 or more",
                         population.members.size(), population.members.size() == 1 ? "" : "s");
    }
    return population;
}

ShapeMember read_shape_member(const ShapePopulation& population, const fs::path& file) {
    ReadShape shape = read_shape(file);
    check_equal(population.connectivity, population.members[0].file, shape.connectivity, file);
    return {file.stem().string(), file, std::move(shape.points)};
}

}  // namespace couture::drivers
