#include <array>
#include <vector>

#include "host/synth/shapes/models.h"

// Models a person of about 1.75 units height. Joints form a tree of frames; limbs point along -y of their joint's
// frame.

namespace exemplar {
namespace {

struct HumanPart {
    enum : std::int32_t { head, neck, torso, upper_arm, lower_arm, hand, upper_leg, lower_leg, foot };
};

/// Proportions, each about 1.
struct HumanBuild {
    float girth, shoulders, hips, legs, arms, muscle, head;
    bool woman;
};

/// Joint angles in degrees; index 0 is the left side (+x), 1 the right.
struct Posture {
    std::array<float, 2> arm_out, arm_forward, arm_twist, elbow, wrist, leg_out, leg_forward, knee, ankle;
    float bend, lean, twist, head_turn, head_nod;
};

HumanBuild pick_human_build(Random& random) {
    HumanBuild b{};
    b.woman = chance(random, 0.5);
    b.girth = pick(random, 0.85f, 1.22f);
    b.shoulders = pick(random, 0.94f, 1.08f) * (b.woman ? 0.9f : 1.04f);
    b.hips = pick(random, 0.94f, 1.06f) * (b.woman ? 1.07f : 0.97f);
    b.legs = pick(random, 0.92f, 1.08f);
    b.arms = pick(random, 0.94f, 1.06f);
    b.muscle = pick(random, 0.88f, 1.12f) * (b.woman ? 0.9f : 1.05f);
    b.head = pick(random, 0.95f, 1.12f);
    return b;
}

Posture stand(Random& random) {
    Posture p{};
    for (std::size_t s = 0; s < 2; ++s) {
        p.arm_out[s] = pick(random, 24, 45);
        p.arm_forward[s] = pick(random, -15, 25);
        p.arm_twist[s] = pick(random, -20, 25);
        p.elbow[s] = pick(random, 5, 35);
        p.wrist[s] = pick(random, -15, 15);
        p.leg_out[s] = pick(random, 5, 14);
        p.leg_forward[s] = pick(random, -8, 8);
        p.knee[s] = pick(random, 2, 10);
    }
    p.lean = pick(random, -4, 4);
    p.bend = pick(random, -3, 8);
    p.twist = pick(random, -12, 12);
    p.head_turn = pick(random, -35, 35);
    p.head_nod = pick(random, -12, 18);
    return p;
}

void raise_arms(Random& random, Posture& p, std::size_t from, std::size_t to) {
    for (std::size_t s = from; s < to; ++s) {
        p.arm_out[s] = pick(random, 75, 150);
        p.arm_forward[s] = pick(random, -10, 20);
        p.elbow[s] = pick(random, 5, 50);
    }
}

void stride(Random& random, Posture& p) {
    const std::size_t front = random.index(2), rear = 1 - front;
    const float effort = pick(random, 0.5f, 1.3f);
    p.leg_forward[front] = 38 * effort;
    p.leg_forward[rear] = -22 * effort;
    p.knee[front] = pick(random, 10, 40) * effort;
    p.knee[rear] = pick(random, 15, 60) * effort;
    p.arm_forward[front] = -35 * effort;
    p.arm_forward[rear] = 42 * effort;
    p.elbow[front] = p.elbow[rear] = pick(random, 25, 70) * effort;
    p.arm_twist = {-10, -10};
    p.bend = 7 * effort;
}

void sit(Random& random, Posture& p) {
    for (std::size_t s = 0; s < 2; ++s) {
        p.leg_forward[s] = pick(random, 75, 92);
        p.leg_out[s] = pick(random, 10, 22);
        p.knee[s] = pick(random, 60, 95);
        p.arm_out[s] = pick(random, 35, 60);
        p.arm_twist[s] = -15;
    }
}

Posture pick_posture(Random& random) {
    Posture p = stand(random);
    switch (random.index(6)) {
        case 0:
            break;
        case 1:
            stride(random, p);
            break;
        case 2:
            raise_arms(random, p, 0, 2);
            break;
        case 3:
            stride(random, p);
            raise_arms(random, p, 0, 1);
            break;
        case 4:
            sit(random, p);
            break;
        default:
            raise_arms(random, p, 1, 2);
            p.leg_out = {pick(random, 12, 26), pick(random, 8, 26)};
    }
    return p;
}

class HumanBody {
  public:
    HumanBody(ShapeModel& model, const HumanBuild& build, const Posture& posture, Random& random)
        : b_(build), p_(posture), random_(random), add_(model) {}

    void sculpt() {
        const Frame pelvis{Vec3(0, 0.95f, 0), turn_x(p_.lean)};
        const Frame chest = pelvis.at(Vec3(0, 0.12f, 0), turn_y(p_.twist) * turn_x(p_.bend));
        torso(pelvis, chest);
        for (int side = 0; side < 2; ++side) {
            leg(pelvis, side);
            arm(chest, side);
        }
        head(chest);
    }

  private:
    static float sign(int side) { return side == 0 ? 1.0f : -1.0f; }

    void torso(const Frame& pelvis, const Frame& chest) {
        const float g = b_.girth;
        add_.part(HumanPart::torso).blend(0.07f);
        add_.ellipsoid(pelvis, Vec3(0.158f * b_.hips * g, 0.125f, 0.112f * g));
        add_.ellipsoid(chest.at(Vec3(0, 0.03f, 0.008f * g)),
                       Vec3(0.133f * g * (b_.woman ? 0.93f : 1.0f), 0.16f, 0.1f * g));
        add_.ellipsoid(chest.at(Vec3(0, 0.235f, 0)), Vec3(0.158f * b_.shoulders, 0.17f, 0.108f * g));
        const float shoulder = 0.125f * b_.shoulders;
        add_.limb(chest * Vec3(-shoulder, 0.35f, -0.01f), chest * Vec3(shoulder, 0.35f, -0.01f), 0.058f, 0.058f);
        for (int s = 0; s < 2; ++s) {
            add_.blend(0.04f);
            add_.ellipsoid(pelvis.at(Vec3(sign(s) * 0.07f * b_.hips, -0.045f, -0.062f * g)),
                           Vec3(0.08f, 0.085f, 0.07f));
            add_.limb(chest * Vec3(sign(s) * 0.05f, 0.4f, -0.02f), chest * Vec3(sign(s) * shoulder, 0.36f, -0.01f),
                      0.05f, 0.05f);
            if (b_.woman) {
                add_.ellipsoid(chest.at(Vec3(sign(s) * 0.07f, 0.225f, 0.085f * g)), Vec3::Constant(0.06f * g));
            } else {
                add_.ellipsoid(chest.at(Vec3(sign(s) * 0.068f, 0.265f, 0.075f * g)),
                               Vec3(0.078f, 0.06f, 0.045f * b_.muscle));
            }
        }
    }

    void arm(const Frame& chest, int side) {
        const auto s = static_cast<std::size_t>(side);
        const float sx = sign(side), m = b_.muscle, length = 0.285f * b_.arms;
        const Frame shoulder =
            chest.at(Vec3(sx * 0.178f * b_.shoulders, 0.345f, -0.01f),
                     turn_z(sx * p_.arm_out[s]) * turn_x(-p_.arm_forward[s]) * turn_y(-sx * p_.arm_twist[s]));
        const Vec3 elbow(0, -length, 0);
        add_.part(HumanPart::upper_arm).blend(0.035f);
        add_.limb(shoulder.origin, shoulder * elbow, 0.05f * m, 0.037f * m);
        add_.ellipsoid(shoulder.at(Vec3(sx * 0.008f, -0.035f, 0)), Vec3(0.054f, 0.075f, 0.057f) * m);
        add_.blend(0.02f);
        add_.ellipsoid(shoulder.at(Vec3(0, -0.5f * length, 0.012f)), Vec3(0.04f, 0.085f, 0.043f) * m);

        const Frame forearm = shoulder.at(elbow, turn_x(-p_.elbow[s]));
        const Vec3 wrist(0, -0.245f * b_.arms, 0);
        add_.part(HumanPart::lower_arm).blend(0.015f);
        add_.limb(forearm.origin, forearm * wrist, 0.036f * m, 0.026f);
        add_.ellipsoid(forearm.at(Vec3(0, -0.075f, 0.004f)), Vec3(0.043f, 0.085f, 0.04f) * m);
        hand(forearm.at(wrist, turn_x(-p_.wrist[s]) * turn_y(sx * 80.0f)), sx);
    }

    /// Palm toward +z of its frame, fingers along -y, the thumb to the side of -sx * x.
    void hand(const Frame& wrist, float sx) {
        const float curl = pick(random_, 4, 32), spread = pick(random_, 10, 14);
        add_.part(HumanPart::hand).blend(0.012f);
        const Vec3 back = wrist.axes.col(2);
        add_.limb(wrist * Vec3(0, -0.01f, 0), wrist * Vec3(0, -0.065f, 0), 0.031f, 0.044f, 0.58f, back);
        for (int i = 0; i < 4; ++i) {
            const float across = static_cast<float>(i) - 1.5f;
            const float length = i == 3 ? 0.062f : i == 1 ? 0.086f : 0.08f;
            const Frame knuckle =
                wrist.at(Vec3(sx * across * 0.0262f, -0.088f, 0), turn_z(across * spread * sx) * turn_x(-curl * 0.6f));
            const Frame middle = knuckle.at(Vec3(0, -0.5f * length, 0), turn_x(-curl));
            add_.blend(0.006f);
            add_.tube(std::array{knuckle * Vec3(0, 0.02f, 0), knuckle.origin, middle.origin,
                                 middle * Vec3(0, -0.5f * length, 0)},
                      0.0125f, 0.0098f);
        }
        const Frame thumb = wrist.at(Vec3(-sx * 0.03f, -0.03f, 0.008f), turn_z(-sx * 46) * turn_x(-12));
        add_.blend(0.012f);
        add_.tube(std::array{thumb.origin, thumb * Vec3(0, -0.042f, 0), thumb * Vec3(sx * 0.008f, -0.075f, 0.004f)},
                  0.0165f, 0.0115f);
    }

    void leg(const Frame& pelvis, int side) {
        const auto s = static_cast<std::size_t>(side);
        const float sx = sign(side), g = b_.girth, m = b_.muscle, thigh_length = 0.425f * b_.legs;
        const Frame hip =
            pelvis.at(Vec3(sx * 0.088f * b_.hips, -0.045f, 0), turn_z(sx * p_.leg_out[s]) * turn_x(-p_.leg_forward[s]));
        const Vec3 knee(0, -thigh_length, 0);
        add_.part(HumanPart::upper_leg).blend(0.03f);
        add_.limb(hip.origin, hip * knee, 0.088f * g, 0.053f);
        add_.ellipsoid(hip.at(Vec3(0, -0.17f, 0.022f)), Vec3(0.068f * g, 0.15f, 0.066f * m));

        const Frame shin = hip.at(knee, turn_x(p_.knee[s]));
        const Vec3 ankle(0, -0.41f * b_.legs, 0);
        add_.part(HumanPart::lower_leg).blend(0.02f);
        add_.limb(shin.origin, shin * ankle, 0.051f, 0.034f);
        add_.ellipsoid(shin.at(Vec3(0, -0.115f, -0.022f)), Vec3(0.05f, 0.11f, 0.048f) * m);

        const Frame foot = shin.at(ankle, turn_x(p_.ankle[s]) * turn_y(sx * 10));
        add_.part(HumanPart::foot).blend(0.02f);
        const Vec3 up = foot.axes.col(1);
        add_.limb(foot * Vec3(0, -0.01f, 0), foot * Vec3(0, -0.05f, 0.06f), 0.033f, 0.026f);
        add_.limb(foot * Vec3(0, -0.048f, -0.028f), foot * Vec3(0, -0.054f, 0.09f), 0.036f, 0.038f, 0.8f, up);
        add_.limb(foot * Vec3(0, -0.056f, 0.09f), foot * Vec3(-sx * 0.008f, -0.06f, 0.155f), 0.042f, 0.032f, 0.55f, up);
    }

    void head(const Frame& chest) {
        const float h = b_.head;
        const Frame base = chest.at(Vec3(0, 0.405f, -0.012f), turn_x(0.4f * p_.head_nod) * turn_y(0.5f * p_.head_turn));
        const Frame skull = base.at(Vec3(0, 0.095f, 0.012f), turn_x(0.6f * p_.head_nod) * turn_y(0.5f * p_.head_turn));
        add_.part(HumanPart::neck).blend(0.03f);
        add_.limb(base * Vec3(0, -0.02f, 0), skull * Vec3(0, 0.03f, 0), 0.058f * b_.muscle, 0.05f * b_.muscle);
        add_.part(HumanPart::head).blend(0.025f);
        add_.ellipsoid(skull.at(Vec3(0, 0.115f * h, 0)), Vec3(0.078f, 0.1f, 0.095f) * h);
        add_.ellipsoid(skull.at(Vec3(0, 0.06f * h, 0.032f * h)), Vec3(0.056f, 0.072f, 0.058f) * h);
        add_.blend(0.012f);
        add_.limb(skull * (Vec3(0, 0.108f, 0.088f) * h), skull * (Vec3(0, 0.078f, 0.102f) * h), 0.009f, 0.015f);
        for (const float sx : {1.0f, -1.0f})
            add_.ellipsoid(skull.at(Vec3(sx * 0.079f, 0.095f, -0.004f) * h, turn_y(sx * 20)),
                           Vec3(0.011f, 0.03f, 0.02f));
        hair(skull);
    }

    void hair(const Frame& skull) {
        const float h = b_.head;
        add_.blend(0.015f);
        switch (random_.index(b_.woman ? 4 : 2)) {
            case 0:
                break;
            case 1:
                add_.ellipsoid(skull.at(Vec3(0, 0.137f, -0.014f) * h), Vec3(0.086f, 0.09f, 0.1f) * h);
                break;
            case 2:  // a bun
                add_.ellipsoid(skull.at(Vec3(0, 0.135f, -0.012f) * h), Vec3(0.084f, 0.088f, 0.1f) * h);
                add_.ball(skull * (Vec3(0, 0.2f, -0.09f) * h), 0.045f);
                break;
            default:  // to the shoulders
                add_.ellipsoid(skull.at(Vec3(0, 0.137f, -0.014f) * h), Vec3(0.087f, 0.09f, 0.1f) * h);
                add_.limb(skull * (Vec3(0, 0.11f, -0.055f) * h), skull * (Vec3(0, -0.02f, -0.075f) * h), 0.075f, 0.06f,
                          0.6f, skull.axes.col(2));
        }
    }

    const HumanBuild& b_;
    const Posture& p_;
    Random& random_;
    Sculptor add_;
};

}  // namespace

ShapeModel sculpt_human(Random& random) {
    ShapeModel model;
    model.detail = 0.0086f;
    const HumanBuild build = pick_human_build(random);
    const Posture posture = pick_posture(random);
    HumanBody(model, build, posture, random).sculpt();
    return model;
}

}  // namespace exemplar
