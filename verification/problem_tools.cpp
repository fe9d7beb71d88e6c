#include "verification/problem_tools.h"

#include <algorithm>

#include "iga/core/error.h"
#include "iga/core/format.h"
#include "iga/post/stress.h"
#include "iga/spline/refine.h"
#include "iga/topology/locator.h"
#include "meshing/parts/parts.h"

namespace couture::verification {

using namespace iga;

namespace {

/// Probes are given by decimal coordinates of points on curved sides.
constexpr double probe_tolerance = 1e-8;

/// Breakpoints of the k-refined geometry; at each, one derivative less than the degree, or as many
/// as the geometry has.
KnotVector field_knots(const KnotVector& geometry, int degree, int n_elements) {
    if (degree >= geometry.degree()) {
        return refine(geometry, degree, n_elements).knots;
    }
    const KnotVector fine = refine(geometry, geometry.degree(), n_elements).knots;
    std::vector<double> knots;
    for (int i = 0; i <= fine.n_elements(); ++i) {
        const bool is_end = i == 0 || i == fine.n_elements();
        const int smoothness = std::min(degree - 1, fine.degree() - fine.multiplicities()[i]);
        knots.insert(knots.end(), is_end ? degree + 1 : degree - smoothness, fine.breakpoints()[i]);
    }
    return {degree, knots};
}

template <int d>
Location<d> locate(const MultiPatch<d>& geometry, const Vector3& point) {
    const auto place = Locator<d>(geometry).find(point, probe_tolerance * geometry.size());
    if (!place) {
        throw GeometryError("probe {} lies outside the body", format_point(point));
    }
    return *place;
}

}  // namespace

template <int d>
MultiPatch<d> part(const std::string& name, const std::map<std::string, double>& parameters) {
    return std::get<MultiPatch<d>>(meshing::make_part(name, parameters));
}

template <int d>
void name_outer(MultiPatch<d>& geometry) {
    geometry.boundary_sets["outer"] = geometry.outer_sides();
}

template <int d>
SpacePtr<d> make_space(const MultiPatch<d>& geometry, int degree,
                       const std::array<int, d>& n_elements) {
    const bool is_contained =
        std::all_of(geometry.patches.begin(), geometry.patches.end(), [&](const Patch<d>& patch) {
            const std::array<int, d> degrees = patch.space().degrees();
            return *std::max_element(degrees.begin(), degrees.end()) <= degree;
        });
    if (is_contained) {
        return std::make_shared<const Space<d>>(refine<d>(geometry, degree, n_elements));
    }
    std::vector<TensorSpace<d>> spaces;
    for (const Patch<d>& patch : geometry.patches) {
        TensorSpace<d> space = patch.space();
        for (int k = 0; k < d; ++k) {
            space.knots[k] = field_knots(patch.knots(k), degree, n_elements[k]);
        }
        spaces.push_back(std::move(space));
    }
    return std::make_shared<const Space<d>>(geometry, std::move(spaces));
}

template <int d>
SpacePtr<d> make_space(const MultiPatch<d>& geometry, int degree, int n_elements) {
    std::array<int, d> n;
    n.fill(n_elements);
    return make_space<d>(geometry, degree, n);
}

template <int d>
CaseResult<d> solve(const SpacePtr<d>& space, const Problem& problem,
                    std::optional<int> n_gauss_points) {
    LinearStaticOptions options;
    options.n_gauss_points = n_gauss_points;
    return solve_linear_static<d>(space, problem, options).cases.at(0);
}

Problem neo_hookean_problem(Kinematics kinematics, double shear_modulus, double bulk_modulus) {
    Problem problem;
    problem.kinematics = kinematics;
    problem.materials.resize(1);
    problem.materials[0].name = "rubber";
    problem.materials[0].hyperelastic =
        make_hyperelastic(StoredEnergy::neo_hookean, shear_modulus, bulk_modulus);
    return problem;
}

template <int d>
AcceptedStep<d> run_to_end(const SpacePtr<d>& space, const Problem& problem,
                           const SteppingOptions& options) {
    AcceptedStep<d> last;
    const SteppingReport report = follow_loads<d>(
        make_start<d>(space), problem, options, [&](const AcceptedStep<d>& step) { last = step; });
    if (!report.finished) {
        throw SolverError("{}", report.reason);
    }
    return last;
}

template <int d>
VectorX displacement_at(const Field<d>& u, const Vector3& point) {
    const Location<d> place = locate(u.space->geometry(), point);
    return u.value(place.patch, place.xi);
}

template <int d>
Vector<6> stress_at(const Problem& problem, const Field<d>& u, const Vector3& point) {
    const Location<d> place = locate(u.space->geometry(), point);
    return iga::stress_at<d>(problem, u, "", place.patch, place.xi).stress;
}

template <int d>
double geometry_error(const MultiPatch<d>& geometry, const std::string& set,
                      const std::function<double(const Vector3&)>& f) {
    constexpr int n = 16;
    double largest = 0.0;
    for (const PatchEntity<d>& side : geometry.boundary_set(set)) {
        const Patch<d>& patch = geometry.patches[side.patch];
        const std::array<int, d - 1> tangential = tangential_directions<d>(side.side());
        int n_points = 1;
        for (int i = 0; i < d - 1; ++i) {
            n_points *= n + 1;
        }
        for (int i = 0; i < n_points; ++i) {
            Vector<d> t;
            t[side_direction(side.side())] = side_is_high(side.side()) ? 1.0 : 0.0;
            int rest = i;
            for (const int k : tangential) {
                t[k] = rest % (n + 1) / static_cast<double>(n);
                rest /= n + 1;
            }
            Vector<d> xi;
            for (int k = 0; k < d; ++k) {
                const KnotVector& knots = patch.knots(k);
                xi[k] = (1.0 - t[k]) * knots.front() + t[k] * knots.back();
            }
            Vector3 x = Vector3::Zero();
            x.head(patch.dimension()) = patch.point(xi);
            largest = std::max(largest, std::abs(f(x)));
        }
    }
    return largest;
}

#define COUTURE_INSTANTIATE(d)                                                                \
    template MultiPatch<d> part<d>(const std::string&, const std::map<std::string, double>&); \
    template void name_outer<d>(MultiPatch<d>&);                                              \
    template SpacePtr<d> make_space<d>(const MultiPatch<d>&, int, const std::array<int, d>&); \
    template SpacePtr<d> make_space<d>(const MultiPatch<d>&, int, int);                       \
    template CaseResult<d> solve<d>(const SpacePtr<d>&, const Problem&, std::optional<int>);  \
    template AcceptedStep<d> run_to_end<d>(const SpacePtr<d>&, const Problem&,                \
                                           const SteppingOptions&);                           \
    template VectorX displacement_at<d>(const Field<d>&, const Vector3&);                     \
    template Vector<6> stress_at<d>(const Problem&, const Field<d>&, const Vector3&);         \
    template double geometry_error<d>(const MultiPatch<d>&, const std::string&,               \
                                      const std::function<double(const Vector3&)>&);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::verification
