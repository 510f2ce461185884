#include <array>
#include <cmath>
#include <vector>

#include "host/synth/shapes/models.h"

namespace exemplar {
namespace {

struct TablePart {
    enum : std::int32_t { top, leg };
};

struct TableDesign {
    float width, depth, height, thickness;  // width, depth, thickness are half extents
    float power;                            // of the superellipse: 2 is round
    float leg;
};

TableDesign pick_table_design(Random& random) {
    TableDesign d{};
    d.height = pick(random, 0.55f, 0.85f);
    d.thickness = pick(random, 0.022f, 0.042f);
    d.leg = pick(random, 0.03f, 0.05f);
    if (chance(random, 0.4)) {  // round or oval
        d.power = 2;
        d.width = pick(random, 0.45f, 0.75f);
        d.depth = d.width * pick(random, 0.65f, 1.0f);
    } else {
        d.power = pick(random, 5, 30);
        d.width = pick(random, 0.55f, 0.95f);
        d.depth = pick(random, 0.38f, 0.55f);
    }
    return d;
}

void top(Sculptor& add, const TableDesign& d, Random& random) {
    const float rounding = pick(random, 0.3f, 0.8f) * d.thickness;
    add.part(TablePart::top).blend(0.01f);
    add.add(Prism{superellipse(d.width - rounding, d.depth - rounding, d.power, 48), d.thickness - rounding, rounding},
            {Vec3(0, d.height, 0)});
    if (chance(random, 0.35)) {  // an apron below
        const float h = pick(random, 0.035f, 0.06f);
        add.add(Prism{superellipse(0.82f * d.width, 0.82f * d.depth, d.power, 48), h - 0.01f, 0.01f},
                {Vec3(0, d.height - d.thickness - 0.8f * h, 0)});
    }
}

/// A turned leg: a rod whose radius swings along its length.
void turned_leg(Sculptor& add, const Vec3& from, const Vec3& to, float radius, float phase) {
    std::vector<Vec3> points;
    std::vector<float> radii;
    for (int i = 0; i <= 16; ++i) {
        const float t = static_cast<float>(i) / 16;
        points.push_back(from + t * (to - from));
        radii.push_back(radius * (0.85f + 0.35f * std::sin(12.0f * t + phase) * (1 - 0.5f * t)));
    }
    add.tube(points, radii);
}

/// An S-curved leg with a foot, leaning along `out`.
void cabriole_leg(Sculptor& add, const Vec3& from, const Vec3& out, float radius) {
    const float h = from.y();
    const std::array<Vec3, 5> control{
        from, from + 0.05f * out + Vec3(0, -0.2f * h, 0), from - 0.01f * out + Vec3(0, -0.6f * h, 0),
        from + 0.0f * out + Vec3(0, -0.88f * h, 0), from + 0.07f * out + Vec3(0, -h + 0.025f, 0)};
    const auto points = smooth_curve(control, 17);
    std::vector<float> radii;
    for (std::size_t i = 0; i < points.size(); ++i)
        radii.push_back(radius * (1.35f - 0.75f * static_cast<float>(i) / 16));
    add.tube(points, radii);
    add.ball(points.back(), 0.85f * radius);
}

void corner_legs(Sculptor& add, const TableDesign& d, Random& random) {
    const std::size_t style = random.index(5);
    const float inset = d.power < 3 ? 0.6f : 0.86f, splay = pick(random, 0.04f, 0.12f),
                taper = pick(random, 0.55f, 0.9f), phase = pick(random, 0, 6.28f);
    std::array<Vec3, 4> feet;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 out(i % 2 == 0 ? 1.0f : -1.0f, 0, i < 2 ? 1.0f : -1.0f);
        // Round ends must not stick out of the top.
        const float high = d.height + d.thickness - 1.45f * d.leg;
        const Vec3 from(out.x() * inset * d.width, high, out.z() * inset * d.depth);
        Vec3 to(from.x(), 0, from.z());
        switch (style) {
            case 0:
                add.bar(from, to, d.leg, d.leg, 0.008f);
                break;
            case 1:
                add.limb(from, to, d.leg, taper * d.leg);
                break;
            case 2:
                to += splay * out;
                add.limb(from, to, d.leg, taper * d.leg);
                break;
            case 3:
                turned_leg(add, from, to, d.leg, phase);
                break;
            default:
                cabriole_leg(add, from, out, d.leg);
        }
        feet[i] = from + 0.75f * (to - from);
    }
    if (style < 3 && chance(random, 0.3)) {
        const float r = 0.6f * d.leg;
        add.limb(feet[0], feet[2], r, r);
        add.limb(feet[1], feet[3], r, r);
        add.limb((feet[0] + feet[2]) / 2, (feet[1] + feet[3]) / 2, r, r);
    }
}

void pedestal(Sculptor& add, const TableDesign& d, Random& random) {
    const float r = pick(random, 0.045f, 0.08f), reach = pick(random, 0.5f, 0.75f) * d.depth;
    const Vec3 from(0, d.height - 1.25f * r, 0), to(0, 0.05f, 0), under(0, d.height - d.thickness - 0.03f, 0);
    if (chance(random, 0.5)) {
        turned_leg(add, from, to, r, pick(random, 0, 6.28f));
    } else {
        add.rod(from, to, r, 0.01f);
    }
    add.rod(under, Vec3(0, d.height, 0), 2.2f * r, 0.015f);
    if (chance(random, 0.35)) {  // a round foot
        add.blend(0.06f);
        add.add(RoundCylinder{0.03f, reach, 0.02f}, {Vec3(0, 0.03f, 0)});
        return;
    }
    const int feet = 3 + static_cast<int>(random.index(3));
    for (int i = 0; i < feet; ++i) {
        const Vec3 out = turn_y(360.0f / static_cast<float>(feet) * static_cast<float>(i)) * Vec3(0, 0, 1);
        const std::array<Vec3, 3> control{Vec3(0, 0.16f, 0), 0.6f * reach * out + Vec3(0, 0.1f, 0),
                                          reach * out + Vec3(0, 0.03f, 0)};
        add.tube(smooth_curve(control, 7), 0.045f, 0.03f);
    }
}

void trestle(Sculptor& add, const TableDesign& d, Random& random) {
    const float x = pick(random, 0.6f, 0.78f) * d.width, w = d.leg, high = d.height - 0.5f * d.thickness;
    const bool crossed = chance(random, 0.4);
    for (const float side : {1.0f, -1.0f}) {
        const float z = 0.72f * d.depth;
        if (crossed) {
            add.bar(Vec3(side * x, high, z), Vec3(side * x, 0.02f, -z), w, 0.7f * w, 0.008f);
            add.bar(Vec3(side * x, high, -z), Vec3(side * x, 0.02f, z), w, 0.7f * w, 0.008f);
        } else {
            add.bar(Vec3(side * x, high, 0), Vec3(side * x, 0.04f, 0), w, 2.2f * w, 0.008f, Vec3::UnitZ());
            add.bar(Vec3(side * x, 0.035f, -z), Vec3(side * x, 0.035f, z), 0.035f, 1.2f * w, 0.01f, Vec3::UnitX());
        }
    }
    const float y = crossed ? 0.5f * high : 0.42f * d.height;
    add.bar(Vec3(-x, y, 0), Vec3(x, y, 0), 0.6f * w, 0.9f * w, 0.008f, Vec3::UnitY());
}

}  // namespace

ShapeModel sculpt_table(Random& random) {
    ShapeModel model;
    model.detail = 0.019f;
    Sculptor add(model);
    const TableDesign d = pick_table_design(random);
    top(add, d, random);
    add.part(TablePart::leg).blend(0.015f);
    const double draw = random.uniform();
    if (draw < 0.62) {
        corner_legs(add, d, random);
    } else if (draw < 0.85 || d.power < 3) {
        pedestal(add, d, random);
    } else {
        trestle(add, d, random);
    }
    return model;
}

}  // namespace exemplar
