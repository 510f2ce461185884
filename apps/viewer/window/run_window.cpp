// The window of exemplar-viewer: events in, frames out.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

#include "apps/viewer/painting/paint_gesture.h"
#include "apps/viewer/scene/frame_renderer.h"
#include "apps/viewer/scene/options.h"
#include "apps/viewer/window/interface.h"
#include "apps/viewer/window/save_svg.h"
#include "apps/viewer/window/thumbnails.h"
#include "apps/viewer/window/window.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/window/swapchain.h"
#include "gpu/window/ui_renderer.h"
#include "host/core/interrupt.h"
#include "host/imaging/png.h"

namespace exemplar {
namespace {

using Clock = std::chrono::steady_clock;

constexpr Transition k_image_acquired{
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_NONE,
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
constexpr Transition k_scene_copied{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
constexpr Transition k_interface_drawn{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                       VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_2_NONE,
                                       VK_ACCESS_2_NONE};

// Number of frames drawn after an event, as an interface needs more than one to become stable.
constexpr int k_settling_frames = 3;

/// Returns STEM_0.png and so on in the working folder, with the first number that is free for all extensions.
std::vector<std::filesystem::path> free_names(const std::string& stem, const std::vector<std::string>& extensions) {
    for (int i = 0;; ++i) {
        std::vector<std::filesystem::path> names;
        names.reserve(extensions.size());
        for (const std::string& extension : extensions) names.emplace_back(fmt::format("{}_{}{}", stem, i, extension));
        if (std::ranges::none_of(names, [](const auto& name) { return std::filesystem::exists(name); })) return names;
    }
}

/// The open document cannot be drawn: its curvature cannot be measured, or the device has too little memory for it.
struct UndrawableError : Error {
    using Error::Error;
};

/// Everything on the device. It is replaced when the device is lost, or a frame could not be recorded to its end.
class Session {
  public:
    Session(Window& window, Interface& interface, const std::string& device)
        : window_(window),
          interface_(interface),
          device_({.name = device, .presentation = window.presentation()}),
          swapchain_(device_, window.make_surface(device_.instance())),
          interface_renderer_(device_, swapchain_.format(), interface.fonts()),
          renderer_(device_) {}

    /// Draws and shows a frame; nothing if the window has no pixels. Returns whether it did. Throws UndrawableError.
    /// `fails`: for tests, whether drawing fails.
    bool draw(ViewerState& state, InterfaceRequests& requests, bool fails);
    Image picture() { return renderer_.read(); }
    /// Returns the faces that the view shows.
    const FacePicture& faces(const ViewerState& state) {
        return renderer_.face_picture(state, interface_.view().size());
    }
    Device& device() { return device_; }

  private:
    void follow(ViewerState& state);
    void record_scene(const ViewerState& state, bool fails);
    void record(const WindowImage& image);
    Window& window_;
    Interface& interface_;
    Device device_;
    Swapchain swapchain_;
    UiRenderer interface_renderer_;
    FrameRenderer renderer_;
    ThumbnailStrip thumbnails_;
};

// Closes a document that the device cannot show, with a message; keeps it if the device was lost.
void Session::follow(ViewerState& state) {
    try {
        renderer_.follow(state);
    } catch (const DeviceLostError&) {
        throw;
    } catch (const ModelError& error) {
        state.messages.error(error.what());
        state.set_model(nullptr, {});
    } catch (const Error& error) {
        state.messages.error(error.what());
        state.close();
        renderer_.follow(state);
    }
}

// Memory that curvature takes is only taken when lines or colors need it: here, and not in follow().
void Session::record_scene(const ViewerState& state, bool fails) {
    try {
        if (fails) throw DeviceMemoryError("the device has no memory left, as the command line asked for");
        renderer_.record(state, interface_.view().size());
    } catch (const DeviceLostError&) {
        throw;
    } catch (const Error& error) {
        throw UndrawableError(error.what());
    }
}

bool Session::draw(ViewerState& state, InterfaceRequests& requests, bool fails) {
    const std::optional<WindowImage> image = swapchain_.acquire(window_.pixels());
    if (!image) return false;
    if (state.labeling) thumbnails_.follow(*state.labeling, interface_renderer_);
    requests = interface_.lay_out(state, image->extent);
    renderer_.begin(state.times);
    follow(state);
    record_scene(state, fails);
    record(*image);
    renderer_.submit(image->order);
    swapchain_.present(*image);
    return true;
}

void Session::record(const WindowImage& image) {
    Stream& stream = renderer_.stream();
    stream.transition(image.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, k_image_acquired);
    renderer_.blit(image.image, interface_.view().pixels);
    stream.transition(image.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                      VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, k_scene_copied);
    interface_renderer_.record(stream, interface_.drawing(), image.view, image.extent);
    stream.transition(image.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                      VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, k_interface_drawn);
}

/// The main loop, from events of the window to frames.
class Viewer {
  public:
    explicit Viewer(const ViewerOptions& options)
        : options_(options), window_(options.size, "Exemplar"), interface_(window_) {
        state_.show_panels = !options.plain_window;
        const VkExtent2D pixels = window_.pixels();
        open_files(state_, options, {static_cast<int>(pixels.width), static_cast<int>(pixels.height)});
        set_title();
    }

    /// Runs until the window is closed. Opens a lost device again, a few times.
    void run();

  private:
    void run_session(Session& session);
    void wait_for_work();
    void save(const std::string& extension, const std::function<void(const std::filesystem::path&)>& write);
    void perform(Action action, Session& session);
    void start_hatching();
    void paint(const InterfaceRequests& requests, Session& session);
    void open(const std::filesystem::path& path);
    void set_title();
    bool ended() const {
        return window_.closing() || interrupted() || (options_.frames > 0 && frames_ >= options_.frames);
    }

    Clock::time_point start_ = Clock::now(), last_ = start_;
    const ViewerOptions& options_;
    Window window_;
    Interface interface_;
    ViewerState state_;
    std::size_t frames_ = 0;
    PaintGesture gesture_;
    int restless_ = k_settling_frames;
    bool fitted_ = false, lost_ = false, failed_ = false;
};

void Viewer::set_title() {
    window_.set_title(state_.has_document() ? state_.document().animation.name + " - Exemplar" : "Exemplar");
}

void Viewer::open(const std::filesystem::path& path) {
    const ViewSize view = interface_.view().size();
    try {
        state_.open(path, view);
    } catch (const Error& error) {
        state_.messages.error(error.what());
    }
    set_title();
}

// Waits for events while nothing moves, so that an idle viewer takes no CPU time.
void Viewer::wait_for_work() {
    constexpr double k_idle_seconds = 0.5, k_progress_seconds = 0.1;
    const bool busy = (state_.playback.playing() && state_.playback.frame_count() > 1) || options_.frames > 0;
    const bool labels = state_.labeling && (state_.labeling->job() || state_.labeling->painter().busy());
    const bool works = state_.training || state_.hatching_job || labels;
    const bool waits = !busy && restless_ <= 0;
    const bool event = waits ? window_.wait(works ? k_progress_seconds : k_idle_seconds) : window_.poll();
    if (event) restless_ = k_settling_frames;
    if (works || !state_.messages.all().empty()) restless_ = std::max(restless_, 1);
    --restless_;
}

// Saves in the working folder, without replacing earlier files.
void Viewer::save(const std::string& extension, const std::function<void(const std::filesystem::path&)>& write) {
    const std::filesystem::path path = free_names(state_.document().path.stem().string(), {extension})[0];
    try {
        write(path);
        state_.messages.remark(fmt::format("Saved {}", std::filesystem::absolute(path).string()));
    } catch (const Error& error) {
        state_.messages.error(error.what());
    }
}

void Viewer::start_hatching() {
    const std::string stem = state_.document().path.stem().string() + "_hatched";
    try {
        state_.start_hatching(interface_.view().size(), options_.device, [stem] {
            return free_names(stem, {".svg", ".png"});
        });
    } catch (const Error& error) {
        state_.messages.error(error.what());
    }
}

void Viewer::perform(Action action, Session& session) {
    restless_ = k_settling_frames;
    if (action == Action::quit) {
        window_.close();
    } else if (action == Action::save_png && state_.has_document()) {
        save(".png", [&](const std::filesystem::path& path) { write_png(path, session.picture()); });
    } else if (action == Action::save_svg && state_.has_document()) {
        save(".svg", [&](const std::filesystem::path& path) { save_svg(path, state_, interface_.view().size()); });
    } else if (action == Action::save_hatching && state_.has_document()) {
        start_hatching();
    } else if (action == Action::save_model && state_.model()) {
        save(".safetensors", [&](const std::filesystem::path& path) { save_curvature_model(path, *state_.model()); });
    } else {
        state_.perform(action, interface_.view().size());
        if (state_.labeling) set_title();
    }
}

// Paints along the mouse, and opens the shape that was chosen.
void Viewer::paint(const InterfaceRequests& requests, Session& session) {
    if (requests.start_labeling && state_.has_document())
        state_.try_labeling([&] { state_.start_labeling(state_.document().path, {}, interface_.view().size()); });
    if (!state_.labeling) return;
    for (const PaintEvent& event : requests.paint) {
        restless_ = k_settling_frames;
        state_.try_labeling([&] {
            const FacePicture& faces = session.faces(state_);
            if (event.kind == PaintEvent::Kind::press) gesture_.press(*state_.labeling, faces, event.at);
            if (event.kind == PaintEvent::Kind::drag) gesture_.drag(*state_.labeling, faces, event.at);
            if (event.kind == PaintEvent::Kind::release) gesture_.release(*state_.labeling, faces);
        });
    }
    if (!requests.shape) return;
    state_.try_labeling([&] { state_.open_shape(*requests.shape, interface_.view().size()); });
    set_title();
}

void Viewer::run_session(Session& session) {
    while (!ended()) {
        wait_for_work();
        const Clock::time_point now = Clock::now();
        const double seconds = std::chrono::duration<double>(now - std::exchange(last_, now)).count();
        state_.playback.advance(seconds);
        state_.messages.advance(seconds);
        state_.collect_training();
        state_.collect_hatching();
        if (state_.collect_labeling()) restless_ = k_settling_frames;
        window_.set_painting(state_.labeling != nullptr);
        for (const std::filesystem::path& path : window_.take_drops()) open(path);
        InterfaceRequests requests;
        if (!session.draw(state_, requests, options_.failing_frame == frames_ && !std::exchange(failed_, true))) {
            window_.wait(0.1);
            restless_ = k_settling_frames;  // draws as soon as the window can show it
            continue;
        }
        if (!options_.quiet && frames_ == 0)
            fmt::print("first frame after {:.0f} ms on {}\n",
                       1e3 * std::chrono::duration<double>(Clock::now() - start_).count(),
                       session.device().info().name);
        ++frames_;
        if (options_.losing_frame == frames_ && !std::exchange(lost_, true))
            throw DeviceLostError("the device was lost, as the command line asked for");
        for (const std::filesystem::path& path : requests.open) open(path);
        paint(requests, session);
        for (const Action action : requests.actions) perform(action, session);
        for (const Action action : window_.take_actions()) perform(action, session);
        // Fits only now that the size of the panels is known.
        if (!std::exchange(fitted_, true)) state_.fit(interface_.view().size());
        require_no_validation_messages(*session.device().validation_log());
    }
}

void Viewer::run() {
    constexpr int k_max_losses = 3;
    int losses = 0;
    while (!ended()) {
        std::shared_ptr<const ValidationLog> log;
        try {
            Session session(window_, interface_, options_.device);
            log = session.device().validation_log();
            run_session(session);
        } catch (const UndrawableError& error) {
            if (!state_.has_document()) throw;
            state_.messages.error(error.what());
            state_.close();
            set_title();
        } catch (const DeviceLostError& error) {
            if (++losses > k_max_losses) throw;
            state_.messages.error(error.what());
        } catch (const SurfaceLostError& error) {
            if (++losses > k_max_losses) throw;
            state_.messages.error(error.what());
        }
        if (log) require_no_validation_messages(*log);
    }
    check_interrupt();
}

}  // namespace

void run_window(const ViewerOptions& options) {
    Viewer(options).run();
}

}  // namespace exemplar
