#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace exemplar {

/// What a shell offers in the place of a value.
enum class Completion { nothing, words, files, folders };

/// An option or a positional argument, as it was defined.
struct ArgumentHelp {
    std::vector<std::string> names;  ///< "-h", "--help"; of a positional what stands for it, "MESH"
    std::string description;
    std::string value;          ///< what stands for the value, "FOLDER"; empty if there is none
    std::string range;          ///< "from 1 to 64", or empty
    std::string default_value;  ///< empty if there is none
    std::vector<std::string> words;
    Completion completion = Completion::nothing;
    bool required = false;
    bool many = false;   ///< several values may follow
    bool comma = false;  ///< commas separate values
};

/// A program or one of its subcommands, as it was defined.
struct CommandHelp {
    std::string path;  ///< "exemplar label train"
    std::string description, footer;
    std::vector<ArgumentHelp> options, positionals;
    std::vector<CommandHelp> subcommands;

    std::string name() const { return path.substr(path.rfind(' ') + 1); }
};

/// Reads the definitions of a program; what is hidden from its --help is left out.
CommandHelp describe_command(CLI::App& app);

/// The command, those below it, and so on: a command before its own.
std::vector<const CommandHelp*> all_commands(const CommandHelp& command);

/// `path` with `separator` in the place of blanks, and all other characters that are neither letters nor digits.
std::string joined_path(std::string_view path, char separator);

}  // namespace exemplar
