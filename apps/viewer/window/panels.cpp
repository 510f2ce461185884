#include "apps/viewer/window/panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "host/core/errors.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

constexpr ImGuiWindowFlags k_fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                     ImGuiWindowFlags_NoBringToFrontOnFocus;

void draw_file(ViewerState& state, std::string& path, InterfaceRequests& requests) {
    if (state.has_document()) {
        const Animation& animation = state.document().animation;
        ImGui::TextUnformatted(animation.name.c_str());
        const std::string kind(animation.moves() ? name_of(animation.kind) : "mesh");
        ImGui::TextDisabled("%s, %zu vertices, %zu faces", kind.c_str(), animation.rest.vertex_count(),
                            animation.rest.face_count());
    }
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputTextWithHint("##path", "Drop a file here, or type its path", &path,
                                 ImGuiInputTextFlags_EnterReturnsTrue)) {
        requests.open.emplace_back(path);
        path.clear();
    }
    if (!state.has_document()) return;
    const float width = (ImGui::GetContentRegionAvail().x - 3 * ImGui::GetStyle().ItemSpacing.x) / 4;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(1, ImGui::GetStyle().FramePadding.y));  // all words fit
    if (ImGui::Button("Fit", ImVec2(width, 0))) requests.actions.push_back(Action::fit);
    ImGui::SameLine();
    if (ImGui::Button("Save PNG", ImVec2(width, 0))) requests.actions.push_back(Action::save_png);
    ImGui::SameLine();
    if (ImGui::Button("Save SVG", ImVec2(width, 0))) requests.actions.push_back(Action::save_svg);
    ImGui::SameLine();
    if (ImGui::Button("Keys", ImVec2(width, 0))) state.show_help = !state.show_help;
    ImGui::PopStyleVar();
    if (!state.labeling && !state.document().animation.moves() && ImGui::Button("Paint labels", ImVec2(-1, 0)))
        requests.start_labeling = true;
}

void draw_clips(ViewerState& state) {
    const std::vector<Clip>& clips = state.document().animation.clips;
    ImGui::SetNextItemWidth(150 * ImGui::GetFontSize() / 14);
    if (!ImGui::BeginCombo("##clip", clips[state.clip()].name.c_str())) return;
    for (std::size_t i = 0; i < clips.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::Selectable(clips[i].name.c_str(), i == state.clip())) state.set_clip(i);
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

void draw_speed(ViewerState& state) {
    bool loops = state.playback.loops();
    if (ImGui::Checkbox("Loop", &loops)) state.playback.set_loops(loops);
    ImGui::SameLine();
    auto speed = static_cast<float>(state.playback.speed());
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##speed", &speed, 0.05f, 8, "%.2fx", ImGuiSliderFlags_Logarithmic))
        state.playback.set_speed(speed);
}

}  // namespace

PanelSizes panel_sizes(const ViewerState& state, float width, float height, float scale) {
    constexpr float k_side = 300, k_bottom = 40, k_min_width = 560, k_min_height = 240;
    PanelSizes sizes{.side = 0, .bottom = 0, .width = width, .height = height};
    if (!state.show_panels || width < k_min_width * scale || height < k_min_height * scale) return sizes;
    sizes.side = k_side * scale;
    if (state.playback.frame_count() > 1) sizes.bottom = k_bottom * scale;
    return sizes;
}

void draw_side_panel(ViewerState& state, const PanelSizes& sizes, std::string& path, InterfaceRequests& requests) {
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(sizes.side, sizes.height));
    ImGui::Begin("side", nullptr, k_fixed);
    ImGui::PushItemWidth(ImGui::GetFontSize() * 11);
    draw_file(state, path, requests);
    if (state.has_document()) {
        ImGui::Spacing();
        if (state.labeling) draw_labeling(state, requests);
        const ImGuiTreeNodeFlags open = state.labeling ? 0 : ImGuiTreeNodeFlags_DefaultOpen;
        if (ImGui::CollapsingHeader("Look", open)) draw_look(state);
        if (ImGui::CollapsingHeader("Lines", open)) draw_lines(state);
        if (ImGui::CollapsingHeader("Curvature", open)) draw_curvature(state, requests);
        if (ImGui::CollapsingHeader("Hatching", state.hatching() ? ImGuiTreeNodeFlags_DefaultOpen : 0))
            draw_hatching(state, requests);
        if (state.document().animation.has_rig() && ImGui::CollapsingHeader("Pose")) draw_pose(state);
        ImGui::SetNextItemOpen(state.show_times);
        state.show_times = ImGui::CollapsingHeader("Frame times (G)");
        if (state.show_times) draw_frame_times(state);
    }
    ImGui::PopItemWidth();
    ImGui::End();
}

void draw_playback_bar(ViewerState& state, const PanelSizes& sizes, InterfaceRequests& requests) {
    Playback& playback = state.playback;
    ImGui::SetNextWindowPos(ImVec2(sizes.side, sizes.height - sizes.bottom));
    ImGui::SetNextWindowSize(ImVec2(sizes.width - sizes.side, sizes.bottom));
    ImGui::Begin("playback", nullptr, k_fixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    const float button = ImGui::GetFontSize() * 4;
    if (ImGui::Button(playback.playing() ? "Pause" : "Play", ImVec2(button, 0)))
        requests.actions.push_back(Action::play_pause);
    ImGui::SameLine();
    if (ImGui::ArrowButton("previous", ImGuiDir_Left)) requests.actions.push_back(Action::previous_frame);
    ImGui::SameLine(0, 2);
    if (ImGui::ArrowButton("next", ImGuiDir_Right)) requests.actions.push_back(Action::next_frame);
    ImGui::SameLine();
    draw_clips(state);
    ImGui::SameLine();
    const float right = ImGui::GetFontSize() * 14;
    ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x - right, 40.0f));
    auto frame = static_cast<int>(playback.frame());
    const std::string format = fmt::format("%d / {}", playback.frame_count() - 1);
    if (ImGui::SliderInt("##frame", &frame, 0, static_cast<int>(playback.frame_count()) - 1, format.c_str()))
        playback.scrub(static_cast<std::size_t>(std::max(frame, 0)));
    ImGui::SameLine();
    draw_speed(state);
    ImGui::End();
}

void draw_messages(ViewerState& state, const ViewArea& view, float scale) {
    if (state.messages.all().empty()) return;
    ImGui::SetNextWindowPos(ImVec2(view.left + 8 * scale, 8 * scale));
    ImGui::SetNextWindowSize(ImVec2(std::max(view.width - 16 * scale, 40.0f), 0));
    ImGui::Begin("messages", nullptr, k_fixed | ImGuiWindowFlags_AlwaysAutoResize);
    std::optional<std::size_t> dismissed;
    for (std::size_t i = 0; i < state.messages.all().size(); ++i) {
        const Messages::Message& message = state.messages.all()[i];
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::SmallButton("x")) dismissed = i;
        ImGui::SameLine();
        ImGui::PushStyleColor(ImGuiCol_Text,
                              message.is_error ? ImVec4(1, 0.55f, 0.45f, 1) : ImVec4(0.9f, 0.9f, 0.9f, 1));
        ImGui::PushTextWrapPos(0);
        ImGui::TextUnformatted(message.text.c_str());
        ImGui::PopTextWrapPos();
        ImGui::PopStyleColor();
        ImGui::PopID();
    }
    ImGui::End();
    if (dismissed) state.messages.dismiss(*dismissed);
}

void draw_view_captions(const ViewerState& state, const ViewArea& view) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const Color& paper = state.settings.background;
    const bool dark = 2 * paper[0] + 5 * paper[1] + paper[2] < 8 * 128;  // about the eye's weights
    const ImU32 ink = dark ? IM_COL32(225, 225, 230, 255) : IM_COL32(70, 70, 76, 255);
    const auto centered = [&](const char* text, float x, float y) {
        list.AddText(ImVec2(x - ImGui::CalcTextSize(text).x / 2, y), ink, text);
    };
    const float height = ImGui::GetFontSize();
    if (!state.has_document() && view.width > 300)
        centered("Drop a mesh, an animation or a folder of meshes here", view.left + view.width / 2, view.height / 2);
    if (!state.shows_both()) return;
    centered("learned", view.left + view.width / 4, view.height - 1.6f * height);
    centered("re-estimated", view.left + 3 * view.width / 4, view.height - 1.6f * height);
    const float middle = view.left + view.width / 2;
    list.AddLine(ImVec2(middle, 0), ImVec2(middle, view.height), IM_COL32(150, 150, 156, 255));
}

void draw_help(ViewerState& state, const ViewArea& view, float scale) {
    ImGui::SetNextWindowPos(ImVec2(view.left + view.width / 2, view.height / 2), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSizeConstraints(ImVec2(100, 50), ImVec2(view.width, std::max(view.height - 20 * scale, 60.0f)));
    ImGui::Begin("Keys and mouse", &state.show_help,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoMove);
    if (ImGui::BeginTable("mouse", 2)) {
        for (const MouseHint& hint : mouse_hints(state.labeling != nullptr)) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(hint.mouse.data(), hint.mouse.data() + hint.mouse.size());
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(hint.what.data(), hint.what.data() + hint.what.size());
        }
        ImGui::EndTable();
    }
    ImGui::Separator();
    if (ImGui::BeginTable("keys", 4)) {
        for (const Shortcut& shortcut : shortcuts()) {
            const bool shown = state.labeling ? action_of(shortcut.key, shortcut.control, true) == shortcut.action
                                              : shortcut.mode == KeyMode::always;
            if (!shown || keys_of(shortcut.action) != shortcut.keys) continue;
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(shortcut.keys.data(), shortcut.keys.data() + shortcut.keys.size());
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(shortcut.what.data(), shortcut.what.data() + shortcut.what.size());
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

}  // namespace exemplar
