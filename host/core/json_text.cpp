#include "host/core/json_text.h"

namespace exemplar {

nlohmann::json parse_json(std::string_view text) {
    return nlohmann::json::parse(text);
}

nlohmann::json parse_json(std::string_view text, const nlohmann::json::parser_callback_t& callback, bool throws,
                          bool ignore_comments) {
    return nlohmann::json::parse(text, callback, throws, ignore_comments);
}

std::string json_text(const nlohmann::json& json, int indent) {
    return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string ordered_json_text(const nlohmann::ordered_json& json, int indent, bool ascii) {
    return json.dump(indent, ' ', ascii, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace exemplar
