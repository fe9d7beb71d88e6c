#pragma once

// A reduced model in other programs: one header, C++17, nothing but the standard library.
//
//   couture rom export part.rom --binary part.bin
//
//   const auto model = couture_rom::Model::load("part.bin");
//   std::vector<double> point = model.reference_point();
//   point[model.index_of("radius")] = 12.5;
//   const couture_rom::Answer answer = model.evaluate(point);
//   // answer.von_mises[i] at answer.points[3 i], [3 i + 1], [3 i + 2]
//
// Numbers are in the units of the deck that the model was trained by. Formulas are those of
// couture rom eval, which gives the same to rounding. The file's layout is in io/embedded_model.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace couture_rom {

/// What is wrong with a file or a point, with its name and values.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

struct Parameter {
    std::string name;
    /// Empty without one.
    std::string unit;
    /// Both ends of the range are one state.
    bool is_periodic = false;
    /// Range that the model learned in.
    double lower = 0.0;
    double upper = 0.0;
    /// Of the reference member.
    double reference = 0.0;
    /// 1: the displacement is proportional to it; -1: to its inverse; 0: neither.
    int factor_power = 0;
};

/// Error that the model expects of a field: lengths are root mean squares over the member.
struct ErrorEstimate {
    double truncation = 0.0;
    double kriging = 0.0;
    /// Both together, calibrated by validation.
    double total = 0.0;
    /// total over the field's length.
    double relative = 0.0;
};

struct Answer {
    /// Of modes.
    std::vector<double> geometry_coefficients;
    std::vector<double> displacement_coefficients;
    /// Of the displacement's coefficients.
    std::vector<double> standard_errors;
    /// At each sample point: place on the undeformed member and displacement, 3 numbers each.
    std::vector<double> points;
    std::vector<double> displacements;
    /// One number each; empty if the model has no stresses.
    std::vector<double> von_mises;
    double displacement_max = 0.0;
    double von_mises_max = 0.0;
    /// Sample point with the largest von Mises stress.
    std::size_t i_von_mises_max = 0;
    ErrorEstimate geometry_error;
    ErrorEstimate displacement_error;
    /// Relative.
    double von_mises_error = 0.0;
    /// Parameters outside of their ranges.
    std::vector<std::string> warnings;
};

namespace detail {

using Vector = std::vector<double>;
using Integers = std::vector<std::int64_t>;

inline double dot(const double* a, const double* b, std::size_t n) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) sum += a[i] * b[i];
    return sum;
}

/// Numbers of a file in their order, each checked against its end.
class Reader {
  public:
    Reader(std::string name, std::vector<unsigned char> bytes)
        : name_(std::move(name)), bytes_(std::move(bytes)) {
        static constexpr char magic[] = "COUTROM\n";
        if (bytes_.size() < n_header || std::memcmp(bytes_.data(), magic, 8) != 0) {
            fail("is no model of 'couture rom export --binary', or its beginning was cut off");
        }
        at_ = 8;
        const std::int64_t version = integer();
        if (version != 2) {
            fail("is of version " + std::to_string(version) +
                 ", this program reads version 2; export the model again or take the header of "
                 "that version");
        }
        const std::int64_t size = integer();
        if (size != static_cast<std::int64_t>(bytes_.size())) {
            fail("has " + std::to_string(bytes_.size()) + " bytes, it was written with " +
                 std::to_string(size) + ": it was cut off or changed");
        }
        const std::int64_t checksum = integer();
        std::uint64_t hash = 0xcbf29ce484222325ULL;
        for (std::size_t i = n_header; i < bytes_.size(); ++i) {
            hash = (hash ^ bytes_[i]) * 0x100000001b3ULL;
        }
        if (static_cast<std::int64_t>(hash) != checksum) {
            fail("was changed: its checksum differs");
        }
    }

    [[noreturn]] void fail(const std::string& what) const { throw Error(name_ + ": " + what); }
    void expect(bool is_right, const char* what) const {
        if (!is_right) fail(std::string("does not fit together: ") + what);
    }

    std::int64_t integer() {
        expect(bytes_.size() - at_ >= 8, "it ends too early");
        std::uint64_t bits = 0;
        for (unsigned i = 0; i < 8; ++i) {
            bits |= static_cast<std::uint64_t>(bytes_[at_++]) << (8 * i);
        }
        std::int64_t value = 0;
        std::memcpy(&value, &bits, 8);
        return value;
    }
    /// In [low, high].
    std::int64_t integer(std::int64_t low, std::int64_t high, const char* what) {
        const std::int64_t value = integer();
        expect(value >= low && value <= high, what);
        return value;
    }
    /// Of things that take at least 8 bytes each.
    std::size_t count(const char* what) {
        return static_cast<std::size_t>(
            integer(0, static_cast<std::int64_t>((bytes_.size() - at_) / 8), what));
    }
    /// Of two counts, no more than the file has bytes.
    std::size_t product(std::size_t a, std::size_t b) const {
        expect(b == 0 || a <= bytes_.size() / b, "it ends too early");
        return a * b;
    }
    double number() {
        const std::int64_t bits = integer();
        double value = 0.0;
        std::memcpy(&value, &bits, 8);
        return value;
    }
    std::string text() {
        const auto n = static_cast<std::size_t>(
            integer(0, static_cast<std::int64_t>(bytes_.size() - at_), "a text is too long"));
        std::string value(bytes_.begin() + static_cast<std::ptrdiff_t>(at_),
                          bytes_.begin() + static_cast<std::ptrdiff_t>(at_ + n));
        at_ += n;
        return value;
    }
    Vector numbers(std::size_t n) {
        require(n);
        Vector values(n);
        for (double& value : values) value = number();
        return values;
    }
    /// Each in [low, high].
    Integers integers(std::size_t n, std::int64_t low, std::int64_t high, const char* what) {
        require(n);
        Integers values(n);
        for (std::int64_t& value : values) value = integer(low, high, what);
        return values;
    }
    void expect_end() const { expect(at_ == bytes_.size(), "there are bytes after its end"); }

  private:
    void require(std::size_t n) const {
        expect(n <= (bytes_.size() - at_) / 8, "it ends too early");
    }

    static constexpr std::size_t n_header = 32;
    std::string name_;
    std::vector<unsigned char> bytes_;
    std::size_t at_ = 0;
};

/// Points of one factor of a tensor design.
struct Factor {
    std::size_t n_points = 0;
    std::size_t n_inputs = 0;
    Vector points;
};

/// Kriging of one coefficient.
struct Kriging {
    Vector lengths;
    Vector trend;
    Vector weights;
    double variance = 0.0;
    /// An earlier coefficient that all below and the lengths are the same of; -1: none.
    std::int64_t i_same = -1;
    /// One factor: of K; several: none.
    Vector cholesky;
    std::vector<Vector> eigenvectors;
    Vector eigenvalues;
    Vector K_inverse_F;
    Vector trend_cholesky;
};

/// L^-1 b of a lower matrix, row by row.
inline Vector forward(const Vector& L, const Vector& b) {
    const std::size_t n = b.size();
    Vector x(n);
    for (std::size_t i = 0; i < n; ++i) {
        x[i] = (b[i] - dot(&L[i * n], x.data(), i)) / L[i * n + i];
    }
    return x;
}

/// Coefficients of modes over inputs in the unit cube.
class CoefficientModel {
  public:
    CoefficientModel(Reader& reader, std::int64_t n_parameters) {
        const std::size_t n_inputs = reader.count("numbers of inputs");
        inputs_ = reader.integers(n_inputs, 0, n_parameters - 1, "an input is no parameter");
        waves_ = reader.integers(n_inputs, 0, 2, "kind of an input");
        const std::size_t n = reader.count("numbers of coefficients");
        if (n_inputs == 0) {
            constants_ = reader.numbers(n);
            return;
        }
        is_gaussian_ = reader.integer(0, 1, "kind of correlation") != 0;
        trend_degree_ = reader.integer(0, 2, "kind of trend");
        const std::size_t n_factors = reader.count("numbers of factors");
        std::size_t n_factor_inputs = 0;
        for (std::size_t g = 0; g < n_factors; ++g) {
            Factor factor;
            factor.n_points = reader.count("points of a factor");
            factor.n_inputs = reader.count("inputs of a factor");
            reader.expect(factor.n_points > 0, "a factor without points");
            factor.points = reader.numbers(reader.product(factor.n_points, factor.n_inputs));
            n_points_ = reader.product(n_points_, factor.n_points);
            n_factor_inputs += factor.n_inputs;
            factors_.push_back(std::move(factor));
        }
        reader.expect(n_factors > 0 && n_factor_inputs == n_inputs, "inputs of the factors");
        const std::size_t n_trend = trend_functions(Vector(n_inputs, 0.0)).size();
        for (std::size_t k = 0; k < n; ++k) {
            Kriging one;
            one.lengths = reader.numbers(n_inputs);
            one.trend = reader.numbers(n_trend);
            one.weights = reader.numbers(n_points_);
            one.variance = reader.number();
            one.i_same = reader.integer(-1, static_cast<std::int64_t>(k) - 1, "shared coefficient");
            if (one.i_same >= 0) {
                models_.push_back(std::move(one));
                continue;
            }
            if (n_factors == 1) {
                one.cholesky = reader.numbers(reader.product(n_points_, n_points_));
            } else {
                for (const Factor& factor : factors_) {
                    one.eigenvectors.push_back(
                        reader.numbers(reader.product(factor.n_points, factor.n_points)));
                }
                one.eigenvalues = reader.numbers(n_points_);
            }
            one.K_inverse_F = reader.numbers(reader.product(n_points_, n_trend));
            one.trend_cholesky = reader.numbers(reader.product(n_trend, n_trend));
            models_.push_back(std::move(one));
        }
    }

    std::size_t n_coefficients() const {
        return inputs_.empty() ? constants_.size() : models_.size();
    }

    /// @param unit_point  of all parameters
    Vector values(const Vector& unit_point) const {
        if (inputs_.empty()) return constants_;
        const Vector x = inputs_of(unit_point);
        const Vector f = trend_functions(x);
        Vector result;
        Vector k;
        for (std::size_t i = 0; i < models_.size(); ++i) {
            const Kriging& one = models_[i];
            if (!follows(i)) k = correlations(one, x);
            result.push_back(dot(f.data(), one.trend.data(), f.size()) +
                             dot(k.data(), one.weights.data(), k.size()));
        }
        return result;
    }

    Vector variances(const Vector& unit_point) const {
        if (inputs_.empty()) return Vector(constants_.size(), 0.0);
        const Vector x = inputs_of(unit_point);
        const Vector f = trend_functions(x);
        Vector result;
        for (const Kriging& one : models_) {
            if (one.i_same >= 0) {
                const auto same = static_cast<std::size_t>(one.i_same);
                result.push_back(result[same] / models_[same].variance * one.variance);
                continue;
            }
            const Vector k = correlations(one, x);
            Vector left(f.size());
            for (std::size_t t = 0; t < f.size(); ++t) {
                left[t] = -f[t];
                for (std::size_t j = 0; j < k.size(); ++j) {
                    left[t] += one.K_inverse_F[j * f.size() + t] * k[j];
                }
            }
            const Vector u = forward(one.trend_cholesky, left);
            const double rest = 1.0 - inverse_product(one, k) + dot(u.data(), u.data(), u.size());
            result.push_back(one.variance * std::max(0.0, rest));
        }
        return result;
    }

  private:
    /// The coefficient has the correlations of the one before it.
    bool follows(std::size_t i) const {
        const auto first = [&](std::size_t j) {
            return models_[j].i_same >= 0 ? models_[j].i_same : static_cast<std::int64_t>(j);
        };
        return i > 0 && first(i) == first(i - 1);
    }
    Vector inputs_of(const Vector& unit_point) const {
        Vector x;
        for (std::size_t k = 0; k < inputs_.size(); ++k) {
            const double t = unit_point[static_cast<std::size_t>(inputs_[k])];
            constexpr double turn = 6.283185307179586;
            x.push_back(waves_[k] == 0   ? t
                        : waves_[k] == 1 ? 0.5 * (1.0 + std::cos(turn * t))
                                         : 0.5 * (1.0 + std::sin(turn * t)));
        }
        return x;
    }
    Vector trend_functions(const Vector& x) const {
        Vector f = {1.0};
        if (trend_degree_ > 0) f.insert(f.end(), x.begin(), x.end());
        for (std::size_t i = 0; trend_degree_ > 1 && i < x.size(); ++i) {
            for (std::size_t j = i; j < x.size(); ++j) f.push_back(x[i] * x[j]);
        }
        return f;
    }
    /// With all points of the design, the last factor fastest.
    Vector correlations(const Kriging& one, const Vector& x) const {
        Vector product = {1.0};
        std::size_t first = 0;
        for (const Factor& factor : factors_) {
            Vector next;
            next.reserve(product.size() * factor.n_points);
            Vector row(factor.n_points);
            for (std::size_t j = 0; j < factor.n_points; ++j) {
                double exponent = 0.0;
                double polynomial = 1.0;
                for (std::size_t axis = 0; axis < factor.n_inputs; ++axis) {
                    const double r =
                        std::abs(x[first + axis] - factor.points[j * factor.n_inputs + axis]) /
                        one.lengths[first + axis];
                    const double s = is_gaussian_ ? r : std::sqrt(5.0) * r;
                    exponent += is_gaussian_ ? 0.5 * s * s : s;
                    if (!is_gaussian_) polynomial *= 1.0 + s + s * s * (1.0 / 3.0);
                }
                row[j] = polynomial * std::exp(-exponent);
            }
            for (const double a : product) {
                for (const double b : row) next.push_back(a * b);
            }
            product = std::move(next);
            first += factor.n_inputs;
        }
        return product;
    }
    /// k^T K^-1 k.
    double inverse_product(const Kriging& one, Vector k) const {
        if (one.eigenvectors.empty()) {
            const Vector x = forward(one.cholesky, k);
            return dot(x.data(), x.data(), x.size());
        }
        // Q^T k, factor by factor.
        std::size_t after = n_points_;
        for (std::size_t g = 0; g < factors_.size(); ++g) {
            const std::size_t n = factors_[g].n_points;
            after /= n;
            Vector next(n_points_, 0.0);
            for (std::size_t block = 0; block < n_points_; block += n * after) {
                for (std::size_t i = 0; i < n; ++i) {
                    for (std::size_t j = 0; j < n; ++j) {
                        const double q = one.eigenvectors[g][j * n + i];
                        for (std::size_t a = 0; a < after; ++a) {
                            next[block + i * after + a] += q * k[block + j * after + a];
                        }
                    }
                }
            }
            k = std::move(next);
        }
        double sum = 0.0;
        for (std::size_t i = 0; i < k.size(); ++i) sum += k[i] * k[i] / one.eigenvalues[i];
        return sum;
    }

    Integers inputs_;
    /// 0: values; of periodic parameters 1: cosines, 2: sines.
    Integers waves_;
    Vector constants_;
    bool is_gaussian_ = false;
    /// 0 constant, 1 linear, 2 quadratic with all products.
    std::int64_t trend_degree_ = 0;
    std::vector<Factor> factors_;
    std::size_t n_points_ = 1;
    std::vector<Kriging> models_;
};

/// Geometry or displacement: mean and modes of control points.
struct Part {
    std::size_t i_model = 0;
    std::size_t n_modes = 0;
    Vector gram;
    double truncation = 0.0;
    double leave_one_out_ratio = 1.0;
    double size = 0.0;
    double calibration = 1.0;
    Vector mean;
    Vector modes;

    Part(Reader& reader, std::size_t n_values, const std::vector<CoefficientModel>& models) {
        i_model =
            static_cast<std::size_t>(reader.integer(0, static_cast<std::int64_t>(models.size()) - 1,
                                                    "a field of a model that is not there"));
        n_modes = reader.count("numbers of modes");
        reader.expect(n_modes == models[i_model].n_coefficients(), "modes and coefficients");
        gram = reader.numbers(reader.product(n_modes, n_modes));
        truncation = reader.number();
        leave_one_out_ratio = reader.number();
        size = reader.number();
        calibration = reader.number();
        mean = reader.numbers(n_values);
        modes = reader.numbers(reader.product(n_modes, n_values));
    }

    Vector field(const Vector& coefficients, double factor) const {
        Vector values = mean;
        for (std::size_t k = 0; k < n_modes; ++k) {
            const double* mode = &modes[k * mean.size()];
            for (std::size_t i = 0; i < values.size(); ++i) values[i] += coefficients[k] * mode[i];
        }
        for (double& value : values) value *= factor;
        return values;
    }

    /// @param length  of the field, that `relative` refers to; negative: from its coefficients
    /// @param amplitude_error  standard error of the logarithm of a factor on it
    ErrorEstimate estimate(const Vector& variances, const Vector& coefficients, double factor,
                           double length, double amplitude_error = 0.0) const {
        const double scale = std::abs(factor);
        double expected = 0.0;
        double square = size * size;
        for (std::size_t i = 0; i < n_modes; ++i) {
            expected += variances[i] * gram[i * n_modes + i];
            square += coefficients[i] * dot(&gram[i * n_modes], coefficients.data(), n_modes);
        }
        ErrorEstimate error;
        error.truncation = scale * truncation;
        if (length < 0.0) length = scale * std::sqrt(std::max(square, 0.0));
        error.kriging = std::hypot(scale * std::sqrt(expected), length * amplitude_error);
        error.total =
            calibration * std::hypot(error.truncation, leave_one_out_ratio * error.kriging);
        error.relative = length > 0.0 ? error.total / length : 0.0;
        return error;
    }
};

/// A number, times a parameter or by itself.
struct Modulus {
    double value = 0.0;
    std::int64_t i_parameter = -1;

    double at(const Vector& point) const {
        return i_parameter < 0 ? value : value * point[static_cast<std::size_t>(i_parameter)];
    }
};

using Stiffness = std::array<double, 36>;

struct Material {
    bool follows_parameters = false;
    Stiffness stiffness{};
    Modulus youngs_modulus;
    Modulus poissons_ratio;

    Material(Reader& reader, std::int64_t n_parameters) {
        follows_parameters = reader.integer(0, 1, "kind of material") != 0;
        if (!follows_parameters) {
            const Vector values = reader.numbers(stiffness.size());
            std::copy(values.begin(), values.end(), stiffness.begin());
            return;
        }
        for (Modulus* one : {&youngs_modulus, &poissons_ratio}) {
            one->value = reader.number();
            one->i_parameter = reader.integer(-1, n_parameters - 1, "parameter of a material");
        }
    }

    Stiffness at(const Vector& point) const {
        if (!follows_parameters) return stiffness;
        const double E = youngs_modulus.at(point);
        const double nu = poissons_ratio.at(point);
        const double lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
        const double mu = E / (2.0 * (1.0 + nu));
        Stiffness C{};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) C[6 * i + j] = lambda + (i == j ? 2.0 * mu : 0.0);
            C[6 * (i + 3) + i + 3] = mu;
        }
        return C;
    }
};

/// Functions of one direction at the points of a grid.
struct Line {
    std::size_t n_points = 0;
    std::size_t n_functions = 0;
    std::size_t n_active = 0;
    Integers starts;
    Vector values;
    Vector derivatives;

    explicit Line(Reader& reader) {
        n_points = reader.count("points of a grid");
        n_functions = reader.count("functions of a grid");
        n_active = reader.count("functions of a point");
        reader.expect(n_points > 0 && n_active > 0 && n_active <= n_functions,
                      "points of a grid and their functions");
        starts = reader.integers(n_points, 0, static_cast<std::int64_t>(n_functions - n_active),
                                 "first function of a point");
        values = reader.numbers(reader.product(n_points, n_active));
        derivatives = reader.numbers(reader.product(n_points, n_active));
    }
};

/// What is summed at a point: 3 of the geometry, 3 of the displacement, 1 of the weights; value and
/// derivatives by the 3 parameters of the patch.
constexpr std::size_t n_fields = 7;
using FieldValues = std::array<std::array<double, n_fields>, 4>;

/// Sample points of a patch, first direction fastest.
class Grid {
  public:
    Grid(Reader& reader, std::int64_t n_patches, std::int64_t n_nodes)
        : patch_(static_cast<std::size_t>(
              reader.integer(0, n_patches - 1, "a grid of a patch that is not there"))),
          lines_{Line(reader), Line(reader), Line(reader)} {
        const std::size_t n = reader.product(
            reader.product(lines_[0].n_functions, lines_[1].n_functions), lines_[2].n_functions);
        nodes_ = reader.integers(n, 0, n_nodes - 1, "a node that is not there");
        const std::size_t n_weights = reader.count("numbers of weights");
        reader.expect(n_weights == 0 || n_weights == n, "numbers of weights");
        weights_ = reader.numbers(n_weights);
    }

    std::size_t patch() const { return patch_; }
    std::size_t n_points() const {
        return lines_[0].n_points * lines_[1].n_points * lines_[2].n_points;
    }

    /// Calls body(field values) for all points in their order.
    template <typename Body>
    void visit(const Vector& X, const Vector& U, const Body& body) const {
        const Vector net = gather(X, U);
        const std::size_t n_row = lines_[0].n_functions * n_fields;
        const std::size_t n_plane = lines_[1].n_functions * n_row;
        // Value and derivative along direction 2; then these and the derivative along direction 1.
        Vector planes(2 * n_plane);
        Vector rows(3 * n_row);
        for (std::size_t c = 0; c < lines_[2].n_points; ++c) {
            std::fill(planes.begin(), planes.end(), 0.0);
            add(lines_[2], c, net.data(), n_plane, planes.data(), &planes[n_plane]);
            for (std::size_t b = 0; b < lines_[1].n_points; ++b) {
                std::fill(rows.begin(), rows.end(), 0.0);
                add(lines_[1], b, planes.data(), n_row, rows.data(), &rows[n_row]);
                add(lines_[1], b, &planes[n_plane], n_row, &rows[2 * n_row], nullptr);
                for (std::size_t a = 0; a < lines_[0].n_points; ++a) {
                    FieldValues out{};
                    add(lines_[0], a, rows.data(), n_fields, out[0].data(), out[1].data());
                    add(lines_[0], a, &rows[n_row], n_fields, out[2].data(), nullptr);
                    add(lines_[0], a, &rows[2 * n_row], n_fields, out[3].data(), nullptr);
                    if (!weights_.empty()) divide(out);
                    body(out);
                }
            }
        }
    }

  private:
    Vector gather(const Vector& X, const Vector& U) const {
        Vector net(nodes_.size() * n_fields);
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const std::size_t first = 3 * static_cast<std::size_t>(nodes_[i]);
            const double weight = weights_.empty() ? 1.0 : weights_[i];
            for (std::size_t k = 0; k < 3; ++k) {
                net[i * n_fields + k] = weight * X[first + k];
                net[i * n_fields + 3 + k] = weight * U[first + k];
            }
            net[i * n_fields + 6] = weight;
        }
        return net;
    }
    /// Sums of the functions at a point times blocks of n numbers.
    static void add(const Line& line, std::size_t i_point, const double* blocks, std::size_t n,
                    double* value, double* derivative) {
        for (std::size_t j = 0; j < line.n_active; ++j) {
            const double* from = blocks + (static_cast<std::size_t>(line.starts[i_point]) + j) * n;
            const double N = line.values[i_point * line.n_active + j];
            const double dN = line.derivatives[i_point * line.n_active + j];
            for (std::size_t i = 0; i < n; ++i) value[i] += N * from[i];
            if (derivative == nullptr) continue;
            for (std::size_t i = 0; i < n; ++i) derivative[i] += dN * from[i];
        }
    }
    /// Of rational functions.
    static void divide(FieldValues& fields) {
        const double W = fields[0][6];
        for (std::size_t i = 0; i < 6; ++i) fields[0][i] /= W;
        for (std::size_t k = 1; k < 4; ++k) {
            for (std::size_t i = 0; i < 6; ++i) {
                fields[k][i] = (fields[k][i] - fields[0][i] * fields[k][6]) / W;
            }
        }
    }

    std::size_t patch_;
    std::array<Line, 3> lines_;
    Integers nodes_;
    Vector weights_;
};

/// Von Mises stress of small strain.
inline double von_mises(const FieldValues& fields, const Stiffness& C) {
    // J[i][k] = dx_i / dxi_k, cofactors, H = dU/dxi J^-1.
    const auto J = [&](std::size_t i, std::size_t k) { return fields[1 + k][i]; };
    std::array<std::array<double, 3>, 3> cofactor{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i1 = (i + 1) % 3;
            const std::size_t i2 = (i + 2) % 3;
            const std::size_t k1 = (k + 1) % 3;
            const std::size_t k2 = (k + 2) % 3;
            cofactor[i][k] = J(i1, k1) * J(i2, k2) - J(i1, k2) * J(i2, k1);
        }
    }
    const double det =
        J(0, 0) * cofactor[0][0] + J(0, 1) * cofactor[0][1] + J(0, 2) * cofactor[0][2];
    std::array<std::array<double, 3>, 3> H{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t k = 0; k < 3; ++k) H[i][j] += fields[1 + k][3 + i] * cofactor[j][k];
            H[i][j] /= det;
        }
    }
    const std::array<double, 6> strain = {H[0][0],           H[1][1],           H[2][2],
                                          H[1][2] + H[2][1], H[0][2] + H[2][0], H[0][1] + H[1][0]};
    std::array<double, 6> s{};
    for (std::size_t a = 0; a < 6; ++a) s[a] = dot(&C[6 * a], strain.data(), 6);
    const double a = s[0] - s[1];
    const double b = s[1] - s[2];
    const double c = s[2] - s[0];
    return std::sqrt(0.5 * (a * a + b * b + c * c) +
                     3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

}  // namespace detail

/// Geometry, displacement, stress and expected error of a part over its parameters. Evaluations
/// change nothing: threads may share a model.
class Model {
  public:
    /// @throws Error  for a file that can't be read, was cut off or changed, or of another version
    static Model load(const std::string& file) {
        std::ifstream stream(file, std::ios::binary);
        if (!stream) throw Error(file + ": can't be opened");
        std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(stream),
                                         std::istreambuf_iterator<char>()};
        if (stream.bad()) throw Error(file + ": can't be read");
        return from_bytes(std::move(bytes), file);
    }
    /// @param name  for messages
    static Model from_bytes(std::vector<unsigned char> bytes, const std::string& name = "model") {
        return Model(detail::Reader(name, std::move(bytes)));
    }

    const std::string& title() const { return title_; }
    /// The version that wrote it, "couture 0.1.0".
    const std::string& program() const { return program_; }
    const std::string& length_unit() const { return length_unit_; }
    const std::string& stress_unit() const { return stress_unit_; }
    const std::vector<Parameter>& parameters() const { return parameters_; }
    /// Empty if there are stresses.
    const std::string& why_no_stress() const { return no_stress_; }
    /// Full solutions that error estimates are calibrated by; 0: they are not.
    int n_validated() const { return n_validated_; }
    std::size_t n_points() const {
        std::size_t n = 0;
        for (const detail::Grid& grid : grids_) n += grid.n_points();
        return n;
    }

    /// @throws Error  for a name that there is not: lists those there are
    std::size_t index_of(const std::string& name) const {
        std::string names;
        for (std::size_t i = 0; i < parameters_.size(); ++i) {
            if (parameters_[i].name == name) return i;
            names += (i > 0 ? ", " : "") + parameters_[i].name;
        }
        throw Error("no parameter is called '" + name + "'; there are " + names);
    }
    /// A value for each parameter, in its unit.
    std::vector<double> reference_point() const {
        std::vector<double> point;
        for (const Parameter& one : parameters_) point.push_back(one.reference);
        return point;
    }

    /// @param point  a value for each parameter, in its unit; outside of its range with a warning
    /// @throws Error  for another number of values, or one that is not finite
    Answer evaluate(const std::vector<double>& point) const {
        Answer answer;
        const std::vector<double> unit = unit_point(point, answer.warnings);
        const double factor = factor_at(point, unit);
        answer.geometry_coefficients = models_[geometry_->i_model].values(unit);
        answer.displacement_coefficients = models_[displacement_->i_model].values(unit);
        estimate_errors(unit, factor, answer);
        const std::vector<double> X = geometry_->field(answer.geometry_coefficients, 1.0);
        const std::vector<double> U =
            displacement_->field(answer.displacement_coefficients, factor);
        sample(point, X, U, answer);
        return answer;
    }

  private:
    explicit Model(detail::Reader reader) {
        for (std::string* text : {&title_, &length_unit_, &stress_unit_, &no_stress_, &program_}) {
            *text = reader.text();
        }
        const std::size_t n_parameters = reader.count("numbers of parameters");
        for (std::size_t i = 0; i < n_parameters; ++i) {
            Parameter one;
            one.name = reader.text();
            one.unit = reader.text();
            one.is_periodic = reader.integer(0, 1, "kind of a parameter") != 0;
            one.lower = reader.number();
            one.upper = reader.number();
            one.reference = reader.number();
            one.factor_power = static_cast<int>(reader.integer(-1, 1, "power of a parameter"));
            parameters_.push_back(std::move(one));
        }
        const auto n = static_cast<std::int64_t>(n_parameters);
        const std::size_t n_nodes = reader.count("numbers of nodes");
        reader.expect(n_nodes > 0, "there are no nodes");
        const std::size_t n_models = reader.count("numbers of models");
        for (std::size_t i = 0; i < n_models; ++i) models_.emplace_back(reader, n);
        if (reader.integer(0, 1, "kind of amplitude") != 0) {
            amplitude_.emplace(reader, n);
            reader.expect(amplitude_->n_coefficients() == 1, "coefficients of the amplitude");
        }
        geometry_.emplace(reader, 3 * n_nodes, models_);
        displacement_.emplace(reader, 3 * n_nodes, models_);
        von_mises_calibration_ = reader.number();
        n_validated_ = static_cast<int>(reader.integer(0, 1'000'000'000, "full solutions"));
        const std::size_t n_materials = reader.count("numbers of materials");
        for (std::size_t i = 0; i < n_materials; ++i) materials_.emplace_back(reader, n);
        const std::size_t n_patches = reader.count("numbers of patches");
        material_of_patch_ = reader.integers(
            n_patches, 0, static_cast<std::int64_t>(n_materials) - 1, "material of a patch");
        const std::size_t n_grids = reader.count("numbers of grids");
        const std::int64_t n_known =
            n_patches > 0 ? static_cast<std::int64_t>(n_patches) : 1'000'000'000;
        for (std::size_t i = 0; i < n_grids; ++i) {
            grids_.emplace_back(reader, n_known, static_cast<std::int64_t>(n_nodes));
        }
        reader.expect(!no_stress_.empty() || n_patches > 0, "stresses without a material");
        reader.expect_end();
    }

    std::vector<double> unit_point(const std::vector<double>& point,
                                   std::vector<std::string>& warnings) const {
        if (point.size() != parameters_.size()) {
            throw Error("a point with " + std::to_string(point.size()) +
                        " values; there must be one for each of " +
                        std::to_string(parameters_.size()) + " parameters");
        }
        std::vector<double> unit;
        constexpr double rounding = 1e-12;
        for (std::size_t i = 0; i < point.size(); ++i) {
            const Parameter& one = parameters_[i];
            if (!std::isfinite(point[i]) || (one.factor_power < 0 && point[i] == 0.0)) {
                throw Error("'" + one.name + "' is " + std::to_string(point[i]) +
                            "; it must be finite" + (one.factor_power < 0 ? " and not 0" : ""));
            }
            const double range = one.upper - one.lower;
            unit.push_back((point[i] - one.lower) / range);
            const double outside = std::max(one.lower - point[i], point[i] - one.upper) / range;
            if (outside > rounding && !one.is_periodic) {
                warnings.push_back(one.name + " = " + std::to_string(point[i]) +
                                   " lies outside of [" + std::to_string(one.lower) + ", " +
                                   std::to_string(one.upper) + "], where the model learned, by " +
                                   std::to_string(std::lround(100.0 * outside)) +
                                   " % of that range");
            }
        }
        return unit;
    }

    double factor_at(const std::vector<double>& point, const std::vector<double>& unit) const {
        double product = 1.0;
        for (std::size_t i = 0; i < point.size(); ++i) {
            const double ratio = point[i] / parameters_[i].reference;
            if (parameters_[i].factor_power > 0) product *= ratio;
            if (parameters_[i].factor_power < 0) product /= ratio;
        }
        if (amplitude_) product *= std::exp(amplitude_->values(unit)[0]);
        return product;
    }

    void estimate_errors(const std::vector<double>& unit, double factor, Answer& answer) const {
        const detail::Part& geometry = *geometry_;
        const detail::Part& displacement = *displacement_;
        const std::vector<double> variances = models_[displacement.i_model].variances(unit);
        for (const double variance : variances) {
            answer.standard_errors.push_back(std::sqrt(variance));
        }
        answer.geometry_error = geometry.estimate(models_[geometry.i_model].variances(unit),
                                                  answer.geometry_coefficients, 1.0, geometry.size);
        answer.displacement_error =
            displacement.estimate(variances, answer.displacement_coefficients, factor, -1.0,
                                  amplitude_ ? std::sqrt(amplitude_->variances(unit)[0]) : 0.0);
        answer.von_mises_error = von_mises_calibration_ * answer.displacement_error.relative;
    }

    void sample(const std::vector<double>& point, const std::vector<double>& X,
                const std::vector<double>& U, Answer& answer) const {
        std::vector<detail::Stiffness> stiffness;
        for (const detail::Material& one : materials_) stiffness.push_back(one.at(point));
        const bool has_stress = no_stress_.empty();
        const std::size_t n = n_points();
        answer.points.reserve(3 * n);
        answer.displacements.reserve(3 * n);
        answer.von_mises.reserve(has_stress ? n : 0);
        for (const detail::Grid& grid : grids_) {
            grid.visit(X, U, [&](const detail::FieldValues& fields) {
                const double* values = fields[0].data();
                answer.points.insert(answer.points.end(), values, values + 3);
                answer.displacements.insert(answer.displacements.end(), values + 3, values + 6);
                answer.displacement_max = std::max(
                    answer.displacement_max, std::sqrt(detail::dot(values + 3, values + 3, 3)));
                if (!has_stress) return;
                const auto material = static_cast<std::size_t>(material_of_patch_[grid.patch()]);
                answer.von_mises.push_back(detail::von_mises(fields, stiffness[material]));
                if (answer.von_mises.back() > answer.von_mises_max) {
                    answer.von_mises_max = answer.von_mises.back();
                    answer.i_von_mises_max = answer.von_mises.size() - 1;
                }
            });
        }
    }

    std::string title_;
    std::string program_;
    std::string length_unit_;
    std::string stress_unit_;
    std::string no_stress_;
    std::vector<Parameter> parameters_;
    std::vector<detail::CoefficientModel> models_;
    /// Of the logarithm of a factor on the displacement.
    std::optional<detail::CoefficientModel> amplitude_;
    std::optional<detail::Part> geometry_;
    std::optional<detail::Part> displacement_;
    double von_mises_calibration_ = 1.0;
    int n_validated_ = 0;
    std::vector<detail::Material> materials_;
    detail::Integers material_of_patch_;
    std::vector<detail::Grid> grids_;
};

}  // namespace couture_rom
