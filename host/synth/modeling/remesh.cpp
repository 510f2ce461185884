#include "host/synth/modeling/remesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "host/core/parallel.h"
#include "host/synth/modeling/edit_mesh.h"

namespace exemplar {
namespace {

constexpr int k_rounds = 5;                                  // of flips and smoothing
constexpr float k_bend_per_edge = 0.45f;                     // radians per edge beyond which triangles get smaller
constexpr float k_min_density = 0.8f, k_max_density = 2.5f;  // wanted edge length = uniform length / density

/// Returns the edge length of `faces` equilateral triangles with the mesh's area.
float uniform_edge_length(const TriangleMesh& mesh, std::size_t faces) {
    const std::vector<float> areas = face_areas(mesh);
    const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
    return static_cast<float>(std::sqrt(area / static_cast<double>(faces) * 2.3094));
}

/// Returns how much finer than uniform the triangles should be at each vertex, by how fast the normal turns there.
std::vector<float> vertex_densities(const EditMesh& mesh, float length) {
    // Around a vertex of a closed mesh the corners of its faces list every neighbor twice.
    std::vector<float> density(mesh.vertex_count());
    parallel_for(
        density.size(),
        [&](std::size_t i) {
            const auto v = static_cast<std::uint32_t>(i);
            float turn = 0, distance = 0;
            for (const std::uint32_t f : mesh.faces_of(v)) {
                for (const std::uint32_t u : mesh.face(f)) {
                    turn += (mesh.normal(u) - mesh.normal(v)).norm();
                    distance += (mesh.position(u) - mesh.position(v)).norm();
                }
            }
            density[v] = turn / std::max(distance, 1e-12f) * length / k_bend_per_edge;
        },
        512);
    for (int pass = 0; pass < 3; ++pass) {
        std::vector<float> smoothed(density.size());
        parallel_for(
            density.size(),
            [&](std::size_t i) {
                const auto faces = mesh.faces_of(static_cast<std::uint32_t>(i));
                float sum = 0;
                for (const std::uint32_t f : faces)
                    for (const std::uint32_t u : mesh.face(f)) sum += density[u];
                // v itself counts once per face: its weight is a third of the total.
                smoothed[i] = sum / (3 * static_cast<float>(faces.size()));
            },
            512);
        density = std::move(smoothed);
    }
    for (float& d : density) d = std::clamp(d, k_min_density, k_max_density);
    return density;
}

/// Collapses edges, the shortest relative to the wanted length first, until `faces` are left or nothing can
/// collapse.
class Coarsener {
  public:
    Coarsener(EditMesh& mesh, std::vector<float>& density) : mesh_(mesh), density_(density) {
        version_.resize(mesh.vertex_count(), 0);
    }
    void run(std::size_t faces, float length) {
        for (const float share : {0.35f, 0.5f, 0.6f}) sweep(2 * share * length, faces);
        // Edges that could not collapse may do so after changes around them, so this repeats while it helps.
        for (std::size_t before = mesh_.live_faces() + 1; mesh_.live_faces() < before && mesh_.live_faces() > faces;) {
            before = mesh_.live_faces();
            std::vector<Candidate> all;
            for (const auto& [a, b] : mesh_.edges()) all.push_back(candidate(a, b));
            queue_ = std::priority_queue<Candidate, std::vector<Candidate>, Later>({}, std::move(all));
            drain(faces);
        }
    }

  private:
    struct Candidate {
        float cost;
        std::uint32_t a, b, version_a, version_b;
    };
    struct Later {
        bool operator()(const Candidate& x, const Candidate& y) const {
            return std::tie(x.cost, x.a, x.b) > std::tie(y.cost, y.a, y.b);
        }
    };

    Candidate candidate(std::uint32_t a, std::uint32_t b) const {
        const float length = (mesh_.position(a) - mesh_.position(b)).norm();
        return {length * (density_[a] + density_[b]), a, b, version_[a], version_[b]};
    }
    /// Goes through the faces and collapses their shortest edges up to this cost: most of the work, without a queue.
    void sweep(float limit, std::size_t faces) {
        for (std::uint32_t f = 0; f < mesh_.face_count() && mesh_.live_faces() > faces; ++f) {
            if (!mesh_.is_live_face(f)) continue;
            const auto [a, b, c] = mesh_.face(f);
            const Candidate shortest = std::min({candidate(a, b), candidate(b, c), candidate(c, a)},
                                                [](const Candidate& x, const Candidate& y) { return x.cost < y.cost; });
            if (shortest.cost > limit || !mesh_.collapse(shortest.a, shortest.b)) continue;
            density_[shortest.a] = (density_[shortest.a] + density_[shortest.b]) / 2;
        }
    }
    void drain(std::size_t faces) {
        while (!queue_.empty() && mesh_.live_faces() > faces) {
            const Candidate c = queue_.top();
            queue_.pop();
            if (c.version_a != version_[c.a] || c.version_b != version_[c.b] || !mesh_.collapse(c.a, c.b)) continue;
            density_[c.a] = (density_[c.a] + density_[c.b]) / 2;
            ++version_[c.a];
            ++version_[c.b];
            for (const std::uint32_t u : mesh_.neighbors(c.a)) queue_.push(candidate(c.a, u));
        }
    }

    EditMesh& mesh_;
    std::vector<float>& density_;
    std::vector<std::uint32_t> version_;
    std::priority_queue<Candidate, std::vector<Candidate>, Later> queue_;
};

/// Returns the new position and normal of v: moved toward the weighted center of its faces within the tangent plane,
/// then onto the surface.
std::pair<Vec3, Vec3> smoothed_vertex(const EditMesh& mesh, const std::vector<float>& density,
                                      const ImplicitField& field, std::uint32_t v, float length) {
    Vec3 center = Vec3::Zero();
    float total = 0;
    for (const std::uint32_t f : mesh.faces_of(v)) {
        const auto [a, b, c] = mesh.face(f);
        const Vec3 &pa = mesh.position(a), &pb = mesh.position(b), &pc = mesh.position(c);
        const float d = density[a] + density[b] + density[c];
        const float weight = (pb - pa).cross(pc - pa).norm() * d * d;
        center += weight * (pa + pb + pc) / 3;
        total += weight;
    }
    const Vec3& old = mesh.position(v);
    Vec3 shift = total > 0 ? Vec3(center / total - old) : Vec3(Vec3::Zero());
    shift -= mesh.normal(v) * mesh.normal(v).dot(shift);
    Vec3 position = old + 0.8f * shift;
    const Vec3 normal = field.project(position, 0.5f * length);
    if (mesh.can_move(v, position, normal)) return {position, normal};
    return {old, mesh.normal(v)};
}

void smooth(EditMesh& mesh, const std::vector<float>& density, const ImplicitField& field, float length) {
    std::vector<std::pair<Vec3, Vec3>> moved(mesh.vertex_count());
    parallel_for(
        mesh.vertex_count(),
        [&](std::size_t i) {
            const auto v = static_cast<std::uint32_t>(i);
            if (mesh.is_live(v)) moved[i] = smoothed_vertex(mesh, density, field, v, length);
        },
        128);
    for (std::uint32_t v = 0; v < moved.size(); ++v)
        if (mesh.is_live(v)) mesh.move(v, moved[v].first, moved[v].second);
}

}  // namespace

TriangleMesh remesh(const TriangleMesh& mesh, const ImplicitField& field, std::size_t faces) {
    EditMesh edit(mesh);
    const float length = uniform_edge_length(mesh, faces);
    std::vector<float> density = vertex_densities(edit, length);
    Coarsener(edit, density).run(faces, length);
    for (int round = 0; round < k_rounds; ++round) {
        for (const auto& [a, b] : edit.edges()) edit.improve_edge(a, b);
        smooth(edit, density, field, length);
    }
    for (const auto& [a, b] : edit.edges()) edit.improve_edge(a, b);
    return edit.compact();
}

}  // namespace exemplar
