#include "host/curvature/state/segments.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "host/core/eight.h"
#include "host/core/parallel.h"
#include "host/learn/components/pca.h"
#include "host/learn/mean_shift.h"

namespace exemplar {

namespace {

using Eigen::Matrix3f;

/// Distance of weight vectors above which vertices belong to different segments: half that between a vertex of one
/// bone and one shared evenly by two bones.
constexpr float k_weight_bandwidth = 0.35f;
/// For rotation matrices, root mean square over frames: about twelve degrees.
constexpr float k_rotation_bandwidth = 0.3f;
/// Minimum vertices of a segment: its frame is computed from their positions.
constexpr std::size_t k_smallest_patch = 40;
constexpr std::size_t k_max_rotation_frames = 24, k_rotation_dimensions = 12;

/// The edges of a triangle that meet in its first corner.
struct TriangleEdges {
    Vec3 first, second;
};
TriangleEdges triangle_edges(const Segments::Triangle& triangle, std::span<const Vec3> vertices) {
    std::array<FourFloats, 3> corner{};
    for (std::size_t i = 0; i < 3; ++i)
        for (const std::uint32_t v : triangle.patches[i]) corner[i] += load_three(vertices[v].data());
    const FourFloats first = corner[1] - corner[0], second = corner[2] - corner[0];
    return {{first[0], first[1], first[2]}, {second[0], second[1], second[2]}};
}

/// Returns the squared width of a triangle: 0 if its corners are on a line.
float squared_width(const TriangleEdges& edges) {
    const float longest = std::max(edges.first.squaredNorm(), edges.second.squaredNorm());
    return longest > 0 ? (edges.first.cross(edges.second) / longest).squaredNorm() : 0;
}

/// Returns the axes of a triangle, or the identity if its corners are on a line.
Matrix3f triangle_frame(const Segments::Triangle& triangle, std::span<const Vec3> vertices) {
    constexpr float k_min_width = 1e-4f;  // far more than rounding makes of a line
    const TriangleEdges edges = triangle_edges(triangle, vertices);
    if (!(squared_width(edges) > k_min_width * k_min_width)) return Matrix3f::Identity();
    Matrix3f frame;
    frame.col(0) = edges.first.normalized();
    frame.col(2) = edges.first.cross(edges.second).normalized();
    frame.col(1) = frame.col(2).cross(frame.col(0));
    return frame;
}

/// Returns the `wanted` vertices among `candidates` nearest to `at`, repeated until there are k_patch.
std::array<std::uint32_t, Segments::Triangle::k_patch> patch_around(const std::vector<std::uint32_t>& candidates,
                                                                    std::span<const Vec3> vertices, const Vec3& at,
                                                                    std::size_t wanted) {
    std::vector<std::uint32_t> sorted = candidates;
    std::partial_sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(wanted), sorted.end(),
                      [&](std::uint32_t a, std::uint32_t b) {
                          const float da = (vertices[a] - at).squaredNorm(), db = (vertices[b] - at).squaredNorm();
                          return da != db ? da < db : a < b;
                      });
    std::array<std::uint32_t, Segments::Triangle::k_patch> patch;
    for (std::size_t i = 0; i < patch.size(); ++i) patch[i] = sorted[i % wanted];
    return patch;
}

/// Chooses three patches far from each other and not on a line. Patches are smaller where large ones would lie on a
/// line, as in a part that is small or a narrow crescent.
Segments::Triangle spread_triangle(const std::vector<std::uint32_t>& members, std::span<const Vec3> rest) {
    const auto farthest = [&](auto&& distance) {
        return *std::max_element(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
            return distance(rest[a]) < distance(rest[b]);
        });
    };
    const Vec3 start = rest[members.front()];
    const Vec3 a = rest[farthest([&](const Vec3& p) { return (p - start).squaredNorm(); })];
    const Vec3 b = rest[farthest([&](const Vec3& p) { return (p - a).squaredNorm(); })];
    const Vec3 along = (b - a).normalized();
    const Vec3 c = rest[farthest([&](const Vec3& p) { return (p - a).cross(along).squaredNorm(); })];
    constexpr std::size_t k_patch = Segments::Triangle::k_patch;
    constexpr float k_good_width = 0.2f;
    Segments::Triangle best;
    float best_width = -1;
    // At most a quarter of the vertices, so that the patches at the ends differ.
    for (std::size_t size = std::clamp<std::size_t>(members.size() / 4, 1, k_patch); size > 0; size /= 2) {
        const auto around = [&](const Vec3& at) { return patch_around(members, rest, at, size); };
        const Segments::Triangle triangle{{around(a), around(b), around(c)}};
        const float wide = squared_width(triangle_edges(triangle, rest));
        if (wide > best_width) {
            best = triangle;
            best_width = wide;
        }
        if (wide > k_good_width * k_good_width) break;
    }
    return best;
}

/// Computes the rotation of the edges around each vertex from rest to a frame (Kabsch), as rows of nine numbers.
void vertex_rotations(const TriangleMesh& rest, std::span<const Vec3> frame, Eigen::Ref<Eigen::MatrixXf> out) {
    std::vector<Matrix3f> moment(rest.vertex_count(), Matrix3f::Zero());
    const auto add = [&](std::uint32_t v, std::uint32_t w) {
        moment[v] += (frame[w] - frame[v]) * (rest.vertices[w] - rest.vertices[v]).transpose();
    };
    for (const Face& face : rest.faces)
        for (std::size_t i = 0; i < 3; ++i) {
            add(face[i], face[(i + 1) % 3]);
            add(face[i], face[(i + 2) % 3]);
        }
    parallel_for(
        moment.size(),
        [&](std::size_t v) {
            const Eigen::JacobiSVD<Matrix3f> svd(moment[v], Eigen::ComputeFullU | Eigen::ComputeFullV);
            Vec3 sign = Vec3::Ones();
            if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign.z() = -1;
            const Matrix3f rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
            out.row(static_cast<Eigen::Index>(v)) = rotation.reshaped().transpose();
        },
        256);
}

}  // namespace

Matrix3f nearest_rotation(const Matrix3f& linear) {
    constexpr int k_max_steps = 30;
    if (!(linear.determinant() > 1e-12f * std::pow(linear.norm(), 3.0f))) return Matrix3f::Identity();
    Matrix3f q = linear;
    for (int step = 0; step < k_max_steps; ++step) {
        const Matrix3f next = 0.5f * (q + q.inverse().transpose());
        const float change = (next - q).norm();
        q = next;
        if (change < 1e-6f) break;
    }
    return q;
}

void Segments::rotations_of_rig(std::span<const Affine> bones, std::vector<Matrix3f>& out) const {
    out.resize(count());
    for (std::size_t s = 0; s < out.size(); ++s) {
        Matrix3f blended = Matrix3f::Zero();
        for (std::uint32_t i = influence_begin[s]; i < influence_begin[s + 1]; ++i)
            blended += influences[i].weight * bones[influences[i].bone].linear();
        out[s] = nearest_rotation(blended);
    }
}

void Segments::rotations_of_sequence(std::span<const Vec3> vertices, std::vector<Matrix3f>& out) const {
    out.resize(count());
    for (std::size_t s = 0; s < out.size(); ++s) out[s] = triangle_frame(triangles[s], vertices);
}

Segments segment_rig(const Rig& rig, std::size_t vertex_count) {
    Eigen::MatrixXf weights =
        Eigen::MatrixXf::Zero(static_cast<Eigen::Index>(vertex_count), static_cast<Eigen::Index>(rig.bones.size()));
    for (std::size_t v = 0; v < vertex_count; ++v)
        for (const Influence& influence : rig.influences_of(v))
            weights(static_cast<Eigen::Index>(v), influence.bone) = influence.weight;
    const MeanShiftClusters clusters = mean_shift(weights, k_weight_bandwidth);

    Segments segments;
    segments.segment_of_vertex = clusters.cluster;
    segments.influence_begin.push_back(0);
    for (Eigen::Index s = 0; s < clusters.modes.rows(); ++s) {
        for (Eigen::Index b = 0; b < clusters.modes.cols(); ++b)
            if (clusters.modes(s, b) > 0.01f)
                segments.influences.push_back({static_cast<std::uint32_t>(b), clusters.modes(s, b)});
        segments.influence_begin.push_back(static_cast<std::uint32_t>(segments.influences.size()));
    }
    return segments;
}

Segments segment_sequence(const TriangleMesh& rest, std::span<const std::vector<Vec3>> frames) {
    const std::size_t taken = std::min(frames.size(), k_max_rotation_frames);
    Eigen::MatrixXf rotations(static_cast<Eigen::Index>(rest.vertex_count()), static_cast<Eigen::Index>(9 * taken));
    for (std::size_t i = 0; i < taken; ++i)
        vertex_rotations(rest, frames[i * frames.size() / taken],
                         rotations.middleCols(static_cast<Eigen::Index>(9 * i), 9));
    rotations /= std::sqrt(static_cast<float>(taken));
    const Pca pca = fit_pca(rotations, 0.99, k_rotation_dimensions);
    return segment_patches(rest, mean_shift(pca.project(rotations), k_rotation_bandwidth, k_smallest_patch).cluster);
}

Segments segment_patches(const TriangleMesh& rest, const std::vector<std::uint32_t>& patch_of_vertex) {
    Segments segments;
    segments.segment_of_vertex = patch_of_vertex;
    std::vector<std::vector<std::uint32_t>> members;
    for (std::uint32_t v = 0; v < rest.vertex_count(); ++v) {
        const std::uint32_t s = segments.segment_of_vertex[v];
        if (s >= members.size()) members.resize(s + 1);
        members[s].push_back(v);
    }
    for (const auto& vertices : members) segments.triangles.push_back(spread_triangle(vertices, rest.vertices));
    return segments;
}

}  // namespace exemplar
