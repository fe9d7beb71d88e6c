#include "rom/bounded_minimum.h"

#include <cmath>
#include <nlopt.hpp>

#include "iga/core/error.h"

namespace couture::rom {

namespace {

using Function = std::function<double(const VectorX&, VectorX&)>;

VectorX to_vector(const std::vector<double>& values) {
    return Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::vector<double> to_values(const VectorX& vector) {
    return {vector.data(), vector.data() + vector.size()};
}

/// The search, and the best point that it has seen: the library forgets it if rounding stops it.
struct Search {
    const Function& function;
    BoundedMinimum best;
};

double evaluate(const std::vector<double>& x, std::vector<double>& gradient, void* data) {
    auto& search = *static_cast<Search*>(data);
    const VectorX point = to_vector(x);
    VectorX slope(point.size());
    const double value = search.function(point, slope);
    if (!gradient.empty()) {
        gradient = to_values(slope);
    }
    if (value < search.best.value) {
        search.best = {point, value};
    }
    return value;
}

}  // namespace

BoundedMinimum bounded_minimum(const Function& function, const VectorX& start, const VectorX& lower,
                               const VectorX& upper, double tolerance) {
    const VectorX first = start.cwiseMax(lower).cwiseMin(upper);
    VectorX slope(first.size());
    Search search{function, {first, function(first, slope)}};
    if (!std::isfinite(search.best.value)) {
        throw SolverError("bounded_minimum: the function is {} at the start; it must be finite",
                          search.best.value);
    }
    nlopt::opt method(nlopt::LD_LBFGS, static_cast<unsigned>(first.size()));
    method.set_lower_bounds(to_values(lower));
    method.set_upper_bounds(to_values(upper));
    method.set_min_objective(evaluate, &search);
    constexpr int most_evaluations = 200;
    method.set_ftol_abs(tolerance);
    method.set_maxeval(most_evaluations);
    std::vector<double> x = to_values(first);
    double value = 0.0;
    try {
        method.optimize(x, value);
    } catch (const nlopt::roundoff_limited&) {
        // As near as rounding allows.
    } catch (const std::runtime_error&) {
        // The line search failed: the best point so far stands.
    }
    return search.best;
}

}  // namespace couture::rom
