#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/features/hatching_surface.h"
#include "host/hatching/features/hatching_view.h"
#include "host/hatching/features/orientation_fields.h"
#include "host/learn/feature_matrix.h"

namespace exemplar {

/// Points on faces of a mesh, such as those that pixels show.
struct FacePoints {
    std::vector<std::uint32_t> face;                ///< N
    std::vector<std::array<float, 2>> barycentric;  ///< N: of corners 1 and 2; the rest is corner 0's

    std::size_t size() const { return face.size(); }
};

/// Takes what is known of a mesh's vertices to points of its faces: the CPU implementation is the reference;
/// gpu/hatching implements it in shaders. Values are finite. Outputs hold one column of N after the other. All throw
/// UsageError if sizes do not fit, or a face, a corner or a column does not exist.
class PixelProjection {
  public:
    virtual ~PixelProjection() = default;
    PixelProjection() = default;
    PixelProjection(const PixelProjection&) = delete;
    PixelProjection& operator=(const PixelProjection&) = delete;

    /// The columns `which` of `values` (a row per vertex), linear over each face.
    virtual void scalars(const TriangleMesh& mesh, const FacePoints& points, const FeatureMatrix& values,
                         std::span<const std::uint32_t> which, std::span<float> out) = 0;
    /// The columns `which` of view_curvature_features(surface, view), likewise.
    virtual void curvature(const HatchingSurface& surface, const HatchingView& view, const FacePoints& points,
                           std::span<const std::uint32_t> which, std::span<float> out) = 0;
    /// Fields of directions without sign (a vector of any length per vertex; zero: none) in the picture: at each point
    /// the mean of those of the corners, which are turned to the first that has one, as the view shows it there; a unit
    /// vector of doubled angle, or zero where there is no direction.
    virtual void directions(const TriangleMesh& mesh, const HatchingView& view, const FacePoints& points,
                            std::span<const std::span<const Vec3>> fields, std::span<DoubledAngle> out) = 0;
};

class CpuPixelProjection final : public PixelProjection {
  public:
    void scalars(const TriangleMesh& mesh, const FacePoints& points, const FeatureMatrix& values,
                 std::span<const std::uint32_t> which, std::span<float> out) override;
    void curvature(const HatchingSurface& surface, const HatchingView& view, const FacePoints& points,
                   std::span<const std::uint32_t> which, std::span<float> out) override;
    void directions(const TriangleMesh& mesh, const HatchingView& view, const FacePoints& points,
                    std::span<const std::span<const Vec3>> fields, std::span<DoubledAngle> out) override;
};

/// A value or vector per vertex at a point.
template <typename Values>
auto interpolate(const TriangleMesh& mesh, const FacePoints& points, std::size_t i, const Values& values) {
    const Face& face = mesh.faces[points.face[i]];
    const auto& [b, c] = points.barycentric[i];
    using Value = std::decay_t<decltype(values[0])>;
    return Value((1 - b - c) * values[face[0]] + b * values[face[1]] + c * values[face[2]]);
}

/// What each PixelProjection throws before it does anything.
void check_projection(const TriangleMesh& mesh, const FacePoints& points);
void check_scalars(const TriangleMesh& mesh, const FacePoints& points, const FeatureMatrix& values,
                   std::span<const std::uint32_t> which, std::span<const float> out);
void check_curvature(const HatchingSurface& surface, const FacePoints& points, std::span<const std::uint32_t> which,
                     std::span<const float> out);
void check_directions(const TriangleMesh& mesh, const FacePoints& points, std::span<const std::span<const Vec3>> fields,
                      std::span<const DoubledAngle> out);

}  // namespace exemplar
