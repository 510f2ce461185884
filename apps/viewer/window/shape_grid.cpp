// The grid of suggested shapes: a person accepts or rejects them, most certain first.

#include <fmt/format.h>
#include <imgui.h>

#include "apps/viewer/window/panels.h"
#include "apps/viewer/window/thumbnails.h"

namespace exemplar {
namespace {

void draw_grid_cell(ViewerState& state, std::size_t shape, float height, InterfaceRequests& requests) {
    LabelingSession& session = *state.labeling;
    ImGui::PushID(static_cast<int>(shape));
    ImGui::BeginGroup();
    draw_thumbnail(session, shape, height);
    const double certain = 100 * (1 - static_cast<double>(session.shape_info(shape).uncertainty.value_or(1)));
    ImGui::TextUnformatted(
        fmt::format("{}  {:.0f} %", session.folder().shapes()[shape].path.filename().string(), certain).c_str());
    if (ImGui::SmallButton("Accept")) state.try_labeling([&] { session.accept(shape); });
    ImGui::SameLine();
    if (ImGui::SmallButton("Reject")) session.reject(shape);
    ImGui::SameLine();
    if (ImGui::SmallButton("Open")) requests.shape = shape;
    ImGui::EndGroup();
    ImGui::PopID();
}

}  // namespace

void draw_shape_grid(ViewerState& state, const ViewArea& view, InterfaceRequests& requests) {
    const std::vector<std::size_t> shapes = state.labeling->to_verify();
    ImGui::SetNextWindowPos(ImVec2(view.left, view.top));
    ImGui::SetNextWindowSize(ImVec2(view.width, view.height));
    ImGui::Begin("grid", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings);
    ImGui::TextUnformatted(shapes.empty() ? "No suggested shape is left to check. Tab closes the grid."
                                          : "Are these labels right? A accepts the first, R rejects it, O opens it.");
    const float height = ImGui::GetFontSize() * 9, width = height * 4 / 3 + ImGui::GetStyle().ItemSpacing.x;
    const auto columns = std::max(static_cast<std::size_t>(ImGui::GetContentRegionAvail().x / width), std::size_t{1});
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (i % columns > 0)
            ImGui::SameLine(static_cast<float>(i % columns) * width + ImGui::GetStyle().WindowPadding.x);
        draw_grid_cell(state, shapes[i], height, requests);
    }
    if (ImGui::Button("Learn from these (Tab)")) requests.actions.push_back(Action::shape_grid);
    ImGui::End();
}

}  // namespace exemplar
