#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/features/hatching_surface.h"
#include "host/imaging/camera.h"
#include "host/imaging/gbuffer.h"
#include "host/learn/feature_matrix.h"

namespace exemplar {

/// Camera, light and image size of a drawing.
struct HatchingView {
    Camera camera;
    Vec3 light = Vec3::UnitZ();  ///< unit direction to the distant light, mesh coordinates
    int width = 0, height = 0;   ///< pixels
    Vec3 up = Vec3::UnitY();     ///< of the object, mesh coordinates; any length but zero
};

/// Returns the unit direction to a light in mesh coordinates. `direction` is in eye coordinates: x right, y up, z
/// towards the eye; any length but zero.
Vec3 light_from(const Camera& camera, const Vec3& direction);
/// Returns the usual light: from above, left, behind the eye.
Vec3 default_light(const Camera& camera);

/// Returns the size of an object in a view: its median geodesic distance, in pixels at the depth of its middle.
float size_in_view(const HatchingSurface& surface, const HatchingView& view);

/// Projects a direction at a point of the surface into the image; only the direction of the result is meaningful.
Vec2 projected_direction(const HatchingView& view, const Eigen::Matrix4f& view_projection, const Vec3& point,
                         const Vec3& direction);

/// The pixels that show the surface, row by row; they are the rows of feature matrices.
struct CoveredPixels {
    std::vector<std::uint32_t> pixel;  ///< N: y * width + x
    std::vector<std::int32_t> row;     ///< per pixel of the image: its index in `pixel`, or -1
};
CoveredPixels covered_pixels(const GBuffer& gbuffer);

/// Computes the features per vertex that depend on surface and view (thesis App. B.2): V x 90, 15 functions of
/// curvature and their magnitudes at each of the three scales. Curvatures are in units of 1 / (median geodesic
/// distance), derivatives and products of two in units of its square; all are clamped to what a patch of their scale
/// can resolve.
FeatureMatrix view_curvature_features(const HatchingSurface& surface, const HatchingView& view);
constexpr std::size_t k_curvature_functions = 15;
constexpr std::size_t k_view_curvature_columns = 2 * k_curvature_functions * k_hatching_scales.size();

/// Returns the names of the columns of view_curvature_features.
std::vector<std::string> view_curvature_names();

}  // namespace exemplar
