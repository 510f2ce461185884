#include "apps/viewer/scene/hatched_still.h"

#include <fmt/format.h>

#include <utility>

#include "apps/viewer/scene/options.h"
#include "apps/viewer/scene/viewer_state.h"
#include "gpu/hatching/hatching_device.h"
#include "host/core/errors.h"
#include "host/hatching/features/surface_cache.h"
#include "host/hatching/view_hatching.h"
#include "host/imaging/png.h"
#include "host/mesh/editing/loose_vertices.h"

namespace exemplar {
namespace {

// Adapts a line style to hatching, which is black on white: makes pale lines black.
DrawingStyle on_white(DrawingStyle look) {
    constexpr int k_pale = 128;
    for (LineStyle& line : look.lines) {
        const Color& c = line.color;
        if (2 * c[0] + 5 * c[1] + c[2] > 8 * k_pale) line.color = {0, 0, 0};  // about the eye's weights
    }
    return look;
}

HatchedDrawing draw_on(HatchingDevice& device, const HatchedStill& still,
                       const std::function<void(const char*)>& step) {
    step("measuring the surface");
    const HatchingSurface surface = cached_surface(still.mesh, default_surface_folder());
    step("hatching");
    PixelFeatures pixels(surface, still.view, device.tools().images);
    HatchingStyle style = *still.hatching;
    style.resize(still.view.width, still.view.height);
    ViewHatching hatching = hatch_view(style, pixels, device.tools());
    step("drawing lines");
    taper_strokes(hatching.strokes, style.taper);
    return {still.view.width, still.view.height, std::move(hatching.strokes),
            feature_curves(surface, still.view, still.curves, still.look, still.unit_depth)};
}

}  // namespace

HatchedStill hatched_still(const ViewerState& state, ViewSize size, const std::string& device) {
    if (!state.has_document()) throw UsageError("there is nothing to hatch: open a mesh or an animation first");
    if (!state.hatching())
        throw UsageError(
            "no style of hatching is open; drop one of 'exemplar hatch train' here, or start with --hatching");
    HatchedStill still;
    still.hatching = state.hatching();
    still.mesh = state.document().animation.rest;
    still.mesh.vertices = vertices_of(state.document().animation, state.shape());
    still.mesh = without_loose_vertices(still.mesh);
    still.view.camera = state.camera.camera(size);
    still.view.light = default_light(still.view.camera);
    still.view.width = size.width;
    still.view.height = size.height;
    still.unit_depth = state.camera.distance();
    still.curves = state.settings.shown_lines();
    still.look = on_white(state.settings.style);
    still.title = state.document().animation.name;
    still.device = device;
    return still;
}

HatchedDrawing draw_still(const HatchedStill& still, const std::function<void(const char*)>& step) {
    HatchedDrawing drawing;
    std::shared_ptr<const ValidationLog> log;
    {
        HatchingDevice device({.name = still.device});
        log = device.device().validation_log();
        drawing = draw_on(device, still, step);
    }
    require_no_validation_messages(*log);  // includes messages from the end of the device
    return drawing;
}

void require_still_name(const std::filesystem::path& path) {
    const std::filesystem::path extension = path.extension();
    if (extension != ".svg" && extension != ".png")
        throw UsageError(fmt::format("{}: give a name that ends in .svg or .png", path.string()));
}

void write_still(const std::filesystem::path& path, const HatchedStill& still, const HatchedDrawing& drawing) {
    require_still_name(path);
    if (path.extension() == ".svg")
        write_hatching_svg(path, drawing, still.look, {.title = still.title});
    else
        write_png(path, hatching_picture(drawing, still.look));
}

}  // namespace exemplar
