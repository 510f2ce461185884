#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

#include "host/synth/shapes/models.h"

namespace exemplar {
namespace {

struct GlassesPart {
    enum : std::int32_t { frame, lens, temple };
};

/// A lens outline for the right lens (+x is outward, second coordinate up), around the origin.
std::vector<Vec2> lens_outline(float width, float height, Random& random) {
    const float power = pick(random, 2.0f, 4.2f), drop = pick(random, -0.03f, 0.07f),
                taper = pick(random, -0.05f, 0.22f);
    std::vector<Vec2> outline = superellipse(width, height, power, 36);
    for (Vec2& p : outline) {
        p.x() *= 1 + taper * 0.5f * p.y() / height;                   // wider above, as aviators and wayfarers are
        p.y() += drop * (p.x() / width) * (p.y() > 0 ? 1.0f : 0.4f);  // a brow line that rises outward
    }
    return outline;
}

/// Returns the frame whose x is `outward`, whose z is up and whose y points toward the face.
Frame lens_frame(float side, float x, float wrap) {
    Frame frame{Vec3(side * x, 0, 0), {}};
    frame.axes.col(0) = turn_y(side * wrap) * Vec3(side, 0, 0);
    frame.axes.col(2) = Vec3::UnitY();
    frame.axes.col(1) = frame.axes.col(2).cross(frame.axes.col(0));
    return frame;
}

struct GlassesDesign {
    float width, height, gap, rim, wrap, temple_length, temple_height, temple_radius, ear_bend, splay;
    bool flat_temples, double_bridge;
};

GlassesDesign pick_glasses_design(Random& random) {
    GlassesDesign d{};
    d.width = pick(random, 0.26f, 0.34f);
    d.height = d.width * pick(random, 0.55f, 0.98f);
    d.gap = pick(random, 0.1f, 0.16f);
    d.rim = pick(random, 0.021f, 0.036f);
    d.wrap = pick(random, 2, 12);
    d.temple_length = pick(random, 1.2f, 1.5f);
    d.temple_height = d.height * pick(random, 0.1f, 0.7f);
    d.temple_radius = pick(random, 0.024f, 0.034f);
    d.ear_bend = pick(random, 15, 60);
    d.splay = pick(random, -6, 10);
    d.flat_temples = chance(random, 0.5);
    d.double_bridge = chance(random, 0.2);
    return d;
}

void temple(Sculptor& add, const GlassesDesign& d, const Vec3& hinge, float side) {
    const Vec3 back = turn_y(side * -d.splay) * Vec3(0, 0, -1);
    const Vec3 ear = hinge + 0.72f * d.temple_length * back;
    const Vec3 down = turn_x(-d.ear_bend) * back;
    const std::array<Vec3, 4> control{hinge, hinge + 0.4f * d.temple_length * back + Vec3(0, 0.01f, 0), ear,
                                      ear + 0.28f * d.temple_length * down};
    const auto points = smooth_curve(control, 19);
    add.part(GlassesPart::temple).blend(0.01f);
    const Vec3 widen(1, d.flat_temples ? 2.0f : 1.0f, 1);
    add.tube(points, d.temple_radius, 1.15f * d.temple_radius, widen);
}

void half(Sculptor& add, const GlassesDesign& d, const std::vector<Vec2>& outline, float side) {
    const Frame lens = lens_frame(side, d.gap + d.width, d.wrap);
    add.part(GlassesPart::lens).blend(0.006f);
    add.add(Prism{outline, 0.004f, 0.0155f}, lens);
    add.part(GlassesPart::frame).blend(0.01f);
    std::vector<Vec3> rim;
    rim.reserve(outline.size() + 1);
    for (const Vec2& p : outline) rim.push_back(lens * Vec3(p.x(), 0, p.y()));
    rim.push_back(rim[0]);
    add.tube(rim, d.rim, d.rim);
    // The end piece runs from the rim's outer edge to the hinge.
    const Vec3 edge = lens * Vec3(0.96f * d.width, 0, d.temple_height), hinge = edge + Vec3(side * 0.07f, 0, -0.06f);
    add.limb(edge, hinge + Vec3(0, 0, 0.02f), 1.1f * d.rim, 1.15f * d.rim);
    temple(add, d, hinge + Vec3(0, 0, -0.02f), side);
}

}  // namespace

ShapeModel sculpt_glasses(Random& random) {
    ShapeModel model;
    model.detail = 0.0145f;
    Sculptor add(model);
    const GlassesDesign d = pick_glasses_design(random);
    const std::vector<Vec2> outline = lens_outline(d.width, d.height, random);
    half(add, d, outline, 1);
    half(add, d, outline, -1);
    const float bridge_height = d.height * pick(random, 0.1f, 0.45f);
    const float inner = d.gap + 0.1f * d.width;
    const std::array<Vec3, 3> arch{Vec3(-inner, bridge_height, 0.0f),
                                   Vec3(0, bridge_height + pick(random, 0.02f, 0.07f), 0.03f),
                                   Vec3(inner, bridge_height, 0.0f)};
    add.part(GlassesPart::frame).blend(0.015f);
    add.tube(smooth_curve(arch, 7), 1.05f * d.rim, 1.05f * d.rim);
    return model;
}

}  // namespace exemplar
