#include "host/mesh/editing/simplify.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/mesh/queries/distance_queue.h"
#include "host/mesh/queries/point_tree.h"
#include "host/mesh/topology.h"

namespace exemplar {
namespace {

constexpr int k_passes = 4;                    ///< of clustering; further ones hardly move the seeds
constexpr std::size_t k_faces_per_vertex = 2;  ///< of a closed mesh
constexpr double k_ridge = 0.01;  ///< pulls a vertex to its cluster's center in directions that its planes leave free

/// Compressed rows of indices.
struct Rows {
    std::vector<std::uint32_t> begin, value;

    std::span<const std::uint32_t> operator[](std::size_t row) const {
        return {value.data() + begin[row], value.data() + begin[row + 1]};
    }
};

/// Builds rows from the pairs that for_each_pair(emit) passes to emit(row, value), in that order; calls it twice.
template <typename ForEachPair>
Rows make_rows(std::size_t count, ForEachPair&& for_each_pair) {
    Rows rows;
    rows.begin.assign(count + 1, 0);
    for_each_pair([&](std::uint32_t row, std::uint32_t) { ++rows.begin[row + 1]; });
    std::partial_sum(rows.begin.begin(), rows.begin.end(), rows.begin.begin());
    rows.value.resize(rows.begin.back());
    std::vector<std::uint32_t> next(rows.begin.begin(), rows.begin.end() - 1);
    for_each_pair([&](std::uint32_t row, std::uint32_t value) { rows.value[next[row]++] = value; });
    return rows;
}

Rows vertex_neighbors(const TriangleMesh& mesh) {
    return make_rows(mesh.vertex_count(), [&](auto&& emit) {
        for (const Face& face : mesh.faces)
            for (std::size_t k = 0; k < 3; ++k) {
                emit(face[k], face[(k + 1) % 3]);
                emit(face[(k + 1) % 3], face[k]);
            }
    });
}

/// Maps a mesh to unit size around the origin and back, so that single precision suffices at any scale.
class UnitFrame {
  public:
    explicit UnitFrame(const TriangleMesh& mesh) {
        const BoundingBox box = bounding_box(mesh);
        origin_ = (box.low + box.high) / 2;
        if (box.diagonal() > 0) size_ = box.diagonal();
    }
    Vec3 to_unit(const Vec3& p) const { return ((p.cast<double>() - origin_) / size_).cast<float>(); }
    Vec3 from_unit(const Vec3& p) const { return (origin_ + p.cast<double>() * size_).cast<float>(); }

  private:
    Vec3d origin_;
    double size_ = 1;
};

/// Clusters of the vertices of a mesh of unit size.
class Clustering {
  public:
    Clustering(const TriangleMesh& mesh, std::size_t clusters)
        : mesh_(mesh), neighbors_(vertex_neighbors(mesh)), area_(vertex_areas()) {
        spread_seeds(clusters);
        for (int pass = 0; pass < k_passes; ++pass) {
            check_interrupt();
            if (pass > 0) center_seeds();
            grow();
        }
    }

    std::size_t count() const { return seed_.size(); }
    /// Returns the cluster of a vertex; k_invalid_index in a piece without a seed.
    std::uint32_t of(std::uint32_t vertex) const { return cluster_[vertex]; }

    /// Returns per cluster the point with the smallest weighted sum of squared distances to the planes of its faces.
    std::vector<Vec3> best_points() const {
        std::vector<Eigen::Matrix3d> planes(count(), Eigen::Matrix3d::Zero());
        std::vector<Vec3d> right(count(), Vec3d::Zero());
        const std::vector<Vec3d> center = centers();
        for (const Face& face : mesh_.faces) {
            const Vec3d a = mesh_.vertices[face[0]].cast<double>();
            const Vec3d normal =
                (mesh_.vertices[face[1]].cast<double>() - a).cross(mesh_.vertices[face[2]].cast<double>() - a);
            const double twice_area = normal.norm();
            if (!(twice_area > 0)) continue;
            for (const std::uint32_t v : face) {
                const std::uint32_t c = cluster_[v];
                if (c == k_invalid_index) continue;
                planes[c] += normal * normal.transpose() / twice_area;
                right[c] += normal * normal.dot(a - center[c]) / twice_area;
            }
        }
        std::vector<Vec3> points(count());
        for (std::size_t c = 0; c < count(); ++c) {
            const double ridge = k_ridge * planes[c].trace();
            Vec3d offset = Vec3d::Zero();
            if (ridge > 0) offset = (planes[c] + ridge * Eigen::Matrix3d::Identity()).ldlt().solve(right[c]);
            points[c] = (center[c] + offset).cast<float>();
        }
        return points;
    }

  private:
    std::vector<double> vertex_areas() const {
        std::vector<double> areas(mesh_.vertex_count(), 0);
        for (const Face& face : mesh_.faces) {
            const Vec3& a = mesh_.vertices[face[0]];
            const double area =
                static_cast<double>((mesh_.vertices[face[1]] - a).cross(mesh_.vertices[face[2]] - a).norm()) / 6;
            for (const std::uint32_t v : face) areas[v] += area;
        }
        return areas;
    }

    /// Places seeds at equal steps of accumulated area, in the order of the vertices.
    void spread_seeds(std::size_t clusters) {
        const double step = std::accumulate(area_.begin(), area_.end(), 0.0) / static_cast<double>(clusters);
        double next = step / 2, passed = 0;
        for (std::uint32_t v = 0; v < area_.size(); ++v) {
            passed += area_[v];
            if (passed <= next) continue;
            seed_.push_back(v);
            while (next < passed) next += step;
        }
    }

    /// Grows the clusters from all seeds at once, nearest vertices first and only along edges.
    void grow() {
        cluster_.assign(mesh_.vertex_count(), k_invalid_index);
        std::vector<float> best(mesh_.vertex_count(), std::numeric_limits<float>::infinity());
        std::vector<bool> settled(mesh_.vertex_count(), false);
        DistanceQueue queue;
        for (std::uint32_t c = 0; c < count(); ++c) {
            cluster_[seed_[c]] = c, best[seed_[c]] = 0;
            queue.push(0, seed_[c]);
        }
        while (!queue.empty()) {
            const auto [distance, v] = queue.pop();
            if (settled[v]) continue;
            settled[v] = true;
            const Vec3& seed = mesh_.vertices[seed_[cluster_[v]]];
            for (const std::uint32_t other : neighbors_[v]) {
                const float d = (mesh_.vertices[other] - seed).norm();
                if (settled[other] || !(d < best[other])) continue;
                best[other] = d, cluster_[other] = cluster_[v];
                queue.push(d, other);
            }
        }
    }

    std::vector<Vec3d> centers() const {
        std::vector<Vec3d> center(count(), Vec3d::Zero());
        std::vector<double> total(count(), 0);
        for (std::uint32_t v = 0; v < cluster_.size(); ++v) {
            if (cluster_[v] == k_invalid_index) continue;
            center[cluster_[v]] += area_[v] * mesh_.vertices[v].cast<double>();
            total[cluster_[v]] += area_[v];
        }
        for (std::size_t c = 0; c < count(); ++c) center[c] /= total[c];  // a seed always has area
        return center;
    }

    /// Moves each seed to the vertex of its cluster that is nearest to the center.
    void center_seeds() {
        const std::vector<Vec3d> center = centers();
        std::vector<double> nearest(count(), std::numeric_limits<double>::infinity());
        for (std::uint32_t v = 0; v < cluster_.size(); ++v) {
            const std::uint32_t c = cluster_[v];
            if (c == k_invalid_index || !(area_[v] > 0)) continue;
            const double d = (mesh_.vertices[v].cast<double>() - center[c]).squaredNorm();
            if (d < nearest[c]) nearest[c] = d, seed_[c] = v;
        }
    }

    const TriangleMesh& mesh_;
    Rows neighbors_;
    std::vector<double> area_;
    std::vector<std::uint32_t> seed_, cluster_;
};

/// Returns one face for every three clusters that meet in a face of the mesh, oriented like the first such face.
std::vector<Face> faces_between(const TriangleMesh& mesh, const Clustering& clustering) {
    std::vector<std::tuple<Face, std::uint32_t, Face>> found;  // clusters sorted, face of the mesh, clusters in order
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        Face clusters;
        for (std::size_t k = 0; k < 3; ++k) clusters[k] = clustering.of(mesh.faces[f][k]);
        Face sorted = clusters;
        std::ranges::sort(sorted);
        if (sorted[2] == k_invalid_index || sorted[0] == sorted[1] || sorted[1] == sorted[2]) continue;
        found.emplace_back(sorted, f, clusters);
    }
    std::ranges::sort(found);
    const auto same = [](const auto& a, const auto& b) { return std::get<0>(a) == std::get<0>(b); };
    found.erase(std::unique(found.begin(), found.end(), same), found.end());
    std::ranges::sort(found, {}, [](const auto& entry) { return std::get<1>(entry); });  // in the order of the mesh
    std::vector<Face> faces;
    faces.reserve(found.size());
    for (const auto& entry : found) faces.push_back(std::get<2>(entry));
    return faces;
}

/// Returns the squared distance of a point from a triangle, to its inside or its edges.
float squared_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto from_edge = [&](const Vec3& from, const Vec3& to) {
        const Vec3 along = to - from;
        const float length = along.squaredNorm();
        const float t = length > 0 ? std::clamp((p - from).dot(along) / length, 0.0F, 1.0F) : 0.0F;
        return (from + t * along - p).squaredNorm();
    };
    const Vec3 normal = (b - a).cross(c - a);
    const float squared = normal.squaredNorm();
    const bool inside = squared > 0 && (b - a).cross(p - a).dot(normal) >= 0 && (c - b).cross(p - b).dot(normal) >= 0 &&
                        (a - c).cross(p - c).dot(normal) >= 0;
    if (inside) return (p - a).dot(normal) * (p - a).dot(normal) / squared;
    return std::min({from_edge(a, b), from_edge(b, c), from_edge(c, a)});
}

/// Returns the face that represents each face of the original: the nearest one at its clusters, preferably one that
/// faces the same way.
std::vector<std::uint32_t> assign_faces(const TriangleMesh& mesh, const Clustering& clustering,
                                        const TriangleMesh& simple) {
    const Rows faces_at = make_rows(clustering.count(), [&](auto&& emit) {
        for (std::uint32_t f = 0; f < simple.face_count(); ++f)
            for (const std::uint32_t c : simple.faces[f]) emit(c, f);
    });
    const std::vector<Vec3> center = face_centers(mesh), normal = face_normals(mesh),
                            simple_normal = face_normals(simple);
    const PointTree centers(face_centers(simple));
    std::vector<std::uint32_t> face_of(mesh.face_count());
    parallel_ranges(mesh.face_count(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            std::pair<bool, float> best{true, std::numeric_limits<float>::infinity()};  // turned away, distance
            bool found = false;
            for (const std::uint32_t v : mesh.faces[f]) {
                const std::uint32_t c = clustering.of(v);
                if (c == k_invalid_index) continue;
                for (const std::uint32_t other : faces_at[c]) {
                    const Face& corner = simple.faces[other];
                    const std::pair<bool, float> rating{
                        normal[f].dot(simple_normal[other]) < 0,
                        squared_distance(center[f], simple.vertices[corner[0]], simple.vertices[corner[1]],
                                         simple.vertices[corner[2]])};
                    if (found && !(rating < best)) continue;
                    best = rating, face_of[f] = other, found = true;
                }
            }
            if (!found) face_of[f] = centers.nearest(center[f]);
        }
    });
    return face_of;
}

}  // namespace

SimplifiedMesh simplify_mesh(const TriangleMesh& mesh, std::size_t faces) {
    SimplifiedMesh result;
    if (mesh.face_count() <= faces) {
        result.mesh = mesh;
        result.face_of.resize(mesh.face_count());
        std::iota(result.face_of.begin(), result.face_of.end(), 0U);
        return result;
    }
    const UnitFrame frame(mesh);
    TriangleMesh unit = mesh;
    result.mesh.origin = mesh.origin;
    for (Vec3& v : unit.vertices) v = frame.to_unit(v);
    const Clustering clustering(unit, std::max<std::size_t>(faces / k_faces_per_vertex, 4));
    result.mesh.vertices = clustering.best_points();
    result.mesh.faces = faces_between(unit, clustering);
    if (result.mesh.faces.empty())
        throw MeshError(
            "the mesh has too many faces and cannot be simplified: they share no vertices; join those at the same "
            "place");
    if (result.mesh.face_count() > 2 * faces)
        throw MeshError(
            "the mesh has too many faces and cannot be simplified: they connect vertices at random; export it again");
    result.mesh.source_face_count = static_cast<std::uint32_t>(result.mesh.face_count());
    result.face_of = assign_faces(unit, clustering, result.mesh);
    for (Vec3& v : result.mesh.vertices) v = frame.from_unit(v);
    return result;
}

}  // namespace exemplar
