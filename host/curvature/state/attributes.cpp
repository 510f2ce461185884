#include "host/curvature/state/attributes.h"

#include <Eigen/Geometry>
#include <cmath>

namespace exemplar {

namespace {

/// The two coordinates of e1 that are kept. The third, where |normal| has its largest coordinate, follows from e1
/// being orthogonal to the normal; dropping that one makes the division by the normal's coordinate most stable.
struct KeptAxes {
    int first, second, dropped;
};
KeptAxes kept_axes(const Vec3& normal) {
    int dropped;
    normal.cwiseAbs().maxCoeff(&dropped);
    return dropped == 0 ? KeptAxes{1, 2, 0} : dropped == 1 ? KeptAxes{0, 2, 1} : KeptAxes{0, 1, 2};
}

/// Returns the rotation from the tangent frame with first axis `tangent` to the principal frame.
TangentRotation turn_between(const Vec3& tangent, const Vec3& normal, const Vec3& e1) {
    return {tangent.dot(e1), normal.cross(tangent).dot(e1)};
}

}  // namespace

std::size_t attribute_count(AttributeSet set) {
    return set == AttributeSet::principal ? 8 : 7;
}

bool is_derivative(AttributeSet set, std::size_t attribute) {
    return attribute + 4 >= attribute_count(set);
}

Vec3 edge_tangent(const Vec3& edge, const Vec3& normal) {
    const Vec3 flat = edge - normal * normal.dot(edge);
    const float squared = flat.squaredNorm();
    return squared > k_min_flatness * edge.squaredNorm() ? Vec3(flat / std::sqrt(squared))
                                                         : frame_of_normal(normal).tangent;
}

void AttributeFrames::encode(const VertexCurvature& curvature, const PosedSurface& surface,
                             std::span<float> attributes) const {
    const std::size_t count = vertex_count();
    const auto out = [&](std::size_t attribute, std::size_t v) -> float& { return attributes[attribute * count + v]; };
    for (std::size_t v = 0; v < count; ++v) {
        if (set == AttributeSet::principal) {
            const Vec3 e1 = surface.rotations[segment[v]].transpose() * curvature.e1[v];
            const float sign = e1.dot(reference_direction[v]) < 0 ? -1.0f : 1.0f;
            const KeptAxes axes = kept_axes(reference_normal[v]);
            out(0, v) = curvature.k1[v];
            out(1, v) = curvature.k2[v];
            out(2, v) = sign * e1[axes.first];
            out(3, v) = sign * e1[axes.second];
            for (std::size_t k = 0; k < 4; ++k) out(4 + k, v) = sign * curvature.derivative[v][k];
            continue;
        }
        const Vec3& normal = surface.normals[v];
        const Vec3 tangent = edge_tangent(surface.vertices[neighbor[v]] - surface.vertices[v], normal);
        const TangentRotation back = turn_between(tangent, normal, curvature.e1[v]).inverse();
        const Form form = in_rotated_frame(Form{curvature.k1[v], 0.0f, curvature.k2[v]}, back);
        const FormDerivative derivative = in_rotated_frame(curvature.derivative[v], back);
        for (std::size_t k = 0; k < 3; ++k) out(k, v) = form[k];
        for (std::size_t k = 0; k < 4; ++k) out(3 + k, v) = derivative[k];
    }
}

void AttributeFrames::decode(std::span<const float> attributes, const PosedSurface& surface,
                             VertexCurvature& curvature) const {
    const std::size_t count = vertex_count();
    const auto in = [&](std::size_t attribute, std::size_t v) { return attributes[attribute * count + v]; };
    curvature.k1.resize(count);
    curvature.k2.resize(count);
    curvature.e1.resize(count);
    curvature.e2.resize(count);
    curvature.derivative.resize(count);
    for (std::size_t v = 0; v < count; ++v) {
        if (set == AttributeSet::principal) {
            curvature.k1[v] = std::max(in(0, v), in(1, v));
            curvature.k2[v] = std::min(in(0, v), in(1, v));
            curvature.e1[v] = completed_direction(in(2, v), in(3, v), v, surface);
            for (std::size_t k = 0; k < 4; ++k) curvature.derivative[v][k] = in(4 + k, v);
        } else {
            const Vec3& normal = surface.normals[v];
            const Vec3 tangent = edge_tangent(surface.vertices[neighbor[v]] - surface.vertices[v], normal);
            const TangentRotation turn =
                principal_rotation({in(0, v), in(1, v), in(2, v)}, curvature.k1[v], curvature.k2[v]);
            curvature.e1[v] = turn.cosine * tangent + turn.sine * normal.cross(tangent);
            curvature.derivative[v] = in_rotated_frame(FormDerivative{in(3, v), in(4, v), in(5, v), in(6, v)}, turn);
        }
        curvature.e2[v] = surface.normals[v].cross(curvature.e1[v]);
    }
}

Vec3 AttributeFrames::completed_direction(float first, float second, std::size_t v, const PosedSurface& surface) const {
    const Eigen::Matrix3f& rotation = surface.rotations[segment[v]];
    const Vec3 normal = rotation.transpose() * surface.normals[v];
    const KeptAxes axes = kept_axes(reference_normal[v]);
    Vec3 e1;
    e1[axes.first] = first;
    e1[axes.second] = second;
    const float along = normal[axes.dropped];
    const float divisor = along >= 0 ? std::max(along, k_min_divisor) : std::min(along, -k_min_divisor);
    e1[axes.dropped] = -(normal[axes.first] * first + normal[axes.second] * second) / divisor;
    e1 -= normal * normal.dot(e1);
    const float length = e1.norm();
    return rotation * (length > 1e-6f ? Vec3(e1 / length) : frame_of_normal(normal).tangent);
}

}  // namespace exemplar
