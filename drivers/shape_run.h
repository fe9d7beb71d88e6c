#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drivers/shape_population.h"
#include "rom/shape_analysis.h"
#include "rom/shape_curves.h"

namespace couture::drivers {

/// A shape that was projected onto the modes of a population.
struct ProjectedShape {
    ShapeMember member;
    rom::ShapeProjection projection;
};

/// A shape that was made of modes.
struct VirtualShape {
    std::string name;
    /// In standard deviations of the modes.
    VectorX scores;
    MatrixX points;
    /// Of volumes; else empty.
    std::string certificate;
};

/// What an analysis of shapes gives.
struct ShapeRun {
    std::string name;
    ShapePopulation population;
    rom::ShapeModel model;
    /// That are written and projected onto.
    int n_modes = 1;
    VectorX compactness;
    /// With 3 members or more.
    std::optional<rom::ShapeCurve> generalisation;
    rom::ShapeCurve specificity;
    /// Of the mean of volumes; else empty.
    std::string mean_certificate;
    std::vector<ProjectedShape> projections;
    std::vector<VirtualShape> virtuals;
    double seconds = 0.0;
    std::vector<std::filesystem::path> files;
};

/// As shape_schema.md says.
[[nodiscard]] std::string shape_json(const ShapeRun& run);
/// Tables of modes, projections and virtual members.
void print_shape(const ShapeRun& run, const std::filesystem::path& folder);

/// Writes the mean, the modes at -3 to 3 standard deviations, projections and virtual members:
/// NAME_mean, NAME_mode_K_S, NAME_projected_MEMBER, NAME_virtual_K as VTP of meshes and VTU of
/// volumes, with the array "displacement" from the mean; mean, projections and virtual members of
/// volumes also as spline files (.xml). NAME_mode_K.pvd lists the files of a mode. Tables:
/// NAME_curves.csv, NAME_coefficients.csv.
///
/// @param with_pictures  also NAME_modes.png, NAME_curves.png, NAME_members.png
/// @throws FileError  if one can't be written
std::vector<std::filesystem::path> write_shape_files(const ShapeRun& run,
                                                     const std::filesystem::path& folder,
                                                     bool with_pictures);

}  // namespace couture::drivers
