#pragma once

#include <volk.h>

#include <filesystem>
#include <string>
#include <vector>

#include "apps/viewer/controls/orbit_camera.h"
#include "apps/viewer/controls/shortcuts.h"
#include "gpu/runtime/device/device.h"

struct GLFWwindow;

namespace exemplar {

/// A window of the system, without anything in it. There is one at a time.
class Window {
  public:
    /// Throws UsageError if there is no display.
    Window(ViewSize size, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// What a device must have to show images in it.
    PresentationOptions presentation() const;
    /// A surface of an instance with these extensions, which the caller ends.
    VkSurfaceKHR make_surface(VkInstance instance) const;
    /// Its size in pixels; zero while it is minimized.
    VkExtent2D pixels() const;
    /// Pixels per unit that texts should be scaled with.
    float content_scale() const;
    bool closing() const;
    void close();
    void set_title(const std::string& title);

    /// Takes events that are there, or waits for some for so many seconds. Returns whether there was any.
    bool poll();
    bool wait(double seconds);
    /// What keys asked for and files that were dropped since the last call.
    std::vector<Action> take_actions();
    std::vector<std::filesystem::path> take_drops();

    GLFWwindow* handle() const { return window_; }

  private:
    static Window& self(GLFWwindow* window);
    void listen();
    void on_key(int key, int event, int modifiers);
    GLFWwindow* window_ = nullptr;
    bool had_event_ = true;
    std::vector<Action> actions_;
    std::vector<std::filesystem::path> drops_;
};

}  // namespace exemplar
