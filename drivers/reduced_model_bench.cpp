#include "drivers/reduced_model_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "iga/core/parallel.h"
#include "iga/spline/shapes.h"
#include "rom/designs.h"
#include "rom/field_sampler.h"
#include "rom/member_geometry.h"
#include "rom/reduced_model.h"

namespace couture::drivers {

namespace {

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

rom::ParameterSpace parameters() {
    std::vector<rom::Parameter> list;
    for (int i = 0; i < 9; ++i) {
        list.push_back({fmt::format("size_{}", i), rom::ParameterGroup::geometry, "", 0.0, 1.0});
    }
    list.push_back({"direction", rom::ParameterGroup::load, "", 0.0, 1.0});
    list.push_back({"poissons_ratio", rom::ParameterGroup::material, "", 0.0, 1.0});
    return rom::ParameterSpace(list);
}

rom::FieldModel random_model(const rom::TensorDesign& design, const VectorX& mean, int n_modes,
                             double size) {
    rom::PodBasis basis;
    basis.modes = rom::random_design(n_modes, static_cast<int>(mean.size()), 1).array() - 0.5;
    basis.singular_values = VectorX::Ones(n_modes);
    basis.rank = n_modes;
    const MatrixX values = size * (rom::random_design(n_modes, design.n_points(), 2).array() - 0.5);
    const rom::KrigingParameters kriging{VectorX::Ones(design.n_parameters()), 1e-6};
    return {mean, std::move(basis), n_modes,
            rom::CoefficientModel(design, values, {},
                                  std::vector<rom::KrigingParameters>(n_modes, kriging))};
}

/// Small changes of a cube, so that no sample is folded.
rom::ReducedModel random_cube(int n_elements, int n_modes) {
    iga::MultiPatch<3> cube;
    cube.patches = {iga::make_box<3>(Vector3::Ones())};
    cube = iga::refine<3>(cube, 3, std::array<int, 3>{n_elements, n_elements, n_elements});
    const VectorX points = rom::to_field(iga::Space<3>(cube), cube);
    const MatrixX geometries = rom::star_design(9, 2);
    const rom::TensorDesign all{{geometries, rom::full_design(1, 3), rom::full_design(1, 2)}};
    rom::ReducedModelParts parts{parameters(),
                                 std::vector<int>(11, 0),
                                 VectorX::Constant(11, 0.5),
                                 cube,
                                 {},
                                 {},
                                 {},
                                 {},
                                 {}};
    parts.models.push_back(random_model({{geometries}}, points, n_modes, 1e-5));
    parts.models.push_back(random_model(all, VectorX::Zero(points.size()), n_modes, 1e-5));
    parts.displacement.i_model = 1;
    parts.geometry.gram = MatrixX::Identity(n_modes, n_modes);
    parts.displacement.gram = parts.geometry.gram;
    return rom::ReducedModel(std::move(parts));
}

rom::SampleGrid equidistant_grid(int n) {
    std::vector<double> line(n);
    for (int i = 0; i < n; ++i) {
        line[i] = static_cast<double>(i) / (n - 1);
    }
    return {0, {line, line, line}};
}

/// Of one call: the best of several runs of some calls each.
template <typename Call>
double seconds_of(int n_calls, const Call& call) {
    double best = 1e300;
    for (int run = 0; run < 5; ++run) {
        const double start = cpu_seconds();
        for (int i = 0; i < n_calls; ++i) {
            call(i);
        }
        best = std::min(best, (cpu_seconds() - start) / n_calls);
    }
    return best;
}

EvaluationRow measure(int n_elements, int n_modes, int n_calls) {
    const rom::ReducedModel model = random_cube(n_elements, n_modes);
    const rom::FieldSampler sampler(model.space(), {equidistant_grid(n_elements + 3)});
    iga::Problem problem;
    problem.materials = {iga::make_isotropic("steel", 1.0, 0.3)};
    const MatrixX points = rom::random_design(11, 64, 3);
    const auto point = [&](int i) { return VectorX(points.row(i % 64)); };

    EvaluationRow row{n_modes, 3 * model.n_nodes(), sampler.n_points()};
    const rom::Evaluation there = model.evaluate(point(0));
    double sum = 0.0;
    row.fields_seconds =
        seconds_of(n_calls, [&](int i) { sum += model.evaluate(point(i)).displacement[0]; });
    row.samples_seconds = seconds_of(n_calls, [&](int) {
        sum += sampler.sample(there.control_points, there.displacement, problem).von_mises[0];
    });
    row.batch_seconds =
        seconds_of(1, [&](int) { sum += model.evaluate_batch(points).displacements(0, 0); }) / 64.0;
    row.errors_seconds =
        seconds_of(n_calls, [&](int i) { sum += model.errors(point(i)).displacement.total; });
    row.gradient_seconds =
        seconds_of(1, [&](int i) { sum += model.gradient(point(i)).displacement(0, 0); });
    // Nothing is left out by the compiler: it can't know the sum.
    row.n_samples += sum == 0.123 ? 1 : 0;
    return row;
}

}  // namespace

std::vector<EvaluationRow> measure_evaluations(bool quick) {
    const int before = n_threads();
    set_n_threads(1);
    std::vector<EvaluationRow> rows;
    for (const int n_modes : quick ? std::vector<int>{5} : std::vector<int>{25, 50}) {
        rows.push_back(measure(quick ? 5 : 19, n_modes, quick ? 5 : 20));
    }
    set_n_threads(before);
    return rows;
}

std::string evaluation_text(const std::vector<EvaluationRow>& rows) {
    std::string text =
        "\nReduced model: evaluation, one thread, processor time; milliseconds per point\n"
        "  modes  unknowns  samples  fields  samples  both  fields in batch  errors  gradient\n";
    for (const EvaluationRow& row : rows) {
        text += fmt::format(
            "  {:5}  {:8}  {:7}  {:6.3f}  {:7.3f}  {:4.2f}  {:15.3f}  {:6.3f}  {:8.2f}\n",
            row.n_modes, row.n_unknowns, row.n_samples, 1e3 * row.fields_seconds,
            1e3 * row.samples_seconds, 1e3 * (row.fields_seconds + row.samples_seconds),
            1e3 * row.batch_seconds, 1e3 * row.errors_seconds, 1e3 * row.gradient_seconds);
    }
    return text;
}

}  // namespace couture::drivers
