#include "io/state_file.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "io/hdf5_file.h"
#include "io/hdf5_store.h"

namespace couture::io {

namespace {

using Json = nlohmann::ordered_json;

constexpr int state_version = 1;
constexpr const char* kind = "state";

// ---- the record

/// JSON has no number for what is not finite.
double to_number(const Json& value) {
    return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

Json to_json(const std::map<std::string, Vector3>& forces) {
    Json object = Json::object();
    for (const auto& [name, force] : forces) {
        object[name] = {force[0], force[1], force[2]};
    }
    return object;
}

Vector3 to_vector(const Json& list) {
    return {to_number(list.at(0)), to_number(list.at(1)), to_number(list.at(2))};
}

std::map<std::string, Vector3> to_forces(const Json& object) {
    std::map<std::string, Vector3> forces;
    for (const auto& [name, force] : object.items()) {
        forces[name] = to_vector(force);
    }
    return forces;
}

/// Calls body(name, number) for all numbers of a report.
template <typename Report, typename Body>
void for_numbers(Report& report, const Body& body) {
    body("t", report.t);
    body("energy_before", report.energy_before);
    body("energy_transferred", report.energy_transferred);
    body("energy_after", report.energy_after);
    body("volume_before", report.volume_before);
    body("volume_after", report.volume_after);
    body("shape_ratio_before", report.shape_ratio_before);
    body("shape_ratio_after", report.shape_ratio_after);
    body("scaled_jacobian_before", report.scaled_jacobian_before);
    body("scaled_jacobian_after", report.scaled_jacobian_after);
    body("angle_deviation_before", report.angle_deviation_before);
    body("angle_deviation_after", report.angle_deviation_after);
    body("gradient_drift", report.gradient_drift);
    body("min_det_F", report.min_det_F);
    body("largest_gap", report.largest_gap);
}

Json to_json(const iga::RemeshingReport& report) {
    Json object = {{"cause", report.cause},
                   {"carries_gradient", report.transfer == iga::Transfer::gradient},
                   {"n_iterations", report.n_iterations},
                   {"reactions_before", to_json(report.reactions_before)},
                   {"reactions_after", to_json(report.reactions_after)}};
    for_numbers(report, [&](const char* name, double value) { object[name] = value; });
    return object;
}

iga::RemeshingReport to_report(const Json& object) {
    iga::RemeshingReport report;
    report.cause = object.at("cause").get<std::string>();
    if (object.at("carries_gradient").get<bool>()) {
        report.transfer = iga::Transfer::gradient;
    }
    report.n_iterations = object.at("n_iterations").get<int>();
    report.reactions_before = to_forces(object.at("reactions_before"));
    report.reactions_after = to_forces(object.at("reactions_after"));
    for_numbers(report,
                [&](const char* name, double& value) { value = to_number(object.at(name)); });
    return report;
}

/// Calls body(name, value) for all of a state but its matrices and its reference.
template <typename State, typename Body>
void for_state_values(State& state, const Body& body) {
    body("t", state.t);
    body("next_step", state.next_step);
    body("work", state.work);
    body("time_direction", state.time_direction);
    body("displacement_scale", state.displacement_scale);
    body("n_steps", state.n_steps);
    body("n_remeshings", state.n_remeshings);
    body("last_remeshing", state.last_remeshing);
    body("watches_quality", state.watches_quality);
}

template <int d>
Json record_of(const iga::AcceptedStep<d>& step, const StateOrigin& origin) {
    Json record = {
        {"deck", origin.deck},
        {"model_hash", origin.model_hash},
        {"signature", origin.signature},
        {"geometry_file", origin.geometry_file},
        {"geometry_hash", origin.geometry_hash},
        {"program", std::string("couture ") + COUTURE_VERSION},
        {"dimension", d},
        {"number", step.number},
        {"step", step.step},
        {"n_cuts", step.n_cuts},
        {"energy", step.energy},
        {"applied_force", {step.applied_force[0], step.applied_force[1], step.applied_force[2]}},
        {"reactions", to_json(step.reactions)},
        {"newton",
         {{"converged", step.newton.converged},
          {"iterations", step.newton.iterations},
          {"residuals", step.newton.residuals},
          {"min_det_F", step.newton.min_det_F}}}};
    for_state_values(step.state,
                     [&](const char* name, const auto& value) { record["state"][name] = value; });
    if (step.remeshing) {
        record["remeshing"] = to_json(*step.remeshing);
    }
    return record;
}

/// All but the matrices and the reference.
template <int d>
iga::AcceptedStep<d> to_step(const Json& record) {
    iga::AcceptedStep<d> step;
    step.number = record.at("number").get<int>();
    for_state_values(step.state, [&](const char* name, auto& value) {
        record.at("state").at(name).get_to(value);
    });
    step.step = to_number(record.at("step"));
    step.n_cuts = record.at("n_cuts").get<int>();
    step.energy = to_number(record.at("energy"));
    step.applied_force = to_vector(record.at("applied_force"));
    step.reactions = to_forces(record.at("reactions"));
    const Json& newton = record.at("newton");
    step.newton.converged = newton.at("converged").get<bool>();
    step.newton.iterations = newton.at("iterations").get<int>();
    for (const Json& residual : newton.at("residuals")) {
        step.newton.residuals.push_back(to_number(residual));
    }
    step.newton.min_det_F = to_number(newton.at("min_det_F"));
    if (record.contains("remeshing")) {
        step.remeshing = to_report(record.at("remeshing"));
    }
    return step;
}

void check_origin(const std::string& file, const Json& record, int d, const StateOrigin& origin) {
    const auto at = [&](const char* key) { return record.at(key).get<std::string>(); };
    const auto refuse = [&](const std::string& what, const std::string& there,
                            const std::string& here) {
        throw InputError(
            "{}: is a state of another deck: {} {} of '{}' there, {} of '{}' here; resume with the "
            "deck that made it, choose another folder with --out, or run without --resume",
            file, what, there, at("deck"), here, origin.deck);
    };
    if (at("model_hash") != origin.model_hash) {
        refuse("model hash", at("model_hash"), origin.model_hash);
    }
    if (at("geometry_hash") != origin.geometry_hash) {
        refuse("geometry file", fmt::format("{} ({})", at("geometry_file"), at("geometry_hash")),
               fmt::format("{} ({})", origin.geometry_file, origin.geometry_hash));
    }
    if (at("signature") != origin.signature || record.at("dimension").get<int>() != d) {
        refuse("signature", at("signature"), origin.signature);
    }
}

// ---- matrices

void expect_shape(const std::string& file, const std::string& name, const MatrixX& matrix,
                  Eigen::Index n_rows, Eigen::Index n_columns) {
    expect(matrix.rows() == n_rows && matrix.cols() == n_columns, file,
           fmt::format("'{}' is {} x {}; expected {} x {}", name, matrix.rows(), matrix.cols(),
                       n_rows, n_columns));
}

template <int d>
iga::ReferencePtr<d> read_reference(const Source& source, hid_t root) {
    const Handle group = source.group(root, "reference");
    RawSplines splines = read_hdf5(source.file, source.bytes(group, "geometry"));
    auto* geometry = std::get_if<iga::MultiPatch<d>>(&splines.multipatch);
    expect(geometry != nullptr, source.file, "the reference's geometry has another dimension");
    iga::ReferenceConfiguration<d> reference;
    reference.space = std::make_shared<const iga::Space<d>>(std::move(*geometry));
    reference.displacement = source.matrix(group, "displacement");
    reference.gradient = source.matrix(group, "gradient");
    const Eigen::Index n = reference.space->n_dofs();
    if (!reference.is_undeformed()) {
        expect_shape(source.file, "reference/displacement", reference.displacement, n, d);
        expect_shape(source.file, "reference/gradient", reference.gradient, n, 9);
    }
    return std::make_shared<const iga::ReferenceConfiguration<d>>(std::move(reference));
}

}  // namespace

template <int d>
void write_state(const std::filesystem::path& path, const iga::AcceptedStep<d>& step,
                 const StateOrigin& origin) {
    std::string content;
    {
        const Handle store = make_image();
        write_bytes(store, "record", record_of(step, origin).dump());
        write_matrix(store, "displacement", step.state.displacement);
        write_matrix(store, "direction", step.state.direction);
        const iga::ReferenceConfiguration<d>& reference = *step.state.reference;
        if (step.state.n_remeshings > 0) {
            const Handle group = make_group(store, "reference");
            write_bytes(group, "geometry", to_hdf5<d>(reference.space->geometry()));
            write_matrix(group, "displacement", reference.displacement);
            write_matrix(group, "gradient", reference.gradient);
        }
        content = image_of(store);
    }
    write_text(path, pack_hdf5(kind, state_version, content));
}

template <int d>
iga::AcceptedStep<d> read_state(const std::filesystem::path& path,
                                const iga::ReferencePtr<d>& undeformed, const StateOrigin& origin) {
    const std::string file = path.string();
    const std::string bytes = read_text(path);
    std::string content(unpack_hdf5(file, bytes, kind, state_version));
    const Handle store = open_image(file, content);
    const Source source{file, bytes.size()};
    iga::AcceptedStep<d> step;
    try {
        const Json record = Json::parse(source.bytes(store, "record"));
        check_origin(file, record, d, origin);
        step = to_step<d>(record);
    } catch (const Json::exception& error) {
        throw FileError("{}: the record can't be read: {}", file, error.what());
    }
    const bool is_remeshed = H5Lexists(store, "reference", H5P_DEFAULT) > 0;
    step.state.reference = is_remeshed ? read_reference<d>(source, store) : undeformed;
    step.state.displacement = source.matrix(store, "displacement");
    step.state.direction = source.matrix(store, "direction");
    const Eigen::Index n = step.state.reference->space->n_dofs();
    expect_shape(file, "displacement", step.state.displacement, n, d);
    return step;
}

template void write_state(const std::filesystem::path&, const iga::AcceptedStep<2>&,
                          const StateOrigin&);
template void write_state(const std::filesystem::path&, const iga::AcceptedStep<3>&,
                          const StateOrigin&);
template iga::AcceptedStep<2> read_state(const std::filesystem::path&, const iga::ReferencePtr<2>&,
                                         const StateOrigin&);
template iga::AcceptedStep<3> read_state(const std::filesystem::path&, const iga::ReferencePtr<3>&,
                                         const StateOrigin&);

}  // namespace couture::io
