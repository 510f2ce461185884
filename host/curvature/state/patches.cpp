#include "host/curvature/state/patches.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <span>
#include <utility>

#include "host/mesh/topology.h"

namespace exemplar {

namespace {

constexpr float k_far = std::numeric_limits<float>::infinity();
/// A piece of at most this many patches is taken as nearly flat and is cut across its principal axis. Distances over
/// edges would cut a square along a diagonal.
constexpr std::size_t k_flat = 8;

class PatchCutter {
  public:
    PatchCutter(const TriangleMesh& mesh, std::size_t most)
        : most_(most),
          neighbors_(mesh.vertex_count()),
          vertices_(mesh.vertices),
          part_(mesh.vertex_count(), 0),
          distance_(mesh.vertex_count(), k_far),
          patch_(mesh.vertex_count(), 0) {
        for (const Edge& edge : build_topology(mesh).edges) {
            const auto [a, b] = edge.vertex;
            const float length = (mesh.vertices[a] - mesh.vertices[b]).norm();
            neighbors_[a].push_back({b, length});
            neighbors_[b].push_back({a, length});
        }
    }

    std::vector<std::uint32_t> cut() {
        std::vector<std::uint32_t> all(patch_.size());
        std::iota(all.begin(), all.end(), 0u);
        cut(all);
        return patch_;
    }

  private:
    struct Neighbor {
        std::uint32_t vertex;
        float length;
    };
    using Vertices = std::span<std::uint32_t>;
    using Place = std::pair<float, std::uint32_t>;  ///< position along the length of the piece, vertex

    std::size_t patches_of(std::size_t vertices) const { return (vertices + most_ - 1) / most_; }

    void cut(Vertices part) {
        if (part.size() <= most_) {
            for (const std::uint32_t v : part) patch_[v] = patches_;
            ++patches_;
            return;
        }
        ++parts_;
        for (const std::uint32_t v : part) part_[v] = parts_;
        const std::vector<std::size_t> piece_ends = lay_out(part);
        const std::size_t middle = place_of_cut(part.size(), piece_ends);
        cut(part.first(middle));
        cut(part.subspan(middle));
    }

    /// Returns the cut between two pieces that is nearest to the middle and takes no more patches than necessary, or
    /// a cut that fills all patches of the first half if there is none.
    std::size_t place_of_cut(std::size_t count, const std::vector<std::size_t>& piece_ends) const {
        const std::size_t needed = patches_of(count), full = needed / 2 * most_;
        const auto from_middle = [&](std::size_t at) { return at > count / 2 ? at - count / 2 : count / 2 - at; };
        std::size_t best = 0;  // none
        for (const std::size_t at : piece_ends)
            if (patches_of(at) + patches_of(count - at) == needed && from_middle(at) < from_middle(best)) best = at;
        return best > 0 ? best : full;
    }

    /// Orders a part piece by piece, each along its length. Returns where the pieces end, except the last.
    std::vector<std::size_t> lay_out(Vertices part) {
        std::vector<std::size_t> ends;
        for (const std::uint32_t v : part) distance_[v] = k_far;
        std::vector<std::uint32_t> result;
        result.reserve(part.size());
        for (const std::uint32_t seed : part) {
            if (distance_[seed] < k_far) continue;
            if (!result.empty()) ends.push_back(result.size());
            const std::vector<std::uint32_t> piece = along_length(seed);
            result.insert(result.end(), piece.begin(), piece.end());
        }
        std::copy(result.begin(), result.end(), part.begin());
        return ends;
    }

    /// Returns the connected piece of the part that contains a vertex, ordered from one end to the other.
    std::vector<std::uint32_t> along_length(std::uint32_t seed) {
        std::vector<std::uint32_t> piece = measure(seed);
        std::vector<Place> places = piece.size() <= k_flat * most_ ? along_axis(piece) : over_edges(piece);
        std::sort(places.begin(), places.end());
        for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = places[i].second;
        return piece;
    }

    std::vector<Place> along_axis(const std::vector<std::uint32_t>& piece) const {
        Eigen::Matrix3Xf points(3, static_cast<Eigen::Index>(piece.size()));
        for (std::size_t i = 0; i < piece.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = vertices_[piece[i]];
        points.colwise() -= points.rowwise().mean().eval();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver(points * points.transpose());
        const Vec3 axis = solver.eigenvectors().col(2);
        std::vector<Place> places(piece.size());
        std::transform(piece.begin(), piece.end(), places.begin(),
                       [&](std::uint32_t v) { return Place(axis.dot(vertices_[v]), v); });
        return places;
    }

    /// Returns the distance to one end minus the distance to the other. `piece` is in the order measure() returns.
    std::vector<Place> over_edges(const std::vector<std::uint32_t>& piece) {
        std::vector<Place> places;
        const std::uint32_t first = piece.back();
        for (const std::uint32_t v : piece) distance_[v] = k_far;
        const std::uint32_t last = measure(first).back();
        for (const std::uint32_t v : piece) {
            places.emplace_back(distance_[v], v);
            distance_[v] = k_far;
        }
        measure(last);
        for (auto& [along, v] : places) along -= distance_[v];
        return places;
    }

    /// Computes distances from a vertex over the edges of its part. Returns the reached vertices, nearest first.
    std::vector<std::uint32_t> measure(std::uint32_t from) {
        std::vector<std::uint32_t> reached;
        std::priority_queue<Place, std::vector<Place>, std::greater<>> queue;
        const auto reach = [&](std::uint32_t v, float distance) {
            if (part_[v] != part_[from] || !(distance < distance_[v])) return;
            distance_[v] = distance;
            queue.emplace(distance, v);
        };
        reach(from, 0);
        while (!queue.empty()) {
            const auto [distance, v] = queue.top();
            queue.pop();
            if (distance > distance_[v]) continue;
            reached.push_back(v);
            for (const auto& [w, length] : neighbors_[v]) reach(w, distance + length);
        }
        return reached;
    }

    std::size_t most_;
    std::vector<std::vector<Neighbor>> neighbors_;
    const std::vector<Vec3>& vertices_;
    std::vector<std::uint32_t> part_;  // of each vertex
    std::vector<float> distance_;
    std::vector<std::uint32_t> patch_;
    std::uint32_t parts_ = 0, patches_ = 0;
};

}  // namespace

std::vector<std::uint32_t> surface_patches(const TriangleMesh& mesh, std::size_t vertices) {
    if (vertices == 0 || mesh.vertex_count() == 0) return std::vector<std::uint32_t>(mesh.vertex_count(), 0);
    return PatchCutter(mesh, vertices).cut();
}

}  // namespace exemplar
