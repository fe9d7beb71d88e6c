#include "iga/core/timer.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace couture {

std::size_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

namespace {

std::size_t machine_available() {
    std::ifstream file("/proc/meminfo");
    std::string key;
    std::size_t kilobytes = 0;
    std::string unit;
    while (file >> key >> kilobytes) {
        std::getline(file, unit);
        if (key == "MemAvailable:") {
            return kilobytes * 1024;
        }
    }
    return std::numeric_limits<std::size_t>::max();
}

std::size_t cgroup_available() {
    std::ifstream limit_file("/sys/fs/cgroup/memory.max");
    std::ifstream used_file("/sys/fs/cgroup/memory.current");
    std::size_t limit = 0;
    std::size_t used = 0;
    if (limit_file >> limit && used_file >> used) {
        return limit > used ? limit - used : 0;
    }
    return std::numeric_limits<std::size_t>::max();
}

}  // namespace

std::size_t available_address_space() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
        return std::numeric_limits<std::size_t>::max();
    }
    std::ifstream file("/proc/self/statm");
    std::size_t pages = 0;
    file >> pages;
    const std::size_t used = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

std::size_t available_memory() {
    return std::min({machine_available(), cgroup_available(), available_address_space()});
}

}  // namespace couture
