#pragma once

#include <string>
#include <string_view>

#include "apps/help/command_help.h"

namespace exemplar {

/// Returns the man page of one command, in roff. `release` is the program's name and version, `date` as 2026-01-31.
std::string man_page(const CommandHelp& command, std::string_view release, std::string_view date);

/// "exemplar-label-train"
std::string man_page_name(const CommandHelp& command);

}  // namespace exemplar
