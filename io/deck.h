#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "iga/linalg/sparse_solver.h"
#include "iga/mechanics/problem.h"
#include "iga/solve/load_stepping.h"
#include "io/rom_section.h"
#include "io/units.h"

namespace couture::io {

/// Exactly one of `file`, `mesh` and `part` is set.
struct GeometrySource {
    /// Absolute, or relative to the working folder.
    std::filesystem::path file;
    /// A deck for meshing: the volume that it makes.
    std::filesystem::path mesh;
    /// In place of the surface that `mesh` names; empty: that one.
    std::filesystem::path surface;
    std::string part;
    /// Of the part, or of the part that `mesh` names.
    std::map<std::string, double> parameters;
    /// Sets of the deck: name -> entities as in PatchEntity::name ("patch 3 side 0:low").
    std::map<std::string, std::vector<std::string>> sets;
    /// Where [geometry] was written.
    std::string source;
};

struct Discretization {
    /// Nothing: that of the geometry.
    std::optional<int> degree;
    /// Per direction; one number: the same in all; empty: those of the geometry.
    std::vector<int> elements;
    /// The body is the splines of this degree through the geometry, which may be lower than its
    /// own; else it is the geometry itself.
    bool interpolates_geometry = false;
    std::optional<int> n_gauss_points;
    std::string source;
};

/// How a deformed body is meshed again.
enum class Mesher {
    slide,   ///< control points move, those of the boundary within their faces and curves
    surface  ///< the boundary as triangles, mapped to the layout anew and filled
};

/// When a body at finite strain is meshed again.
struct RemeshingOptions {
    std::string source;
    /// Increasing.
    std::vector<double> times;
    /// Of the worst place of the deformed body, beyond which it is meshed again.
    std::optional<double> shape_ratio;
    std::optional<double> scaled_jacobian;
    std::optional<double> angle_deviation;
    bool on_failure = false;
    Mesher mesher = Mesher::slide;
    iga::Transfer transfer = iga::Transfer::displacement;
    int max_remeshings = 20;
};

/// A number to be reported, and checked if a value is expected.
struct Probe {
    std::string source;
    std::string name;
    std::string quantity;
    /// Where: a point, or a patch and a parameter, or a set; scalars have none.
    std::optional<Vector3> at;
    std::optional<int> patch;
    std::vector<double> xi;
    std::string on;
    /// Empty: the only case.
    std::string load_case;
    /// When, in a run over time; nothing: at its end.
    std::optional<double> t;
    std::optional<double> expect;
    /// The larger of tolerance |expect| and `absolute_tolerance` is allowed.
    double tolerance = 1e-3;
    double absolute_tolerance = 0.0;

    /// Largest accepted |value - expect|.
    [[nodiscard]] double allowed_error() const;
    /// True if nothing is expected. NaN never passes where something is.
    [[nodiscard]] bool passes(double value) const;
};

struct OutputOptions {
    bool vtu = true;
    /// Linear cells instead of exact spline cells.
    bool linear = false;
    bool gauss_points = false;
    /// Runs over time: fields of each so many steps.
    int every = 1;
    bool png = false;
    /// What a picture is coloured by.
    std::string png_quantity = "von_mises";
    /// Displacements are drawn this many times larger; nothing: a tenth of the part at most.
    std::optional<double> png_scale;
};

/// One job.
struct Deck {
    std::filesystem::path path;
    /// As read, overrides in comment lines below.
    std::string text;
    std::string title;
    UnitSystem units;
    GeometrySource geometry;
    Discretization discretization;
    iga::Problem problem;
    iga::SolverOptions solver;
    /// Of hyperelastic decks; stops: the times of tables, probes and remeshings within the run.
    iga::SteppingOptions stepping;
    std::optional<RemeshingOptions> remeshing;
    OutputOptions output;
    std::vector<Probe> probes;
    /// Nothing: no reduced model is made of it.
    std::optional<RomSection> rom;
    /// What the states of a run depend on: all of the deck but its title and [stepping], [solver],
    /// [remeshing], [rom], [output], with the overrides; and the end of the run if loads grow until
    /// then.
    std::string model_text;

    /// The materials are hyperelastic: all are, or none.
    [[nodiscard]] bool is_hyperelastic() const;
};

/// Reads and checks a deck by itself (the geometry is not opened). Implausible values warn.
///
/// @param overrides  "section.key=value", see override_value
/// @throws FileError   if it can't be read
/// @throws InputError  with all that is wrong: file, line, the text with a caret, the rule, the
///                     nearest name
[[nodiscard]] Deck read_deck(const std::filesystem::path& path,
                             const std::vector<std::string>& overrides = {});

/// The same for a text at hand; `path` names it and is what paths in it are relative to.
[[nodiscard]] Deck parse_deck(const std::string& text, const std::filesystem::path& path,
                              const std::vector<std::string>& overrides = {});

/// `message` with the line of the deck's text that it is about: the first line at or below
/// `source` ("part.toml:14") in the same section that holds `word`.
[[nodiscard]] std::string located_in(const Deck& deck, const std::string& source,
                                     const std::string& word, const std::string& message);

}  // namespace couture::io
