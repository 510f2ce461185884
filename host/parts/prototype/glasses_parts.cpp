#include "host/parts/prototype/glasses_parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/mesh/queries/axes.h"
#include "host/mesh/topology.h"
#include "host/parts/prototype/print_solid.h"
#include "host/parts/rigging/part_graph.h"

namespace exemplar {
namespace {

std::int32_t label_of_name(const std::vector<std::string>& names, const std::string& wanted,
                           const std::vector<std::string>& usual, const char* option) {
    const std::vector<std::string> candidates = wanted.empty() ? usual : std::vector<std::string>{wanted};
    for (const std::string& candidate : candidates)
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i] == candidate || (wanted.empty() && lower_case(names[i]) == candidate))
                return static_cast<std::int32_t>(i);
    std::vector<std::string> short_names;
    short_names.reserve(names.size());
    for (const std::string& name : names)
        short_names.push_back(fmt::format("'{}'", without_controls(name.substr(0, 40))));
    const std::string labels = fmt::format("the mesh has the labels {}", fmt::join(short_names, ", "));
    if (wanted.empty()) throw UsageError(fmt::format("{}; name one of them by {}", labels, option));
    throw UsageError(fmt::format("{} '{}' is no label; {}", option, without_controls(wanted.substr(0, 40)), labels));
}

/// The mesh of some faces of another one.
TriangleMesh mesh_of_faces(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces) {
    TriangleMesh some;
    some.vertices = mesh.vertices;
    some.faces.reserve(faces.size());
    for (const std::uint32_t f : faces) some.faces.push_back(mesh.faces[f]);
    some.source_face_count = static_cast<std::uint32_t>(faces.size());
    return some;
}

/// The faces of lenses, of each piece of arm, and of everything but the arms.
struct SortedFaces {
    std::vector<std::uint32_t> lens, frame;
    std::vector<std::vector<std::uint32_t>> arms;  ///< the two largest, by decreasing area
};

SortedFaces sorted_faces(const TriangleMesh& mesh, std::span<const std::int32_t> label, const GlassesLabels& labels) {
    const PartGraph graph = build_part_graph(mesh, build_topology(mesh), label);
    std::vector<std::uint32_t> arms;
    for (std::uint32_t p = 0; p < graph.parts.size(); ++p)
        if (graph.parts[p].label == labels.arm) arms.push_back(p);
    std::stable_sort(arms.begin(), arms.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return graph.parts[a].area > graph.parts[b].area; });
    if (arms.size() < 2)
        throw MeshError(
            fmt::format("it has {} of the label for arms; glasses have two", counted(arms.size(), "connected piece")));
    SortedFaces sorted;
    sorted.arms.resize(2);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const std::uint32_t part = graph.part_of_face[f];
        if (part == arms[0] || part == arms[1])
            sorted.arms[part == arms[0] ? 0 : 1].push_back(f);
        else
            sorted.frame.push_back(f);
        if (graph.parts[part].label == labels.lens) sorted.lens.push_back(f);
    }
    if (sorted.lens.empty()) throw MeshError("no face has the label of lenses");
    return sorted;
}

/// The normal of the best mirror plane of the frame that separates the arms; across both arms if there is none.
Vec3 sideways(const TriangleMesh& frame, const Vec3& one_arm, const Vec3& other_arm) {
    for (const SymmetryPlane& plane : symmetry_planes(frame)) {
        const float one = (one_arm - plane.point).dot(plane.normal),
                    other = (other_arm - plane.point).dot(plane.normal);
        if (one * other < 0 && std::abs(one - other) > 0.5F * (one_arm - other_arm).norm())
            return one > other ? plane.normal : Vec3(-plane.normal);
    }
    return (one_arm - other_arm).normalized();
}

/// The direction normal to `side` in which the lenses have the largest projected area.
Vec3 facing(const TriangleMesh& lenses, const Vec3& side) {
    const Vec3 u = side.unitOrthogonal(), v = side.cross(u);
    const std::vector<Vec3> normal = face_normals(lenses);
    const std::vector<float> area = face_areas(lenses);
    Vec3 best = u;
    double largest = -1;
    for (int degree = 0; degree < 180; ++degree) {
        const float angle = static_cast<float>(degree) * std::numbers::pi_v<float> / 180;
        const Vec3 direction = std::cos(angle) * u + std::sin(angle) * v;
        double projected = 0;
        for (std::size_t f = 0; f < normal.size(); ++f)
            projected += static_cast<double>(area[f] * std::abs(normal[f].dot(direction)));
        if (projected > largest) {
            largest = projected;
            best = direction;
        }
    }
    return best;
}

/// The length-weighted centroid of the edges between an arm and the rest.
Vec3 root_of_arm(const TriangleMesh& mesh, const std::vector<std::uint32_t>& arm) {
    std::vector<bool> is_arm(mesh.face_count(), false);
    for (const std::uint32_t f : arm) is_arm[f] = true;
    Vec3d sum = Vec3d::Zero();
    double length = 0;
    for (const Edge& edge : build_topology(mesh).edges) {
        if (edge.is_boundary() || is_arm[edge.face[0]] == is_arm[edge.face[1]]) continue;
        const Vec3 &a = mesh.vertices[edge.vertex[0]], &b = mesh.vertices[edge.vertex[1]];
        sum += static_cast<double>((a - b).norm()) * ((a + b) / 2).cast<double>();
        length += static_cast<double>((a - b).norm());
    }
    if (!(length > 0)) throw MeshError("an arm does not touch the rest; join them to one surface before");
    return (sum / length).cast<float>();
}

Vec3 tip_of_arm(const TriangleMesh& mesh, std::vector<std::uint32_t> arm, const Vec3& root) {
    const std::vector<float> area = face_areas(mesh);
    const std::vector<Vec3> center = face_centers(mesh);
    std::stable_sort(arm.begin(), arm.end(), [&](std::uint32_t a, std::uint32_t b) {
        return (center[a] - root).squaredNorm() > (center[b] - root).squaredNorm();
    });
    double all = 0, taken = 0;
    for (const std::uint32_t f : arm) all += static_cast<double>(area[f]);
    Vec3d sum = Vec3d::Zero();
    for (const std::uint32_t f : arm) {
        if (taken > 0.05 * all) break;
        sum += static_cast<double>(area[f]) * center[f].cast<double>();
        taken += static_cast<double>(area[f]);
    }
    return taken > 0 ? Vec3((sum / taken).cast<float>()) : center[arm[0]];
}

/// The axes of the glasses as rows.
Eigen::Matrix3f upright_axes(const TriangleMesh& mesh, const SortedFaces& sorted, const std::array<Vec3, 2>& root,
                             const std::array<Vec3, 2>& arm_center) {
    Vec3 x = sideways(mesh_of_faces(mesh, sorted.frame), arm_center[0], arm_center[1]);
    const TriangleMesh lenses = mesh_of_faces(mesh, sorted.lens);
    Vec3 z = facing(lenses, x);
    const Vec3 arms = (arm_center[0] + arm_center[1]) / 2;
    if ((area_centroid(lenses) - arms).dot(z) < 0) z = -z;
    Vec3 y = z.cross(x);
    if (((root[0] + root[1]) / 2 - arms).dot(y) < 0) {
        y = -y;
        x = -x;
    }
    Eigen::Matrix3f axes;
    axes << x.transpose(), y.transpose(), z.transpose();
    return axes;
}

}  // namespace

GlassesLabels glasses_labels(const std::vector<std::string>& names, const std::string& lens, const std::string& arm) {
    GlassesLabels labels;
    labels.lens = label_of_name(names, lens, {"lens", "lenses", "glass", "glasses"}, "--lens");
    labels.arm = label_of_name(names, arm, {"arm", "arms", "temple", "temples", "skeleton"}, "--arm");
    if (labels.lens == labels.arm) throw UsageError("--lens and --arm name the same label; give two");
    return labels;
}

GlassesParts glasses_parts(const TriangleMesh& mesh, std::span<const std::int32_t> label, const GlassesLabels& labels,
                           double width) {
    GlassesParts parts;
    parts.mesh = closed_for_print(mesh);
    const SortedFaces sorted = sorted_faces(parts.mesh, label, labels);
    std::array<Vec3, 2> root, center;
    for (std::size_t arm = 0; arm < 2; ++arm) {
        root[arm] = root_of_arm(parts.mesh, sorted.arms[arm]);
        center[arm] = area_centroid(mesh_of_faces(parts.mesh, sorted.arms[arm]));
    }
    const Eigen::Matrix3f axes = upright_axes(parts.mesh, sorted, root, center);
    const Vec3 middle = area_centroid(mesh_of_faces(parts.mesh, sorted.lens));
    for (Vec3& v : parts.mesh.vertices) v = axes * (v - middle);
    const BoundingBox box = bounding_box(mesh_of_faces(parts.mesh, sorted.frame));
    const auto scale = static_cast<float>(width / (box.high - box.low).x());
    const Vec3 shift(static_cast<float>((box.high + box.low).x() / 2), 0, 0);
    for (Vec3& v : parts.mesh.vertices) v = scale * (v - shift);
    parts.mesh.origin.setZero();
    const std::vector<Vec3> centers = face_centers(parts.mesh);
    for (const std::uint32_t f : sorted.lens) parts.lens_faces[centers[f].x() > 0 ? 0 : 1].push_back(f);
    if (parts.lens_faces[0].empty() || parts.lens_faces[1].empty())
        throw MeshError("its lenses are all on one side; glasses have two");
    const bool is_first_left = (axes * (center[0] - center[1])).x() > 0;
    for (std::size_t side = 0; side < 2; ++side) {
        parts.arm_faces[side] = sorted.arms[is_first_left ? side : 1 - side];
        parts.arm_root[side] = root_of_arm(parts.mesh, parts.arm_faces[side]);
        parts.arm_tip[side] = tip_of_arm(parts.mesh, parts.arm_faces[side], parts.arm_root[side]);
    }
    return parts;
}

}  // namespace exemplar
