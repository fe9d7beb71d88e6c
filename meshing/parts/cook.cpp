#include "meshing/parts/cook.h"

#include "iga/spline/shapes.h"
#include "meshing/parts/part_geometry.h"

namespace couture::meshing {

namespace {

iga::Surface make_membrane() {
    MatrixX corners(4, 2);
    corners << 0, 0, 48, 44, 0, 44, 48, 60;
    return iga::make_multilinear<2>(corners);
}

iga::MultiPatch<2> make_cook(const PartValues&) {
    iga::MultiPatch<2> membrane;
    membrane.patches.push_back(make_membrane());
    membrane.boundary_sets = {{"clamped", {iga::make_side<2>(0, 0)}},
                              {"loaded", {iga::make_side<2>(0, 1)}},
                              {"bottom", {iga::make_side<2>(0, 2)}},
                              {"top", {iga::make_side<2>(0, 3)}}};
    return membrane;
}

iga::MultiPatch<3> make_cook_3d(const PartValues& values) {
    iga::MultiPatch<3> membrane;
    membrane.patches.push_back(make_slab(make_membrane(), 0.0, values.at("thickness")));
    membrane.boundary_sets = {
        {"clamped", {iga::make_side<3>(0, 0)}}, {"loaded", {iga::make_side<3>(0, 1)}},
        {"bottom", {iga::make_side<3>(0, 2)}},  {"top", {iga::make_side<3>(0, 3)}},
        {"z_low", {iga::make_side<3>(0, 4)}},   {"z_high", {iga::make_side<3>(0, 5)}}};
    return membrane;
}

}  // namespace

std::vector<PartDefinition> cook_parts() {
    return {{{"cook",
              "Cook's membrane (0, 0), (48, 44), (48, 60), (0, 44). Sets: clamped (x = 0), loaded "
              "(x = 48), bottom, top.",
              {},
              2},
             make_cook},
            {{"cook_3d",
              "The same with a thickness, 0 <= z <= thickness. Sets: clamped, loaded, bottom, top, "
              "z_low, "
              "z_high.",
              {length_parameter("thickness", 1.0, "size along z")},
              3},
             make_cook_3d}};
}

}  // namespace couture::meshing
