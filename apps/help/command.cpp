#include "apps/help/command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <limits>
#include <optional>

#include "host/core/text.h"

namespace exemplar {
namespace {

std::vector<const CLI::App*> subcommands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

/// All option and subcommand names that `app` knows at its level.
std::vector<std::string> known_words(const CLI::App& app) {
    std::vector<std::string> words;
    for (const CLI::App* command : subcommands_of(app)) words.push_back(command->get_name());
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
    return words;
}

/// The subcommand the user got to before the parser gave up.
const CLI::App& deepest(const CLI::App& app) {
    const auto parsed = app.get_subcommands();
    return parsed.empty() ? app : deepest(*parsed.back());
}

/// "exemplar label train": the words that lead to a subcommand.
std::string command_path(const CLI::App& app) {
    return app.get_parent() ? command_path(*app.get_parent()) + " " + app.get_name() : app.get_name();
}

/// Returns a message on the first unknown argument, with the nearest known word; empty if all are known.
std::string unknown_argument(const CLI::App& app) {
    std::vector<std::string> unknown = app.remaining(true);
    if (unknown.empty()) return {};
    const auto option = std::ranges::find_if(unknown, [](const auto& w) { return w.starts_with('-'); });
    std::string word = option == unknown.end() ? unknown.front() : *option;
    word.erase(std::min(word.find('='), word.size()));
    const CLI::App& command = deepest(app);
    const std::vector<std::string> words = known_words(command);
    if (word.starts_with('-')) return fmt::format("unknown option '{}'{}", word, suggestion(word, words));
    if (subcommands_of(command).empty()) return fmt::format("unexpected argument '{}'", word);
    return fmt::format("unknown subcommand '{}'{}", word, suggestion(word, words));
}

}  // namespace

ValueCheck::ValueCheck(const CLI::Validator& validator)
    : validator_(std::make_shared<const CLI::Validator>(validator)) {}

ValueCheck::ValueCheck(std::function<std::string(const std::string&)> check, std::string description, std::string name)
    : ValueCheck(CLI::Validator([check = std::move(check)](std::string& text) { return check(text); },
                                std::move(description), std::move(name))) {}

ValueCheck in_range(double min, double max) {
    return ValueCheck(CLI::Range(min, max));
}

ValueCheck in_range(int min, int max) {
    return ValueCheck(CLI::Range(min, max));
}

ValueCheck whole_number(std::uint64_t min, std::uint64_t max) {
    const bool open = max == std::numeric_limits<std::uint64_t>::max();
    const std::string range = open ? fmt::format("from {}", min) : fmt::format("from {} to {}", min, max);
    const auto check = [=](const std::string& text) {
        std::uint64_t value = 0;
        const char* end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        if (error == std::errc() && stop == end && value >= min && value <= max) return std::string();
        return fmt::format("'{}' is no whole number {}", text, range);
    };
    return {check, min == 0 && open ? "" : range};
}

ValueCheck one_of(std::vector<std::string> words) {
    return ValueCheck(CLI::IsMember(std::move(words)));
}

Option* Option::type_name(std::string name) {
    option_->type_name(std::move(name));
    return this;
}

Option* Option::required() {
    option_->required();
    return this;
}

Option* Option::check(const ValueCheck& check) {
    option_->check(check.validator());
    return this;
}

Option* Option::capture_default_str() {
    option_->capture_default_str();
    return this;
}

Option* Option::default_str(const std::string& text) {
    option_->default_str(text);
    return this;
}

Option* Option::excludes(const Option* other) {
    option_->excludes(other->option_);
    return this;
}

Option* Option::needs(const Option* other) {
    option_->needs(other->option_);
    return this;
}

Option* Option::delimiter(char character) {
    option_->delimiter(character);
    return this;
}

Option* Option::allow_extra_args(bool allowed) {
    option_->allow_extra_args(allowed);
    return this;
}

Option* Option::hide() {
    option_->group("");
    return this;
}

Command::Command(const std::string& name, const std::string& description)
    : owned_(std::make_unique<CLI::App>(description, name)), app_(owned_.get()) {}

Command::Command(CLI::App& app) : app_(&app) {}

Command::~Command() = default;

Command* Command::add_subcommand(const std::string& name, const std::string& description) {
    subcommands_.push_back(std::unique_ptr<Command>(new Command(*app_->add_subcommand(name, description))));
    return subcommands_.back().get();
}

template <typename T>
Option* Command::add_option(const std::string& name, T& variable, const std::string& description) {
    return keep(app_->add_option(name, variable, description));
}

template Option* Command::add_option(const std::string&, std::string&, const std::string&);
template Option* Command::add_option(const std::string&, std::filesystem::path&, const std::string&);
template Option* Command::add_option(const std::string&, float&, const std::string&);
template Option* Command::add_option(const std::string&, double&, const std::string&);
template Option* Command::add_option(const std::string&, std::size_t&, const std::string&);
template Option* Command::add_option(const std::string&, std::int64_t&, const std::string&);
template Option* Command::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option* Command::add_option(const std::string&, std::optional<std::size_t>&, const std::string&);
template Option* Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option* Command::add_option(const std::string&, std::vector<std::filesystem::path>&, const std::string&);
template Option* Command::add_option(const std::string&, std::vector<std::size_t>&, const std::string&);

Option* Command::add_word_option(const std::string& name, std::function<void(const std::string&)> use,
                                 const std::string& description) {
    return keep(app_->add_option_function<std::string>(name, use, description));
}

Option* Command::add_list_option(const std::string& name, std::function<void(const std::vector<std::string>&)> use,
                                 const std::string& description) {
    return keep(app_->add_option_function<std::vector<std::string>>(name, use, description));
}

Option* Command::add_flag(const std::string& name, bool& variable, const std::string& description) {
    return keep(app_->add_flag(name, variable, description));
}

Option* Command::add_flag_callback(const std::string& name, std::function<void()> use, const std::string& description) {
    return keep(app_->add_flag_callback(name, std::move(use), description));
}

void Command::footer(const std::string& text) {
    app_->footer(text);
}

void Command::require_subcommand() {
    app_->require_subcommand(1);
}

void Command::callback(std::function<void()> run) {
    app_->callback(std::move(run));
}

std::size_t Command::count(const std::string& option) const {
    return app_->count(option);
}

bool Command::has_given_subcommand() const {
    return !app_->get_subcommands().empty();
}

void Command::version(const std::string& version) {
    app_->set_version_flag("--version", version);
}

std::optional<int> Command::parse(int argc, char** argv) {
    try {
        app_->parse(argc, argv);
        return {};
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app_->exit(error);
        std::string what = unknown_argument(*app_);
        if (what.empty()) what = error.what();
        fmt::print(stderr, "error: {}; see '{} --help'\n", what, command_path(deepest(*app_)));
        return 2;
    }
}

}  // namespace exemplar
