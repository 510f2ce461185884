#pragma once

#include <string>

#include "apps/help/command.h"

namespace exemplar {

/// Adds the hidden option --help-pages FOLDER, with which the build writes man pages (FOLDER/man1) and completion
/// scripts (FOLDER/bash, FOLDER/zsh, FOLDER/fish) for a program. Pages are dated today, or
/// SOURCE_DATE_EPOCH of the environment.
void add_help_pages_option(Command& program, const std::string& version);

}  // namespace exemplar
