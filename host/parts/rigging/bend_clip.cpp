#include "host/parts/rigging/bend_clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

Eigen::Quaternionf rotation_of(const Vec3& degrees) {
    const Vec3 angle = degrees * (std::numbers::pi_v<float> / 180);
    return Eigen::AngleAxisf(angle[2], Vec3::UnitZ()) * Eigen::AngleAxisf(angle[1], Vec3::UnitY()) *
           Eigen::AngleAxisf(angle[0], Vec3::UnitX());
}

/// At most 40 bytes of text from a file, for messages.
std::string quoted_name(const std::string& text) {
    return without_controls(text.size() <= 40 ? text : text.substr(0, 37) + "...");
}

JointAngles angles_of_json(const nlohmann::json& json, const std::string& source) {
    const std::string expected = "expected an object with three angles in degrees per joint, as {\"arm\": [30, 0, 0]}";
    if (!json.is_object() || json.empty()) throw DataError(source + ": " + expected);
    JointAngles angles;
    for (const auto& [joint, value] : json.items()) {
        const auto is_angle = [](const nlohmann::json& number) {
            return number.is_number() && std::abs(number.get<double>()) <= 3600;
        };
        if (!value.is_array() || value.size() != 3 || !std::all_of(value.begin(), value.end(), is_angle))
            throw DataError(fmt::format("{}: '{}': {}", source, quoted_name(joint), expected));
        angles[joint] = Vec3(value[0].get<float>(), value[1].get<float>(), value[2].get<float>());
    }
    return angles;
}

/// The pose in which the nodes of `rig` are turned by these angles from rest.
Pose pose_of_angles(const Rig& rig, const JointAngles& angles, const std::string& source) {
    Pose pose = rest_pose(rig);
    std::vector<std::string> names;
    names.reserve(rig.nodes.size());
    for (const RigNode& node : rig.nodes) names.push_back(node.name);
    for (const auto& [joint, degrees] : angles) {
        const auto found = std::find(names.begin(), names.end(), joint);
        if (found == names.end())
            throw DataError(fmt::format("{}: the rig has no joint '{}'{}; 'exemplar label rig --json' lists its joints",
                                        source, quoted_name(joint), suggestion(joint.substr(0, 255), names)));
        NodeTransform& node = pose.nodes[static_cast<std::size_t>(found - names.begin())];
        node.rotation = (node.rotation * rotation_of(degrees)).normalized();
    }
    return pose;
}

Pose pose_between(const Pose& from, const Pose& to, float share) {
    Pose pose = from;
    for (std::size_t n = 0; n < pose.nodes.size(); ++n)
        pose.nodes[n].rotation = from.nodes[n].rotation.slerp(share, to.nodes[n].rotation).normalized();
    return pose;
}

}  // namespace

Clip bend_each_joint(const Rig& rig, double degrees, std::size_t frames_per_bend) {
    Clip clip;
    clip.name = "bend";
    const Pose rest = rest_pose(rig);
    clip.poses.push_back(rest);
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
        if (rig.nodes[n].parent == k_invalid_index) continue;
        for (const Eigen::Index axis : {0, 2})
            for (std::size_t i = 1; i <= frames_per_bend; ++i) {
                const double phase = static_cast<double>(i) / static_cast<double>(frames_per_bend);
                Vec3 angle = Vec3::Zero();
                angle[axis] = static_cast<float>(degrees * std::sin(std::numbers::pi * phase));
                if (i == frames_per_bend) angle.setZero();
                Pose pose = rest;
                pose.nodes[n].rotation = (pose.nodes[n].rotation * rotation_of(angle)).normalized();
                clip.poses.push_back(pose);
            }
    }
    return clip;
}

std::vector<JointAngles> read_poses(const std::filesystem::path& path) {
    nlohmann::json json;
    try {
        json = parse_json(read_file(path));
    } catch (const nlohmann::json::exception&) {
        throw DataError(path.string() + ": no JSON; expected joints with three angles, as {\"arm\": [30, 0, 0]}");
    }
    std::vector<JointAngles> poses;
    if (!json.is_array()) return {angles_of_json(json, path.string())};
    for (std::size_t i = 0; i < json.size(); ++i)
        poses.push_back(angles_of_json(json[i], fmt::format("{}: pose {}", path.string(), i + 1)));
    if (poses.empty()) throw DataError(path.string() + ": no poses");
    return poses;
}

Clip clip_of_poses(const Rig& rig, const std::vector<JointAngles>& poses, const std::string& source,
                   std::size_t frames_per_pose) {
    Clip clip;
    clip.name = "pose";
    clip.poses.push_back(rest_pose(rig));
    for (const JointAngles& angles : poses) {
        const Pose from = clip.poses.back(), to = pose_of_angles(rig, angles, source);
        for (std::size_t i = 1; i <= frames_per_pose; ++i)
            clip.poses.push_back(pose_between(from, to, static_cast<float>(i) / static_cast<float>(frames_per_pose)));
    }
    return clip;
}

}  // namespace exemplar
