// The parts of the side panel.

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/viewer/window/panels.h"
#include "host/core/errors.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

struct PaintName {
    SurfacePaint paint;
    const char* name;
};
constexpr std::array k_paint_names = {PaintName{SurfacePaint::plain, "Plain"},
                                      PaintName{SurfacePaint::faces, "Labels"},
                                      PaintName{SurfacePaint::mean_curvature, "Mean curvature"},
                                      PaintName{SurfacePaint::gaussian_curvature, "Gaussian curvature"},
                                      PaintName{SurfacePaint::first_curvature, "Curvature k1"},
                                      PaintName{SurfacePaint::second_curvature, "Curvature k2"},
                                      PaintName{SurfacePaint::normals, "Normals"}};
struct LightName {
    SurfaceLight light;
    const char* name;
};
constexpr std::array k_light_names = {LightName{SurfaceLight::smooth, "Smooth"}, LightName{SurfaceLight::flat, "Flat"},
                                      LightName{SurfaceLight::steps, "Steps"}, LightName{SurfaceLight::none, "None"}};

// Well-separated colors, less bright than those of labels would be on a dark panel.
ImU32 series_color(std::size_t index) {
    const Color color = label_color(index);
    return IM_COL32(color[0], color[1], color[2], 255);
}

void choose_paint(ViewerState& state) {
    const auto current = std::ranges::find(k_paint_names, state.settings.paint, &PaintName::paint);
    if (!ImGui::BeginCombo("Colors", current->name)) return;
    for (const PaintName& entry : k_paint_names) {
        if (entry.paint == SurfacePaint::faces && state.document().face_colors.empty()) continue;
        if (ImGui::Selectable(entry.name, entry.paint == state.settings.paint)) state.settings.paint = entry.paint;
    }
    ImGui::EndCombo();
}

void choose_light(ViewerState& state) {
    const auto current = std::ranges::find(k_light_names, state.settings.light, &LightName::light);
    if (!ImGui::BeginCombo("Shading", current->name)) return;
    for (const LightName& entry : k_light_names) {
        if (ImGui::Selectable(entry.name, entry.light == state.settings.light)) state.settings.light = entry.light;
    }
    ImGui::EndCombo();
}

void draw_legend(const Document& document) {
    for (const LegendEntry& entry : document.legend) {
        const ImVec4 color(static_cast<float>(entry.color[0]) / 255, static_cast<float>(entry.color[1]) / 255,
                           static_cast<float>(entry.color[2]) / 255, 1);
        const float size = ImGui::GetFontSize() * 0.8f;
        ImGui::ColorButton(entry.name.c_str(), color, ImGuiColorEditFlags_NoTooltip, ImVec2(size, size));
        ImGui::SameLine();
        ImGui::TextUnformatted(entry.name.c_str());
    }
}

void draw_training(ViewerState& state) {
    if (!state.training) {
        const Animation& animation = state.document().animation;
        const bool can = animation.has_rig() || animation.frame_count() >= k_min_poses;
        if (!can || !ImGui::Button(state.model() ? "Train again" : "Train a model", ImVec2(-1, 0))) return;
        try {
            state.start_training();
        } catch (const Error& error) {
            state.messages.error(error.what());
        }
        return;
    }
    const TrainingJob::Status status = state.training->status();
    const std::string text = fmt::format("{} ({})", state.training->canceled() ? "canceling" : status.what,
                                         format_seconds(state.training->seconds()));
    ImGui::ProgressBar(status.share, ImVec2(-1, 0), text.c_str());
    if (ImGui::Button("Cancel", ImVec2(-1, 0))) state.training->cancel();
}

void draw_joints(ViewerState& state, const std::vector<std::uint32_t>& nodes) {
    constexpr const char* k_format = "%.0f\xC2\xB0";
    const Rig& rig = state.document().animation.rig;
    const float height =
        ImGui::GetTextLineHeightWithSpacing() * std::min(6.5f, static_cast<float>(nodes.size()) + 0.5f);
    static constexpr std::array k_axes = {"x", "y", "z"};
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const ImGuiID id = ImGui::GetID("joint");
    auto chosen = static_cast<std::uint32_t>(storage.GetInt(id, static_cast<int>(nodes.front())));
    if (std::ranges::find(nodes, chosen) == nodes.end()) chosen = nodes.front();
    if (ImGui::BeginListBox("##joints", ImVec2(-1, height))) {
        for (const std::uint32_t node : nodes) {
            const bool turned = !state.pose.turns[node].isZero(0);
            const std::string label = fmt::format(
                "{}{}##{}", rig.nodes[node].name.empty() ? "joint" : rig.nodes[node].name, turned ? " *" : "", node);
            if (ImGui::Selectable(label.c_str(), node == chosen)) chosen = node;
        }
        ImGui::EndListBox();
    }
    storage.SetInt(id, static_cast<int>(chosen));
    for (int axis = 0; axis < 3; ++axis)
        ImGui::SliderFloat(fmt::format("Turn {}", k_axes[static_cast<std::size_t>(axis)]).c_str(),
                           &state.pose.turns[chosen][axis], -180, 180, k_format);
}

void draw_weights(ViewerState& state) {
    const Rig& rig = state.document().animation.rig;
    for (std::size_t t = 0; t < rig.targets.size(); ++t) {
        ImGui::PushID(static_cast<int>(t));
        ImGui::SliderFloat(rig.targets[t].name.c_str(), &state.pose.added_weights[t], -1, 1, "%+.2f");
        ImGui::PopID();
    }
}

// "curvature/pose.comp" is "curvature/pose".
std::string short_name(const std::string& program) {
    return program.substr(0, program.find('.'));
}

// Draws frames side by side, newest at the right, with the times of kernels stacked.
void draw_stack(const FrameTimes& times, const std::vector<std::string>& names) {
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, ImGui::GetFontSize() * 6);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(origin, ImVec2(origin.x + size.x, origin.y + size.y), ImGui::GetColorU32(ImGuiCol_FrameBg));
    float most = 0;
    for (std::size_t age = 0; age < times.frame_count(); ++age) most = std::max(most, times.total(age));
    const float width = size.x / FrameTimes::k_frames, unit = most > 0 ? 0.95f * size.y / most : 0;
    for (std::size_t age = 0; age < times.frame_count(); ++age) {
        const float right = origin.x + size.x - static_cast<float>(age) * width;
        float bottom = origin.y + size.y;
        for (std::size_t i = 0; i < names.size(); ++i) {
            const float top = bottom - unit * times.at(names[i], age);
            list.AddRectFilled(ImVec2(right - width, top), ImVec2(right, bottom), series_color(i));
            bottom = top;
        }
    }
    list.AddText(ImVec2(origin.x + 4, origin.y + 2), ImGui::GetColorU32(ImGuiCol_Text),
                 fmt::format("{:.2f} ms", most).c_str());
    ImGui::Dummy(size);
}

}  // namespace

bool edit_color(const char* label, Color& color) {
    std::array<float, 3> value{};
    for (std::size_t c = 0; c < 3; ++c) value[c] = static_cast<float>(color[c]) / 255;
    if (!ImGui::ColorEdit3(label, value.data(), ImGuiColorEditFlags_NoInputs)) return false;
    for (std::size_t c = 0; c < 3; ++c)
        color[c] = static_cast<std::uint8_t>(std::lround(std::clamp(value[c], 0.0f, 1.0f) * 255));
    return true;
}

void draw_look(ViewerState& state) {
    choose_light(state);
    choose_paint(state);
    if (state.settings.paint == SurfacePaint::faces) draw_legend(state.document());
    if (paints_curvature(state.settings.paint))
        ImGui::SliderFloat("Range", &state.settings.curvature_range, 0.005f, 5, "%.3f", ImGuiSliderFlags_Logarithmic);
    edit_color("Surface", state.settings.plain);
    ImGui::SameLine();
    edit_color("Background", state.settings.background);
    bool parallel = state.camera.parallel();
    if (ImGui::Checkbox("Parallel view", &parallel)) state.camera.set_parallel(parallel);
}

void draw_curvature(ViewerState& state, InterfaceRequests& requests) {
    if (state.model()) {
        ImGui::TextDisabled("Model: %s", state.model_name().c_str());
        auto source = static_cast<int>(state.settings.source);
        ImGui::RadioButton("Learned", &source, static_cast<int>(ShownCurvature::learned));
        ImGui::SameLine();
        ImGui::RadioButton("Re-estimated", &source, static_cast<int>(ShownCurvature::estimated));
        ImGui::SameLine();
        ImGui::RadioButton("Both", &source, static_cast<int>(ShownCurvature::both));
        state.settings.source = static_cast<ShownCurvature>(source);
        if (ImGui::Button("Save the model", ImVec2(-1, 0))) requests.actions.push_back(Action::save_model);
    } else {
        ImGui::TextDisabled("Re-estimated on every frame");
    }
    draw_training(state);
}

void draw_pose(ViewerState& state) {
    const std::vector<std::uint32_t> nodes = moving_nodes(state.document().animation.rig);
    const Rig& rig = state.document().animation.rig;
    if (!nodes.empty() && rig.bones.size() > 1) draw_joints(state, nodes);
    draw_weights(state);
    if (ImGui::Button("Reset pose (R)", ImVec2(-1, 0))) state.pose.reset();
}

void draw_frame_times(ViewerState& state) {
    const std::vector<std::string> names = state.times.names();
    draw_stack(state.times, names);
    for (std::size_t i = 0; i < names.size(); ++i) {
        const float size = ImGui::GetFontSize() * 0.7f;
        ImGui::ColorButton(names[i].c_str(), ImGui::ColorConvertU32ToFloat4(series_color(i)),
                           ImGuiColorEditFlags_NoTooltip, ImVec2(size, size));
        ImGui::SameLine(0, 4);
        ImGui::Text("%7.3f ms  %s", static_cast<double>(state.times.average(names[i])), short_name(names[i]).c_str());
    }
    ImGui::Text("     %7.3f ms  all on the device", static_cast<double>(state.times.average_total()));
}

}  // namespace exemplar
