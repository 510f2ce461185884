#include "host/mesh/queries/geodesics.h"

#include <algorithm>
#include <limits>

#include "host/core/parallel.h"

namespace exemplar {

namespace {

constexpr float k_infinity = std::numeric_limits<float>::infinity();

/// Relaxes arcs, never beyond `radius`, until the queue is empty; `distance` must hold the tentative distances.
/// Calls settle(face, distance) for each face whose distance has become final; ends early, with entries left in the
/// queue, when that returns false.
template <typename Settle>
void run_dijkstra(const DualGraph& graph, DistanceQueue& queue, float* distance, float radius, Settle&& settle) {
    const std::uint32_t* begin = graph.begin.data();
    const DualGraph::Arc* arcs = graph.arcs.data();
    while (!queue.empty()) {
        const auto [d, face] = queue.pop();
        if (d > distance[face]) continue;  // a shorter path was found since
        if (!settle(face, d)) return;
        for (std::uint32_t a = begin[face]; a != begin[face + 1]; ++a) {
            const auto [neighbor, length] = arcs[a];
            const float candidate = d + length;
            if (candidate < distance[neighbor] && candidate <= radius) {
                distance[neighbor] = candidate;
                queue.push(candidate, neighbor);
            }
        }
    }
}

}  // namespace

DualGraph build_dual_graph(const TriangleMesh& mesh, const Topology& topology) {
    const std::vector<Vec3> centers = face_centers(mesh);
    std::vector<float> length(topology.edges.size());
    for (std::size_t e = 0; e < length.size(); ++e) {
        const Edge& edge = topology.edges[e];
        if (edge.is_boundary()) continue;
        const Vec3 midpoint = (mesh.vertices[edge.vertex[0]] + mesh.vertices[edge.vertex[1]]) * 0.5f;
        length[e] = (centers[edge.face[0]] - midpoint).norm() + (centers[edge.face[1]] - midpoint).norm();
    }
    DualGraph graph;
    graph.begin.reserve(mesh.face_count() + 1);
    graph.begin.push_back(0);
    graph.arcs.reserve(topology.face_edges.size());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        for (std::uint32_t e : topology.edges_of_face(f)) {
            const Edge& edge = topology.edges[e];
            if (!edge.is_boundary()) graph.arcs.push_back({edge.face[edge.face[0] == f ? 1 : 0], length[e]});
        }
        graph.begin.push_back(static_cast<std::uint32_t>(graph.arcs.size()));
    }
    return graph;
}

GeodesicSearch::GeodesicSearch(const DualGraph& graph) : graph_(&graph), distance_(graph.face_count(), k_infinity) {}

std::span<const GeodesicSearch::Reached> GeodesicSearch::within(std::uint32_t source, float radius,
                                                                std::size_t max_faces) {
    reached_.clear();
    complete_distance_ = k_infinity;
    if (!(radius >= 0)) return reached_;
    distance_[source] = 0;
    queue_.push(0, source);
    run_dijkstra(*graph_, queue_, distance_.data(), radius, [&](std::uint32_t face, float distance) {
        if (reached_.size() == max_faces) {
            complete_distance_ = distance_[face];
            distance_[face] = k_infinity;
            return false;
        }
        reached_.push_back({face, distance});
        return true;
    });
    leave_out_queued();
    // Every other face with a tentative distance was settled, so `reached_` holds the rest of the faces touched.
    for (const Reached& reached : reached_) distance_[reached.face] = k_infinity;
    return reached_;
}

/// Empties the queue after a search that ended early.
void GeodesicSearch::leave_out_queued() {
    while (!queue_.empty()) distance_[queue_.pop().face] = k_infinity;
}

void GeodesicSearch::distances(std::uint32_t source, std::span<float> out) {
    std::ranges::fill(out, k_infinity);
    out[source] = 0;
    queue_.push(0, source);
    run_dijkstra(*graph_, queue_, out.data(), k_infinity, [](std::uint32_t, float) { return true; });
}

std::vector<float> distances_from_sources(const DualGraph& graph, std::span<const std::uint32_t> sources) {
    const std::size_t faces = graph.face_count();
    std::vector<float> distances(sources.size() * faces);
    parallel_ranges(sources.size(), 4, [&](std::size_t begin, std::size_t end) {
        GeodesicSearch search(graph);
        for (std::size_t i = begin; i != end; ++i)
            search.distances(sources[i], std::span(distances).subspan(i * faces, faces));
    });
    return distances;
}

namespace {

struct Components {
    std::vector<float> area;  ///< per face, of the component it belongs to
    std::size_t count = 0;
};

Components find_components(const DualGraph& graph, const std::vector<float>& areas) {
    const std::size_t faces = graph.face_count();
    Components result{std::vector<float>(faces)};
    std::vector<bool> seen(faces);
    std::vector<std::uint32_t> members;
    for (std::uint32_t first = 0; first < faces; ++first) {
        if (seen[first]) continue;
        ++result.count;
        members.assign(1, first);
        seen[first] = true;
        double sum = 0;
        for (std::size_t i = 0; i < members.size(); ++i) {
            sum += static_cast<double>(areas[members[i]]);
            for (std::uint32_t a = graph.begin[members[i]]; a != graph.begin[members[i] + 1]; ++a) {
                const std::uint32_t neighbor = graph.arcs[a].face;
                if (!seen[neighbor]) members.push_back(neighbor);
                seen[neighbor] = true;
            }
        }
        for (std::uint32_t f : members) result.area[f] = static_cast<float>(sum);
    }
    return result;
}

/// Returns the rank of each face among equally distant faces: large components first, then far from the area
/// centroid, then by coordinates, so that the index decides only between coinciding faces.
std::vector<std::uint32_t> sampling_ranks(const TriangleMesh& mesh, const std::vector<float>& component,
                                          const std::vector<float>& from_centroid) {
    const std::vector<Vec3> centers = face_centers(mesh);
    std::vector<std::uint32_t> order(mesh.face_count()), rank(mesh.face_count());
    for (std::uint32_t f = 0; f < order.size(); ++f) order[f] = f;
    std::sort(order.begin(), order.end(), [&](std::uint32_t f, std::uint32_t g) {
        if (component[f] != component[g]) return component[f] > component[g];
        if (from_centroid[f] != from_centroid[g]) return from_centroid[f] > from_centroid[g];
        for (int i = 0; i < 3; ++i)
            if (centers[f][i] != centers[g][i]) return centers[f][i] < centers[g][i];
        return f < g;
    });
    for (std::uint32_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
    return rank;
}

/// Farthest-point sampling that maintains the geodesic Voronoi cell of each face.
class FarthestPointSampler {
  public:
    FarthestPointSampler(const DualGraph& graph, const std::vector<std::uint32_t>& rank)
        : graph_(graph), rank_(rank), distance_(rank.size(), k_infinity), cell_(rank.size(), k_invalid_index) {
        for (std::uint32_t f = 0; f < rank.size(); ++f) farthest_.push_back(candidate(f));
        std::make_heap(farthest_.begin(), farthest_.end());
    }
    /// Makes `face` a sample and moves the faces that are nearer to it than to any earlier sample into its cell.
    void add(std::uint32_t face) {
        const auto sample = static_cast<std::uint32_t>(samples_.size());
        samples_.push_back(face);
        distance_[face] = 0;
        queue_.push(0, face);
        run_dijkstra(graph_, queue_, distance_.data(), k_infinity, [&](std::uint32_t f, float) {
            cell_[f] = sample;
            return true;
        });
    }
    /// Returns the face farthest from all samples that is not a sample itself; there must be one.
    std::uint32_t take_farthest() {
        for (;;) {
            std::pop_heap(farthest_.begin(), farthest_.end());
            const Candidate top = farthest_.back();
            farthest_.pop_back();
            if (top.distance == distance_[top.face]) {
                if (top.distance > 0 || !is_sample(top.face)) return top.face;
                continue;
            }
            farthest_.push_back(candidate(top.face));  // distances only decrease, so correcting them late suffices
            std::push_heap(farthest_.begin(), farthest_.end());
        }
    }
    const std::vector<std::uint32_t>& samples() const { return samples_; }
    const std::vector<std::uint32_t>& cells() const { return cell_; }

  private:
    struct Candidate {
        float distance;
        std::uint32_t rank, face;
        bool operator<(const Candidate& other) const {
            return distance != other.distance ? distance < other.distance : rank > other.rank;
        }
    };
    Candidate candidate(std::uint32_t face) const { return {distance_[face], rank_[face], face}; }
    bool is_sample(std::uint32_t face) const { return std::ranges::find(samples_, face) != samples_.end(); }

    const DualGraph& graph_;
    const std::vector<std::uint32_t>& rank_;
    DistanceQueue queue_;
    std::vector<float> distance_;
    std::vector<std::uint32_t> cell_;
    std::vector<Candidate> farthest_;
    std::vector<std::uint32_t> samples_;
};

/// Returns one weight per sample, the summed area of the faces in its cell; weights sum to 1.
std::vector<float> cell_shares(const std::vector<std::uint32_t>& cell, std::vector<float> areas, std::size_t count) {
    if (std::ranges::all_of(areas, [](float a) { return a == 0; })) std::ranges::fill(areas, 1.0f);
    std::vector<double> sum(count);
    double total = 0;
    for (std::size_t f = 0; f < cell.size(); ++f) {
        if (cell[f] == k_invalid_index) continue;
        sum[cell[f]] += static_cast<double>(areas[f]);
        total += static_cast<double>(areas[f]);
    }
    std::vector<float> shares;
    shares.reserve(count);
    for (double s : sum) shares.push_back(static_cast<float>(s / total));
    return shares;
}

}  // namespace

FaceSamples sample_faces(const TriangleMesh& mesh, const DualGraph& graph, std::size_t count) {
    const std::size_t faces = mesh.face_count();
    const std::vector<float> areas = face_areas(mesh);
    if (count == 0 || faces == 0) return {};
    if (count >= faces) {
        std::vector<std::uint32_t> all(faces);
        for (std::uint32_t f = 0; f < faces; ++f) all[f] = f;
        return {all, cell_shares(all, areas, faces)};
    }
    const Vec3 centroid = area_centroid(mesh);
    std::vector<float> from_centroid;
    for (const Vec3& center : face_centers(mesh)) from_centroid.push_back((center - centroid).norm());
    const Components components = find_components(graph, areas);
    const std::vector<std::uint32_t> rank = sampling_ranks(mesh, components.area, from_centroid);

    // If not every component gets a sample, the largest must, or the sampled ones might have no area at all.
    const bool every_component = count >= components.count;
    std::uint32_t first = 0;
    for (std::uint32_t f = 1; f < faces; ++f) {
        const bool farther = every_component && from_centroid[f] > from_centroid[first];
        const bool level = !every_component || from_centroid[f] == from_centroid[first];
        if (farther || (level && rank[f] < rank[first])) first = f;
    }
    FarthestPointSampler sampler(graph, rank);
    sampler.add(first);
    while (sampler.samples().size() < count) sampler.add(sampler.take_farthest());
    return {sampler.samples(), cell_shares(sampler.cells(), areas, count)};
}

}  // namespace exemplar
