#pragma once

#include <CLI/CLI.hpp>
#include <ranges>
#include <string>
#include <vector>

namespace exemplar {

/// Words that an option takes, for the completion of shells. Nothing is refused here: what reads the option does that,
/// and suggests the nearest.
CLI::Validator offered_words(const std::vector<std::string>& words);
/// The same of views and other texts.
CLI::Validator offered_words(const std::ranges::input_range auto& words) {
    return offered_words(std::vector<std::string>(words.begin(), words.end()));
}

/// The words given to offered_words or to CLI::IsMember, in their order; empty if an option has neither.
std::vector<std::string> words_of(CLI::Option& option);

}  // namespace exemplar
