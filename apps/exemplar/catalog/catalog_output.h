#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace exemplar {

/// A text as a field of a CSV file (RFC 4180): in quotes where it needs them. What a spreadsheet would take for a
/// formula is preceded by an apostrophe: names of files come from anywhere.
std::string csv_field(std::string_view text);
/// JSON on one line; bytes that are no UTF-8 become U+FFFD.
std::string json_text(const nlohmann::json& json);
/// Writes a list, a value a line, as the values come: `fill` is called once, with a function that writes one.
void write_json_list(std::ostream& out,
                     const std::function<void(const std::function<void(const nlohmann::json&)>&)>& fill);
/// A text as an SQL literal.
std::string sql_text(std::string_view text);

}  // namespace exemplar
