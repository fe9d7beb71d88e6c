#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "meshing/parts/part_surface.h"
#include "meshing/parts/sheet_map.h"

namespace couture::meshing {

/// Puts a PartSurface together from named faces. A face consists of one or more sheets, each
/// bounded by curves and triangulated in its plane; sheets that share a curve share its vertices.
/// Curves between two faces become feature curves, those inside one face are mere seams.
class PartSurfaceBuilder {
  public:
    /// @param target_edge_length  positive
    explicit PartSurfaceBuilder(double target_edge_length);

    int add_face(std::string name, PartFaceKind kind, bool is_cap = false);

    /// An end of curves; only where three or more feature curves meet is it a corner.
    ///
    /// @param place  distinguishes corners of the same faces, or empty
    int add_vertex(const Vector3& point, std::string place = "");

    /// A curve between two vertices, divided into edges of about the target length, or shorter so
    /// that two in a row make an angle of not much more than 15 degrees.
    ///
    /// @param point  for t from 0 to 1
    /// @param place  distinguishes curves between the same faces, or empty
    int add_curve(int from, int to, const std::function<Vector3(double)>& point,
                  std::string place = "");

    /// A straight line; one that is there already is taken.
    int add_line(int from, int to, std::string place = "");

    /// Arc about the line along z through `centre` from a vertex to another, counter-clockwise by
    /// `sweep` radians.
    int add_arc(int from, int to, const Vector3& centre, double sweep, std::string place = "");

    /// A circle about the line along z through `centre`, as two arcs.
    struct Circle {
        Vector3 centre = Vector3::Zero();
        double radius = 0.0;
        double start_angle = 0.0;
        /// Vertices at the start angle and opposite.
        std::vector<int> vertices;
        /// From the first vertex counter-clockwise to the second, and on to the first.
        std::vector<int> arcs;
    };

    Circle add_circle(const Vector3& centre, double radius, double start_angle = 0.0,
                      const std::string& place = "");

    /// A part of a face.
    ///
    /// @param curves  its boundary loops, in any order and direction; no two loops touch
    void add_sheet(int face, const std::vector<int>& curves, SheetMap map);

    /// A plane sheet across a coordinate axis.
    void add_plane_sheet(int face, const std::vector<int>& curves, int axis, int sign);

    /// The cylinder between two circles with the same axis, radius and start angle: two sheets.
    ///
    /// @param holes  of each half (from the start angle on, and the other one), as curves
    void add_cylinder(int face, const Circle& low, const Circle& high, Facing facing,
                      const std::vector<std::vector<int>>& holes = {{}, {}});

    /// A plane polygon with straight edges between vertices, across a coordinate axis.
    ///
    /// @param holes  more boundary curves
    void add_polygon(int face, const std::vector<int>& vertices, int axis, int sign,
                     const std::vector<int>& holes = {});

    [[nodiscard]] const Vector3& point(int vertex) const { return points_[ends_[vertex]]; }

    /// Triangulates the sheets and names curves and corners.
    [[nodiscard]] PartSurface finish() const;

  private:
    struct Curve {
        int from = -1;
        int to = -1;
        /// Point numbers from the first to the last.
        std::vector<int> points;
        std::string place;
    };
    struct Sheet {
        int face = -1;
        std::vector<int> curves;
        SheetMap map;
    };
    /// A curve, and whether it is run through from its end to its start.
    struct CurveUse {
        int curve = -1;
        bool is_reversed = false;
    };

    [[nodiscard]] std::vector<std::vector<CurveUse>> chain(const std::vector<int>& curves) const;
    [[nodiscard]] std::vector<int> points_of(const std::vector<CurveUse>& loop) const;
    void mesh_sheet(const Sheet& sheet, PartSurface& part) const;
    void name_features(PartSurface& part) const;

    double target_edge_length_;
    std::vector<Vector3> points_;
    /// Point number of each vertex.
    std::vector<int> ends_;
    std::vector<std::string> vertex_places_;
    std::vector<Curve> curves_;
    std::map<std::pair<int, int>, int> lines_;
    std::vector<PartFace> faces_;
    std::vector<Sheet> sheets_;
};

}  // namespace couture::meshing
