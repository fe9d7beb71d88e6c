#include "io/snapshot_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "iga/core/error.h"
#include "iga/core/text_hash.h"
#include "io/atomic_file.h"
#include "io/hdf5_file.h"
#include "io/spline_file.h"

namespace couture::io {

namespace {

namespace fs = std::filesystem;

constexpr const char* kind = "snapshot";
constexpr int version = 1;
constexpr const char* plan_name = "plan.json";
constexpr const char* added_name = "added_points.json";
constexpr const char* failed = ".failed";

std::string geometry_name(int i_geometry) { return fmt::format("geometry_{:04}", i_geometry); }

std::string solution_name(int i_geometry, int i_material) {
    return fmt::format("solution_{:04}_{:02}", i_geometry, i_material);
}

bool has_snapshots(const fs::path& folder) {
    return std::any_of(fs::directory_iterator(folder), fs::directory_iterator(),
                       [](const auto& entry) {
                           const std::string name = entry.path().filename().string();
                           return name.starts_with("geometry_") || name.starts_with("solution_");
                       });
}

// The first entry in which two jobs differ.
std::string difference(const std::string& mine, const std::string& theirs) {
    const auto a = nlohmann::json::parse(mine, nullptr, false);
    const auto b = nlohmann::json::parse(theirs, nullptr, false);
    if (!a.is_object() || !b.is_object()) return "it can't be read";
    for (const auto& [key, value] : a.items()) {
        if (!b.contains(key) || b[key] != value) return fmt::format("'{}' differs", key);
    }
    return "it has more entries";
}

}  // namespace

SnapshotStore::SnapshotStore(fs::path folder, std::string job)
    : folder_(std::move(folder)), job_(std::move(job)), job_hash_(text_hash(job_)) {
    const fs::path plan = file(plan_name);
    const std::string found = fs::exists(plan) ? read_text(plan) : std::string();
    if (found == job_) return;
    if (!found.empty() && has_snapshots(folder_)) {
        throw InputError(
            "{}: the snapshots there are of another job: {}; take the deck and settings that made "
            "them, or another folder (--out); or remove {} if they are of no use any more",
            plan.string(), difference(job_, found), folder_.string());
    }
    // A plan of which no snapshot was made stands in nobody's way.
    fs::remove(reference_file());
    fs::remove(record_file());
    write_text(plan, job_);
}

fs::path SnapshotStore::file(const std::string& name) const { return folder_ / name; }
fs::path SnapshotStore::record_file() const { return file("reference_layout.json"); }
fs::path SnapshotStore::reference_file() const { return file("reference.h5"); }

std::optional<iga::MultiPatch<3>> SnapshotStore::reference() const {
    if (!fs::exists(reference_file())) return {};
    auto splines = read_splines(reference_file());
    auto* volume = std::get_if<iga::MultiPatch<3>>(&splines.multipatch);
    if (volume == nullptr) {
        throw FileError("{}: holds surfaces; expected the reference member's volume",
                        reference_file().string());
    }
    return std::move(*volume);
}

void SnapshotStore::write_reference(const iga::MultiPatch<3>& reference) {
    write_splines(reference_file(), reference);
}

void SnapshotStore::take_reference(const SnapshotStore& other) {
    for (const auto& [from, to] : {std::pair(other.record_file(), record_file()),
                                   std::pair(other.reference_file(), reference_file())}) {
        if (fs::exists(from) && !fs::exists(to)) write_text(to, read_text(from));
    }
}

bool SnapshotStore::has_geometry(int i_geometry) const {
    return fs::exists(file(geometry_name(i_geometry) + ".h5"));
}

bool SnapshotStore::has_solution(int i_geometry, int i_material) const {
    return fs::exists(file(solution_name(i_geometry, i_material) + ".h5"));
}

namespace {

// A file that can't be read is named with the way out.
template <typename Read>
MatrixX with_way_out(const Read& read) {
    try {
        return read();
    } catch (const FileError& error) {
        throw FileError("{}. Remove the file, it will be made again", error.what());
    }
}

}  // namespace

MatrixX SnapshotStore::geometry(int i_geometry, const std::string& signature) const {
    return with_way_out([&] { return read_matrix(geometry_name(i_geometry), signature); });
}

MatrixX SnapshotStore::solution(int i_geometry, int i_material,
                                const std::string& signature) const {
    return with_way_out(
        [&] { return read_matrix(solution_name(i_geometry, i_material), signature); });
}

void SnapshotStore::write_geometry(int i_geometry, const MatrixX& control_points,
                                   const std::string& signature) {
    write_matrix(geometry_name(i_geometry), control_points, signature);
}

void SnapshotStore::write_solution(int i_geometry, int i_material, const MatrixX& displacements,
                                   const std::string& signature) {
    write_matrix(solution_name(i_geometry, i_material), displacements, signature);
}

MatrixX SnapshotStore::read_matrix(const std::string& name, const std::string& signature) const {
    const fs::path path = file(name + ".h5");
    const std::string bytes = read_text(path);
    std::string content(unpack_hdf5(path.string(), bytes, kind, version));
    const Handle store = open_image(path.string(), content);
    const Source source{path.string(), bytes.size()};
    const Handle root(H5Gopen2(store, "/", H5P_DEFAULT), H5Gclose, path.string());
    const std::string job = source.text(root, "job");
    const std::string found = source.text(root, "signature");
    if (job != job_hash_ || found != signature) {
        throw InputError(
            "{}: of job {} and signature {}; this model has {} and {}. Remove the "
            "file, it will be made again",
            path.string(), job, found, job_hash_, signature);
    }
    std::vector<hsize_t> shape;
    const std::vector<double> values = source.doubles(root, "values", 2, shape);
    return Eigen::Map<const MatrixX>(values.data(), static_cast<Eigen::Index>(shape[1]),
                                     static_cast<Eigen::Index>(shape[0]));
}

void SnapshotStore::write_matrix(const std::string& name, const MatrixX& values,
                                 const std::string& signature) {
    std::string content;
    {
        const Handle store = make_image();
        write_attribute(store, "job", job_hash_);
        write_attribute(store, "signature", signature);
        write_doubles(store, "values",
                      {static_cast<hsize_t>(values.cols()), static_cast<hsize_t>(values.rows())},
                      values.data());
        content = image_of(store);
    }
    write_text(file(name + ".h5"), pack_hdf5(kind, version, content));
}

MatrixX SnapshotStore::added_points(int n_parameters) const {
    const fs::path path = file(added_name);
    if (!fs::exists(path)) return MatrixX::Zero(0, n_parameters);
    const auto rows = nlohmann::json::parse(read_text(path), nullptr, false);
    if (!rows.is_array()) {
        throw FileError("{}: is no list of points, or was cut; remove it to go on without them",
                        path.string());
    }
    MatrixX points(static_cast<Eigen::Index>(rows.size()), n_parameters);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const auto& row = rows[i];
        if (!row.is_array() || static_cast<int>(row.size()) != n_parameters) {
            throw FileError("{}: row {} does not hold {} numbers", path.string(), i, n_parameters);
        }
        for (int k = 0; k < n_parameters; ++k) points(i, k) = row[k].get<double>();
    }
    return points;
}

void SnapshotStore::write_added_points(const MatrixX& points) {
    auto rows = nlohmann::json::array();
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const VectorX row = points.row(i);
        rows.push_back(std::vector<double>(row.begin(), row.end()));
    }
    write_text(file(added_name), rows.dump(1) + "\n");
}

std::optional<std::string> SnapshotStore::failure(const std::string& name) const {
    const fs::path path = file(name + failed);
    if (!fs::exists(path)) return {};
    return read_text(path);
}

std::optional<std::string> SnapshotStore::geometry_failure(int i_geometry) const {
    return failure(geometry_name(i_geometry));
}

std::optional<std::string> SnapshotStore::solution_failure(int i_geometry, int i_material) const {
    return failure(solution_name(i_geometry, i_material));
}

void SnapshotStore::write_geometry_failure(int i_geometry, const std::string& reason) {
    write_text(file(geometry_name(i_geometry) + failed), reason);
}

void SnapshotStore::write_solution_failure(int i_geometry, int i_material,
                                           const std::string& reason) {
    write_text(file(solution_name(i_geometry, i_material) + failed), reason);
}

void SnapshotStore::clear_failures() {
    std::vector<fs::path> old;
    for (const auto& entry : fs::directory_iterator(folder_)) {
        if (entry.path().extension() == failed) old.push_back(entry.path());
    }
    for (const fs::path& path : old) fs::remove(path);
}

void SnapshotStore::note_time(const std::string& what, double seconds) const {
    // One short write to a file that is only added to: processes do not mix lines.
    std::ofstream(file("timings.csv"), std::ios::app) << fmt::format("{},{:.3f}\n", what, seconds);
}

int SnapshotStore::merge(const SnapshotStore& other) {
    if (other.job_ != job_) {
        throw InputError("{}: its snapshots are of another job than those of {}: {}",
                         other.folder_.string(), folder_.string(), difference(job_, other.job_));
    }
    int n_files = 0;
    for (const auto& entry : fs::directory_iterator(other.folder_)) {
        const fs::path name = entry.path().filename();
        const bool is_store = name.extension() == ".h5" || name.extension() == failed ||
                              name == record_file().filename();
        if (!is_store || fs::exists(file(name.string()))) continue;
        // What failed there may be done here.
        if (name.extension() == failed && fs::exists(file(name.stem().string() + ".h5"))) continue;
        write_text(file(name.string()), read_text(entry.path()));
        if (name.extension() == ".h5") fs::remove(file(name.stem().string() + failed));
        ++n_files;
    }
    return n_files;
}

}  // namespace couture::io
