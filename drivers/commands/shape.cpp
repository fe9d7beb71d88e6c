#include <fmt/format.h>

#include <cmath>

#include "drivers/commands/commands.h"
#include "drivers/number_list.h"
#include "drivers/shape_run.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/timer.h"
#include "iga/topology/jacobian_certificate.h"
#include "io/atomic_file.h"
#include "meshing/pipeline/midpoint.h"

namespace couture::drivers {

namespace {

namespace fs = std::filesystem;

/// Modes that leave less than this relative error (1.14) are enough.
constexpr double small_error = 0.1;

rom::Alignment alignment_of(const ShapeOptions& options) {
    if (options.no_align && options.scale) {
        throw InputError("shape: --no-align and --scale exclude each other; give one of them");
    }
    return options.no_align ? rom::Alignment::none
           : options.scale  ? rom::Alignment::similarity
                            : rom::Alignment::rigid;
}

std::optional<int> reference_of(const ShapeOptions& options, const ShapePopulation& population) {
    if (options.reference.empty()) return population.reference;
    std::string names;
    for (std::size_t j = 0; j < population.members.size(); ++j) {
        if (population.members[j].name == options.reference) return static_cast<int>(j);
        names += (j == 0 ? "" : ", ") + population.members[j].name;
    }
    throw InputError("shape: --reference {}: there is no such member; there are {}",
                     options.reference, names);
}

int modes_of(const ShapeOptions& options, const rom::ShapeModel& model,
             const VectorX& compactness) {
    if (options.n_modes) {
        if (*options.n_modes < 1 || *options.n_modes > model.n_modes()) {
            throw InputError("shape: --modes {}: {} members have 1 to {}", *options.n_modes,
                             model.n_members(), model.n_modes());
        }
        return *options.n_modes;
    }
    int n = 1;
    while (n < model.n_modes() && 1.0 - compactness[n] > small_error * small_error) ++n;
    return n;
}

std::string certificate(const ShapeRun& run, const MatrixX& points) {
    const ShapeConnectivity& connectivity = run.population.connectivity;
    if (!connectivity.volume) return "";
    return iga::to_string(meshing::certified(connectivity.volume_with(points)));
}

void warn_of_members(const ShapeRun& run) {
    const auto& members = run.population.members;
    for (const int j : run.model.mirrored_members) {
        log::warn(fmt::format(
            "shape: {} is much nearer to the mean when it is mirrored: is it a left side among "
            "right ones? Members are never mirrored",
            members[j].name));
    }
    // Coefficients of all modes are distances between members.
    const MatrixX& a = run.model.coefficients;
    const double equal = 1e-9 * a.colwise().norm().maxCoeff();
    for (Eigen::Index i = 0; i < a.cols(); ++i) {
        for (Eigen::Index j = i + 1; j < a.cols(); ++j) {
            if ((a.col(i) - a.col(j)).norm() > equal) continue;
            log::warn(fmt::format(
                "shape: {} and {} have the same shape; it counts twice in the mean and its spread",
                members[i].name, members[j].name));
        }
    }
    if (!run.model.has_converged) {
        log::warn(fmt::format("shape: the alignment still moved after {} iterations",
                              run.model.n_iterations));
    }
}

void analyse(const ShapeOptions& options, ShapeRun& run) {
    std::vector<MatrixX> shapes;
    for (const ShapeMember& member : run.population.members) shapes.push_back(member.points);
    rom::AlignmentOptions alignment;
    alignment.alignment = alignment_of(options);
    alignment.reference = reference_of(options, run.population);
    run.model = rom::make_shape_model(shapes, alignment);
    run.compactness = rom::compactness(run.model);
    run.n_modes = modes_of(options, run.model, run.compactness);
    if (run.model.n_members() > 2) {
        run.generalisation = rom::generalisation(run.model);
    } else {
        log::warn("shape: leaving one out takes 3 members or more: no generalisation");
    }
    run.specificity = rom::specificity(run.model);
    run.mean_certificate = certificate(run, run.model.mean);
    warn_of_members(run);
}

void project(const ShapeOptions& options, ShapeRun& run) {
    for (const std::string& file : options.project) {
        ShapeMember member = read_shape_member(run.population, file);
        rom::ShapeProjection projection = rom::project_shape(run.model, member.points, run.n_modes);
        if (run.model.alignment != rom::Alignment::none &&
            rom::fits_mirrored(projection.motion.apply(member.points), run.model.mean)) {
            log::warn(
                fmt::format("shape: {} is much nearer to the mean when it is mirrored", file));
        }
        run.projections.push_back({std::move(member), std::move(projection)});
    }
}

void make_virtual_members(const ShapeOptions& options, ShapeRun& run) {
    for (const std::string& text : options.virtual_members) {
        const std::vector<double> numbers = read_number_list("shape", "--virtual", text);
        const auto n = static_cast<Eigen::Index>(numbers.size());
        if (n > run.model.n_modes()) {
            throw InputError("shape: --virtual {}: {} numbers; there are {} modes", text, n,
                             run.model.n_modes());
        }
        VirtualShape shape;
        shape.name = fmt::format("virtual_{}", run.virtuals.size() + 1);
        shape.scores = Eigen::Map<const VectorX>(numbers.data(), n);
        shape.points = rom::virtual_member(
            run.model, shape.scores.cwiseProduct(run.model.standard_deviations.head(n)));
        shape.certificate = certificate(run, shape.points);
        constexpr double usual = 3.0;
        if (shape.scores.cwiseAbs().maxCoeff() > usual) {
            log::warn(fmt::format(
                "shape: --virtual {}: beyond 3 standard deviations, where the population has "
                "hardly any member",
                text));
        }
        run.virtuals.push_back(std::move(shape));
    }
}

/// That of the family, if it is one.
std::string name_of(const ShapeOptions& options) {
    const fs::path input = options.inputs.front();
    if (options.inputs.size() > 1) return "shape";
    const fs::path whole = fs::weakly_canonical(fs::absolute(input));
    return (fs::is_directory(input) ? whole.filename().string() : input.stem().string()) + "_shape";
}

}  // namespace

int run_shape(const ShapeOptions& options, const CommonOptions& common) {
    if (options.inputs.empty()) {
        throw InputError(
            "shape: no members; give files of isotopological meshes or volumes, the folder of a "
            "family's run or its deck");
    }
    const Timer timer;
    ShapeRun run;
    run.name = name_of(options);
    const fs::path folder = options.out.empty() ? fs::path("out") / run.name : options.out;
    io::require_writable(folder);
    run.population = read_shape_population(options.inputs);
    analyse(options, run);
    project(options, run);
    make_virtual_members(options, run);
    run.files = write_shape_files(run, folder, options.png);
    run.seconds = timer.seconds();
    if (common.json) {
        fmt::print("{}\n", shape_json(run));
    } else if (!common.quiet) {
        print_shape(run, folder);
    }
    return ExitCode::done;
}

}  // namespace couture::drivers
