#include "io/atomic_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include "iga/core/error.h"

namespace couture::io {

namespace fs = std::filesystem;

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
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw FileError("{}: can't be read: {}", path.string(), std::strerror(errno));
    }
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

}  // namespace couture::io
