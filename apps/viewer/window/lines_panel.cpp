// The part of the side panel for lines: which of them are drawn, and how.

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "apps/viewer/window/panels.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

// "suggestive_contours" is "Suggestive contours".
std::string words_of(LineType type) {
    std::string words(name_of(type));
    std::ranges::replace(words, '_', ' ');
    words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
    return words;
}

void choose_style(ViewerState& state) {
    if (!ImGui::BeginCombo("Style", state.settings.style.name.c_str())) return;
    for (const std::string_view name : builtin_style_names())
        if (ImGui::Selectable(std::string(name).c_str(), name == state.settings.style.name))
            state.settings.set_style(load_style(std::string(name)));
    ImGui::EndCombo();
}

// Returns a style's threshold for a type, in the unit of set_threshold.
float threshold_of(const DrawingStyle& style, LineType type) {
    const LineThresholds thresholds = style.thresholds(type);
    switch (type) {
        case LineType::suggestive_contours:
            return thresholds.suggestive_contours;
        case LineType::suggestive_highlights:
            return thresholds.suggestive_highlights;
        case LineType::ridges:
        case LineType::valleys:
            return thresholds.ridges_valleys;
        case LineType::apparent_ridges:
            return thresholds.apparent_ridges;
        case LineType::principal_highlights:
            return thresholds.principal_highlights;
        case LineType::creases:
            return thresholds.crease_angle * 180 / std::numbers::pi_v<float>;
        case LineType::contours:
        case LineType::boundaries:
            break;
    }
    return 0;
}

bool edit_threshold(DrawingStyle& style, LineType type) {
    float threshold = threshold_of(style, type);
    const bool angle = type == LineType::creases;
    const bool changed = angle
                             ? ImGui::SliderFloat("Angle", &threshold, 0, 180, "%.0f\xC2\xB0")
                             : ImGui::SliderFloat("Threshold", &threshold, 0, 1, "%.3f", ImGuiSliderFlags_Logarithmic);
    if (changed) style.of(type).threshold = std::clamp(threshold, 0.0f, angle ? 180.0f : 1e6f);
    return changed;
}

// Draws an entry of the list: whether the type is shown, its color and, if it is shown, threshold and width below.
void draw_type(ViewSettings& settings, std::size_t index) {
    const LineType type = k_line_types[index];
    LineStyle& line = settings.style.of(type);
    bool changed = edit_color("##color", line.color);
    ImGui::SameLine();
    ImGui::Checkbox(words_of(type).c_str(), &settings.lines[index]);
    if (settings.lines[index]) {
        ImGui::Indent();
        if (has_threshold(type)) changed |= edit_threshold(settings.style, type);
        if (ImGui::SliderFloat("Width", &line.thickness.width, 0.2f, 16, "%.1f px", ImGuiSliderFlags_Logarithmic)) {
            line.thickness.most = std::max(line.thickness.most, line.thickness.width);
            line.thickness.least = std::min(line.thickness.least, line.thickness.width);
            changed = true;
        }
        ImGui::Unindent();
    }
    if (changed) ++settings.style_version;
}

}  // namespace

void draw_lines(ViewerState& state) {
    choose_style(state);
    for (std::size_t i = 0; i < k_line_types.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        draw_type(state.settings, i);
        ImGui::PopID();
    }
}

}  // namespace exemplar
