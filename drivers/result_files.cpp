#include "drivers/result_files.h"

#include <nlohmann/json.hpp>

#include "drivers/result_picture.h"
#include "iga/core/text_hash.h"
#include "iga/post/finite_stress.h"
#include "iga/post/stress.h"
#include "io/atomic_file.h"
#include "io/vtk_writer.h"

namespace couture::drivers {

namespace fs = std::filesystem;

namespace {

/// Coefficients of von Mises and principal stresses at the control points of a stress field: exact
/// where the stress is constant, of the field's own accuracy elsewhere.
MatrixX map_rows(const MatrixX& stresses, int n_columns,
                 const std::function<VectorX(const Vector<6>&)>& f) {
    MatrixX result(stresses.rows(), n_columns);
    for (Eigen::Index i = 0; i < stresses.rows(); ++i) {
        result.row(i) = f(stresses.row(i).transpose()).transpose();
    }
    return result;
}

}  // namespace

const std::vector<std::string>& voigt_names() {
    static const std::vector<std::string> names = {"xx", "yy", "zz", "yz", "xz", "xy"};
    return names;
}

MatrixX von_mises_rows(const MatrixX& stresses) {
    return map_rows(stresses, 1,
                    [](const Vector<6>& s) { return VectorX::Constant(1, iga::von_mises(s)); });
}

MatrixX principal_rows(const MatrixX& stresses) {
    return map_rows(stresses, 3,
                    [](const Vector<6>& s) { return VectorX(iga::principal_stresses(s)); });
}

template <int d>
std::vector<io::PointArray> field_arrays(const iga::Problem& problem,
                                         const iga::CaseResult<d>& result, const MatrixX& stress) {
    if (problem.physics == iga::Physics::poisson) {
        return {{"potential", result.displacement.coefficients, {}},
                {"flux", stress.leftCols(3), {}}};
    }
    return {{"displacement", result.displacement.coefficients, {}},
            {"stress", stress, voigt_names()},
            {"von_mises", von_mises_rows(stress), {}},
            {"principal", principal_rows(stress), {"1", "2", "3"}}};
}

namespace {

template <int d>
iga::FiniteStresses<d> finite_stresses(const io::Deck& deck, const iga::Field<d>& displacement) {
    iga::SteppingState<d> state = iga::make_start<d>(displacement.space);
    state.displacement = displacement.coefficients;
    return {deck.problem, state, deck.stepping.n_gauss_points, deck.stepping.volumetric};
}

template <int d>
void write_gauss_points(const fs::path& path, const io::Deck& deck,
                        const iga::CaseResult<d>& load_case, const std::string& origin) {
    if (deck.is_hyperelastic()) {
        const auto points = finite_stresses<d>(deck, load_case.displacement).at_gauss_points();
        const std::vector<io::PointArray> arrays = {
            {"displacement", points.displacement, {}},
            {"stress", points.stress, voigt_names()},
            {"von_mises", von_mises_rows(points.stress), {}}};
        io::write_points_vtu(path, points.points, arrays, origin, points.cells);
        return;
    }
    const auto points =
        iga::gauss_point_stresses<d>(deck.problem, load_case.displacement, load_case.name);
    std::vector<io::PointArray> arrays;
    if (deck.problem.physics == iga::Physics::poisson) {
        arrays = {{"flux", points.stresses.leftCols(3), {}}};
    } else {
        arrays = {{"stress", points.stresses, voigt_names()},
                  {"von_mises", von_mises_rows(points.stresses), {}}};
    }
    io::write_points_vtu(path, points.points, arrays, origin);
}

}  // namespace

template <int d>
MatrixX smooth_stress(const io::Deck& deck, const iga::CaseResult<d>& result) {
    return deck.is_hyperelastic()
               ? finite_stresses<d>(deck, result.displacement).project().stress
               : iga::project_stress<d>(deck.problem, result.displacement, result.name);
}

template <int d>
std::string provenance(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                       const GeometryCertificate& certificate) {
    nlohmann::ordered_json object = {{"program", "couture " COUTURE_VERSION},
                                     {"deck", deck.path.filename().string()},
                                     {"deck_hash", text_hash(deck.text)},
                                     {"deck_text", deck.text},
                                     {"signature", iga::signature(geometry)},
                                     {"certificate",
                                      {{"validity", iga::to_string(certificate.validity)},
                                       {"min_jacobian", certificate.min_jacobian},
                                       {"patch", certificate.patch}}}};
    if (!deck.geometry.file.empty()) {
        object["geometry_file"] = deck.geometry.file.filename().string();
        object["geometry_hash"] = text_hash(io::read_text(deck.geometry.file));
    }
    return object.dump();
}

template <int d>
std::vector<fs::path> write_result_files(const io::Deck& deck, const iga::SpacePtr<d>& space,
                                         const iga::LinearStaticResult<d>& result,
                                         const GeometryCertificate& certificate,
                                         const fs::path& folder,
                                         const std::optional<MatrixX>& given_stress) {
    std::vector<fs::path> files;
    const std::string origin = provenance<d>(deck, space->geometry(), certificate);
    for (const iga::CaseResult<d>& load_case : result.cases) {
        const std::string stem =
            deck.path.stem().string() + (load_case.name.empty() ? "" : "_" + load_case.name);
        MatrixX stress;
        if (deck.output.vtu || deck.output.png) {
            stress = given_stress ? *given_stress : smooth_stress<d>(deck, load_case);
        }
        if (deck.output.vtu) {
            files.push_back(folder / (stem + ".vtu"));
            const auto arrays = field_arrays<d>(deck.problem, load_case, stress);
            io::write_vtu<d>(files.back(), *space, arrays, {},
                             {.linear = deck.output.linear, .provenance = origin});
        }
        if (deck.output.gauss_points) {
            files.push_back(folder / (stem + "_gauss.vtu"));
            write_gauss_points<d>(files.back(), deck, load_case, origin);
        }
        if (deck.output.png) {
            files.push_back(folder / (stem + ".png"));
            write_picture<d>(files.back(), deck, space, load_case, stress);
        }
    }
    return files;
}

template std::vector<io::PointArray> field_arrays(const iga::Problem&, const iga::CaseResult<2>&,
                                                  const MatrixX&);
template std::vector<io::PointArray> field_arrays(const iga::Problem&, const iga::CaseResult<3>&,
                                                  const MatrixX&);
template std::string provenance<2>(const io::Deck&, const iga::MultiPatch<2>&,
                                   const GeometryCertificate&);
template std::string provenance<3>(const io::Deck&, const iga::MultiPatch<3>&,
                                   const GeometryCertificate&);
template MatrixX smooth_stress<2>(const io::Deck&, const iga::CaseResult<2>&);
template MatrixX smooth_stress<3>(const io::Deck&, const iga::CaseResult<3>&);
template std::vector<fs::path> write_result_files<2>(const io::Deck&, const iga::SpacePtr<2>&,
                                                     const iga::LinearStaticResult<2>&,
                                                     const GeometryCertificate&, const fs::path&,
                                                     const std::optional<MatrixX>&);
template std::vector<fs::path> write_result_files<3>(const io::Deck&, const iga::SpacePtr<3>&,
                                                     const iga::LinearStaticResult<3>&,
                                                     const GeometryCertificate&, const fs::path&,
                                                     const std::optional<MatrixX>&);

}  // namespace couture::drivers
