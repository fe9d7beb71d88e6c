#include "iga/core/timer.h"

#include <sys/resource.h>

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

std::size_t available_memory() { return std::min(machine_available(), cgroup_available()); }

}  // namespace couture
