#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "host/synth/shapes/models.h"

namespace exemplar {
namespace {

struct CupPart {
    enum : std::int32_t { body, handle };
};

/// Returns the middle of the wall by height, from the corner above the floor (share 0) to the rim (share 1).
struct Silhouette {
    float height, base, belly, rim, foot, wall;

    float radius(float share) const {
        // The parabola through base, belly and rim at 0, 1/2 and 1.
        return base * (1 - share) * (1 - 2 * share) + 4 * belly * share * (1 - share) + rim * share * (2 * share - 1);
    }
    Vec3 at(float share) const { return {0, foot + height * share, radius(share)}; }
};

Silhouette pick_silhouette(Random& random) {
    Silhouette s{};
    s.wall = pick(random, 0.028f, 0.045f);
    s.height = pick(random, 0.75f, 1.15f);
    s.base = pick(random, 0.34f, 0.45f);
    switch (random.index(4)) {
        case 0:  // straight mug
            s.belly = s.rim = s.base;
            break;
        case 1:  // tapered
            s.rim = s.base * pick(random, 1.15f, 1.5f);
            s.belly = (s.base + s.rim) / 2;
            break;
        case 2:  // barrel
            s.rim = s.base * pick(random, 0.9f, 1.1f);
            s.belly = s.base * pick(random, 1.12f, 1.35f);
            break;
        default:  // teacup
            s.base *= 0.75f;
            s.height *= 0.75f;
            s.rim = s.base * pick(random, 1.7f, 2.1f);
            s.belly = s.base * pick(random, 1.5f, 1.65f);
    }
    if (chance(random, 0.35)) s.foot = pick(random, 0.05f, 0.1f);
    return s;
}

void body(Sculptor& add, const Silhouette& s, Random& random) {
    Lathe wall;
    wall.profile.push_back({0, s.foot});
    wall.thickness.push_back(s.wall * 1.2f);
    for (int i = 0; i <= 12; ++i) {
        const float share = static_cast<float>(i) / 12;
        wall.profile.push_back({s.radius(share), s.foot + s.height * share});
        wall.thickness.push_back(s.wall * (1.15f - 0.2f * share));
    }
    add.part(CupPart::body).blend(0.015f);
    add.add(wall, {});
    if (chance(random, 0.4)) add.add(Torus{s.radius(1), s.wall * 1.25f}, {s.at(1).cwiseProduct(Vec3(0, 1, 0))});
    if (s.foot > 0) {
        const Lathe ring{{{0.75f * s.base, s.foot}, {0.8f * s.base, 0}}, {s.wall, s.wall}};
        add.add(ring, {});
    }
    if (chance(random, 0.25)) {  // a raised band
        const float share = pick(random, 0.2f, 0.8f);
        add.add(Torus{s.radius(share) + 0.4f * s.wall, s.wall}, {s.at(share).cwiseProduct(Vec3(0, 1, 0))});
    }
}

void handle(Sculptor& add, const Silhouette& s, Random& random) {
    const float thick = pick(random, 0.042f, 0.062f), reach = pick(random, 0.25f, 0.42f);
    const float top = pick(random, 0.72f, 0.9f), bottom = pick(random, 0.14f, 0.36f);
    const Vec3 outward(0, 0, s.wall + 0.35f * thick);
    const Vec3 a = s.at(top) + outward, b = s.at(bottom) + outward;
    const float far = std::max(a.z(), b.z()) + reach;
    const Vec3 middle(0, (a.y() + b.y()) / 2, far);
    std::vector<Vec3> control;
    switch (random.index(4)) {
        case 0:  // round
            control = {a, Vec3(0, a.y() + 0.02f, a.z() + 0.6f * reach), middle,
                       Vec3(0, b.y() - 0.02f, b.z() + 0.6f * reach), b};
            break;
        case 1:  // square
            control = {a,
                       Vec3(0, a.y(), far - 0.06f),
                       Vec3(0, a.y() - 0.08f, far),
                       Vec3(0, b.y() + 0.08f, far),
                       Vec3(0, b.y(), far - 0.06f),
                       b};
            break;
        case 2:  // ear
            control = {a, Vec3(0, a.y() + 0.08f, a.z() + 0.55f * reach), Vec3(0, 0.65f * a.y() + 0.35f * b.y(), far),
                       Vec3(0, 0.25f * a.y() + 0.75f * b.y(), b.z() + 0.5f * reach), b};
            break;
        default:  // slanted
            control = {a, Vec3(0, a.y() + 0.01f, far), Vec3(0, 0.6f * a.y() + 0.4f * b.y(), far + 0.02f), b};
    }
    const float width = pick(random, 1, 1.7f);
    const auto points = smooth_curve(control, 25);
    add.part(CupPart::handle).blend(0.02f);
    add.tube(points, thick, thick, Vec3(width, 1, 1));
}

}  // namespace

ShapeModel sculpt_cup(Random& random) {
    ShapeModel model;
    model.detail = 0.024f;
    Sculptor add(model);
    const Silhouette silhouette = pick_silhouette(random);
    body(add, silhouette, random);
    handle(add, silhouette, random);
    return model;
}

}  // namespace exemplar
