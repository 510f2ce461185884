#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): of another library
class App;
}

namespace exemplar {

/// The kind of values that a shell offers to complete.
enum class Completion { nothing, words, files, folders };

/// An option or a positional argument, as it was defined.
struct ArgumentHelp {
    std::vector<std::string> names;  ///< "-h", "--help"; for a positional argument the name of its value, "MESH"
    std::string description;
    std::string value;          ///< name of the value in the help text, "FOLDER"; empty if it takes none
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

/// Reads the definitions of a program, without those that its --help hides.
CommandHelp describe_command(CLI::App& app);

/// Returns the command and all its subcommands, each before its own subcommands.
std::vector<const CommandHelp*> all_commands(const CommandHelp& command);

/// Returns `path` with `separator` instead of every character that is neither a letter nor a digit.
std::string joined_path(std::string_view path, char separator);

}  // namespace exemplar
