#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/mesh/queries/distance_queue.h"
#include "host/mesh/topology.h"

namespace exemplar {

/// The dual graph of a mesh: a node per face, an arc to each neighbor across an edge whose length is
/// center -> edge midpoint -> center. Shortest paths on it approximate geodesic distances (thesis App. A.1i).
struct DualGraph {
    struct Arc {
        std::uint32_t face;
        float length;
    };
    std::vector<std::uint32_t> begin;  ///< F + 1 offsets into arcs
    std::vector<Arc> arcs;
    std::size_t face_count() const { return begin.size() - 1; }
};
DualGraph build_dual_graph(const TriangleMesh& mesh, const Topology& topology);

/// Reusable workspace for shortest paths from one face; not thread-safe: one per thread.
class GeodesicSearch {
  public:
    struct Reached {
        std::uint32_t face;
        float distance;
    };
    explicit GeodesicSearch(const DualGraph& graph);
    /// Returns the faces within `radius` of `source` (itself included), by increasing distance: all of them, or the
    /// first `max_faces` (at least 1) if there are more. The cost depends only on the faces returned. The span is valid
    /// until the next call.
    std::span<const Reached> within(std::uint32_t source, float radius, std::size_t max_faces = k_all_faces);
    /// Returns a distance below which the last call of `within` has left out no face: infinity if it returned all faces
    /// within its radius, else the distance of the nearest face that it left out.
    float complete_distance() const { return complete_distance_; }
    /// Computes the distance from `source` to every face; infinity in other components. out.size() == face count.
    void distances(std::uint32_t source, std::span<float> out);

    static constexpr std::size_t k_all_faces = std::numeric_limits<std::size_t>::max();

  private:
    void leave_out_queued();

    const DualGraph* graph_;
    DistanceQueue queue_;
    std::vector<float> distance_;  ///< infinity everywhere between calls
    std::vector<Reached> reached_;
    float complete_distance_ = std::numeric_limits<float>::infinity();
};

/// Returns the distances from each source to each face: sources x F, row-major, computed in parallel.
std::vector<float> distances_from_sources(const DualGraph& graph, std::span<const std::uint32_t> sources);

/// A subset of faces that represents the whole surface in sums over all faces.
struct FaceSamples {
    std::vector<std::uint32_t> face;  ///< S distinct faces
    std::vector<float> area_share;    ///< S; share of the surface nearest to each sample; sums to 1
};
/// Chooses farthest-point samples under geodesic distance, each weighted by the area of its geodesic Voronoi cell.
/// Starts at the face farthest from the area centroid, so the result does not depend on face order. Every component
/// gets a sample; with fewer samples than components only the largest do, and the others do not count for the
/// shares. A component without area has a share of 0. With count >= F every face is its own sample, in order, and
/// sums are exact. Faces count equally if all areas are zero.
FaceSamples sample_faces(const TriangleMesh& mesh, const DualGraph& graph, std::size_t count);

}  // namespace exemplar
