// Reads what exemplar-import makes of a file: lines "warning TEXT", then a binary PLY file; or one line that says why
// there is none.
#include "host/mesh/io/io_import.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>

#include "host/core/text.h"
#include "host/mesh/editing/weld.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_text.h"

extern char** environ;

namespace exemplar::mesh_io {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_import_program = "exemplar-import";

/// Returns the path of the program, or its name alone if only PATH can tell.
std::string import_program() {
    std::error_code ignored;
    const fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    for (const fs::path& place : {folder, folder.parent_path()})
        if (!place.empty() && fs::is_regular_file(place / k_import_program, ignored)) return place / k_import_program;
    return k_import_program;
}

struct ImportOutput {
    int not_started = 0;  ///< errno
    int status = 0;       ///< as waitpid tells
    std::string bytes;
};

ImportOutput run_import(const std::string& program, const fs::path& path) {
    ImportOutput output;
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return {errno, 0, {}};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::string name = program, file = fs::absolute(path).string();
    std::array<char*, 3> arguments{name.data(), file.data(), nullptr};
    pid_t child = 0;
    output.not_started = posix_spawnp(&child, name.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    std::array<char, 65536> bytes{};
    ssize_t got = 0;
    while (!output.not_started &&
           ((got = read(ends[0], bytes.data(), bytes.size())) > 0 || (got < 0 && errno == EINTR)))
        if (got > 0) output.bytes.append(bytes.data(), static_cast<std::size_t>(got));
    close(ends[0]);
    while (!output.not_started && waitpid(child, &output.status, 0) < 0 && errno == EINTR) continue;
    return output;
}

/// Throws what went wrong, if anything.
void check_import(const ImportOutput& output, const fs::path& path) {
    const std::string name = path.string(), extension = path.extension().string();
    if (output.not_started)
        fail(name,
             fmt::format("{} is read by builds with assimp; install libassimp-dev and build again, or convert the "
                         "file to glTF, OBJ or PLY",
                         extension));
    if (WIFSIGNALED(output.status)) {
        const bool late = WTERMSIG(output.status) == SIGXCPU || WTERMSIG(output.status) == SIGKILL;
        fail(name, fmt::format("{}; convert the file to glTF, OBJ or PLY",
                               late ? "reading it took too long, and was ended" : "its reader crashed on this file"));
    }
    if (WEXITSTATUS(output.status) != 0)
        fail(name, output.bytes.empty() ? "cannot be read" : printable(trimmed(output.bytes), 300));
}

/// Takes the lines of warnings in front of the PLY file.
std::vector<std::string> take_warnings(std::string_view& content) {
    constexpr std::string_view k_begin = "warning ";
    std::vector<std::string> warnings;
    while (content.starts_with(k_begin)) {
        const std::size_t end = content.find('\n');
        warnings.push_back(printable(content.substr(k_begin.size(), end - k_begin.size()), 300));
        content.remove_prefix(end == std::string_view::npos ? content.size() : end + 1);
    }
    return warnings;
}

/// Joins vertices at equal positions, which such files have for each normal and texture coordinate.
void join_vertices(MeshFile& file) {
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> number;
    VertexWelder welder;
    for (const Vec3& position : file.mesh.vertices) number.push_back(welder.add(position, vertices));
    for (Face& face : file.mesh.faces)
        for (std::uint32_t& v : face) v = number[v];
    for (std::uint32_t& v : file.polygons.corners) v = number[v];
    file.mesh.vertices = std::move(vertices);
}

}  // namespace

MeshFile read_imported(const fs::path& path) {
    const ImportOutput output = run_import(import_program(), path);
    check_import(output, path);
    std::string_view content = output.bytes;
    std::vector<std::string> warnings = take_warnings(content);
    MeshFile file = read_ply(content, path.string());
    join_vertices(file);
    file.warnings.insert(file.warnings.begin(), warnings.begin(), warnings.end());
    return file;
}

}  // namespace exemplar::mesh_io
