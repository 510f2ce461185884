#include "apps/viewer/controls/shortcuts.h"

#include <array>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace exemplar {
namespace {

constexpr std::array k_shortcuts = {
    Shortcut{Action::play_pause, GLFW_KEY_SPACE, false, "Space", "Play or pause"},
    Shortcut{Action::next_frame, GLFW_KEY_PERIOD, false, ".", "Next frame"},
    Shortcut{Action::previous_frame, GLFW_KEY_COMMA, false, ",", "Previous frame"},
    Shortcut{Action::first_frame, GLFW_KEY_HOME, false, "Home", "First frame"},
    Shortcut{Action::last_frame, GLFW_KEY_END, false, "End", "Last frame"},
    Shortcut{Action::faster, GLFW_KEY_RIGHT_BRACKET, false, "]", "Play faster"},
    Shortcut{Action::slower, GLFW_KEY_LEFT_BRACKET, false, "[", "Play slower"},
    Shortcut{Action::loop, GLFW_KEY_L, false, "L", "Loop or end at the last frame"},
    Shortcut{Action::next_clip, GLFW_KEY_TAB, false, "Tab", "Next clip"},
    Shortcut{Action::fit, GLFW_KEY_F, false, "F", "Show all of the surface"},
    Shortcut{Action::upright, GLFW_KEY_U, false, "U", "Turn upright"},
    Shortcut{Action::front, GLFW_KEY_1, false, "1", "Look from the front"},
    Shortcut{Action::back, GLFW_KEY_2, false, "2", "Look from behind"},
    Shortcut{Action::left, GLFW_KEY_3, false, "3", "Look from the left"},
    Shortcut{Action::right, GLFW_KEY_4, false, "4", "Look from the right"},
    Shortcut{Action::top, GLFW_KEY_5, false, "5", "Look from above"},
    Shortcut{Action::bottom, GLFW_KEY_6, false, "6", "Look from below"},
    Shortcut{Action::parallel, GLFW_KEY_O, false, "O", "Parallel or perspective view"},
    Shortcut{Action::turn_left, GLFW_KEY_LEFT, false, "Left", "Turn to the left"},
    Shortcut{Action::turn_right, GLFW_KEY_RIGHT, false, "Right", "Turn to the right"},
    Shortcut{Action::turn_up, GLFW_KEY_UP, false, "Up", "Turn upwards"},
    Shortcut{Action::turn_down, GLFW_KEY_DOWN, false, "Down", "Turn downwards"},
    Shortcut{Action::zoom_in, GLFW_KEY_EQUAL, false, "+", "Zoom in"},
    Shortcut{Action::zoom_in, GLFW_KEY_KP_ADD, false, "+ (keypad)", "Zoom in"},
    Shortcut{Action::zoom_out, GLFW_KEY_MINUS, false, "-", "Zoom out"},
    Shortcut{Action::zoom_out, GLFW_KEY_KP_SUBTRACT, false, "- (keypad)", "Zoom out"},
    Shortcut{Action::next_light, GLFW_KEY_S, false, "S", "Next shading"},
    Shortcut{Action::next_paint, GLFW_KEY_C, false, "C", "Next colors"},
    Shortcut{Action::curvature_source, GLFW_KEY_V, false, "V", "Learned, re-estimated, or both"},
    Shortcut{Action::reset_pose, GLFW_KEY_R, false, "R", "Undo what sliders changed of the pose"},
    Shortcut{Action::save_png, GLFW_KEY_S, true, "Ctrl+S", "Save the picture as PNG"},
    Shortcut{Action::save_svg, GLFW_KEY_E, true, "Ctrl+E", "Save the lines as SVG"},
    Shortcut{Action::save_hatching, GLFW_KEY_H, true, "Ctrl+H", "Save a hatched still as SVG and PNG"},
    Shortcut{Action::save_model, GLFW_KEY_M, true, "Ctrl+M", "Save the model of curvature"},
    Shortcut{Action::panels, GLFW_KEY_P, false, "P", "Show or hide the panels"},
    Shortcut{Action::frame_times, GLFW_KEY_G, false, "G", "Show or hide frame times"},
    Shortcut{Action::help, GLFW_KEY_F1, false, "F1, H", "Show or hide this help"},
    Shortcut{Action::help, GLFW_KEY_H, false, "H", "Show or hide this help"},
    Shortcut{Action::quit, GLFW_KEY_Q, true, "Ctrl+Q", "Quit"},
    Shortcut{Action::label_1, GLFW_KEY_1, false, "1", "Paint label 1", KeyMode::painting},
    Shortcut{Action::label_2, GLFW_KEY_2, false, "2", "Paint label 2", KeyMode::painting},
    Shortcut{Action::label_3, GLFW_KEY_3, false, "3", "Paint label 3", KeyMode::painting},
    Shortcut{Action::label_4, GLFW_KEY_4, false, "4", "Paint label 4", KeyMode::painting},
    Shortcut{Action::label_5, GLFW_KEY_5, false, "5", "Paint label 5", KeyMode::painting},
    Shortcut{Action::label_6, GLFW_KEY_6, false, "6", "Paint label 6", KeyMode::painting},
    Shortcut{Action::label_7, GLFW_KEY_7, false, "7", "Paint label 7", KeyMode::painting},
    Shortcut{Action::label_8, GLFW_KEY_8, false, "8", "Paint label 8", KeyMode::painting},
    Shortcut{Action::label_9, GLFW_KEY_9, false, "9", "Paint label 9", KeyMode::painting},
    Shortcut{Action::undo, GLFW_KEY_Z, true, "Ctrl+Z", "Undo", KeyMode::painting},
    Shortcut{Action::redo, GLFW_KEY_Y, true, "Ctrl+Y", "Redo", KeyMode::painting},
    Shortcut{Action::brush, GLFW_KEY_B, false, "B", "Brush", KeyMode::painting},
    Shortcut{Action::eraser, GLFW_KEY_E, false, "E", "Eraser", KeyMode::painting},
    Shortcut{Action::lasso, GLFW_KEY_L, false, "L", "Lasso", KeyMode::painting},
    Shortcut{Action::fill, GLFW_KEY_K, false, "K", "Fill a piece", KeyMode::painting},
    Shortcut{Action::paint_mirror_image, GLFW_KEY_M, false, "M", "Paint the mirror image", KeyMode::painting},
    Shortcut{Action::narrower_brush, GLFW_KEY_LEFT_BRACKET, false, "[", "Narrower brush", KeyMode::painting},
    Shortcut{Action::wider_brush, GLFW_KEY_RIGHT_BRACKET, false, "]", "Wider brush", KeyMode::painting},
    Shortcut{Action::paint_through, GLFW_KEY_T, false, "T", "Paint hidden faces, too", KeyMode::painting},
    Shortcut{Action::show_confidence, GLFW_KEY_C, false, "C", "Show confidence", KeyMode::painting},
    Shortcut{Action::uncertain_place, GLFW_KEY_N, false, "N", "Turn to the next uncertain place", KeyMode::painting},
    Shortcut{Action::discard_suggestion, GLFW_KEY_X, false, "X", "Paint anew, without the suggestion",
             KeyMode::painting},
    Shortcut{Action::verify, GLFW_KEY_ENTER, false, "Enter", "Save these labels, open the next", KeyMode::painting},
    Shortcut{Action::next_shape, GLFW_KEY_PAGE_DOWN, false, "Page down", "Open the next shape", KeyMode::painting},
    Shortcut{Action::shape_grid, GLFW_KEY_TAB, false, "Tab", "Grid of suggested shapes", KeyMode::painting},
    Shortcut{Action::accept_shape, GLFW_KEY_A, false, "A", "Accept the first of the grid", KeyMode::painting},
    Shortcut{Action::reject_shape, GLFW_KEY_R, false, "R", "Reject the first of the grid", KeyMode::painting},
    Shortcut{Action::open_suggested, GLFW_KEY_O, false, "O", "Open the first of the grid", KeyMode::painting},
};

constexpr std::array k_mouse_hints = {
    MouseHint{"Left drag", "Orbit"},
    MouseHint{"Right or middle drag, or Shift and left", "Pan"},
    MouseHint{"Wheel", "Zoom to the cursor"},
    MouseHint{"Double click", "Show all of the surface"},
    MouseHint{"Drop a file", "Open it: mesh, animation, model, labels or style"},
};

constexpr std::array k_painting_hints = {
    MouseHint{"Left drag", "Paint"},
    MouseHint{"Right drag", "Orbit"},
    MouseHint{"Middle drag, or Shift and left", "Pan"},
    MouseHint{"Wheel", "Zoom to the cursor"},
};

}  // namespace

std::span<const Shortcut> shortcuts() {
    return k_shortcuts;
}

std::span<const MouseHint> mouse_hints(bool painting) {
    if (painting) return k_painting_hints;
    return k_mouse_hints;
}

std::optional<Action> action_of(int key, bool control, bool painting) {
    std::optional<Action> found;
    for (const Shortcut& shortcut : k_shortcuts) {
        if (shortcut.key != key || shortcut.control != control) continue;
        if (shortcut.mode == KeyMode::painting && painting) return shortcut.action;
        if (shortcut.mode == KeyMode::always && !found) found = shortcut.action;
    }
    return found;
}

std::string_view keys_of(Action action) {
    for (const Shortcut& shortcut : k_shortcuts)
        if (shortcut.action == action) return shortcut.keys;
    return {};
}

}  // namespace exemplar
