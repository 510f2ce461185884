#include <cmath>
#include <vector>

#include "host/synth/shapes/models.h"

namespace exemplar {
namespace {

struct OctopusPart {
    enum : std::int32_t { head, tentacle };
};

/// The course of a tentacle: angles in degrees, positions as shares of its length.
struct Sway {
    float azimuth, drift, droop, wave, phase, curl, curl_side;
};

std::vector<Vec3> tentacle_path(const Vec3& root, float length, const Sway& sway, std::size_t count) {
    constexpr float k_degree = 0.017453293f;
    std::vector<Vec3> points{root};
    const float step = length / static_cast<float>(count - 1);
    for (std::size_t i = 1; i < count; ++i) {
        const float s = static_cast<float>(i) / static_cast<float>(count - 1);
        const float tip = s > 0.5f ? (s - 0.5f) * (s - 0.5f) * 4 : 0.0f;
        const float elevation =
            (-sway.droop * (1 - 1.6f * s) + sway.wave * std::sin(5.5f * s + sway.phase) * s + sway.curl * tip) *
            k_degree;
        const float azimuth = (sway.azimuth + sway.drift * std::sin(3.1416f * s) + sway.curl_side * tip) * k_degree;
        points.push_back(points.back() + step * Vec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                                     std::cos(elevation) * std::cos(azimuth)));
    }
    return points;
}

void mantle(Sculptor& add, Random& random) {
    const float width = pick(random, 0.24f, 0.32f), height = pick(random, 0.3f, 0.48f), lean = pick(random, -48, 5);
    const Frame base{Vec3(0, 0.12f, 0), turn_x(lean)};
    add.part(OctopusPart::head).blend(0.1f);
    add.ellipsoid({Vec3(0, 0.09f, 0)}, Vec3(0.24f, 0.17f, 0.24f));
    add.ellipsoid(base.at(Vec3(0, 0.6f * height + 0.1f, 0)), Vec3(width, height, width * pick(random, 0.88f, 1.05f)));
    add.limb(base.origin, base * Vec3(0, height, 0), 0.2f, 0.7f * width);
    add.blend(0.02f);
    for (const float side : {1.0f, -1.0f}) add.ball(Vec3(side * 0.15f, 0.21f, 0.17f), pick(random, 0.055f, 0.07f));
}

}  // namespace

ShapeModel sculpt_octopus(Random& random) {
    ShapeModel model;
    model.detail = 0.017f;
    Sculptor add(model);
    mantle(add, random);
    const std::size_t arms = chance(random, 0.8) ? 8 : 6 + random.index(2);
    const float length = pick(random, 0.95f, 1.45f), radius = pick(random, 0.075f, 0.1f);
    const float droop = pick(random, 5, 55), turn = pick(random, 0, 45);
    add.part(OctopusPart::tentacle);
    for (std::size_t i = 0; i < arms; ++i) {
        const float sector = 360 / static_cast<float>(arms);
        Sway sway{};
        sway.azimuth = turn + sector * static_cast<float>(i) + pick(random, -4, 4);
        sway.drift = pick(random, -26, 26);
        sway.droop = droop + pick(random, -15, 15);
        sway.wave = pick(random, 0, 38);
        sway.phase = pick(random, 0, 6.28f);
        sway.curl = pick(random, -20, 210);
        sway.curl_side = pick(random, -70, 70);
        const float a = sway.azimuth * 0.017453293f;
        const Vec3 root(0.15f * std::sin(a), 0.02f, 0.15f * std::cos(a));
        const auto points = tentacle_path(root, length * pick(random, 0.85f, 1.1f), sway, 22);
        add.blend(0.035f);
        add.tube(points, radius, 0.024f);
    }
    return model;
}

}  // namespace exemplar
