#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace exemplar {

/// Adds the hidden option --help-pages FOLDER, with which the build writes man pages (FOLDER/man1) and completion
/// scripts (FOLDER/bash, FOLDER/zsh, FOLDER/fish) for `app`, which must have a name. Pages are dated today, or
/// SOURCE_DATE_EPOCH of the environment.
void add_help_pages_option(CLI::App& app, const std::string& version);

}  // namespace exemplar
