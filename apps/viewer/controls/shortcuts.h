#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace exemplar {

/// Actions of keys. One table assigns them; the help panel shows the same table.
enum class Action {
    play_pause,
    next_frame,
    previous_frame,
    first_frame,
    last_frame,
    faster,
    slower,
    loop,
    next_clip,
    fit,
    upright,
    front,
    back,
    left,
    right,
    top,
    bottom,
    parallel,
    turn_left,
    turn_right,
    turn_up,
    turn_down,
    zoom_in,
    zoom_out,
    next_light,
    next_paint,
    curvature_source,
    reset_pose,
    save_png,
    save_svg,
    save_hatching,
    save_model,
    panels,
    frame_times,
    help,
    quit,
    // While labels are painted.
    label_1,
    label_2,
    label_3,
    label_4,
    label_5,
    label_6,
    label_7,
    label_8,
    label_9,
    undo,
    redo,
    brush,
    eraser,
    lasso,
    fill,
    paint_mirror_image,
    narrower_brush,
    wider_brush,
    paint_through,
    show_confidence,
    uncertain_place,
    discard_suggestion,
    verify,
    next_shape,
    shape_grid,
    accept_shape,
    reject_shape,
    open_suggested
};

/// When a key has its action. Keys of painting come first while labels are painted.
enum class KeyMode { always, painting };

struct Shortcut {
    Action action;
    int key;  ///< key code of GLFW
    bool control;
    std::string_view keys;  ///< as they are shown
    std::string_view what;
    KeyMode mode = KeyMode::always;
};

/// All shortcuts, in the order they are shown. An action may have several, of which the first is shown.
std::span<const Shortcut> shortcuts();
/// The action of a key, if it has one. `painting`: labels are painted.
std::optional<Action> action_of(int key, bool control, bool painting = false);
/// Help on moving the camera, for the same panel: buttons or wheel, and what they do.
struct MouseHint {
    std::string_view mouse, what;
};
std::span<const MouseHint> mouse_hints(bool painting = false);
/// The keys of an action as they are shown; empty if there is none.
std::string_view keys_of(Action action);

}  // namespace exemplar
