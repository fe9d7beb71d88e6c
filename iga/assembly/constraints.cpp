#include "iga/assembly/constraints.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <algorithm>

#include "iga/assembly/elasticity.h"
#include "iga/assembly/entity_quadrature.h"
#include "iga/core/error.h"
#include "iga/core/format.h"

namespace couture::iga {

namespace {

/// Two directions, or two prescribed values, nearer than this (relative) are one.
constexpr double same_direction = 1e-8;
constexpr double same_value = 1e-6;
/// Of values obtained on different sides, relative to the largest.
constexpr double rounding = 1e-12;
/// A side whose unit normals differ by more than this is curved.
constexpr double flatness = 1e-6;

template <int d>
std::vector<int> dofs_of_set(const Space<d>& space, const BoundarySet<d>& set) {
    std::vector<int> dofs;
    for (const PatchEntity<d>& entity : set) {
        const std::vector<int> on = space.dofs_on(entity);
        dofs.insert(dofs.end(), on.begin(), on.end());
    }
    std::sort(dofs.begin(), dofs.end());
    dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
    return dofs;
}

double finite_value(const Function& value, const Vector3& x) {
    const double f = value(x, 0.0);
    if (!std::isfinite(f)) {
        throw InputError("prescribed displacement at {} = {}; must be finite", format_point(x), f);
    }
    return f;
}

/// Entities of dimension k that lie on an entity, itself if that is its dimension.
template <int d>
std::vector<PatchEntity<d>> closure(const PatchEntity<d>& entity, int k) {
    std::vector<PatchEntity<d>> result;
    for (const PatchEntity<d>& part : entities_of_patch<d>(entity.patch, k)) {
        bool lies_on = true;
        for (int direction = 0; direction < d; ++direction) {
            lies_on = lies_on && (entity.position[direction] == End::free ||
                                  entity.position[direction] == part.position[direction]);
        }
        if (lies_on) {
            result.push_back(part);
        }
    }
    return result;
}

/// A function's coefficients on sets: its values at corners, then the nearest function in L2 along
/// each edge with its ends held, then on each side with its edges held. What two sides have in
/// common follows from there alone, so that a function is the same on both.
template <int d>
class Projection {
  public:
    Projection(const Space<d>& space, const MatrixX& positions, const Function& value)
        : space_(space), positions_(positions), value_(value) {}

    /// One coefficient for each of the set's functions, `dofs`.
    VectorX on(const BoundarySet<d>& set, const std::vector<int>& dofs) {
        for (int k = 0; k < d; ++k) {
            for (const PatchEntity<d>& entity : set) {
                if (entity.dimension() < k) {
                    continue;
                }
                for (const PatchEntity<d>& part : closure(entity, k)) {
                    add(part);
                }
            }
        }
        VectorX result(dofs.size());
        for (std::size_t i = 0; i < dofs.size(); ++i) {
            result[static_cast<Eigen::Index>(i)] = known_.at(dofs[i]);
        }
        return result;
    }

  private:
    void add(const PatchEntity<d>& entity) {
        std::vector<int> unknown = space_.dofs_on(entity);
        std::sort(unknown.begin(), unknown.end());
        unknown.erase(std::unique(unknown.begin(), unknown.end()), unknown.end());
        std::erase_if(unknown, [this](int dof) { return known_.count(dof) != 0; });
        if (unknown.empty()) {
            return;
        }
        const auto n = static_cast<Eigen::Index>(unknown.size());
        const auto local = [&unknown](int dof) {
            const auto found = std::lower_bound(unknown.begin(), unknown.end(), dof);
            return found != unknown.end() && *found == dof
                       ? static_cast<int>(found - unknown.begin())
                       : -1;
        };
        std::vector<Eigen::Triplet<double>> entries;
        VectorX b = VectorX::Zero(n);
        for_entity_points<d>(space_, entity, {}, [&](const EntityPoint<d>& point) {
            double rest = finite_value(value_, point.x);
            for (std::size_t i = 0; i < point.dofs.size(); ++i) {
                if (local(point.dofs[i]) < 0) {
                    rest -= known_.at(point.dofs[i]) * point.values[i];
                }
            }
            for (std::size_t i = 0; i < point.dofs.size(); ++i) {
                const int row = local(point.dofs[i]);
                if (row < 0) {
                    continue;
                }
                b[row] += point.weight * rest * point.values[i];
                for (std::size_t j = 0; j < point.dofs.size(); ++j) {
                    if (const int column = local(point.dofs[j]); column >= 0) {
                        entries.emplace_back(row, column,
                                             point.weight * point.values[i] * point.values[j]);
                    }
                }
            }
        });
        SparseMatrix mass(n, n);
        mass.setFromTriplets(entries.begin(), entries.end());
        // Functions without area (on a collapsed side) take the value at their place.
        const double largest = mass.diagonal().maxCoeff();
        for (Eigen::Index i = 0; i < n; ++i) {
            if (!(mass.coeff(i, i) > 1e-14 * largest)) {
                mass.coeffRef(i, i) += largest > 0.0 ? largest : 1.0;
                b[i] =
                    mass.coeff(i, i) * finite_value(value_, positions_.row(unknown[i]).transpose());
            }
        }
        const Eigen::SimplicialLDLT<SparseMatrix> factor(mass);
        VectorX x = factor.solve(b);
        x += factor.solve(b - mass * x);
        for (Eigen::Index i = 0; i < n; ++i) {
            known_[unknown[i]] = x[i];
        }
    }

    const Space<d>& space_;
    const MatrixX& positions_;
    const Function& value_;
    std::map<int, double> known_;
};

/// The normal of a plane side.
template <int d>
Vector3 plane_normal(const Space<d>& space, const PatchEntity<d>& side, const Support& support) {
    std::optional<Vector3> normal;
    const std::string prefix = support.source.empty() ? "" : support.source + ": ";
    if (!side.is_side()) {
        throw InputError(
            "{}normal displacement on '{}': {} is not a side and has no normal; "
            "hold its components instead",
            prefix, support.on, side.name());
    }
    for_entity_points<d>(space, side, {}, [&](const EntityPoint<d>& point) {
        if (!(point.normal.norm() > 0.5)) {
            return;
        }
        normal = normal.value_or(point.normal);
        if ((point.normal - *normal).norm() > flatness) {
            throw InputError(
                "{}normal displacement on '{}': {} is curved, its normal is {} at one place and {} "
                "at {}; a normal can be held on planes only (a stiff [[foundation]] with 'normal' "
                "holds a curved side)",
                prefix, support.on, side.name(), format_point(*normal), format_point(point.normal),
                format_point(point.x));
        }
    });
    if (!normal) {
        throw InputError("{}normal displacement on '{}': {} has no area", prefix, support.on,
                         side.name());
    }
    // Exactly along an axis where it is so up to rounding.
    for (int a = 0; a < d; ++a) {
        if (std::abs(std::abs((*normal)[a]) - 1.0) < 1e-12) {
            return (*normal)[a] > 0.0 ? Vector3(Vector3::Unit(a)) : Vector3(-Vector3::Unit(a));
        }
    }
    return *normal;
}

template <int d>
struct PlanePiece {
    Vector3 normal;
    BoundarySet<d> sides;
};

/// The sides of a set by their normals.
template <int d>
std::vector<PlanePiece<d>> plane_pieces(const Space<d>& space, const BoundarySet<d>& set,
                                        const Support& support) {
    std::vector<PlanePiece<d>> pieces;
    for (const PatchEntity<d>& side : set) {
        const Vector3 normal = plane_normal(space, side, support);
        const auto same = std::find_if(
            pieces.begin(), pieces.end(),
            [&](const PlanePiece<d>& piece) { return (piece.normal - normal).norm() <= flatness; });
        if (same != pieces.end()) {
            same->sides.push_back(side);
        } else {
            pieces.push_back({normal, {side}});
        }
    }
    return pieces;
}

}  // namespace

template <int d>
void Constraints<d>::to_global(MatrixX& unknowns) const {
    for (const auto& [dof, frame] : frames) {
        unknowns.middleRows<d>(d * dof) =
            (frame.transpose() * unknowns.middleRows<d>(d * dof)).eval();
    }
}

template <int d>
void Constraints<d>::to_frames(MatrixX& unknowns) const {
    for (const auto& [dof, frame] : frames) {
        unknowns.middleRows<d>(d * dof) = (frame * unknowns.middleRows<d>(d * dof)).eval();
    }
}

template <int d>
MatrixX dof_positions(const Space<d>& space) {
    MatrixX positions = MatrixX::Zero(space.n_dofs(), 3);
    for (int p = 0; p < space.n_patches(); ++p) {
        const Patch<d>& patch = space.geometry().patches[p];
        const TensorSpace<d>& tensor = space.tensor(p);
        const int n = patch.dimension();
        if (tensor == patch.space()) {
            for (int i = 0; i < tensor.n_basis(); ++i) {
                positions.row(space.dofs(p)[i]).head(n) = patch.control_points().row(i);
            }
            continue;
        }
        std::array<std::vector<double>, d> greville;
        for (int k = 0; k < d; ++k) {
            greville[k] = tensor.knots[k].greville();
        }
        for (int i = 0; i < tensor.n_basis(); ++i) {
            const std::array<int, d> index = tensor.indices(i);
            Vector<d> xi;
            for (int k = 0; k < d; ++k) {
                xi[k] = greville[k][index[k]];
            }
            positions.row(space.dofs(p)[i]).head(n) = patch.point(xi).transpose();
        }
    }
    return positions;
}

template <int d>
Constraints<d> make_constraints(const Space<d>& space, const Problem& problem,
                                const std::vector<std::string>& load_cases) {
    const int nc = n_components<d>(problem);
    const auto n_cases = static_cast<Eigen::Index>(load_cases.size());
    const MatrixX positions = dof_positions(space);
    std::map<int, std::vector<HeldDirection<d>>> held;
    double largest_value = 0.0;

    const auto hold = [&](int dof, const Vector<d>& direction, int i_support,
                          const VectorX& values) {
        std::vector<HeldDirection<d>>& here = held[dof];
        Vector<d> rest = direction;
        VectorX value = values;
        for (const HeldDirection<d>& other : here) {
            const double c = other.direction.dot(rest);
            rest -= c * other.direction;
            value -= c * other.values;
        }
        const double length = rest.norm();
        if (length > same_direction) {
            here.push_back({dof, rest / length, i_support, value / length});
            return;
        }
        double scale = values.cwiseAbs().maxCoeff();
        const HeldDirection<d>* holder = &here.front();
        for (const HeldDirection<d>& other : here) {
            scale = std::max(scale, other.values.cwiseAbs().maxCoeff());
            if (std::abs(other.direction.dot(direction)) >
                std::abs(holder->direction.dot(direction))) {
                holder = &other;
            }
        }
        if (value.cwiseAbs().maxCoeff() > same_value * scale + rounding * largest_value) {
            const Support& support = problem.supports[i_support];
            throw InputError(
                "{}displacement on '{}' contradicts the one on '{}' at {}: they differ "
                "by {:.6g}; leave one of them out where they meet",
                support.source.empty() ? "" : support.source + ": ", support.on,
                problem.supports[holder->support].on, format_point(positions.row(dof)),
                value.cwiseAbs().maxCoeff());
        }
    };

    for (std::size_t s = 0; s < problem.supports.size(); ++s) {
        const Support& support = problem.supports[s];
        const BoundarySet<d>& whole_set = space.geometry().boundary_set(support.on);
        const auto apply = [&](const BoundarySet<d>& set, const Vector<d>& direction,
                               const Function& function) {
            const std::vector<int> dofs = dofs_of_set(space, set);
            if (dofs.empty()) {
                return;  // a part of a body that the set does not reach
            }
            const VectorX value = Projection<d>(space, positions, function).on(set, dofs);
            largest_value = std::max(largest_value, value.cwiseAbs().maxCoeff());
            for (std::size_t i = 0; i < dofs.size(); ++i) {
                VectorX values(n_cases);
                for (Eigen::Index c = 0; c < n_cases; ++c) {
                    values[c] = acts_in(support, load_cases[c]) ? value[i] : 0.0;
                }
                hold(dofs[i], direction, static_cast<int>(s), values);
            }
        };
        for (int a = 0; a < nc; ++a) {
            if (support.components[a]) {
                apply(whole_set, Vector<d>::Unit(a), *support.components[a]);
            }
        }
        if (support.normal && nc == d) {
            for (const PlanePiece<d>& piece : plane_pieces(space, whole_set, support)) {
                apply(piece.sides, piece.normal.template head<d>(), *support.normal);
            }
        }
    }

    Constraints<d> constraints;
    constraints.n_components = nc;
    constraints.is_fixed.assign(static_cast<std::size_t>(space.n_dofs()) * nc, 0);
    constraints.support.assign(constraints.is_fixed.size(), -1);
    constraints.values = MatrixX::Zero(space.n_dofs() * nc, n_cases);
    for (const auto& [dof, directions] : held) {
        const bool along_axes =
            std::all_of(directions.begin(), directions.end(), [](const HeldDirection<d>& h) {
                return h.direction.cwiseAbs().maxCoeff() > 1.0 - 1e-12;
            });
        const auto fix = [&](int component, const HeldDirection<d>& h, double sign) {
            const int unknown = nc * dof + component;
            constraints.is_fixed[unknown] = 1;
            constraints.support[unknown] = h.support;
            constraints.values.row(unknown) = sign * h.values.transpose();
        };
        if (along_axes) {
            for (const HeldDirection<d>& h : directions) {
                int component = 0;
                h.direction.cwiseAbs().maxCoeff(&component);
                fix(component, h, h.direction[component] > 0.0 ? 1.0 : -1.0);
            }
            continue;
        }
        // Held directions first, then any complement.
        Matrix<d> frame = Matrix<d>::Zero();
        int n = 0;
        for (const HeldDirection<d>& h : directions) {
            frame.row(n) = h.direction.transpose();
            fix(n, h, 1.0);
            ++n;
        }
        for (int a = 0; a < d && n < d; ++a) {
            Vector<d> axis = Vector<d>::Unit(a);
            for (int pass = 0; pass < 2; ++pass) {
                for (int k = 0; k < n; ++k) {
                    axis -= frame.row(k).dot(axis) * frame.row(k).transpose();
                }
            }
            if (axis.norm() > 0.5 / d) {
                frame.row(n++) = axis.normalized().transpose();
            }
        }
        constraints.frames[dof] = frame;
    }
    return constraints;
}

namespace {

template <int d>
Vector3 middle_of(const MultiPatch<d>& geometry) {
    Vector3 middle = Vector3::Zero();
    const MatrixX box = geometry.bounding_box();
    middle.head(box.rows()) = 0.5 * (box.col(0) + box.col(1));
    return middle;
}

}  // namespace

template <int d>
MatrixX rigid_body_modes(const Space<d>& space, const Problem& problem,
                         std::vector<std::string>& names, const std::optional<Vector3>& centre) {
    const int nc = n_components<d>(problem);
    if (problem.physics == Physics::poisson) {
        names = {"the constant"};
        return MatrixX::Ones(space.n_dofs(), 1);
    }
    if (problem.kinematics == Kinematics::axisymmetric) {
        names = {"translation along y (the axis)"};
        MatrixX modes = MatrixX::Zero(space.n_dofs() * nc, 1);
        for (int i = 0; i < space.n_dofs(); ++i) {
            modes(nc * i + 1, 0) = 1.0;
        }
        return modes;
    }
    MatrixX x = dof_positions(space);
    x.rowwise() -= centre.value_or(middle_of(space.geometry())).transpose();
    const std::string axes = "xyz";
    for (int a = 0; a < d; ++a) {
        names.push_back(fmt::format("translation along {}", axes[a]));
    }
    for (int a = d == 2 ? 2 : 0; a < 3; ++a) {
        names.push_back(fmt::format("rotation about {}", axes[a]));
    }
    MatrixX modes = MatrixX::Zero(space.n_dofs() * nc, static_cast<Eigen::Index>(names.size()));
    for (int i = 0; i < space.n_dofs(); ++i) {
        for (int a = 0; a < d; ++a) {
            modes(nc * i + a, a) = 1.0;
        }
        // e_a x position: component b = a + 1 gets -x_c, component c = a + 2 gets x_b.
        for (int a = d == 2 ? 2 : 0; a < 3; ++a) {
            const int column = d == 2 ? d : d + a;
            const int b = (a + 1) % 3;
            const int c = (a + 2) % 3;
            if (b < nc) {
                modes(nc * i + b, column) = -x(i, c);
            }
            if (c < nc) {
                modes(nc * i + c, column) = x(i, b);
            }
        }
    }
    return modes;
}

template <int d>
std::vector<std::string> free_rigid_motions(const Space<d>& space, const Problem& problem,
                                            const Constraints<d>& constraints,
                                            const SparseMatrix& foundations) {
    const int nc = constraints.n_components;
    std::vector<std::string> names;
    MatrixX modes = rigid_body_modes(space, problem, names);
    const auto n_modes = modes.cols();

    // Bodies: patches joined by shared functions.
    std::vector<int> body(space.n_dofs(), -1);
    std::vector<int> body_of_patch(space.n_patches());
    for (int p = 0; p < space.n_patches(); ++p) {
        body_of_patch[p] = p;
    }
    const auto root = [&](int p) {
        while (body_of_patch[p] != p) {
            p = body_of_patch[p] = body_of_patch[body_of_patch[p]];
        }
        return p;
    };
    for (int p = 0; p < space.n_patches(); ++p) {
        for (const int dof : space.dofs(p)) {
            if (body[dof] < 0) {
                body[dof] = p;
            } else {
                const int a = root(body[dof]);
                const int b = root(p);
                body_of_patch[std::max(a, b)] = std::min(a, b);
            }
        }
    }
    std::map<int, Matrix<6>> held;
    std::map<int, Matrix<6>> whole;
    for (int p = 0; p < space.n_patches(); ++p) {
        held.try_emplace(root(p), Matrix<6>::Zero());
        whole.try_emplace(root(p), Matrix<6>::Zero());
    }
    const MatrixX ground = foundations.nonZeros() > 0 ? MatrixX(foundations * modes) : MatrixX();
    const double ground_scale =
        ground.size() > 0 ? std::max(foundations.diagonal().maxCoeff(), 1e-300) : 1.0;
    MatrixX framed = modes;
    constraints.to_frames(framed);
    for (int i = 0; i < space.n_dofs(); ++i) {
        Matrix<6>& H = held[root(body[i])];
        Matrix<6>& M = whole[root(body[i])];
        for (int a = 0; a < nc; ++a) {
            const int unknown = nc * i + a;
            M.topLeftCorner(n_modes, n_modes) +=
                modes.row(unknown).transpose() * modes.row(unknown);
            if (constraints.is_fixed[unknown]) {
                H.topLeftCorner(n_modes, n_modes) +=
                    framed.row(unknown).transpose() * framed.row(unknown);
            }
            if (ground.size() > 0) {
                H.topLeftCorner(n_modes, n_modes) +=
                    modes.row(unknown).transpose() * ground.row(unknown) / ground_scale;
            }
        }
    }
    std::vector<std::string> free;
    // One held function among 1e6 gives 1e-6; rounding stays below 1e-15.
    constexpr double held_tolerance = 1e-13;
    for (const auto& [patch, H] : held) {
        // Modes orthonormal over the body, so that the eigenvalues are comparable.
        const MatrixX M = whole[patch].topLeftCorner(n_modes, n_modes);
        const Eigen::SelfAdjointEigenSolver<MatrixX> whole_solver(M);
        const MatrixX W =
            whole_solver.eigenvectors() *
            whole_solver.eigenvalues().cwiseMax(1e-300).cwiseInverse().cwiseSqrt().asDiagonal();
        const Eigen::SelfAdjointEigenSolver<MatrixX> solver(
            MatrixX(W.transpose() * H.topLeftCorner(n_modes, n_modes) * W));
        std::vector<Eigen::Index> null_space;
        for (Eigen::Index k = 0; k < n_modes; ++k) {
            if (solver.eigenvalues()[k] < held_tolerance) {
                null_space.push_back(k);
            }
        }
        if (null_space.empty()) {
            continue;
        }
        // A pure motion is named if it is free by itself; the rest is counted.
        MatrixX basis(n_modes, static_cast<Eigen::Index>(null_space.size()));
        for (std::size_t k = 0; k < null_space.size(); ++k) {
            basis.col(static_cast<Eigen::Index>(k)) = W * solver.eigenvectors().col(null_space[k]);
        }
        const MatrixX Q =
            basis.householderQr().householderQ() * MatrixX::Identity(n_modes, basis.cols());
        const std::string where =
            held.size() > 1 ? fmt::format(" (the body of patch {})", patch) : "";
        std::size_t n_named = 0;
        for (Eigen::Index k = 0; k < n_modes; ++k) {
            if (Q.row(k).norm() > 1.0 - 1e-6) {
                free.push_back(names[k] + where);
                ++n_named;
            }
        }
        if (n_named < null_space.size()) {
            std::string mixture;
            for (Eigen::Index k = 0; k < n_modes; ++k) {
                if (Q.row(k).norm() > 1e-3 && Q.row(k).norm() <= 1.0 - 1e-6) {
                    mixture += (mixture.empty() ? "" : " with ") + names[k];
                }
            }
            free.push_back(fmt::format("{} combined motion{} of {}{}", null_space.size() - n_named,
                                       null_space.size() - n_named > 1 ? "s" : "", mixture, where));
        }
    }
    return free;
}

template <int d>
void require_held(const Space<d>& space, const Problem& problem, const Constraints<d>& constraints,
                  const SparseMatrix& foundations) {
    const std::vector<std::string> free =
        free_rigid_motions(space, problem, constraints, foundations);
    if (free.empty()) {
        return;
    }
    if (problem.physics == Physics::poisson) {
        throw InputError("the potential is given nowhere: free mode: {}; add a [[potential]]",
                         fmt::join(free, ", "));
    }
    throw InputError(
        "the body is not held: free rigid-body motions: {}; add supports ([[fixed]], "
        "[[symmetry]], [[displacement]]) or a [[foundation]]",
        fmt::join(free, ", "));
}

#define COUTURE_INSTANTIATE(d)                                                                    \
    template struct Constraints<d>;                                                               \
    template Constraints<d> make_constraints(const Space<d>&, const Problem&,                     \
                                             const std::vector<std::string>&);                    \
    template MatrixX dof_positions(const Space<d>&);                                              \
    template MatrixX rigid_body_modes(const Space<d>&, const Problem&, std::vector<std::string>&, \
                                      const std::optional<Vector3>&);                             \
    template void require_held(const Space<d>&, const Problem&, const Constraints<d>&,            \
                               const SparseMatrix&);                                              \
    template std::vector<std::string> free_rigid_motions(                                         \
        const Space<d>&, const Problem&, const Constraints<d>&, const SparseMatrix&);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::iga
