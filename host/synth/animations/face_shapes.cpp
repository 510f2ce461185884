#include <array>
#include <utility>

#include "host/synth/animations/face.h"

namespace exemplar {
namespace {

const Vec3 k_still = Vec3::Zero();

/// Returns the point of the front of the face at (x, y).
Vec3 front(const ImplicitField& field, float x, float y) {
    float outside = field.high().z(), inside = 0;
    for (int i = 0; i < 30; ++i) {
        const float middle = (outside + inside) / 2;
        (field.value(Vec3(x, y, middle)) > 0 ? outside : inside) = middle;
    }
    return {x, y, outside};
}

class Shapes {
  public:
    Shapes(const FaceModel& model, const ImplicitField& field) : m_(model), field_(field) {}

    std::vector<FaceShape> make() {
        brows();
        eyes();
        nose_and_cheeks();
        jaw();
        mouth();
        lips();
        return std::move(shapes_);
    }

  private:
    Vec3 at(float x, float y) const { return front(field_, x, y); }
    void add(std::string_view name, std::vector<SkinPush> pushes) { shapes_.push_back({name, std::move(pushes)}); }
    /// Adds a shape for each side; `pushes_of` makes the pushes of the side of this sign.
    template <typename PushesOf>
    void add_sides(std::string_view left, std::string_view right, PushesOf pushes_of) {
        add(left, pushes_of(1.0f));
        add(right, pushes_of(-1.0f));
    }

    void brows() {
        const float forehead = m_.brow_y + 0.12f;
        add("browInnerUp", {{at(0, m_.brow_y), {0.17f, 0.11f, 0.2f}, {0, 0.035f, 0.008f}},
                            {at(0, forehead), {0.26f, 0.15f, 0.25f}, {0, 0.012f, 0}, 0, 0.011f, 0.1f}});
        add_sides("browOuterUpLeft", "browOuterUpRight", [&](float s) -> std::vector<SkinPush> {
            return {{at(s * 0.2f, m_.brow_y), {0.13f, 0.1f, 0.2f}, {0, 0.032f, 0}},
                    {at(s * 0.17f, forehead), {0.17f, 0.14f, 0.25f}, {0, 0.01f, 0}, 0, 0.009f, 0.1f}};
        });
        add_sides("browDownLeft", "browDownRight", [&](float s) -> std::vector<SkinPush> {
            return {{at(s * 0.12f, m_.brow_y), {0.16f, 0.1f, 0.2f}, {-s * 0.014f, -0.028f, 0.006f}, 0.008f},
                    {at(s * 0.035f, m_.brow_y + 0.01f),
                     {0.1f, 0.12f, 0.2f},
                     k_still,
                     0.004f,
                     0.009f,
                     0.07f,
                     Vec3::UnitX()}};
        });
    }

    void eyes() {
        const auto eye = [&](float s) { return at(s * m_.eye_x, m_.eye_y); };
        add_sides("eyeBlinkLeft", "eyeBlinkRight", [&](float s) -> std::vector<SkinPush> {
            return {{eye(s) + Vec3(0, 0.02f, 0), {0.11f, 0.075f, 0.15f}, {0, -0.02f, 0}, 0.012f}};
        });
        add_sides("eyeWideLeft", "eyeWideRight", [&](float s) -> std::vector<SkinPush> {
            return {{eye(s), {0.12f, 0.09f, 0.15f}, {0, 0.012f, 0}, 0.02f},
                    {eye(s) + Vec3(0, 0.055f, 0), {0.12f, 0.06f, 0.15f}, {0, 0.012f, 0}, -0.01f}};
        });
        add_sides("eyeSquintLeft", "eyeSquintRight", [&](float s) -> std::vector<SkinPush> {
            return {{eye(s) + Vec3(0, -0.04f, 0), {0.13f, 0.08f, 0.15f}, {0, 0.022f, 0}, 0.008f},
                    {at(s * (m_.eye_x + 0.1f), m_.eye_y), {0.1f, 0.1f, 0.2f}, k_still, 0, 0.008f, 0.065f}};
        });
    }

    void nose_and_cheeks() {
        add_sides("noseSneerLeft", "noseSneerRight", [&](float s) -> std::vector<SkinPush> {
            return {{at(s * 0.06f, m_.nose_y), {0.09f, 0.11f, 0.16f}, {s * 0.006f, 0.026f, 0}, 0.01f},
                    {at(s * 0.03f, m_.nose_y + 0.13f),
                     {0.09f, 0.1f, 0.16f},
                     k_still,
                     0,
                     0.008f,
                     0.07f,
                     Vec3(0, 0.8f, 0.6f)}};
        });
        add_sides("cheekPuffLeft", "cheekPuffRight", [&](float s) -> std::vector<SkinPush> {
            return {{at(s * 0.2f, m_.mouth_y + 0.03f), {0.19f, 0.19f, 0.28f}, k_still, 0.06f}};
        });
        add_sides("cheekSquintLeft", "cheekSquintRight", [&](float s) -> std::vector<SkinPush> {
            return {{at(s * 0.17f, m_.eye_y - 0.13f), {0.14f, 0.11f, 0.2f}, {0, 0.025f, 0}, 0.02f}};
        });
    }

    void jaw() {
        const Vec3 chin = at(0, m_.chin_y);
        const Vec3 wide(0.34f, 0.27f, 0.42f);
        add("jawOpen", {{chin, wide, {0, -0.1f, -0.025f}},
                        {at(0, m_.mouth_y - 0.01f), {0.14f, 0.07f, 0.12f}, {0, -0.012f, -0.035f}}});
        add_sides("jawLeft", "jawRight", [&](float s) -> std::vector<SkinPush> {
            return {{chin, wide, {s * 0.06f, 0, 0}}};
        });
        add("jawForward", {{chin, wide, {0, 0.005f, 0.06f}}});
    }

    void mouth() {
        const auto corner = [&](float s) { return at(s * m_.mouth_x, m_.mouth_y); };
        const Vec3 around(0.14f, 0.11f, 0.18f);
        add_sides("mouthSmileLeft", "mouthSmileRight", [&](float s) -> std::vector<SkinPush> {
            return {{corner(s), around, {s * 0.03f, 0.035f, -0.012f}},
                    {at(s * (m_.mouth_x + 0.07f), m_.mouth_y + 0.07f),
                     {0.12f, 0.15f, 0.2f},
                     k_still,
                     0.012f,
                     0.011f,
                     0.085f,
                     Vec3(s * 0.8f, 0.6f, 0)}};
        });
        add_sides("mouthFrownLeft", "mouthFrownRight", [&](float s) -> std::vector<SkinPush> {
            return {{corner(s), around, {s * 0.01f, -0.035f, 0}},
                    {at(s * (m_.mouth_x + 0.02f), m_.mouth_y - 0.09f),
                     {0.11f, 0.1f, 0.2f},
                     k_still,
                     0.006f,
                     0.008f,
                     0.075f,
                     Vec3(s * 0.8f, -0.6f, 0)}};
        });
        add_sides("mouthStretchLeft", "mouthStretchRight", [&](float s) -> std::vector<SkinPush> {
            return {{corner(s), around, {s * 0.045f, -0.008f, -0.02f}}};
        });
        add_sides("mouthDimpleLeft", "mouthDimpleRight", [&](float s) -> std::vector<SkinPush> {
            return {{at(s * (m_.mouth_x + 0.05f), m_.mouth_y), {0.08f, 0.08f, 0.15f}, k_still, -0.018f}};
        });
        add_sides("mouthLeft", "mouthRight", [&](float s) -> std::vector<SkinPush> {
            return {{at(0, m_.mouth_y), {0.24f, 0.13f, 0.25f}, {s * 0.045f, 0, 0}}};
        });
        std::vector<SkinPush> pucker{{at(0, m_.mouth_y), {0.15f, 0.11f, 0.2f}, {0, 0, 0.05f}}};
        for (const float s : {1.0f, -1.0f}) pucker.push_back({corner(s), around, {-s * 0.035f, 0, 0.008f}});
        pucker.push_back({at(0, m_.mouth_y), {0.13f, 0.1f, 0.2f}, k_still, 0, 0.006f, 0.07f, Vec3::UnitX()});
        add("mouthPucker", std::move(pucker));
    }

    void lips() {
        const Vec3 upper = at(0, m_.mouth_y + 0.025f), lower = at(0, m_.mouth_y - 0.03f);
        const Vec3 wide(0.13f, 0.06f, 0.15f);
        add_sides("mouthUpperUpLeft", "mouthUpperUpRight", [&](float s) -> std::vector<SkinPush> {
            return {{upper + Vec3(s * 0.045f, 0.01f, 0), {0.09f, 0.07f, 0.15f}, {0, 0.024f, 0.006f}}};
        });
        add_sides("mouthLowerDownLeft", "mouthLowerDownRight", [&](float s) -> std::vector<SkinPush> {
            return {{lower + Vec3(s * 0.045f, -0.01f, 0), {0.09f, 0.07f, 0.15f}, {0, -0.024f, 0.004f}}};
        });
        add("mouthRollUpper", {{upper, wide, {0, -0.008f, -0.022f}}});
        add("mouthRollLower", {{lower, wide, {0, 0.008f, -0.022f}}});
        add("mouthShrugLower",
            {{lower, {0.15f, 0.08f, 0.18f}, {0, 0.022f, 0.016f}},
             {at(0, (m_.mouth_y + m_.chin_y) / 2 - 0.03f), {0.14f, 0.1f, 0.2f}, k_still, 0.008f, 0.007f, 0.07f}});
    }

    const FaceModel& m_;
    const ImplicitField& field_;
    std::vector<FaceShape> shapes_;
};

}  // namespace

std::vector<FaceShape> face_shapes(const FaceModel& model, const ImplicitField& field) {
    return Shapes(model, field).make();
}

}  // namespace exemplar
