#include "iga/topology/snap_knots.h"

#include <algorithm>

namespace couture::iga {

KnotVector snap_knots(const KnotVector& knots, const KnotVector& target, double tolerance) {
    const double slack = tolerance * (knots.back() - knots.front());
    std::vector<double> snapped;
    double previous = knots.front();
    for (int i = 0; i <= knots.n_elements(); ++i) {
        double value = knots.breakpoints()[i];
        if (i > 0 && i < knots.n_elements()) {
            const std::vector<double>& goals = target.breakpoints();
            const auto goal = std::lower_bound(goals.begin(), goals.end(), value - slack);
            if (goal != goals.end() && *goal <= value + slack && *goal > previous &&
                *goal < knots.breakpoints()[i + 1]) {
                value = *goal;
            }
        }
        snapped.insert(snapped.end(), knots.multiplicities()[i], value);
        previous = value;
    }
    return {knots.degree(), std::move(snapped)};
}

}  // namespace couture::iga
