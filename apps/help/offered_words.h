#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace exemplar {

/// Names the words of an option for the completion of shells. Rejects no others: the reader of the option does that,
/// and suggests the nearest word.
CLI::Validator completion_words(const std::vector<std::string>& words);
CLI::Validator completion_words(std::span<const std::string_view> words);

/// Returns the words given to completion_words or to CLI::IsMember, in order; empty if an option has neither.
std::vector<std::string> words_of(CLI::Option& option);

}  // namespace exemplar
