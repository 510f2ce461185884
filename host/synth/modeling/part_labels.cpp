#include "host/synth/modeling/part_labels.h"

#include <algorithm>
#include <array>
#include <map>

#include "host/core/parallel.h"
#include "host/mesh/topology.h"

namespace exemplar {
namespace {

constexpr int k_smoothing_passes = 3;
constexpr double k_speck_share = 0.3;  // of the area of the part's largest component

struct Neighbor {
    std::uint32_t face;
    float length;  // of the shared edge
};
using Adjacency = std::vector<std::array<Neighbor, 3>>;

Adjacency face_adjacency(const TriangleMesh& mesh, const Topology& topology) {
    Adjacency adjacency(mesh.face_count());
    std::vector<std::size_t> count(mesh.face_count(), 0);
    for (const Edge& edge : topology.edges) {
        const float length = (mesh.vertices[edge.vertex[0]] - mesh.vertices[edge.vertex[1]]).norm();
        for (std::size_t side = 0; side < 2; ++side) {
            const std::uint32_t f = edge.face[side];
            adjacency[f][count[f]++] = {edge.face[1 - side], length};
        }
    }
    return adjacency;
}

/// Gives a face between two faces of another part that part, if this shortens the boundary.
void shorten_boundaries(const Adjacency& adjacency, std::vector<std::int32_t>& part) {
    for (std::uint32_t f = 0; f < part.size(); ++f) {
        std::map<std::int32_t, float> border;
        for (const Neighbor& n : adjacency[f]) border[part[n.face]] += n.length;
        const auto best = std::max_element(border.begin(), border.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
        if (best->second > 1.05f * border[part[f]]) part[f] = best->first;
    }
}

/// Returns the component of equal part of each face, numbered in order of first face.
std::vector<std::uint32_t> part_components(const Adjacency& adjacency, const std::vector<std::int32_t>& part) {
    std::vector<std::uint32_t> component(part.size(), k_invalid_index);
    std::uint32_t count = 0;
    std::vector<std::uint32_t> stack;
    for (std::uint32_t seed = 0; seed < part.size(); ++seed) {
        if (component[seed] != k_invalid_index) continue;
        component[seed] = count;
        stack.push_back(seed);
        while (!stack.empty()) {
            const std::uint32_t f = stack.back();
            stack.pop_back();
            for (const Neighbor& n : adjacency[f]) {
                if (component[n.face] != k_invalid_index || part[n.face] != part[f]) continue;
                component[n.face] = count;
                stack.push_back(n.face);
            }
        }
        ++count;
    }
    return component;
}

struct Patch {
    std::int32_t part = 0;
    double area = 0;
    std::map<std::int32_t, double> border;  // length shared with each other part
};

std::vector<Patch> measure_patches(const TriangleMesh& mesh, const Adjacency& adjacency,
                                   const std::vector<std::int32_t>& part, const std::vector<std::uint32_t>& component) {
    const std::vector<float> areas = face_areas(mesh);
    std::vector<Patch> patches(*std::max_element(component.begin(), component.end()) + 1);
    for (std::uint32_t f = 0; f < part.size(); ++f) {
        Patch& patch = patches[component[f]];
        patch.part = part[f];
        patch.area += areas[f];
        for (const Neighbor& n : adjacency[f])
            if (part[n.face] != part[f]) patch.border[part[n.face]] += n.length;
    }
    return patches;
}

/// Gives each speck to a neighboring part; returns whether any face changed its part.
bool dissolve_specks(const TriangleMesh& mesh, const Adjacency& adjacency, std::vector<std::int32_t>& part) {
    const std::vector<std::uint32_t> component = part_components(adjacency, part);
    const std::vector<Patch> patches = measure_patches(mesh, adjacency, part, component);
    std::map<std::int32_t, double> largest;
    for (const Patch& patch : patches) largest[patch.part] = std::max(largest[patch.part], patch.area);
    std::vector<std::int32_t> replacement(patches.size());
    bool found = false;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        const Patch& patch = patches[i];
        replacement[i] = patch.part;
        if (patch.area >= k_speck_share * largest[patch.part] || patch.border.empty()) continue;
        replacement[i] = std::max_element(patch.border.begin(), patch.border.end(), [](const auto& a, const auto& b) {
                             return a.second < b.second;
                         })->first;
        found = true;
    }
    for (std::uint32_t f = 0; f < part.size(); ++f) part[f] = replacement[component[f]];
    return found;
}

}  // namespace

std::vector<std::int32_t> label_faces(const TriangleMesh& mesh, const ImplicitField& field) {
    const std::vector<Vec3> centers = face_centers(mesh);
    std::vector<std::int32_t> part(mesh.face_count());
    parallel_for(
        part.size(), [&](std::size_t f) { part[f] = field.dominant_part(centers[f]); }, 256);
    const Adjacency adjacency = face_adjacency(mesh, build_topology(mesh));
    for (int pass = 0; pass < k_smoothing_passes; ++pass) shorten_boundaries(adjacency, part);
    for (int pass = 0; pass < 4 && dissolve_specks(mesh, adjacency, part); ++pass) {
    }
    return part;
}

}  // namespace exemplar
