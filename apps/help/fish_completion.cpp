#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/help/completion.h"

namespace exemplar {
namespace {

std::string fish_quoted(std::string_view text) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\') out += '\\';
        out += c;
    }
    return out + "'";
}

/// "-x": a value and no files; "-r": a value, with files. Fish has -s for short names and -l for long ones.
std::string value_of(const ArgumentHelp& argument) {
    const std::string words = fmt::format("{}", fmt::join(argument.words, " "));
    switch (argument.completion) {
        case Completion::words:
            if (argument.comma) return " -x -a " + fish_quoted("(__fish_append , " + words + ")");
            return " -x -a " + fish_quoted(words);
        case Completion::files:
            return " -r -F" + (words.empty() ? "" : " -a " + fish_quoted(words));
        case Completion::folders:
            return " -x -a '(__fish_complete_directories)'";
        case Completion::nothing:
            break;
    }
    return " -x";
}

std::string completion_lines(const CommandHelp& command, const std::string& begin) {
    std::string text;
    for (const CommandHelp& below : command.subcommands)
        text += fmt::format("{} -a {} -d {}\n", begin, below.name(), fish_quoted(below.description));
    for (const ArgumentHelp& argument : command.positionals) {
        if (argument.completion == Completion::files) text += begin + " -F\n";
        if (!argument.words.empty())
            text +=
                fmt::format("{} -a {} -d {}\n", begin, fish_quoted(fmt::format("{}", fmt::join(argument.words, " "))),
                            fish_quoted(argument.description));
    }
    for (const ArgumentHelp& option : command.options) {
        text += begin;
        for (const std::string& name : option.names)
            text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        text += (option.value.empty() ? "" : value_of(option)) + " -d " + fish_quoted(option.description) + "\n";
    }
    return text;
}

}  // namespace

std::string fish_completion(const CommandHelp& program) {
    const std::string function = "__" + joined_path(program.path, '_') + "_command";
    std::string paths;
    for (const CommandHelp* command : all_commands(program))
        if (command != &program) paths += " " + fish_quoted(command->path);
    std::string text =
        fmt::format("# Completion of {0} for fish.\nfunction {1}\n    set -l command {0}\n", program.path, function) +
        (paths.empty() ? ""
                       : fmt::format("    for word in (commandline -opc)[2..-1]\n"
                                     "        if contains -- \"$command $word\"{}\n"
                                     "            set command \"$command $word\"\n        end\n    end\n",
                                     paths)) +
        fmt::format("    echo $command\nend\ncomplete -c {} -f\n", program.path);
    for (const CommandHelp* command : all_commands(program))
        text += completion_lines(
            *command, fmt::format("complete -c {} -n 'test ({}) = \"{}\"'", program.path, function, command->path));
    return text;
}

}  // namespace exemplar
