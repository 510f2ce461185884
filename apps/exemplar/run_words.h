#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace exemplar {

struct ProgramOutput {
    int code;          ///< the exit code; 127 if the program cannot be started, 128 if a signal ended it
    std::string text;  ///< of both streams, or why it cannot be started
};

/// A variable of the environment and its value.
using Variable = std::pair<std::string, std::string>;

/// Runs a program found in PATH to its end, with `variables` in addition to this program's environment. Its words pass
/// no shell. Throws DataError if there is no pipe left.
ProgramOutput run_words(const std::vector<std::string>& words, const std::vector<Variable>& variables = {});

/// Returns the path of this program.
std::filesystem::path this_program();

}  // namespace exemplar
