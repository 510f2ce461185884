#include "apps/viewer/window/interface.h"

#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <array>
#include <cmath>

#include "apps/viewer/window/panels.h"

namespace exemplar {
namespace {

// Freely licensed fonts of common systems, best first. If none is found, the library's pixel font is used.
constexpr std::array k_fonts = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                "/usr/share/fonts/TTF/DejaVuSans.ttf",
                                "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
                                "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf"};

void add_font(ImFontAtlas& atlas, float scale) {
    constexpr float k_size = 14;
    for (const char* path : k_fonts)
        if (std::filesystem::exists(path) && atlas.AddFontFromFileTTF(path, std::round(k_size * scale))) return;
    ImFontConfig config;
    config.SizePixels = std::round(13 * scale);
    atlas.AddFontDefault(&config);
}

void set_colors(ImGuiStyle& style) {
    const auto gray = [](float value, float alpha = 1) { return ImVec4(value, value, value * 1.03f, alpha); };
    const ImVec4 accent(0.33f, 0.56f, 0.80f, 1), strong(0.42f, 0.66f, 0.92f, 1);
    ImGui::StyleColorsDark(&style);
    ImVec4* colors = style.Colors;
    colors[ImGuiCol_Text] = gray(0.90f);
    colors[ImGuiCol_TextDisabled] = gray(0.58f);
    colors[ImGuiCol_WindowBg] = gray(0.145f);
    colors[ImGuiCol_PopupBg] = gray(0.17f, 0.98f);
    colors[ImGuiCol_Border] = gray(0.25f);
    colors[ImGuiCol_FrameBg] = gray(0.22f);
    colors[ImGuiCol_FrameBgHovered] = gray(0.28f);
    colors[ImGuiCol_FrameBgActive] = gray(0.32f);
    colors[ImGuiCol_Header] = gray(0.205f);
    colors[ImGuiCol_HeaderHovered] = gray(0.27f);
    colors[ImGuiCol_HeaderActive] = gray(0.31f);
    colors[ImGuiCol_Button] = gray(0.26f);
    colors[ImGuiCol_ButtonHovered] = gray(0.33f);
    colors[ImGuiCol_ButtonActive] = accent;
    colors[ImGuiCol_SliderGrab] = ImVec4(0.25f, 0.41f, 0.58f, 1);
    colors[ImGuiCol_SliderGrabActive] = accent;
    colors[ImGuiCol_CheckMark] = strong;
    colors[ImGuiCol_PlotHistogram] = accent;
    colors[ImGuiCol_TextSelectedBg] = ImVec4(accent.x, accent.y, accent.z, 0.45f);
    colors[ImGuiCol_ScrollbarBg] = gray(0.145f);
    colors[ImGuiCol_TitleBg] = colors[ImGuiCol_TitleBgActive] = gray(0.19f);
}

void set_style(float scale) {
    ImGuiStyle& style = ImGui::GetStyle();
    set_colors(style);
    style.WindowRounding = 0;
    style.FrameRounding = style.GrabRounding = style.PopupRounding = 3;
    style.WindowBorderSize = 0;
    style.WindowPadding = ImVec2(10, 8);
    style.ItemSpacing = ImVec2(8, 5);
    style.ScrollbarSize = 11;
    style.ScaleAllSizes(scale);
}

}  // namespace

Interface::Interface(Window& window) : scale_(window.content_scale()) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // leaves no file behind
    add_font(*io.Fonts, scale_);
    set_style(scale_);
    ImGui_ImplGlfw_InitForVulkan(window.handle(), true);
}

Interface::~Interface() {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

ImFontAtlas& Interface::fonts() const {
    return *ImGui::GetIO().Fonts;
}

const ImDrawData& Interface::drawing() const {
    return *ImGui::GetDrawData();
}

void Interface::find_view(const ViewerState& state, VkExtent2D pixels) {
    const ImGuiIO& io = ImGui::GetIO();
    const PanelSizes panels = panel_sizes(state, io.DisplaySize.x, io.DisplaySize.y, scale_);
    view_.left = panels.side;
    view_.top = 0;
    view_.width = std::max(io.DisplaySize.x - panels.side, 1.0f);
    view_.height = std::max(io.DisplaySize.y - panels.bottom, 1.0f);
    const auto pixel = [](float value, float scale, std::uint32_t most) {
        return std::min(static_cast<std::uint32_t>(std::lround(std::max(value * scale, 0.0f))), most);
    };
    const std::uint32_t left = pixel(view_.left, io.DisplayFramebufferScale.x, pixels.width - 1),
                        bottom = pixel(view_.height, io.DisplayFramebufferScale.y, pixels.height);
    view_.pixels = {{static_cast<std::int32_t>(left), 0}, {pixels.width - left, std::max(bottom, 1u)}};
}

InterfaceRequests Interface::lay_out(ViewerState& state, VkExtent2D pixels) {
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    find_view(state, pixels);
    move_camera(state);
    InterfaceRequests requests;
    follow_brush(state, requests);
    const ImGuiIO& io = ImGui::GetIO();
    const PanelSizes sizes = panel_sizes(state, io.DisplaySize.x, io.DisplaySize.y, scale_);
    if (sizes.side > 0) draw_side_panel(state, sizes, path_, requests);
    if (sizes.bottom > 0) draw_playback_bar(state, sizes, requests);
    if (state.labeling && state.show_grid) draw_shape_grid(state, view_, requests);
    draw_messages(state, view_, scale_);
    draw_view_captions(state, view_);
    if (state.show_help) draw_help(state, view_, scale_);
    ImGui::Render();
    return requests;
}

// Two pictures side by side move together.
void Interface::move_camera(ViewerState& state) const {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantCaptureMouse || !state.has_document()) return;
    const int parts = state.shows_both() ? 2 : 1;
    const float width = view_.width / static_cast<float>(parts);
    const ViewSize size{static_cast<int>(std::lround(std::max(width, 1.0f))),
                        static_cast<int>(std::lround(std::max(view_.height, 1.0f)))};
    const auto inside = [&](ImVec2 mouse) {
        const float x = mouse.x - view_.left;
        return Vec2(parts == 2 && x >= width ? x - width : x, mouse.y - view_.top);
    };
    if (!ImGui::IsMousePosValid()) return;
    const Vec2 to = inside(io.MousePos), from = to - Vec2(io.MouseDelta.x, io.MouseDelta.y);
    const bool paints = state.labeling != nullptr;  // with the left button
    const bool pans = (io.MouseDown[1] && !paints) || io.MouseDown[2] || (io.MouseDown[0] && io.KeyShift);
    if (pans)
        state.camera.pan(from, to, size);
    else if (io.MouseDown[paints ? 1 : 0] && from != to)
        state.camera.orbit(from, to, size);
    if (io.MouseWheel != 0) state.camera.zoom(std::pow(1.12f, io.MouseWheel), to, size);
    if (io.MouseDoubleClicked[0] && !paints) state.fit(size);
}

// Turns the left button's movements into strokes, and draws the brush.
void Interface::follow_brush(const ViewerState& state, InterfaceRequests& requests) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!state.labeling || state.show_grid || !ImGui::IsMousePosValid()) {
        painting_ = false;
        return;
    }
    const Vec2 unit(io.MousePos.x, io.MousePos.y);
    const Vec2 at((unit.x() - view_.left) * io.DisplayFramebufferScale.x,
                  (unit.y() - view_.top) * io.DisplayFramebufferScale.y);
    if (io.MouseClicked[0] && !io.WantCaptureMouse && !io.KeyShift) {
        painting_ = true;
        outline_.clear();
        requests.paint.push_back({PaintEvent::Kind::press, at});
    } else if (painting_ && io.MouseDown[0]) {
        requests.paint.push_back({PaintEvent::Kind::drag, at});
    }
    if (painting_) outline_.push_back(unit);
    if (painting_ && !io.MouseDown[0]) {
        painting_ = false;
        requests.paint.push_back({PaintEvent::Kind::drag, at});
        requests.paint.push_back({PaintEvent::Kind::release, at});
    }
    if (!io.WantCaptureMouse) draw_brush(*state.labeling, unit, painting_ ? std::span(outline_) : std::span<Vec2>());
}

}  // namespace exemplar
