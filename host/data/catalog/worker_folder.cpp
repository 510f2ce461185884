#include "host/data/catalog/worker_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <random>
#include <vector>

#include "host/core/errors.h"
#include "host/data/catalog/catalog.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_lock = ".lock";
constexpr const char* k_work = ".work";

[[noreturn]] void throw_lock_error(const fs::path& path, int reason) {
    throw DataError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(reason)));
}

/// Opens a lock or marker file, or creates it. Does not create anything at the target of a link.
int open_or_make(const fs::path& path) {
    const int file = open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0) throw_lock_error(path, errno);
    return file;
}

std::string host_name() {
    std::array<char, 256> name{};
    gethostname(name.data(), name.size() - 1);
    std::string host(name.data());
    for (char& c : host)
        if (c == '/' || c == '.') c = '-';
    return host;
}

/// Returns a new id. The process number alone would not do: it is reused, and occurs on many machines.
std::string new_id() {
    std::random_device random;
    return fmt::format("{}-{}-{:08x}", host_name(), getpid(), random());
}

/// Returns whether somebody holds the lock; true if the system cannot tell.
bool is_held(const fs::path& lock) {
    const int file = open(lock.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) return errno != ENOENT;
    const bool held = flock(file, LOCK_EX | LOCK_NB) != 0;
    close(file);
    return held;
}

/// Returns whether a worker ran on this machine, by its name from new_id without the last two parts. Locks held on
/// other machines may look free here.
bool is_of_this_host(const fs::path& lock) {
    std::string host = lock.stem().string();
    for (int part = 0; part < 2; ++part) host.resize(std::min(host.rfind('-'), host.size()));
    return host == host_name();
}

bool is_old(const fs::path& path) {
    constexpr auto k_long = std::chrono::hours(24);
    std::error_code error;
    const auto changed = fs::last_write_time(path, error);
    return error || fs::file_time_type::clock::now() - changed > k_long;
}

/// Removes the folders and locks of dead workers.
void remove_dead(const fs::path& work) {
    std::vector<fs::path> locks;
    std::error_code error;
    for (fs::directory_iterator it(work, error), end; !error && it != end; it.increment(error))
        if (it->path().extension() == k_lock && it->path().filename() != k_lock) locks.push_back(it->path());
    for (const fs::path& lock : locks) {
        if (is_held(lock) || !(is_of_this_host(lock) || is_old(fs::path(lock).replace_extension()))) continue;
        fs::remove_all(fs::path(lock).replace_extension(), error);
        fs::remove(lock, error);
    }
}

}  // namespace

FileLock::FileLock(const fs::path& path) : file_(open_or_make(path)) {
    // If the system cannot lock, is_held returns true, and leftovers are not removed.
    while (flock(file_, LOCK_EX) != 0 && errno == EINTR) continue;
}

FileLock::~FileLock() {
    close(file_);
}

WorkerFolder::WorkerFolder(const fs::path& output) : id_(new_id()) {
    const fs::path work = output / k_work;
    std::error_code error;
    fs::create_directories(work, error);
    if (error) throw_lock_error(work, error.value());
    // Nobody may find the lock free between its creation and its locking.
    const FileLock making(work / k_lock);
    remove_dead(work);
    path_ = work / id_;
    lock_path_ = work / (id_ + k_lock);
    lock_ = open_or_make(lock_path_);
    flock(lock_, LOCK_EX | LOCK_NB);
    fs::create_directory(path_, error);
    if (error) throw_lock_error(path_, error.value());
}

WorkerFolder::~WorkerFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    fs::remove(lock_path_, ignored);
    close(lock_);
}

bool WorkerFolder::may_be_alive(const fs::path& output, const std::string& id) {
    if (!is_output_name(id)) return false;
    return is_held(output / k_work / (id + k_lock));
}

void refuse_links(const fs::path& output) {
    std::error_code ignored;
    for (const char* const name : {k_work, "labeled", "shards", "index.html", "catalog.db", k_output_mark})
        if (fs::is_symlink(output / name, ignored))
            throw DataError(
                fmt::format("{}: is a link, and nothing is written where links lead; remove it or give "
                            "another output folder",
                            (output / name).string()));
}

void mark_output_folder(const fs::path& output) {
    std::error_code error;
    fs::create_directories(output, error);
    if (error) throw_lock_error(output, error.value());
    close(open_or_make(output / k_output_mark));
}

fs::path make_output_folder(const fs::path& output, const std::string& name) {
    if (!is_output_name(name))
        throw DataError(fmt::format("'{}' leads out of the output folder {}", name, output.string()));
    fs::path folder = output;
    std::error_code error;
    fs::create_directories(output, error);
    if (error) throw_lock_error(output, error.value());
    for (const fs::path& part : fs::path(name).parent_path()) {
        folder /= part;
        const fs::file_status status = fs::symlink_status(folder, error);
        if (fs::is_directory(status)) continue;
        if (fs::exists(status))
            throw DataError(
                fmt::format("{}: is no folder, so that nothing can be written there; remove it", folder.string()));
        error.clear();
        fs::create_directory(folder, error);
        if (error) throw_lock_error(folder, error.value());
    }
    return folder;
}

}  // namespace exemplar
