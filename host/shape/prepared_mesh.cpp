#include "host/shape/prepared_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "host/core/parallel.h"
#include "host/mesh/editing/validate.h"
#include "host/shape/percentile.h"

namespace exemplar {
namespace {

Vec3d corner(const TriangleMesh& mesh, const Face& face, int k) {
    return mesh.vertices[face[static_cast<std::size_t>(k)]].cast<double>();
}

/// Area-weighted mean of the face centers in double precision; the plain mean where there is no area.
Vec3d surface_centroid(const TriangleMesh& mesh) {
    Vec3d weighted = Vec3d::Zero(), plain = Vec3d::Zero();
    double total = 0.0;
    for (const Face& face : mesh.faces) {
        const Vec3d a = corner(mesh, face, 0), b = corner(mesh, face, 1), c = corner(mesh, face, 2);
        const double area = 0.5 * (b - a).cross(c - a).norm();
        weighted += area * (a + b + c) / 3.0;
        plain += (a + b + c) / 3.0;
        total += area;
    }
    return total > 0.0 ? Vec3d(weighted / total) : Vec3d(plain / static_cast<double>(mesh.face_count()));
}

/// Returns whether the normals of a centered mesh of unit diagonal point inward. A surface with holes is judged only
/// if they are too small to matter: the cones over them from the centroid hold less than the signed volume of the
/// rest.
bool faces_inward(const TriangleMesh& mesh) {
    const MeshReport report = validate_mesh(mesh);
    if (report.inside_out) return true;
    if (!report.inconsistent_edges.empty() || !report.non_manifold_edges.empty()) return false;
    Vec3d area = Vec3d::Zero();
    double volume = 0.0;
    for (const Face& face : mesh.faces) {
        const Vec3d a = corner(mesh, face, 0);
        const Vec3d vector = 0.5 * (corner(mesh, face, 1) - a).cross(corner(mesh, face, 2) - a);
        area += vector;
        volume += vector.dot(a) / 3.0;
    }
    constexpr double k_rounding = 1e-6;
    return report.boundary_edges > 0 && volume < -(area.norm() / 3.0 + k_rounding);
}

/// The mesh with its centroid at the origin and unit size: later steps may work in single precision at any scale.
TriangleMesh centered_mesh(const TriangleMesh& mesh) {
    const double diagonal = bounding_box(mesh).diagonal();
    const double scale = diagonal > 0.0 ? 1.0 / diagonal : 1.0;
    const Vec3d centroid = surface_centroid(mesh);
    TriangleMesh centered;
    centered.faces = mesh.faces;
    centered.source_face_count = static_cast<std::uint32_t>(mesh.face_count());
    centered.vertices.assign(mesh.vertex_count(), Vec3::Zero());
    for (const Face& face : mesh.faces) {  // unreferenced vertices may lie anywhere; they stay at the origin
        for (const std::uint32_t v : face) {
            centered.vertices[v] = ((mesh.vertices[v].cast<double>() - centroid) * scale).cast<float>();
        }
    }
    if (faces_inward(centered)) {
        for (Face& face : centered.faces) std::swap(face[1], face[2]);
    }
    return centered;
}

/// A face near another one, its weight, and its center in the other's tangent plane.
struct NearFace {
    std::uint32_t face;
    double weight;
    Eigen::Vector2d offset;
};

/// Collects faces around vertex `v`, `face` among them: all, or where there are more than k_max_fan those that edges at
/// the vertex join to `face`, nearest first, until there are as many. The tip of a cone of n faces would otherwise
/// cost n steps for each of them.
void faces_around(const PreparedMesh& prepared, std::uint32_t face, std::uint32_t v,
                  std::vector<std::uint32_t>& around) {
    constexpr std::size_t k_max_fan = 128;
    const std::span<const std::uint32_t> all = prepared.topology.faces_of_vertex(v);
    around.assign(all.begin(), all.size() > k_max_fan ? all.begin() : all.end());
    if (all.size() <= k_max_fan) return;
    around.push_back(face);
    // Whole rings of the search, so that both sides of the face end equally far from it.
    for (std::size_t done = 0, ring = 1; done < ring && ring < k_max_fan; ring = around.size())
        for (; done < ring; ++done)
            for (const std::uint32_t e : prepared.topology.edges_of_face(around[done])) {
                const Edge& edge = prepared.topology.edges[e];
                if (edge.is_boundary() || (edge.vertex[0] != v && edge.vertex[1] != v)) continue;
                const std::uint32_t next = edge.face[edge.face[0] == around[done] ? 1 : 0];
                if (std::ranges::find(around, next) == around.end()) around.push_back(next);
            }
}

/// Collects the faces that share a vertex with `face`, itself included, once per shared vertex. Weights are areas
/// times the cosine between the normals: faces at a right angle to each other do not mix, so that the edges of a box
/// stay sharp.
void find_near_faces(const PreparedMesh& prepared, const std::vector<float>& areas, const std::vector<Vec3>& normals,
                     std::uint32_t face, std::vector<std::uint32_t>& around, std::vector<NearFace>& near) {
    const Vec3 &center = prepared.center[face], &normal = normals[face];
    const Vec3 x = normal.unitOrthogonal(), y = normal.cross(x);
    near.clear();
    for (const std::uint32_t v : prepared.mesh.faces[face]) {
        faces_around(prepared, face, v, around);
        for (const std::uint32_t f : around) {
            const Vec3 from = prepared.center[f] - center;
            near.push_back({f,
                            static_cast<double>(areas[f] * std::max(normals[f].dot(normal), 0.0F)),
                            {static_cast<double>(from.dot(x)), static_cast<double>(from.dot(y))}});
        }
    }
}

/// Returns the intercept of a weighted linear regression of the normals: a mean whose weights are balanced so that
/// their center is the origin. If all faces lie on one side, as at a border, balancing stops before a weight falls
/// below zero. Zero if there is no weight.
Vec3d regressed_normal(const std::vector<NearFace>& near, const std::vector<Vec3>& normals) {
    constexpr double k_ridge = 1e-3;  // faces on one line have no slope across it
    Eigen::Vector2d moment = Eigen::Vector2d::Zero(), slope = moment;
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const NearFace& n : near) {
        moment += n.weight * n.offset;
        spread += n.weight * n.offset * n.offset.transpose();
    }
    spread.diagonal().array() += k_ridge * spread.trace();
    if (spread.trace() > 0.0) slope = spread.inverse() * moment;
    double steepest = 1.0;
    for (const NearFace& n : near) steepest = std::max(steepest, slope.dot(n.offset));
    Vec3d sum = Vec3d::Zero();
    for (const NearFace& n : near)
        sum += n.weight * (1.0 - slope.dot(n.offset) / steepest) * normals[n.face].cast<double>();
    return sum;
}

/// Face normals without the noise of the tessellation: twice the local linear regression, at the face's own center, of
/// the normals around it. A plain mean would lean to where the larger faces are.
std::vector<Vec3> smoothed_normals(const PreparedMesh& prepared, const std::vector<float>& areas) {
    constexpr int k_passes = 2;
    std::vector<Vec3> normals = face_normals(prepared.mesh);
    for (int pass = 0; pass < k_passes; ++pass) {
        const std::vector<Vec3> previous = normals;
        parallel_ranges(normals.size(), 1024, [&](std::size_t begin, std::size_t end) {
            std::vector<std::uint32_t> around;
            std::vector<NearFace> near;
            for (std::size_t f = begin; f < end; ++f) {
                find_near_faces(prepared, areas, previous, static_cast<std::uint32_t>(f), around, near);
                const Vec3d sum = regressed_normal(near, previous);
                if (const double length = sum.norm(); length > 0.0) normals[f] = (sum / length).cast<float>();
            }
        });
    }
    return normals;
}

/// Shares of the total area; equal shares where there is no area.
std::vector<float> area_shares(const std::vector<float>& areas, double total) {
    std::vector<float> shares(areas.size(), 1.0F / static_cast<float>(areas.size()));
    if (total > 0.0) {
        for (std::size_t f = 0; f < areas.size(); ++f) {
            shares[f] = static_cast<float>(static_cast<double>(areas[f]) / total);
        }
    }
    return shares;
}

/// Shares of the samples; equal shares where the sampled components have no area.
void mend_sample_shares(FaceSamples& samples) {
    const double total = std::accumulate(samples.area_share.begin(), samples.area_share.end(), 0.0);
    if (std::isfinite(total) && total > 0.0) return;
    samples.area_share.assign(samples.face.size(), 1.0F / static_cast<float>(samples.face.size()));
}

std::vector<std::uint32_t> component_sizes(const TriangleMesh& mesh, const Topology& topology) {
    const std::vector<std::uint32_t> component = face_components(mesh, topology);
    std::vector<std::uint32_t> size(mesh.face_count(), 0);
    for (const std::uint32_t c : component) ++size[c];
    std::vector<std::uint32_t> of_face(mesh.face_count());
    for (std::size_t f = 0; f < component.size(); ++f) of_face[f] = size[component[f]];
    return of_face;
}

/// 30th, 50th and 95th percentile of the distances between different faces; zeros if there are none.
std::array<float, 3> distance_percentiles(const PreparedMesh& prepared) {
    const std::size_t faces = prepared.face_count();
    float maximum = 0.0F;
    for (const float d : prepared.distance) {
        if (std::isfinite(d)) maximum = std::max(maximum, d);
    }
    WeightedHistogram histogram(maximum, 1U << 15U);
    for (std::size_t s = 0; s < prepared.sample_count(); ++s) {
        const double share = static_cast<double>(prepared.samples.area_share[s]);
        for (std::size_t f = 0; f < faces; ++f) {
            const float d = prepared.distance[s * faces + f];
            if (f != prepared.samples.face[s] && std::isfinite(d)) {
                histogram.add(d, share * static_cast<double>(prepared.area_share[f]));
            }
        }
    }
    constexpr std::array<double, 3> k_shares{0.30, 0.50, 0.95};
    std::array<float, 3> result{};
    histogram.percentiles(k_shares, result);
    return result;
}

/// Multiplies all lengths by `factor`.
void rescale(PreparedMesh& prepared, float factor) {
    for (Vec3& v : prepared.mesh.vertices) v *= factor;
    for (Vec3& c : prepared.center) c *= factor;
    for (DualGraph::Arc& arc : prepared.graph.arcs) arc.length *= factor;
    for (float& d : prepared.distance) d *= factor;
    prepared.total_area *= factor * factor;
}

}  // namespace

PreparedMesh prepare_mesh(const TriangleMesh& mesh, std::size_t samples) {
    PreparedMesh prepared;
    prepared.mesh = centered_mesh(mesh);
    const std::vector<float> areas = face_areas(prepared.mesh);
    const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
    prepared.total_area = static_cast<float>(total);
    prepared.area_share = area_shares(areas, total);
    prepared.center = face_centers(prepared.mesh);
    prepared.topology = build_topology(prepared.mesh);
    prepared.normal = smoothed_normals(prepared, areas);
    prepared.graph = build_dual_graph(prepared.mesh, prepared.topology);
    prepared.component_size = component_sizes(prepared.mesh, prepared.topology);
    prepared.samples = sample_faces(prepared.mesh, prepared.graph, samples);
    mend_sample_shares(prepared.samples);
    prepared.distance = distances_from_sources(prepared.graph, prepared.samples.face);

    // Without two connected faces of some size there is no distance to use as unit; the size of the whole mesh
    // replaces it.
    auto [unit, median, far] = distance_percentiles(prepared);
    constexpr float k_tiny = 1e-6F;
    if (!(unit > k_tiny)) unit = median > k_tiny ? median : 1.0F;
    if (!(median > k_tiny)) median = unit;
    if (!(far > k_tiny)) far = median;
    rescale(prepared, 1.0F / unit);
    prepared.median_distance = median / unit;
    prepared.far_distance = far / unit;
    return prepared;
}

void gather_distances(const PreparedMesh& prepared, std::size_t begin, std::size_t end, std::vector<float>& out) {
    const std::size_t faces = prepared.face_count(), samples = prepared.sample_count();
    out.resize((end - begin) * samples);
    for (std::size_t s = 0; s < samples; ++s) {
        const float* row = prepared.distance.data() + s * faces;
        for (std::size_t f = begin; f < end; ++f) out[(f - begin) * samples + s] = row[f];
    }
}

Vec3 face_tangent(const PreparedMesh& prepared, std::size_t face) {
    const Face& corners = prepared.mesh.faces[face];
    Vec3 longest = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 edge = prepared.mesh.vertices[corners[(k + 1) % 3]] - prepared.mesh.vertices[corners[k]];
        // Ties (an equilateral face) must not depend on rounding: the first edge is taken unless another is clearly
        // longer.
        if (edge.squaredNorm() > 1.0001F * longest.squaredNorm()) longest = edge;
    }
    const Vec3& normal = prepared.normal[face];
    const Vec3 tangent = longest - longest.dot(normal) * normal;
    const float length = tangent.norm();
    return length > 1e-3F * longest.norm() && length > 0.0F ? Vec3(tangent / length) : normal.unitOrthogonal();
}

}  // namespace exemplar
