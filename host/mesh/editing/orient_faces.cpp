#include "host/mesh/editing/orient_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "host/mesh/editing/area_vector.h"
#include "host/mesh/editing/nested_pieces.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/topology.h"

namespace exemplar {
namespace {

/// The pieces of a surface, and which faces are to be turned around.
struct SurfacePieces {
    std::vector<std::uint32_t> begin, faces;  ///< compressed rows: the faces of each piece, in the order of the walk
    std::vector<std::uint32_t> piece_of_face;
    std::vector<bool> is_turned;  ///< per face

    std::size_t count() const { return begin.size() - 1; }
    std::span<const std::uint32_t> faces_of(std::size_t piece) const {
        return {faces.data() + begin[piece], faces.data() + begin[piece + 1]};
    }
    void turn(std::size_t piece) {
        for (const std::uint32_t f : faces_of(piece)) is_turned[f] = !is_turned[f];
    }
};

/// Returns whether exactly two faces meet at an edge.
bool has_two_faces(const std::vector<Edge>& edges, std::size_t e) {
    const auto is_same = [&](std::size_t other) { return edges[other].vertex == edges[e].vertex; };
    return !edges[e].is_boundary() && (e == 0 || !is_same(e - 1)) && (e + 1 == edges.size() || !is_same(e + 1));
}

bool traverses(const Face& face, const Edge& edge) {
    for (std::size_t i = 0; i < 3; ++i)
        if (face[i] == edge.vertex[0] && face[(i + 1) % 3] == edge.vertex[1]) return true;
    return false;
}

/// Returns whether both faces of an edge traverse it in the same direction, that is, one of them is to be turned.
bool faces_disagree(const TriangleMesh& mesh, const Edge& edge) {
    return traverses(mesh.faces[edge.face[0]], edge) == traverses(mesh.faces[edge.face[1]], edge);
}

/// Finds the pieces by walks in breadth, and turns each face to agree with the one from which it is reached.
SurfacePieces walk_pieces(const TriangleMesh& mesh, const Topology& topology) {
    SurfacePieces pieces{{0}, {}, std::vector<std::uint32_t>(mesh.face_count(), k_invalid_index), {}};
    pieces.is_turned.assign(mesh.face_count(), false);
    for (std::uint32_t first = 0; first < mesh.face_count(); ++first) {
        if (pieces.piece_of_face[first] != k_invalid_index) continue;
        const auto piece = static_cast<std::uint32_t>(pieces.count());
        pieces.piece_of_face[first] = piece;
        pieces.faces.push_back(first);
        for (std::size_t i = pieces.begin.back(); i < pieces.faces.size(); ++i) {
            const std::uint32_t f = pieces.faces[i];
            for (const std::uint32_t e : topology.edges_of_face(f)) {
                if (!has_two_faces(topology.edges, e)) continue;
                const Edge& edge = topology.edges[e];
                const std::uint32_t g = edge.face[0] == f ? edge.face[1] : edge.face[0];
                if (pieces.piece_of_face[g] != k_invalid_index) continue;
                pieces.piece_of_face[g] = piece;
                pieces.is_turned[g] = pieces.is_turned[f] != faces_disagree(mesh, edge);
                pieces.faces.push_back(g);
            }
        }
        pieces.begin.push_back(static_cast<std::uint32_t>(pieces.faces.size()));
    }
    return pieces;
}

/// Counts over the edges of a piece, from which its orientation is decided.
struct PieceEdges {
    bool is_closed = true;           ///< all its edges have two faces
    std::size_t disagreeing = 0;     ///< edges between faces of opposite orientation in the file
    std::size_t still_disagree = 0;  ///< after the walk
};

std::vector<PieceEdges> count_piece_edges(const TriangleMesh& mesh, const Topology& topology,
                                          const SurfacePieces& pieces) {
    std::vector<PieceEdges> counts(pieces.count());
    for (std::size_t e = 0; e < topology.edges.size(); ++e) {
        const Edge& edge = topology.edges[e];
        if (!has_two_faces(topology.edges, e)) {
            for (const std::uint32_t f : edge.face)
                if (f != k_invalid_index) counts[pieces.piece_of_face[f]].is_closed = false;
            continue;
        }
        PieceEdges& count = counts[pieces.piece_of_face[edge.face[0]]];
        const bool disagree = faces_disagree(mesh, edge);
        count.disagreeing += disagree;
        count.still_disagree += disagree != (pieces.is_turned[edge.face[0]] != pieces.is_turned[edge.face[1]]);
    }
    return counts;
}

/// Takes back the walk in a piece if it did not help, and keeps the orientation of most of the piece's area.
/// Returns the number of turned faces.
std::size_t settle_piece(const TriangleMesh& mesh, const PieceEdges& edges, std::size_t piece, SurfacePieces& pieces) {
    if (edges.disagreeing == 0 || (edges.still_disagree > 0 && edges.still_disagree >= edges.disagreeing)) {
        for (const std::uint32_t f : pieces.faces_of(piece)) pieces.is_turned[f] = false;
        return 0;
    }
    double kept = 0, turned = 0;
    for (const std::uint32_t f : pieces.faces_of(piece))
        (pieces.is_turned[f] ? turned : kept) += doubled_area_vector(mesh, mesh.faces[f]).norm();
    if (turned > kept) pieces.turn(piece);
    return static_cast<std::size_t>(
        std::ranges::count_if(pieces.faces_of(piece), [&](std::uint32_t f) { return pieces.is_turned[f]; }));
}

/// Integrals over a piece, in double precision.
struct PieceShape {
    double area = 0;
    double volume = 0;                  ///< signed, of the cones from the area centroid
    Vec3d area_vector = Vec3d::Zero();  ///< of its faces; zero for a closed piece
    double diagonal = 0;                ///< of its bounding box
};

PieceShape shape_of_piece(const TriangleMesh& mesh, const SurfacePieces& pieces, std::size_t piece) {
    PieceShape shape;
    const double infinity = std::numeric_limits<double>::infinity();
    BoundingBox box{Vec3d::Constant(infinity), Vec3d::Constant(-infinity)};
    // Positions relative to a vertex, so that pieces far from the origin lose no digits.
    const Vec3d origin = mesh.vertices[mesh.faces[pieces.faces_of(piece)[0]][0]].cast<double>();
    Vec3d moment = Vec3d::Zero();
    for (const std::uint32_t f : pieces.faces_of(piece)) {
        Vec3d area = 0.5 * doubled_area_vector(mesh, mesh.faces[f]);
        if (pieces.is_turned[f]) area = -area;
        Vec3d center = Vec3d::Zero();
        for (const std::uint32_t v : mesh.faces[f]) {
            const Vec3d p = mesh.vertices[v].cast<double>() - origin;
            box.low = box.low.cwiseMin(p);
            box.high = box.high.cwiseMax(p);
            center += p / 3;
        }
        shape.area += area.norm();
        shape.area_vector += area;
        shape.volume += area.dot(center) / 3;
        moment += area.norm() * center;
    }
    if (shape.area > 0) shape.volume -= shape.area_vector.dot(moment / shape.area) / 3;
    shape.diagonal = box.diagonal();
    return shape;
}

/// Returns 1 if a piece faces outward, -1 if inward, 0 if it cannot be told.
int facing_of_piece(const PieceShape& shape, bool is_closed) {
    constexpr double k_rounding = 1e-12, k_rounding_of_open = 1e-6;
    // The cones over the holes, from the centroid, hold no more than the first term of an open piece.
    const double undecided =
        is_closed ? k_rounding * std::pow(shape.area, 1.5)
                  : shape.area_vector.norm() * shape.diagonal / 3 + k_rounding_of_open * std::pow(shape.diagonal, 3);
    if (!(std::abs(shape.volume) > undecided)) return 0;
    return shape.volume > 0 ? 1 : -1;
}

/// Lets cavities face into their piece: see orient_faces. Returns the sign that the volume of each piece is to have;
/// `facing` has the sign that it has.
std::vector<int> wanted_facing(const TriangleMesh& mesh, const SurfacePieces& pieces,
                               const std::vector<PieceEdges>& edges, const std::vector<int>& facing) {
    std::vector<int> closed = facing, wanted(facing.size());
    for (std::size_t p = 0; p < facing.size(); ++p)
        if (!edges[p].is_closed) closed[p] = 0;
    for (std::size_t p = 0; p < facing.size(); ++p) wanted[p] = facing[p] != 0;
    if (std::ranges::count(closed, -1) == 0 || std::ranges::count(closed, 0) + 1 >= std::ssize(closed)) return wanted;

    const std::vector<std::uint32_t> outer = enclosing_pieces(mesh, pieces.piece_of_face, closed);
    // Outer pieces first: those around a piece are fewer than those around anything inside of it.
    std::vector<std::pair<std::size_t, std::size_t>> by_depth;
    for (std::size_t p = 0; p < facing.size(); ++p) {
        std::size_t depth = 0;
        for (std::uint32_t q = outer[p]; q != k_invalid_index && depth < facing.size(); q = outer[q]) ++depth;
        if (depth > 0) by_depth.emplace_back(depth, p);
    }
    std::ranges::sort(by_depth);
    for (const auto& [depth, p] : by_depth)
        if (wanted[outer[p]] == closed[outer[p]] && closed[p] != closed[outer[p]]) wanted[p] = closed[p];
    return wanted;
}

/// Finds what each piece faces. Pieces that cannot be judged alone take part in a surface that is closed across edges
/// of more than two faces, and inside out as a whole.
std::vector<int> facing_of_pieces(const TriangleMesh& mesh, const Topology& topology, const SurfacePieces& pieces,
                                  const std::vector<PieceEdges>& edges) {
    std::vector<int> facing(pieces.count());
    bool is_unsure = false;
    for (std::size_t p = 0; p < pieces.count(); ++p) {
        if (edges[p].still_disagree > 0) continue;
        facing[p] = facing_of_piece(shape_of_piece(mesh, pieces, p), edges[p].is_closed);
        is_unsure |= facing[p] == 0 && !edges[p].is_closed;
    }
    if (is_unsure && std::ranges::none_of(topology.edges, &Edge::is_boundary) && validate_mesh(mesh).inside_out)
        for (std::size_t p = 0; p < pieces.count(); ++p)
            if (facing[p] == 0) facing[p] = -1;
    return facing;
}

}  // namespace

OrientationChange orient_faces(TriangleMesh& mesh) {
    const Topology topology = build_topology(mesh);
    SurfacePieces pieces = walk_pieces(mesh, topology);
    const std::vector<PieceEdges> edges = count_piece_edges(mesh, topology, pieces);
    OrientationChange change{.pieces = pieces.count()};
    for (std::size_t p = 0; p < pieces.count(); ++p) change.turned_faces += settle_piece(mesh, edges[p], p, pieces);
    const std::vector<int> facing = facing_of_pieces(mesh, topology, pieces, edges);
    const std::vector<int> wanted = wanted_facing(mesh, pieces, edges, facing);
    for (std::size_t p = 0; p < pieces.count(); ++p) {
        if (facing[p] == wanted[p]) continue;
        pieces.turn(p);
        ++change.turned_pieces;
    }
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        if (pieces.is_turned[f]) std::swap(mesh.faces[f][1], mesh.faces[f][2]);
    return change;
}

}  // namespace exemplar
