#include "io/dimension_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "iga/core/error.h"

namespace couture::io {

namespace {

// Pixels at text_scale 1.
constexpr double arrow_length = 15.0;
constexpr double arrow_half_width = 3.6;
constexpr double line_width = 1.3;
constexpr double first_row = 26.0;
constexpr double row_spacing = 28.0;
/// Between a point and its extension line, and beyond the dimension line.
constexpr double extension_gap = 3.0;
constexpr double extension_end = 6.0;
constexpr double text_gap = 7.0;
constexpr double border = 12.0;
constexpr Color line_color{0.05, 0.20, 0.50};
constexpr Color extension_color{0.42, 0.52, 0.68};
constexpr double straight = 1e-9;

using Interval = std::array<double, 2>;

/// A size in the picture's plane whose line is moved out.
struct OuterLine {
    const DimensionLine* line = nullptr;
    /// 0: the line runs upwards and lies to the right or left; 1: to the right, above or below.
    int side_axis = 0;
    int side_sign = 1;
    Vector2 from = Vector2::Zero();
    Vector2 to = Vector2::Zero();
    bool text_fits = true;
    bool arrows_fit = true;

    [[nodiscard]] double start() const { return from[1 - side_axis]; }
    [[nodiscard]] double end() const { return to[1 - side_axis]; }
    [[nodiscard]] double length() const { return std::abs(end() - start()); }
};

class Drawing {
  public:
    Drawing(Scene& scene, double pixels_per_unit)
        : scene_(scene),
          axes_(view_axes(scene)),
          pixels_per_unit_(pixels_per_unit),
          unit_(scene.text_scale.value_or(1.0) / pixels_per_unit) {
        for (const SurfacePiece& piece : scene.surfaces) {
            const std::vector<Vector2> seen = add_piece(piece.vertices);
            for (Eigen::Index t = 0; t < piece.triangles.rows(); ++t) {
                for (int k = 0; k < 3; ++k) {
                    edges_.push_back(
                        {seen[piece.triangles(t, k)], seen[piece.triangles(t, (k + 1) % 3)]});
                }
            }
        }
        for (const CurvePiece& piece : scene.curves) {
            const std::vector<Vector2> seen = add_piece(piece.points);
            for (std::size_t i = 0; i + 1 < seen.size(); ++i) {
                edges_.push_back({seen[i], seen[i + 1]});
            }
        }
        box_ = shown_;
        for (const Label& label : scene.labels) {
            show_text(in_plane(label.position), label.text, label.angle);
        }
        arrows_.color = line_color;
    }

    void add(const std::vector<DimensionLine>& lines) {
        std::vector<OuterLine> outer;
        for (const DimensionLine& line : lines) {
            if (line.offset.isZero()) {
                draw_through(line);
            } else {
                outer.push_back(place(line));
            }
        }
        std::stable_sort(outer.begin(), outer.end(), [](const OuterLine& a, const OuterLine& b) {
            return a.length() < b.length();
        });
        for (const OuterLine& line : outer) {
            for (const Vector2& end : {line.from, line.to}) {
                box_[0] = box_[0].cwiseMin(end);
                box_[1] = box_[1].cwiseMax(end);
            }
        }
        for (const OuterLine& line : outer) {
            draw_outer(line);
        }
    }

    void finish() {
        if (!arrow_points_.empty()) {
            const auto n = static_cast<Eigen::Index>(arrow_points_.size());
            arrows_.vertices.resize(n, 3);
            arrows_.triangles.resize(n / 3, 3);
            for (Eigen::Index i = 0; i < n; ++i) {
                arrows_.vertices.row(i) = in_space(arrow_points_[i]).transpose();
                arrows_.triangles(i / 3, i % 3) = static_cast<int>(i);
            }
            scene_.surfaces.push_back(arrows_);
        }
        const Vector2 room = Vector2::Constant(border * unit_);
        const Vector2 size = shown_[1] - shown_[0] + 2.0 * room;
        scene_.width = static_cast<int>(std::ceil(size.x() * pixels_per_unit_));
        scene_.height = static_cast<int>(std::ceil(size.y() * pixels_per_unit_));
        scene_.frame = {{0.5 * (shown_[0] + shown_[1])}, scene_.height / pixels_per_unit_};
    }

  private:
    [[nodiscard]] Vector2 in_plane(const Vector3& x) const {
        return (axes_.transpose() * x).head<2>();
    }

    /// In front of all pieces.
    [[nodiscard]] Vector3 in_space(const Vector2& p) const {
        return axes_ * Vector3(p.x(), p.y(), depth_ + unit_);
    }

    void show(const Vector2& p) {
        shown_[0] = shown_[0].cwiseMin(p);
        shown_[1] = shown_[1].cwiseMax(p);
    }

    std::vector<Vector2> add_piece(const MatrixX& points) {
        std::vector<Vector2> result;
        for (Eigen::Index i = 0; i < points.rows(); ++i) {
            const Vector3 seen = axes_.transpose() * points.row(i).transpose();
            show(seen.head<2>());
            depth_ = std::max(depth_, seen.z());
            result.emplace_back(seen.head<2>());
        }
        return result;
    }

    /// How far the pieces reach from a place in a direction, within `half_width` of the ray.
    [[nodiscard]] double reach_from(const Vector2& from, const Vector2& direction,
                                    double half_width) const {
        const Vector2 across(-direction.y(), direction.x());
        double reach = 0.0;
        for (const auto& [a, b] : edges_) {
            const double at_a = (a - from).dot(across);
            const double at_b = (b - from).dot(across);
            if (std::min(at_a, at_b) > half_width || std::max(at_a, at_b) < -half_width) {
                continue;
            }
            for (const double end : {-half_width, half_width}) {
                const double t =
                    at_a == at_b ? 0.0 : std::clamp((end - at_a) / (at_b - at_a), 0.0, 1.0);
                reach = std::max(reach, (a + t * (b - a) - from).dot(direction));
            }
        }
        return reach;
    }

    void show_text(const Vector2& center, const std::string& text, double angle) {
        const Vector2 half = 0.5 * unit_ * label_size(text);
        const double cosine = std::abs(std::cos(angle));
        const double sine = std::abs(std::sin(angle));
        const Vector2 reach(cosine * half.x() + sine * half.y(),
                            sine * half.x() + cosine * half.y());
        show(center - reach);
        show(center + reach);
    }

    void draw_text(const Vector2& center, const std::string& text, double angle) {
        scene_.labels.push_back({in_space(center), text, angle, true});
        show_text(center, text, angle);
    }

    void draw_line(const Vector2& a, const Vector2& b, const Color& color) {
        CurvePiece piece;
        piece.points.resize(2, 3);
        piece.points.row(0) = in_space(a).transpose();
        piece.points.row(1) = in_space(b).transpose();
        piece.color = color;
        piece.width = line_width;
        scene_.curves.push_back(std::move(piece));
        show(a);
        show(b);
    }

    void draw_arrow(const Vector2& tip, const Vector2& direction) {
        const Vector2 back = tip - arrow_length * unit_ * direction;
        const Vector2 across = arrow_half_width * unit_ * Vector2(-direction.y(), direction.x());
        arrow_points_.insert(arrow_points_.end(), {tip, back + across, back - across});
    }

    [[nodiscard]] OuterLine place(const DimensionLine& line) const {
        const Vector3 offset = axes_.transpose() * line.offset;
        const Vector3 along = axes_.transpose() * line.along;
        OuterLine result;
        result.line = &line;
        result.side_axis = std::abs(offset.x()) > std::abs(offset.y()) ? 0 : 1;
        const int axis = result.side_axis;
        if (std::abs(std::abs(offset[axis]) - 1.0) > straight ||
            std::abs(std::abs(along[1 - axis]) - 1.0) > straight) {
            throw InputError(
                "add_dimension_lines: '{}' is measured along ({}, {}, {}) and moved along ({}, {}, "
                "{}); one must be to the right or left in the picture, the other up or down",
                line.text, line.along[0], line.along[1], line.along[2], line.offset[0],
                line.offset[1], line.offset[2]);
        }
        result.side_sign = offset[axis] > 0.0 ? 1 : -1;
        result.from = in_plane(line.from);
        result.to = in_plane(line.to);
        const double length = result.length() / unit_;
        result.text_fits = length > label_size(line.text).x() + 2.0 * (arrow_length + text_gap);
        result.arrows_fit = length > 2.5 * arrow_length;
        return result;
    }

    /// What a line and its text take of their row.
    [[nodiscard]] Interval taken(const OuterLine& line) const {
        Interval interval{std::min(line.start(), line.end()), std::max(line.start(), line.end())};
        if (!line.arrows_fit) {
            interval[0] -= 2.0 * arrow_length * unit_;
            interval[1] += 2.0 * arrow_length * unit_;
        }
        if (!line.text_fits) {
            const double room = (label_size(line.line->text).x() + text_gap) * unit_;
            (line.end() < line.start() ? interval[0] -= room : interval[1] += room);
        }
        return interval;
    }

    /// Takes a place in the first row that has one.
    int take_row(const OuterLine& line) {
        std::vector<std::vector<Interval>>& rows =
            rows_[line.side_axis][line.side_sign > 0 ? 1 : 0];
        const Interval wanted = taken(line);
        const double gap = text_gap * unit_;
        for (std::size_t i = 0;; ++i) {
            if (i == rows.size()) {
                rows.emplace_back();
            }
            const bool is_free =
                std::all_of(rows[i].begin(), rows[i].end(), [&](const Interval& other) {
                    return wanted[1] + gap < other[0] || other[1] + gap < wanted[0];
                });
            if (is_free) {
                rows[i].push_back(wanted);
                return static_cast<int>(i);
            }
        }
    }

    void draw_outer(const OuterLine& line) {
        const int axis = line.side_axis;
        const int row = take_row(line);
        const double level = box_[line.side_sign > 0 ? 1 : 0][axis] +
                             line.side_sign * (first_row + row * row_spacing) * unit_;
        // From a coordinate along the line to a place on it.
        const auto at = [&](double coordinate, double height) {
            Vector2 p;
            p[axis] = height;
            p[1 - axis] = coordinate;
            return p;
        };
        for (const Vector2& end : {line.from, line.to}) {
            draw_line(at(end[1 - axis], end[axis] + line.side_sign * extension_gap * unit_),
                      at(end[1 - axis], level + line.side_sign * extension_end * unit_),
                      extension_color);
        }
        const double sign = line.end() < line.start() ? -1.0 : 1.0;
        const Vector2 forwards = at(sign, 0.0);
        const Vector2 from = at(line.start(), level);
        const Vector2 to = at(line.end(), level);
        const double tail = line.arrows_fit ? 0.0 : 2.0 * arrow_length * unit_;
        draw_line(from - tail * forwards, to + tail * forwards, line_color);
        draw_arrow(to, line.arrows_fit ? forwards : Vector2(-forwards));
        if (!line.line->is_one_sided) {
            draw_arrow(from, line.arrows_fit ? Vector2(-forwards) : forwards);
        }
        const double half_text = 0.5 * label_size(line.line->text).x() * unit_;
        const Vector2 center = line.text_fits
                                   ? Vector2(0.5 * (from + to))
                                   : Vector2(to + (tail + text_gap * unit_ + half_text) * forwards);
        draw_text(center, line.line->text, axis == 0 ? std::numbers::pi / 2 : 0.0);
    }

    /// A line through both ends, and on to a text behind everything on its way.
    void draw_through(const DimensionLine& line) {
        const Vector3 seen = axes_.transpose() * line.along;
        if (std::abs(seen.z()) > straight || std::abs(seen.norm() - 1.0) > straight) {
            throw InputError(
                "add_dimension_lines: '{}' is measured along ({}, {}, {}); it must be a unit "
                "direction in the picture's plane",
                line.text, line.along[0], line.along[1], line.along[2]);
        }
        const Vector2 direction = seen.head<2>();
        const Vector2 from = in_plane(line.from);
        const Vector2 to = in_plane(line.to);
        const Vector2 half = 0.5 * unit_ * label_size(line.text);
        const double reach =
            std::max((to - from).norm(), reach_from(from, direction, 2.0 * half.y()));
        const Vector2 end = from + (reach + 2.0 * text_gap * unit_) * direction;
        draw_line(from, end, line_color);
        draw_arrow(to, direction);
        if (!line.is_one_sided) {
            draw_arrow(from, -direction);
        }
        // Beside the end, or above or below it where the line is steep.
        constexpr double steep = 0.2;
        const bool is_beside = std::abs(direction.x()) > steep;
        const double gap = text_gap * unit_;
        const Vector2 shift = is_beside ? Vector2(std::copysign(half.x() + gap, direction.x()), 0.0)
                                        : Vector2(0.0, std::copysign(half.y(), direction.y()));
        draw_text(end + shift, line.text, 0.0);
    }

    Scene& scene_;
    Matrix<3> axes_;
    double pixels_per_unit_;
    /// Length of a pixel at text_scale 1.
    double unit_;
    double depth_ = -std::numeric_limits<double>::infinity();
    /// Of all pieces.
    std::vector<std::array<Vector2, 2>> edges_;
    /// Lower left and upper right corner of all pieces and ends, and of all that is shown.
    std::array<Vector2, 2> box_;
    std::array<Vector2, 2> shown_ = {Vector2::Constant(std::numeric_limits<double>::infinity()),
                                     Vector2::Constant(-std::numeric_limits<double>::infinity())};
    /// What is taken in each row: [axis of the side][low, high][row].
    std::array<std::array<std::vector<std::vector<Interval>>, 2>, 2> rows_;
    std::vector<Vector2> arrow_points_;
    SurfacePiece arrows_;
};

}  // namespace

void add_dimension_lines(Scene& scene, const std::vector<DimensionLine>& lines,
                         double pixels_per_unit) {
    if (scene.surfaces.empty() && scene.curves.empty()) {
        throw InputError("add_dimension_lines: the scene has no surface and no curve to measure");
    }
    if (!(pixels_per_unit > 0.0 && std::isfinite(pixels_per_unit))) {
        throw InputError("add_dimension_lines: pixels_per_unit = {}; must be positive and finite",
                         pixels_per_unit);
    }
    Drawing drawing(scene, pixels_per_unit);
    drawing.add(lines);
    drawing.finish();
}

}  // namespace couture::io
