#include "host/mesh/editing/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/mesh/editing/area_vector.h"

namespace exemplar {
namespace {

void find_vertex_defects(const TriangleMesh& mesh, MeshReport& report) {
    std::vector<bool> referenced(mesh.vertex_count(), false);
    for (const Face& face : mesh.faces)
        for (std::uint32_t v : face) referenced[v] = true;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        if (!mesh.vertices[v].allFinite()) report.non_finite_vertices.push_back(v);
        if (!referenced[v]) report.unreferenced_vertices.push_back(v);
    }
}

void find_degenerate_faces(const TriangleMesh& mesh, MeshReport& report) {
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const Face& face = mesh.faces[f];
        const bool repeats = face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
        if (repeats || doubled_area_vector(mesh, face).isZero(0)) report.degenerate_faces.push_back(f);
    }
}

void find_duplicate_faces(const TriangleMesh& mesh, MeshReport& report) {
    struct Corners {
        Face sorted;
        std::uint32_t face;
        bool operator<(const Corners& other) const {
            return sorted != other.sorted ? sorted < other.sorted : face < other.face;
        }
    };
    std::vector<Corners> all(mesh.face_count());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        all[f] = {mesh.faces[f], f};
        std::ranges::sort(all[f].sorted);
    }
    std::sort(all.begin(), all.end());
    for (std::size_t i = 1; i < all.size(); ++i)
        if (all[i].sorted == all[i - 1].sorted) report.duplicate_faces.push_back(all[i].face);
    std::ranges::sort(report.duplicate_faces);
}

/// Returns +1 if a face traverses the edge from its first vertex to its second, -1 if in reverse, 0 if both (a
/// repeated vertex).
int direction_through(const Face& face, const Edge& edge) {
    int direction = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = face[i], b = face[(i + 1) % 3];
        if (a == edge.vertex[0] && b == edge.vertex[1]) ++direction;
        if (a == edge.vertex[1] && b == edge.vertex[0]) --direction;
    }
    return direction;
}

/// Fills in the defects of edges. Returns whether the surface is closed and consistently oriented, that is, whether
/// faces traverse every edge as often in one direction as in the other.
bool find_edge_defects(const TriangleMesh& mesh, const Topology& topology, MeshReport& report) {
    bool is_cycle = !mesh.faces.empty();
    const auto& edges = topology.edges;
    for (std::size_t e = 0; e < edges.size();) {
        const std::size_t first = e;
        int sum = direction_through(mesh.faces[edges[first].face[0]], edges[first]);
        for (; e < edges.size() && edges[e].vertex == edges[first].vertex; ++e)
            if (!edges[e].is_boundary()) sum += direction_through(mesh.faces[edges[e].face[1]], edges[e]);
        if (edges[first].is_boundary()) ++report.boundary_edges;
        if (e - first > 1)
            report.non_manifold_edges.push_back(edges[first].vertex);
        else if (std::abs(sum) == 2)
            report.inconsistent_edges.push_back(edges[first].vertex);
        is_cycle = is_cycle && sum == 0 && !edges[first].is_boundary();
    }
    return is_cycle;
}

double signed_volume(const TriangleMesh& mesh) {
    if (mesh.vertices.empty()) return 0;
    const Vec3d origin = mesh.vertices[0].cast<double>();
    double six_volumes = 0;
    for (const Face& face : mesh.faces)
        six_volumes += doubled_area_vector(mesh, face).dot(mesh.vertices[face[0]].cast<double>() - origin);
    return six_volumes / 6;
}

std::string place(std::uint32_t element) {
    return std::to_string(element);
}
std::string place(const std::array<std::uint32_t, 2>& edge) {
    return fmt::format("{}-{}", edge[0], edge[1]);
}

/// Appends "NUMBER SINGULAR or PLURAL (FIRST PLACES): MEND" if there are any.
template <typename Element>
void add_message(std::vector<std::string>& lines, const std::vector<Element>& elements, const std::string& what,
                 const std::string& many, const std::string& mend) {
    constexpr std::size_t k_places = 5;
    if (elements.empty()) return;
    std::string places;
    for (std::size_t i = 0; i < std::min(elements.size(), k_places); ++i)
        places += (i ? ", " : "") + place(elements[i]);
    if (elements.size() > k_places) places += ", ...";
    lines.push_back(fmt::format("{} {} ({}): {}", elements.size(), elements.size() == 1 ? what : many, places, mend));
}

}  // namespace

bool MeshReport::clean() const {
    return usable() && non_manifold_edges.empty() && inconsistent_edges.empty() && degenerate_faces.empty() &&
           duplicate_faces.empty() && unreferenced_vertices.empty() && !inside_out;
}

std::vector<std::string> MeshReport::messages() const {
    std::vector<std::string> lines;
    if (const std::size_t points = unreferenced_vertices.size(); empty && points > 0)
        lines.push_back(
            fmt::format("{} point{} and no faces: a point cloud cannot be used; make it a surface first, say by a "
                        "reconstruction in MeshLab",
                        points, points == 1 ? "" : "s"));
    else if (empty)
        lines.push_back("the mesh has no faces: it cannot be used; save it again with its surface");
    add_message(lines, non_finite_vertices, "vertex is not finite", "vertices are not finite",
                "the mesh cannot be used until they have numbers for coordinates");
    add_message(lines, non_manifold_edges, "edge with more than two faces", "edges with more than two faces",
                "their faces are taken as neighbors one after the other");
    add_message(lines, inconsistent_edges, "edge between faces of opposite orientation",
                "edges between faces of opposite orientation",
                "kept; normals and what is seen along them are wrong on one side, so make the orientation consistent");
    if (inside_out) lines.push_back("the surface is inside out: kept; normals point inward, so reverse all faces");
    add_message(lines, degenerate_faces, "face without area", "faces without area",
                "kept; they take normals from their neighbors and weigh nothing");
    add_message(lines, duplicate_faces, "face with the vertices of an earlier one",
                "faces with the vertices of earlier ones", "kept; they count twice");
    add_message(lines, unreferenced_vertices, "vertex without a face", "vertices without a face", "they are ignored");
    if (boundary_edges)
        lines.push_back(fmt::format("{} boundary edge{}: the surface is open; rays may leave through its holes",
                                    boundary_edges, boundary_edges == 1 ? "" : "s"));
    if (components > 1)
        lines.push_back(fmt::format(
            "{} connected components: distances run within each, so join pieces that belong together", components));
    return lines;
}

MeshReport validate_mesh(const TriangleMesh& mesh) {
    MeshReport report;
    report.empty = mesh.faces.empty();
    const Topology topology = build_topology(mesh);
    find_vertex_defects(mesh, report);
    find_degenerate_faces(mesh, report);
    find_duplicate_faces(mesh, report);
    const bool is_cycle = find_edge_defects(mesh, topology, report);
    const std::vector<std::uint32_t> component = face_components(mesh, topology);
    if (!component.empty()) report.components = *std::ranges::max_element(component) + std::size_t{1};
    report.inside_out = is_cycle && report.usable() && signed_volume(mesh) < 0;
    return report;
}

std::string size_fault(const TriangleMesh& mesh, const SizeRange& range) {
    if (mesh.faces.empty()) return {};
    const double size = bounding_box(mesh).diagonal();
    if (size > range.largest)
        return fmt::format("the mesh is too large ({:.2g} across) for computations in floats; scale it to below {:.0e}",
                           size, range.largest);
    if (size > 0 && size < range.smallest)
        return fmt::format("the mesh is too small ({:.2g} across) for computations in floats; scale it to above {:.0e}",
                           size, range.smallest);
    return {};
}

namespace {

MeshReport require_sized(const TriangleMesh& mesh, const std::string& name, const SizeRange& range) {
    MeshReport report = validate_mesh(mesh);
    if (!report.usable()) throw MeshError(name + ": " + report.messages().front());
    if (const std::string fault = size_fault(mesh, range); !fault.empty()) throw MeshError(name + ": " + fault);
    return report;
}

}  // namespace

MeshReport require_usable(const TriangleMesh& mesh, const std::string& name) {
    return require_sized(mesh, name, k_usable_sizes);
}

MeshReport require_drawable(const TriangleMesh& mesh, const std::string& name) {
    return require_sized(mesh, name, k_drawable_sizes);
}

}  // namespace exemplar
