#include "io/atomic_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "iga/core/error.h"

namespace couture::io {

namespace fs = std::filesystem;

namespace {

std::mutex temporaries_mutex;
std::set<fs::path> temporaries;

/// Keeps a path in the list of temporary files while it lives.
class Listed {
  public:
    explicit Listed(fs::path path) : path_(std::move(path)) {
        const std::lock_guard lock(temporaries_mutex);
        temporaries.insert(path_);
    }
    ~Listed() {
        const std::lock_guard lock(temporaries_mutex);
        temporaries.erase(path_);
    }
    Listed(const Listed&) = delete;
    Listed& operator=(const Listed&) = delete;

  private:
    fs::path path_;
};

}  // namespace

void remove_temporaries() {
    // Never unlocked: nothing may be renamed to its final name any more.
    temporaries_mutex.lock();
    std::error_code code;
    for (const fs::path& path : temporaries) {
        fs::remove(path, code);
    }
}

void write_atomically(const fs::path& path,
                      const std::function<void(const fs::path& temporary)>& write) {
    std::error_code code;
    const fs::path folder = path.parent_path();
    if (!folder.empty()) {
        fs::create_directories(folder, code);
        if (code) {
            throw FileError("{}: the folder can't be made: {}", folder.string(), code.message());
        }
    }
    if (fs::is_directory(path, code)) {
        throw FileError("{}: is a folder; give a file name", path.string());
    }
    const fs::path temporary = folder / fmt::format(".{}.{}{}", path.stem().string(), ::getpid(),
                                                    path.extension().string());
    const Listed listed(temporary);
    try {
        write(temporary);
    } catch (...) {
        fs::remove(temporary, code);
        throw;
    }
    fs::rename(temporary, path, code);
    if (code) {
        const std::string reason = code.message();
        fs::remove(temporary, code);
        throw FileError("{}: can't be written: {}", path.string(), reason);
    }
}

void remove_leftovers(const fs::path& folder, const std::string& stem) {
    std::error_code code;
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder, code)) {
        // ".name.PID.extension", as made above.
        const std::string name = entry.path().stem().string();
        const std::size_t dot = name.rfind('.');
        if (name.starts_with("." + stem) && dot > 0 && dot + 1 < name.size() &&
            name.find_first_not_of("0123456789", dot + 1) == std::string::npos) {
            found.push_back(entry.path());
        }
    }
    for (const fs::path& path : found) {
        fs::remove(path, code);
    }
}

void require_writable(const fs::path& folder) {
    std::error_code code;
    fs::path existing = fs::absolute(folder);
    while (!fs::exists(existing, code) && existing.has_parent_path() &&
           existing != existing.parent_path()) {
        existing = existing.parent_path();
    }
    if (!fs::is_directory(existing, code)) {
        throw FileError("{}: results can't be written there: {} is not a folder", folder.string(),
                        existing.string());
    }
    if (::access(existing.c_str(), W_OK) != 0) {
        throw FileError("{}: results can't be written there: {}: {}", folder.string(),
                        existing.string(), std::strerror(errno));
    }
}

void write_text(const fs::path& path, std::string_view text) {
    write_atomically(path, [&](const fs::path& temporary) {
        std::ofstream file(temporary, std::ios::binary);
        file.write(text.data(), static_cast<std::streamsize>(text.size()));
        file.close();
        if (!file) {
            throw FileError("{}: can't be written: {}", path.string(), std::strerror(errno));
        }
    });
}

std::string read_text(const fs::path& path) {
    if (fs::is_directory(path)) {
        throw FileError("{}: is a folder, not a file", path.string());
    }
    if (fs::exists(path) && !fs::is_regular_file(path)) {
        throw FileError("{}: is a pipe or device, not a file; write it to a file first",
                        path.string());
    }
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw FileError("{}: can't be read: {}", path.string(), std::strerror(errno));
    }
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

}  // namespace couture::io
