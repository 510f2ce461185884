#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "host/synth/animations/figure.h"
#include "host/synth/animations/motion_curve.h"

namespace exemplar {
namespace {

constexpr double k_radians = std::numbers::pi / 180;
constexpr double k_figure_frame_rate = 30;

/// Signs that mirror a rotation of the left side to the right: twists and sideways motions change sign.
std::array<float, 3> mirror(const FigureJoint& joint) {
    return joint.side < 0 ? std::array{1.0f, -1.0f, -1.0f} : std::array{1.0f, 1.0f, 1.0f};
}

/// Walking motion of a joint: at phase p (radians, the left leg swings first) its first angle is middle + swing
/// sin(p + lag) degrees.
struct Gait {
    std::string_view joint;
    double middle, swing, lag;
};
constexpr double k_half = std::numbers::pi;
constexpr std::array<Gait, 8> k_gaits{{{"left_hip", 6, 26, 0},
                                       {"right_hip", 6, 26, k_half},
                                       {"left_knee", -30, 28, 1.9 + k_half},
                                       {"right_knee", -30, 28, 1.9},
                                       {"left_shoulder", 4, 26, k_half},
                                       {"right_shoulder", 4, 26, 0},
                                       {"left_elbow", 28, 18, k_half},
                                       {"right_elbow", 28, 18, 0}}};

/// One angle of one joint over time.
class AngleCurve {
  public:
    AngleCurve(const Random& random, float low, float high, double duration)
        : low_(low), high_(high), course_(random.fork(1), low, high, Random(random).uniform(0.4, 0.8), duration) {}

    void walk(const Gait& gait) { gait_ = &gait; }
    /// Returns degrees; `walking` in [0, 1] is the share by which walking replaces the joint's own motion.
    float at(double time, double walking, double phase) const {
        double angle = course_.at(time);
        if (gait_) {
            const double step = gait_->middle + gait_->swing * std::sin(phase + gait_->lag);
            angle += walking * (step - angle);
        }
        return std::clamp(static_cast<float>(angle), low_, high_);
    }

  private:
    float low_, high_;
    MotionCurve course_;
    const Gait* gait_ = nullptr;
};

std::vector<std::array<AngleCurve, 3>> angle_courses(const Random& random, double duration) {
    std::vector<std::array<AngleCurve, 3>> courses;
    for (std::size_t j = 0; j < k_figure_joints; ++j) {
        const FigureJoint& joint = figure_joints()[j];
        const Random own = random.fork(j);
        const auto course = [&](std::size_t i) {
            return AngleCurve(own.fork(i), joint.limits.low[i], joint.limits.high[i], duration);
        };
        courses.push_back({course(0), course(1), course(2)});
        for (const Gait& gait : k_gaits)
            if (gait.joint == joint.name) courses.back()[0].walk(gait);
    }
    return courses;
}

/// Position, rotation (degrees) and share of walking of the root over time.
struct RootCourse {
    RootCourse(const Random& random, double duration)
        : x(random.fork(1), -0.9, 0.9, 1.5, duration),
          y(random.fork(2), -0.06, 0.06, 0.6, duration),
          z(random.fork(3), -0.9, 0.9, 1.5, duration),
          turn(random.fork(4), -150, 150, 2.0, duration),
          walking(random.fork(5), -0.6, 1.6, 1.2, duration),
          pace(random.fork(6), 0.7, 1.2, 1.0, duration) {}

    MotionCurve x, y, z, turn, walking, pace;
};

}  // namespace

Eigen::Matrix3f figure_axes(const FigureModel& model, std::size_t joint) {
    return axes_along(model.tip[joint] - model.joint[joint]);
}

Eigen::Quaternionf joint_rotation(const FigureJoint& joint, const Eigen::Matrix3f& axes,
                                  const std::array<float, 3>& degrees) {
    const std::array<float, 3> sign = mirror(joint);
    const auto turn = [&](std::size_t i, const Vec3& axis) {
        return Eigen::AngleAxisf(sign[i] * degrees[i] * static_cast<float>(k_radians), axis);
    };
    const Eigen::Quaternionf local = turn(2, Vec3::UnitZ()) * turn(0, Vec3::UnitX()) * turn(1, Vec3::UnitY());
    const Eigen::Quaternionf frame(axes);
    return (frame * local * frame.conjugate()).normalized();
}

std::array<float, 3> joint_angles(const FigureJoint& joint, const Eigen::Matrix3f& axes,
                                  const Eigen::Quaternionf& rotation) {
    // With R = Rz(c) Rx(a) Ry(b): R(2,1) = sin a, R(2,0) = -cos a sin b, R(2,2) = cos a cos b, R(0,1) = -sin c cos a,
    // R(1,1) = cos c cos a.
    const Eigen::Matrix3f r = axes.transpose() * rotation.toRotationMatrix() * axes;
    const std::array<float, 3> sign = mirror(joint);
    const float scale = static_cast<float>(1 / k_radians);
    return {sign[0] * scale * std::asin(std::clamp(r(2, 1), -1.0f, 1.0f)),
            sign[1] * scale * std::atan2(-r(2, 0), r(2, 2)), sign[2] * scale * std::atan2(-r(0, 1), r(1, 1))};
}

Clip move_figure(const FigureModel& model, const Rig& rig, std::size_t frames, Random random) {
    const double duration = static_cast<double>(frames) / k_figure_frame_rate;
    const auto courses = angle_courses(random.fork(1), duration);
    const RootCourse root(random.fork(2), duration);
    Clip clip;
    clip.frames_per_second = k_figure_frame_rate;
    double phase = random.uniform(0, 2 * std::numbers::pi);
    for (std::size_t f = 0; f < frames; ++f) {
        const double time = static_cast<double>(f) / k_figure_frame_rate;
        const double walking = std::clamp(root.walking.at(time), 0.0, 1.0);
        const double eased = walking * walking * (3 - 2 * walking);  // smooth where the clamp begins
        phase += 2 * std::numbers::pi * root.pace.at(time) / k_figure_frame_rate;
        Pose pose = rest_pose(rig);
        for (std::size_t j = 0; j < k_figure_joints; ++j) {
            const auto& [bend, twist, side] = courses[j];
            std::array<float, 3> angles{bend.at(time, eased, phase), twist.at(time, eased, phase),
                                        side.at(time, eased, phase)};
            if (j == 0) angles[1] = static_cast<float>(root.turn.at(time));
            pose.nodes[j].rotation = joint_rotation(figure_joints()[j], figure_axes(model, j), angles);
        }
        pose.nodes[0].translation += Vec3d(root.x.at(time), root.y.at(time), root.z.at(time)).cast<float>();
        clip.poses.push_back(std::move(pose));
    }
    return clip;
}

}  // namespace exemplar
