#include "host/hatching/animation/advected_strokes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/hatching/placement/placement_grid.h"

namespace exemplar {
namespace {

constexpr float k_farthest_tear = 16;        // pixels
constexpr float k_depth_share = 1 / 200.0f;  // as of occlusion_barriers

void check_view_size(const HatchingView& view, const GBuffer& gbuffer) {
    if (gbuffer.width != view.width || gbuffer.height != view.height)
        throw UsageError(fmt::format("the G-buffer is of {} x {} pixels, the view of {} x {}", gbuffer.width,
                                     gbuffer.height, view.width, view.height));
}

/// Returns the pixel that contains a point of the picture.
std::optional<std::size_t> pixel_of(const GBuffer& gbuffer, const Vec2& point) {
    const bool inside = point.x() >= 0 && point.y() >= 0 && point.x() < static_cast<float>(gbuffer.width) &&
                        point.y() < static_cast<float>(gbuffer.height);
    if (!inside) return std::nullopt;
    return gbuffer.index(static_cast<int>(point.x()), static_cast<int>(point.y()));
}

/// A mesh in a view: faces in homogeneous picture coordinates.
class ProjectedMesh {
  public:
    ProjectedMesh(const TriangleMesh& mesh, const HatchingView& view, const GBuffer& gbuffer)
        : mesh_(mesh), view_(view), gbuffer_(gbuffer), view_projection_(view.camera.view_projection()) {
        check_view_size(view, gbuffer);
    }

    SurfacePoint place(const Vec2& point) const {
        const auto pixel = pixel_of(gbuffer_, point);
        if (!pixel || gbuffer_.face[*pixel] == k_no_face) return {};
        SurfacePoint place{gbuffer_.face[*pixel], gbuffer_.barycentric[*pixel], true};
        const Eigen::Matrix3d corners = corners_of(place.face);
        place.counter_clockwise = corners.determinant() < 0;  // y is down
        const double x = 2.0 * point.x() / view_.width - 1, y = 2.0 * point.y() / view_.height - 1;
        const Eigen::Vector3d shares = corners.fullPivLu().solve(Eigen::Vector3d(x, y, 1));
        const double sum = shares.sum();
        if (!shares.allFinite() || !(std::abs(sum) > 0)) return place;
        const SurfacePoint exact{place.face,
                                 {static_cast<float>(shares[1] / sum), static_cast<float>(shares[2] / sum)},
                                 place.counter_clockwise};
        return is_near(exact, place) ? exact : place;
    }

    Vec3 position(const SurfacePoint& place) const {
        const Face& face = mesh_.faces[place.face];
        const auto& [b, c] = place.barycentric;
        return (1 - b - c) * mesh_.vertices[face[0]] + b * mesh_.vertices[face[1]] + c * mesh_.vertices[face[2]];
    }
    bool is_back_facing(const SurfacePoint& place) const {
        return (corners_of(place.face).determinant() < 0) != place.counter_clockwise;
    }
    const GBuffer& gbuffer() const { return gbuffer_; }
    const HatchingView& view() const { return view_; }
    std::size_t face_count() const { return mesh_.face_count(); }

  private:
    /// Returns x, y and w in clip space, one column per corner.
    Eigen::Matrix3d corners_of(std::uint32_t f) const {
        Eigen::Matrix3d corners;
        for (int k = 0; k < 3; ++k) {
            const Eigen::Vector4d at =
                view_projection_.cast<double>() *
                mesh_.vertices[mesh_.faces[f][static_cast<std::size_t>(k)]].cast<double>().homogeneous();
            corners.col(k) = Eigen::Vector3d(at.x(), at.y(), at.w());
        }
        return corners;
    }
    /// Returns whether two points are at most eight pixels apart, for pixels of the size that they have at `b`.
    bool is_near(const SurfacePoint& a, const SurfacePoint& b) const {
        const Vec3 from = position(b);
        const float w = (view_projection_ * from.homogeneous()).w();
        const float pixel = 2 * w / (static_cast<float>(view_.height) * std::abs(view_.camera.projection(1, 1)));
        return (position(a) - from).norm() <= 8 * pixel;
    }

    const TriangleMesh& mesh_;
    const HatchingView& view_;
    const GBuffer& gbuffer_;
    Eigen::Matrix4f view_projection_;
};

float depth_tolerance(const GBuffer& gbuffer) {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (const float depth : gbuffer.depth) {
        if (!std::isfinite(depth)) continue;
        low = std::min(low, depth);
        high = std::max(high, depth);
    }
    return high > low ? k_depth_share * (high - low) : 0.0f;
}

class StrokeAdvection {
  public:
    StrokeAdvection(const TriangleMesh& mesh, const HatchingView& view, const GBuffer& gbuffer)
        : seen_(mesh, view, gbuffer), tolerance_(depth_tolerance(gbuffer)) {}

    std::vector<AdvectedStroke> carry(const SurfaceStroke& stroke) const {
        std::vector<AdvectedStroke> parts;
        bool goes_on = false;
        for (std::size_t i = 0; i < stroke.places.size(); ++i) {
            const std::optional<Vec2> point = shown(stroke.places[i]);
            if (goes_on && point) goes_on = (*point - parts.back().stroke.points.back()).norm() <= k_farthest_tear;
            if (point && !goes_on) {
                parts.emplace_back().stroke.layer = stroke.layer;
                parts.back().is_whole[0] = i == 0;
            }
            if (point) parts.back().stroke.points.push_back(*point);
            if (point) parts.back().is_whole[1] = i + 1 == stroke.places.size();
            goes_on = point.has_value();
        }
        std::erase_if(parts, [](const AdvectedStroke& part) { return part.stroke.points.size() < 2; });
        for (AdvectedStroke& part : parts) extend_to_whole_steps(part.stroke.points);
        return parts;
    }

  private:
    /// Returns where the picture shows a point of the surface, if it is visible.
    std::optional<Vec2> shown(const SurfacePoint& place) const {
        if (place.face == k_no_face) return std::nullopt;
        if (place.face >= seen_.face_count())
            throw UsageError(fmt::format("a stroke lies on face {}; there are {}", place.face, seen_.face_count()));
        if (seen_.is_back_facing(place)) return std::nullopt;
        const HatchingView& view = seen_.view();
        const Vec3 at = seen_.position(place);
        const float depth = -(view.camera.view * at.homogeneous()).z();
        const Vec2 point = view.camera.project(at, view.width, view.height).head<2>();
        const auto pixel = pixel_of(seen_.gbuffer(), point);
        if (!pixel || seen_.gbuffer().face[*pixel] == k_no_face) return std::nullopt;
        if (!(depth <= farthest_around(*pixel) + tolerance_)) return std::nullopt;
        return point;
    }

    float farthest_around(std::size_t pixel) const {
        const GBuffer& gbuffer = seen_.gbuffer();
        const int x = static_cast<int>(pixel) % gbuffer.width, y = static_cast<int>(pixel) / gbuffer.width;
        float farthest = -std::numeric_limits<float>::infinity();
        for (int j = std::max(y - 1, 0); j <= std::min(y + 1, gbuffer.height - 1); ++j) {
            for (int i = std::max(x - 1, 0); i <= std::min(x + 1, gbuffer.width - 1); ++i) {
                const float depth = gbuffer.depth[gbuffer.index(i, j)];
                if (std::isfinite(depth)) farthest = std::max(farthest, depth);
            }
        }
        return farthest;
    }

    /// Extends the last segment until the length is the nearest whole number of steps, if that is longer.
    static void extend_to_whole_steps(std::vector<Vec2>& points) {
        constexpr float k_step_pixels = static_cast<float>(k_step) / k_pixel, k_rounding = 0.01f;
        float length = 0;
        for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
        const float missing = std::round(length / k_step_pixels) * k_step_pixels - length + k_rounding;
        const Vec2 way = points.back() - points[points.size() - 2];
        if (missing > 0 && way.norm() > 0) points.back() += missing * way.normalized();
    }

    ProjectedMesh seen_;
    float tolerance_;
};

}  // namespace

std::vector<SurfaceStroke> strokes_on_surface(std::span<const HatchStroke> strokes, const TriangleMesh& mesh,
                                              const HatchingView& view, const GBuffer& gbuffer) {
    const ProjectedMesh seen(mesh, view, gbuffer);
    std::vector<SurfaceStroke> out(strokes.size());
    parallel_for(
        strokes.size(),
        [&](std::size_t i) {
            out[i].layer = strokes[i].layer;
            for (const Vec2& point : strokes[i].points) out[i].places.push_back(seen.place(point));
        },
        16);
    return out;
}

std::vector<AdvectedStroke> advected_strokes(std::span<const SurfaceStroke> strokes, const TriangleMesh& mesh,
                                             const HatchingView& view, const GBuffer& gbuffer) {
    const StrokeAdvection carrier(mesh, view, gbuffer);
    std::vector<std::vector<AdvectedStroke>> parts(strokes.size());
    parallel_for(
        strokes.size(), [&](std::size_t i) { parts[i] = carrier.carry(strokes[i]); }, 16);
    std::vector<AdvectedStroke> out;
    for (std::vector<AdvectedStroke>& some : parts) std::ranges::move(some, std::back_inserter(out));
    return out;
}

}  // namespace exemplar
