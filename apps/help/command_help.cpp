#include "apps/help/command_help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <regex>

#include "apps/help/command.h"

namespace exemplar {
namespace {

constexpr std::string_view k_offered = "offered words: ";

std::vector<std::string> split_at_commas(std::string_view text) {
    std::vector<std::string> words;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(','), text.size());
        words.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return words;
}

/// The checks of an option. CLI11 tells how many there are by refusing the next.
std::vector<const CLI::Validator*> validators_of(CLI::Option& option) {
    std::vector<const CLI::Validator*> validators;
    try {
        for (int i = 0;; ++i) validators.push_back(option.get_validator(i));
    } catch (const CLI::OptionNotFound&) {
        return validators;
    }
}

bool is_set_of_words(const std::string& description) {
    return description.starts_with('{') && description.ends_with('}');
}

/// Returns the name of a value without the descriptions of checks that CLI11 appends.
std::string value_name(CLI::Option& option) {
    std::string checks;
    for (const CLI::Validator* validator : validators_of(option)) {
        const std::string text = validator->get_description();
        if (!text.empty()) checks += ":" + text;
    }
    std::string name = option.get_type_name();
    name.resize(name.size() - checks.size());
    if (name == "UINT" || name == "INT" || name == "FLOAT") return "NUMBER";
    if (name == "TEXT" || name.empty()) return "WORD";
    return name;
}

std::string range_of(CLI::Option& option) {
    static const std::regex interval(R"(^\w+ in \[(\S+) - (\S+)\]$)");
    for (const CLI::Validator* validator : validators_of(option)) {
        const std::string text = validator->get_description();
        if (!text.empty() && !is_set_of_words(text)) return std::regex_replace(text, interval, "from $1 to $2");
    }
    return {};
}

Completion completion_of(const ArgumentHelp& argument, bool positional) {
    if (!argument.words.empty() && argument.value.find("FILE") == std::string::npos) return Completion::words;
    if (argument.value == "FOLDER" || argument.value == "DIR") return Completion::folders;
    constexpr std::array k_files{"FILE", "LIST", "SET", "SOURCE", "ANIM", "FILE|FOLDER", "NAME|FILE"};
    const bool is_file = std::ranges::find(k_files, argument.value) != k_files.end();
    return is_file || (positional && argument.value == "WORD") ? Completion::files : Completion::nothing;
}

/// Returns the words given to completion_words() or one_of(), in order; empty if an option has neither.
std::vector<std::string> words_of(CLI::Option& option) {
    for (const CLI::Validator* validator : validators_of(option)) {
        const std::string name = validator->get_name(), text = validator->get_description();
        if (name.starts_with(k_offered)) return split_at_commas(std::string_view(name).substr(k_offered.size()));
        if (is_set_of_words(text)) return split_at_commas(std::string_view(text).substr(1, text.size() - 2));
    }
    return {};
}

ArgumentHelp describe_argument(CLI::Option& option) {
    ArgumentHelp help;
    const bool positional = option.get_positional();
    if (positional) help.names.push_back(option.get_name(true));
    for (const std::string& name : option.get_snames()) help.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) help.names.push_back("--" + name);
    help.description = option.get_description();
    help.required = option.get_required();
    help.default_value = option.get_default_str();
    if (option.get_items_expected_max() == 0) return help;
    help.value = value_name(option);
    help.range = range_of(option);
    help.words = words_of(option);
    help.completion = completion_of(help, positional);
    help.comma = option.get_delimiter() == ',';
    help.many = option.get_items_expected_max() > 1 && (positional || option.get_allow_extra_args());
    return help;
}

CommandHelp describe(CLI::App& app, const std::string& path) {
    CommandHelp help{path, app.get_description(), app.get_footer(), {}, {}, {}};
    for (CLI::Option* option : app.get_options([](const CLI::Option* o) { return !o->get_group().empty(); }))
        (option->get_positional() ? help.positionals : help.options).push_back(describe_argument(*option));
    for (CLI::App* command : app.get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); }))
        help.subcommands.push_back(describe(*command, path + " " + command->get_name()));
    return help;
}

}  // namespace

ValueCheck completion_words(const std::vector<std::string>& words) {
    const auto accept = [](const std::string&) { return std::string(); };
    return {accept, "", std::string(k_offered) + fmt::format("{}", fmt::join(words, ","))};
}

ValueCheck completion_words(std::span<const std::string_view> words) {
    return completion_words(std::vector<std::string>(words.begin(), words.end()));
}

CommandHelp describe_command(CLI::App& app) {
    return describe(app, app.get_name());
}

std::vector<const CommandHelp*> all_commands(const CommandHelp& command) {
    std::vector<const CommandHelp*> all{&command};
    for (const CommandHelp& below : command.subcommands) {
        const std::vector<const CommandHelp*> more = all_commands(below);
        all.insert(all.end(), more.begin(), more.end());
    }
    return all;
}

std::string joined_path(std::string_view path, char separator) {
    std::string joined(path);
    for (char& c : joined)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = separator;
    return joined;
}

}  // namespace exemplar
