#include <array>
#include <cmath>
#include <vector>

#include "host/synth/shapes/models.h"

// Chairs of a seat at 0.45 units height, one of several kinds of legs and one of several kinds of backs.

namespace exemplar {
namespace {

struct ChairPart {
    enum : std::int32_t { seat, back, leg };
};

struct ChairDesign {
    float width, depth, height, thickness;  // of the seat; width and depth are half extents
    float back_height, tilt;                // tilt in degrees
    float leg;                              // leg radius
    bool round, square_legs;
};

ChairDesign pick_chair_design(Random& random) {
    ChairDesign d{};
    d.width = pick(random, 0.2f, 0.27f);
    d.depth = pick(random, 0.19f, 0.25f);
    d.height = pick(random, 0.4f, 0.5f);
    d.thickness = pick(random, 0.018f, 0.045f);
    d.back_height = pick(random, 0.36f, 0.62f);
    d.tilt = pick(random, 3, 16);
    d.leg = pick(random, 0.018f, 0.03f);
    d.round = chance(random, 0.3);
    d.square_legs = chance(random, 0.5);
    return d;
}

void stick(Sculptor& add, const ChairDesign& d, const Vec3& a, const Vec3& b, float ra, float rb) {
    if (d.square_legs) {
        add.bar(a, b, (ra + rb) / 2, (ra + rb) / 2, 0.006f);
    } else {
        add.limb(a, b, ra, rb);
    }
}

void seat(Sculptor& add, const ChairDesign& d, Random& random) {
    add.part(ChairPart::seat).blend(0.01f);
    const Frame frame{Vec3(0, d.height, 0), Eigen::Matrix3f::Identity()};
    std::vector<Vec2> outline = superellipse(d.width, d.depth, d.round ? 2.2f : pick(random, 5, 12), 32);
    const float taper = d.round ? 0 : pick(random, 0, 0.18f);
    for (Vec2& p : outline) p.x() *= 1 + taper * p.y() / d.depth;  // narrower at the back
    const float rounding = 0.45f * d.thickness;
    for (Vec2& p : outline) p *= 1 - rounding / d.width;
    add.add(Prism{outline, d.thickness - rounding, rounding}, frame);
    if (chance(random, 0.3)) {  // a cushion
        add.blend(0.015f);
        add.add(Ellipsoid{Vec3(0.85f * d.width, 0.045f, 0.85f * d.depth)}, frame.at(Vec3(0, d.thickness, 0)));
    }
}

void stretchers(Sculptor& add, const ChairDesign& d, const std::array<Vec3, 4>& top, const std::array<Vec3, 4>& bottom,
                Random& random) {
    const bool h_shape = chance(random, 0.5);
    const float share = pick(random, 0.45f, 0.7f);
    const auto at = [&](std::size_t i) { return Vec3(top[i] + share * (bottom[i] - top[i])); };
    const float r = std::max(0.65f * d.leg, 0.0135f);
    add.limb(at(0), at(2), r, r);
    add.limb(at(1), at(3), r, r);
    if (h_shape) {
        add.limb((at(0) + at(2)) / 2, (at(1) + at(3)) / 2, r, r);
    } else {
        add.limb(at(2), at(3), r, r);
    }
}

/// Four legs; corners in the order front left, front right, rear left, rear right.
void four_legs(Sculptor& add, const ChairDesign& d, Random& random) {
    const float splay = pick(random, 0, 0.09f), taper = pick(random, 0.6f, 1);
    const float inset = d.round ? 0.68f : 0.84f;
    std::array<Vec3, 4> top, bottom;
    for (std::size_t i = 0; i < 4; ++i) {
        const float x = i % 2 == 0 ? 1.0f : -1.0f, z = i < 2 ? 1.0f : -1.0f;
        top[i] = Vec3(x * inset * d.width, d.height + d.thickness - 1.2f * d.leg, z * inset * d.depth);
        bottom[i] = Vec3(top[i].x() + x * splay, 0.02f, top[i].z() + z * splay * (i < 2 ? 0.7f : 1.2f));
        stick(add, d, top[i], bottom[i], d.leg, std::max(taper * d.leg, 0.0145f));
    }
    if (chance(random, 0.45)) stretchers(add, d, top, bottom, random);
}

/// A column on a star of five feet with castors.
void swivel(Sculptor& add, const ChairDesign& d, Random& random) {
    const float reach = pick(random, 0.24f, 0.32f), r = pick(random, 0.026f, 0.036f);
    add.rod(Vec3(0, 0.09f, 0), Vec3(0, d.height - 0.3f * d.thickness, 0), r, 0.008f);
    add.rod(Vec3(0, d.height - d.thickness - 0.03f, 0), Vec3(0, d.height - 0.4f * d.thickness, 0), 2.4f * r, 0.01f);
    const bool castors = chance(random, 0.7);
    for (int i = 0; i < 5; ++i) {
        const Vec3 out = turn_y(72 * static_cast<float>(i)) * Vec3(0, 0, 1);
        add.limb(Vec3(0, 0.11f, 0), out * reach + Vec3(0, 0.065f, 0), 0.03f, 0.019f);
        if (castors) add.limb(out * reach + Vec3(0, 0.06f, 0), out * reach + Vec3(0, 0.028f, 0), 0.018f, 0.027f);
    }
}

/// A cantilever: two bent tubes that run down in front and back along the floor.
void cantilever(Sculptor& add, const ChairDesign& d) {
    const float r = std::max(0.75f * d.leg, 0.0165f), x = 0.88f * d.width;
    for (const float side : {1.0f, -1.0f}) {
        const std::array<Vec3, 6> control{Vec3(side * x, d.height - d.thickness, -0.6f * d.depth),
                                          Vec3(side * x, d.height - d.thickness, 0.8f * d.depth),
                                          Vec3(side * x, d.height - 0.06f, 1.05f * d.depth),
                                          Vec3(side * x, 0.08f, 1.05f * d.depth),
                                          Vec3(side * x, 0.02f, 0.85f * d.depth),
                                          Vec3(side * x, 0.02f, -d.depth)};
        add.tube(smooth_curve(control, 26), r, r);
    }
    add.limb(Vec3(x, 0.02f, -d.depth), Vec3(-x, 0.02f, -d.depth), r, r);
}

void legs(Sculptor& add, const ChairDesign& d, Random& random) {
    add.part(ChairPart::leg).blend(0.012f);
    const double draw = random.uniform();
    if (draw < 0.68) {
        four_legs(add, d, random);
    } else if (draw < 0.86) {
        swivel(add, d, random);
    } else {
        cantilever(add, d);
    }
}

/// The plane of the back: origin at the seat's rear edge, y up along the back, z to the front.
Frame back_plane(const ChairDesign& d) {
    const float rear = d.round ? 0.74f * d.depth : d.depth - 0.025f;
    return {Vec3(0, d.height, -rear), turn_x(-d.tilt)};
}

void panel(Sculptor& add, const ChairDesign& d, Random& random) {
    // A strip bent around the sitter in plan, extruded along the back.
    const float half_width = 0.95f * d.width * (d.round ? 0.78f : 1.0f), bend = pick(random, 0, 0.07f),
                wall = pick(random, 0.013f, 0.022f);
    std::vector<Vec2> outline;
    for (int i = 0; i <= 10; ++i) {
        const float t = static_cast<float>(i) / 5 - 1;
        outline.push_back({half_width * t, bend * t * t - 0.004f});
    }
    for (std::size_t i = outline.size(); i > 0; --i) outline.push_back(outline[i - 1] + Vec2(0, 0.008f));
    const float from = chance(random, 0.4) ? pick(random, 0.1f, 0.22f) : -0.01f;
    const Frame plane = back_plane(d);
    add.add(Prism{outline, (d.back_height - from) / 2 - wall, wall}, plane.at(Vec3(0, (d.back_height + from) / 2, 0)));
    if (from > 0)
        for (const float side : {0.6f, -0.6f})
            add.limb(plane * Vec3(side * half_width, -0.005f, 0),
                     plane * Vec3(side * half_width, from + 0.06f, 0.36f * bend), 0.016f, 0.016f);
}

/// Two posts joined by a top rail and filled with rungs, slats or spindles.
void framed_back(Sculptor& add, const ChairDesign& d, Random& random) {
    const Frame plane = back_plane(d);
    const float half_width = (d.round ? 0.62f : 0.86f) * d.width, flare = pick(random, 0, 0.03f),
                rail = pick(random, 0.025f, 0.055f);
    const auto at = [&](float across, float share) {
        return plane * Vec3(across * (half_width + flare * share), share * d.back_height, 0);
    };
    for (const float side : {1.0f, -1.0f})
        stick(add, d, at(side, -0.01f), at(side, 1), d.leg, std::max(0.85f * d.leg, 0.0155f));
    const float rail_share = 1 - 0.6f * rail / d.back_height;
    add.bar(at(-1, rail_share), at(1, rail_share), rail, 0.0145f, 0.008f, plane.axes.col(2));
    const float thin = 0.0125f;
    if (chance(random, 0.45)) {  // ladder
        const std::size_t rungs = 1 + random.index(3);
        for (std::size_t i = 0; i < rungs; ++i) {
            const float share = (static_cast<float>(i) + 1) / (static_cast<float>(rungs) + 1);
            add.bar(at(-1, share), at(1, share), pick(random, 0.016f, 0.03f), thin, 0.006f, plane.axes.col(2));
        }
        return;
    }
    const bool flat = chance(random, 0.5);
    const std::size_t spindles = 2 + random.index(4);
    for (std::size_t i = 0; i < spindles; ++i) {
        const float across = 2 * (static_cast<float>(i) + 1) / (static_cast<float>(spindles) + 1) - 1;
        if (flat) {
            add.bar(at(across, -0.01f), at(across, rail_share), 0.02f, thin, 0.006f, plane.axes.col(2));
        } else {
            add.limb(at(across, -0.01f), at(across, rail_share), 0.0135f, 0.0135f);
        }
    }
}

/// A bent hoop with spindles, as on a Windsor chair.
void hoop(Sculptor& add, const ChairDesign& d, Random& random) {
    const Frame plane = back_plane(d);
    const float half_width = (d.round ? 0.6f : 0.85f) * d.width, h = d.back_height;
    std::vector<Vec3> control;
    for (const Vec2& p : {Vec2(-1, -0.01f), Vec2(-1.05f, 0.5f), Vec2(-0.8f, 0.85f), Vec2(0, 1), Vec2(0.8f, 0.85f),
                          Vec2(1.05f, 0.5f), Vec2(1, -0.01f)})
        control.push_back(plane * Vec3(p.x() * half_width, p.y() * h, 0));
    add.tube(smooth_curve(control, 25), 0.018f, 0.018f);
    const int spindles = 3 + 2 * static_cast<int>(random.index(2));
    for (int i = 0; i < spindles; ++i) {
        const float across = 2 * static_cast<float>(i + 1) / static_cast<float>(spindles + 1) - 1;
        const float top = 1 - 0.24f * across * across;
        add.limb(plane * Vec3(0.8f * across * half_width, -0.01f, 0), plane * Vec3(across * half_width, top * h, 0),
                 0.0135f, 0.0135f);
    }
}

}  // namespace

ShapeModel sculpt_chair(Random& random) {
    ShapeModel model;
    model.detail = 0.0115f;
    Sculptor add(model);
    const ChairDesign d = pick_chair_design(random);
    seat(add, d, random);
    legs(add, d, random);
    add.part(ChairPart::back).blend(0.008f);
    const double draw = random.uniform();
    if (draw < 0.34) {
        panel(add, d, random);
    } else if (draw < 0.8) {
        framed_back(add, d, random);
    } else {
        hoop(add, d, random);
    }
    return model;
}

}  // namespace exemplar
