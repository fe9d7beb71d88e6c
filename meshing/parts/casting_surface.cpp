#include "meshing/parts/casting_surface.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace couture::meshing {

namespace {

constexpr double bolt_radius = 12.0;
constexpr int n_bolts = 4;

void build_casting(const PartValues& values, PartSurfaceBuilder& builder) {
    const double flange_top_z = values.at("height_B");
    const double hub_top_z = values.at("height_H");
    const int bottom = builder.add_face("bottom", PartFaceKind::plane);
    const int edge = builder.add_face("flange_edge", PartFaceKind::cylinder);
    const int flange_top = builder.add_face("flange_top", PartFaceKind::plane);
    const int hub = builder.add_face("hub", PartFaceKind::cylinder);
    const int hub_top = builder.add_face("hub_top", PartFaceKind::plane);
    const int bore = builder.add_face("bore", PartFaceKind::cylinder);
    const auto circle = [&](double radius, double z) {
        return builder.add_circle({0.0, 0.0, z}, radius);
    };
    const auto edge_low = circle(values.at("radius_B"), 0.0);
    const auto edge_high = circle(values.at("radius_B"), flange_top_z);
    const auto hub_low = circle(values.at("radius_H"), flange_top_z);
    const auto hub_high = circle(values.at("radius_H"), hub_top_z);
    const auto bore_low = circle(values.at("radius_I"), 0.0);
    const auto bore_high = circle(values.at("radius_I"), hub_top_z);
    builder.add_cylinder(edge, edge_low, edge_high, Facing::outwards);
    builder.add_cylinder(hub, hub_low, hub_high, Facing::outwards);
    builder.add_cylinder(bore, bore_low, bore_high, Facing::inwards);
    std::vector<int> bottom_curves = edge_low.arcs;
    std::vector<int> top_curves = edge_high.arcs;
    const auto add = [](std::vector<int>& to, const std::vector<int>& curves) {
        to.insert(to.end(), curves.begin(), curves.end());
    };
    add(bottom_curves, bore_low.arcs);
    add(top_curves, hub_low.arcs);
    for (int i = 0; i < n_bolts; ++i) {
        const double angle = i * std::numbers::pi / 2;
        const double x = values.at("length") * std::cos(angle);
        const double y = values.at("length") * std::sin(angle);
        const int bolt = builder.add_face(fmt::format("bolt_{}", i + 1), PartFaceKind::cylinder);
        const auto low = builder.add_circle({x, y, 0.0}, bolt_radius);
        const auto high = builder.add_circle({x, y, flange_top_z}, bolt_radius);
        builder.add_cylinder(bolt, low, high, Facing::inwards);
        add(bottom_curves, low.arcs);
        add(top_curves, high.arcs);
    }
    builder.add_plane_sheet(bottom, bottom_curves, 2, -1);
    builder.add_plane_sheet(flange_top, top_curves, 2, 1);
    std::vector<int> ring = hub_high.arcs;
    add(ring, bore_high.arcs);
    builder.add_plane_sheet(hub_top, ring, 2, 1);
}

}  // namespace

std::vector<PartSurfaceDefinition> casting_surfaces() {
    return {{{"casting",
              "Round flange with four bolt holes of radius 12 and a hub about z, bored through, in "
              "mm. Faces: bottom (z = 0), flange_edge, flange_top, hub, hub_top, bore, bolt_1 "
              "(on +x) to bolt_4, counter-clockwise.",
              {{"length", 80.5, 80.0, 81.0, "from the axis to the axes of the bolt holes, mm"},
               {"radius_B", 122.5, 120.0, 125.0, "radius of the flange, mm"},
               {"radius_H", 37.5, 35.0, 40.0, "radius of the hub, mm"},
               {"radius_I", 22.5, 20.0, 25.0, "radius of the bore, mm"},
               {"height_B", 20.0, 15.0, 25.0, "thickness of the flange, mm"},
               {"height_H", 150.0, 140.0, 160.0, "height of the hub above z = 0, mm"}}},
             3.4,
             build_casting}};
}

}  // namespace couture::meshing
