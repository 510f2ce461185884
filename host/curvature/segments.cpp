#include "host/curvature/segments.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "host/core/parallel.h"
#include "host/learn/mean_shift.h"
#include "host/learn/pca.h"

namespace exemplar {

namespace {

using Eigen::Matrix3f;

/// Two weights that differ by this much belong to different segments: halfway between a vertex that a bone holds alone
/// and one that it shares evenly.
constexpr float k_weight_bandwidth = 0.35f;
/// For rotation matrices, root mean square over frames: about twelve degrees.
constexpr float k_rotation_bandwidth = 0.3f;
/// A segment's frame is read from vertices, so it must have some.
constexpr std::size_t k_smallest_patch = 40;
constexpr std::size_t k_most_rotation_frames = 24, k_rotation_dimensions = 12;

Matrix3f orthonormal_frame(const Vec3& first, const Vec3& second) {
    Matrix3f frame;
    const Vec3 x = first.normalized();
    const Vec3 z = first.cross(second).normalized();
    frame.col(0) = x;
    frame.col(1) = z.cross(x);
    frame.col(2) = z;
    return frame;
}

Matrix3f triangle_frame(const Segments::Triangle& triangle, std::span<const Vec3> vertices) {
    std::array<Vec3, 3> center;
    for (std::size_t i = 0; i < 3; ++i) {
        center[i].setZero();
        for (const std::uint32_t v : triangle.patches[i]) center[i] += vertices[v];
    }
    const Matrix3f frame = orthonormal_frame(center[1] - center[0], center[2] - center[0]);
    constexpr float k_least = 0.5f;  // the determinant is 1, or 0 where the corners are on a line
    return frame.determinant() > k_least ? frame : Matrix3f::Identity();
}

/// The vertices among `candidates` nearest to `at`, but at most a quarter, so that those in three places differ;
/// repeated if these are too few.
std::array<std::uint32_t, Segments::Triangle::k_patch> patch_around(const std::vector<std::uint32_t>& candidates,
                                                                    std::span<const Vec3> vertices, const Vec3& at) {
    std::vector<std::uint32_t> sorted = candidates;
    const std::size_t wanted = std::clamp<std::size_t>(sorted.size() / 4, 1, Segments::Triangle::k_patch);
    std::partial_sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(wanted), sorted.end(),
                      [&](std::uint32_t a, std::uint32_t b) {
                          const float da = (vertices[a] - at).squaredNorm(), db = (vertices[b] - at).squaredNorm();
                          return da != db ? da < db : a < b;
                      });
    std::array<std::uint32_t, Segments::Triangle::k_patch> patch;
    for (std::size_t i = 0; i < patch.size(); ++i) patch[i] = sorted[i % wanted];
    return patch;
}

/// Three patches far from each other and from one line.
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
    Segments::Triangle triangle;
    triangle.patches = {patch_around(members, rest, a), patch_around(members, rest, b), patch_around(members, rest, c)};
    return triangle;
}

/// Rotation of the edges around each vertex from rest to a frame (Kabsch), as nine numbers a row.
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
    constexpr int k_most_steps = 30;
    if (!(linear.determinant() > 1e-12f * std::pow(linear.norm(), 3.0f))) return Matrix3f::Identity();
    Matrix3f q = linear;
    for (int step = 0; step < k_most_steps; ++step) {
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
    for (std::size_t s = 0; s < out.size(); ++s)
        out[s] = triangle_frame(triangles[s], vertices);
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
    const std::size_t taken = std::min(frames.size(), k_most_rotation_frames);
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
