#pragma once

#include <vulkan/vulkan_core.h>

#include <filesystem>
#include <string>
#include <vector>

#include "apps/viewer/controls/orbit_camera.h"
#include "apps/viewer/controls/shortcuts.h"
#include "gpu/runtime/device/device.h"

struct GLFWwindow;

namespace exemplar {

/// An empty window of the system. Only one may exist at a time.
class Window {
  public:
    /// Throws UsageError if there is no display.
    Window(ViewSize size, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Requirements on a device that shows images in it.
    PresentationOptions presentation() const;
    /// Makes a surface of an instance that has these extensions; the caller destroys it.
    VkSurfaceKHR make_surface(VkInstance instance) const;
    /// Its size in pixels; zero while it is minimized.
    VkExtent2D pixels() const;
    /// Pixels per unit, for the scale of text.
    float content_scale() const;
    bool closing() const;
    void close();
    void set_title(const std::string& title);

    /// Handle pending events, or wait for events for up to that many seconds. Return whether there was any.
    bool poll();
    bool wait(double seconds);
    /// Return the actions of keys, and the dropped files, since the last call.
    std::vector<Action> take_actions();
    /// Sets whether keys are those of painting.
    void set_painting(bool painting) { painting_ = painting; }
    std::vector<std::filesystem::path> take_drops();

    GLFWwindow* handle() const { return window_; }

  private:
    static Window& self(GLFWwindow* window);
    void listen();
    void on_key(int key, int event, int modifiers);
    GLFWwindow* window_ = nullptr;
    bool painting_ = false;
    bool had_event_ = true;
    std::vector<Action> actions_;
    std::vector<std::filesystem::path> drops_;
};

}  // namespace exemplar
