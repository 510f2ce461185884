#include "host/parts/rigging/part_weights.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/core/errors.h"
#include "host/core/interrupt.h"

namespace exemplar {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Weights below this are dropped: such tails bend nothing that could be seen.
constexpr float k_least_weight = 0.01F;

/// A third of the area of the faces around each vertex; at least a tiny share, so that every vertex has an equation.
Eigen::VectorXd vertex_masses(const TriangleMesh& mesh, const std::vector<float>& area) {
    Eigen::VectorXd mass = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.vertex_count()));
    double total = 0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        for (const std::uint32_t v : mesh.faces[f]) {
            mass[v] += area[f] / 3.0;
            total += area[f] / 3.0;
        }
    const double least = std::max(1e-9 * total / static_cast<double>(mesh.vertex_count()), 1e-300);
    return mass.cwiseMax(least);
}

/// The joints with a boundary at each joint: its children, and itself but for the root.
std::vector<std::vector<std::uint32_t>> boundaries_of_joints(const Skeleton& skeleton) {
    std::vector<std::vector<std::uint32_t>> at(skeleton.joints.size());
    for (std::uint32_t j = 0; j < skeleton.joints.size(); ++j) {
        if (skeleton.joints[j].parent == k_invalid_index) continue;
        at[j].push_back(j);
        at[skeleton.joints[j].parent].push_back(j);
    }
    return at;
}

/// The spread of heat at the center of each face, in mesh units.
std::vector<double> spread_of_faces(const TriangleMesh& mesh, const PartGraph& graph, const Skeleton& skeleton,
                                    double falloff) {
    const auto boundaries = boundaries_of_joints(skeleton);
    const std::vector<Vec3> center = face_centers(mesh);
    std::vector<double> spread(mesh.face_count(), 0);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const std::uint32_t own = skeleton.joint_of_part[graph.part_of_face[f]];
        float nearest = std::numeric_limits<float>::infinity();
        for (const std::uint32_t j : boundaries[own]) {
            const Joint& joint = skeleton.joints[j];
            const float distance = (joint.head - center[f]).squaredNorm();
            if (distance >= nearest) continue;
            nearest = distance;
            const double radius = graph.boundaries[joint.boundary].length / (2 * std::numbers::pi);
            const double bone = (joint.tail - joint.head).norm();
            spread[f] = std::min(falloff * radius, bone / 4);
        }
    }
    return spread;
}

/// Half the cotangent of the angle at `tip` over the edge a-b; at least a small positive number, so that no weight
/// leaves [0, 1], and bounded for needles.
double edge_conductance(const Vec3& tip, const Vec3& a, const Vec3& b) {
    const Vec3d u = (a - tip).cast<double>(), v = (b - tip).cast<double>();
    const double sine = u.cross(v).norm();
    return std::clamp(sine > 0 ? u.dot(v) / sine : 10.0, 0.02, 10.0) / 2;
}

SparseMatrix heat_matrix(const TriangleMesh& mesh, const Eigen::VectorXd& mass, const std::vector<double>& spread) {
    Triplets entries;
    entries.reserve(12 * mesh.face_count() + mesh.vertex_count());
    for (Eigen::Index v = 0; v < mass.size(); ++v) entries.emplace_back(v, v, mass[v]);
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t tip = mesh.faces[f][i], a = mesh.faces[f][(i + 1) % 3], b = mesh.faces[f][(i + 2) % 3];
            if (a == b || spread[f] <= 0) continue;
            const double c =
                spread[f] * spread[f] * edge_conductance(mesh.vertices[tip], mesh.vertices[a], mesh.vertices[b]);
            entries.emplace_back(a, a, c);
            entries.emplace_back(b, b, c);
            entries.emplace_back(a, b, -c);
            entries.emplace_back(b, a, -c);
        }
    SparseMatrix matrix(mass.size(), mass.size());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

/// The area around each vertex that belongs to each joint, as rows of (joint, area); vertices without faces have none.
std::vector<std::vector<Influence>> areas_of_joints(const TriangleMesh& mesh, const PartGraph& graph,
                                                    const Skeleton& skeleton, const std::vector<float>& area) {
    std::vector<std::vector<Influence>> rows(mesh.vertex_count());
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const std::uint32_t joint = skeleton.joint_of_part[graph.part_of_face[f]];
        for (const std::uint32_t v : mesh.faces[f]) {
            auto found =
                std::find_if(rows[v].begin(), rows[v].end(), [&](const Influence& i) { return i.bone == joint; });
            if (found == rows[v].end()) found = rows[v].insert(rows[v].end(), Influence{joint, 0});
            found->weight += std::max(area[f], 1e-30F);
        }
    }
    return rows;
}

/// Whether joint `j` may move a vertex whose faces belong to the joints of `row`.
bool may_move(const Skeleton& skeleton, std::uint32_t j, const std::vector<Influence>& row) {
    return std::any_of(row.begin(), row.end(), [&](const Influence& own) {
        return own.bone == j || skeleton.joints[j].parent == own.bone || skeleton.joints[own.bone].parent == j;
    });
}

/// Keeps the four largest, scaled to sum to one, by increasing joint.
void finish_row(std::vector<Influence>& row) {
    std::sort(row.begin(), row.end(), [](const Influence& a, const Influence& b) {
        return a.weight != b.weight ? a.weight > b.weight : a.bone < b.bone;
    });
    if (row.size() > k_most_influences) row.resize(k_most_influences);
    float sum = 0;
    for (const Influence& influence : row) sum += influence.weight;
    for (Influence& influence : row) influence.weight /= sum;
    std::sort(row.begin(), row.end(), [](const Influence& a, const Influence& b) { return a.bone < b.bone; });
}

/// Spreads the heat of one joint after the other, and collects what reaches the vertices that it may move.
std::vector<std::vector<Influence>> spread_heat(const SparseMatrix& matrix, const Eigen::VectorXd& mass,
                                                const std::vector<std::vector<Influence>>& areas,
                                                const Skeleton& skeleton) {
    const Eigen::SimplicialLDLT<SparseMatrix> solver(matrix);
    if (solver.info() != Eigen::Success) throw MeshError("the skin weights of its surface cannot be computed");
    std::vector<std::vector<Influence>> rows(areas.size());
    for (std::uint32_t j = 0; j < skeleton.joints.size(); ++j) {
        check_interrupt();
        Eigen::VectorXd source = Eigen::VectorXd::Zero(mass.size());
        for (std::size_t v = 0; v < areas.size(); ++v) {
            float sum = 0, own = 0;
            for (const Influence& share : areas[v]) {
                sum += share.weight;
                if (share.bone == j) own = share.weight;
            }
            if (own > 0) source[static_cast<Eigen::Index>(v)] = mass[static_cast<Eigen::Index>(v)] * own / sum;
        }
        const Eigen::VectorXd heat = solver.solve(source);
        for (std::size_t v = 0; v < areas.size(); ++v) {
            const auto weight = static_cast<float>(heat[static_cast<Eigen::Index>(v)]);
            if (weight >= k_least_weight && may_move(skeleton, j, areas[v])) rows[v].push_back({j, weight});
        }
    }
    return rows;
}

}  // namespace

Skin weights_of_parts(const TriangleMesh& mesh, const PartGraph& graph, const Skeleton& skeleton, double falloff) {
    const std::vector<float> area = face_areas(mesh);
    const Eigen::VectorXd mass = vertex_masses(mesh, area);
    const std::vector<double> spread = spread_of_faces(mesh, graph, skeleton, falloff);
    const auto areas = areas_of_joints(mesh, graph, skeleton, area);
    auto rows = spread_heat(heat_matrix(mesh, mass, spread), mass, areas, skeleton);
    Skin skin;
    skin.bones.reserve(skeleton.joints.size());
    for (std::uint32_t j = 0; j < skeleton.joints.size(); ++j) {
        Bone bone;
        bone.node = j;
        bone.inverse_bind.linear() = skeleton.joints[j].axes.transpose();
        bone.inverse_bind.translation() = -(skeleton.joints[j].axes.transpose() * skeleton.joints[j].head);
        skin.bones.push_back(bone);
    }
    skin.influence_begin.reserve(rows.size() + 1);
    for (auto& row : rows) {
        if (row.empty()) row.push_back({0, 1});
        finish_row(row);
        skin.influence_begin.push_back(static_cast<std::uint32_t>(skin.influences.size()));
        skin.influences.insert(skin.influences.end(), row.begin(), row.end());
    }
    skin.influence_begin.push_back(static_cast<std::uint32_t>(skin.influences.size()));
    return skin;
}

}  // namespace exemplar
