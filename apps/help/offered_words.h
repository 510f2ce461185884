#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace exemplar {

/// Words that an option takes, for the completion of shells. Nothing is refused here: what reads the option does that,
/// and suggests the nearest.
CLI::Validator offered_words(const std::vector<std::string>& words);
CLI::Validator offered_words(std::span<const std::string_view> words);

/// The words given to offered_words or to CLI::IsMember, in their order; empty if an option has neither.
std::vector<std::string> words_of(CLI::Option& option);

}  // namespace exemplar
