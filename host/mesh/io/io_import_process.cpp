// Runs exemplar-import on a file and collects what it writes.
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <thread>

#include "host/mesh/io/io_import.h"
#include "host/mesh/io/io_text.h"

extern char** environ;

namespace exemplar::mesh_io {
namespace {

namespace fs = std::filesystem;
using ImportClock = std::chrono::steady_clock;

constexpr const char* k_import_program = "exemplar-import";
constexpr std::uint64_t k_megabyte = std::uint64_t{1} << 20;

/// Returns the path of the program, or its name alone if only PATH can tell.
std::string import_program() {
    std::error_code ignored;
    const fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    for (const fs::path& place : {folder, folder.parent_path()})
        if (!place.empty() && fs::is_regular_file(place / k_import_program, ignored)) return place / k_import_program;
    return k_import_program;
}

/// The bounds of exemplar-import. They only matter if a file has taken control of it, since it limits itself to less.
ImportBounds usual_bounds(const fs::path& path) {
    std::error_code unknown_size;
    const std::uint64_t size = fs::file_size(path, unknown_size), bytes = unknown_size ? 0 : size;
    return {std::chrono::seconds(5 * (60 + bytes / k_megabyte)), 256 * k_megabyte + 200 * bytes};
}

struct ImportRun {
    int not_started = 0;  ///< errno
    int status = 0;       ///< as waitpid tells
    bool is_late = false, is_too_large = false;
    std::string output;
};

/// Reads the pipe `end` into the run's output, until the program closes it, the deadline passes, or the output has more
/// than `max_bytes`.
void read_until_closed(int end, ImportClock::time_point deadline, std::uint64_t max_bytes, ImportRun& run) {
    std::array<char, 65536> bytes{};
    for (;;) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - ImportClock::now()).count();
        pollfd readable{.fd = end, .events = POLLIN, .revents = 0};
        const int found = left > 0 ? poll(&readable, 1, static_cast<int>(std::min<std::int64_t>(left, 1 << 30))) : 0;
        if (found < 0 && errno == EINTR) continue;
        run.is_late = found == 0;
        run.is_too_large = run.output.size() > max_bytes;
        if (found <= 0 || run.is_too_large) return;
        const ssize_t got = read(end, bytes.data(), bytes.size());
        if (got > 0) run.output.append(bytes.data(), static_cast<std::size_t>(got));
        if (got == 0 || (got < 0 && errno != EINTR)) return;
    }
}

/// Waits until the process ends, and ends it at the deadline.
void await_end(pid_t child, ImportClock::time_point deadline, ImportRun& run) {
    for (;;) {
        if (run.is_late || run.is_too_large) kill(child, SIGKILL);
        const pid_t ended = waitpid(child, &run.status, WNOHANG);
        if (ended == child || (ended < 0 && errno != EINTR)) return;
        run.is_late = run.is_late || ImportClock::now() > deadline;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

/// Starts the program with its output in `end`; returns errno.
int start_import(std::string program, const fs::path& path, ImportContent wanted, int end, pid_t& child) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, end, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::string option = "--animation", file = fs::absolute(path).string();
    std::array<char*, 4> arguments{program.data(), option.data(), file.data(), nullptr};
    if (wanted == ImportContent::still) arguments = {program.data(), file.data(), nullptr, nullptr};
    const int error = posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

ImportRun run_program(const std::string& program, const fs::path& path, ImportContent wanted,
                      const ImportBounds& bounds) {
    ImportRun run;
    const ImportClock::time_point deadline = ImportClock::now() + bounds.time;
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
        run.not_started = errno;
        return run;
    }
    pid_t child = 0;
    run.not_started = start_import(program, path, wanted, ends[1], child);
    close(ends[1]);
    if (!run.not_started) read_until_closed(ends[0], deadline, bounds.bytes, run);
    close(ends[0]);
    if (!run.not_started) await_end(child, deadline, run);
    return run;
}

/// Throws what went wrong, if anything.
void check_run(const ImportRun& run, const fs::path& path) {
    const std::string name = path.string(), extension = path.extension().string();
    if (run.not_started)
        fail(name,
             fmt::format("{} is read by builds with assimp; install libassimp-dev and build again, or convert the "
                         "file to glTF, OBJ or PLY",
                         extension));
    if (run.is_too_large)
        fail(name, "holds far more than a file of its size should; convert the file to glTF, OBJ or PLY");
    if (run.is_late || WIFSIGNALED(run.status)) {
        const bool late = run.is_late || WTERMSIG(run.status) == SIGXCPU || WTERMSIG(run.status) == SIGKILL;
        fail(name, fmt::format("{}; convert the file to glTF, OBJ or PLY",
                               late ? "reading it took too long, and was ended" : "its reader crashed on this file"));
    }
    if (WEXITSTATUS(run.status) != 0)
        fail(name, run.output.empty() ? "cannot be read" : printable(trimmed(run.output), 300));
}

}  // namespace

std::string run_import(const fs::path& path, ImportContent wanted) {
    return run_import(path, wanted, import_program(), usual_bounds(path));
}

std::string run_import(const fs::path& path, ImportContent wanted, const std::string& program,
                       const ImportBounds& bounds) {
    ImportRun run = run_program(program, path, wanted, bounds);
    check_run(run, path);
    return std::move(run.output);
}

}  // namespace exemplar::mesh_io
