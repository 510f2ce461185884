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
constexpr int k_region_rounds = 4;
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

}  // namespace

std::vector<OutlineFit> register_view(const TriangleMesh& mesh, const FloatImage& darkness,
                                      const RegistrationOptions& options) {
    const float picture = static_cast<float>(std::max(darkness.width, darkness.height));
    const ScaledDrawing whole = scaled_drawing(darkness, 1, 0.7f * picture);
    if (whole.region.empty()) throw DataError("nothing is drawn; give dark strokes on light paper");
    const PoseFrame frame = pose_frame(mesh, darkness.width, darkness.height);
    const DrawnLines lines = drawn_lines(whole.darkness, whole.region);
    const ScaledDrawing small = scaled_drawing(darkness, std::min(1.0f, k_region_size / whole.size), k_region_size);
    const PoseFrame little = frame.resized(small.darkness.width, small.darkness.height);
    const TriangleMesh simple = search_mesh(mesh);
    const std::vector<RegionFit> starts =
        options.start ? search_near(simple, little, options.start->scaled(small.scale), small.region, small.size,
                                    k_promising, options.step)
                      : search_views(simple, little, small.region, small.size, k_promising, options.step);
    std::vector<OutlineFit> fits;
    for (const RegionFit& start : starts) {
        const RegionFit near =
            fit_to_region(mesh, frame, start.pose.scaled(1 / small.scale), whole.region, whole.size, k_region_rounds);
        fits.push_back(fit_to_lines(mesh, frame, near.pose, lines, whole.size));
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

}  // namespace exemplar
