#pragma once

#include <span>
#include <string>

#include "apps/viewer/window/interface.h"

namespace exemplar {

// The panels of a window, drawn with Dear ImGui between the begin and the end of its frame.

/// Sizes of the panels in units of the window; 0 if the window is too small for them.
struct PanelSizes {
    float side = 0;               ///< width, at the left
    float bottom = 0;             ///< height, beside it
    float width = 0, height = 0;  ///< of the window
};
PanelSizes panel_sizes(const ViewerState& state, float width, float height, float scale);

/// `path` is the text in the field for files.
void draw_side_panel(ViewerState& state, const PanelSizes& sizes, std::string& path, InterfaceRequests& requests);
void draw_playback_bar(ViewerState& state, const PanelSizes& sizes, InterfaceRequests& requests);
void draw_messages(ViewerState& state, const ViewArea& view, float scale);
/// Draws captions of two pictures side by side, or a hint if there is nothing to show.
void draw_view_captions(const ViewerState& state, const ViewArea& view);
void draw_help(ViewerState& state, const ViewArea& view, float scale);

/// Draws the thumbnails of suggested shapes, to accept or reject them.
void draw_shape_grid(ViewerState& state, const ViewArea& view, InterfaceRequests& requests);
/// Draws the outline of the brush at the mouse, or of the lasso so far; places are in units of the window.
void draw_brush(const LabelingSession& session, const Vec2& mouse, std::span<const Vec2> outline);

// Parts of the side panel.

void draw_labeling(ViewerState& state, InterfaceRequests& requests);

/// A swatch that opens a color picker; "##name" has no label. Returns whether the color was changed.
bool edit_color(const char* label, Color& color);
void draw_look(ViewerState& state);
void draw_lines(ViewerState& state);
void draw_curvature(ViewerState& state, InterfaceRequests& requests);
void draw_hatching(ViewerState& state, InterfaceRequests& requests);
void draw_pose(ViewerState& state);
void draw_frame_times(ViewerState& state);

}  // namespace exemplar
