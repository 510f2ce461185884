#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace exemplar {

/// Returns a text as a field of a CSV file (RFC 4180), quoted if needed. An apostrophe precedes what a spreadsheet
/// would take for a formula, as file names may come from anywhere.
std::string csv_field(std::string_view text);
/// Writes a list while its values are made, one value a line: `fill` is called once, with a function that writes a
/// value.
void write_json_list(std::ostream& out,
                     const std::function<void(const std::function<void(const nlohmann::json&)>&)>& fill);
/// Returns a text as an SQL literal.
std::string sql_text(std::string_view text);

}  // namespace exemplar
