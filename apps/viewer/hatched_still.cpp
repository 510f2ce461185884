#include "apps/viewer/hatched_still.h"

#include <fmt/format.h>

#include "apps/viewer/viewer_state.h"
#include "gpu/hatching/hatching_device.h"
#include "host/core/errors.h"
#include "host/imaging/png.h"

namespace exemplar {

HatchedStill hatched_still(const ViewerState& state, ViewSize size, const std::string& device) {
    if (!state.hatching())
        throw UsageError(
            "no style of hatching is open; drop one of 'exemplar hatch train' here, or start with --hatching");
    HatchedStill still;
    still.hatching = state.hatching();
    still.mesh = state.document().animation.rest;
    still.mesh.vertices = vertices_at(state.document(), state.moment());
    still.view.camera = state.camera.camera(size);
    still.view.light = usual_light(still.view.camera);
    still.view.width = size.width;
    still.view.height = size.height;
    still.unit_depth = state.camera.distance();
    still.curves = state.settings.shown_lines();
    still.look = state.settings.style;
    still.title = state.document().animation.name;
    still.device = device;
    return still;
}

HatchedDrawing draw_still(const HatchedStill& still, const std::function<void(const char*)>& step) {
    constexpr float k_taper = 6;  // pixels, as 'exemplar hatch draw' has it
    step("measuring the surface");
    const HatchingSurface surface = measure_surface(still.mesh);
    step("hatching");
    HatchingDevice device({.name = still.device});
    PixelFeatures pixels(surface, still.view, device.tools().images);
    ViewHatching hatching = hatch_view(*still.hatching, pixels, device.tools());
    step("drawing lines");
    taper_strokes(hatching.strokes, k_taper);
    return {still.view.width, still.view.height, std::move(hatching.strokes),
            feature_curves(surface, still.view, still.curves, still.look, still.unit_depth)};
}

void write_still(const std::filesystem::path& path, const HatchedStill& still, const HatchedDrawing& drawing) {
    const std::filesystem::path extension = path.extension();
    if (extension == ".svg")
        write_hatching_svg(path, drawing, still.look, {.title = still.title});
    else if (extension == ".png")
        write_png(path, hatching_picture(drawing, still.look));
    else
        throw UsageError(fmt::format("{}: give a name that ends in .svg or .png", path.string()));
}

}  // namespace exemplar
