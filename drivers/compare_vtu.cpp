#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "drivers/comparison.h"
#include "iga/core/format.h"

namespace couture::drivers {

namespace {

using Json = nlohmann::json;
using io::NamedRows;
using io::VtuMesh;

/// Largest magnitude of the finite numbers in both.
double size_of(const MatrixX& a, const MatrixX& b) {
    double size = 0.0;
    for (const MatrixX* rows : {&a, &b}) {
        for (const double value : rows->reshaped()) {
            size = std::isfinite(value) ? std::max(size, std::abs(value)) : size;
        }
    }
    return size;
}

struct LargestDifference {
    double value = 0.0;
    Eigen::Index row = 0;
    Eigen::Index column = 0;
    /// Rows with a difference above the limit.
    Eigen::Index n_rows = 0;
};

/// Numbers that are not finite differ from all but themselves, infinitely.
double distance(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) {
        return 0.0;
    }
    const double difference = std::abs(a - b);
    return std::isfinite(difference) ? difference : std::numeric_limits<double>::infinity();
}

LargestDifference find_largest(const MatrixX& a, const MatrixX& b, double limit) {
    LargestDifference largest;
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
        bool differs = false;
        for (Eigen::Index j = 0; j < a.cols(); ++j) {
            const double difference = distance(a(i, j), b(i, j));
            differs = differs || difference > limit;
            if (difference > largest.value) {
                largest.value = difference;
                largest.row = i;
                largest.column = j;
            }
        }
        largest.n_rows += differs ? 1 : 0;
    }
    return largest;
}

VectorX center(const VtuMesh& mesh, Eigen::Index cell) {
    VectorX sum = VectorX::Zero(3);
    for (const long point : mesh.cells[cell]) {
        sum += mesh.points.row(point).transpose();
    }
    return sum / static_cast<double>(std::max<std::size_t>(mesh.cells[cell].size(), 1));
}

class Comparison {
  public:
    Comparison(const VtuMesh& first, const VtuMesh& second, double tolerance)
        : first_(first), second_(second), tolerance_(tolerance) {}

    [[nodiscard]] std::vector<std::string> differences() {
        const bool is_same_mesh = compare_meshes();
        if (is_same_mesh) {
            compare_points();
        }
        compare_arrays(first_.point_arrays, second_.point_arrays, "point", is_same_mesh);
        compare_arrays(first_.cell_arrays, second_.cell_arrays, "cell", is_same_mesh);
        return std::move(differences_);
    }

  private:
    template <typename... Args>
    void add(fmt::format_string<Args...> format, Args&&... args) {
        differences_.push_back(fmt::format(format, std::forward<Args>(args)...));
    }

    /// True if points and cells match by their numbers.
    bool compare_meshes() {
        if (first_.points.rows() != second_.points.rows()) {
            add("points: {}, {}", first_.points.rows(), second_.points.rows());
        }
        if (first_.cells.size() != second_.cells.size()) {
            add("cells: {}, {}", first_.cells.size(), second_.cells.size());
        }
        if (!differences_.empty()) {
            return false;
        }
        for (std::size_t i = 0; i < first_.cells.size(); ++i) {
            if (first_.cell_types[i] != second_.cell_types[i]) {
                add("cell {}: VTK cell type {}, {}", i, first_.cell_types[i],
                    second_.cell_types[i]);
                return false;
            }
            if (first_.cells[i] != second_.cells[i]) {
                add("cell {}: has other points, or the same in another order", i);
                return false;
            }
        }
        return true;
    }

    void compare_points() {
        if (first_.points.rows() == 0) {
            return;
        }
        const double size = std::max(size_of_box(first_.points), size_of_box(second_.points));
        const LargestDifference largest =
            find_largest(first_.points, second_.points, tolerance_ * size);
        if (largest.n_rows > 0) {
            add("positions: {} of {} points differ, most {:.3g} ({:.2e} of the part's size) at {}",
                largest.n_rows, first_.points.rows(), largest.value, largest.value / size,
                format_point(first_.points.row(largest.row)));
        }
    }

    static double size_of_box(const MatrixX& points) {
        return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
    }

    static const NamedRows* find(const std::vector<NamedRows>& arrays, const std::string& name) {
        const auto found = std::find_if(arrays.begin(), arrays.end(),
                                        [&](const NamedRows& a) { return a.name == name; });
        return found == arrays.end() ? nullptr : &*found;
    }

    void compare_arrays(const std::vector<NamedRows>& a, const std::vector<NamedRows>& b,
                        const std::string& place, bool is_same_mesh) {
        for (const NamedRows& array : a) {
            const NamedRows* other = find(b, array.name);
            if (other == nullptr) {
                add("{} array '{}': only in the first", place, array.name);
            } else if (array.rows.cols() != other->rows.cols()) {
                add("{} array '{}': {} components, {} components", place, array.name,
                    array.rows.cols(), other->rows.cols());
            } else if (is_same_mesh) {
                compare_rows(array, *other, place);
            }
        }
        for (const NamedRows& array : b) {
            if (find(a, array.name) == nullptr) {
                add("{} array '{}': only in the second", place, array.name);
            }
        }
    }

    void compare_rows(const NamedRows& a, const NamedRows& b, const std::string& place) {
        const double size = size_of(a.rows, b.rows);
        const LargestDifference largest = find_largest(a.rows, b.rows, tolerance_ * size);
        if (largest.n_rows == 0) {
            return;
        }
        const VectorX x = place == "cell" ? center(first_, largest.row)
                                          : VectorX(first_.points.row(largest.row).transpose());
        add("{} array '{}': {} of {} rows differ, most {:.6g}, {:.6g} ({:.2e} of its largest value)"
            " in component {} at {}",
            place, a.name, largest.n_rows, a.rows.rows(), a.rows(largest.row, largest.column),
            b.rows(largest.row, largest.column), largest.value / size, largest.column,
            format_point(x));
    }

    const VtuMesh& first_;
    const VtuMesh& second_;
    double tolerance_;
    std::vector<std::string> differences_;
};

std::vector<std::string> compare_provenance(const std::string& first, const std::string& second) {
    const Json a = Json::parse(first, nullptr, false);
    const Json b = Json::parse(second, nullptr, false);
    if (!a.is_object() || !b.is_object()) {
        return first == second ? std::vector<std::string>{}
                               : std::vector<std::string>{
                                     "not written by couture, or by another "
                                     "version"};
    }
    std::vector<std::string> differences;
    std::set<std::string> keys;
    for (const Json* object : {&a, &b}) {
        for (const auto& [key, value] : object->items()) {
            keys.insert(key);
        }
    }
    for (const std::string& key : keys) {
        const std::string x = a.contains(key) ? a[key].dump() : "none";
        const std::string y = b.contains(key) ? b[key].dump() : "none";
        if (x != y) {
            // The hash of the deck says it already; whole texts are for a file comparison.
            differences.push_back(key == "deck_text" ? "deck_text: differs"
                                                     : fmt::format("{}: {}, {}", key, x, y));
        }
    }
    return differences;
}

}  // namespace

VtuComparison compare_vtu(const VtuMesh& first, const VtuMesh& second, double tolerance) {
    return {Comparison(first, second, tolerance).differences(),
            compare_provenance(first.provenance, second.provenance)};
}

}  // namespace couture::drivers
