#include "host/parts/splitting/part_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "host/core/disjoint_sets.h"
#include "host/core/errors.h"
#include "host/mesh/queries/axes.h"
#include "host/mesh/topology.h"

namespace exemplar {
namespace {

/// A connected piece of one label.
struct Piece {
    std::int32_t label;
    double area = 0;
    Vec3d center = Vec3d::Zero();
    std::string name = {};
};

std::vector<std::int32_t> label_per_triangle(const TriangleMesh& mesh, const FaceLabels& labels) {
    const std::size_t count = mesh.source_face.empty() ? mesh.face_count() : mesh.source_face_count;
    if (labels.label.size() != count)
        throw UsageError(fmt::format("{} labels were given for a mesh of {} faces", labels.label.size(), count));
    std::vector<std::int32_t> label(mesh.face_count());
    for (std::uint32_t f = 0; f < label.size(); ++f) {
        label[f] = labels.label[mesh.source_of(f)];
        if (label[f] < -1 || label[f] >= static_cast<std::int32_t>(labels.names.size()))
            throw UsageError(fmt::format("label {} of {}", label[f], labels.names.size()));
    }
    return label;
}

std::string name_of_label(const FaceLabels& labels, std::int32_t label) {
    return label < 0 ? "unlabeled" : labels.names[static_cast<std::size_t>(label)];
}

/// Returns `name`, with a number behind it if it is taken already.
std::string unused_name(const std::string& name, std::set<std::string>& taken) {
    std::string found = name;
    for (int i = 2; !taken.insert(found).second; ++i) found = fmt::format("{}_{}", name, i);
    return found;
}

/// Numbers the pieces in order of their first face; sums up their areas and centers.
std::vector<Piece> find_pieces(const TriangleMesh& mesh, const std::vector<std::int32_t>& label,
                               std::vector<std::uint32_t>& piece_of_face) {
    DisjointSets sets(mesh.face_count());
    for (const Edge& edge : build_topology(mesh).edges)
        if (!edge.is_boundary() && label[edge.face[0]] == label[edge.face[1]]) sets.join(edge.face[0], edge.face[1]);
    const std::vector<float> areas = face_areas(mesh);
    const std::vector<Vec3> centers = face_centers(mesh);
    std::vector<Piece> pieces;
    piece_of_face.resize(mesh.face_count());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const std::uint32_t first = sets.find(f);
        if (first == f) pieces.push_back({.label = label[f]});
        piece_of_face[f] = first == f ? static_cast<std::uint32_t>(pieces.size() - 1) : piece_of_face[first];
        Piece& piece = pieces[piece_of_face[f]];
        const double area = double{areas[f]} + 1e-30;
        piece.area += area;
        piece.center += area * centers[f].cast<double>();
    }
    for (Piece& piece : pieces) piece.center /= piece.area;
    return pieces;
}

/// A mirror plane, and which pieces it maps to each other.
class PieceMirror {
  public:
    PieceMirror(const SymmetryPlane& plane, double diagonal)
        : point_(plane.point.cast<double>()), normal_(plane.normal.cast<double>()), diagonal_(diagonal) {
        Eigen::Index axis = 0;
        normal_.cwiseAbs().maxCoeff(&axis);
        if (normal_[axis] < 0) normal_ = -normal_;
    }

    /// Returns the pairs among pieces of one label, the left one first; takes them out of `pieces`.
    std::vector<std::array<Piece*, 2>> take_pairs(std::vector<Piece*>& pieces) const {
        std::vector<std::array<Piece*, 2>> pairs;
        for (std::size_t i = 0; i < pieces.size(); ++i)
            for (std::size_t j = i + 1; j < pieces.size(); ++j) {
                if (!pieces[i] || !pieces[j] || !mirror_each_other(*pieces[i], *pieces[j])) continue;
                const bool first_is_left = side_of(*pieces[i]) > 0;
                pairs.push_back({pieces[first_is_left ? i : j], pieces[first_is_left ? j : i]});
                pieces[i] = pieces[j] = nullptr;
            }
        std::erase(pieces, nullptr);
        return pairs;
    }
    /// Returns how much the plane's normal is along x, as that of the left and right of a figure mostly is.
    double along_x() const { return std::abs(normal_.x()); }

  private:
    double side_of(const Piece& piece) const { return (piece.center - point_).dot(normal_); }
    bool mirror_each_other(const Piece& a, const Piece& b) const {
        const Vec3d mirrored = a.center - 2 * side_of(a) * normal_;
        return side_of(a) * side_of(b) < 0 && std::abs(side_of(a)) > 0.01 * diagonal_ &&
               (mirrored - b.center).norm() < 0.05 * diagonal_ &&
               std::min(a.area, b.area) > 0.75 * std::max(a.area, b.area);
    }

    Vec3d point_, normal_;
    double diagonal_;
};

/// The pieces of each label, largest first; those without a label come first.
std::vector<std::vector<Piece*>> pieces_by_label(std::vector<Piece>& pieces, std::size_t labels) {
    std::vector<std::vector<Piece*>> of_label(labels + 1);
    for (Piece& piece : pieces) of_label[static_cast<std::size_t>(piece.label + 1)].push_back(&piece);
    for (std::vector<Piece*>& list : of_label)
        std::ranges::stable_sort(list, std::greater<>(), [](const Piece* piece) { return piece->area; });
    return of_label;
}

void name_pairs(const std::string& label, const std::vector<std::array<Piece*, 2>>& pairs,
                std::set<std::string>& taken) {
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const std::string number = pairs.size() > 1 ? fmt::format("_{}", p + 1) : "";
        pairs[p][0]->name = unused_name(fmt::format("{}_left{}", label, number), taken);
        pairs[p][1]->name = unused_name(fmt::format("{}_right{}", label, number), taken);
    }
}

/// Returns the symmetry plane that maps most pieces to each other; none if no plane maps any.
std::optional<PieceMirror> best_mirror(const TriangleMesh& mesh, const std::vector<std::vector<Piece*>>& of_label) {
    constexpr float k_symmetric = 0.02F;
    std::optional<PieceMirror> best;
    double best_score = 1;
    for (const SymmetryPlane& plane : symmetry_planes(mesh)) {
        if (!(plane.error < k_symmetric)) continue;
        const PieceMirror mirror(plane, bounding_box(mesh).diagonal());
        double score = mirror.along_x();  // decides between equal numbers of pairs
        for (std::vector<Piece*> pieces : of_label) score += 2 * static_cast<double>(mirror.take_pairs(pieces).size());
        if (score > best_score) best_score = score, best = mirror;
    }
    return best;
}

}  // namespace

MeshParts parts_by_label(const TriangleMesh& mesh, const FaceLabels& labels) {
    const std::vector<std::int32_t> label = label_per_triangle(mesh, labels);
    const auto unlabeled = static_cast<std::int32_t>(labels.names.size());
    std::vector<bool> occurs(labels.names.size() + 1, false);
    for (const std::int32_t l : label) occurs[static_cast<std::size_t>(l < 0 ? unlabeled : l)] = true;
    MeshParts parts;
    std::set<std::string> taken;
    std::vector<std::uint32_t> part(occurs.size(), 0);
    for (std::size_t l = 0; l < occurs.size(); ++l) {
        if (!occurs[l]) continue;
        part[l] = static_cast<std::uint32_t>(parts.names.size());
        parts.labels.push_back(l < labels.names.size() ? static_cast<std::int32_t>(l) : -1);
        parts.names.push_back(unused_name(name_of_label(labels, parts.labels.back()), taken));
    }
    parts.part_of_face.reserve(label.size());
    for (const std::int32_t l : label)
        parts.part_of_face.push_back(part[static_cast<std::size_t>(l < 0 ? unlabeled : l)]);
    return parts;
}

MeshParts parts_by_piece(const TriangleMesh& mesh, const FaceLabels& labels) {
    MeshParts parts;
    std::vector<Piece> pieces = find_pieces(mesh, label_per_triangle(mesh, labels), parts.part_of_face);
    std::set<std::string> taken;
    std::vector<std::vector<Piece*>> of_label = pieces_by_label(pieces, labels.names.size());
    const bool is_divided = std::ranges::any_of(of_label, [](const auto& list) { return list.size() > 1; });
    const std::optional<PieceMirror> mirror = is_divided ? best_mirror(mesh, of_label) : std::nullopt;
    for (std::vector<Piece*>& list : of_label) {
        if (list.empty()) continue;
        const std::string name = name_of_label(labels, list.front()->label);
        const bool is_alone = list.size() == 1;
        if (mirror) name_pairs(name, mirror->take_pairs(list), taken);
        for (std::size_t i = 0; i < list.size(); ++i)
            list[i]->name = unused_name(is_alone ? name : fmt::format("{}_{}", name, i + 1), taken);
    }
    for (const Piece& piece : pieces) {
        parts.names.push_back(piece.name);
        parts.labels.push_back(piece.label);
    }
    return parts;
}

}  // namespace exemplar
