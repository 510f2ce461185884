// The part of the side panel for hatching: stills in a learned style.

#include <fmt/format.h>
#include <imgui.h>

#include "apps/viewer/window/panels.h"
#include "host/core/text.h"

namespace exemplar {

void draw_hatching(ViewerState& state, InterfaceRequests& requests) {
    if (!state.hatching()) {
        ImGui::TextWrapped("Drop a style of 'exemplar hatch train' here.");
        return;
    }
    ImGui::TextDisabled("Style: %s", state.hatching_name().c_str());
    if (!state.hatching_job) {
        if (ImGui::Button("Draw a hatched still (Ctrl+H)", ImVec2(-1, 0)))
            requests.actions.push_back(Action::save_hatching);
        return;
    }
    HatchingJob& job = *state.hatching_job;
    ImGui::TextUnformatted(
        fmt::format("{} ({})", job.canceled() ? "canceling" : job.what(), format_seconds(job.seconds())).c_str());
    if (ImGui::Button("Cancel##hatching", ImVec2(-1, 0))) job.cancel();
}

}  // namespace exemplar
