#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "meshing/surface/predicates.h"

namespace couture::meshing {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 to_point(const Vector2& a) { return {a.x(), a.y()}; }
Kernel::Point_3 to_point(const Vector3& a) { return {a.x(), a.y(), a.z()}; }

}  // namespace

int orientation(const Vector2& a, const Vector2& b, const Vector2& c) {
    return static_cast<int>(CGAL::orientation(to_point(a), to_point(b), to_point(c)));
}

int orientation(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
    return static_cast<int>(CGAL::orientation(to_point(a), to_point(b), to_point(c), to_point(d)));
}

}  // namespace couture::meshing
