#include "host/curvature/attributes.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace exemplar {

namespace {

constexpr std::array<std::string_view, 8> k_principal_names{"k1",   "k2",   "e1 first", "e1 second",
                                                            "C111", "C112", "C122",     "C222"};
constexpr std::array<std::string_view, 7> k_tensor_names{"II11", "II12", "II22", "C111", "C112", "C122", "C222"};

/// The two coordinates of e1 that are kept: all but the one that the normal is longest along, which follows from e1
/// being orthogonal to the normal and would be the least certain to be left out.
struct KeptAxes {
    int first, second, dropped;
};
KeptAxes kept_axes(const Vec3& normal) {
    int dropped;
    normal.cwiseAbs().maxCoeff(&dropped);
    return dropped == 0 ? KeptAxes{1, 2, 0} : dropped == 1 ? KeptAxes{0, 2, 1} : KeptAxes{0, 1, 2};
}

/// The turn of the principal frame against the tangent frame with first axis `tangent`.
Turn turn_between(const Vec3& tangent, const Vec3& normal, const Vec3& e1) {
    return {tangent.dot(e1), normal.cross(tangent).dot(e1)};
}

}  // namespace

std::size_t attribute_count(AttributeSet set) {
    return set == AttributeSet::principal ? k_principal_names.size() : k_tensor_names.size();
}

std::string_view attribute_name(AttributeSet set, std::size_t attribute) {
    return set == AttributeSet::principal ? k_principal_names.at(attribute) : k_tensor_names.at(attribute);
}

bool is_derivative(AttributeSet set, std::size_t attribute) {
    return attribute + 4 >= attribute_count(set);
}

Vec3 carried(const Vec3& axis, const Vec3& from, const Vec3& to) {
    const float one_plus = 1 + from.dot(to);
    // Opposite normals have no least rotation; any that is continuous nearby will do.
    if (!(one_plus > 1e-4f)) return -axis;
    return axis - (from + to) * (to.dot(axis) / one_plus);
}

void AttributeFrames::encode(const VertexCurvature& curvature, std::span<const Vec3> normals,
                             std::span<const Eigen::Matrix3f> rotations, std::span<float> attributes) const {
    const std::size_t count = vertex_count();
    const auto out = [&](std::size_t attribute, std::size_t v) -> float& { return attributes[attribute * count + v]; };
    for (std::size_t v = 0; v < count; ++v) {
        const Eigen::Matrix3f& rotation = rotations[segment[v]];
        const Vec3 normal = rotation.transpose() * normals[v];
        Vec3 e1 = rotation.transpose() * curvature.e1[v];
        if (set == AttributeSet::principal) {
            const float sign = e1.dot(reference_direction[v]) < 0 ? -1.0f : 1.0f;
            const KeptAxes axes = kept_axes(reference_normal[v]);
            out(0, v) = curvature.k1[v];
            out(1, v) = curvature.k2[v];
            out(2, v) = sign * e1[axes.first];
            out(3, v) = sign * e1[axes.second];
            for (std::size_t k = 0; k < 4; ++k) out(4 + k, v) = sign * curvature.derivative[v][k];
            continue;
        }
        const Vec3 tangent = carried(any_frame(reference_normal[v]).tangent, reference_normal[v], normal);
        const Turn back = turn_between(tangent, normal, e1).inverse();
        const Form form = turned(Form{curvature.k1[v], 0.0f, curvature.k2[v]}, back);
        const FormDerivative derivative = turned(curvature.derivative[v], back);
        for (std::size_t k = 0; k < 3; ++k) out(k, v) = form[k];
        for (std::size_t k = 0; k < 4; ++k) out(3 + k, v) = derivative[k];
    }
}

void AttributeFrames::decode(std::span<const float> attributes, std::span<const Vec3> normals,
                             std::span<const Eigen::Matrix3f> rotations, VertexCurvature& curvature) const {
    const std::size_t count = vertex_count();
    const auto in = [&](std::size_t attribute, std::size_t v) { return attributes[attribute * count + v]; };
    curvature.k1.resize(count);
    curvature.k2.resize(count);
    curvature.e1.resize(count);
    curvature.e2.resize(count);
    curvature.derivative.resize(count);
    for (std::size_t v = 0; v < count; ++v) {
        const Eigen::Matrix3f& rotation = rotations[segment[v]];
        const Vec3 normal = rotation.transpose() * normals[v];
        Vec3 e1;
        if (set == AttributeSet::principal) {
            const float k1 = in(0, v), k2 = in(1, v);
            curvature.k1[v] = std::max(k1, k2);
            curvature.k2[v] = std::min(k1, k2);
            const KeptAxes axes = kept_axes(reference_normal[v]);
            e1[axes.first] = in(2, v);
            e1[axes.second] = in(3, v);
            const float along = normal[axes.dropped];
            const float divisor = along >= 0 ? std::max(along, k_least_divisor) : std::min(along, -k_least_divisor);
            e1[axes.dropped] = -(normal[axes.first] * e1[axes.first] + normal[axes.second] * e1[axes.second]) / divisor;
            e1 -= normal * normal.dot(e1);
            const float length = e1.norm();
            e1 = length > 1e-6f ? Vec3(e1 / length) : any_frame(normal).tangent;
            for (std::size_t k = 0; k < 4; ++k) curvature.derivative[v][k] = in(4 + k, v);
        } else {
            const Vec3 tangent = carried(any_frame(reference_normal[v]).tangent, reference_normal[v], normal);
            const Turn turn = principal_turn({in(0, v), in(1, v), in(2, v)}, curvature.k1[v], curvature.k2[v]);
            e1 = turn.cosine * tangent + turn.sine * normal.cross(tangent);
            curvature.derivative[v] = turned(FormDerivative{in(3, v), in(4, v), in(5, v), in(6, v)}, turn);
        }
        curvature.e1[v] = rotation * e1;
        curvature.e2[v] = normals[v].cross(curvature.e1[v]);
    }
}

}  // namespace exemplar
