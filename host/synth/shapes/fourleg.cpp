#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "host/synth/shapes/models.h"

// Four-legged animals: a table of species, varied by seed, posed standing or walking, looking around or grazing.

namespace exemplar {
namespace {

struct FourlegPart {
    enum : std::int32_t { head, neck, torso, leg, tail, ear };
};

/// Sizes in units of about the trunk's length; angles in degrees.
struct Species {
    float length, chest, rump, belly, leg, leg_radius;
    float neck, neck_angle, neck_radius;
    float head, skull, muzzle;  // length from skull to nose, radii
    float ear, ear_width, ear_angle;
    float tail, tail_radius, tail_angle;  // angle below the horizontal
    bool hoofed;
};

constexpr std::array<Species, 9> k_species{{
    // length chest rump belly leg  legr   neck angle nrad  head skull muzzle  ear  width angle tail  trad   tang hoof
    {1.00f, 0.21f, 0.21f, 0.20f, 0.80f, 0.056f, 0.58f, 48, 0.125f, 0.34f, 0.105f, 0.066f, 0.13f, 0.036f, 70, 0.65f,
     0.040f, 68, true},  // horse
    {1.10f, 0.25f, 0.24f, 0.28f, 0.56f, 0.058f, 0.32f, 22, 0.135f, 0.30f, 0.115f, 0.080f, 0.15f, 0.048f, 5, 0.62f,
     0.024f, 82, true},  // cow
    {0.85f, 0.18f, 0.14f, 0.12f, 0.48f, 0.042f, 0.27f, 50, 0.095f, 0.22f, 0.092f, 0.046f, 0.13f, 0.042f, 65, 0.42f,
     0.030f, -20, false},  // dog
    {0.90f, 0.16f, 0.15f, 0.15f, 0.42f, 0.046f, 0.20f, 38, 0.100f, 0.11f, 0.108f, 0.050f, 0.08f, 0.045f, 55, 0.85f,
     0.028f, 40, false},  // cat
    {0.95f, 0.25f, 0.25f, 0.27f, 0.27f, 0.058f, 0.14f, 8, 0.150f, 0.22f, 0.130f, 0.075f, 0.14f, 0.060f, 35, 0.25f,
     0.022f, 10, true},  // pig
    {0.85f, 0.22f, 0.18f, 0.18f, 1.05f, 0.050f, 1.15f, 66, 0.100f, 0.26f, 0.090f, 0.055f, 0.12f, 0.036f, 25, 0.50f,
     0.024f, 80, true},  // giraffe
    {0.90f, 0.18f, 0.17f, 0.17f, 0.72f, 0.038f, 0.42f, 56, 0.080f, 0.22f, 0.088f, 0.045f, 0.16f, 0.042f, 40, 0.16f,
     0.034f, 30, true},  // deer
    {0.90f, 0.25f, 0.25f, 0.28f, 0.36f, 0.044f, 0.20f, 35, 0.125f, 0.19f, 0.105f, 0.062f, 0.13f, 0.036f, -5, 0.20f,
     0.034f, 60, true},  // sheep
    {1.00f, 0.26f, 0.28f, 0.27f, 0.42f, 0.088f, 0.22f, 12, 0.155f, 0.21f, 0.135f, 0.070f, 0.07f, 0.048f, 60, 0.12f,
     0.042f, 50, false},  // bear
}};

Species pick_species(Random& random) {
    Species s = k_species[random.index(k_species.size())];
    for (float* size : {&s.length, &s.chest, &s.rump, &s.belly, &s.leg, &s.leg_radius, &s.neck, &s.neck_radius, &s.head,
                        &s.skull, &s.muzzle, &s.ear, &s.tail})
        *size *= pick(random, 0.9f, 1.12f);
    s.neck_angle += pick(random, -10, 10);
    s.ear_angle += pick(random, -15, 15);
    s.tail_angle += pick(random, -15, 10);
    if (s.neck > 0.25f && chance(random, 0.22)) s.neck_angle = pick(random, -38, -22);  // grazing
    return s;
}

Vec3 direction(float elevation, float azimuth) {
    const float e = elevation * 0.017453293f, a = azimuth * 0.017453293f;
    return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

class Animal {
  public:
    Animal(ShapeModel& model, const Species& species, Random& random) : s_(species), random_(random), add_(model) {}

    void sculpt() {
        height_ = s_.leg + 0.9f * (s_.chest + s_.rump) / 2;
        torso();
        const bool walking = chance(random_, 0.6);
        const float gait = walking ? pick(random_, 10, 26) : 3;
        const float mirror = chance(random_, 0.5) ? 1.0f : -1.0f;
        for (const float side : {1.0f, -1.0f}) {
            front_leg(side, side * mirror * gait + pick(random_, -4, 4));
            rear_leg(side, -side * mirror * gait * pick(random_, 0.7f, 1.0f) + pick(random_, -4, 4));
        }
        neck_and_head();
        tail();
    }

  private:
    Vec3 withers() const { return {0, height_, 0.34f * s_.length}; }
    Vec3 croup() const { return {0, height_ + 0.01f, -0.34f * s_.length}; }

    void torso() {
        add_.part(FourlegPart::torso).blend(0.06f);
        add_.limb(croup(), withers(), s_.rump, s_.chest, 0.8f, Vec3::UnitX());
        add_.ellipsoid({Vec3(0, height_ - 0.1f * s_.belly, -0.02f)},
                       Vec3(0.85f * s_.belly, 0.95f * s_.belly, 0.36f * s_.length));
        add_.ellipsoid({withers() + Vec3(0, -0.12f * s_.chest, 0.2f * s_.chest)}, Vec3(0.78f, 0.98f, 0.75f) * s_.chest);
    }

    /// Returns the joints of a leg: offsets (forward, down) as shares of the free leg length, rotated by the swing
    /// about the first.
    std::vector<Vec3> joints(const Vec3& top, const std::vector<Vec2>& offsets, float swing, float bend) const {
        const float length = top.y() - s_.leg_radius * 0.6f;
        std::vector<Vec3> points{top};
        float angle = swing;
        for (std::size_t i = 1; i < offsets.size(); ++i) {
            const Vec2 step = (offsets[i] - offsets[i - 1]) * length;
            points.push_back(points.back() + turn_x(-angle) * Vec3(0, -step.y(), step.x()));
            if (i == 2) angle -= bend;
        }
        return points;
    }

    void foot(const Vec3& ankle) {
        const float r = s_.leg_radius;
        if (s_.hoofed) {
            add_.limb(ankle + Vec3(0, 0.3f * r, 0), ankle + Vec3(0, -0.55f * r, 0.25f * r), 0.72f * r, 0.95f * r);
        } else {
            add_.limb(ankle, ankle + Vec3(0, -0.15f * r, 1.2f * r), 0.8f * r, 0.78f * r);
        }
    }

    void front_leg(float side, float swing) {
        const float r = s_.leg_radius;
        const Vec3 top(side * std::max(0.68f * s_.chest, 2.1f * r), height_ - 0.35f * s_.chest, 0.34f * s_.length);
        const auto p = joints(top, {{0, 0}, {-0.05f, 0.3f}, {-0.02f, 0.62f}, {-0.02f, 0.93f}}, swing,
                              std::max(swing, 0.0f) * 1.3f);
        add_.part(FourlegPart::leg).blend(0.06f);
        add_.limb(p[0], p[1], 0.34f * s_.chest + 0.35f * r, 1.15f * r, 0.75f, Vec3::UnitX());
        add_.blend(0.02f);
        add_.tube(p, std::array<float, 4>{1.6f * r, 1.15f * r, 0.82f * r, 0.68f * r});
        foot(p[3]);
    }

    void rear_leg(float side, float swing) {
        const float r = s_.leg_radius;
        const Vec3 top(side * std::max(0.66f * s_.rump, 2.45f * r), height_ - 0.2f * s_.rump, -0.36f * s_.length);
        const auto p = joints(top, {{0, 0}, {0.07f, 0.32f}, {-0.1f, 0.63f}, {-0.07f, 0.94f}}, swing,
                              std::max(-swing, 0.0f) * 0.4f);
        add_.part(FourlegPart::leg).blend(0.06f);
        add_.limb(p[0], p[1], 0.54f * s_.rump, 1.45f * r, 0.62f, Vec3::UnitX());
        add_.blend(0.02f);
        add_.tube(p, std::array<float, 4>{2.0f * r, 1.4f * r, 0.88f * r, 0.7f * r});
        foot(p[3]);
    }

    void neck_and_head() {
        const float turn = pick(random_, -38, 38);
        const Vec3 root = withers() + Vec3(0, 0.22f * s_.chest, 0.35f * s_.chest);
        const Vec3 middle = root + 0.5f * s_.neck * direction(s_.neck_angle - 6, 0.3f * turn);
        const Vec3 poll = middle + 0.5f * s_.neck * direction(s_.neck_angle + 6, 0.7f * turn);
        add_.part(FourlegPart::neck).blend(0.07f);
        const float r = s_.neck_radius;
        add_.limb(root, middle, std::min(1.25f * r, 0.9f * s_.chest), r, 0.8f, Vec3::UnitX());
        add_.limb(middle, poll, r, 0.82f * r, 0.8f, Vec3::UnitX());

        const bool grazing = s_.neck_angle < 0;
        const float nod =
            grazing ? pick(random_, -65, -45) : std::min(pick(random_, -38, -8), 20 - 0.55f * s_.neck_angle);
        Frame skull{poll + 0.35f * s_.skull * direction(nod, turn), Eigen::Matrix3f::Identity()};
        skull.axes = turn_y(turn) * turn_x(-nod);  // z along the face
        add_.part(FourlegPart::head).blend(0.025f);
        add_.ellipsoid(skull, Vec3(0.86f, 1.0f, 1.1f) * s_.skull);
        add_.limb(skull * Vec3(0, -0.12f * s_.skull, 0.3f * s_.skull),
                  skull * Vec3(0, -0.28f * s_.skull, 0.84f * s_.head), 0.8f * s_.skull, s_.muzzle, 0.9f,
                  skull.axes.col(0));
        for (const float side : {1.0f, -1.0f}) ear(skull, side);
        if (s_.hoofed && s_.neck_angle > 0 && chance(random_, 0.25)) horns(skull);
    }

    void ear(const Frame& skull, float side) {
        const Frame base =
            skull.at(Vec3(side * 0.66f, 0.64f, -0.35f) * s_.skull, turn_z(side * (s_.ear_angle - 90)) * turn_x(-12));
        add_.part(FourlegPart::ear).blend(0.02f);
        const float thickness = std::max(0.42f * s_.ear_width, 0.018f) / s_.ear_width;
        add_.add(RoundCone{0.55f * s_.ear, 0.7f * s_.ear_width, s_.ear_width}, base, Vec3(1, 1, thickness));
        add_.add(RoundCone{0.45f * s_.ear, s_.ear_width, 0.5f * s_.ear_width}, base.at(Vec3(0, 0.55f * s_.ear, 0)),
                 Vec3(1, 1, thickness));
    }

    void horns(const Frame& skull) {
        const float length = pick(random_, 0.8f, 1.5f) * s_.skull, r = 0.2f * s_.skull;
        add_.part(FourlegPart::head).blend(0.015f);
        for (const float side : {1.0f, -1.0f}) {
            const std::array<Vec3, 3> control{
                skull * (Vec3(side * 0.3f, 0.85f, 0.0f) * s_.skull),
                skull * (Vec3(side * 0.42f, 0.95f, -0.05f) * s_.skull + Vec3(side * 0.3f, 0.5f, 0) * length),
                skull * (Vec3(side * 0.4f, 0.95f, 0.0f) * s_.skull + Vec3(side * 0.35f, 1.1f, 0.15f) * length)};
            add_.tube(smooth_curve(control, 5), r, std::max(0.45f * r, 0.014f));
        }
    }

    void tail() {
        const Vec3 root = croup() + Vec3(0, 0.5f * s_.rump, -0.82f * s_.rump);
        const float wag = pick(random_, -28, 28), curl = pick(random_, -45, 25);
        std::vector<Vec3> control{root};
        for (int i = 0; i < 4; ++i) {
            const float droop =
                s_.tail_angle * std::min(1.0f, 0.4f + 0.3f * static_cast<float>(i)) + curl * static_cast<float>(i) / 3;
            control.push_back(control.back() +
                              0.25f * s_.tail *
                                  direction(-std::min(droop, 86.0f), 180 + wag * (1 + 0.3f * static_cast<float>(i))));
        }
        add_.part(FourlegPart::tail).blend(0.025f);
        const auto points = smooth_curve(control, 9);
        add_.tube(points, s_.tail_radius, 0.65f * s_.tail_radius);
        if (s_.tail > 0.4f && s_.hoofed) add_.limb(points[6], points[8], 0.9f * s_.tail_radius, 1.5f * s_.tail_radius);
    }

    const Species& s_;
    Random& random_;
    Sculptor add_;
    float height_ = 0;
};

}  // namespace

ShapeModel sculpt_fourleg(Random& random) {
    ShapeModel model;
    model.detail = 0.016f;
    const Species species = pick_species(random);
    Animal(model, species, random).sculpt();
    return model;
}

}  // namespace exemplar
