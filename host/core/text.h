#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace exemplar {

/// Returns the candidate nearest to `word` (at most 255 characters) by edit distance; empty if none is similar
/// enough.
std::string nearest_word(std::string_view word, std::span<const std::string> candidates);
/// Returns " (did you mean 'X'?)" with the nearest candidate, or an empty string.
std::string suggestion(std::string_view word, std::span<const std::string> candidates);
/// Returns `text` with the letters A to Z in lower case, whatever the locale.
std::string lower_case(std::string_view text);
/// Compares runs of digits as numbers, so that "2.off" comes before "10.off". Strings that differ only in leading
/// zeros compare as text.
bool natural_less(std::string_view a, std::string_view b);
/// Returns whether all of `text` is well-formed UTF-8, as JSON, model and glTF files require of names.
bool is_utf8(std::string_view text);
/// Returns `text` with each control character, which could do anything to a terminal, replaced by '?'; the result is
/// one line.
std::string without_controls(std::string_view text);
/// Returns "1 face", "2 faces" and so on; `more` is the plural if it is not `one` with an s.
std::string counted(std::size_t count, std::string_view one, std::string_view more = {});
/// Returns bytes as base64 (RFC 4648), padded, without line breaks.
std::string base64(std::string_view bytes);
/// Formats seconds as "0.42 s", "12 s", "3 min 20 s" or "1 h 05 min".
std::string format_seconds(double seconds);

}  // namespace exemplar
