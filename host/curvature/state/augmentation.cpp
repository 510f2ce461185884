#include "host/curvature/state/augmentation.h"

#include <cmath>
#include <numbers>

#include "host/core/random.h"

namespace exemplar {

namespace {

using Eigen::Quaternionf;

/// Probability that a blend shape takes a random weight in [0, 1] instead of its weight in a frame.
constexpr double k_free_weight = 0.08;

Vec3 random_direction(Random& random) {
    Vec3 v;
    do {
        for (Eigen::Index i = 0; i < 3; ++i) v[i] = static_cast<float>(random.normal());
    } while (!(v.norm() > 1e-3f));
    return v.normalized();
}

/// Extrapolates from `from` towards `to`, by `factor` times the shortest rotation between them.
Quaternionf stretched(const Quaternionf& from, const Quaternionf& to, float factor) {
    Eigen::AngleAxisf turn(from.conjugate() * to);
    if (turn.angle() > std::numbers::pi_v<float>) turn.angle() -= 2 * std::numbers::pi_v<float>;
    return (from * Quaternionf(Eigen::AngleAxisf(factor * turn.angle(), turn.axis()))).normalized();
}

}  // namespace

Clip augmented_poses(const Animation& animation, std::span<const FrameRef> frames, std::size_t count,
                     std::uint64_t seed, const PoseSpread& spread) {
    Random random(seed);
    const auto any_pose = [&]() -> const Pose& {
        const FrameRef frame = frames[random.index(frames.size())];
        return animation.clips[frame.clip].poses[frame.frame];
    };
    const Pose& middle = animation.clips[frames[frames.size() / 2].clip].poses[frames[frames.size() / 2].frame];
    Clip clip;
    clip.name = "augmented";
    for (std::size_t i = 0; i < count; ++i) {
        Pose pose = any_pose();
        for (std::size_t node = 0; node < pose.nodes.size(); ++node) {
            const auto factor = static_cast<float>(random.uniform(spread.min_stretch, spread.max_stretch));
            const Eigen::AngleAxisf perturbation(static_cast<float>(spread.perturbation * random.normal()),
                                                 random_direction(random));
            pose.nodes[node].rotation =
                (stretched(middle.nodes[node].rotation, any_pose().nodes[node].rotation, factor) *
                 Quaternionf(perturbation))
                    .normalized();
        }
        for (std::size_t target = 0; target < pose.weights.size(); ++target)
            pose.weights[target] =
                random.uniform() < k_free_weight ? static_cast<float>(random.uniform()) : any_pose().weights[target];
        clip.poses.push_back(std::move(pose));
    }
    return clip;
}

}  // namespace exemplar
