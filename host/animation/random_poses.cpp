#include "host/animation/random_poses.h"

#include "host/core/random.h"

namespace exemplar {

Clip random_expressions(const Rig& rig, std::size_t poses, std::uint64_t seed) {
    constexpr std::size_t k_max_active = 4;
    Clip clip;
    clip.name = "random";
    Random random(seed);
    for (std::size_t i = 0; i < poses; ++i) {
        Pose pose = rest_pose(rig);
        for (std::size_t active = random.index(k_max_active) + 1; active > 0 && !rig.targets.empty(); --active)
            pose.weights[random.index(rig.targets.size())] = static_cast<float>(1 - random.uniform());
        clip.poses.push_back(std::move(pose));
    }
    return clip;
}

}  // namespace exemplar
