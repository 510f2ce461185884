#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// A pair of glasses in millimeters: x points to the left of who wears them, y up and z forward. The origin is between
/// the lenses. Pairs are left, then right.
struct GlassesParts {
    TriangleMesh mesh;
    std::array<std::vector<std::uint32_t>, 2> lens_faces;
    std::array<std::vector<std::uint32_t>, 2> arm_faces;
    std::array<Vec3, 2> arm_root;  ///< the length-weighted centroid of the boundary between arm and frame
    std::array<Vec3, 2> arm_tip;   ///< the centroid of the twentieth of the arm's area that is farthest from the root
};

/// The labels of lenses and arms, as indices of `names`.
struct GlassesLabels {
    std::int32_t lens = -1, arm = -1;
};
/// Finds the labels named `lens` and `arm`; if empty, those with a usual name (lens, glass; arm, temple, skeleton).
/// Throws UsageError that lists the labels of the mesh if there is none.
GlassesLabels glasses_labels(const std::vector<std::string>& names, const std::string& lens, const std::string& arm);

/// Finds the parts of glasses and turns them upright. x is the normal of the mirror plane of everything but the arms
/// that separates the arms; z is the direction within that plane in which the lenses have the largest projected area,
/// away from the arms; y points up, as arms bend down towards their tips. The frame, which is everything but the arms,
/// becomes `width` wide. Throws MeshError if the surface is open or has no two arms.
GlassesParts glasses_parts(const TriangleMesh& mesh, std::span<const std::int32_t> label, const GlassesLabels& labels,
                           double width);

}  // namespace exemplar
