#include "drivers/field_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "drivers/result_files.h"
#include "drivers/result_picture.h"
#include "drivers/state_series.h"
#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/vtk_writer.h"

namespace couture::drivers {

namespace fs = std::filesystem;

namespace {

/// Text inside an attribute of XML.
std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

std::vector<io::PointArray> arrays_of(const MatrixX& displacement, const MatrixX& stress,
                                      const MatrixX& strain, const MatrixX& det_F) {
    return {{"displacement", displacement, {}},
            {"stress", stress, voigt_names()},
            {"von_mises", von_mises_rows(stress), {}},
            {"principal", principal_rows(stress), {"1", "2", "3"}},
            {"strain", strain, voigt_names()},
            {"det_F", det_F, {}}};
}

}  // namespace

template <int d>
FieldSeries<d>::FieldSeries(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                            const GeometryCertificate& certificate, fs::path folder,
                            std::string extension)
    : deck_(deck),
      folder_(std::move(folder)),
      name_(deck.path.stem().string()),
      provenance_(provenance<d>(deck, geometry, certificate)),
      extension_(std::move(extension)) {}

template <int d>
bool FieldSeries<d>::belongs_to(const std::string& file, const std::string& stem) const {
    if (!file.starts_with(stem + "_")) {
        return false;
    }
    std::string_view rest = std::string_view(file).substr(stem.size() + 1);
    std::size_t n_digits = 0;
    while (n_digits < rest.size() && std::isdigit(static_cast<unsigned char>(rest[n_digits]))) {
        ++n_digits;
    }
    rest.remove_prefix(n_digits);
    return n_digits >= 4 && (rest == extension_ || rest == "_remeshed" + extension_);
}

template <int d>
std::vector<std::string> FieldSeries<d>::stems() const {
    std::vector<std::string> result;
    if (deck_.output.vtu) {
        result.push_back(name_);
    }
    if (deck_.output.gauss_points) {
        result.push_back(name_ + "_gauss");
    }
    return result;
}

template <int d>
fs::path FieldSeries<d>::file_of(const std::string& stem, int number, bool is_remeshing) const {
    return folder_ / (stem + "_" + step_name(number, is_remeshing) + extension_);
}

template <int d>
void FieldSeries<d>::clear() const {
    std::error_code code;
    std::vector<fs::path> old;
    for (const auto& entry : fs::directory_iterator(folder_, code)) {
        const std::string file = entry.path().filename().string();
        for (const std::string& stem : {name_, name_ + "_gauss"}) {
            if (file == stem + ".pvd" || belongs_to(file, stem)) {
                old.push_back(entry.path());
            }
        }
    }
    for (const fs::path& path : old) {
        fs::remove(path, code);
    }
}

template <int d>
bool FieldSeries<d>::is_due(const StepSummary& step) const {
    return step.remeshing || step.number % deck_.output.every == 0 || step.t >= deck_.stepping.end;
}

template <int d>
bool FieldSeries<d>::has(const StepSummary& step) const {
    const std::vector<std::string> all = stems();
    return std::all_of(all.begin(), all.end(), [&](const std::string& stem) {
        return fs::exists(file_of(stem, step.number, step.remeshing.has_value()));
    });
}

template <int d>
iga::FiniteStresses<d> FieldSeries<d>::stresses_of(const iga::AcceptedStep<d>& step) const {
    return {deck_.problem, step.state, deck_.stepping.n_gauss_points, deck_.stepping.volumetric};
}

template <int d>
void FieldSeries<d>::write(const iga::AcceptedStep<d>& step) const {
    const bool is_remeshing = step.remeshing.has_value();
    const iga::FiniteStresses<d> stresses = stresses_of(step);
    if (deck_.output.vtu) {
        const iga::FiniteFields fields = stresses.project();
        const auto arrays = field_arrays(step.state.displacement, fields);
        // Positions of all files are undeformed ones.
        io::write_vtu<d>(file_of(name_, step.number, is_remeshing), *stresses.undeformed(), arrays,
                         {}, {.linear = deck_.output.linear, .provenance = provenance_});
    }
    if (deck_.output.gauss_points) {
        const iga::FiniteGaussPoints points = stresses.at_gauss_points();
        const auto arrays =
            arrays_of(points.displacement, points.stress, points.strain, points.det_F);
        io::write_points_vtu(file_of(name_ + "_gauss", step.number, is_remeshing), points.points,
                             arrays, provenance_, points.cells);
    }
}

template <int d>
void FieldSeries<d>::write_lists(const std::vector<StepSummary>& history) const {
    for (const std::string& stem : stems()) {
        std::string text =
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
            "  <Collection>\n";
        for (std::size_t i = 0; i < history.size(); ++i) {
            const StepSummary& step = history[i];
            const auto file_at = [&](const StepSummary& one) {
                return file_of(stem, one.number, one.remeshing.has_value());
            };
            const fs::path file = file_at(step);
            // A time has one entry: on the new mesh where the body was meshed again.
            const bool is_followed = i + 1 < history.size() && history[i + 1].remeshing &&
                                     fs::exists(file_at(history[i + 1]));
            if (fs::exists(file) && !is_followed) {
                text += fmt::format("    <DataSet timestep=\"{}\" file=\"{}\"/>\n", step.t,
                                    escaped(file.filename().string()));
            }
        }
        text += "  </Collection>\n</VTKFile>\n";
        io::write_text(folder_ / (stem + ".pvd"), text);
    }
}

template <int d>
void FieldSeries<d>::draw(const iga::AcceptedStep<d>& step) const {
    const iga::FiniteStresses<d> stresses = stresses_of(step);
    iga::CaseResult<d> result;
    result.displacement = {stresses.undeformed(), step.state.displacement};
    write_picture<d>(folder_ / (name_ + ".png"), deck_, stresses.undeformed(), result,
                     stresses.project().stress);
}

template <int d>
std::vector<fs::path> FieldSeries<d>::files() const {
    std::vector<fs::path> result;
    for (const std::string& stem : stems()) {
        result.push_back(folder_ / (stem + ".pvd"));
    }
    if (deck_.output.png) {
        result.push_back(folder_ / (name_ + ".png"));
    }
    return result;
}

std::vector<io::PointArray> field_arrays(const MatrixX& displacement,
                                         const iga::FiniteFields& fields) {
    return arrays_of(displacement, fields.stress, fields.strain, fields.det_F);
}

template class FieldSeries<2>;
template class FieldSeries<3>;

}  // namespace couture::drivers
