#include "host/mesh/editing/remove_flat_faces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <queue>
#include <unordered_map>
#include <utility>
#include <vector>

#include "host/mesh/editing/area_vector.h"

namespace exemplar {
namespace {

/// Returns the longest side of a face (from this corner to the next) if the face has no area. Sides of equal length
/// are told apart by their vertices, so that the order of corners does not matter.
std::optional<std::size_t> longest_side_if_flat(const TriangleMesh& mesh, const Face& face) {
    constexpr double k_roundings = 4 * 0x1p-23, k_max_slope = 1.0 / 1024;
    std::size_t longest = 0;
    double length = -1, coordinate = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 &p = mesh.vertices[face[i]], &q = mesh.vertices[face[(i + 1) % 3]];
        const double side = (q.cast<double>() - p.cast<double>()).norm();
        coordinate = std::max(coordinate, static_cast<double>(p.cwiseAbs().maxCoeff()));
        if (side < length || (side == length && face[(i + 2) % 3] < face[(longest + 2) % 3])) continue;
        longest = i;
        length = side;
    }
    const double height = doubled_area_vector(mesh, face).norm() / length;
    if (!(height <= std::min(k_roundings * coordinate, k_max_slope * length))) return std::nullopt;
    return longest;
}

/// Removes flat faces one after the other, those with the longest sides first: a flat face across such a side is then
/// cut into shorter ones, so that rows and heaps of flat faces come to an end.
class FlatFaceRemoval {
  public:
    explicit FlatFaceRemoval(TriangleMesh& mesh) : mesh_(mesh) {}

    /// Returns the number of flat faces that were removed.
    std::size_t run() {
        for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) enqueue_if_flat(f);
        const std::size_t found = flat_.size();
        if (found == 0 || found == mesh_.face_count()) return 0;
        prepare();
        while (!flat_.empty()) {
            const FlatFace flat = flat_.top();
            flat_.pop();
            if (is_removed_[flat.face]) continue;
            remove(flat.face);
            split_across(flat);
        }
        apply();
        return found;
    }

  private:
    struct FlatFace {
        double length;  ///< of its longest side
        Face corners;   ///< in increasing order: ties do not depend on the order of faces
        std::uint32_t face;
        std::size_t side;
        bool operator<(const FlatFace& other) const {
            return length != other.length ? length < other.length : corners > other.corners;
        }
    };
    static constexpr std::size_t k_splits_per_flat_face = 32;  // bounds the work on heaps of flat faces
    static constexpr std::size_t k_max_faces_across = 3;       // more are a fan that splitting would multiply

    static std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
        return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
    }

    void enqueue_if_flat(std::uint32_t f) {
        Face corners = mesh_.faces[f];
        const auto side = longest_side_if_flat(mesh_, corners);
        if (!side) return;
        const Vec3 &a = mesh_.vertices[corners[*side]], &b = mesh_.vertices[corners[(*side + 1) % 3]];
        std::ranges::sort(corners);
        flat_.push({(b.cast<double>() - a.cast<double>()).norm(), corners, f, *side});
    }

    void prepare() {
        splits_left_ = k_splits_per_flat_face * flat_.size();
        is_removed_.assign(mesh_.face_count(), false);
        whole_.resize(mesh_.face_count());
        std::iota(whole_.begin(), whole_.end(), 0u);
        if (mesh_.source_face.empty()) mesh_.source_face = whole_;
        faces_at_edge_.reserve(3 * mesh_.face_count());
        for (std::uint32_t f = 0; f < mesh_.face_count(); ++f) add_sides(f);
    }

    void add_sides(std::uint32_t f) {
        const auto& [a, b, c] = mesh_.faces[f];
        for (const std::uint64_t key : {key_of(a, b), key_of(b, c), key_of(c, a)}) faces_at_edge_.emplace(key, f);
    }

    void remove(std::uint32_t f) {
        is_removed_[f] = true;
        const auto& [a, b, c] = mesh_.faces[f];
        for (const std::uint64_t key : {key_of(a, b), key_of(b, c), key_of(c, a)}) {
            auto [it, end] = faces_at_edge_.equal_range(key);
            while (it != end && it->second != f) ++it;
            if (it != end) faces_at_edge_.erase(it);
        }
    }

    /// Splits the faces across the longest side of a removed face at its third corner.
    void split_across(const FlatFace& flat) {
        const Face face = mesh_.faces[flat.face];
        const std::uint32_t a = face[flat.side], b = face[(flat.side + 1) % 3], c = face[(flat.side + 2) % 3];
        std::vector<std::uint32_t> across;
        const auto [begin, end] = faces_at_edge_.equal_range(key_of(a, b));
        for (auto it = begin; it != end; ++it) across.push_back(it->second);
        if (across.size() > k_max_faces_across || across.size() > splits_left_) return;
        for (const std::uint32_t f : across)
            for (const std::uint32_t d : mesh_.faces[f])
                if (d == c || (d != a && d != b && faces_at_edge_.contains(key_of(c, d)))) return;
        splits_left_ -= across.size();
        std::ranges::sort(across);
        for (const std::uint32_t f : across) split(f, a, b, c);
    }

    /// Replaces face f by two: in one of them vertex c takes the place of a, in the other that of b.
    void split(std::uint32_t f, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        remove(f);
        for (const std::uint32_t replaced : {b, a}) {
            Face half = mesh_.faces[f];
            std::ranges::replace(half, replaced, c);
            const auto added = static_cast<std::uint32_t>(mesh_.face_count());
            mesh_.faces.push_back(half);
            mesh_.source_face.push_back(mesh_.source_face[f]);
            whole_.push_back(whole_[f]);
            is_removed_.push_back(false);
            add_sides(added);
            enqueue_if_flat(added);
        }
    }

    /// Leaves the removed faces out, and puts halves at the place of their whole.
    void apply() {
        std::vector<std::uint32_t> kept;
        for (std::uint32_t f = 0; f < mesh_.face_count(); ++f)
            if (!is_removed_[f]) kept.push_back(f);
        std::ranges::stable_sort(kept, {}, [&](std::uint32_t f) { return whole_[f]; });
        std::vector<Face> faces;
        std::vector<std::uint32_t> source_face;
        for (const std::uint32_t f : kept) {
            faces.push_back(mesh_.faces[f]);
            source_face.push_back(mesh_.source_face[f]);
        }
        mesh_.faces = std::move(faces);
        mesh_.source_face = std::move(source_face);
    }

    TriangleMesh& mesh_;
    std::priority_queue<FlatFace> flat_;
    std::unordered_multimap<std::uint64_t, std::uint32_t> faces_at_edge_;
    std::vector<bool> is_removed_;
    std::vector<std::uint32_t> whole_;  ///< per face, the face of the given mesh that it is or was cut from
    std::size_t splits_left_ = 0;
};

}  // namespace

std::size_t remove_flat_faces(TriangleMesh& mesh) {
    return FlatFaceRemoval(mesh).run();
}

}  // namespace exemplar
