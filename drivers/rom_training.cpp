#include "drivers/rom_training.h"

#include <limits>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/timer.h"
#include "iga/solve/static_system.h"
#include "rom/member_geometry.h"
#include "rom/pod.h"
#include "rom/reduced_model.h"

namespace couture::drivers {

namespace {

// The member as every process sees it: on the control points of the store.
iga::SpacePtr<3> stored_member(const iga::Space<3>& reference, const io::SnapshotStore& store,
                               int i_geometry, const std::string& signature) {
    return std::make_shared<const iga::Space<3>>(
        rom::to_member(reference, iga::flatten(store.geometry(i_geometry, signature))));
}

// False if the geometry is refused.
bool make_geometry(RomSamples& samples, const iga::Space<3>& reference, io::SnapshotStore& store,
                   int i_geometry, const std::string& signature) {
    if (store.has_geometry(i_geometry)) return true;
    const Timer timer;
    MatrixX control_points;
    std::string failure;
    try {
        const auto member = samples.make_member(samples.plan().point(i_geometry, 0, 0), store);
        control_points = iga::unflatten(rom::to_field(reference, member->geometry()), 3);
    } catch (const Error& error) {
        failure = error.what();
    }
    if (!failure.empty()) {
        log::warn(fmt::format("rom: geometry {} is refused: {}", i_geometry, failure));
        store.write_geometry_failure(i_geometry, failure);
        return false;
    }
    store.write_geometry(i_geometry, control_points, signature);
    store.note_time(fmt::format("geometry {}", i_geometry), timer.seconds());
    return true;
}

// What projected displacements are made of: modes of all solutions, each of unit length, so that
// small ones are as well represented as large ones.
MatrixX projection_fields(const RomSamples& samples, const iga::Space<3>& reference,
                          const io::SnapshotStore& store, const std::string& signature) {
    const RomPlan& plan = samples.plan();
    std::vector<MatrixX> solutions;
    Eigen::Index n_columns = 0;
    for (int g = 0; g < plan.n_geometries(); ++g) {
        for (int m = 0; m < plan.n_materials(); ++m) {
            if (plan.is_projected(g) || !store.has_solution(g, m)) continue;
            solutions.push_back(store.solution(g, m, signature));
            n_columns += solutions.back().cols();
        }
    }
    const rom::InnerProduct product = rom::mode_product(
        reference, samples.section().is_l2 ? rom::ModeProduct::l2 : rom::ModeProduct::euclidean);
    MatrixX all(3L * reference.n_dofs(), n_columns);
    Eigen::Index column = 0;
    for (const MatrixX& some : solutions) {
        const VectorX sizes = rom::lengths(some, product).cwiseMax(1e-300);
        all.middleCols(column, some.cols()) = some * sizes.cwiseInverse().asDiagonal();
        column += some.cols();
    }
    if (n_columns == 0) throw InputError("rom: no solution is left that others could be made of");
    constexpr double tolerance = 1e-5;
    return rom::make_pod_basis(all, product, {.tolerance = tolerance}).modes;
}

// @param fields  that it is projected onto; none: it is solved
void make_solution(RomSamples& samples, const iga::SpacePtr<3>& member, io::SnapshotStore& store,
                   int i_geometry, int i_material, const std::string& signature,
                   const MatrixX& fields) {
    const Timer timer;
    std::vector<VectorX> points;
    for (int l = 0; l < samples.plan().n_loads(); ++l) {
        points.push_back(samples.plan().point(i_geometry, l, i_material));
    }
    MatrixX displacements;
    std::string failure;
    try {
        displacements = fields.size() > 0 ? samples.project(member, points, fields)
                                          : samples.solve(member, points);
    } catch (const Error& error) {
        failure = error.what();
    }
    if (!failure.empty()) {
        log::warn(fmt::format("rom: geometry {}, material {} is refused: {}", i_geometry,
                              i_material, failure));
        store.write_solution_failure(i_geometry, i_material, failure);
        return;
    }
    store.write_solution(i_geometry, i_material, displacements, signature);
    store.note_time(fmt::format("solution {} {}", i_geometry, i_material), timer.seconds());
}

}  // namespace

StoreProgress progress_of(const RomPlan& plan, const io::SnapshotStore& store) {
    StoreProgress progress;
    for (int g = 0; g < plan.n_geometries(); ++g) {
        if (store.has_geometry(g)) ++progress.n_geometries;
        const bool is_refused = !store.has_geometry(g) && store.geometry_failure(g).has_value();
        if (is_refused) ++progress.n_refused;
        for (int m = 0; m < plan.n_materials(); ++m) {
            if (store.has_solution(g, m)) {
                ++progress.n_solutions;
            } else if (!is_refused && store.solution_failure(g, m)) {
                ++progress.n_refused;
            } else if (!is_refused) {
                ++progress.n_missing;
                if (!plan.is_projected(g)) ++progress.n_unsolved;
            }
        }
    }
    return progress;
}

Progress::Progress(const RomPlan& plan, const io::SnapshotStore& store)
    : plan_(plan), store_(store), before_(progress_of(plan, store)), last_(before_) {}

void Progress::report() const {
    const StoreProgress now = progress_of(plan_, store_);
    if (now.n_geometries == last_.n_geometries && now.n_missing == last_.n_missing) return;
    last_ = now;
    const int n_made = before_.n_missing - now.n_missing;
    std::string line = fmt::format("rom: {} of {} geometries, {} of {} solutions", now.n_geometries,
                                   plan_.n_geometries(), now.n_solutions,
                                   plan_.n_geometries() * plan_.n_materials());
    if (now.n_refused > 0) line += fmt::format(", {} refused", now.n_refused);
    if (n_made > 0) {
        line += fmt::format("; about {:.0f} s left", timer_.seconds() / n_made * now.n_missing);
    }
    log::info(line);
}

std::vector<RefusedSample> refused_samples(const RomPlan& plan, const io::SnapshotStore& store) {
    std::vector<RefusedSample> refused;
    for (int g = 0; g < plan.n_geometries(); ++g) {
        const std::string point = describe_point(plan.space, plan.point(g, 0, 0));
        if (const auto reason = store.geometry_failure(g); reason && !store.has_geometry(g)) {
            refused.push_back({g, -1, point, *reason});
            continue;
        }
        for (int m = 0; m < plan.n_materials(); ++m) {
            const auto reason = store.solution_failure(g, m);
            if (reason && !store.has_solution(g, m)) {
                refused.push_back({g, m, describe_point(plan.space, plan.point(g, 0, m)), *reason});
            }
        }
    }
    return refused;
}

rom::SnapshotSet read_snapshots(const RomSamples& samples, const iga::Space<3>& reference,
                                const io::SnapshotStore& store) {
    const RomPlan& plan = samples.plan();
    const std::string signature = iga::signature(reference.geometry());
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    const long n_values = 3L * reference.n_dofs();
    const int n_mechanics = plan.n_loads() * plan.n_materials();
    rom::SnapshotSet set{plan.space,
                         {},
                         plan.reference,
                         reference.geometry(),
                         plan.geometry_points,
                         {},
                         MatrixX::Constant(n_values, plan.n_geometries(), nothing),
                         MatrixX::Constant(n_values, plan.n_snapshots(), nothing)};
    for (const io::RomParameter& one : samples.section().parameters) {
        const bool is_load = one.parameter.group == rom::ParameterGroup::load;
        set.factor_power.push_back(!one.is_factored ? 0 : is_load ? 1 : -1);
    }
    if (!plan.load.empty()) set.mechanics_factors.push_back(plan.load_points);
    if (!plan.material.empty()) set.mechanics_factors.push_back(plan.material_points);
    for (int g = 0; g < plan.n_geometries(); ++g) {
        if (!store.has_geometry(g)) continue;
        set.control_points.col(g) = iga::flatten(store.geometry(g, signature));
        for (int m = 0; m < plan.n_materials(); ++m) {
            if (!store.has_solution(g, m)) continue;
            const MatrixX solution = store.solution(g, m, signature);
            for (int l = 0; l < plan.n_loads(); ++l) {
                set.displacements.col(g * n_mechanics + l * plan.n_materials() + m) =
                    solution.col(l);
            }
        }
    }
    rom::check(set);
    return set;
}

void fill_store(RomSamples& samples, const iga::Space<3>& reference, io::SnapshotStore& store,
                int i_first, int stride) {
    const std::string signature = iga::signature(reference.geometry());
    const RomPlan& plan = samples.plan();
    const Progress progress(plan, store);
    const auto make_solutions = [&](int g, const MatrixX& fields) {
        if (!make_geometry(samples, reference, store, g, signature)) return;
        iga::SpacePtr<3> member;
        for (int m = 0; m < plan.n_materials(); ++m) {
            if (store.has_solution(g, m) || store.solution_failure(g, m)) continue;
            if (!member) member = stored_member(reference, store, g, signature);
            make_solution(samples, member, store, g, m, signature, fields);
            progress.report();
        }
    };
    const auto for_own = [&](bool is_projected, const auto& make) {
        for (int g = i_first; g < plan.n_geometries(); g += stride) {
            if (plan.is_projected(g) != is_projected) continue;
            if (!store.has_geometry(g) && store.geometry_failure(g)) continue;
            make(g);
        }
    };
    const StoreProgress made = progress_of(plan, store);
    if (made.n_missing == 0) return;
    if (made.n_unsolved > 0) {
        for_own(false, [&](int g) { make_solutions(g, {}); });
        for_own(true, [&](int g) {
            if (make_geometry(samples, reference, store, g, signature)) progress.report();
        });
        return;
    }
    const MatrixX fields = projection_fields(samples, reference, store, signature);
    log::info(fmt::format("rom: projecting onto {} modes of the solutions", fields.cols()));
    for_own(true, [&](int g) { make_solutions(g, fields); });
}

}  // namespace couture::drivers
