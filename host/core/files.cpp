#include "host/core/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include "host/core/errors.h"
#include "host/core/memory_budget.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, int error) {
    throw DataError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(error)));
}

/// Creates an empty file beside `path` under a name that does not exist yet, not even as a link: in a shared folder
/// somebody may have placed a link there, and process numbers are reused.
fs::path temporary_beside(const fs::path& path, const fs::path& named) {
    static std::atomic<unsigned> counter{0};
    for (;;) {
        fs::path name = path;
        name += fmt::format(".{}.{}.tmp", getpid(), counter++);
        const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file < 0 && errno == EEXIST) continue;
        if (file < 0) fail(named, errno);
        close(file);
        return name;
    }
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

/// Fills the file `opened`; errors name `path`.
void write_stream(const fs::path& opened, const fs::path& path, const std::function<void(std::ostream&)>& write) {
    errno = 0;
    std::ofstream stream(opened, std::ios::binary | std::ios::trunc);
    if (!stream) fail(path, errno);
    write(stream);
    stream.close();
    if (!stream) fail(path, errno ? errno : EIO);
}

/// Returns whether `path` is written to directly: terminals, pipes and /dev/null must not be replaced by a file.
bool takes_a_stream(const fs::path& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::is_character_file(status) || fs::is_fifo(status);
}

/// Returns the target of a link, so that writing keeps the link; else `path`.
fs::path link_target(const fs::path& path) {
    std::error_code error;
    if (!fs::is_symlink(path, error)) return path;
    const fs::path target = fs::canonical(path, error);
    return error ? path : target;
}

/// Maps a file. Returns an empty view if there is nothing to map: an empty file, a pipe, an unreadable file.
FileView map_file(const fs::path& path) {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return {};  // opening a pipe would wait
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return {};
    struct stat status = {};
    const bool sized = fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0;
    const auto bytes = static_cast<std::size_t>(status.st_size);
    void* memory = sized ? mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE | MAP_POPULATE, file, 0) : MAP_FAILED;
    close(file);
    if (memory == MAP_FAILED) return {};
    const auto unmap = [bytes](void* mapped) { munmap(mapped, bytes); };
    return {{static_cast<const char*>(memory), bytes}, std::shared_ptr<void>(memory, unmap)};
}

}  // namespace

void write_file_atomically(const fs::path& path, const std::function<void(std::ostream&)>& write) {
    if (takes_a_stream(path)) return write_stream(path, path, write);
    std::error_code error;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
    if (error) fail(path, error.value());

    const fs::path target = link_target(path);
    RemoveUnlessKept temporary{temporary_beside(target, path)};
    write_stream(temporary.path, path, write);
    fs::rename(temporary.path, target, error);
    if (error) fail(path, error.value());
    temporary.kept = true;
}

namespace {

/// Throws DataError if so many bytes do not fit in memory: a sparse file takes no space on disk, and a pipe may
/// never end.
void require_memory_for(const fs::path& path, std::uintmax_t bytes) {
    constexpr std::uintmax_t k_always_there = 64 << 20;
    if (bytes < k_always_there || bytes <= usable_memory() / 2) return;
    throw DataError(fmt::format("{}: {:.1f} GB are too many to read in {:.1f} GB of memory", path.string(),
                                1e-9 * static_cast<double>(bytes), 1e-9 * static_cast<double>(usable_memory())));
}

}  // namespace

std::string read_file(const fs::path& path) {
    std::error_code ignored;  // opening says more
    if (fs::is_directory(path, ignored)) throw DataError(path.string() + ": is a folder, not a file");
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw DataError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    // A pipe has no size, and the size of a file may have changed: both are read to the end piece by piece.
    constexpr std::size_t k_piece = 65536;
    const std::uintmax_t size = fs::file_size(path, ignored);
    if (!ignored) require_memory_for(path, size);
    std::string content(ignored ? k_piece : static_cast<std::size_t>(size) + 1, '\0');
    std::size_t filled = 0;
    errno = 0;
    for (;;) {
        stream.read(content.data() + filled, static_cast<std::streamsize>(content.size() - filled));
        filled += static_cast<std::size_t>(stream.gcount());
        if (!stream) break;
        require_memory_for(path, 2 * content.size());
        content.resize(content.size() + std::max(k_piece, content.size() / 2));
    }
    if (stream.bad()) throw DataError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    content.resize(filled);
    return content;
}

FileView hold_file(const fs::path& path) {
    auto copy = std::make_shared<const std::string>(read_file(path));
    return {*copy, copy};
}

FileView view_file(const fs::path& path) {
    FileView mapped = map_file(path);
    return mapped.owner ? mapped : hold_file(path);
}

std::string suggest_file(const fs::path& path) {
    if (!path.has_filename() && path.has_relative_path()) return suggest_file(path.parent_path());  // ends in a slash
    std::vector<std::string> names;
    std::error_code error;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, error)) return {};  // before the iterator copies a path that may be long
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        if (std::error_code gone; !it->is_symlink(gone) || fs::exists(it->path(), gone))
            names.push_back(it->path().filename().string());
    std::sort(names.begin(), names.end());
    const std::string nearest = nearest_word(path.filename().string(), names);
    if (nearest.empty()) return {};
    return fmt::format(" (did you mean '{}'?)", (path.parent_path() / nearest).string());
}

}  // namespace exemplar
