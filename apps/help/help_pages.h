#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace exemplar {

/// Adds the hidden option --help-pages FOLDER, by which the build makes man pages (FOLDER/man1) and completion
/// (FOLDER/bash, FOLDER/zsh, FOLDER/fish) of what is defined in `app`, which has a name. The pages are of today, or of
/// the environment's SOURCE_DATE_EPOCH.
void add_help_pages_option(CLI::App& app, const std::string& version);

}  // namespace exemplar
