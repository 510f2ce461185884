#include "host/parts/rigging/part_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <tuple>

namespace exemplar {
namespace {

/// -1 right, 0 middle, 1 left, per joint.
using Sides = std::vector<int>;

/// The part of a mesh as a mesh of its own.
TriangleMesh submesh(const TriangleMesh& mesh, const PartGraph& graph, std::uint32_t part) {
    TriangleMesh sub;
    sub.vertices = mesh.vertices;
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        if (graph.part_of_face[f] == part) sub.faces.push_back(mesh.faces[f]);
    sub.source_face_count = static_cast<std::uint32_t>(sub.faces.size());
    return sub;
}

/// Turns the normal so that its largest coordinate is positive.
void orient_normal(SymmetryPlane& plane) {
    Eigen::Index largest = 0;
    plane.normal.cwiseAbs().maxCoeff(&largest);
    if (plane.normal[largest] < 0) plane.normal = -plane.normal;
}

/// Planes through the center of the root: those of its part, which poses of limbs do not disturb, then of the surface.
std::vector<SymmetryPlane> candidate_planes(const TriangleMesh& mesh, const PartGraph& graph,
                                            const Skeleton& skeleton) {
    const std::uint32_t root = skeleton.joints.front().part;
    std::vector<SymmetryPlane> planes = symmetry_planes(submesh(mesh, graph, root));
    const std::vector<SymmetryPlane> whole = symmetry_planes(mesh);
    planes.insert(planes.end(), whole.begin(), whole.end());
    for (SymmetryPlane& plane : planes) orient_normal(plane);
    return planes;
}

std::map<std::int32_t, std::size_t> parts_per_label(const PartGraph& graph) {
    std::map<std::int32_t, std::size_t> count;
    for (const Part& part : graph.parts) ++count[part.label];
    return count;
}

Sides sides_of(const PartGraph& graph, const Skeleton& skeleton, const SymmetryPlane& plane) {
    const std::map<std::int32_t, std::size_t> count = parts_per_label(graph);
    Sides side(skeleton.joints.size(), 0);
    for (std::size_t j = 1; j < side.size(); ++j) {
        const Joint& joint = skeleton.joints[j];
        side[j] = side[joint.parent];
        if (side[j] != 0 || count.at(graph.parts[joint.part].label) < 2) continue;
        side[j] = (joint.head - plane.point).dot(plane.normal) >= 0 ? 1 : -1;
    }
    return side;
}

/// How badly a plane explains the parts: for each part on a side the distance from its mirror image to the nearest part
/// of its label on the other side, over the distance between the sides; at most 1 each. Mean over the parts.
double mirror_mismatch(const PartGraph& graph, const Skeleton& skeleton, const SymmetryPlane& plane,
                       const Sides& side) {
    double sum = 0, count = 0;
    for (std::size_t j = 1; j < side.size(); ++j) {
        if (side[j] == 0 || side[skeleton.joints[j].parent] != 0) continue;
        const Vec3 head = skeleton.joints[j].head;
        const float distance = (head - plane.point).dot(plane.normal);
        const Vec3 image = head - 2 * distance * plane.normal;
        float nearest = std::numeric_limits<float>::infinity();
        for (std::size_t k = 1; k < side.size(); ++k)
            if (side[k] == -side[j] &&
                graph.parts[skeleton.joints[k].part].label == graph.parts[skeleton.joints[j].part].label)
                nearest = std::min(nearest, (skeleton.joints[k].head - image).norm());
        sum += std::min(1.0F, nearest / std::max(2 * std::abs(distance), 1e-30F));
        count += 1;
    }
    return count > 0 ? sum / count : 1;
}

/// A plane with a larger mismatch separates no sides.
constexpr double k_largest_mismatch = 0.45;

std::optional<SymmetryPlane> best_plane(const TriangleMesh& mesh, const PartGraph& graph, const Skeleton& skeleton) {
    const std::map<std::int32_t, std::size_t> count = parts_per_label(graph);
    if (std::all_of(count.begin(), count.end(), [](const auto& entry) { return entry.second < 2; })) return {};
    std::optional<SymmetryPlane> best;
    double least = k_largest_mismatch;
    for (const SymmetryPlane& plane : candidate_planes(mesh, graph, skeleton)) {
        const double mismatch = mirror_mismatch(graph, skeleton, plane, sides_of(graph, skeleton, plane));
        if (mismatch >= least) continue;
        least = mismatch;
        best = plane;
    }
    return best;
}

/// The principal axis of the surface that numbers are given along: the longest, without its share across the plane.
Vec3 numbering_axis(const TriangleMesh& mesh, const std::optional<SymmetryPlane>& plane) {
    const PrincipalAxes principal = principal_axes(mesh);
    for (const Vec3& axis : principal.axis)
        if (!plane || std::abs(axis.dot(plane->normal)) < 0.7F) {
            Vec3 within = axis;
            if (plane) within -= axis.dot(plane->normal) * plane->normal;
            Eigen::Index largest = 0;
            within.cwiseAbs().maxCoeff(&largest);
            return within[largest] < 0 ? Vec3(-within) : within;
        }
    return Vec3::UnitY();
}

}  // namespace

std::optional<SymmetryPlane> name_parts(const TriangleMesh& mesh, const PartGraph& graph,
                                        const std::vector<std::string>& labels, bool swap_sides, Skeleton& skeleton) {
    std::optional<SymmetryPlane> plane = best_plane(mesh, graph, skeleton);
    const Sides side = plane ? sides_of(graph, skeleton, *plane) : Sides(skeleton.joints.size(), 0);
    std::map<std::string, std::vector<std::size_t>> alike;
    for (std::size_t j = 0; j < side.size(); ++j) {
        const std::int32_t label = graph.parts[skeleton.joints[j].part].label;
        std::string name = label < 0 ? "unlabeled" : labels.at(static_cast<std::size_t>(label));
        if (side[j] != 0) name += (side[j] > 0) != swap_sides ? "_left" : "_right";
        alike[name].push_back(j);
    }
    const Vec3 along = numbering_axis(mesh, plane);
    for (auto& [name, joints] : alike) {
        std::stable_sort(joints.begin(), joints.end(), [&](std::size_t a, std::size_t b) {
            return skeleton.joints[a].head.dot(along) > skeleton.joints[b].head.dot(along);
        });
        for (std::size_t i = 0; i < joints.size(); ++i)
            skeleton.joints[joints[i]].name = joints.size() == 1 ? name : fmt::format("{}_{}", name, i + 1);
    }
    return plane;
}

}  // namespace exemplar
