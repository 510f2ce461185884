#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "host/mesh/curvature/curvature.h"
#include "host/mesh/mesh.h"
#include "host/mesh/curvature/tangent_tensors.h"

namespace exemplar {

/// How the curvature of a vertex is written as numbers that follow a pose smoothly.
///
/// tensor: seven: the second fundamental form (II11, II12, II22) and the derivative tensor (C111, C112, C122, C222) in
/// the tangent frame whose first axis is an edge of the mesh, so that it moves with the surface as if drawn on it.
/// principal: the thesis' eight (Sec. 5.3.1): k1, k2, two components of e1 in the frame of the vertex' rigid segment,
/// and the derivative tensor in (e1, e2). The seven stay smooth where k1 meets k2, where principal directions, and with
/// them six of the eight, jump, and where a limb twists against its segment; the price is an eigenvalue problem of two
/// by two per vertex.
enum class AttributeSet : std::uint32_t { principal = 0, tensor = 1 };

constexpr std::size_t k_most_attributes = 8;
/// The left-out coordinate of e1 is divided by the normal's, which is kept from being smaller: where the normal has
/// turned away from its place in training, the division would enlarge every error.
constexpr float k_least_divisor = 0.2f;
/// An edge with less of its squared length than this in the tangent plane has no direction there.
constexpr float k_least_flat = 1e-6f;
std::size_t attribute_count(AttributeSet set);
std::string_view attribute_name(AttributeSet set, std::size_t attribute);
/// Whether an attribute is of third order (a component of the derivative tensor); those are learned with cubic
/// features.
bool is_derivative(AttributeSet set, std::size_t attribute);

/// A surface at one moment, as attributes are written and read on it.
struct PosedSurface {
    std::span<const Vec3> vertices, normals;  ///< normals: unit
    std::span<const Eigen::Matrix3f>
        rotations{};  ///< principal only: from the coordinates of each segment to the world
};

/// Writes curvature as attributes and back.
struct AttributeFrames {
    AttributeSet set = AttributeSet::tensor;
    std::vector<std::uint32_t> neighbor;  ///< tensor: where the edge leads to that is the first axis at each vertex
    std::vector<std::uint32_t> segment;   ///< principal: of each vertex
    /// principal: mean normal in training, in the coordinates of the segment. The coordinate of e1 that is left out is
    /// the one that this is longest along.
    std::vector<Vec3> reference_normal;
    std::vector<Vec3> reference_direction;  ///< principal, for writing: the mean of e1, which its sign is chosen by

    std::size_t vertex_count() const { return set == AttributeSet::tensor ? neighbor.size() : segment.size(); }

    /// Attributes of all vertices, attribute-major (attribute_count x vertices).
    void encode(const VertexCurvature& curvature, const PosedSurface& surface, std::span<float> attributes) const;
    /// The inverse, up to the sign of the principal directions: k1 >= k2, unit e1 and e2 orthogonal to the normals.
    void decode(std::span<const float> attributes, const PosedSurface& surface, VertexCurvature& curvature) const;

  private:
    Vec3 completed_direction(float first, float second, std::size_t v, const PosedSurface& surface) const;
};

/// The direction of an edge in the tangent plane of `normal`, unit; some tangent if it stands upright.
Vec3 edge_tangent(const Vec3& edge, const Vec3& normal);

}  // namespace exemplar
