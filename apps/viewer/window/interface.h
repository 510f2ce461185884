#pragma once

#include <vulkan/vulkan_core.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/scene/viewer_state.h"
#include "apps/viewer/window/window.h"

struct ImDrawData;
struct ImFontAtlas;

namespace exemplar {

/// A movement of the mouse that paints, in pixels of the view.
struct PaintEvent {
    enum class Kind { press, drag, release } kind;
    Vec2 at;
};

/// Requests of panels to the program, beyond their changes of its state.
struct InterfaceRequests {
    std::vector<Action> actions;
    std::vector<std::filesystem::path> open;
    std::vector<PaintEvent> paint;
    std::optional<std::size_t> shape;  ///< to open, of the folder that is being labeled
    bool start_labeling = false;       ///< of the open mesh
};

/// The area that shows the surface: in units of the window, and in pixels.
struct ViewArea {
    float left = 0, top = 0, width = 1, height = 1;
    VkRect2D pixels{};
    ViewSize size() const { return {static_cast<int>(pixels.extent.width), static_cast<int>(pixels.extent.height)}; }
};

/// The panels of a window and the control by mouse. Only one may exist at a time.
class Interface {
  public:
    explicit Interface(Window& window);
    ~Interface();
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;

    ImFontAtlas& fonts() const;
    /// Lays out a frame of `pixels`, and lets the mouse move the camera in the area that panels leave free.
    InterfaceRequests lay_out(ViewerState& state, VkExtent2D pixels);
    const ViewArea& view() const { return view_; }
    const ImDrawData& drawing() const;

  private:
    void find_view(const ViewerState& state, VkExtent2D pixels);
    void move_camera(ViewerState& state) const;
    void follow_brush(const ViewerState& state, InterfaceRequests& requests);
    float scale_;
    std::string path_;           // text being typed
    bool painting_ = false;      // a stroke is being drawn
    std::vector<Vec2> outline_;  // of a lasso, in units of the window
    ViewArea view_;
};

}  // namespace exemplar
