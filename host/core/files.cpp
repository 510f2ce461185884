#include "host/core/files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "host/core/errors.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// A name no other thread or process uses at this moment.
fs::path temporary_beside(const fs::path& path) {
    static std::atomic<unsigned> counter{0};
    fs::path name = path;
    name += fmt::format(".{}.{}.tmp", getpid(), counter++);
    return name;
}

[[noreturn]] void fail(const fs::path& path, int error) {
    throw DataError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(error)));
}

/// Removes the temporary file unless the write was completed.
struct RemoveUnlessKept {
    fs::path path;
    bool kept = false;
    ~RemoveUnlessKept() {
        std::error_code ignored;
        if (!kept) fs::remove(path, ignored);
    }
};

}  // namespace

void write_file_atomically(const fs::path& path, const std::function<void(std::ostream&)>& write) {
    std::error_code error;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
    if (error) fail(path, error.value());

    RemoveUnlessKept temporary{temporary_beside(path)};
    errno = 0;
    std::ofstream stream(temporary.path, std::ios::binary | std::ios::trunc);
    if (!stream) fail(path, errno);
    write(stream);
    stream.close();
    if (!stream) fail(path, errno ? errno : EIO);
    fs::rename(temporary.path, path, error);
    if (error) fail(path, error.value());
    temporary.kept = true;
}

std::string read_file(const fs::path& path) {
    if (fs::is_directory(path)) throw DataError(path.string() + ": is a folder, not a file");
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw DataError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    std::ostringstream content;
    content << stream.rdbuf();
    if (stream.bad()) throw DataError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    return std::move(content).str();
}

}  // namespace exemplar
