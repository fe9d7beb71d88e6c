#include "meshing/field/dual_tree.h"

namespace couture::meshing {

DualTree make_dual_tree(const SurfaceMesh& mesh, std::span<const FaceHandle> roots) {
    DualTree tree;
    tree.crossed.resize(mesh.n_faces());
    std::vector<bool> is_reached(mesh.n_faces(), false);
    const auto grow = [&](FaceHandle root) {
        if (is_reached[root.idx()]) return;
        std::size_t next = tree.order.size();
        tree.order.push_back(root);
        is_reached[root.idx()] = true;
        for (; next < tree.order.size(); ++next) {
            for (const HalfedgeHandle h : mesh.fh_range(tree.order[next])) {
                const FaceHandle face = mesh.face_handle(mesh.opposite_halfedge_handle(h));
                if (!face.is_valid() || is_reached[face.idx()]) continue;
                is_reached[face.idx()] = true;
                tree.crossed[face.idx()] = h;
                tree.order.push_back(face);
            }
        }
    };
    for (const FaceHandle face : roots) grow(face);
    for (const FaceHandle face : mesh.faces()) grow(face);
    return tree;
}

}  // namespace couture::meshing
