#include "host/core/text.h"
#include "host/lines/extraction/lines.h"

#include <algorithm>
#include <string>

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
        case LineType::creases:
            return "creases";
        case LineType::boundaries:
            return "boundaries";
    }
    return {};
}

std::optional<LineType> line_type_named(std::string_view name) {
    for (const LineType type : k_line_types)
        if (name_of(type) == name) return type;
    return std::nullopt;
}

std::optional<LineType> line_type_from_prefix(std::string_view word) {
    constexpr std::size_t k_min_letters = 3;
    std::string name = lower_case(word);
    std::ranges::replace(name, '-', '_');
    if (name == "highlights") return LineType::suggestive_highlights;
    if (name.size() >= k_min_letters)
        for (const LineType type : k_line_types)
            if (name_of(type).starts_with(name)) return type;
    return std::nullopt;
}

bool depends_on_view(LineType type) {
    return type != LineType::ridges && type != LineType::valleys && type != LineType::creases &&
           type != LineType::boundaries;
}

bool needs_curvature(LineType type) {
    return type != LineType::contours && type != LineType::creases && type != LineType::boundaries;
}

bool runs_along_edge(LineType type, const LineSegment& segment) {
    return type == LineType::creases || type == LineType::boundaries ||
           (type == LineType::contours && segment.family == k_family_along_edges);
}

std::optional<LineFading> line_fading(LineType type, const LineThresholds& thresholds) {
    switch (type) {
        case LineType::suggestive_contours:
            return LineFading{thresholds.suggestive_contours, thresholds.fade};
        case LineType::suggestive_highlights:
            return LineFading{thresholds.suggestive_highlights, thresholds.fade};
        case LineType::principal_highlights:
            return LineFading{thresholds.principal_highlights, thresholds.fade};
        case LineType::apparent_ridges:
            return LineFading{thresholds.apparent_ridges, thresholds.fade};
        case LineType::ridges:
        case LineType::valleys:
            return LineFading{thresholds.ridges_valleys, thresholds.ridges_valleys};
        case LineType::contours:
        case LineType::creases:
        case LineType::boundaries:
            break;
    }
    return std::nullopt;
}

float line_opacity(LineType type, float strength, const LineThresholds& thresholds) {
    const std::optional<LineFading> f = line_fading(type, thresholds);
    if (!f) return 1;
    const float above = strength - f->threshold;
    return above > 0 ? above / (above + f->half) : 0;
}

}  // namespace exemplar
