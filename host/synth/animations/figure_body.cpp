#include <array>

#include "host/mesh/topology.h"
#include "host/synth/animations/figure.h"

// Models a person of about 1.75 units height, smooth enough to have curvature everywhere: mittens for hands, no
// hair.

namespace exemplar {
namespace {

enum Joint : std::int32_t {
    k_hips,
    k_spine,
    k_chest,
    k_neck,
    k_head,
    k_clavicle,  // the left side; the right follows in the list
    k_shoulder,
    k_elbow,
    k_wrist,
    k_hip,
    k_knee,
    k_ankle,
    k_joints_of_a_side = k_ankle - k_clavicle + 1
};

constexpr JointLimits k_clavicle_limits{{-8, 0, -4}, {12, 0, 16}};
constexpr JointLimits k_shoulder_limits{{-40, -35, -30}, {75, 35, 65}};
constexpr JointLimits k_elbow_limits{{0, -25, 0}, {125, 25, 0}};
constexpr JointLimits k_wrist_limits{{-20, -15, -40}, {20, 15, 40}};
constexpr JointLimits k_hip_limits{{-25, -20, -8}, {80, 20, 35}};
constexpr JointLimits k_knee_limits{{-120, 0, 0}, {0, 0, 0}};
constexpr JointLimits k_ankle_limits{{-35, -8, -8}, {18, 8, 8}};

struct FigureBuild {
    float girth, shoulders, hips, legs, arms, muscle, head;
};

FigureBuild pick_figure_build(Random& random) {
    FigureBuild b{};
    b.girth = pick(random, 0.88f, 1.18f);
    b.shoulders = pick(random, 0.9f, 1.08f);
    b.hips = pick(random, 0.95f, 1.1f);
    b.legs = pick(random, 0.94f, 1.06f);
    b.arms = pick(random, 0.95f, 1.05f);
    b.muscle = pick(random, 0.92f, 1.12f);
    b.head = pick(random, 1.0f, 1.12f);
    return b;
}

class FigureBody {
  public:
    FigureBody(FigureModel& figure, const FigureBuild& build) : figure_(figure), b_(build), add_(figure.shape) {}

    void sculpt() {
        trunk();
        head();
        for (const int side : {0, 1}) {
            arm(side);
            leg(side);
        }
    }

  private:
    static float sign(int side) { return side == 0 ? 1.0f : -1.0f; }
    Sculptor& on(int joint, int side = 0) { return add_.part(joint + side * k_joints_of_a_side); }
    void place(std::size_t joint, int side, const Vec3& begin, const Vec3& end) {
        const std::size_t j = side == 0 ? joint : joint + k_joints_of_a_side;
        figure_.joint[j] = begin;
        figure_.tip[j] = end;
    }

    void trunk() {
        const float g = b_.girth;
        const Vec3 hips(0, 0.95f, 0), spine(0, 1.06f, -0.005f), chest(0, 1.21f, -0.012f), neck(0, 1.475f, -0.015f);
        place(k_hips, 0, hips, spine);
        place(k_spine, 0, spine, chest);
        place(k_chest, 0, chest, neck);
        on(k_hips).blend(0.09f);
        add_.ellipsoid({hips}, Vec3(0.158f * b_.hips * g, 0.125f, 0.115f * g));
        on(k_spine).ellipsoid({Vec3(0, 1.1f, 0.008f * g)}, Vec3(0.132f * g, 0.16f, 0.102f * g));
        on(k_chest).ellipsoid({Vec3(0, 1.305f, 0)}, Vec3(0.158f * b_.shoulders, 0.17f, 0.11f * g));
        const float shoulder = 0.12f * b_.shoulders;
        for (const int s : {0, 1}) {
            const float sx = sign(s);
            on(k_clavicle, s).blend(0.06f);
            add_.limb(Vec3(sx * 0.03f, 1.42f, -0.012f), Vec3(sx * shoulder, 1.42f, -0.012f), 0.058f, 0.058f);
            add_.limb(Vec3(sx * 0.04f, 1.46f, -0.02f), Vec3(sx * shoulder, 1.43f, -0.012f), 0.048f, 0.05f);
            on(k_chest).ellipsoid({Vec3(sx * 0.07f, 1.33f, 0.075f * g)}, Vec3(0.08f, 0.065f, 0.05f * b_.muscle));
            on(k_hips).ellipsoid({Vec3(sx * 0.072f * b_.hips, 0.9f, -0.06f * g)}, Vec3(0.082f, 0.09f, 0.07f));
        }
    }

    void head() {
        const float h = b_.head;
        const Vec3 neck(0, 1.475f, -0.015f), skull(0, 1.575f, 0.0f);
        place(k_neck, 0, neck, skull);
        place(k_head, 0, skull, skull + Vec3(0, 0.2f * h, 0));
        on(k_neck).blend(0.05f);
        add_.limb(Vec3(0, 1.44f, -0.015f), skull + Vec3(0, 0.02f, 0), 0.06f * b_.muscle, 0.054f * b_.muscle);
        on(k_head).blend(0.04f);
        add_.ellipsoid({skull + Vec3(0, 0.115f, -0.002f) * h}, Vec3(0.08f, 0.102f, 0.097f) * h);
        add_.ellipsoid({skull + Vec3(0, 0.058f, 0.034f) * h}, Vec3(0.056f, 0.072f, 0.06f) * h);
        add_.blend(0.03f);
        add_.limb(skull + Vec3(0, 0.105f, 0.09f) * h, skull + Vec3(0, 0.075f, 0.108f) * h, 0.01f, 0.016f);
        for (const float sx : {1.0f, -1.0f})
            add_.ellipsoid({skull + Vec3(sx * 0.08f, 0.095f, -0.004f) * h, turn_y(sx * 20)},
                           Vec3(0.014f, 0.03f, 0.021f));
    }

    void arm(int side) {
        const float sx = sign(side), m = b_.muscle;
        // The arms are half raised, so that the surface below them is neither stretched nor folded at rest.
        const Frame shoulder = Frame{Vec3(sx * 0.172f * b_.shoulders, 1.412f, -0.012f), turn_z(sx * 52)};
        const Vec3 elbow = shoulder * Vec3(0, -0.285f * b_.arms, 0), wrist = shoulder * Vec3(0, -0.535f * b_.arms, 0);
        place(k_clavicle, side, Vec3(sx * 0.025f, 1.42f, -0.012f), shoulder.origin);
        place(k_shoulder, side, shoulder.origin, elbow);
        place(k_elbow, side, elbow, wrist);
        const Frame upper{shoulder.origin, shoulder.axes}, lower{elbow, shoulder.axes};
        on(k_shoulder, side).blend(0.05f);
        add_.limb(shoulder.origin, elbow, 0.052f * m, 0.039f * m);
        add_.ellipsoid(upper.at(Vec3(sx * 0.006f, -0.04f, 0)), Vec3(0.055f, 0.078f, 0.058f) * m);
        add_.blend(0.035f).ellipsoid(upper.at(Vec3(0, -0.145f, 0.011f)), Vec3(0.041f, 0.085f, 0.043f) * m);
        on(k_elbow, side).blend(0.03f);
        add_.limb(elbow, wrist, 0.038f * m, 0.028f);
        add_.ellipsoid(lower.at(Vec3(0, -0.075f, 0.004f)), Vec3(0.044f, 0.088f, 0.041f) * m);
        hand(Frame{wrist, shoulder.axes * turn_y(sx * 80)}, side);
    }

    /// Palm toward +z of its frame, fingers along -y, the thumb to the side of -sx * x.
    void hand(const Frame& wrist, int side) {
        const float sx = sign(side);
        const Vec3 back = wrist.axes.col(2);
        place(k_wrist, side, wrist.origin, wrist * Vec3(0, -0.17f, 0));
        on(k_wrist, side).blend(0.025f);
        add_.limb(wrist * Vec3(0, -0.015f, 0), wrist * Vec3(0, -0.075f, 0), 0.032f, 0.045f, 0.66f, back);
        add_.limb(wrist * Vec3(0, -0.085f, 0), wrist * Vec3(0, -0.15f, 0.012f), 0.041f, 0.03f, 0.6f, back);
        add_.tube(std::array{wrist * Vec3(-sx * 0.022f, -0.035f, 0.006f), wrist * Vec3(-sx * 0.057f, -0.065f, 0.014f),
                             wrist * Vec3(-sx * 0.07f, -0.098f, 0.02f)},
                  0.019f, 0.0135f);
    }

    void leg(int side) {
        const float sx = sign(side), g = b_.girth, m = b_.muscle;
        const Frame hip = Frame{Vec3(sx * 0.09f * b_.hips, 0.905f, 0), turn_z(sx * 7)};
        const Frame knee = hip.at(Vec3(0, -0.425f * b_.legs, 0)), ankle = knee.at(Vec3(0, -0.41f * b_.legs, 0));
        place(k_hip, side, hip.origin, knee.origin);
        place(k_knee, side, knee.origin, ankle.origin);
        on(k_hip, side).blend(0.05f);
        add_.limb(hip.origin, knee.origin, 0.086f * g, 0.055f);
        add_.blend(0.04f).ellipsoid(hip.at(Vec3(0, -0.17f, 0.02f)), Vec3(0.07f * g, 0.15f, 0.068f * m));
        on(k_knee, side).blend(0.04f);
        add_.limb(knee.origin, ankle.origin, 0.053f, 0.037f);
        add_.ellipsoid(knee.at(Vec3(0, -0.115f, -0.022f)), Vec3(0.051f, 0.112f, 0.049f) * m);
        foot(Frame{ankle.origin, turn_y(sx * 10)}, side);
    }

    void foot(const Frame& ankle, int side) {
        const float sx = sign(side);
        place(k_ankle, side, ankle.origin, ankle * Vec3(0, -0.055f, 0.15f));
        on(k_ankle, side).blend(0.035f);
        add_.limb(ankle * Vec3(0, -0.01f, 0), ankle * Vec3(0, -0.05f, 0.06f), 0.036f, 0.028f);
        add_.limb(ankle * Vec3(0, -0.048f, -0.028f), ankle * Vec3(0, -0.054f, 0.09f), 0.037f, 0.039f, 0.82f,
                  Vec3::UnitY());
        add_.limb(ankle * Vec3(0, -0.056f, 0.09f), ankle * Vec3(-sx * 0.008f, -0.06f, 0.155f), 0.043f, 0.033f, 0.6f,
                  Vec3::UnitY());
    }

    FigureModel& figure_;
    const FigureBuild& b_;
    Sculptor add_;
};

}  // namespace

const std::array<FigureJoint, k_figure_joints>& figure_joints() {
    constexpr auto k_right = static_cast<std::uint32_t>(k_joints_of_a_side);
    static const std::array<FigureJoint, k_figure_joints> joints{
        {{"hips", k_invalid_index, 0, {{-8, -180, -6}, {12, 180, 6}}},
         {"spine", k_hips, 0, {{-12, -14, -12}, {24, 14, 12}}},
         {"chest", k_spine, 0, {{-8, -16, -10}, {16, 16, 10}}},
         {"neck", k_chest, 0, {{-14, -25, -12}, {18, 25, 12}}},
         {"head", k_neck, 0, {{-14, -28, -10}, {18, 28, 10}}},
         {"left_clavicle", k_chest, 1, k_clavicle_limits},
         {"left_shoulder", k_clavicle, 1, k_shoulder_limits},
         {"left_elbow", k_shoulder, 1, k_elbow_limits},
         {"left_wrist", k_elbow, 1, k_wrist_limits},
         {"left_hip", k_hips, 1, k_hip_limits},
         {"left_knee", k_hip, 1, k_knee_limits},
         {"left_ankle", k_knee, 1, k_ankle_limits},
         {"right_clavicle", k_chest, -1, k_clavicle_limits},
         {"right_shoulder", k_clavicle + k_right, -1, k_shoulder_limits},
         {"right_elbow", k_shoulder + k_right, -1, k_elbow_limits},
         {"right_wrist", k_elbow + k_right, -1, k_wrist_limits},
         {"right_hip", k_hips, -1, k_hip_limits},
         {"right_knee", k_hip + k_right, -1, k_knee_limits},
         {"right_ankle", k_knee + k_right, -1, k_ankle_limits}}};
    return joints;
}

FigureModel sculpt_figure(Random& random) {
    FigureModel figure{};
    figure.shape.detail = 0.0095f;
    const FigureBuild build = pick_figure_build(random);
    FigureBody(figure, build).sculpt();
    return figure;
}

}  // namespace exemplar
