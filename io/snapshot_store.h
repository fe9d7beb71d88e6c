#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "iga/topology/multipatch.h"

namespace couture::io {

/// The solutions that a reduced model is learned from, in a folder; each file appears whole or not
/// at all and holds nothing that depends on when or by whom it was made, so that any number of
/// processes may fill one store, and a store is the same however the work was split.
///
///   plan.json               the job: what all of it depends on, and its points
///   reference.h5            splines of the reference member (io/hdf5_store.h)
///   reference_layout.json   its decisions, of members that are meshed
///   geometry_0003.h5        control points of geometry 3, n_nodes x 3
///   solution_0003_01.h5     displacements of geometry 3 with material 1, 3 n_nodes x n_loads
///   geometry_0003.failed, solution_0003_01.failed    why there is none
///   added_points.json       geometries that were added to the design, numbered after its own
///   timings.csv             what was made when, by the clock; beside the point of the rest
///
/// Matrices are packed HDF5 as spline files are, "Couture snapshot 1": data set /values (columns x
/// rows), attributes job and signature.
class SnapshotStore {
  public:
    /// Opens a store, or makes it.
    ///
    /// @param job  JSON, equal for equal work; its hash stands in every file
    /// @throws FileError   if it can't be made or read
    /// @throws InputError  if the folder holds another job's: says what differs
    SnapshotStore(std::filesystem::path folder, std::string job);

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    [[nodiscard]] const std::string& job() const { return job_; }
    [[nodiscard]] std::filesystem::path record_file() const;
    [[nodiscard]] std::filesystem::path reference_file() const;

    /// @throws FileError  if it is damaged
    [[nodiscard]] std::optional<iga::MultiPatch<3>> reference() const;
    void write_reference(const iga::MultiPatch<3>& reference);
    /// Takes over another store's reference and its decisions, unless there are some.
    void take_reference(const SnapshotStore& other);

    [[nodiscard]] bool has_geometry(int i_geometry) const;
    [[nodiscard]] bool has_solution(int i_geometry, int i_material) const;
    /// @throws FileError   if it is missing or damaged
    /// @throws InputError  if it is of another job or signature
    [[nodiscard]] MatrixX geometry(int i_geometry, const std::string& signature) const;
    [[nodiscard]] MatrixX solution(int i_geometry, int i_material,
                                   const std::string& signature) const;
    /// @throws FileError  if it can't be written; what was there stays
    void write_geometry(int i_geometry, const MatrixX& control_points,
                        const std::string& signature);
    void write_solution(int i_geometry, int i_material, const MatrixX& displacements,
                        const std::string& signature);

    /// Geometries beside those of the design, in the unit cube, n x parameters; in
    /// added_points.json.
    /// @throws FileError  if it can't be read as such
    [[nodiscard]] MatrixX added_points(int n_parameters) const;
    void write_added_points(const MatrixX& points);

    /// Why a sample was refused; nothing if it was not.
    [[nodiscard]] std::optional<std::string> geometry_failure(int i_geometry) const;
    [[nodiscard]] std::optional<std::string> solution_failure(int i_geometry, int i_material) const;
    void write_geometry_failure(int i_geometry, const std::string& reason);
    void write_solution_failure(int i_geometry, int i_material, const std::string& reason);
    /// Forgets all failures, so that they are tried again.
    void clear_failures();

    /// Appends a line to timings.csv.
    void note_time(const std::string& what, double seconds) const;

    /// Takes over what another store of the same job has and this one lacks.
    ///
    /// @return the number of files
    /// @throws InputError  if it is of another job
    int merge(const SnapshotStore& other);

  private:
    [[nodiscard]] std::filesystem::path file(const std::string& name) const;
    [[nodiscard]] MatrixX read_matrix(const std::string& name, const std::string& signature) const;
    void write_matrix(const std::string& name, const MatrixX& values, const std::string& signature);
    [[nodiscard]] std::optional<std::string> failure(const std::string& name) const;

    std::filesystem::path folder_;
    std::string job_;
    std::string job_hash_;
};

}  // namespace couture::io
