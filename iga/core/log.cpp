#include "iga/core/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <mutex>

namespace couture::log {

namespace {

spdlog::logger& logger() {
    static const auto instance = [] {
        auto created = spdlog::stderr_color_mt("couture");
        created->set_pattern("%^%v%$");
        created->set_level(spdlog::level::warn);
        return created;
    }();
    return *instance;
}

std::mutex warnings_mutex;
std::vector<std::string> kept_warnings;

}  // namespace

void set_level(Level level) {
    switch (level) {
        case Level::quiet:
            logger().set_level(spdlog::level::err);
            break;
        case Level::warnings:
            logger().set_level(spdlog::level::warn);
            break;
        case Level::progress:
            logger().set_level(spdlog::level::info);
            break;
        case Level::detail:
            logger().set_level(spdlog::level::debug);
            break;
    }
}

void info(std::string_view message) { logger().info("{}", message); }
void detail(std::string_view message) { logger().debug("{}", message); }

void warn(std::string_view message) {
    const std::lock_guard lock(warnings_mutex);
    if (std::find(kept_warnings.begin(), kept_warnings.end(), message) != kept_warnings.end()) {
        return;
    }
    kept_warnings.emplace_back(message);
    logger().warn("warning: {}", message);
}

std::vector<std::string> warnings() {
    const std::lock_guard lock(warnings_mutex);
    return kept_warnings;
}

void clear_warnings() {
    const std::lock_guard lock(warnings_mutex);
    kept_warnings.clear();
}

}  // namespace couture::log
