#include "iga/distributed/partition.h"

#include <algorithm>
#include <cmath>

#include "iga/core/error.h"

namespace couture::iga {

namespace {

template <int d>
std::int64_t count(const std::vector<ElementBox<d>>& boxes) {
    std::int64_t n = 0;
    for (const ElementBox<d>& box : boxes) {
        n += box.n_elements();
    }
    return n;
}

/// Direction of space in which the boxes' middles are furthest apart.
int longest_extent(const std::vector<Vector3>& middles) {
    Vector3 low = middles.front();
    Vector3 high = middles.front();
    for (const Vector3& x : middles) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    return axis;
}

template <int d>
class Bisection {
  public:
    Bisection(const std::function<Vector3(const ElementBox<d>&)>& middle,
              std::vector<std::vector<ElementBox<d>>>& parts)
        : middle_(middle), parts_(parts) {}

    void share_out(std::vector<ElementBox<d>> boxes, int first_part, int n_parts) {
        if (n_parts == 1) {
            std::sort(boxes.begin(), boxes.end(),
                      [](const auto& a, const auto& b) { return a.patch < b.patch; });
            parts_[first_part] = std::move(boxes);
            return;
        }
        sort(boxes);
        const std::int64_t n_all = count<d>(boxes);
        const std::int64_t wanted = n_all * (n_parts / 2) / n_parts;
        std::vector<ElementBox<d>> low;
        std::size_t next = 0;
        std::int64_t n_low = 0;
        while (n_low + boxes[next].n_elements() <= wanted) {
            n_low += boxes[next].n_elements();
            low.push_back(boxes[next++]);
        }
        std::vector<ElementBox<d>> high(boxes.begin() + static_cast<std::ptrdiff_t>(next) + 1,
                                        boxes.end());
        cut(boxes[next], wanted - n_low, low, high);
        n_low = count<d>(low);
        // Parts in proportion to the elements, at least one element for each.
        const auto share =
            static_cast<int>(std::lround(static_cast<double>(n_parts) * static_cast<double>(n_low) /
                                         static_cast<double>(n_all)));
        const auto least = static_cast<int>(std::max<std::int64_t>(1, n_parts - (n_all - n_low)));
        const auto most = static_cast<int>(std::min<std::int64_t>(n_parts - 1, n_low));
        const int n_low_parts = std::clamp(share, least, most);
        share_out(std::move(low), first_part, n_low_parts);
        share_out(std::move(high), first_part + n_low_parts, n_parts - n_low_parts);
    }

  private:
    /// Along the longest extent; patches of equal place by number.
    void sort(std::vector<ElementBox<d>>& boxes) const {
        if (boxes.size() == 1) {
            return;
        }
        std::vector<Vector3> middles;
        for (const ElementBox<d>& box : boxes) {
            middles.push_back(middle_(box));
        }
        const int axis = longest_extent(middles);
        std::vector<std::size_t> order(boxes.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            order[i] = i;
        }
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return middles[a][axis] < middles[b][axis];
        });
        std::vector<ElementBox<d>> sorted;
        for (const std::size_t i : order) {
            sorted.push_back(boxes[i]);
        }
        boxes = std::move(sorted);
    }

    /// Gives about `n_wanted` elements of a box to the lower group, the rest to the other; neither
    /// is left empty.
    void cut(const ElementBox<d>& box, std::int64_t n_wanted, std::vector<ElementBox<d>>& low,
             std::vector<ElementBox<d>>& high) const {
        int direction = 0;
        for (int k = 1; k < d; ++k) {
            if (box.end[k] - box.first[k] > box.end[direction] - box.first[direction]) {
                direction = k;
            }
        }
        const int n_layers = box.end[direction] - box.first[direction];
        const double layer = static_cast<double>(box.n_elements()) / n_layers;
        const int n_low = std::clamp(static_cast<int>(std::lround(n_wanted / layer)),
                                     low.empty() ? 1 : 0, high.empty() ? n_layers - 1 : n_layers);
        ElementBox<d> first = box;
        ElementBox<d> second = box;
        const auto halve = [&](int at) {
            first = second = box;
            first.end[direction] = second.first[direction] = box.first[direction] + at;
        };
        halve(n_low);
        // The end that lies towards the lower group goes there.
        const bool is_reversed = n_low > 0 && n_low < n_layers && !low.empty() && !high.empty() &&
                                 (middle_(first) - middle_(low.back())).norm() +
                                         (middle_(second) - middle_(high.front())).norm() >
                                     (middle_(second) - middle_(low.back())).norm() +
                                         (middle_(first) - middle_(high.front())).norm();
        if (is_reversed) {
            halve(n_layers - n_low);
            std::swap(first, second);
        }
        if (first.n_elements() > 0) {
            low.push_back(first);
        }
        if (second.n_elements() > 0) {
            high.insert(high.begin(), second);
        }
    }

    const std::function<Vector3(const ElementBox<d>&)>& middle_;
    std::vector<std::vector<ElementBox<d>>>& parts_;
};

}  // namespace

template <int d>
std::vector<std::vector<ElementBox<d>>> partition(
    const std::vector<std::array<int, d>>& n_elements,
    const std::function<Vector3(const ElementBox<d>&)>& middle, int n_parts) {
    std::vector<ElementBox<d>> boxes;
    for (std::size_t p = 0; p < n_elements.size(); ++p) {
        boxes.push_back({static_cast<int>(p), {}, n_elements[p]});
    }
    const std::int64_t n_all = count<d>(boxes);
    if (n_parts < 1 || n_all < n_parts) {
        throw InputError(
            "{} ranks for {} elements; each rank takes at least one element: start fewer ranks or "
            "take more 'elements' in [discretization]",
            n_parts, n_all);
    }
    std::vector<std::vector<ElementBox<d>>> parts(n_parts);
    Bisection<d>(middle, parts).share_out(std::move(boxes), 0, n_parts);
    return parts;
}

template std::vector<std::vector<ElementBox<2>>> partition<2>(
    const std::vector<std::array<int, 2>>&, const std::function<Vector3(const ElementBox<2>&)>&,
    int);
template std::vector<std::vector<ElementBox<3>>> partition<3>(
    const std::vector<std::array<int, 3>>&, const std::function<Vector3(const ElementBox<3>&)>&,
    int);

}  // namespace couture::iga
