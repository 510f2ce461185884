#include "host/synth/modeling/field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace exemplar {
namespace {

constexpr float k_far = 1e9f;

/// Returns the minimum of a and b; a parabola rounds its kink where |a - b| < width.
float smooth_min(float a, float b, float width) {
    const float overlap = std::max(width - std::abs(a - b), 0.0f);
    return std::min(a, b) - (width > 0 ? overlap * overlap / (4 * width) : 0.0f);
}

}  // namespace

ImplicitField::ImplicitField(std::vector<Primitive> primitives) : primitives_(std::move(primitives)) {
    low_ = Vec3::Constant(k_far);
    high_ = -low_;
    for (const Primitive& primitive : primitives_) {
        const auto to_world = [&](const Ball& local) -> Ball {
            const Vec3 center = primitive.origin + primitive.axes * local.center.cwiseProduct(primitive.stretch);
            return {center, local.radius * primitive.stretch.maxCoeff()};
        };
        balls_.push_back(to_world(bounding_ball(primitive.solid)));
        largest_blend_ = std::max(largest_blend_, primitive.blend);
        for (const Ball& local : covering_balls(primitive.solid)) {
            const Ball ball = to_world(local);
            low_ = low_.cwiseMin(ball.center - Vec3::Constant(ball.radius + primitive.blend));
            high_ = high_.cwiseMax(ball.center + Vec3::Constant(ball.radius + primitive.blend));
        }
    }
}

float ImplicitField::distance_to(std::size_t i, const Vec3& p) const {
    const Primitive& primitive = primitives_[i];
    const Vec3 local = (primitive.axes.transpose() * (p - primitive.origin)).cwiseQuotient(primitive.stretch);
    return solid_distance(primitive.solid, local) * primitive.stretch.minCoeff();
}

float ImplicitField::value(const Vec3& p) const {
    float result = k_far;
    for (std::size_t i = 0; i < primitives_.size(); ++i) {
        const float reach = result + primitives_[i].blend + balls_[i].radius;
        // A primitive farther away than the current value plus its blend cannot change it.
        if (result < k_far && reach > 0 && (p - balls_[i].center).squaredNorm() > reach * reach) continue;
        result = smooth_min(result, distance_to(i, p), primitives_[i].blend);
    }
    return result;
}

float ImplicitField::value(const Vec3& p, std::span<const std::uint32_t> active) const {
    float result = k_far;
    for (const std::uint32_t i : active) result = smooth_min(result, distance_to(i, p), primitives_[i].blend);
    return result;
}

std::vector<std::uint32_t> ImplicitField::active_near(const Vec3& p, float radius,
                                                      std::span<const std::uint32_t> active) const {
    std::vector<float> distance;
    float result = k_far;
    for (const std::uint32_t i : active) {
        distance.push_back(distance_to(i, p));
        result = smooth_min(result, distance.back(), primitives_[i].blend);
    }
    std::vector<std::uint32_t> near;
    for (std::size_t i = 0; i < active.size(); ++i)
        if (distance[i] < result + 2.5f * radius + largest_blend_) near.push_back(active[i]);
    return near;
}

Vec3 ImplicitField::normal(const Vec3& p, float step) const {
    static const std::array<Vec3, 4> corners{Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)};
    Vec3 gradient = Vec3::Zero();
    for (const Vec3& corner : corners) gradient += corner * value(p + step * corner);
    const float length = gradient.norm();
    return length > 0 ? Vec3(gradient / length) : Vec3(Vec3::Zero());
}

Vec3 ImplicitField::project(Vec3& p, float reach) const {
    const float step = 0.02f * reach;
    const Vec3 start = p;
    Vec3 direction = Vec3::Zero();
    for (int iteration = 0; iteration < 4; ++iteration) {
        const float here = value(p);
        direction = normal(p, step);
        // Flattened primitives have gradients below 1, so the slope along the direction is measured.
        const float slope = (value(p + step * direction) - here) / step;
        const float move = here / std::clamp(slope, 0.25f, 1.5f);
        p -= direction * std::clamp(move, -reach, reach);
        if (std::abs(move) < 1e-3f * reach) break;
    }
    const Vec3 offset = p - start;
    if (offset.norm() > reach) p = start + offset * (reach / offset.norm());
    return direction;
}

std::int32_t ImplicitField::dominant_part(const Vec3& p) const {
    float least = std::numeric_limits<float>::infinity();
    std::int32_t part = 0;
    for (std::size_t i = 0; i < primitives_.size(); ++i) {
        if ((p - balls_[i].center).norm() - balls_[i].radius > least) continue;
        const float distance = distance_to(i, p);
        if (distance < least) {
            least = distance;
            part = primitives_[i].part;
        }
    }
    return part;
}

}  // namespace exemplar
