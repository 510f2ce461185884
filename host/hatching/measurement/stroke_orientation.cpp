#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/core/parallel.h"
#include "host/hatching/measurement/stroke_properties.h"
#include "host/hatching/tracing/drawing_filters.h"

namespace exemplar {
namespace {

constexpr float k_tensor_scale = 1;          ///< pixels
constexpr float k_min_tensor_window = 1.5f;  ///< standard deviation of the tensor's window, pixels
constexpr float k_edge = 1;                  ///< width of the gradient beside a stroke's edge, pixels
constexpr float k_min_own_share = 0.98f;     ///< min share of the window that is the stroke's own
constexpr float k_min_coherence = 0.5f;      ///< min coherence of the tensor: 1 for parallel edges, 0 if isotropic

struct Tensor {
    float xx = 0, xy = 0, yy = 0;

    float coherence() const {
        const float sum = xx + yy;
        return sum > 0 ? std::hypot(xx - yy, 2 * xy) / sum : 0;
    }
    /// Returns the direction in which the image changes least, in [0, pi).
    float orientation() const {
        const float across = 0.5f * std::atan2(2 * xy, xx - yy);
        return across + (across < std::numbers::pi_v<float> / 2 ? std::numbers::pi_v<float> / 2
                                                                : -std::numbers::pi_v<float> / 2);
    }
};

/// The tensor around a point, and the share of its window, within the stroke and its edges, that is the stroke's own.
struct OwnTensor {
    Tensor tensor;
    float share = 0;
};

OwnTensor tensor_at(const ImageGradient& gradient, const StrokeMap& map, const PixelMask& crossing_pixels,
                    const TracedPoint& point, std::int32_t stroke, float width) {
    const float scale = std::max(k_min_tensor_window, width);
    const int reach = static_cast<int>(std::ceil(2 * scale));
    const auto [cx, cy] = map.pixel_of(point);
    const Vec2 across(-std::sin(point.orientation), std::cos(point.orientation));
    Tensor tensor;
    float own = 0, all = 0;
    for (int y = std::max(0, cy - reach); y <= std::min(gradient.x.height - 1, cy + reach); ++y)
        for (int x = std::max(0, cx - reach); x <= std::min(gradient.x.width - 1, cx + reach); ++x) {
            const Vec2 way = center_of({x, y}) - point.center;
            const float weight = std::exp(-0.5f * way.squaredNorm() / (scale * scale));
            const bool on_stroke = std::abs(across.dot(way)) <= 0.5f * width + k_edge;
            if (on_stroke) all += weight;
            if (crossing_pixels.pixel(x, y)[0] || map.nearest(x, y).stroke != stroke) continue;
            if (on_stroke) own += weight;
            const float gx = gradient.x.pixel(x, y)[0], gy = gradient.y.pixel(x, y)[0];
            tensor.xx += weight * gx * gx;
            tensor.xy += weight * gx * gy;
            tensor.yy += weight * gy * gy;
        }
    return {tensor, all > 0 ? own / all : 0};
}

}  // namespace

void measure_orientations(const FloatImage& darkness, const StrokeMap& map, const PixelMask& crossing_pixels,
                          std::span<TracedStroke> strokes) {
    const ImageGradient gradient = gaussian_gradient(darkness, k_tensor_scale);
    parallel_for(
        strokes.size(),
        [&](std::size_t s) {
            for (TracedPoint& point : strokes[s].points) {
                if (point.at_crossing) continue;
                const OwnTensor own =
                    tensor_at(gradient, map, crossing_pixels, point, static_cast<std::int32_t>(s), strokes[s].width);
                if (own.share < k_min_own_share || own.tensor.coherence() < k_min_coherence) continue;
                point.orientation = own.tensor.orientation();
                point.oriented = true;
            }
        },
        8);
}

}  // namespace exemplar
