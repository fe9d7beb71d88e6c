#include "rom/constrained_minimum.h"

#include <algorithm>
#include <cmath>
#include <nlopt.hpp>

#include "iga/core/error.h"

namespace couture::rom {

namespace {

/// The search, what it has asked for last, and the best point that it has seen: the library
/// forgets it if rounding stops it.
class Search {
  public:
    Search(const ConstrainedFunction& functions, double tolerance)
        : functions_(functions), tolerance_(tolerance) {}

    void move_to(const VectorX& x) {
        if (best_.n_evaluations > 0 && x == x_) {
            return;
        }
        x_ = x;
        values_ = functions_(x_, gradients_);
        const double violation =
            values_.size() > 1 ? values_.tail(values_.size() - 1).maxCoeff() : 0.0;
        const int n = ++best_.n_evaluations;
        if (n == 1 || is_better(values_[0], violation)) {
            best_ = {x_, values_[0], violation, n};
        }
    }

    [[nodiscard]] const VectorX& values() const { return values_; }
    [[nodiscard]] const MatrixX& gradients() const { return gradients_; }
    [[nodiscard]] const ConstrainedMinimum& best() const { return best_; }

  private:
    [[nodiscard]] bool is_better(double value, double violation) const {
        if (violation > tolerance_ || best_.violation > tolerance_) {
            return violation < best_.violation;
        }
        return value < best_.value;
    }

    const ConstrainedFunction& functions_;
    double tolerance_;
    VectorX x_;
    VectorX values_;
    MatrixX gradients_;
    ConstrainedMinimum best_;
};

/// One of the functions, for the library.
struct Entry {
    Search* search;
    Eigen::Index i_function;
};

double evaluate(const std::vector<double>& x, std::vector<double>& gradient, void* data) {
    const auto& entry = *static_cast<Entry*>(data);
    entry.search->move_to(Eigen::Map<const VectorX>(x.data(), static_cast<Eigen::Index>(x.size())));
    if (!gradient.empty()) {
        const VectorX slopes = entry.search->gradients().col(entry.i_function);
        std::copy(slopes.begin(), slopes.end(), gradient.begin());
    }
    return entry.search->values()[entry.i_function];
}

std::vector<double> to_values(const VectorX& vector) {
    return {vector.data(), vector.data() + vector.size()};
}

}  // namespace

ConstrainedMinimum constrained_minimum(const ConstrainedFunction& functions, const VectorX& start,
                                       const VectorX& lower, const VectorX& upper,
                                       double tolerance) {
    Search search(functions, tolerance);
    const VectorX first = start.cwiseMax(lower).cwiseMin(upper);
    search.move_to(first);
    if (!search.values().allFinite()) {
        throw SolverError("constrained_minimum: a function is not finite at the start");
    }
    std::vector<Entry> entries;
    for (Eigen::Index i = 0; i < search.values().size(); ++i) {
        entries.push_back({&search, i});
    }
    nlopt::opt method(nlopt::LD_SLSQP, static_cast<unsigned>(first.size()));
    method.set_lower_bounds(to_values(lower));
    method.set_upper_bounds(to_values(upper));
    method.set_min_objective(evaluate, entries.data());
    for (std::size_t i = 1; i < entries.size(); ++i) {
        method.add_inequality_constraint(evaluate, &entries[i], 0.5 * tolerance);
    }
    constexpr double step_tolerance = 1e-8;
    constexpr int most_evaluations = 200;
    method.set_xtol_abs(step_tolerance);
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
    return search.best();
}

}  // namespace couture::rom
