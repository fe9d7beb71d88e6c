#include "io/picture_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "iga/core/error.h"

namespace couture::io {

namespace {

void check_piece(const char* kind, std::size_t i, const MatrixX& points) {
    if (points.rows() == 0 || points.cols() != 3 || !points.allFinite()) {
        throw InputError(
            "render_png: the points of {} {} are {} x {}; expected n x 3 finite coordinates", kind,
            i, points.rows(), points.cols());
    }
}

}  // namespace

void check_scene(const Scene& scene) {
    if (scene.surfaces.empty() && scene.curves.empty()) {
        throw InputError("render_png: the scene has no surface and no curve; nothing to show");
    }
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
        const SurfacePiece& piece = scene.surfaces[i];
        check_piece("surface", i, piece.vertices);
        const Eigen::Index n = piece.vertices.rows();
        if (piece.triangles.size() > 0 &&
            (piece.triangles.cols() != 3 || piece.triangles.minCoeff() < 0 ||
             piece.triangles.maxCoeff() >= n)) {
            throw InputError(
                "render_png: the triangles of surface {} are m x {} with vertices {} to {}; "
                "expected m x 3 and 0 to {}",
                i, piece.triangles.cols(), piece.triangles.minCoeff(), piece.triangles.maxCoeff(),
                n - 1);
        }
        if (piece.values.size() != 0 && piece.values.size() != n) {
            throw InputError("render_png: surface {} has {} values for {} vertices", i,
                             piece.values.size(), n);
        }
    }
    for (std::size_t i = 0; i < scene.curves.size(); ++i) {
        check_piece("curve", i, scene.curves[i].points);
    }
    if (!(scene.view_direction.cross(scene.up).norm() >
          1e-6 * scene.view_direction.norm() * scene.up.norm())) {
        throw InputError(
            "render_png: view direction ({}, {}, {}) and up ({}, {}, {}) must be independent",
            scene.view_direction[0], scene.view_direction[1], scene.view_direction[2], scene.up[0],
            scene.up[1], scene.up[2]);
    }
    if (scene.frame && !(scene.frame->center.allFinite() && scene.frame->height > 0.0 &&
                         std::isfinite(scene.frame->height))) {
        throw InputError(
            "render_png: the frame has its centre at ({}, {}) and is {} high; the centre must be "
            "finite and the height positive",
            scene.frame->center[0], scene.frame->center[1], scene.frame->height);
    }
    if (scene.text_scale && !(*scene.text_scale > 0.0 && *scene.text_scale < 100.0)) {
        throw InputError("render_png: text_scale = {}; must be positive and below 100",
                         *scene.text_scale);
    }
    constexpr int largest = 8192;
    if (std::min(scene.width, scene.height) < 16 || std::max(scene.width, scene.height) > largest) {
        throw InputError("render_png: size {} x {}; each must be from 16 to {} pixels", scene.width,
                         scene.height, largest);
    }
}

}  // namespace couture::io
