#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "apps/help/completion.h"

namespace exemplar {
namespace {

/// Returns a bash pattern that matches exactly this text.
std::string bash_quoted(std::string_view text) {
    return fmt::format("'{}'", text);
}

/// The patterns of the options for which `chosen` holds: "command option".
template <typename Chosen>
std::vector<std::string> option_patterns(const CommandHelp& program, Chosen&& chosen) {
    std::vector<std::string> patterns;
    for (const CommandHelp* command : all_commands(program))
        for (const ArgumentHelp& option : command->options)
            for (const std::string& name : option.names)
                if (chosen(option)) patterns.push_back(bash_quoted(command->path + " " + name));
    return patterns;
}

std::string case_line(const std::vector<std::string>& patterns, std::string_view action) {
    return patterns.empty() ? "" : fmt::format("        {}) {} ;;\n", fmt::join(patterns, "|"), action);
}

/// Returns code that scans the words of the command line: sets `command` to the subcommand, `option` to the last
/// option before the cursor.
std::string finding_of_command(const CommandHelp& program) {
    std::vector<std::string> patterns;
    for (const CommandHelp* command : all_commands(program))
        if (command != &program) patterns.push_back(bash_quoted(command->path));
    return fmt::format(
               "    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}\n"
               "    local command={} option= words= kind= comma= i\n"
               "    for ((i = 1; i < COMP_CWORD; ++i)); do\n"
               "        case ${{COMP_WORDS[i]}} in -*) option=${{COMP_WORDS[i]}} ;; esac\n",
               program.path) +
           (patterns.empty() ? ""
                             : "        case \"$command ${COMP_WORDS[i]}\" in\n    " +
                                   case_line(patterns, "command+=\" ${COMP_WORDS[i]}\"") + "        esac\n") +
           "    done\n";
}

/// An option whose last value may be followed by another one counts as the word before the cursor.
std::string finding_of_option(const CommandHelp& program) {
    const auto many = option_patterns(program, [](const ArgumentHelp& o) { return o.many; });
    std::string taken_apart =
        "    # Bash takes --option=value apart.\n"
        "    if [ \"$current\" = = ]; then current=; elif [ \"$previous\" = = ]; then previous=$option; fi\n";
    if (many.empty()) return taken_apart;
    return taken_apart + "    case $current in -*) ;; *) case \"$command $option\" in\n" +
           case_line(many, "previous=$option") + "    esac ;; esac\n";
}

std::string words_of_option(const CommandHelp& command, const ArgumentHelp& option) {
    return case_line({bash_quoted(command.path + " " + option.names.back())},
                     fmt::format("kind={} words='{}'{}", option.completion == Completion::files ? "files" : "words",
                                 fmt::join(option.words, " "), option.comma ? " comma=," : ""));
}

/// Writes the cases that complete the value of an option.
std::string values_of_options(const CommandHelp& program) {
    const auto of_kind = [&](Completion kind) {
        return option_patterns(program, [=](const ArgumentHelp& o) {
            return !o.value.empty() && o.words.empty() && o.completion == kind;
        });
    };
    std::string text = "    case \"$command $previous\" in\n" + case_line(of_kind(Completion::nothing), "return") +
                       case_line(of_kind(Completion::files), "kind=files") +
                       case_line(of_kind(Completion::folders), "kind=folders");
    for (const CommandHelp* command : all_commands(program))
        for (const ArgumentHelp& option : command->options)
            if (!option.words.empty()) text += words_of_option(*command, option);
    return text + "    esac\n";
}

/// Writes the case of a command: completes its options, subcommands and arguments.
std::string arguments_of_commands(const CommandHelp& program) {
    std::string text = "    [ -n \"$kind\" ] || case $command in\n";
    for (const CommandHelp* command : all_commands(program)) {
        std::vector<std::string> options, words;
        for (const ArgumentHelp& option : command->options)
            options.insert(options.end(), option.names.begin(), option.names.end());
        for (const CommandHelp& below : command->subcommands) words.push_back(below.name());
        bool files = false;
        for (const ArgumentHelp& argument : command->positionals) {
            words.insert(words.end(), argument.words.begin(), argument.words.end());
            files = files || argument.completion == Completion::files;
        }
        text += fmt::format(
            "        {})\n            case $current in\n                -*) kind=words words='{}' ;;\n"
            "                *) kind={} words='{}' ;;\n            esac ;;\n",
            bash_quoted(command->path), fmt::join(options, " "), files ? "files" : "words", fmt::join(words, " "));
    }
    return text + "    esac\n";
}

constexpr std::string_view k_replies =
    R"(    local before=
    [ -z "$comma" ] || before=${current%"${current##*,}"}
    mapfile -t COMPREPLY < <(compgen -P "$before" -W "$words" -- "${current#"$before"}")
    case $kind in
        files) mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$current") ;;
        folders) mapfile -t COMPREPLY < <(compgen -d -- "$current") ;;
        *) return ;;
    esac
    compopt -o filenames 2>/dev/null || true
)";

}  // namespace

std::string bash_completion(const CommandHelp& program) {
    const std::string function = "_" + joined_path(program.path, '_');
    return fmt::format("# Completion of {} for bash.\n{}() {{\n", program.path, function) +
           finding_of_command(program) + finding_of_option(program) + values_of_options(program) +
           arguments_of_commands(program) + std::string(k_replies) +
           fmt::format("}}\ncomplete -F {} {}\n", function, program.path);
}

}  // namespace exemplar
