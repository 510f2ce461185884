// The part of the side panel for painting labels, and the list of shapes.

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>

#include "apps/viewer/window/panels.h"
#include "apps/viewer/window/thumbnails.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

void draw_palette_entry(ViewerState& state, std::size_t label) {
    LabelingSession& session = *state.labeling;
    static std::size_t renamed = static_cast<std::size_t>(-1);
    static std::string name;
    ImGui::PushID(static_cast<int>(label));
    Color color = session.palette()[label].color;
    if (edit_color("##color", color)) state.try_labeling([&] { session.recolor_label(label, color); });
    ImGui::SameLine();
    if (renamed == label) {
        ImGui::SetKeyboardFocusHere();
        if (ImGui::InputText("##name", &name, ImGuiInputTextFlags_EnterReturnsTrue)) {
            state.try_labeling([&] { session.rename_label(label, name); });
            renamed = static_cast<std::size_t>(-1);
        }
        if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) renamed = static_cast<std::size_t>(-1);
    } else {
        const std::string key = label < 9 ? fmt::format("{}  ", label + 1) : std::string("    ");
        const bool chosen = session.settings.label == static_cast<std::int32_t>(label);
        if (ImGui::Selectable((key + session.palette()[label].name).c_str(), chosen,
                              ImGuiSelectableFlags_AllowDoubleClick)) {
            session.settings.label = static_cast<std::int32_t>(label);
            if (session.settings.tool == PaintTool::eraser) session.settings.tool = PaintTool::brush;
            if (ImGui::IsMouseDoubleClicked(0)) renamed = label, name = session.palette()[label].name;
        }
    }
    ImGui::PopID();
}

void draw_palette(ViewerState& state) {
    for (std::size_t label = 0; label < state.labeling->palette().size(); ++label) draw_palette_entry(state, label);
    static std::string added;
    ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 4);
    const bool entered =
        ImGui::InputTextWithHint("##new label", "New label", &added, ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if (ImGui::Button("Add", ImVec2(-1, 0)) || entered) {
        state.try_labeling([&] { state.labeling->add_label(added); });
        added.clear();
    }
    if (state.labeling->palette().size() > 1) ImGui::TextDisabled("Double click renames a label");
}

void draw_tools(ViewerState& state, InterfaceRequests& requests) {
    PaintSettings& paint = state.labeling->settings;
    constexpr std::array k_tools = {std::pair{PaintTool::brush, "Brush"}, std::pair{PaintTool::eraser, "Eraser"},
                                    std::pair{PaintTool::lasso, "Lasso"}, std::pair{PaintTool::fill, "Fill"}};
    for (const auto& [tool, name] : k_tools) {
        if (tool != PaintTool::brush) ImGui::SameLine();
        if (ImGui::RadioButton(name, paint.tool == tool)) paint.tool = tool;
    }
    ImGui::SliderFloat("Brush", &paint.radius, 1, 200, "%.0f pixels", ImGuiSliderFlags_Logarithmic);
    bool changed = ImGui::Checkbox("Complete", &paint.completes);
    ImGui::SameLine();
    changed |= ImGui::Checkbox("Confidence", &paint.confidence);
    ImGui::SameLine();
    ImGui::Checkbox("Hidden", &paint.through);
    if (changed) ++state.labeling->settings_version;
    const float width = (ImGui::GetContentRegionAvail().x - 4 * ImGui::GetStyle().ItemSpacing.x) / 5;
    constexpr std::array k_edits = {std::pair{Action::undo, "Undo"}, std::pair{Action::redo, "Redo"},
                                    std::pair{Action::paint_mirror_image, "Mirror"},
                                    std::pair{Action::uncertain_place, "Unsure"},
                                    std::pair{Action::discard_suggestion, "Anew"}};
    for (const auto& [action, name] : k_edits) {
        if (action != Action::undo) ImGui::SameLine();
        if (ImGui::Button(name, ImVec2(width, 0))) requests.actions.push_back(action);
    }
}

void draw_painting_status(const LabelPainter& painter) {
    const std::size_t unlabeled = painter.unlabeled_count();
    std::string text = unlabeled > 0 ? fmt::format("{} of {} faces have no label", unlabeled, painter.face_count())
                                     : std::string("Every face has a label");
    if (!painter.has_features())
        text += "; measuring the shape ...";
    else if (painter.completion_seconds() > 0)
        text += fmt::format("; completed in {:.0f} ms", 1000 * painter.completion_seconds());
    ImGui::PushTextWrapPos(0);
    ImGui::TextDisabled("%s", text.c_str());
    ImGui::PopTextWrapPos();
}

void draw_shape_row(const LabelingSession& session, std::size_t shape, InterfaceRequests& requests) {
    constexpr std::array k_states = {"empty", "suggested", "verified", "broken"};
    const float height = ImGui::GetFontSize() * 3;
    ImGui::PushID(static_cast<int>(shape));
    if (ImGui::Selectable("##shape", shape == session.shape(), 0, ImVec2(0, height))) requests.shape = shape;
    ImGui::SameLine(4);
    draw_thumbnail(session, shape, height);
    ImGui::SameLine();
    const char* const shape_state = k_states[static_cast<std::size_t>(session.state_of(shape))];
    ImGui::TextUnformatted(
        fmt::format("{}\n{}", session.folder().shapes()[shape].path.filename().string(), shape_state).c_str());
    ImGui::PopID();
}

void draw_shape_list(ViewerState& state, InterfaceRequests& requests) {
    const LabelingSession& session = *state.labeling;
    const std::size_t count = session.folder().shapes().size(), verified = session.folder().verified_count();
    ImGui::ProgressBar(static_cast<float>(verified) / static_cast<float>(count), ImVec2(-1, 0),
                       fmt::format("{} of {} verified", verified, count).c_str());
    if (session.job()) {
        const FolderJob::Status status = session.job()->status();
        ImGui::TextDisabled("%s %.0f %%", status.what.c_str(), static_cast<double>(100 * status.share));
    }
    const std::size_t waiting = session.to_verify().size();
    if (waiting > 0 &&
        ImGui::Button(fmt::format("Check {} (Tab)", counted(waiting, "suggested shape")).c_str(), ImVec2(-1, 0)))
        requests.actions.push_back(Action::shape_grid);
    ImGui::BeginChild("shapes", ImVec2(0, ImGui::GetFontSize() * 18), true);
    ImGuiListClipper clipper;  // a folder may have thousands
    clipper.Begin(static_cast<int>(count));
    while (clipper.Step())
        for (int s = clipper.DisplayStart; s < clipper.DisplayEnd; ++s)
            draw_shape_row(session, static_cast<std::size_t>(s), requests);
    ImGui::EndChild();
}

}  // namespace

void draw_labeling(ViewerState& state, InterfaceRequests& requests) {
    if (ImGui::CollapsingHeader("Labels", ImGuiTreeNodeFlags_DefaultOpen)) {
        draw_palette(state);
        draw_tools(state, requests);
        draw_painting_status(state.labeling->painter());
        if (ImGui::Button("Verified, next shape (Enter)", ImVec2(-1, 0))) requests.actions.push_back(Action::verify);
    }
    if (state.labeling->folder().shapes().size() > 1 &&
        ImGui::CollapsingHeader("Shapes", ImGuiTreeNodeFlags_DefaultOpen))
        draw_shape_list(state, requests);
}

void draw_brush(const LabelingSession& session, const Vec2& mouse, std::span<const Vec2> outline) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const PaintSettings& paint = session.settings;
    const auto label = static_cast<std::size_t>(paint.label);
    const bool erases = paint.tool == PaintTool::eraser || label >= session.palette().size();
    const Color color = erases ? Color{60, 60, 60} : session.palette()[label].color;
    const ImU32 ink = IM_COL32(color[0], color[1], color[2], 255);
    if (paint.tool == PaintTool::lasso) {
        for (std::size_t i = 1; i < outline.size(); ++i)
            list.AddLine(ImVec2(outline[i - 1].x(), outline[i - 1].y()), ImVec2(outline[i].x(), outline[i].y()), ink,
                         2);
        return;
    }
    const float radius = paint.tool == PaintTool::fill ? 3 : paint.radius / ImGui::GetIO().DisplayFramebufferScale.x;
    list.AddCircle(ImVec2(mouse.x(), mouse.y()), radius, ink, 0, 1.5F);
}

}  // namespace exemplar
