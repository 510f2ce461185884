#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace exemplar {

/// The candidate nearest to `word` (at most 255 characters) by edit distance, if near enough to be meant; else empty.
std::string nearest_word(std::string_view word, std::span<const std::string> candidates);
/// " (did you mean 'X'?)" or an empty string.
std::string suggestion(std::string_view word, std::span<const std::string> candidates);
/// Orders "2.off" before "10.off": digit runs compare as numbers; equal ones by their leading zeros.
bool natural_less(std::string_view a, std::string_view b);
/// Whether all of `text` is well-formed UTF-8, as JSON, model and glTF files demand of names.
bool is_utf8(std::string_view text);
/// Text with ? in the place of control characters, which could do anything to a terminal: one line.
std::string without_controls(std::string_view text);
/// "1 face", "2 faces"; `more` is the plural where an s does not make it.
std::string counted(std::size_t count, std::string_view one, std::string_view more = {});
/// Seconds as "0.42 s", "12 s", "3 min 20 s", "1 h 05 min".
std::string format_seconds(double seconds);

}  // namespace exemplar
