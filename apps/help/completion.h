#pragma once

#include <string>

#include "apps/help/command_help.h"

namespace exemplar {

/// Scripts that complete a program's command line: subcommands, options, their words, files and folders.
std::string bash_completion(const CommandHelp& program);
std::string zsh_completion(const CommandHelp& program);
std::string fish_completion(const CommandHelp& program);

}  // namespace exemplar
