#include "drivers/field_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "drivers/result_files.h"
#include "drivers/result_picture.h"
#include "drivers/state_series.h"
#include "iga/core/error.h"
#include "iga/post/finite_stress.h"
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

/// "NNNN.vtu" or "NNNN_remeshed.vtu" after the stem and a dash.
bool belongs_to(const std::string& file, const std::string& stem) {
    if (!file.starts_with(stem + "_")) {
        return false;
    }
    std::string_view rest = std::string_view(file).substr(stem.size() + 1);
    std::size_t n_digits = 0;
    while (n_digits < rest.size() && std::isdigit(static_cast<unsigned char>(rest[n_digits]))) {
        ++n_digits;
    }
    rest.remove_prefix(n_digits);
    return n_digits >= 4 && (rest == ".vtu" || rest == "_remeshed.vtu");
}

}  // namespace

template <int d>
FieldSeries<d>::FieldSeries(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                            const GeometryCertificate& certificate, fs::path folder)
    : deck_(deck),
      folder_(std::move(folder)),
      name_(deck.path.stem().string()),
      provenance_(provenance<d>(deck, geometry, certificate)) {}

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
    return folder_ / (stem + "_" + step_name(number, is_remeshing) + ".vtu");
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
void FieldSeries<d>::write(const iga::AcceptedStep<d>& step) const {
    const bool is_remeshing = step.remeshing.has_value();
    if (deck_.output.vtu) {
        const iga::FiniteFields fields = iga::project_finite_state<d>(deck_.problem, step.state);
        const auto arrays =
            arrays_of(step.state.displacement, fields.stress, fields.strain, fields.det_F);
        // Positions of all files are undeformed ones.
        io::write_vtu<d>(file_of(name_, step.number, is_remeshing),
                         *step.state.reference->undeformed(), arrays, {},
                         {.linear = deck_.output.linear, .provenance = provenance_});
    }
    if (deck_.output.gauss_points) {
        const iga::FiniteGaussPoints points = iga::gauss_point_states<d>(
            deck_.problem, step.state, deck_.discretization.n_gauss_points);
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
        for (const StepSummary& step : history) {
            const fs::path file = file_of(stem, step.number, step.remeshing.has_value());
            if (fs::exists(file)) {
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
    const iga::SpacePtr<d> space = step.state.reference->undeformed();
    iga::CaseResult<d> result;
    result.displacement = {space, step.state.displacement};
    write_picture<d>(folder_ / (name_ + ".png"), deck_, space, result,
                     iga::project_finite_state<d>(deck_.problem, step.state).stress);
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

template class FieldSeries<2>;
template class FieldSeries<3>;

}  // namespace couture::drivers
