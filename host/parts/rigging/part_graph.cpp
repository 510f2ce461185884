#include "host/parts/rigging/part_graph.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "host/core/disjoint_sets.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/parts/rigging/joined_parts.h"
#include "host/parts/rigging/part_boundaries.h"
#include "host/parts/rigging/part_contacts.h"

namespace exemplar {
namespace {

/// Connected faces of equal label, numbered in order of their first face.
struct LabelPieces {
    std::vector<std::uint32_t> piece_of_face;
    std::vector<std::int32_t> label;
    std::vector<double> area;
};

/// Numbers sets in order of their first item.
std::vector<std::uint32_t> numbered_sets(DisjointSets& sets, std::size_t count) {
    std::vector<std::uint32_t> number(count, k_invalid_index), result(count);
    std::uint32_t next = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t root = sets.find(i);
        if (number[root] == k_invalid_index) number[root] = next++;
        result[i] = number[root];
    }
    return result;
}

LabelPieces pieces_of(const Topology& topology, const std::vector<std::int32_t>& label,
                      const std::vector<float>& area) {
    DisjointSets sets(label.size());
    for (const Edge& edge : topology.edges)
        if (!edge.is_boundary() && label[edge.face[0]] == label[edge.face[1]]) sets.join(edge.face[0], edge.face[1]);
    LabelPieces pieces{numbered_sets(sets, label.size()), {}, {}};
    for (std::size_t f = 0; f < label.size(); ++f) {
        if (pieces.piece_of_face[f] == pieces.label.size()) {
            pieces.label.push_back(label[f]);
            pieces.area.push_back(0);
        }
        pieces.area[pieces.piece_of_face[f]] += area[f];
    }
    return pieces;
}

std::vector<bool> slivers_of(const LabelPieces& pieces, double share) {
    std::map<std::int32_t, double> largest;
    for (std::size_t i = 0; i < pieces.label.size(); ++i)
        largest[pieces.label[i]] = std::max(largest[pieces.label[i]], pieces.area[i]);
    std::vector<bool> sliver(pieces.label.size());
    for (std::size_t i = 0; i < sliver.size(); ++i)
        sliver[i] = pieces.label[i] < 0 || pieces.area[i] < share * largest[pieces.label[i]];
    return sliver;
}

/// Returns for each piece its neighbor with the longest common boundary; k_invalid_index without a neighbor.
std::vector<std::uint32_t> closest_neighbors(const TriangleMesh& mesh, const Topology& topology,
                                             const LabelPieces& pieces) {
    std::vector<std::uint32_t> best(pieces.label.size(), k_invalid_index);
    std::vector<double> length(best.size(), -1);
    for (const auto& [pair, common] : common_lengths(mesh, topology, pieces.piece_of_face))
        for (const auto& [own, other] : {pair, std::pair(pair.second, pair.first)})
            if (common > length[own]) {
                length[own] = common;
                best[own] = other;
            }
    return best;
}

/// Gives slivers the label of their neighbor: all whose neighbor is none, else the smallest one. Returns whether any
/// label changed.
bool merge_some_slivers(const TriangleMesh& mesh, const Topology& topology, const LabelPieces& pieces, double share,
                        std::vector<std::int32_t>& label) {
    const std::vector<bool> sliver = slivers_of(pieces, share);
    const std::vector<std::uint32_t> neighbor = closest_neighbors(mesh, topology, pieces);
    std::vector<bool> merged(sliver.size(), false);
    std::uint32_t smallest = k_invalid_index;
    bool any = false;
    for (std::uint32_t i = 0; i < sliver.size(); ++i) {
        if (!sliver[i] || neighbor[i] == k_invalid_index) continue;
        if (smallest == k_invalid_index || pieces.area[i] < pieces.area[smallest]) smallest = i;
        merged[i] = !sliver[neighbor[i]];
        any = any || merged[i];
    }
    if (smallest == k_invalid_index) return false;
    if (!any) merged[smallest] = true;
    for (std::size_t f = 0; f < label.size(); ++f) {
        const std::uint32_t piece = pieces.piece_of_face[f];
        if (merged[piece]) label[f] = pieces.label[neighbor[piece]];
    }
    return true;
}

/// Merges pieces of small components into those that they hang on. Returns the part of each piece; `contacts` keeps
/// those between parts.
std::vector<std::uint32_t> attach_components(const LabelPieces& pieces, double share,
                                             std::vector<PieceContact>& contacts) {
    const std::vector<bool> sliver = slivers_of(pieces, share);
    DisjointSets sets(pieces.label.size());
    std::erase_if(contacts, [&](const PieceContact& contact) {
        const std::uint32_t own = pieces.piece_of_face[contact.face], other = pieces.piece_of_face[contact.other_face];
        if (!sliver[own] && pieces.label[own] != pieces.label[other]) return false;
        sets.join(own, other);
        return true;
    });
    return numbered_sets(sets, pieces.label.size());
}

/// Returns the label of each part: that of its largest piece.
std::vector<std::int32_t> labels_of_parts(const LabelPieces& pieces, const std::vector<std::uint32_t>& part_of_piece) {
    std::vector<std::int32_t> label(1 + *std::max_element(part_of_piece.begin(), part_of_piece.end()));
    std::vector<double> largest(label.size(), -1);
    for (std::size_t i = 0; i < part_of_piece.size(); ++i)
        if (pieces.area[i] > largest[part_of_piece[i]]) {
            largest[part_of_piece[i]] = pieces.area[i];
            label[part_of_piece[i]] = pieces.label[i];
        }
    return label;
}

std::vector<Part> describe_parts(const TriangleMesh& mesh, const std::vector<std::int32_t>& label_of_part,
                                 const std::vector<std::uint32_t>& part_of_face, const std::vector<float>& area) {
    std::vector<Part> parts(label_of_part.size());
    const std::vector<Vec3> center = face_centers(mesh);
    std::vector<Vec3d> sum(parts.size(), Vec3d::Zero()), plain(parts.size(), Vec3d::Zero());
    std::vector<double> count(parts.size(), 0);
    for (std::size_t f = 0; f < part_of_face.size(); ++f) {
        const std::uint32_t p = part_of_face[f];
        parts[p].area += area[f];
        sum[p] += area[f] * center[f].cast<double>();
        plain[p] += center[f].cast<double>();
        count[p] += 1;
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
        parts[p].label = label_of_part[p];
        parts[p].center = (parts[p].area > 0 ? sum[p] / parts[p].area : plain[p] / count[p]).cast<float>();
    }
    return parts;
}

std::vector<PartBoundary> contacts_of_parts(const std::vector<PieceContact>& contacts,
                                            const std::vector<std::uint32_t>& part_of_face) {
    std::vector<PartBoundary> result;
    result.reserve(contacts.size());
    for (const PieceContact& contact : contacts) {
        const std::uint32_t a = part_of_face[contact.face], b = part_of_face[contact.other_face];
        if (a != b) result.push_back({{std::min(a, b), std::max(a, b)}, 0, 0, contact.point});
    }
    return result;
}

}  // namespace

PartGraph build_part_graph(const TriangleMesh& mesh, const Topology& topology, std::span<const std::int32_t> label,
                           double sliver_share) {
    if (label.size() != mesh.face_count() || label.empty())
        throw UsageError("parts need a mesh with faces and one label per face");
    std::vector<std::int32_t> cleaned(label.begin(), label.end());
    const std::vector<float> area = face_areas(mesh);
    LabelPieces pieces = pieces_of(topology, cleaned, area);
    while (merge_some_slivers(mesh, topology, pieces, sliver_share, cleaned)) {
        check_interrupt();
        pieces = pieces_of(topology, cleaned, area);
    }
    std::vector<PieceContact> contacts = component_contacts(mesh, topology);
    const std::vector<std::uint32_t> part_of_piece = attach_components(pieces, sliver_share, contacts);
    PartGraph graph;
    graph.part_of_face.reserve(label.size());
    for (const std::uint32_t piece : pieces.piece_of_face) graph.part_of_face.push_back(part_of_piece[piece]);
    std::vector<std::int32_t> label_of_part = labels_of_parts(pieces, part_of_piece);
    divide_joined_parts(mesh, topology, label_of_part, graph.part_of_face);
    graph.parts = describe_parts(mesh, label_of_part, graph.part_of_face, area);
    graph.boundaries =
        part_boundaries(mesh, topology, graph.part_of_face, contacts_of_parts(contacts, graph.part_of_face));
    return graph;
}

}  // namespace exemplar
