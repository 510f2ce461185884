#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// A grid of particles over a rectangle: row by row, `columns` x `rows` of them.
struct ClothGrid {
    std::size_t columns = 0, rows = 0;  ///< at least 4 each
    double width = 1, height = 1;       ///< size of the rectangle

    std::size_t size() const { return columns * rows; }
    double cell_width() const { return width / static_cast<double>(columns - 1); }
    double cell_height() const { return height / static_cast<double>(rows - 1); }
    std::size_t index(std::size_t column, std::size_t row) const { return row * columns + column; }
};

/// Material of a cloth in SI units; the defaults are a light woven one.
struct ClothMaterial {
    double density = 0.18;    ///< kg per square meter
    double stretch = 4000;    ///< N per meter, along the threads
    double shear = 1500;      ///< N per meter, across them
    double bending = 1.2e-3;  ///< N meters
    double damping = 40;      ///< per second, of the velocity differences between neighbors
};

/// A ball that cloth cannot pass. Its rotation carries cloth along.
struct Ball3 {
    Vec3d center = Vec3d::Zero(), velocity = Vec3d::Zero();
    double radius = 0;
    double spin = 0;  ///< radians per second about +y
};

/// Constraints and forces on a cloth, as functions of the time in seconds (negative before the first frame).
struct ClothScene {
    std::vector<std::uint32_t> pinned;                            ///< particles whose position is prescribed
    std::function<Vec3d(std::uint32_t, double)> pinned_position;  ///< position of a pinned particle at a time
    std::function<Vec3d(const Vec3d&, double)> wind;              ///< air velocity at a place; none if empty
    std::function<Ball3(double)> ball;                            ///< none if empty
};

/// Simulates cloth by extended position-based dynamics (XPBD: Macklin, Mueller and Chentanez 2016) with many small
/// steps of one iteration each (Macklin et al. 2019). Constraints are distances along and across the threads, and
/// second differences for bending, which measure curvature in cloth that hardly stretches. The cloth does not
/// collide with itself. Deterministic.
class Cloth {
  public:
    /// Particles start at `positions` (grid.size() of them), at rest.
    Cloth(const ClothGrid& grid, const ClothMaterial& material, std::vector<Vec3d> positions, ClothScene scene);

    /// Simulates from time `from` to time `to` (seconds).
    void advance(double from, double to);
    const std::vector<Vec3d>& positions() const { return positions_; }
    double kinetic_energy() const;  ///< joules

  private:
    struct Distance {
        std::uint32_t a, b;
        double rest, compliance;
    };
    struct Bend {
        std::uint32_t a, middle, c;
        double compliance;
    };

    void connect(const ClothMaterial& material);
    void add_distance(std::size_t a, std::size_t b, double rest, double stiffness, double across);
    void accelerate(double time);
    void step(double time, double duration);
    void solve_distance(const Distance& constraint, double per_square_second);
    void solve_bend(const Bend& constraint, double per_square_second);
    void collide(const Ball3& ball, double duration);
    void damp_relative_motion(double share);

    ClothGrid grid_;
    ClothScene scene_;
    double mass_, damping_, thickness_;
    std::vector<Vec3d> positions_, before_, velocities_, accelerations_;
    std::vector<double> inverse_mass_;
    std::vector<Distance> distances_;
    std::vector<Bend> bends_;
};

/// A triangulated rectangle that follows a grid of particles as a bicubic B-spline surface, so that its curvature is
/// continuous for any particle positions. Its vertices are not on a grid: rows are staggered and vertices jittered,
/// so that triangles are nearly equilateral and have no common direction.
class ClothSurface {
  public:
    ClothSurface(const ClothGrid& grid, std::size_t vertices, std::uint64_t seed);

    const std::vector<Face>& faces() const { return faces_; }
    /// Returns the vertex positions for these particles.
    std::vector<Vec3> vertices(const std::vector<Vec3d>& particles) const;

  private:
    void add_vertex(double x, double y);
    void zip_rows(std::size_t lower, std::size_t lower_end, std::size_t upper, std::size_t upper_end);

    ClothGrid grid_;
    std::vector<Vec2> parameters_;  ///< in units of grid cells
    std::vector<Face> faces_;
};

}  // namespace exemplar
