// A program that knows a reduced model by one header and one file: main MODEL [NAME=VALUE ...]
// prints what the model answers; main --time MODEL the time of an evaluation.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "rom/embed/couture_rom.h"

namespace {

void print_estimate(const char* name, const couture_rom::ErrorEstimate& one) {
    std::printf("%s %.17g %.17g %.17g %.17g\n", name, one.relative, one.total, one.truncation,
                one.kriging);
}

void print_list(const char* name, const std::vector<double>& values) {
    std::printf("%s", name);
    for (const double value : values) std::printf(" %.17g", value);
    std::printf("\n");
}

std::vector<double> point_of(const couture_rom::Model& model, int argc, char** argv) {
    std::vector<double> point = model.reference_point();
    for (int i = 2; i < argc; ++i) {
        const std::string setting = argv[i];
        const std::size_t equals = setting.find('=');
        point[model.index_of(setting.substr(0, equals))] =
            std::strtod(setting.c_str() + equals + 1, nullptr);
    }
    return point;
}

int print_time(const couture_rom::Model& model) {
    using Clock = std::chrono::steady_clock;
    double best = 1e300;
    for (int i = 0; i < 20; ++i) {
        const Clock::time_point start = Clock::now();
        const couture_rom::Answer answer = model.evaluate(model.reference_point());
        best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count());
        if (answer.points.empty()) return 1;
    }
    std::printf("%zu points: %.2f ms\n", model.n_points(), 1e3 * best);
    return 0;
}

int run(int argc, char** argv) {
    if (argc == 3 && std::strcmp(argv[1], "--time") == 0) {
        return print_time(couture_rom::Model::load(argv[2]));
    }
    const couture_rom::Model model = couture_rom::Model::load(argv[1]);
    const couture_rom::Answer answer = model.evaluate(point_of(model, argc, argv));
    std::printf("title %s\nunits %s %s\n", model.title().c_str(), model.length_unit().c_str(),
                model.stress_unit().c_str());
    for (const couture_rom::Parameter& one : model.parameters()) {
        std::printf("parameter %s %.17g %.17g %s\n", one.name.c_str(), one.lower, one.upper,
                    one.unit.c_str());
    }
    print_list("coefficients", answer.displacement_coefficients);
    print_list("standard_errors", answer.standard_errors);
    print_list("points", answer.points);
    print_list("displacements", answer.displacements);
    print_list("von_mises", answer.von_mises);
    std::printf("maxima %.17g %.17g %zu\n", answer.displacement_max, answer.von_mises_max,
                answer.i_von_mises_max);
    print_estimate("geometry_error", answer.geometry_error);
    print_estimate("displacement_error", answer.displacement_error);
    std::printf("von_mises_error %.17g\n", answer.von_mises_error);
    for (const std::string& warning : answer.warnings) std::printf("warning %s\n", warning.c_str());
    if (!model.why_no_stress().empty()) {
        std::printf("no_stress %s\n", model.why_no_stress().c_str());
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    try {
        return run(argc, argv);
    } catch (const couture_rom::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
