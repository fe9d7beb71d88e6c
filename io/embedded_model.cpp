#include "io/embedded_model.h"

#include <bit>
#include <cstdint>
#include <string_view>

#include "rom/grid_kernel.h"

namespace couture::io {

namespace {

constexpr std::string_view magic = "COUTROM\n";
constexpr int version = 2;

/// Appends numbers in little-endian order.
class Bytes {
  public:
    void integer(std::int64_t value) {
        const auto bits = static_cast<std::uint64_t>(value);
        for (unsigned shift = 0; shift < 64; shift += 8) {
            text_ += static_cast<char>(bits >> shift & 0xffU);
        }
    }
    void number(double value) { integer(std::bit_cast<std::int64_t>(value)); }
    void text(std::string_view value) {
        integer(static_cast<std::int64_t>(value.size()));
        text_ += value;
    }
    template <typename Integers>
    void integers(const Integers& values) {
        for (const auto value : values) integer(value);
    }
    void numbers(const std::vector<double>& values) {
        for (const double value : values) number(value);
    }
    /// Row by row.
    void matrix(const MatrixX& values) {
        for (Eigen::Index i = 0; i < values.rows(); ++i) {
            for (Eigen::Index j = 0; j < values.cols(); ++j) number(values(i, j));
        }
    }
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    std::string text_;
};

std::int64_t fnv_1a(std::string_view text) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const char c : text) {
        hash ^= static_cast<unsigned char>(c);
        hash *= 0x100000001b3ULL;
    }
    return static_cast<std::int64_t>(hash);
}

void add_parameters(Bytes& out, const rom::ReducedModelParts& parts) {
    out.integer(parts.parameters.size());
    for (int i = 0; i < parts.parameters.size(); ++i) {
        const rom::Parameter& one = parts.parameters.parameters()[i];
        out.text(one.name);
        out.text(one.unit);
        out.integer(one.is_periodic ? 1 : 0);
        out.number(one.lower);
        out.number(one.upper);
        out.number(parts.reference_point[i]);
        out.integer(parts.factor_power[i]);
    }
}

// @param i_same  an earlier coefficient with the same system, which is not repeated; -1: none
void add_kriging(Bytes& out, const rom::Kriging& one, std::int64_t i_same) {
    out.matrix(one.parameters().lengths);
    out.matrix(one.trend_coefficients());
    out.matrix(one.weights());
    out.number(one.process_variance());
    out.integer(i_same);
    if (i_same >= 0) return;
    const rom::CorrelationMatrix& K = one.system()->correlation_matrix();
    if (K.eigenvectors().empty()) {
        out.matrix(K.cholesky_factor());
    } else {
        for (const MatrixX& Q : K.eigenvectors()) out.matrix(Q);
        out.matrix(K.eigenvalues());
    }
    out.matrix(one.system()->K_inverse_F());
    out.matrix(one.system()->trend_factor());
}

void add_coefficients(Bytes& out, const rom::CoefficientModel& model,
                      const rom::KrigingInputs& inputs) {
    out.integer(inputs.size());
    out.integers(inputs.parameters());
    for (const rom::KrigingInputs::Wave wave : inputs.waves()) {
        out.integer(wave == rom::KrigingInputs::Wave::cosine ? 1
                    : wave == rom::KrigingInputs::Wave::sine ? 2
                                                             : 0);
    }
    out.integer(model.n_coefficients());
    if (model.models().empty()) {
        out.matrix(model.training());
        return;
    }
    out.integer(model.options().correlation == rom::CorrelationKind::gaussian ? 1 : 0);
    out.integer(static_cast<int>(model.options().trend));
    out.integer(static_cast<std::int64_t>(model.design().factors.size()));
    for (const MatrixX& points : model.design().factors) {
        out.integer(points.rows());
        out.integer(points.cols());
        out.matrix(points);
    }
    const std::vector<rom::Kriging>& models = model.models();
    for (std::size_t k = 0; k < models.size(); ++k) {
        std::size_t same = 0;
        while (models[same].system() != models[k].system()) ++same;
        add_kriging(out, models[k], same < k ? static_cast<std::int64_t>(same) : -1);
    }
}

void add_part(Bytes& out, const rom::FieldPart& part, double calibration, const VectorX& mean,
              const MatrixX& modes) {
    out.integer(part.i_model);
    out.integer(modes.cols());
    out.matrix(part.gram);
    for (const double value : {part.truncation, part.leave_one_out_ratio, part.size, calibration}) {
        out.number(value);
    }
    out.matrix(mean);
    out.matrix(modes.transpose());
}

void add_modulus(Bytes& out, const ExportModulus& modulus) {
    out.number(modulus.value);
    out.integer(modulus.i_parameter.value_or(-1));
}

void add_materials(Bytes& out, const ExportContent& content) {
    out.integer(static_cast<std::int64_t>(content.materials.size()));
    for (const ExportMaterial& material : content.materials) {
        out.integer(material.follows_parameters ? 1 : 0);
        if (material.follows_parameters) {
            add_modulus(out, material.youngs_modulus);
            add_modulus(out, material.poissons_ratio);
        } else {
            out.matrix(material.stiffness);
        }
    }
    out.integer(static_cast<std::int64_t>(content.material_of_patch.size()));
    out.integers(content.material_of_patch);
}

void add_grid(Bytes& out, const iga::Space<3>& space, const rom::SampleGrid& grid) {
    const iga::TensorSpace<3>& tensor = space.tensor(grid.patch);
    std::vector<rom::LineTable> tables;
    out.integer(grid.patch);
    for (int k = 0; k < 3; ++k) {
        const rom::LineTable& table = tables.emplace_back(tensor.knots[k], grid.parameters[k]);
        out.integer(table.n_points());
        out.integer(table.n_functions);
        out.integer(table.n_active);
        out.integers(table.starts);
        out.numbers(table.values);
        out.numbers(table.derivatives);
    }
    std::vector<double> weights;
    for (int c = 0; c < tables[2].n_functions; ++c) {
        for (int b = 0; b < tables[1].n_functions; ++b) {
            for (int a = 0; a < tables[0].n_functions; ++a) {
                const int function =
                    tensor.index({tables[0].first + a, tables[1].first + b, tables[2].first + c});
                out.integer(space.dofs(grid.patch)[function]);
                if (space.weights(grid.patch).size() > 0) {
                    weights.push_back(space.weights(grid.patch)[function]);
                }
            }
        }
    }
    out.integer(static_cast<std::int64_t>(weights.size()));
    out.numbers(weights);
}

}  // namespace

std::string to_embedded(const rom::ReducedModel& model, const ExportContent& content) {
    const rom::ReducedModelParts& parts = model.parts();
    Bytes body;
    for (const std::string& text : {content.title, content.length_unit, content.stress_unit,
                                    content.no_stress, std::string("couture ") + COUTURE_VERSION}) {
        body.text(text);
    }
    add_parameters(body, parts);
    body.integer(model.n_nodes());
    body.integer(static_cast<std::int64_t>(parts.models.size()));
    for (std::size_t i = 0; i < parts.models.size(); ++i) {
        add_coefficients(body, parts.models[i].coefficients(),
                         model.kriging_inputs(static_cast<int>(i)));
    }
    body.integer(parts.amplitude ? 1 : 0);
    if (parts.amplitude) {
        add_coefficients(body, *parts.amplitude, model.kriging_inputs(parts.displacement.i_model));
    }
    add_part(body, parts.geometry, parts.calibration.geometry, model.geometry_mean(),
             model.geometry_modes());
    add_part(body, parts.displacement, parts.calibration.displacement, model.displacement_mean(),
             model.displacement_modes());
    body.number(parts.calibration.von_mises);
    body.integer(parts.calibration.n_points);
    add_materials(body, content);
    body.integer(static_cast<std::int64_t>(content.grids.size()));
    for (const rom::SampleGrid& grid : content.grids) add_grid(body, *model.space(), grid);

    Bytes file;
    file.integer(version);
    constexpr std::size_t n_header = 8 + 3 * 8;
    file.integer(static_cast<std::int64_t>(n_header + body.text().size()));
    file.integer(fnv_1a(body.text()));
    return std::string(magic) + file.text() + body.text();
}

}  // namespace couture::io
