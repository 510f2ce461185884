#include "host/hatching/features/line_images.h"

#include <cmath>

#include "host/hatching/features/line_directions.h"

namespace exemplar {
namespace {

LineThresholds thresholds_of(LineType type, float threshold) {
    LineThresholds thresholds;
    if (type == LineType::suggestive_contours) thresholds.suggestive_contours = threshold;
    if (type == LineType::ridges || type == LineType::valleys) thresholds.ridges_valleys = threshold;
    if (type == LineType::apparent_ridges) thresholds.apparent_ridges = threshold;
    return thresholds;
}

Vec3 point_in(const TriangleMesh& mesh, std::uint32_t face, const std::array<float, 3>& weights) {
    Vec3 point = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) point += weights[k] * mesh.vertices[mesh.faces[face][k]];
    return point;
}

/// Adds length times opacity of a straight line, in steps of half a pixel, each distributed bilinearly to four
/// pixels.
void deposit(const Vec2& from, const Vec2& to, float opacity, FloatImage& image) {
    const float length = (to - from).norm();
    const int steps = std::max(1, static_cast<int>(std::ceil(2 * length)));
    for (int s = 0; s < steps; ++s) {
        const float t = (static_cast<float>(s) + 0.5f) / static_cast<float>(steps);
        const Vec2 at = from + t * (to - from) - Vec2::Constant(0.5f);
        const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
        const float u = at.x() - static_cast<float>(x), v = at.y() - static_cast<float>(y);
        const float amount = opacity * length / static_cast<float>(steps);
        for (int k = 0; k < 4; ++k) {
            const int px = x + k % 2, py = y + k / 2;
            if (px < 0 || py < 0 || px >= image.width || py >= image.height) continue;
            image.pixel(px, py)[0] += amount * (k % 2 ? u : 1 - u) * (k / 2 ? v : 1 - v);
        }
    }
}

}  // namespace

const char* line_kind_name(std::size_t kind) {
    constexpr std::array<const char*, k_line_kinds> k_names{"contours", "ridges", "valleys", "apparent_ridges"};
    return k_names[kind];
}

float line_threshold(std::size_t kind, std::size_t step) {
    const float first = kind == 0 || kind == 2 ? -3.0f : -2.0f;
    const float share = static_cast<float>(step) / static_cast<float>(k_line_thresholds - 1);
    return std::pow(10.0f, first + share * (-1 - first));
}

LineImages::LineImages(const HatchingSurface& surface, const HatchingView& view)
    : surface_(surface), view_(view), visibility_(line_surface(surface)) {}

std::vector<LineSegment> LineImages::segments(LineType type, float threshold) const {
    LineOptions options;
    options.parallel_eye = view_.camera.projection(3, 3) != 0;
    options.eye = options.parallel_eye ? view_.camera.to_eye(Vec3::Zero()) : view_.camera.position();
    options.feature_size = surface_.feature_size;
    options.thresholds = thresholds_of(type, threshold);
    return extract_lines(line_surface(surface_), type, options);
}

void LineImages::add(LineType type, float threshold, FloatImage& image) const {
    const std::vector<LineSegment> found = segments(type, threshold);
    const VisibleParts visible = visibility_.visible_parts(type, found, view_.camera, view_.width, view_.height);
    const LineThresholds thresholds = thresholds_of(type, threshold);
    for (std::size_t s = 0; s < found.size(); ++s) {
        const Vec3 a = point_in(surface_.mesh, found[s].face, found[s].ends[0]);
        const Vec3 b = point_in(surface_.mesh, found[s].face, found[s].ends[1]);
        const float strength = 0.5f * (found[s].strength[0] + found[s].strength[1]);
        const float opacity = line_opacity(type, strength, thresholds);
        for (const VisiblePart& part : visible.of(s)) {
            const auto place = [&](float t) -> Vec2 {
                return view_.camera.project(a + t * (b - a), view_.width, view_.height).head<2>();
            };
            deposit(place(part.from), place(part.to), opacity, image);
        }
    }
}

FloatImage LineImages::draw(std::size_t kind, std::size_t step) const {
    constexpr std::array<LineType, k_line_kinds> k_types{LineType::suggestive_contours, LineType::ridges,
                                                         LineType::valleys, LineType::apparent_ridges};
    FloatImage image(view_.width, view_.height, 1);
    const float threshold = line_threshold(kind, step);
    if (kind == 0) add(LineType::contours, threshold, image);
    add(k_types[kind], threshold, image);
    return image;
}

}  // namespace exemplar
