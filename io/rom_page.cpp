#include "io/rom_page.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "iga/core/error.h"
#include "io/built_in_page.h"
#include "io/color_map.h"
#include "rom/grid_kernel.h"

namespace couture::io {

namespace {

using Json = nlohmann::ordered_json;

std::string to_base64(const void* data, std::size_t size) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const auto* bytes = static_cast<const unsigned char*>(data);
    std::string text;
    text.reserve((size + 2) / 3 * 4);
    for (std::size_t i = 0; i < size; i += 3) {
        const std::size_t n = std::min<std::size_t>(3, size - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = group << 8U | (k < n ? bytes[i + k] : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += k <= n ? digits[group >> (18 - 6 * k) & 63U] : '=';
        }
    }
    return text;
}

template <typename T>
Json packed(const char* type, const std::vector<T>& values) {
    return {{"type", type}, {"data", to_base64(values.data(), values.size() * sizeof(T))}};
}

Json packed(const std::vector<double>& values) { return packed("f64", values); }
Json packed(const std::vector<int>& values) { return packed("i32", values); }
/// Row by row.
Json packed(const MatrixX& values) {
    const MatrixX rows = values.transpose();
    return packed(std::vector<double>(rows.data(), rows.data() + rows.size()));
}

// ---- modes

/// Of the largest share of a mode in the field.
constexpr double mode_tolerance = 1e-7;

template <typename Integer>
Json rounded(const VectorX& mode, double largest) {
    const double unit = largest > 0.0 ? largest / std::numeric_limits<Integer>::max() : 1.0;
    std::vector<Integer> integers;
    for (const double value : mode) {
        integers.push_back(static_cast<Integer>(std::lround(value / unit)));
    }
    Json object = packed(sizeof(Integer) == 1 ? "i8" : "i16", integers);
    object["unit"] = unit;
    return object;
}

/// @param share  largest value of the mode times its largest coefficient
Json mode_json(const VectorX& mode, double share, double largest_share) {
    // Rounding to n steps on both sides of zero is off by half a step.
    const double allowed = mode_tolerance * largest_share;
    const double largest = mode.cwiseAbs().maxCoeff();
    if (share / (2 * std::numeric_limits<std::int8_t>::max()) <= allowed) {
        return rounded<std::int8_t>(mode, largest);
    }
    if (share / (2 * std::numeric_limits<std::int16_t>::max()) <= allowed) {
        return rounded<std::int16_t>(mode, largest);
    }
    return packed("f32", std::vector<float>(mode.begin(), mode.end()));
}

/// Rows of the nodes.
MatrixX rows_of(const MatrixX& field, const std::vector<int>& nodes) {
    MatrixX rows(3 * static_cast<Eigen::Index>(nodes.size()), field.cols());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        rows.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = field.middleRows<3>(3 * nodes[i]);
    }
    return rows;
}

Json part_json(const rom::FieldPart& part, const rom::FieldModel& model, double calibration,
               const MatrixX& mean, const MatrixX& modes) {
    const VectorX coefficients =
        model.coefficients().training().cwiseAbs().colwise().maxCoeff().transpose();
    const VectorX shares =
        modes.cwiseAbs().colwise().maxCoeff().transpose().cwiseProduct(coefficients);
    Json list = Json::array();
    for (Eigen::Index k = 0; k < modes.cols(); ++k) {
        list.push_back(mode_json(modes.col(k), shares[k], shares.maxCoeff()));
    }
    return {{"i_model", part.i_model},
            {"mean", mean.isZero(0.0) ? Json() : packed(mean)},
            {"modes", std::move(list)},
            {"gram", packed(part.gram)},
            {"truncation", part.truncation},
            {"leave_one_out_ratio", part.leave_one_out_ratio},
            {"size", part.size},
            {"calibration", calibration}};
}

// ---- coefficients

Json model_json(const rom::CoefficientModel& model, const rom::KrigingInputs& inputs) {
    const int n = model.n_coefficients();
    Json object = {{"inputs", inputs.parameters()},
                   {"waves", inputs.waves()},
                   {"n_coefficients", n},
                   {"is_gaussian", model.options().correlation == rom::CorrelationKind::gaussian},
                   {"trend_degree", static_cast<int>(model.options().trend)}};
    if (model.models().empty()) {
        object["constants"] = packed(model.training());
        return object;
    }
    object["factors"] = Json::array();
    for (const MatrixX& points : model.design().factors) {
        object["factors"].push_back(
            {{"n_points", points.rows()}, {"n_inputs", points.cols()}, {"points", packed(points)}});
    }
    MatrixX lengths(n, model.n_inputs());
    MatrixX trends(n, model.models()[0].trend_coefficients().size());
    MatrixX weights(n, model.training().rows());
    std::vector<double> nuggets;
    std::vector<double> variances;
    for (int k = 0; k < n; ++k) {
        const rom::Kriging& one = model.models()[k];
        lengths.row(k) = one.parameters().lengths.transpose();
        trends.row(k) = one.trend_coefficients().transpose();
        weights.row(k) = one.weights().transpose();
        nuggets.push_back(one.parameters().nugget);
        variances.push_back(one.process_variance());
    }
    object["lengths"] = packed(lengths);
    object["trends"] = packed(trends);
    object["weights"] = packed(weights);
    object["nuggets"] = packed(nuggets);
    object["variances"] = packed(variances);
    return object;
}

// ---- grids

/// Numbers the nodes that grids see, in the order in which they are first seen.
class NodeNumbers {
  public:
    explicit NodeNumbers(int n_nodes) : number_(n_nodes, -1) {}

    int operator()(int node) {
        if (number_[node] < 0) {
            number_[node] = static_cast<int>(nodes_.size());
            nodes_.push_back(node);
        }
        return number_[node];
    }
    [[nodiscard]] const std::vector<int>& nodes() const { return nodes_; }

  private:
    std::vector<int> number_;
    std::vector<int> nodes_;
};

Json line_json(const rom::LineTable& table) {
    return {{"n_points", table.n_points()},   {"n_functions", table.n_functions},
            {"n_active", table.n_active},     {"starts", packed(table.starts)},
            {"values", packed(table.values)}, {"derivatives", packed(table.derivatives)}};
}

int normal_direction(const rom::SampleGrid& grid) {
    const std::array<int, 3> sizes = grid.sizes();
    for (int k = 0; k < 3; ++k) {
        if (sizes[k] == 1) {
            return k;
        }
    }
    throw InputError(
        "make_rom_page: a grid of {} x {} x {} points; those of sides have 1 in one "
        "direction",
        sizes[0], sizes[1], sizes[2]);
}

Json grid_json(const iga::Space<3>& space, const rom::SampleGrid& grid, NodeNumbers& number) {
    const int across = normal_direction(grid);
    const std::array<int, 3> directions = {(across + 1) % 3, (across + 2) % 3, across};
    const iga::TensorSpace<3>& tensor = space.tensor(grid.patch);
    std::vector<rom::LineTable> tables;
    for (const int k : directions) {
        tables.emplace_back(tensor.knots[k], grid.parameters[k]);
    }
    // At an end one function is not zero and two have slopes.
    std::vector<double> values;
    std::vector<double> derivatives;
    std::vector<int> nodes;
    std::vector<double> weights;
    for (int n = 0; n < tables[2].n_active; ++n) {
        if (tables[2].value(0)[n] == 0.0 && tables[2].derivative(0)[n] == 0.0) {
            continue;
        }
        values.push_back(tables[2].value(0)[n]);
        derivatives.push_back(tables[2].derivative(0)[n]);
        std::array<int, 3> i{};
        i[across] = tables[2].first + tables[2].starts[0] + n;
        for (int b = 0; b < tables[1].n_functions; ++b) {
            i[directions[1]] = tables[1].first + b;
            for (int a = 0; a < tables[0].n_functions; ++a) {
                i[directions[0]] = tables[0].first + a;
                const int function = tensor.index(i);
                nodes.push_back(number(space.dofs(grid.patch)[function]));
                if (space.weights(grid.patch).size() > 0) {
                    weights.push_back(space.weights(grid.patch)[function]);
                }
            }
        }
    }
    return {{"patch", grid.patch},
            {"a", line_json(tables[0])},
            {"b", line_json(tables[1])},
            {"across_values", packed(values)},
            {"across_derivatives", packed(derivatives)},
            {"nodes", packed(nodes)},
            {"weights", weights.empty() ? Json() : packed(weights)}};
}

// ---- the rest

bool is_poissons_ratio(const ExportContent& content, int i_parameter) {
    return std::any_of(content.materials.begin(), content.materials.end(), [&](const auto& one) {
        return one.follows_parameters && one.poissons_ratio.i_parameter == i_parameter;
    });
}

Json parameters_json(const rom::ReducedModelParts& parts, const ExportContent& content) {
    Json list = Json::array();
    for (int i = 0; i < parts.parameters.size(); ++i) {
        const rom::Parameter& one = parts.parameters.parameters()[i];
        list.push_back({{"name", one.name},
                        {"unit", one.unit},
                        {"lower", one.lower},
                        {"upper", one.upper},
                        {"factor_power", parts.factor_power[i]},
                        {"reference", parts.reference_point[i]},
                        {"is_poissons_ratio", is_poissons_ratio(content, i)}});
    }
    return list;
}

Json modulus_json(const ExportModulus& modulus) {
    return {{"value", modulus.value},
            {"parameter", modulus.i_parameter ? Json(*modulus.i_parameter) : Json()}};
}

Json material_json(const ExportMaterial& material) {
    if (!material.follows_parameters) {
        return {{"stiffness", packed(MatrixX(material.stiffness))}};
    }
    return {{"youngs_modulus", modulus_json(material.youngs_modulus)},
            {"poissons_ratio", modulus_json(material.poissons_ratio)}};
}

Json colors_json() {
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < n_colors; ++i) {
        for (const double channel : viridis(static_cast<double>(i) / (n_colors - 1))) {
            bytes.push_back(static_cast<std::uint8_t>(std::lround(255.0 * channel)));
        }
    }
    return packed("u8", bytes);
}

Json page_json(const rom::ReducedModel& model, const ExportContent& content) {
    const rom::ReducedModelParts& parts = model.parts();
    NodeNumbers number(model.n_nodes());
    Json grids = Json::array();
    for (const rom::SampleGrid& grid : content.grids) {
        grids.push_back(grid_json(*model.space(), grid, number));
    }
    Json models = Json::array();
    for (std::size_t i = 0; i < parts.models.size(); ++i) {
        models.push_back(
            model_json(parts.models[i].coefficients(), model.kriging_inputs(static_cast<int>(i))));
    }
    Json materials = Json::array();
    for (const ExportMaterial& material : content.materials) {
        materials.push_back(material_json(material));
    }
    const std::vector<int>& nodes = number.nodes();
    return {
        {"program", std::string("couture ") + COUTURE_VERSION},
        {"title", content.title},
        {"units", {{"length", content.length_unit}, {"stress", content.stress_unit}}},
        {"no_stress", content.no_stress},
        {"n_cells", content.n_cells},
        {"n_nodes", nodes.size()},
        {"n_validated", parts.calibration.n_points},
        {"von_mises_calibration", parts.calibration.von_mises},
        {"parameters", parameters_json(parts, content)},
        {"materials", std::move(materials)},
        {"material_of_patch", content.material_of_patch},
        {"geometry",
         part_json(parts.geometry, parts.models[parts.geometry.i_model], parts.calibration.geometry,
                   rows_of(model.geometry_mean(), nodes), rows_of(model.geometry_modes(), nodes))},
        {"displacement",
         part_json(parts.displacement, parts.models[parts.displacement.i_model],
                   parts.calibration.displacement, rows_of(model.displacement_mean(), nodes),
                   rows_of(model.displacement_modes(), nodes))},
        {"models", std::move(models)},
        {"amplitude",
         parts.amplitude
             ? model_json(*parts.amplitude, model.kriging_inputs(parts.displacement.i_model))
             : Json()},
        {"grids", std::move(grids)},
        {"colors", colors_json()}};
}

/// Text within <script>: no tag begins there.
std::string without_tags(const std::string& json) {
    std::string text;
    text.reserve(json.size());
    for (const char c : json) {
        if (c == '<') {
            text += "\\u003c";
        } else {
            text += c;
        }
    }
    return text;
}

}  // namespace

std::string make_rom_page(const rom::ReducedModel& model, const ExportContent& content) {
    constexpr std::string_view place = "/*COUTURE_MODEL*/";
    const std::size_t at = built_in_page_text.find(place);
    std::string page(built_in_page_text.substr(0, at));
    page += without_tags(page_json(model, content).dump());
    page += built_in_page_text.substr(at + place.size());
    return page;
}

}  // namespace couture::io
