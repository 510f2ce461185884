#include "host/mesh/topology.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace exemplar {

namespace {

/// Turns counts, stored at [i + 1], into offsets.
void counts_to_offsets(std::vector<std::uint32_t>& begin) {
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
}

/// Returns whether side i of a face (from corner i to the next) is a proper edge that no earlier side repeats.
bool opens_edge(const Face& face, int i) {
    const auto& [a, b, c] = face;
    switch (i) {
        case 0:
            return a != b;
        case 1:
            return b != c && c != a;
        default:
            return c != a && a != b && b != c;
    }
}

/// A side of a face as seen from its smaller vertex.
struct Side {
    std::uint32_t far_vertex;
    std::uint32_t face;
    bool operator<(const Side& other) const {
        return far_vertex != other.far_vertex ? far_vertex < other.far_vertex : face < other.face;
    }
};

/// Sorts all sides into rows by their smaller vertex (a counting sort), each row by far vertex and face.
std::vector<Side> sorted_sides(const TriangleMesh& mesh, std::vector<std::uint32_t>& begin) {
    begin.assign(mesh.vertex_count() + 1, 0);
    for (const Face& face : mesh.faces)
        for (int i = 0; i < 3; ++i)
            if (opens_edge(face, i)) ++begin[std::min(face[i], face[(i + 1) % 3]) + 1];
    counts_to_offsets(begin);
    std::vector<Side> sides(begin.back());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const Face& face = mesh.faces[f];
        for (int i = 0; i < 3; ++i) {
            if (!opens_edge(face, i)) continue;
            const auto [low, high] = std::minmax(face[i], face[(i + 1) % 3]);
            sides[next[low]++] = {high, f};
        }
    }
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        std::sort(sides.begin() + begin[v], sides.begin() + begin[v + 1]);
    return sides;
}

void build_edges(const TriangleMesh& mesh, Topology& topology) {
    std::vector<std::uint32_t> begin;
    const std::vector<Side> sides = sorted_sides(mesh, begin);
    topology.edges.reserve(sides.size() / 2 + 1);
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        for (std::uint32_t i = begin[v]; i < begin[v + 1];) {
            const std::uint32_t far_vertex = sides[i].far_vertex, first = i;
            while (i < begin[v + 1] && sides[i].far_vertex == far_vertex) ++i;
            if (i - first == 1) topology.edges.push_back({{v, far_vertex}, {sides[first].face, k_invalid_index}});
            for (std::uint32_t j = first + 1; j < i; ++j)
                topology.edges.push_back({{v, far_vertex}, {sides[j - 1].face, sides[j].face}});
        }
    }
}

void build_face_edges(std::size_t face_count, Topology& topology) {
    auto& begin = topology.face_edge_begin;
    begin.assign(face_count + 1, 0);
    for (const Edge& edge : topology.edges)
        for (std::uint32_t f : edge.face)
            if (f != k_invalid_index) ++begin[f + 1];
    counts_to_offsets(begin);
    topology.face_edges.resize(begin.back());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (std::uint32_t e = 0; e < topology.edges.size(); ++e)
        for (std::uint32_t f : topology.edges[e].face)
            if (f != k_invalid_index) topology.face_edges[next[f]++] = e;
}

/// Returns whether corner i of a face names a vertex that no earlier corner names.
bool opens_vertex(const Face& face, int i) {
    return i == 0 || (face[i] != face[0] && (i == 1 || face[2] != face[1]));
}

void build_vertex_faces(const TriangleMesh& mesh, Topology& topology) {
    auto& begin = topology.vertex_face_begin;
    begin.assign(mesh.vertex_count() + 1, 0);
    for (const Face& face : mesh.faces)
        for (int i = 0; i < 3; ++i)
            if (opens_vertex(face, i)) ++begin[face[i] + 1];
    counts_to_offsets(begin);
    topology.vertex_faces.resize(begin.back());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        for (int i = 0; i < 3; ++i)
            if (opens_vertex(mesh.faces[f], i)) topology.vertex_faces[next[mesh.faces[f][i]]++] = f;
}

/// Returns whether a face traverses the edge a-b from a to b.
bool runs_forward(const Face& face, std::uint32_t a, std::uint32_t b) {
    for (int i = 0; i < 3; ++i)
        if (face[i] == a && face[(i + 1) % 3] == b) return true;
    return false;
}

/// Returns the exterior angle, given the two unit normals and the unit direction in which the first face traverses
/// the edge.
double exterior_angle(const Vec3d& n0, const Vec3d& n1, const Vec3d& direction) {
    const double cosine = n0.dot(n1);
    double bend = std::atan2(direction.dot(n0.cross(n1)), cosine);
    // At a complete fold the sign is noise; a sheet folded onto itself has the outside all around the edge.
    if (cosine < -1 + 1e-7) bend = std::abs(bend);
    return std::numbers::pi + bend;
}

/// Returns the unit normal in double; zero for a degenerate face.
Vec3d normal_or_zero(const TriangleMesh& mesh, const Face& face) {
    const Vec3d a = mesh.vertices[face[0]].cast<double>();
    const Vec3d n = (mesh.vertices[face[1]].cast<double>() - a).cross(mesh.vertices[face[2]].cast<double>() - a);
    const double length = n.norm();
    return length > 0 ? Vec3d(n / length) : Vec3d(Vec3d::Zero());
}

}  // namespace

Topology build_topology(const TriangleMesh& mesh) {
    Topology topology;
    build_edges(mesh, topology);
    build_face_edges(mesh.face_count(), topology);
    build_vertex_faces(mesh, topology);
    return topology;
}

std::vector<std::uint32_t> face_components(const TriangleMesh& mesh, const Topology& topology) {
    std::vector<std::uint32_t> component(mesh.face_count(), k_invalid_index), stack;
    std::uint32_t count = 0;
    for (std::uint32_t first = 0; first < mesh.face_count(); ++first) {
        if (component[first] != k_invalid_index) continue;
        component[first] = count;
        stack.push_back(first);
        while (!stack.empty()) {
            const std::uint32_t f = stack.back();
            stack.pop_back();
            for (std::uint32_t e : topology.edges_of_face(f))
                for (std::uint32_t g : topology.edges[e].face)
                    if (g != k_invalid_index && component[g] == k_invalid_index) {
                        component[g] = count;
                        stack.push_back(g);
                    }
        }
        ++count;
    }
    return component;
}

std::vector<float> exterior_dihedral_angles(const TriangleMesh& mesh, const Topology& topology) {
    std::vector<Vec3d> normals;
    normals.reserve(mesh.face_count());
    for (const Face& face : mesh.faces) normals.push_back(normal_or_zero(mesh, face));
    std::vector<float> angles(topology.edges.size(), std::numbers::pi_v<float>);
    for (std::size_t e = 0; e < angles.size(); ++e) {
        const auto& [vertex, face] = topology.edges[e];
        if (face[1] == k_invalid_index || normals[face[0]].isZero(0) || normals[face[1]].isZero(0)) continue;
        const bool forward = runs_forward(mesh.faces[face[0]], vertex[0], vertex[1]);
        const bool consistent = forward != runs_forward(mesh.faces[face[1]], vertex[0], vertex[1]);
        const Vec3d direction = (mesh.vertices[vertex[1]] - mesh.vertices[vertex[0]]).cast<double>().normalized();
        angles[e] = static_cast<float>(exterior_angle(normals[face[0]],
                                                      consistent ? normals[face[1]] : Vec3d(-normals[face[1]]),
                                                      forward ? direction : Vec3d(-direction)));
    }
    return angles;
}

}  // namespace exemplar
