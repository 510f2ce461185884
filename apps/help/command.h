#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): of another library
class App;
class Option;
class Validator;
}  // namespace CLI

namespace exemplar {

// A program's options and subcommands, which CLI11 reads. Only apps/help includes CLI11, which takes seconds to compile
// in every source that does.

/// A test of the text given to an option, with words that --help and the completion of shells show.
class ValueCheck {
  public:
    /// `check` returns what is wrong with a text, or "". `description` is shown in --help; `name` is not.
    ValueCheck(std::function<std::string(const std::string&)> check, std::string description, std::string name = {});
    explicit ValueCheck(const CLI::Validator& validator);

    const CLI::Validator& validator() const { return *validator_; }

  private:
    std::shared_ptr<const CLI::Validator> validator_;
};

/// Accepts numbers from `min` to `max`.
ValueCheck in_range(double min, double max);
ValueCheck in_range(int min, int max);

/// Accepts whole numbers from `min` to `max`, written without sign.
ValueCheck whole_number(std::uint64_t min, std::uint64_t max = UINT64_MAX);

/// Accepts the words of a set.
ValueCheck one_of(std::vector<std::string> words);

/// Names words for the completion of shells. Rejects no others: the reader of the option does that, and suggests the
/// nearest word.
ValueCheck completion_words(const std::vector<std::string>& words);
ValueCheck completion_words(std::span<const std::string_view> words);

/// An option or a positional argument. Each function returns the option itself.
class Option {
  public:
    explicit Option(CLI::Option& option) : option_(&option) {}

    /// Sets the name of the value in --help; "" shows none.
    Option* type_name(std::string name);
    Option* required();
    Option* check(const ValueCheck& check);
    /// Shows the variable's present value as the default in --help.
    Option* capture_default_str();
    /// Shows `text` as the default in --help.
    Option* default_str(const std::string& text);
    /// Refuses the option beside `other`, or without it.
    Option* excludes(const Option* other);
    Option* needs(const Option* other);
    /// Splits a value at each `character`.
    Option* delimiter(char character);
    /// Whether a list takes all values that follow the option, or one.
    Option* allow_extra_args(bool allowed);
    /// Leaves the option out of --help.
    Option* hide();

  private:
    CLI::Option* option_;
};

/// A program or one of its subcommands. Options write to variables that must outlive parsing.
class Command {
  public:
    Command(const std::string& name, const std::string& description);
    ~Command();
    Command(const Command&) = delete;
    Command& operator=(const Command&) = delete;

    Command* add_subcommand(const std::string& name, const std::string& description);
    /// Adds an option ("--name") or a positional argument ("NAME") of a variable: a bool, number, string, path, an
    /// optional or a vector of one. The types are listed in command.cpp.
    template <typename T>
    Option* add_option(const std::string& name, T& variable, const std::string& description);
    /// Adds an option with a value, or a list of values, that `use` is called with.
    Option* add_word_option(const std::string& name, std::function<void(const std::string&)> use,
                            const std::string& description);
    Option* add_list_option(const std::string& name, std::function<void(const std::vector<std::string>&)> use,
                            const std::string& description);
    /// Adds an option without a value that sets `variable`.
    Option* add_flag(const std::string& name, bool& variable, const std::string& description);
    Option* add_flag_callback(const std::string& name, std::function<void()> use, const std::string& description);

    /// Sets the text below the options in --help.
    void footer(const std::string& text);
    /// Demands one subcommand.
    void require_subcommand();
    /// Sets what is done after this command's options are read.
    void callback(std::function<void()> run);
    /// Returns how often an option was given.
    std::size_t count(const std::string& option) const;
    bool has_given_subcommand() const;
    /// Adds --version.
    void version(const std::string& version);

    /// Reads a program's arguments and calls the callbacks, whose exceptions pass. Returns the exit code if the program
    /// has nothing more to do: 0 after --help or --version; 2 for wrong usage, after a line on stderr that says what
    /// is wrong and suggests the nearest name.
    std::optional<int> parse(int argc, char** argv);

    CLI::App& app() { return *app_; }

  private:
    explicit Command(CLI::App& app);
    Option* keep(CLI::Option* option) { return &options_.emplace_back(*option); }

    std::unique_ptr<CLI::App> owned_;  // of a program
    CLI::App* app_;
    std::deque<Option> options_;
    std::deque<std::unique_ptr<Command>> subcommands_;
};

/// The words of an option and the values that they stand for.
template <typename T>
using Choices = std::vector<std::pair<std::string, T>>;

/// Returns the word of a value, which must be one of the choices.
template <typename T>
const std::string& word_of(const T& value, const Choices<T>& choices) {
    return std::ranges::find(choices, value, &std::pair<std::string, T>::second)->first;
}

/// Adds an option that sets `variable` (a T or std::optional<T>) to the value of a word. The choices must outlive
/// parsing.
template <typename T, typename Variable>
Option* add_choice(Command& command, const std::string& name, Variable& variable, const Choices<T>& choices,
                   const std::string& description) {
    std::vector<std::string> words;
    for (const auto& [word, value] : choices) words.push_back(word);
    const auto set = [&variable, &choices](const std::string& given) {
        variable = std::ranges::find(choices, given, &std::pair<std::string, T>::first)->second;
    };
    return command.add_word_option(name, set, description)->check(one_of(words));
}

}  // namespace exemplar
