#include "rom/field_model.h"

#include <algorithm>
#include <limits>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "rom/snapshots.h"

namespace couture::rom {

namespace {

/// Position in each factor of a point of the design.
std::vector<int> positions_of(int i_point, const std::vector<int>& sizes) {
    std::vector<int> positions(sizes.size());
    for (std::size_t g = sizes.size(); g-- > 0;) {
        positions[g] = i_point % sizes[g];
        i_point /= sizes[g];
    }
    return positions;
}

}  // namespace

TensorDesign accepted_design(const TensorDesign& design, const std::vector<int>& accepted) {
    const std::vector<int> sizes = design.sizes();
    std::vector<std::vector<char>> is_used;
    for (const int size : sizes) {
        is_used.emplace_back(size, 0);
    }
    for (const int i : accepted) {
        const std::vector<int> positions = positions_of(i, sizes);
        for (std::size_t g = 0; g < sizes.size(); ++g) {
            is_used[g][positions[g]] = 1;
        }
    }
    TensorDesign left;
    for (std::size_t g = 0; g < sizes.size(); ++g) {
        std::vector<int> rows;
        for (int i = 0; i < sizes[g]; ++i) {
            if (is_used[g][i] != 0) {
                rows.push_back(i);
            }
        }
        left.factors.emplace_back(design.factors[g](rows, Eigen::all));
    }
    if (left.n_points() == static_cast<int>(accepted.size())) {
        return left;
    }
    return {{design.points()(accepted, Eigen::all)}};
}

namespace {

FieldModel constant_model(const VectorX& field, std::optional<int> n_modes_asked,
                          const KrigingOptions& kriging) {
    PodBasis basis;
    basis.modes = MatrixX(field.size(), 0);
    return {field, basis, n_modes_asked, CoefficientModel({}, MatrixX(1, 0), kriging)};
}

/// Positions among the accepted points of those whose point of the first factor was refused
/// nothing: what is left is a tensor product.
std::vector<int> complete_points(const TensorDesign& design, const std::vector<int>& accepted) {
    const int n_first = static_cast<int>(design.factors[0].rows());
    const int n_each = design.n_points() / n_first;
    std::vector<int> n_accepted(n_first, 0);
    for (const int i : accepted) {
        ++n_accepted[i / n_each];
    }
    std::vector<int> complete;
    for (std::size_t k = 0; k < accepted.size(); ++k) {
        if (n_accepted[accepted[k] / n_each] == n_each) {
            complete.push_back(static_cast<int>(k));
        }
    }
    return complete;
}

/// Kriging with these parameters, nuggets raised to where K of no coefficient is singular to
/// rounding (a product of small matrices bears less than one large one); nothing if that would be
/// more than noise.
std::optional<CoefficientModel> with_parameters(const TensorDesign& design, const MatrixX& values,
                                                const KrigingOptions& options,
                                                std::vector<KrigingParameters> parameters) {
    constexpr double largest_nugget = 1e-5;
    for (double least = 1e-10; least <= largest_nugget; least *= 10.0) {
        for (KrigingParameters& one : parameters) {
            one.nugget = options.nugget.value_or(std::max(one.nugget, least));
        }
        try {
            return CoefficientModel(design, values, options, parameters);
        } catch (const InputError& error) {
            log::detail(error.what());
            if (options.nugget) {
                break;
            }
        }
    }
    return std::nullopt;
}

/// Of a factor: more are thinned out for the search of lengths.
constexpr Eigen::Index most_points_searched = 400;

/// Points and values of a design whose first factor has only so many of its points, evenly spread.
struct Part {
    TensorDesign design;
    MatrixX values;
};

Part thinned(const TensorDesign& design, const MatrixX& values) {
    const Eigen::Index n = design.factors[0].rows();
    const Eigen::Index n_each = design.n_points() / n;
    std::vector<Eigen::Index> rows;
    std::vector<Eigen::Index> points;
    for (Eigen::Index i = 0; i < most_points_searched; ++i) {
        rows.push_back(i * n / most_points_searched);
        for (Eigen::Index j = 0; j < n_each; ++j) points.push_back(rows.back() * n_each + j);
    }
    Part part{design, values(points, Eigen::all)};
    part.design.factors[0] = design.factors[0](rows, Eigen::all);
    return part;
}

struct SharedParameters {
    Trend trend = Trend::constant;
    KrigingParameters parameters;
};

/// Those of the trend with the least leave-one-out errors.
SharedParameters shared_parameters(const Part& part, KrigingOptions options) {
    constexpr Eigen::Index n_searched = 6;
    const MatrixX values = part.values.leftCols(std::min(n_searched, part.values.cols()));
    const std::vector<Trend> trends =
        options.trend == Trend::automatic
            ? std::vector<Trend>{Trend::constant, Trend::linear, Trend::quadratic}
            : std::vector<Trend>{options.trend};
    SharedParameters best;
    double least = std::numeric_limits<double>::infinity();
    for (const Trend trend : trends) {
        options.trend = trend;
        const int n_terms = n_trend_functions(trend, part.design.n_parameters());
        if (trends.size() > 1 && trend != Trend::constant && 2 * n_terms > values.rows()) break;
        const KrigingParameters parameters = most_likely_parameters(part.design, values, options);
        const CoefficientModel model(
            part.design, values, options,
            std::vector<KrigingParameters>(static_cast<std::size_t>(values.cols()), parameters));
        const double cost = model.leave_one_out().squaredNorm();
        if (cost < least) {
            least = cost;
            best = {trend, parameters};
        }
    }
    return best;
}

}  // namespace

CoefficientModel learned_coefficients(const TensorDesign& design, const std::vector<int>& accepted,
                                      const MatrixX& values, const KrigingOptions& options) {
    const TensorDesign left = accepted_design(design, accepted);
    const std::vector<int> complete = complete_points(design, accepted);
    const std::size_t n_least = std::max<std::size_t>(accepted.size() / 2, left.n_parameters() + 2);
    if (left.factors.size() < design.factors.size() && complete.size() >= n_least) {
        std::vector<int> points;
        for (const int k : complete) {
            points.push_back(accepted[k]);
        }
        const CoefficientModel part(accepted_design(design, points), values(complete, Eigen::all),
                                    options);
        if (auto model = with_parameters(left, values, options, part.parameters())) {
            return std::move(*model);
        }
    }
    if (left.factors[0].rows() > most_points_searched) {
        const SharedParameters shared = shared_parameters(thinned(left, values), options);
        KrigingOptions known = options;
        known.trend = shared.trend;
        const std::vector<KrigingParameters> all(static_cast<std::size_t>(values.cols()),
                                                 shared.parameters);
        if (auto model = with_parameters(left, values, known, all)) {
            return std::move(*model);
        }
    }
    return {left, values, options};
}

namespace {

FieldModel learned_model(const TensorDesign& design, const MatrixX& fields, VectorX mean,
                         const InnerProduct& product, const FieldModelOptions& options) {
    if (fields.cols() != design.n_points() || fields.rows() != mean.size()) {
        throw InputError(
            "FieldModel: {} fields of {} values for a design of {} points and a mean of {} values; "
            "there must be one field for each point, as long as the mean",
            fields.cols(), fields.rows(), design.n_points(), mean.size());
    }
    const std::vector<int> accepted = accepted_columns(fields);
    if (accepted.empty()) {
        throw InputError("FieldModel: all {} fields were refused; nothing to learn from",
                         fields.cols());
    }
    const MatrixX snapshots = fields(Eigen::all, accepted).colwise() - mean;
    if (design.n_parameters() == 0) {
        return constant_model(mean + snapshots.col(0), options.pod.n_modes, options.kriging);
    }
    PodBasis basis = make_pod_basis(snapshots, product, options.pod);
    const MatrixX values = project(basis, product, snapshots).transpose();
    CoefficientModel coefficients = learned_coefficients(design, accepted, values, options.kriging);
    return {std::move(mean), std::move(basis), options.pod.n_modes, std::move(coefficients)};
}

}  // namespace

FieldModel::FieldModel(const TensorDesign& design, const MatrixX& fields, VectorX mean,
                       const InnerProduct& product, const FieldModelOptions& options)
    : FieldModel(learned_model(design, fields, std::move(mean), product, options)) {}

FieldModel::FieldModel(VectorX mean, PodBasis basis, std::optional<int> n_modes_asked,
                       CoefficientModel coefficients)
    : mean_(std::move(mean)),
      basis_(std::move(basis)),
      n_modes_asked_(n_modes_asked),
      coefficients_(std::move(coefficients)) {
    if (basis_.modes.rows() != mean_.size() ||
        basis_.modes.cols() != coefficients_.n_coefficients()) {
        throw InputError("FieldModel: modes are {} x {}; expected {} x {}, values by coefficients",
                         basis_.modes.rows(), basis_.modes.cols(), mean_.size(),
                         coefficients_.n_coefficients());
    }
}

std::optional<std::string> FieldModel::missing_modes() const {
    if (!n_modes_asked_ || n_modes() >= *n_modes_asked_) {
        return std::nullopt;
    }
    const Eigen::Index n_fields = coefficients_.training().rows();
    if (n_modes() == basis_.rank) {
        return fmt::format("{} modes asked for, {} are there: the numerical rank of {} snapshots",
                           *n_modes_asked_, n_modes(), n_fields);
    }
    return fmt::format("{} modes asked for, {} suffice for the tolerance", *n_modes_asked_,
                       n_modes());
}

VectorX FieldModel::field(const VectorX& coefficients) const {
    VectorX values = mean_;
    double* out = values.data();
    const Eigen::Index n = values.size();
    const auto mode = [&](Eigen::Index k) { return basis_.modes.col(k).data(); };
    // What takes time is to read the modes: four side by side keep the memory busy, which a product
    // of Eigen's doesn't.
    Eigen::Index k = 0;
    for (; k + 4 <= n_modes(); k += 4) {
        const double* m0 = mode(k);
        const double* m1 = mode(k + 1);
        const double* m2 = mode(k + 2);
        const double* m3 = mode(k + 3);
        const Vector<4> a = coefficients.segment<4>(k);
        for (Eigen::Index i = 0; i < n; ++i) {
            out[i] += (a[0] * m0[i] + a[1] * m1[i]) + (a[2] * m2[i] + a[3] * m3[i]);
        }
    }
    for (; k < n_modes(); ++k) {
        values += coefficients[k] * basis_.modes.col(k);
    }
    return values;
}

MatrixX FieldModel::fields(const MatrixX& coefficients) const {
    MatrixX result(mean_.size(), coefficients.cols());
    result.colwise() = mean_;
    result.noalias() += basis_.modes * coefficients;
    return result;
}

VectorX FieldModel::standard_errors(const VectorX& variances) const {
    return (basis_.modes.cwiseAbs2() * variances).cwiseSqrt();
}

}  // namespace couture::rom
