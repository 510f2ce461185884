#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/curvature/curvature.h"
#include "host/mesh/curvature/tangent_tensors.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// How the curvature of a vertex is encoded as numbers that vary smoothly with the pose.
///
/// tensor: 7 numbers, the second fundamental form (II11, II12, II22) and the derivative tensor (C111, C112, C122,
/// C222) in a tangent frame whose first axis is an edge of the mesh, so that the frame moves with the surface.
/// principal: the 8 numbers of the thesis (Sec. 5.3.1): k1, k2, two components of e1 in the frame of the vertex'
/// rigid segment, and the derivative tensor in (e1, e2).
/// tensor stays smooth where k1 = k2, where directions and so six of the eight numbers jump, and where a limb twists
/// against its segment; the cost is a 2 x 2 eigenvalue problem per vertex.
enum class AttributeSet : std::uint32_t { principal = 0, tensor = 1 };

constexpr std::size_t k_max_attributes = 8;
/// Minimum magnitude of the normal's coordinate by which the left-out coordinate of e1 is divided. It limits the
/// amplification of errors where the normal has turned away from its mean in training.
constexpr float k_min_divisor = 0.2f;
/// An edge whose projection into the tangent plane has less than this share of its squared length has no direction.
constexpr float k_min_flatness = 1e-6f;
std::size_t attribute_count(AttributeSet set);
/// Returns whether an attribute is of third order, i.e. a component of the derivative tensor. Those are learned with
/// cubic features.
bool is_derivative(AttributeSet set, std::size_t attribute);

/// The geometry of a surface in one frame that encoding and decoding attributes needs.
struct PosedSurface {
    std::span<const Vec3> vertices, normals;  ///< normals: unit
    std::span<const Eigen::Matrix3f>
        rotations{};  ///< principal only: from the coordinates of each segment to the world
};

/// Encodes curvature as attributes and decodes it.
struct AttributeFrames {
    AttributeSet set = AttributeSet::tensor;
    std::vector<std::uint32_t> neighbor;  ///< tensor, per vertex: the other end of the edge that is the first axis
    std::vector<std::uint32_t> segment;   ///< principal: per vertex
    /// principal: mean normal in training, in the coordinates of the segment. The axis of its largest coordinate is
    /// the one whose coordinate of e1 is left out.
    std::vector<Vec3> reference_normal;
    std::vector<Vec3> reference_direction;  ///< principal, for encoding only: mean of e1, which fixes its sign

    std::size_t vertex_count() const { return set == AttributeSet::tensor ? neighbor.size() : segment.size(); }

    /// Computes the attributes of all vertices, attribute-major (attribute_count x vertices).
    void encode(const VertexCurvature& curvature, const PosedSurface& surface, std::span<float> attributes) const;
    /// Inverts encode() up to the sign of principal directions. k1 >= k2; unit e1 and e2 orthogonal to the normals.
    void decode(std::span<const float> attributes, const PosedSurface& surface, VertexCurvature& curvature) const;

  private:
    Vec3 completed_direction(float first, float second, std::size_t v, const PosedSurface& surface) const;
};

/// Returns the unit direction of an edge in the tangent plane of `normal`, or any tangent if they are parallel.
Vec3 edge_tangent(const Vec3& edge, const Vec3& normal);

}  // namespace exemplar
