#include "host/lines/lines.h"

namespace exemplar {

std::string_view name_of(LineType type) {
    switch (type) {
        case LineType::contours:
            return "contours";
        case LineType::suggestive_contours:
            return "suggestive_contours";
        case LineType::suggestive_highlights:
            return "suggestive_highlights";
        case LineType::ridges:
            return "ridges";
        case LineType::valleys:
            return "valleys";
        case LineType::apparent_ridges:
            return "apparent_ridges";
        case LineType::principal_highlights:
            return "principal_highlights";
    }
    return {};
}

std::optional<LineType> line_type_named(std::string_view name) {
    for (const LineType type : k_line_types)
        if (name_of(type) == name) return type;
    return std::nullopt;
}

bool depends_on_view(LineType type) {
    return type != LineType::ridges && type != LineType::valleys;
}

}  // namespace exemplar
