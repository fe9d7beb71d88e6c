#include "drivers/state_series.h"

#include <algorithm>
#include <cctype>

#include "iga/core/error.h"
#include "iga/core/log.h"

namespace couture::drivers {

namespace fs = std::filesystem;

namespace {

constexpr const char* extension = ".h5";
constexpr const char* remeshed = "_remeshed";

/// "0003.h5" or "0003_remeshed.h5".
bool is_state(const fs::path& path) {
    std::string stem = path.stem().string();
    if (stem.ends_with(remeshed)) {
        stem.resize(stem.size() - std::string_view(remeshed).size());
    }
    return path.extension() == extension && stem.size() >= 4 &&
           std::all_of(stem.begin(), stem.end(),
                       [](unsigned char c) { return std::isdigit(c) != 0; });
}

void remove_file(const fs::path& path) {
    std::error_code code;
    fs::remove(path, code);
    if (code) {
        throw FileError("{}: can't be removed: {}", path.string(), code.message());
    }
}

}  // namespace

std::string step_name(int number, bool is_remeshing) {
    return fmt::format("{:04}{}", number, is_remeshing ? remeshed : "");
}

template <int d>
StateSeries<d>::StateSeries(fs::path folder, io::StateOrigin origin,
                            iga::ReferencePtr<d> undeformed)
    : folder_(std::move(folder)), origin_(std::move(origin)), undeformed_(std::move(undeformed)) {}

template <int d>
std::vector<fs::path> StateSeries<d>::files() const {
    std::vector<fs::path> result;
    std::error_code code;
    for (const auto& entry : fs::directory_iterator(folder_, code)) {
        if (is_state(entry.path()) && entry.is_regular_file(code)) {
            result.push_back(entry.path());
        }
    }
    // By number, a step before its remeshing.
    std::sort(result.begin(), result.end(), [](const fs::path& a, const fs::path& b) {
        const std::string first = a.stem().string();
        const std::string second = b.stem().string();
        const int i = std::stoi(first);
        const int j = std::stoi(second);
        return i != j ? i < j : first.size() < second.size();
    });
    return result;
}

template <int d>
int StateSeries<d>::clear() const {
    const std::vector<fs::path> old = files();
    // Newest first: what is left after an interrupt is a series without gaps.
    for (auto file = old.rbegin(); file != old.rend(); ++file) {
        remove_file(*file);
    }
    return static_cast<int>(old.size());
}

template <int d>
std::vector<iga::AcceptedStep<d>> StateSeries<d>::read_all() const {
    const std::vector<fs::path> all = files();
    std::vector<iga::AcceptedStep<d>> steps;
    std::size_t n_until_last = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        try {
            iga::AcceptedStep<d> step = io::read_state<d>(all[i], undeformed_, origin_);
            if (step_name(step.number, step.remeshing.has_value()) != all[i].stem().string()) {
                throw FileError("{}: holds step {}, not the one that it is named after",
                                all[i].string(), step.number);
            }
            const int expected = steps.empty() ? 1 : steps.back().number + 1;
            if (step.number > expected) {
                log::warn(
                    fmt::format("{}: the states of steps {} to {} are missing: the history "
                                "has a gap",
                                folder_.string(), expected, step.number - 1));
            }
            if (!steps.empty()) {
                steps.back().state.displacement = {};
                steps.back().state.direction = {};
                steps.back().state.reference = {};
            }
            steps.push_back(std::move(step));
            n_until_last = i + 1;
        } catch (const FileError& error) {
            log::warn(fmt::format("{}; this state is left out", error.what()));
        }
    }
    for (std::size_t i = n_until_last; i < all.size(); ++i) {
        remove_file(all[i]);
    }
    return steps;
}

template <int d>
iga::AcceptedStep<d> StateSeries<d>::read(int number, bool is_remeshing) const {
    return io::read_state<d>(folder_ / (step_name(number, is_remeshing) + extension), undeformed_,
                             origin_);
}

template <int d>
void StateSeries<d>::write(const iga::AcceptedStep<d>& step) const {
    io::write_state<d>(folder_ / (step_name(step.number, step.remeshing.has_value()) + extension),
                       step, origin_);
}

template class StateSeries<2>;
template class StateSeries<3>;

}  // namespace couture::drivers
