#include "apps/exemplar/run_words.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "host/core/errors.h"

extern char** environ;

namespace exemplar {
namespace {

/// Returns "NAME=value" of the program's own variables and of `variables`, which replace them.
std::vector<std::string> environment_with(const std::vector<Variable>& variables) {
    std::vector<std::string> all;
    for (char** own = environ; *own; ++own) {
        const std::string_view text = *own, name = text.substr(0, text.find('='));
        if (std::ranges::find(variables, name, &Variable::first) == variables.end()) all.emplace_back(text);
    }
    for (const auto& [name, value] : variables) all.push_back(fmt::format("{}={}", name, value));
    return all;
}

std::vector<char*> pointers_to(const std::vector<std::string>& words) {
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
    pointers.push_back(nullptr);
    return pointers;
}

}  // namespace

ProgramOutput run_words(const std::vector<std::string>& words, const std::vector<Variable>& variables) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw DataError(fmt::format("no pipe: {}", std::strerror(errno)));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    const std::vector<std::string> environment = environment_with(variables);
    const std::vector<char*> arguments = pointers_to(words), settings = pointers_to(environment);
    pid_t child = 0;
    const int failed = posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), settings.data());
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    ProgramOutput output{failed ? 127 : 0, {}};
    std::array<char, 4096> bytes{};
    ssize_t got = 0;
    while (!failed && ((got = read(ends[0], bytes.data(), bytes.size())) > 0 || (got < 0 && errno == EINTR)))
        if (got > 0) output.text.append(bytes.data(), static_cast<std::size_t>(got));
    close(ends[0]);
    if (failed) {
        output.text = std::strerror(failed);
        return output;
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    output.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    return output;
}

std::filesystem::path this_program() {
    return std::filesystem::read_symlink("/proc/self/exe");
}

}  // namespace exemplar
