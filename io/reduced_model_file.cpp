#include "io/reduced_model_file.h"

#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "io/hdf5_file.h"
#include "io/hdf5_store.h"

namespace couture::io {

namespace {

using Json = nlohmann::ordered_json;

constexpr int rom_version = 2;
constexpr const char* kind = "rom";

/// The names that a choice has in files.
template <typename Choice>
using Names = std::vector<std::pair<Choice, const char*>>;

const Names<rom::ParameterGroup> group_names = {{rom::ParameterGroup::geometry, "geometry"},
                                                {rom::ParameterGroup::load, "load"},
                                                {rom::ParameterGroup::material, "material"}};
const Names<rom::BasisKind> basis_names = {{rom::BasisKind::separate, "separate"},
                                           {rom::BasisKind::stacked, "stacked"}};
const Names<rom::ModeProduct> product_names = {{rom::ModeProduct::l2, "l2"},
                                               {rom::ModeProduct::euclidean, "euclidean"}};
const Names<rom::CorrelationKind> correlation_names = {
    {rom::CorrelationKind::matern_5_2, "matern_5_2"}, {rom::CorrelationKind::gaussian, "gaussian"}};
const Names<rom::Amplitude> amplitude_names = {{rom::Amplitude::none, "none"},
                                               {rom::Amplitude::automatic, "automatic"}};
const Names<rom::Trend> trend_names = {{rom::Trend::constant, "constant"},
                                       {rom::Trend::linear, "linear"},
                                       {rom::Trend::quadratic, "quadratic"},
                                       {rom::Trend::automatic, "automatic"}};

template <typename Choice>
std::string name_of(const Names<Choice>& names, Choice choice) {
    for (const auto& [known, name] : names) {
        if (known == choice) {
            return name;
        }
    }
    return {};
}

template <typename Choice>
Choice choice_of(const std::string& file, const Names<Choice>& names, const Json& value) {
    const auto text = value.get<std::string>();
    for (const auto& [choice, name] : names) {
        if (name == text) {
            return choice;
        }
    }
    throw FileError("{}: the record has the unknown choice '{}'", file, text);
}

template <typename T>
Json to_json(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

template <typename T>
std::optional<T> to_optional(const Json& value) {
    return value.is_null() ? std::nullopt : std::optional<T>(value.get<T>());
}

// ---- the record

Json parameters_json(const rom::ReducedModelParts& parts) {
    Json list = Json::array();
    for (int i = 0; i < parts.parameters.size(); ++i) {
        const rom::Parameter& parameter = parts.parameters.parameters()[i];
        list.push_back({{"name", parameter.name},
                        {"group", name_of(group_names, parameter.group)},
                        {"unit", parameter.unit},
                        {"lower", parameter.lower},
                        {"upper", parameter.upper},
                        {"periodic", parameter.is_periodic},
                        {"factor_power", parts.factor_power[i]},
                        {"reference", parts.reference_point[i]}});
    }
    return list;
}

Json kriging_json(const rom::KrigingOptions& kriging) {
    return {{"correlation", name_of(correlation_names, kriging.correlation)},
            {"trend", name_of(trend_names, kriging.trend)},
            {"nugget", to_json(kriging.nugget)},
            {"n_starts", kriging.n_starts},
            {"seed", kriging.seed}};
}

rom::KrigingOptions to_kriging(const std::string& file, const Json& object) {
    rom::KrigingOptions kriging;
    kriging.correlation = choice_of(file, correlation_names, object.at("correlation"));
    kriging.trend = choice_of(file, trend_names, object.at("trend"));
    kriging.nugget = to_optional<double>(object.at("nugget"));
    object.at("n_starts").get_to(kriging.n_starts);
    object.at("seed").get_to(kriging.seed);
    return kriging;
}

Json options_json(const rom::ReducedModelOptions& options) {
    return {{"basis", name_of(basis_names, options.basis)},
            {"product", name_of(product_names, options.product)},
            {"amplitude", name_of(amplitude_names, options.amplitude)},
            {"n_modes", to_json(options.n_modes)},
            {"tolerance", options.tolerance},
            {"kriging", kriging_json(options.kriging)}};
}

rom::ReducedModelOptions to_options(const std::string& file, const Json& object) {
    rom::ReducedModelOptions options;
    options.basis = choice_of(file, basis_names, object.at("basis"));
    options.product = choice_of(file, product_names, object.at("product"));
    options.amplitude = choice_of(file, amplitude_names, object.at("amplitude"));
    options.n_modes = to_optional<int>(object.at("n_modes"));
    object.at("tolerance").get_to(options.tolerance);
    options.kriging = to_kriging(file, object.at("kriging"));
    return options;
}

/// Calls body(name, value) for all of these but matrices.
template <typename Part, typename Body>
void for_part_values(Part& part, const Body& body) {
    body("i_model", part.i_model);
    body("first_component", part.first_component);
    body("scale", part.scale);
    body("truncation", part.truncation);
    body("leave_one_out", part.leave_one_out);
    body("leave_one_out_ratio", part.leave_one_out_ratio);
    body("size", part.size);
}

template <typename Calibration, typename Body>
void for_calibration_values(Calibration& calibration, const Body& body) {
    body("geometry", calibration.geometry);
    body("displacement", calibration.displacement);
    body("von_mises", calibration.von_mises);
    body("n_points", calibration.n_points);
}

Json part_json(const rom::FieldPart& part) {
    Json object;
    for_part_values(part, [&](const char* name, const auto& value) { object[name] = value; });
    return object;
}

Json coefficients_json(const rom::CoefficientModel& model) {
    return {{"trend", name_of(trend_names, model.options().trend)},
            {"n_factors", model.design().factors.size()}};
}

Json record_of(const ReducedModelFile& content) {
    const rom::ReducedModelParts& parts = content.model.parts();
    Json calibration;
    for_calibration_values(parts.calibration,
                           [&](const char* name, const auto& value) { calibration[name] = value; });
    Json models = Json::array();
    for (const rom::FieldModel& model : parts.models) {
        models.push_back(coefficients_json(model.coefficients()));
        models.back()["n_modes_asked"] = to_json(model.n_modes_asked());
        models.back()["rank"] = model.basis().rank;
        models.back()["remaining_energy"] = model.basis().remaining_energy;
    }
    return {{"program", std::string("couture ") + COUTURE_VERSION},
            {"provenance", content.provenance},
            {"parameters", parameters_json(parts)},
            {"options", options_json(parts.options)},
            {"geometry", part_json(parts.geometry)},
            {"displacement", part_json(parts.displacement)},
            {"calibration", calibration},
            {"models", models},
            {"amplitude", parts.amplitude ? coefficients_json(*parts.amplitude) : Json()}};
}

// ---- the field models

void write_coefficients(hid_t group, const rom::CoefficientModel& coefficients) {
    const std::vector<rom::KrigingParameters> parameters = coefficients.parameters();
    MatrixX lengths(parameters.size(), coefficients.n_inputs());
    VectorX nuggets(parameters.size());
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        lengths.row(static_cast<Eigen::Index>(k)) = parameters[k].lengths.transpose();
        nuggets[static_cast<Eigen::Index>(k)] = parameters[k].nugget;
    }
    write_matrix(group, "coefficients", coefficients.training());
    write_matrix(group, "lengths", lengths);
    write_matrix(group, "nuggets", nuggets);
    write_matrix(group, "leave_one_out", coefficients.leave_one_out());
    const Handle design = make_group(group, "design");
    const std::vector<MatrixX>& factors = coefficients.design().factors;
    for (std::size_t g = 0; g < factors.size(); ++g) {
        write_matrix(design, std::to_string(g), factors[g]);
    }
}

void write_model(hid_t group, const rom::FieldModel& model) {
    write_matrix(group, "mean", model.mean());
    write_matrix(group, "modes", model.basis().modes);
    write_matrix(group, "singular_values", model.basis().singular_values);
    write_coefficients(group, model.coefficients());
}

rom::CoefficientModel read_coefficients(const Source& source, hid_t group, const Json& record,
                                        rom::KrigingOptions kriging) {
    kriging.trend = choice_of(source.file, trend_names, record.at("trend"));
    rom::TensorDesign design;
    const Handle factors = source.group(group, "design");
    for (int g = 0; g < record.at("n_factors").get<int>(); ++g) {
        design.factors.push_back(source.matrix(factors, std::to_string(g)));
    }
    const MatrixX lengths = source.matrix(group, "lengths");
    const VectorX nuggets = source.matrix(group, "nuggets").reshaped();
    expect(nuggets.size() == lengths.rows() &&
               (lengths.rows() == 0 || lengths.cols() == design.n_parameters()),
           source.file,
           fmt::format("kriging has {} x {} lengths and {} nuggets for {} inputs", lengths.rows(),
                       lengths.cols(), nuggets.size(), design.n_parameters()));
    std::vector<rom::KrigingParameters> parameters;
    for (Eigen::Index k = 0; k < lengths.rows(); ++k) {
        parameters.push_back({lengths.row(k).transpose(), nuggets[k]});
    }
    return {std::move(design), source.matrix(group, "coefficients"), kriging, parameters};
}

rom::FieldModel read_model(const Source& source, hid_t group, const Json& record,
                           const rom::KrigingOptions& kriging) {
    rom::PodBasis basis;
    basis.modes = source.matrix(group, "modes");
    basis.singular_values = source.matrix(group, "singular_values");
    record.at("rank").get_to(basis.rank);
    record.at("remaining_energy").get_to(basis.remaining_energy);
    return {source.matrix(group, "mean").reshaped(), std::move(basis),
            to_optional<int>(record.at("n_modes_asked")),
            read_coefficients(source, group, record, kriging)};
}

rom::FieldPart read_part(const Source& source, hid_t root, const std::string& name,
                         const Json& record) {
    rom::FieldPart part;
    for_part_values(part, [&](const char* key, auto& value) { record.at(key).get_to(value); });
    part.gram = source.matrix(source.group(root, name), "gram");
    return part;
}

rom::ReducedModelParts read_parts(const Source& source, hid_t root, const Json& record) {
    std::vector<rom::Parameter> parameters;
    std::vector<int> powers;
    std::vector<double> reference_values;
    for (const Json& one : record.at("parameters")) {
        parameters.push_back({one.at("name").get<std::string>(),
                              choice_of(source.file, group_names, one.at("group")),
                              one.at("unit").get<std::string>(), one.at("lower").get<double>(),
                              one.at("upper").get<double>(), one.value("periodic", false)});
        powers.push_back(one.at("factor_power").get<int>());
        reference_values.push_back(one.at("reference").get<double>());
    }
    RawSplines splines = read_hdf5(source.file, source.bytes(root, "reference"));
    auto* reference = std::get_if<iga::MultiPatch<3>>(&splines.multipatch);
    expect(reference != nullptr, source.file, "the reference member is no volume");
    rom::ReducedModelParts parts{
        rom::ParameterSpace(std::move(parameters)),
        std::move(powers),
        Eigen::Map<const VectorX>(reference_values.data(),
                                  static_cast<Eigen::Index>(reference_values.size())),
        std::move(*reference),
        to_options(source.file, record.at("options")),
        {},
        read_part(source, root, "geometry", record.at("geometry")),
        read_part(source, root, "displacement", record.at("displacement")),
        {}};
    for_calibration_values(parts.calibration, [&](const char* name, auto& value) {
        record.at("calibration").at(name).get_to(value);
    });
    const Handle models = source.group(root, "models");
    for (std::size_t i = 0; i < record.at("models").size(); ++i) {
        parts.models.push_back(read_model(source, source.group(models, std::to_string(i)),
                                          record.at("models")[i], parts.options.kriging));
    }
    if (const Json& amplitude = record.at("amplitude"); !amplitude.is_null()) {
        parts.amplitude = read_coefficients(source, source.group(root, "amplitude"), amplitude,
                                            parts.options.kriging);
    }
    return parts;
}

}  // namespace

void write_reduced_model(const std::filesystem::path& path, const ReducedModelFile& content) {
    const rom::ReducedModelParts& parts = content.model.parts();
    std::string bytes;
    {
        const Handle store = make_image();
        write_bytes(store, "record", record_of(content).dump());
        write_bytes(store, "deck", content.deck);
        write_bytes(store, "reference", to_hdf5<3>(parts.reference));
        for (const auto& [name, part] : {std::pair{"geometry", &parts.geometry},
                                         std::pair{"displacement", &parts.displacement}}) {
            write_matrix(make_group(store, name), "gram", part->gram);
        }
        const Handle models = make_group(store, "models");
        for (std::size_t i = 0; i < parts.models.size(); ++i) {
            write_model(make_group(models, std::to_string(i)), parts.models[i]);
        }
        if (parts.amplitude) {
            write_coefficients(make_group(store, "amplitude"), *parts.amplitude);
        }
        bytes = image_of(store);
    }
    write_text(path, pack_hdf5(kind, rom_version, bytes));
}

ReducedModelFile read_reduced_model(const std::filesystem::path& path) {
    const std::string file = path.string();
    const std::string bytes = read_text(path);
    std::string content(unpack_hdf5(file, bytes, kind, rom_version));
    const Handle store = open_image(file, content);
    const Source source{file, bytes.size()};
    try {
        const Json record = Json::parse(source.bytes(store, "record"));
        return {rom::ReducedModel(read_parts(source, store, record)), source.bytes(store, "deck"),
                record.at("provenance").get<std::map<std::string, std::string>>()};
    } catch (const Json::exception& error) {
        throw FileError("{}: the record can't be read: {}", file, error.what());
    } catch (const InputError& error) {
        throw FileError("{}: {}", file, error.what());
    }
}

}  // namespace couture::io
