#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/help/completion.h"

namespace exemplar {
namespace {

/// Text inside of a specification of _arguments, which colons and brackets divide, in single quotes.
std::string escaped_zsh(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '\'') {
            out += "'\\''";
            continue;
        }
        if (c == ':' || c == '[' || c == ']' || c == '\\') out += '\\';
        out += c;
    }
    return out;
}

/// How a value is completed, behind the colon.
std::string action_of(const ArgumentHelp& argument) {
    switch (argument.completion) {
        case Completion::words:
            if (argument.comma) return fmt::format("_sequence compadd - {}", fmt::join(argument.words, " "));
            return fmt::format("({})", fmt::join(argument.words, " "));
        case Completion::files:
            if (!argument.words.empty())
                // The blank keeps _arguments from adding options of its own.
                return fmt::format(" _alternative \"words\\:word\\:({})\" \"files\\:file\\:_files\"",
                                   fmt::join(argument.words, " "));
            return "_files";
        case Completion::folders:
            return "_files -/";
        case Completion::nothing:
            return " ";
    }
    return " ";
}

std::string option_lines(const CommandHelp& command) {
    std::string text;
    for (const ArgumentHelp& option : command.options)
        for (const std::string& name : option.names) {
            const bool has_value = !option.value.empty();
            // A star: it may be given again. An equal sign: the value may follow one.
            text += fmt::format("        '{}{}{}[{}]{}'\n", option.many || option.comma ? "*" : "", name,
                                has_value && name.starts_with("--") ? "=" : "", escaped_zsh(option.description),
                                has_value ? fmt::format(":{}:{}", escaped_zsh(option.value), action_of(option)) : "");
        }
    return text;
}

std::string positional_lines(const CommandHelp& command) {
    std::string text;
    for (std::size_t i = 0; i < command.positionals.size(); ++i) {
        const ArgumentHelp& argument = command.positionals[i];
        text += fmt::format("        '{}:{}:{}'\n", argument.many ? "*" : std::to_string(i + 1),
                            escaped_zsh(argument.names.front()), action_of(argument));
    }
    return text;
}

std::string function_name(const CommandHelp& command) {
    return "_" + joined_path(command.path, '_');
}

std::string leaf_function(const CommandHelp& command) {
    return fmt::format("{}() {{\n    local specifications=(\n{}{}    )\n    _arguments $specifications\n}}\n",
                       function_name(command), option_lines(command), positional_lines(command));
}

/// Returns the function of a command with subcommands: the first word selects one, which completes the rest.
std::string branch_function(const CommandHelp& command) {
    std::string descriptions, calls;
    for (const CommandHelp& below : command.subcommands) {
        descriptions += fmt::format("            '{}:{}'\n", below.name(), escaped_zsh(below.description));
        calls += fmt::format("            {}) {} ;;\n", below.name(), function_name(below));
    }
    return fmt::format(
        "{}() {{\n    local context state line\n    local -A opt_args\n    local specifications=(\n{}"
        "        '1:COMMAND:->command'\n        '*::argument:->rest'\n    )\n"
        "    _arguments -C $specifications\n    case $state in\n        command)\n            local commands=(\n{}     "
        "       )\n"
        "            _describe command commands ;;\n        rest) case $line[1] in\n{}        esac ;;\n    esac\n}}\n",
        function_name(command), option_lines(command), descriptions, calls);
}

}  // namespace

std::string zsh_completion(const CommandHelp& program) {
    std::string text = fmt::format("#compdef {}\n# Completion of {} for zsh.\n", program.path, program.path);
    for (const CommandHelp* command : all_commands(program))
        text += command->subcommands.empty() ? leaf_function(*command) : branch_function(*command);
    return text + function_name(program) + " \"$@\"\n";
}

}  // namespace exemplar
