#include "host/synth/animations/cloth_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "host/core/random.h"
#include "host/synth/animations/cloth.h"
#include "host/synth/animations/motion_curve.h"

namespace exemplar {
namespace {

constexpr double k_cloth_frame_rate = 30;
constexpr std::uint64_t k_cloth_task = 3;
constexpr double k_drape_radius = 0.38, k_drape_height = 0.5;

/// Turbulent wind: random plane waves that drift with the mean wind, as smooth in space as in time.
class Turbulence {
  public:
    explicit Turbulence(Random random) {
        for (Wave& wave : waves_) {
            const double length = random.uniform(1.0, 3.0);
            const Vec3d direction(random.normal(), random.normal(), random.normal());
            wave.vector = 2 * std::numbers::pi / length * direction.normalized();
            const Vec3d push(random.normal(), random.normal(), random.normal());
            wave.push = 0.35 * (push - push.dot(direction) / direction.squaredNorm() * direction);
            wave.rate = random.uniform(-5, 5);
            wave.phase = random.uniform(0, 2 * std::numbers::pi);
        }
    }
    Vec3d at(const Vec3d& place, double time) const {
        Vec3d sum = Vec3d::Zero();
        for (const Wave& wave : waves_)
            sum += std::sin(wave.vector.dot(place) + wave.rate * time + wave.phase) * wave.push;
        return sum;
    }

  private:
    struct Wave {
        Vec3d vector, push;
        double rate, phase;
    };
    std::array<Wave, 8> waves_;
};

using Vec2d = Eigen::Vector2d;

/// A strip bent, without stretching, into half a sine wave whose ends are `chord` apart.
class Pleat {
  public:
    Pleat(double length, double chord) : length_(length) {
        double low = 0, high = length;
        for (int i = 0; i < 50; ++i) {
            bend((low + high) / 2, chord);
            (arc_.back() > length ? high : low) = (low + high) / 2;
        }
    }
    /// Returns the position of the point at this arc length: along the chord, and aside from it.
    Vec2d at(double distance) const {
        const double wanted = std::clamp(distance / length_, 0.0, 1.0) * arc_.back();
        const auto next = std::max<std::size_t>(
            static_cast<std::size_t>(std::lower_bound(arc_.begin(), arc_.end(), wanted) - arc_.begin()), 1);
        const double t = (wanted - arc_[next - 1]) / (arc_[next] - arc_[next - 1]);
        return points_[next - 1] + t * (points_[next] - points_[next - 1]);
    }

  private:
    void bend(double depth, double chord) {
        constexpr int k_samples = 200;
        points_.clear();
        arc_.clear();
        for (int i = 0; i <= k_samples; ++i) {
            const double t = static_cast<double>(i) / k_samples;
            points_.emplace_back(t * chord, depth * std::sin(std::numbers::pi * t));
            arc_.push_back(i == 0 ? 0.0 : arc_.back() + (points_.back() - points_[points_.size() - 2]).norm());
        }
    }

    double length_;
    std::vector<Vec2d> points_;
    std::vector<double> arc_;  ///< length of the curve up to each point
};

/// Returns a grid with fewer particles than vertices: the surface is a spline over them, and a fold takes several.
ClothGrid grid_for(double width, double height, std::size_t vertices) {
    const double area = width * height / (static_cast<double>(vertices) / 3.2);
    const double cell = std::sqrt(area);
    ClothGrid grid;
    grid.width = width;
    grid.height = height;
    grid.columns = std::max<std::size_t>(static_cast<std::size_t>(std::lround(width / cell)) + 1, 8);
    grid.rows = std::max<std::size_t>(static_cast<std::size_t>(std::lround(height / cell)) + 1, 8);
    return grid;
}

/// Returns the particles of the flat sheet that `right` and `up` span from `corner`.
std::vector<Vec3d> flat_sheet(const ClothGrid& grid, const Vec3d& corner, const Vec3d& right, const Vec3d& up) {
    std::vector<Vec3d> positions;
    for (std::size_t r = 0; r < grid.rows; ++r)
        for (std::size_t c = 0; c < grid.columns; ++c)
            positions.emplace_back(corner + static_cast<double>(c) * grid.cell_width() * right +
                                   static_cast<double>(r) * grid.cell_height() * up);
    return positions;
}

/// Simulates a cloth, starting `lead` seconds before the first frame.
Animation simulate(const AnimationOptions& options, const ClothGrid& grid, const std::vector<Vec3d>& rest,
                   const std::vector<Vec3d>& start, const ClothMaterial& material, ClothScene scene, double lead) {
    const ClothSurface surface(grid, options.vertices, Random(options.shape_seed).fork(k_cloth_task + 1).next());
    Animation animation;
    animation.kind = AnimationKind::sequence;
    animation.rest.faces = surface.faces();
    animation.rest.vertices = surface.vertices(rest);
    Clip clip;
    clip.frames_per_second = k_cloth_frame_rate;
    Cloth cloth(grid, material, start, std::move(scene));
    if (lead > 0) cloth.advance(-lead, 0);
    for (std::size_t f = 0; f < options.frames; ++f) {
        const double time = static_cast<double>(f) / k_cloth_frame_rate;
        if (f > 0) cloth.advance(time - 1 / k_cloth_frame_rate, time);
        clip.frames.push_back(surface.vertices(cloth.positions()));
    }
    animation.clips.push_back(std::move(clip));
    return animation;
}

double duration_of(const AnimationOptions& options, double lead) {
    return lead + static_cast<double>(options.frames) / k_cloth_frame_rate;
}

Random shape_random(const AnimationOptions& options, std::uint64_t scene) {
    return Random(options.shape_seed).fork(k_cloth_task).fork(scene);
}

Random motion_random(const AnimationOptions& options, std::uint64_t scene) {
    return Random(options.motion_seed).fork(k_cloth_task + 2).fork(scene);
}

}  // namespace

Animation make_flag(const AnimationOptions& options) {
    constexpr double k_lead = 1.2;
    Random shape = shape_random(options, 1);
    const double width = shape.uniform(1.5, 1.8), height = shape.uniform(0.95, 1.1);
    const ClothGrid grid = grid_for(width, height, options.vertices);
    const std::vector<Vec3d> rest = flat_sheet(grid, Vec3d(0, 1, 0), Vec3d::UnitX(), Vec3d::UnitY());
    const Random motion = motion_random(options, 1);
    const double duration = duration_of(options, k_lead);
    const auto turbulence = std::make_shared<Turbulence>(motion.fork(1));
    const auto strength = std::make_shared<MotionCurve>(motion.fork(2), 4.5, 7.5, 0.8, duration);
    const auto heading = std::make_shared<MotionCurve>(motion.fork(3), -0.4, 0.4, 0.9, duration);
    ClothScene scene;
    for (std::size_t r = 0; r < grid.rows; ++r) scene.pinned.push_back(static_cast<std::uint32_t>(grid.index(0, r)));
    scene.pinned_position = [rest](std::uint32_t v, double) { return rest[v]; };
    scene.wind = [=](const Vec3d& place, double time) {
        const double speed = strength->at(time + k_lead), angle = heading->at(time + k_lead);
        const Vec3d mean(speed * std::cos(angle), 0.075 * speed, speed * std::sin(angle));
        return Vec3d(mean + 0.25 * speed * turbulence->at(place - mean * time, time));
    };
    return simulate(options, grid, rest, rest, {.bending = 3e-3, .damping = 60}, scene, k_lead);
}

Animation make_curtain(const AnimationOptions& options) {
    constexpr double k_lead = 0.8;
    constexpr std::size_t k_rings = 9;
    Random shape = shape_random(options, 2);
    const double width = shape.uniform(2.0, 2.3), height = shape.uniform(1.5, 1.8);
    ClothGrid grid = grid_for(width, height, options.vertices);
    const std::size_t spacing = std::max<std::size_t>((grid.columns + k_rings / 2) / (k_rings - 1), 2);
    grid.columns = spacing * (k_rings - 1) + 1;
    const std::vector<Vec3d> rest = flat_sheet(grid, Vec3d(0, 0, 0), Vec3d::UnitX(), Vec3d::UnitY());
    const Random motion = motion_random(options, 2);
    const double duration = duration_of(options, k_lead);
    const auto turbulence = std::make_shared<Turbulence>(motion.fork(1));
    const auto closed = std::make_shared<MotionCurve>(motion.fork(2), 0.45, 0.9, 0.8, duration);
    const auto shift = std::make_shared<MotionCurve>(motion.fork(3), -0.3, 0.3, 0.8, duration);
    const auto draft = std::make_shared<MotionCurve>(motion.fork(4), -1.4, 1.4, 0.7, duration);
    ClothScene scene;
    for (std::size_t i = 0; i < k_rings; ++i)
        scene.pinned.push_back(static_cast<std::uint32_t>(grid.index(i * spacing, grid.rows - 1)));
    const auto along_rod = [=](double x, double time) {
        return width / 2 + shift->at(time + k_lead) + (x - width / 2) * closed->at(time + k_lead);
    };
    scene.pinned_position = [=](std::uint32_t v, double time) {
        return Vec3d(along_rod(rest[v].x(), time), rest[v].y(), 0);
    };
    scene.wind = [=](const Vec3d& place, double time) {
        const double speed = draft->at(time + k_lead);
        return Vec3d(Vec3d(0, 0, speed) + 0.5 * turbulence->at(place, time));
    };
    const double ring_distance = width / static_cast<double>(k_rings - 1);
    const Pleat pleat(ring_distance, ring_distance * closed->at(0));
    std::vector<Vec3d> start = rest;
    for (Vec3d& p : start) {
        const double place = std::floor(p.x() / ring_distance + 1e-9), along = p.x() - place * ring_distance;
        const Vec2d bent = pleat.at(along);
        const double side = std::lround(place) % 2 == 0 ? 1.0 : -1.0;  // pleats to alternating sides
        p = Vec3d(along_rod(place * ring_distance, -k_lead) + bent.x(), p.y(), side * bent.y());
    }
    return simulate(options, grid, rest, start, {.density = 0.3, .bending = 4e-3}, scene, k_lead);
}

std::function<Ball3(double)> drape_ball(const AnimationOptions& options) {
    const Random motion = motion_random(options, 3);
    const double duration = duration_of(options, 0);
    const auto x = std::make_shared<MotionCurve>(motion.fork(1), -0.25, 0.25, 0.9, duration);
    const auto y = std::make_shared<MotionCurve>(motion.fork(2), -0.1, 0.1, 0.9, duration);
    const auto z = std::make_shared<MotionCurve>(motion.fork(3), -0.25, 0.25, 0.9, duration);
    const auto spin = std::make_shared<MotionCurve>(motion.fork(4), -2.0, 2.0, 0.8, duration);
    return [=](double time) {
        constexpr double k_moment = 1e-3;
        const auto center = [&](double t) {
            // At first under the middle of the sheet, so that the sheet falls on it symmetrically.
            const double free = std::clamp((t - 0.3) / 1.2, 0.0, 1.0), eased = free * free * (3 - 2 * free);
            return Vec3d(eased * Vec3d(x->at(t), y->at(t), z->at(t)));
        };
        Ball3 ball;
        ball.radius = k_drape_radius;
        ball.center = center(time);
        ball.velocity = (center(time + k_moment) - center(time)) / k_moment;
        ball.spin = std::clamp(time - 0.6, 0.0, 1.0) * spin->at(time);
        return ball;
    };
}

Animation make_drape(const AnimationOptions& options) {
    Random shape = shape_random(options, 3);
    const double width = shape.uniform(1.5, 1.7), height = shape.uniform(1.5, 1.7);
    const ClothGrid grid = grid_for(width, height, options.vertices);
    const std::vector<Vec3d> rest =
        flat_sheet(grid, Vec3d(-width / 2, k_drape_height, height / 2), Vec3d::UnitX(), -Vec3d::UnitZ());
    ClothScene scene;
    scene.ball = drape_ball(options);
    scene.wind = [](const Vec3d&, double) { return Vec3d(Vec3d::Zero()); };  // still air
    return simulate(options, grid, rest, rest, {.density = 0.25, .bending = 4e-3}, scene, 0);
}

}  // namespace exemplar
