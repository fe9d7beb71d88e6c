#include "drivers/number_list.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "iga/core/error.h"

namespace couture::drivers {

std::vector<double> read_number_list(const std::string& command, const std::string& option,
                                     const std::string& text, const std::string& names) {
    std::vector<double> numbers;
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    bool is_list = true;
    while (is_list) {
        double number = 0.0;
        const auto [stop, error] = std::from_chars(at, end, number);
        is_list = error == std::errc() && std::isfinite(number);
        numbers.push_back(number);
        if (stop == end) break;
        is_list = is_list && *stop == ',';
        at = stop + 1;
    }
    const auto n_names = std::ranges::count(names, ',') + 1;
    if (!is_list || (!names.empty() && n_names != static_cast<std::ptrdiff_t>(numbers.size()))) {
        throw InputError("{}: {} '{}' is no list of numbers; write {} without blanks", command,
                         option, text, names.empty() ? "C1,C2,..." : names);
    }
    return numbers;
}

}  // namespace couture::drivers
