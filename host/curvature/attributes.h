#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "host/mesh/curvature.h"
#include "host/mesh/mesh.h"
#include "host/mesh/tangent_tensors.h"

namespace exemplar {

/// How the curvature of a vertex is written as numbers that follow a pose smoothly.
///
/// principal: the thesis' eight (Sec. 5.3.1): k1, k2, two components of e1 in the frame of the vertex' rigid segment,
/// and the derivative tensor in (e1, e2). tensor: seven: the second fundamental form (II11, II12, II22) and the
/// derivative tensor (C111, C112, C122, C222) in a tangent frame that moves with the segment. The seven stay smooth
/// where k1 meets k2, where the principal directions, and with them six of the eight, jump; the price is an eigenvalue
/// problem of two by two per vertex.
enum class AttributeSet : std::uint32_t { principal = 0, tensor = 1 };

constexpr std::size_t k_most_attributes = 8;
/// The left-out coordinate of e1 is divided by the normal's, which is kept from being smaller: where the normal has
/// turned away from its place in training, the division would enlarge every error.
constexpr float k_least_divisor = 0.2f;
std::size_t attribute_count(AttributeSet set);
std::string_view attribute_name(AttributeSet set, std::size_t attribute);
/// Whether an attribute is of third order (a component of the derivative tensor); those are learned with cubic
/// features.
bool is_derivative(AttributeSet set, std::size_t attribute);

/// Writes curvature as attributes and back. A vertex' frame: its normal at rest in its segment, `reference_normal`, has
/// the first axis any_frame(reference_normal).tangent; the least rotation to the present normal carries it along.
struct AttributeFrames {
    AttributeSet set = AttributeSet::tensor;
    std::vector<std::uint32_t> segment;  ///< of each vertex
    std::vector<Vec3> reference_normal;  ///< of each vertex, unit, in the coordinates of its segment
    /// principal only: which way e1 points in training, in the coordinates of the segment; its sign is chosen by it.
    std::vector<Vec3> reference_direction;

    std::size_t vertex_count() const { return segment.size(); }

    /// Attributes of all vertices, attribute-major (attribute_count x vertices). `rotations` turn the coordinates of
    /// each segment to the world's; `normals` are the world's.
    void encode(const VertexCurvature& curvature, std::span<const Vec3> normals,
                std::span<const Eigen::Matrix3f> rotations, std::span<float> attributes) const;
    /// The inverse, up to the sign of the principal directions: k1 >= k2, unit e1 and e2 orthogonal to the normals.
    void decode(std::span<const float> attributes, std::span<const Vec3> normals,
                std::span<const Eigen::Matrix3f> rotations, VertexCurvature& curvature) const;
};

/// `axis`, orthogonal to the unit vector `from`, turned by the least rotation from `from` to the unit vector `to`.
Vec3 carried(const Vec3& axis, const Vec3& from, const Vec3& to);

}  // namespace exemplar
