#pragma once

#include <string>
#include <string_view>

namespace exemplar {

/// A text as a field of a CSV file (RFC 4180): in quotes where it needs them. What a spreadsheet would take for a
/// formula is preceded by an apostrophe: names of files come from anywhere.
std::string csv_field(std::string_view text);
/// A text as an SQL literal.
std::string sql_text(std::string_view text);

}  // namespace exemplar
