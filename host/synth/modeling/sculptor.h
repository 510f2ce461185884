#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "host/core/random.h"
#include "host/synth/modeling/field.h"

namespace exemplar {

/// A shape as primitives. y is up; the shape faces +z.
struct ShapeModel {
    std::vector<Primitive> primitives;
    float detail = 0.02f;  ///< size of a grid cell that resolves the thinnest part
};

/// A coordinate frame: origin and axes (columns) in the world.
struct Frame {
    Vec3 origin = Vec3::Zero();
    Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();

    Vec3 operator*(const Vec3& local) const { return origin + axes * local; }
    /// Returns the frame at `local`, rotated by `rotation`.
    Frame at(const Vec3& local, const Eigen::Matrix3f& rotation = Eigen::Matrix3f::Identity()) const {
        return {origin + axes * local, axes * rotation};
    }
};

/// Return rotations about an axis by an angle in degrees, counter-clockwise when looking against the axis.
Eigen::Matrix3f turn_x(float degrees);
Eigen::Matrix3f turn_y(float degrees);
Eigen::Matrix3f turn_z(float degrees);
/// Returns right-handed axes whose y axis is `direction` and whose z axis is as near as possible to `side`.
Eigen::Matrix3f axes_along(const Vec3& direction, const Vec3& side = Vec3::UnitZ());

/// Returns a float in [low, high).
float pick(Random& random, float low, float high);
bool chance(Random& random, double probability);

/// Returns `count` points along the Catmull-Rom curve through the control points, ends included.
std::vector<Vec3> smooth_curve(std::span<const Vec3> control, std::size_t count);

/// Returns points of a superellipse |x/a|^p + |z/b|^p = 1.
std::vector<Vec2> superellipse(float a, float b, float power, std::size_t count);

/// Adds primitives to a model; the current part and blend width apply to the primitives that follow.
class Sculptor {
  public:
    explicit Sculptor(ShapeModel& model) : model_(model) {}

    Sculptor& part(std::int32_t part) {
        part_ = part;
        return *this;
    }
    Sculptor& blend(float width) {
        blend_ = width;
        return *this;
    }
    /// Adds a round cone between two points; `flatten` scales it across `side` (1 leaves it round).
    void limb(const Vec3& a, const Vec3& b, float radius_a, float radius_b, float flatten = 1,
              const Vec3& side = Vec3::UnitZ());
    /// Adds a tube along a polyline, radii per point; `widen` (>= 1) scales its section along the world's axes.
    void tube(std::span<const Vec3> points, std::span<const float> radii, const Vec3& widen = Vec3::Ones());
    /// Adds a tube whose radius changes linearly in the point number from first to last.
    void tube(std::span<const Vec3> points, float first, float last, const Vec3& widen = Vec3::Ones());
    void ellipsoid(const Frame& frame, const Vec3& radius) { add(Ellipsoid{radius}, frame); }
    void ball(const Vec3& center, float radius) {
        add(Ellipsoid{Vec3::Constant(radius)}, {center, Eigen::Matrix3f::Identity()});
    }
    void box(const Frame& frame, const Vec3& half, float rounding) { add(RoundBox{half, rounding}, frame); }
    /// Adds a straight bar of rectangular section between two points.
    void bar(const Vec3& a, const Vec3& b, float half_width, float half_depth, float rounding,
             const Vec3& side = Vec3::UnitZ());
    void rod(const Vec3& a, const Vec3& b, float radius, float rounding);
    void add(Solid solid, const Frame& frame, const Vec3& stretch = Vec3::Ones());

  private:
    ShapeModel& model_;
    std::int32_t part_ = 0;
    float blend_ = 0.02f;
};

}  // namespace exemplar
