#include "io/calculix_run.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <sstream>
#include <thread>
#include <vector>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/text_cursor.h"

namespace couture::io {

namespace fs = std::filesystem;

namespace {

constexpr const char* thread_variable = "OMP_NUM_THREADS=";
constexpr std::chrono::milliseconds pause_between_looks{10};
/// Characters of a failed run's output that are shown.
constexpr std::size_t shown_output = 600;

MatrixX to_matrix(const std::vector<double>& rows, long n_columns) {
    return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        rows.data(), static_cast<long>(rows.size()) / n_columns, n_columns);
}

bool starts_with_digit(std::string_view word) {
    return !word.empty() && word[0] >= '0' && word[0] <= '9';
}

/// Takes a number; Fortran leaves the E out where the exponent has three digits: nearly zero.
double fortran_number(TextCursor& words, std::string_view what) {
    const std::string_view next = words.peek();
    const std::size_t sign = next.find_last_of('-');
    if (sign != std::string_view::npos && sign > 0 && next.size() - sign == 4 &&
        next.find_first_not_of("0123456789", sign + 1) == std::string_view::npos &&
        next.find('E') == std::string_view::npos) {
        words.word(what);
        return 0.0;
    }
    return words.number(what);
}

/// Lines "node, values" of nodes 1, 2, 3, ...
MatrixX read_nodes(TextCursor& words, std::string_view what) {
    std::vector<double> values;
    for (int node = 1; starts_with_digit(words.peek()); ++node) {
        words.integer("the number of the next node", node, node);
        for (int a = 0; a < 3; ++a) {
            values.push_back(fortran_number(words, what));
        }
    }
    return to_matrix(values, 3);
}

/// Lines "element, point, values" of elements 1, 2, 3, ...
MatrixX read_points(TextCursor& words, int n_values, std::string_view what) {
    std::vector<double> values;
    int element = 0;
    int point = 0;
    while (starts_with_digit(words.peek())) {
        const bool is_next =
            words.integer("the number of an element", element, element + 1) > element;
        element += is_next ? 1 : 0;
        point = is_next ? 1 : point + 1;
        words.integer("the number of an integration point", point, point);
        for (int i = 0; i < n_values; ++i) {
            values.push_back(fortran_number(words, what));
        }
    }
    return to_matrix(values, n_values);
}

/// The variables of this process, with one thread for OpenMP.
std::vector<std::string> environment_of_one_thread() {
    std::vector<std::string> result;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        if (std::strncmp(*variable, thread_variable, std::strlen(thread_variable)) != 0) {
            result.emplace_back(*variable);
        }
    }
    result.push_back(std::string(thread_variable) + "1");
    return result;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
    std::vector<char*> result;
    result.reserve(texts.size() + 1);
    for (std::string& text : texts) {
        result.push_back(text.data());
    }
    result.push_back(nullptr);
    return result;
}

/// Starts a program in `folder`, its messages going to `log` there.
pid_t start(const fs::path& program, std::vector<std::string> arguments, const fs::path& folder,
            const std::string& log) {
    std::vector<std::string> environment = environment_of_one_thread();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    pid_t process = 0;
    const int code = ::posix_spawn(&process, program.c_str(), &actions, nullptr,
                                   pointers_to(arguments).data(), pointers_to(environment).data());
    posix_spawn_file_actions_destroy(&actions);
    if (code != 0) {
        throw FileError("{}: can't be run in {}: {}", program.string(), folder.string(),
                        std::strerror(code));
    }
    return process;
}

/// The exit status, or nothing if the process had to be ended.
std::optional<int> wait_for(pid_t process, std::chrono::seconds time_limit) {
    const auto end = std::chrono::steady_clock::now() + time_limit;
    int status = 0;
    while (::waitpid(process, &status, WNOHANG) == 0) {
        if (std::chrono::steady_clock::now() > end) {
            ::kill(process, SIGKILL);
            ::waitpid(process, &status, 0);
            return std::nullopt;
        }
        std::this_thread::sleep_for(pause_between_looks);
    }
    return status;
}

std::string end_of(const std::string& output) {
    if (output.size() <= shown_output) {
        return output;
    }
    return fmt::format("...{}", std::string_view(output).substr(output.size() - shown_output));
}

}  // namespace

CalculixResult parse_calculix_dat(const std::string& file, std::string_view text) {
    TextCursor words(file, text, 0);
    CalculixResult result;
    while (!words.at_end()) {
        const std::string heading(words.word("a heading"));
        const std::string rest(words.rest_of_line());
        const std::size_t time = rest.rfind("time");
        if (time == std::string::npos) {
            words.fail("found {}; expected a heading that ends with the time",
                       in_quotes(fmt::format("{} {}", heading, rest)));
        }
        result.time = std::strtod(rest.c_str() + time + std::strlen("time"), nullptr);
        if (heading == "displacements") {
            result.displacements = read_nodes(words, "a displacement");
        } else if (heading == "forces") {
            result.forces = read_nodes(words, "a force");
        } else if (heading == "stresses") {
            const MatrixX printed = read_points(words, 6, "a stress");
            // Printed as xx, yy, zz, xy, xz, yz.
            result.stresses = printed;
            result.stresses.col(3) = printed.col(5);
            result.stresses.col(5) = printed.col(3);
        } else if (heading == "global") {
            result.points = read_points(words, 3, "a coordinate");
        } else {
            words.fail("found {}; expected displacements, forces, stresses or global coordinates",
                       in_quotes(heading));
        }
    }
    const auto require = [&](bool holds, const std::string& what) {
        if (!holds) {
            throw FileError("{}: {}; the run has not come to its end", file, what);
        }
    };
    require(result.displacements.rows() > 0, "there are no displacements");
    require(result.forces.rows() == result.displacements.rows(),
            fmt::format("there are {} displacements and {} forces", result.displacements.rows(),
                        result.forces.rows()));
    require(result.stresses.rows() > 0, "there are no stresses");
    require(result.points.rows() == result.stresses.rows(),
            fmt::format("there are {} stresses and {} points", result.stresses.rows(),
                        result.points.rows()));
    return result;
}

std::optional<fs::path> find_calculix() {
    const char* const folders = std::getenv("PATH");
    std::istringstream list(folders == nullptr ? "" : folders);
    for (std::string folder; std::getline(list, folder, ':');) {
        const fs::path program = fs::path(folder) / "ccx";
        if (::access(program.c_str(), X_OK) == 0 && !fs::is_directory(program)) {
            return program;
        }
    }
    return std::nullopt;
}

CalculixResult run_calculix(const fs::path& folder, const std::string& job,
                            std::chrono::seconds time_limit) {
    const std::optional<fs::path> program = find_calculix();
    if (!program) {
        throw FileError(
            "ccx: the program is not in any folder of PATH; install Debian's package "
            "calculix-ccx");
    }
    const fs::path data = folder / (job + ".dat");
    std::error_code code;
    fs::remove(data, code);
    const std::string log = job + ".log";
    const std::optional<int> status =
        wait_for(start(*program, {"ccx", "-i", job}, folder, log), time_limit);
    const std::string output = read_text(folder / log);
    if (!status) {
        throw SolverError("ccx: {} was not done after {} s and has been ended; its last words:\n{}",
                          job, time_limit.count(), end_of(output));
    }
    if (!WIFEXITED(*status) || WEXITSTATUS(*status) != 0 ||
        output.find("Job finished") == std::string::npos) {
        throw SolverError("ccx: {} failed, {} {}; its last words:\n{}", job,
                          WIFEXITED(*status) ? "exit code" : "signal",
                          WIFEXITED(*status) ? WEXITSTATUS(*status) : WTERMSIG(*status),
                          end_of(output));
    }
    return parse_calculix_dat(data.string(), read_text(data));
}

}  // namespace couture::io
