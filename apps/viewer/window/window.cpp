#include "apps/viewer/window/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "gpu/runtime/vulkan/errors.h"

namespace exemplar {
namespace {

std::string last_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "unknown error";
}

// Returns whether an action repeats while its key is held.
bool repeats(Action action) {
    return action == Action::undo || action == Action::redo || action == Action::narrower_brush ||
           action == Action::wider_brush || action == Action::next_frame || action == Action::previous_frame ||
           action == Action::faster || action == Action::slower ||
           (action >= Action::turn_left && action <= Action::zoom_out);
}

}  // namespace

Window::Window(ViewSize size, const std::string& title) {
    if (!glfwInit())
        throw UsageError(
            fmt::format("cannot open a window ({}); --headless --out FOLDER draws without one", last_error()));
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
    if (!window_) {
        const std::string error = last_error();
        glfwTerminate();
        throw UsageError(fmt::format("cannot open a window of {} x {} ({})", size.width, size.height, error));
    }
    listen();
}

Window::~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

Window& Window::self(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

void Window::listen() {
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int event, int modifiers) {
        self(window).on_key(key, event, modifiers);
    });
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
        self(window).had_event_ = true;
        for (int i = 0; i < count; ++i) self(window).drops_.emplace_back(paths[i]);
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double, double) { self(w).had_event_ = true; });
    glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int) { self(w).had_event_ = true; });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int, int, int) { self(w).had_event_ = true; });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double) { self(w).had_event_ = true; });
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned) { self(w).had_event_ = true; });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int) { self(w).had_event_ = true; });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { self(w).had_event_ = true; });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { self(w).had_event_ = true; });
}

void Window::on_key(int key, int event, int modifiers) {
    had_event_ = true;
    if (event == GLFW_RELEASE || ImGui::GetIO().WantTextInput || (modifiers & (GLFW_MOD_ALT | GLFW_MOD_SUPER))) return;
    const std::optional<Action> action = action_of(key, (modifiers & GLFW_MOD_CONTROL) != 0, painting_);
    if (action && (event == GLFW_PRESS || repeats(*action))) actions_.push_back(*action);
}

PresentationOptions Window::presentation() const {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (!names) throw DeviceError("this display cannot show Vulkan images; --headless --out FOLDER draws without one");
    return {.instance_extensions = {names, names + count},
            .can_present = [](VkInstance instance, VkPhysicalDevice device, std::uint32_t family) {
                return glfwGetPhysicalDevicePresentationSupport(instance, device, family) == GLFW_TRUE;
            }};
}

VkSurfaceKHR Window::make_surface(VkInstance instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    check(glfwCreateWindowSurface(instance, window_, nullptr, &surface), "make a surface of the window");
    return surface;
}

VkExtent2D Window::pixels() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {static_cast<std::uint32_t>(std::max(width, 0)), static_cast<std::uint32_t>(std::max(height, 0))};
}

float Window::content_scale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return std::clamp(x, 1.0f, 4.0f);
}

bool Window::closing() const {
    return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void Window::close() {
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::set_title(const std::string& title) {
    glfwSetWindowTitle(window_, title.c_str());
}

bool Window::poll() {
    glfwPollEvents();
    return std::exchange(had_event_, false);
}

bool Window::wait(double seconds) {
    if (!had_event_) glfwWaitEventsTimeout(seconds);
    return std::exchange(had_event_, false);
}

std::vector<Action> Window::take_actions() {
    return std::exchange(actions_, {});
}

std::vector<std::filesystem::path> Window::take_drops() {
    return std::exchange(drops_, {});
}

}  // namespace exemplar
