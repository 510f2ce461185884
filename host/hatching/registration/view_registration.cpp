#include "host/hatching/registration/view_registration.h"

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/hatching/drawing/drawing_warp.h"
#include "host/hatching/drawing/placement_loss.h"
#include "host/hatching/registration/view_search.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/region_outline.h"
#include "host/mesh/editing/simplify.h"

namespace exemplar {
namespace {

constexpr float k_region_size = 96;    ///< longer side of what is drawn, in the search, pixels
constexpr std::size_t k_faces = 3000;  ///< of the mesh in the search
constexpr std::size_t k_promising = 10;
constexpr int k_region_rounds = 4, k_nearby_rounds = 8;
constexpr std::size_t k_tried_frames = 16, k_promising_frames = 3, k_last_reach_frames = 2;
static_assert(k_tried_frames + k_promising_frames == k_frame_registration_steps);
constexpr std::size_t k_views = 3;
constexpr double k_same_view = 0.1;  ///< radians between poses

/// A drawing and the region that it fills, at some scale.
struct ScaledDrawing {
    double scale = 1;
    FloatImage darkness;
    PictureRegion region;
    float size = 0;  ///< longer side of the region
};

float longer_side(const PixelMask& mask) {
    int left = mask.width, right = 0, top = mask.height, bottom = 0;
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x) {
            if (!mask.pixel(x, y)[0]) continue;
            left = std::min(left, x), right = std::max(right, x + 1);
            top = std::min(top, y), bottom = std::max(bottom, y + 1);
        }
    return static_cast<float>(std::max({right - left, bottom - top, 0}));
}

ScaledDrawing scaled_drawing(const FloatImage& darkness, double scale, float size) {
    ScaledDrawing drawing;
    drawing.scale = scale;
    const auto pixels = [&](int length) { return std::max(1, static_cast<int>(std::lround(scale * length))); };
    drawing.darkness =
        scale == 1 ? darkness
                   : warp_drawing(darkness, Similarity(scale, 0), pixels(darkness.width), pixels(darkness.height));
    const float least = scale < 1 ? 0.05f : k_smoothed_ink_darkness;
    PixelMask ink(drawing.darkness.width, drawing.darkness.height, 1);
    const FloatImage smooth = gaussian_blur(drawing.darkness, 0.7f);
    for (std::size_t i = 0; i < ink.data.size(); ++i) ink.data[i] = smooth.data[i] >= least;
    drawing.region = picture_region(inked_region(ink, size), size);
    drawing.size = longer_side(drawing.region.mask);
    return drawing;
}

TriangleMesh search_mesh(const TriangleMesh& mesh) {
    try {
        return simplify_mesh(mesh, k_faces).mesh;
    } catch (const MeshError&) {
        return mesh;  // of loose triangles
    }
}

/// A drawing as the search and the fit see it.
struct PreparedDrawing {
    ScaledDrawing whole, small;
    DrawnLines lines;
};

PreparedDrawing prepared(const FloatImage& darkness) {
    const float picture = static_cast<float>(std::max(darkness.width, darkness.height));
    ScaledDrawing whole = scaled_drawing(darkness, 1, 0.7f * picture);
    if (whole.region.empty()) throw DataError("nothing is drawn; give dark strokes on light paper");
    ScaledDrawing small = scaled_drawing(darkness, std::min(1.0f, k_region_size / whole.size), k_region_size);
    DrawnLines lines = drawn_lines(whole.darkness, whole.region);
    return {std::move(whole), std::move(small), std::move(lines)};
}

PoseFrame frame_of(const TriangleMesh& mesh, const ScaledDrawing& drawing) {
    return pose_frame(mesh, drawing.darkness.width, drawing.darkness.height);
}

/// Fits the pose that was found in the small drawing to the lines of the whole one.
OutlineFit fit_to_drawing(const TriangleMesh& mesh, const ViewPose& found, const PreparedDrawing& drawing) {
    const PoseFrame frame = frame_of(mesh, drawing.whole);
    const RegionFit near = fit_to_region(mesh, frame, found.scaled(1 / drawing.small.scale), drawing.whole.region,
                                         drawing.whole.size, k_region_rounds);
    return fit_to_lines(mesh, frame, near.pose, drawing.lines, drawing.whole.size);
}

/// A frame of an animation and the pose of its best view.
struct FrameView {
    std::size_t frame = 0;
    RegionFit fit;
};

/// Searches some frames, evenly taken, and returns them, best first.
std::vector<FrameView> searched_frames(std::size_t count, const FrameMesh& mesh_of, const ScaledDrawing& small,
                                       const std::function<void()>& step) {
    std::vector<FrameView> views;
    const std::size_t tried = std::min(count, k_tried_frames);
    for (std::size_t k = 0; k < tried; ++k) {
        const std::size_t frame = tried > 1 ? k * (count - 1) / (tried - 1) : 0;
        const TriangleMesh mesh = search_mesh(mesh_of(frame));
        const auto found = search_views(mesh, frame_of(mesh, small), small.region, small.size, 1, [] {});
        if (!found.empty()) views.push_back({frame, found[0]});
        step();
    }
    for (std::size_t k = tried; k < k_tried_frames; ++k) step();
    std::ranges::stable_sort(views, std::greater<>(), [](const FrameView& view) { return view.fit.overlap; });
    return views;
}

/// Returns the frame around a searched one that fits best, each fitted from the same pose.
FrameView best_nearby(std::size_t count, const FrameMesh& mesh_of, const ScaledDrawing& small, const FrameView& start) {
    const std::size_t reach = count / k_tried_frames + 1;
    const std::size_t begin = start.frame > reach ? start.frame - reach : 0;
    FrameView best = start;
    for (std::size_t frame = begin; frame < std::min(count, start.frame + reach + 1); ++frame) {
        const TriangleMesh mesh = search_mesh(mesh_of(frame));
        const RegionFit fit =
            fit_to_region(mesh, frame_of(mesh, small), start.fit.pose, small.region, small.size, k_nearby_rounds);
        if (fit.overlap > best.fit.overlap) best = {frame, fit};
    }
    return best;
}

}  // namespace

std::vector<OutlineFit> register_view(const TriangleMesh& mesh, const FloatImage& darkness,
                                      const RegistrationOptions& options) {
    const PreparedDrawing drawing = prepared(darkness);
    const ScaledDrawing& small = drawing.small;
    const TriangleMesh simple = search_mesh(mesh);
    const PoseFrame little = frame_of(mesh, small);
    const std::vector<RegionFit> starts =
        options.start ? search_near(simple, little, options.start->scaled(small.scale), small.region, small.size,
                                    k_promising, options.step)
                      : search_views(simple, little, small.region, small.size, k_promising, options.step);
    std::vector<OutlineFit> fits;
    for (const RegionFit& start : starts) {
        fits.push_back(fit_to_drawing(mesh, start.pose, drawing));
        options.step();
    }
    for (std::size_t i = starts.size(); i < k_promising; ++i) options.step();
    std::ranges::stable_sort(fits, {}, &OutlineFit::cost);
    std::vector<OutlineFit> best;
    for (const OutlineFit& fit : fits) {
        const auto same = [&](const OutlineFit& other) { return angle_between(fit.pose, other.pose) < k_same_view; };
        if (best.size() < k_views && std::ranges::none_of(best, same)) best.push_back(fit);
    }
    return best;
}

RegisteredFrame register_frame(std::size_t count, const FrameMesh& mesh_of, const FloatImage& darkness,
                               const std::function<void()>& step) {
    if (count == 0) throw UsageError("there are no frames to register");
    const PreparedDrawing drawing = prepared(darkness);
    std::vector<FrameView> views = searched_frames(count, mesh_of, drawing.small, step);
    views.resize(std::min(views.size(), k_promising_frames));
    RegisteredFrame best;
    for (const FrameView& view : views) {
        const FrameView near = best_nearby(count, mesh_of, drawing.small, view);
        // The overlap of silhouettes hardly tells neighboring frames apart; lines do.
        const std::size_t begin = near.frame > k_last_reach_frames ? near.frame - k_last_reach_frames : 0;
        for (std::size_t frame = begin; frame < std::min(count, near.frame + k_last_reach_frames + 1); ++frame) {
            const OutlineFit fit = fit_to_drawing(mesh_of(frame), near.fit.pose, drawing);
            if (fit.cost < best.fit.cost) best = {frame, fit};
        }
        step();
    }
    for (std::size_t i = views.size(); i < k_promising_frames; ++i) step();
    return best;
}

}  // namespace exemplar
