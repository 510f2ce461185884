#include "host/synth/animations/cloth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "host/core/interrupt.h"

namespace exemplar {
namespace {

constexpr double k_gravity = 9.81;
constexpr double k_air_density = 1.2, k_skin_friction = 0.04;  // kg / m^3; share of the pressure along the cloth
constexpr double k_step = 5e-4;                                // seconds: hanging cloth stretches by about step^2
constexpr int k_steps_per_force = 6;                           // air pressure changes slowly
constexpr double k_friction = 0.6, k_sticky_slope = 0.5;       // of a ball

}  // namespace

Cloth::Cloth(const ClothGrid& grid, const ClothMaterial& material, std::vector<Vec3d> positions, ClothScene scene)
    : grid_(grid),
      scene_(std::move(scene)),
      mass_(material.density * grid.cell_width() * grid.cell_height()),
      damping_(material.damping),
      thickness_(0.3 * std::max(grid.cell_width(), grid.cell_height())),
      positions_(std::move(positions)),
      before_(positions_),
      velocities_(positions_.size(), Vec3d::Zero()),
      accelerations_(positions_.size(), Vec3d::Zero()),
      inverse_mass_(positions_.size(), 1 / mass_) {
    for (const std::uint32_t v : scene_.pinned) inverse_mass_[v] = 0;
    connect(material);
}

/// Adds a distance constraint. A thread represents a strip of cloth `across` wide.
void Cloth::add_distance(std::size_t a, std::size_t b, double rest, double stiffness, double across) {
    distances_.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), rest, rest / (stiffness * across)});
}

void Cloth::connect(const ClothMaterial& material) {
    const double dx = grid_.cell_width(), dy = grid_.cell_height(), diagonal = std::hypot(dx, dy);
    const auto bend = [&](std::size_t a, std::size_t m, std::size_t c, double along, double across) {
        // Energy (bending / 2) kappa^2 per area, with kappa = |a - 2 m + c| / along^2.
        const double compliance = along * along * along / (material.bending * across);
        bends_.push_back(
            {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(m), static_cast<std::uint32_t>(c), compliance});
    };
    for (std::size_t r = 0; r < grid_.rows; ++r) {
        for (std::size_t c = 0; c < grid_.columns; ++c) {
            const std::size_t v = grid_.index(c, r), right = v + 1, up = v + grid_.columns;
            const bool has_right = c + 1 < grid_.columns, has_up = r + 1 < grid_.rows;
            if (has_right) add_distance(v, right, dx, material.stretch, dy);
            if (has_up) add_distance(v, up, dy, material.stretch, dx);
            if (has_right && has_up) {
                add_distance(v, up + 1, diagonal, material.shear, std::min(dx, dy));
                add_distance(right, up, diagonal, material.shear, std::min(dx, dy));
            }
            if (c + 2 < grid_.columns) bend(v, v + 1, v + 2, dx, dy);
            if (r + 2 < grid_.rows) bend(v, up, up + grid_.columns, dy, dx);
        }
    }
}

/// Computes accelerations by gravity and by the pressure of the air that blows against the cloth.
void Cloth::accelerate(double time) {
    std::fill(accelerations_.begin(), accelerations_.end(), Vec3d(0, -k_gravity, 0));
    if (!scene_.wind) return;
    const double per_mass = 0.5 * k_air_density * grid_.cell_width() * grid_.cell_height() / mass_;
    for (std::size_t r = 0; r < grid_.rows; ++r) {
        for (std::size_t c = 0; c < grid_.columns; ++c) {
            const std::size_t left = c > 0 ? c - 1 : c, right = std::min(c + 1, grid_.columns - 1);
            const std::size_t low = r > 0 ? r - 1 : r, high = std::min(r + 1, grid_.rows - 1);
            const std::size_t v = grid_.index(c, r);
            const Vec3d along = positions_[grid_.index(right, r)] - positions_[grid_.index(left, r)];
            const Vec3d normal = along.cross(positions_[grid_.index(c, high)] - positions_[grid_.index(c, low)]);
            const double area = normal.norm();
            if (area < 1e-12) continue;
            const Vec3d wind = scene_.wind(positions_[v], time) - velocities_[v], n = normal / area;
            const double across = wind.dot(n);
            accelerations_[v] +=
                per_mass * (std::abs(across) * across * n + k_skin_friction * wind.norm() * (wind - across * n));
        }
    }
}

void Cloth::solve_distance(const Distance& constraint, double per_square_second) {
    const double wa = inverse_mass_[constraint.a], wb = inverse_mass_[constraint.b];
    const Vec3d offset = positions_[constraint.b] - positions_[constraint.a];
    const double length = offset.norm(), soft = wa + wb + constraint.compliance * per_square_second;
    if (wa + wb == 0 || length < 1e-12) return;
    // With one iteration per step the multiplier starts at zero and need not be kept.
    const Vec3d push = (length - constraint.rest) / (soft * length) * offset;
    positions_[constraint.a] += wa * push;
    positions_[constraint.b] -= wb * push;
}

void Cloth::solve_bend(const Bend& constraint, double per_square_second) {
    const double wa = inverse_mass_[constraint.a], wm = inverse_mass_[constraint.middle],
                 wc = inverse_mass_[constraint.c];
    const double soft = wa + 4 * wm + wc + constraint.compliance * per_square_second;
    const Vec3d push = (positions_[constraint.a] - 2 * positions_[constraint.middle] + positions_[constraint.c]) / soft;
    positions_[constraint.a] -= wa * push;
    positions_[constraint.middle] += 2 * wm * push;
    positions_[constraint.c] -= wc * push;
}

/// Moves particles out of the ball and applies friction where they slide over it.
void Cloth::collide(const Ball3& ball, double duration) {
    const double radius = ball.radius + thickness_;
    for (std::size_t v = 0; v < positions_.size(); ++v) {
        const Vec3d offset = positions_[v] - ball.center;
        const double distance = offset.norm(), depth = radius - distance;
        if (depth <= 0 || inverse_mass_[v] == 0 || distance < 1e-12) continue;
        const Vec3d normal = offset / distance;
        positions_[v] += depth * normal;
        const Vec3d carried = duration * (ball.velocity + ball.spin * Vec3d::UnitY().cross(offset));
        Vec3d slide = positions_[v] - before_[v] - carried;
        slide -= slide.dot(normal) * normal;
        const double length = slide.norm();
        // On top the cloth sticks, else a sheet that hangs unevenly would slide off.
        const double held = normal.y() > k_sticky_slope ? 1.0 : k_friction * depth / std::max(length, 1e-12);
        positions_[v] -= std::min(1.0, held) * slide;
    }
}

/// Damps the difference between a particle's velocity and the mean of its neighbors'.
void Cloth::damp_relative_motion(double share) {
    // before_ is not in use here, so it holds the old velocities.
    std::swap(before_, velocities_);
    for (std::size_t r = 0; r < grid_.rows; ++r) {
        for (std::size_t c = 0; c < grid_.columns; ++c) {
            const std::size_t v = grid_.index(c, r);
            Vec3d sum = Vec3d::Zero();
            int count = 0;
            const auto add = [&](std::size_t u) {
                sum += before_[u];
                ++count;
            };
            if (c > 0) add(v - 1);
            if (c + 1 < grid_.columns) add(v + 1);
            if (r > 0) add(v - grid_.columns);
            if (r + 1 < grid_.rows) add(v + grid_.columns);
            velocities_[v] = before_[v] + share * (sum / count - before_[v]);
        }
    }
}

void Cloth::step(double time, double duration) {
    const double per_square_second = 1 / (duration * duration);
    for (std::size_t v = 0; v < positions_.size(); ++v) {
        if (inverse_mass_[v] > 0) velocities_[v] += duration * accelerations_[v];
        before_[v] = positions_[v];
        positions_[v] += duration * velocities_[v];
    }
    for (const std::uint32_t v : scene_.pinned) positions_[v] = scene_.pinned_position(v, time + duration);
    // Constraints are always solved in the same order: alternating the direction would excite vibrations with a
    // period of two steps.
    for (const Bend& c : bends_) solve_bend(c, per_square_second);
    for (const Distance& c : distances_) solve_distance(c, per_square_second);
    if (scene_.ball) collide(scene_.ball(time + duration), duration);
    for (std::size_t v = 0; v < positions_.size(); ++v) velocities_[v] = (positions_[v] - before_[v]) / duration;
    damp_relative_motion(std::min(damping_ * duration, 0.5));
}

void Cloth::advance(double from, double to) {
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / k_step)));
    const double duration = (to - from) / steps;
    for (int i = 0; i < steps; ++i) {
        check_interrupt();
        const double time = from + i * duration;
        if (i % k_steps_per_force == 0) accelerate(time);
        step(time, duration);
    }
}

double Cloth::kinetic_energy() const {
    double sum = 0;
    for (const Vec3d& v : velocities_) sum += 0.5 * mass_ * v.squaredNorm();
    return sum;
}

}  // namespace exemplar
