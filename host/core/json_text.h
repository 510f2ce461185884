#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace exemplar {

// The parser and the writer of JSON, compiled once: in each source that calls nlohmann::json::parse or dump, a compiler
// spends seconds on them.

/// Parses JSON text. Throws nlohmann::json::parse_error.
nlohmann::json parse_json(std::string_view text);
/// Parses JSON text with the arguments of nlohmann::json::parse: `callback` may discard values; without `throws`, text
/// that is no JSON gives a discarded value.
nlohmann::json parse_json(std::string_view text, const nlohmann::json::parser_callback_t& callback, bool throws = true,
                          bool ignore_comments = false);

/// Writes JSON in one line, or indented by `indent` blanks. Bytes that are no UTF-8, as names of files may hold, become
/// U+FFFD. With `ascii`, other characters are escaped as well.
std::string json_text(const nlohmann::json& json, int indent = -1);
std::string ordered_json_text(const nlohmann::ordered_json& json, int indent = -1, bool ascii = false);

}  // namespace exemplar
