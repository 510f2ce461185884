#include "apps/exemplar/catalog/catalog_output.h"

#include <algorithm>
#include <ostream>

#include "host/core/json_text.h"

namespace exemplar {
namespace {

/// `text` between two `mark`s, each mark in it doubled.
std::string in_marks(std::string_view text, char mark) {
    std::string out(1, mark);
    for (const char c : text) {
        if (c == mark) out += mark;
        out += c;
    }
    return out + mark;
}

}  // namespace

std::string csv_field(std::string_view text) {
    constexpr std::string_view k_begin_formulas = "=+-@\t\r";
    const bool formula = !text.empty() && k_begin_formulas.find(text.front()) != std::string_view::npos;
    std::string field(text);
    if (formula) field.insert(field.begin(), '\'');
    return field.find_first_of(",\"\r\n") == std::string::npos ? field : in_marks(field, '"');
}

void write_json_list(std::ostream& out,
                     const std::function<void(const std::function<void(const nlohmann::json&)>&)>& fill) {
    bool any = false;
    fill([&](const nlohmann::json& json) {
        out << (any ? ",\n" : "[\n") << json_text(json);
        any = true;
    });
    out << (any ? "\n]" : "[]");
}

std::string sql_text(std::string_view text) {
    return in_marks(text, '\'');
}

}  // namespace exemplar
