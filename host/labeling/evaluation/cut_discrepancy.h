#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// The cuts of a segmentation: the interior edges between faces of different segments.
struct SegmentCuts {
    std::vector<std::uint32_t> edge;  ///< indices into the interior edges
    std::vector<float> distance;      ///< of each node (the vertices, then the edge midpoints) to the nearest cut
};

/// Cut discrepancy of segmentations of one mesh (Chen, Golovinskiy, Funkhouser 2009): how far apart along the surface
/// their cuts lie. C(S) is the set of all points on the cuts of S, and d(p, C) the length of the shortest path on the
/// surface from p to C:
///
///     DCD(S1 => S2) = mean of d(p, C(S2)) over the points p of C(S1)
///     CD(S1, S2) = (DCD(S1 => S2) + DCD(S2 => S1)) / r,   r = mean distance of the surface's points from its centroid
///
/// It is symmetric, 0 for equal cuts, and does not change with scale. The mean over points is weighted by length.
/// Paths run straight across faces between vertices and edge midpoints, which overestimates distances by at most 4 %
/// on regular triangles. A point from which no cut of the other segmentation can be reached (on another component)
/// counts as r away.
class CutDiscrepancy {
  public:
    explicit CutDiscrepancy(const TriangleMesh& mesh);

    /// Returns the cuts of a segmentation: one segment per face, any numbers. Throws UsageError for another count.
    SegmentCuts cuts_of(std::span<const std::int32_t> segments) const;

    /// Returns CD >= 0 of two segmentations: 0 if neither has a cut, NaN (undefined) if only one has, or if the mesh
    /// is a single point.
    double between(const SegmentCuts& a, const SegmentCuts& b) const;

  private:
    struct CutEdge {
        std::uint32_t edge_node;
        std::uint32_t vertex[2];
        std::uint32_t face[2];
        float length;
    };
    struct Link {
        std::uint32_t node;
        float length;
    };
    std::vector<float> distances_to(const std::vector<std::uint32_t>& cuts) const;
    double mean_distance(const SegmentCuts& from, const SegmentCuts& to) const;

    std::vector<CutEdge> edges_;             ///< interior edges, which a cut can run along
    std::vector<std::uint32_t> link_begin_;  ///< compressed rows: nodes are the vertices, then the edge midpoints
    std::vector<Link> links_;
    std::size_t face_count_ = 0;
    double mean_radius_ = 0;
};

}  // namespace exemplar
