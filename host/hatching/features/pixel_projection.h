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
    std::vector<std::array<float, 2>> barycentric;  ///< N: weights of corners 1 and 2; corner 0 has the rest

    std::size_t size() const { return face.size(); }
};

/// Interpolates values at a mesh's vertices at points of its faces. The CPU implementation is the reference;
/// gpu/hatching implements it in shaders. Values are finite. Outputs hold one column of N values after the other.
/// All functions throw UsageError if sizes do not fit, or a face, a corner or a column does not exist.
class PixelProjection {
  public:
    virtual ~PixelProjection() = default;
    PixelProjection() = default;
    PixelProjection(const PixelProjection&) = delete;
    PixelProjection& operator=(const PixelProjection&) = delete;

    /// Interpolates the columns `which` of `values` (a row per vertex) linearly over each face.
    virtual void scalars(const TriangleMesh& mesh, const FacePoints& points, const FeatureMatrix& values,
                         std::span<const std::uint32_t> which, std::span<float> out) = 0;
    /// Interpolates the columns `which` of view_curvature_features(surface, view) likewise.
    virtual void curvature(const HatchingSurface& surface, const HatchingView& view, const FacePoints& points,
                           std::span<const std::uint32_t> which, std::span<float> out) = 0;
    /// Projects fields of unsigned directions into the image. A field has a vector of any length per vertex; zero:
    /// none. The vectors of a face's corners are interpolated at each point, after their signs are made to agree
    /// with the first one that is not zero, and the mean is projected. Results are unit vectors of doubled angle, or
    /// zero where there is no direction.
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

/// Interpolates per-vertex values or vectors at point i.
template <typename Values>
auto interpolate(const TriangleMesh& mesh, const FacePoints& points, std::size_t i, const Values& values) {
    const Face& face = mesh.faces[points.face[i]];
    const auto& [b, c] = points.barycentric[i];
    using Value = std::decay_t<decltype(values[0])>;
    return Value((1 - b - c) * values[face[0]] + b * values[face[1]] + c * values[face[2]]);
}

/// The checks of arguments that every PixelProjection makes first; they throw UsageError.
void check_projection(const TriangleMesh& mesh, const FacePoints& points);
void check_scalars(const TriangleMesh& mesh, const FacePoints& points, const FeatureMatrix& values,
                   std::span<const std::uint32_t> which, std::span<const float> out);
void check_curvature(const HatchingSurface& surface, const FacePoints& points, std::span<const std::uint32_t> which,
                     std::span<const float> out);
void check_directions(const TriangleMesh& mesh, const FacePoints& points, std::span<const std::span<const Vec3>> fields,
                      std::span<const DoubledAngle> out);

}  // namespace exemplar
