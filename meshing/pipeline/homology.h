#pragma once

#include <map>
#include <string>
#include <vector>

#include "iga/topology/multipatch.h"
#include "meshing/parts/part_surface.h"

namespace couture::meshing {

/// Feature corners and curves of a part by their names, as they are.
struct NamedFeatures {
    struct Curve {
        std::vector<Vector3> points;
        bool is_closed = false;
    };
    std::map<std::string, Vector3> corners;
    std::map<std::string, Curve> curves;
    /// Of the part's box.
    double diagonal = 0.0;
};

[[nodiscard]] NamedFeatures named_features(const PartSurface& part);

/// Which corners and edges of a volume's patches features lie on.
struct FeatureImages {
    std::map<std::string, iga::PatchEntity<3>> corners;
    std::map<std::string, std::vector<iga::PatchEntity<3>>> curves;
};

/// Distance up to which a feature lies on a node or an arc, relative to the diagonal.
constexpr double homology_tolerance = 1e-3;

/// The images of a member's features: for each corner the nearest node, for each curve all arcs
/// that lie on it to homology_tolerance.
[[nodiscard]] FeatureImages find_feature_images(const iga::MultiPatch<3>& volume,
                                                const NamedFeatures& features);

/// How far a member's features are from the images that they have on the reference; distances
/// relative to the diagonal of the member's box.
struct HomologyReport {
    int n_corners = 0;
    int n_curves = 0;
    int points_per_curve = 0;
    double max_corner_distance = 0.0;
    std::string worst_corner;
    double max_curve_distance = 0.0;
    std::string worst_curve;

    [[nodiscard]] bool is_homologous() const {
        return max_corner_distance <= homology_tolerance &&
               max_curve_distance <= homology_tolerance;
    }
};

/// Measures all corners, and evenly spaced points of all curves. What has no image, or no
/// namesake here, counts as infinitely far.
///
/// @param images  of the reference
/// @throws InputError  if the images are not of a volume with such patches, or for less than 2
///                     points
///
/// Source: [Maquart19] Sec. 6.3.4.
[[nodiscard]] HomologyReport measure_homology(const iga::MultiPatch<3>& volume,
                                              const NamedFeatures& features,
                                              const FeatureImages& images,
                                              int points_per_curve = 200);

}  // namespace couture::meshing
