#include "iga/spline/knot_vector.h"

#include <algorithm>
#include <cmath>

#include "iga/core/error.h"

namespace couture::iga {

KnotVector::KnotVector(int degree, std::vector<double> knots)
    : degree_(degree), knots_(std::move(knots)) {
    if (degree < 1 || degree > max_degree) {
        throw InputError("KnotVector: degree = {}; must be from 1 to {}", degree, max_degree);
    }
    const int n_knots = static_cast<int>(knots_.size());
    if (n_knots < 2 * (degree + 1)) {
        throw InputError("KnotVector: {} knots; an open knot vector of degree {} has at least {}",
                         n_knots, degree, 2 * (degree + 1));
    }
    for (int i = 0; i < n_knots; ++i) {
        if (!std::isfinite(knots_[i])) {
            throw InputError("KnotVector: knot {} = {}; knots must be finite", i, knots_[i]);
        }
        if (i > 0 && knots_[i] < knots_[i - 1]) {
            throw InputError(
                "KnotVector: knot {} = {} is smaller than knot {} = {}; knots must not "
                "decrease",
                i, knots_[i], i - 1, knots_[i - 1]);
        }
    }
    const auto n_first = std::count(knots_.begin(), knots_.end(), knots_.front());
    const auto n_last = std::count(knots_.begin(), knots_.end(), knots_.back());
    if (n_first != degree + 1 || n_last != degree + 1) {
        throw InputError(
            "KnotVector: first knot {} occurs {} times, last knot {} occurs {} times; "
            "an open knot vector of degree {} repeats each {} times",
            knots_.front(), n_first, knots_.back(), n_last, degree, degree + 1);
    }
    find_elements();
    for (std::size_t i = 1; i + 1 < breakpoints_.size(); ++i) {
        if (multiplicities_[i] > degree) {
            throw InputError(
                "KnotVector: knot {} occurs {} times; an interior knot of degree {} "
                "occurs at most {} times, or the spline is discontinuous there",
                breakpoints_[i], multiplicities_[i], degree, degree);
        }
    }
}

KnotVector::KnotVector(Part, int degree, std::vector<double> knots)
    : degree_(degree), knots_(std::move(knots)) {
    find_elements();
}

void KnotVector::find_elements() {
    const double first = knots_[degree_];
    const double last = knots_[n_basis()];
    for (std::size_t i = 0; i < knots_.size(); ++i) {
        if (knots_[i] < first || knots_[i] > last) {
            continue;
        }
        if (breakpoints_.empty() || knots_[i] != breakpoints_.back()) {
            breakpoints_.push_back(knots_[i]);
            multiplicities_.push_back(0);
        }
        ++multiplicities_.back();
        if (i + 1 < knots_.size() && knots_[i] < last && knots_[i + 1] > knots_[i]) {
            element_spans_.push_back(static_cast<int>(i));
        }
    }
}

KnotVector KnotVector::restricted(int first, int end) const {
    if (first < 0 || first >= end || end > n_elements()) {
        throw InputError(
            "KnotVector: elements {} to {} of {}; a part has at least one, all of "
            "them there",
            first, end - 1, n_elements());
    }
    const auto begin = knots_.begin();
    return {
        Part{},
        degree_,
        {begin + span_of_element(first) - degree_, begin + span_of_element(end - 1) + degree_ + 2}};
}

KnotVector KnotVector::uniform(int degree, int n_elements, double first, double last) {
    if (n_elements < 1) {
        throw InputError("KnotVector: {} elements; must be at least 1", n_elements);
    }
    std::vector<double> knots(degree + 1, first);
    for (int i = 1; i < n_elements; ++i) {
        knots.push_back(first + (last - first) * i / n_elements);
    }
    knots.insert(knots.end(), degree + 1, last);
    return {degree, std::move(knots)};
}

int KnotVector::find_element(double xi) const {
    if (!(xi >= front() && xi <= back())) {
        throw InputError("KnotVector: parameter {} lies outside [{}, {}]", xi, front(), back());
    }
    const auto above = std::upper_bound(breakpoints_.begin(), breakpoints_.end(), xi);
    return std::min(static_cast<int>(above - breakpoints_.begin()) - 1, n_elements() - 1);
}

std::vector<double> KnotVector::greville() const {
    std::vector<double> points(n_basis());
    for (int i = 0; i < n_basis(); ++i) {
        double sum = 0.0;
        for (int k = 1; k <= degree_; ++k) {
            sum += knots_[i + k];
        }
        points[i] = std::clamp(sum / degree_, front(), back());
    }
    return points;
}

KnotVector KnotVector::reversed() const {
    std::vector<double> knots(knots_.size());
    for (std::size_t i = 0; i < knots_.size(); ++i) {
        knots[i] = front() + back() - knots_[knots_.size() - 1 - i];
    }
    if (!is_open()) {
        return {Part{}, degree_, std::move(knots)};
    }
    std::fill_n(knots.begin(), degree_ + 1, front());
    std::fill_n(knots.rbegin(), degree_ + 1, back());
    return {degree_, std::move(knots)};
}

KnotVector KnotVector::rescaled(double first, double last) const {
    if (!(first < last)) {
        throw InputError("KnotVector: interval [{}, {}]; the first must be smaller", first, last);
    }
    std::vector<double> knots(knots_.size());
    for (std::size_t i = 0; i < knots_.size(); ++i) {
        const double t = (knots_[i] - front()) / (back() - front());
        knots[i] = t == 1.0 ? last : first + t * (last - first);
    }
    return is_open() ? KnotVector(degree_, std::move(knots))
                     : KnotVector(Part{}, degree_, std::move(knots));
}

bool KnotVector::conforms_to(const KnotVector& other, double tolerance) const {
    if (degree_ != other.degree_ || multiplicities_ != other.multiplicities_) {
        return false;
    }
    for (std::size_t i = 0; i < breakpoints_.size(); ++i) {
        const double here = (breakpoints_[i] - front()) / (back() - front());
        const double there =
            (other.breakpoints_[i] - other.front()) / (other.back() - other.front());
        if (std::abs(here - there) > tolerance) {
            return false;
        }
    }
    return true;
}

}  // namespace couture::iga
