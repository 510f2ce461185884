#include "host/parts/rigging/joint_error.h"

#include <algorithm>
#include <limits>

namespace exemplar {
namespace {

struct NamedJoint {
    std::array<std::string, 2> labels;
    Vec3 head;
};

std::vector<NamedJoint> named_joints(const LabeledSkeleton& labeled) {
    const auto label_of = [&](std::uint32_t joint) {
        const std::int32_t label = labeled.graph.parts[labeled.skeleton.joints[joint].part].label;
        return label < 0 ? std::string() : labeled.names.at(static_cast<std::size_t>(label));
    };
    std::vector<NamedJoint> joints;
    joints.reserve(labeled.skeleton.joints.size());
    for (std::uint32_t j = 1; j < labeled.skeleton.joints.size(); ++j) {
        NamedJoint joint{{label_of(j), label_of(labeled.skeleton.joints[j].parent)}, labeled.skeleton.joints[j].head};
        std::sort(joint.labels.begin(), joint.labels.end());
        joints.push_back(joint);
    }
    return joints;
}

}  // namespace

std::vector<JointError> joint_errors(const LabeledSkeleton& truth, const LabeledSkeleton& found) {
    const std::vector<NamedJoint> expected = named_joints(truth), given = named_joints(found);
    std::vector<JointError> errors;
    errors.reserve(expected.size());
    for (const NamedJoint& joint : expected) errors.push_back({joint.labels, {}});
    std::vector<bool> taken(given.size(), false);
    while (true) {
        std::size_t best = expected.size(), partner = 0;
        float nearest = std::numeric_limits<float>::infinity();
        for (std::size_t e = 0; e < expected.size(); ++e)
            for (std::size_t g = 0; g < given.size(); ++g) {
                if (errors[e].distance || taken[g] || expected[e].labels != given[g].labels) continue;
                const float distance = (expected[e].head - given[g].head).norm();
                if (distance >= nearest) continue;
                nearest = distance;
                best = e;
                partner = g;
            }
        if (best == expected.size()) return errors;
        errors[best].distance = nearest;
        taken[partner] = true;
    }
}

}  // namespace exemplar
