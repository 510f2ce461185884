#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "host/labeling/evaluation/cut_discrepancy.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Contingency table of two segmentations S1 and S2 of the same faces. Segment numbers are arbitrary.
struct SegmentOverlap {
    struct Cell {
        std::uint32_t first, second;  ///< segments of S1 and S2, renumbered from 0; cells are sorted, none is empty
        double count, area;           ///< of the faces in both segments
    };
    std::vector<Cell> cells;
    std::vector<double> first_count, second_count;  ///< faces per segment
    std::vector<double> first_area, second_area;    ///< area per segment
    double count = 0, area = 0;                     ///< of all faces
};
/// Computes the overlap. `areas`: one per face; if empty or all zero, faces count equally. Throws UsageError for
/// sizes that differ.
SegmentOverlap segment_overlap(std::span<const std::int32_t> first, std::span<const std::int32_t> second,
                               std::span<const float> areas = {});

/// Returns one minus the Rand index (Chen et al. 2009): the share of face pairs that are in the same segment in one
/// segmentation but not in the other, in [0, 1]. Faces count equally. Zero for fewer than two faces.
double rand_index_error(const SegmentOverlap& overlap);

/// Hamming distance (Chen et al. 2009) of a segmentation S1 from the ground truth S2. Each segment is matched with
/// the segment of the other segmentation that it shares most area with. With ||.|| the area and S the surface,
///
///     D(S1 => S2) = sum over segments i of S2 of || S2_i \ S1_best(i) ||
///     missing rate = D(S1 => S2) / ||S||,   false alarm rate = D(S2 => S1) / ||S||
///
/// both in [0, 1). Too many segments raise the missing rate, too few the false alarm rate.
struct HammingDistance {
    double missing_rate = 0, false_alarm_rate = 0;
    double mean() const { return (missing_rate + false_alarm_rate) / 2; }  ///< the Hamming distance
};
HammingDistance hamming_distance(const SegmentOverlap& overlap);

/// Consistency errors (Chen et al. 2009 after Martin et al. 2001), which ignore refinement. With R(S, f) the segment
/// of S that contains face f, a_f the area of f and ||S|| the area of the surface,
///
///     E(S1, S2, f) = || R(S1, f) \ R(S2, f) || / || R(S1, f) ||
///     global = min(sum of a_f E(S1, S2, f), sum of a_f E(S2, S1, f)) / ||S||
///     local = sum of a_f min(E(S1, S2, f), E(S2, S1, f)) / ||S||
///
/// Both are symmetric and in [0, 1), local <= global; both are 0 if one segmentation refines the other.
struct ConsistencyErrors {
    double global = 0, local = 0;
};
ConsistencyErrors consistency_errors(const SegmentOverlap& overlap);

/// All measures of Chen et al. 2009 of a segmentation against a reference: 0 if they are equal, NaN if unknown.
struct SegmentationErrors {
    double rand_index = std::numeric_limits<double>::quiet_NaN();
    double cut_discrepancy = std::numeric_limits<double>::quiet_NaN();  ///< see CutDiscrepancy
    double missing_rate = std::numeric_limits<double>::quiet_NaN();
    double false_alarm_rate = std::numeric_limits<double>::quiet_NaN();
    double hamming_distance = std::numeric_limits<double>::quiet_NaN();
    double global_consistency = std::numeric_limits<double>::quiet_NaN();
    double local_consistency = std::numeric_limits<double>::quiet_NaN();
};

/// Compares segmentations of one mesh (one segment per face), in O(F log F) each.
class SegmentationMetrics {
  public:
    explicit SegmentationMetrics(const TriangleMesh& mesh) : areas_(face_areas(mesh)), cuts_(mesh) {}

    /// Compares two segmentations. Throws UsageError unless both have one segment per face.
    SegmentationErrors compare(std::span<const std::int32_t> segments, std::span<const std::int32_t> reference) const;
    /// Returns the mean of each measure over the references, computed in parallel; for the cut discrepancy, over
    /// those for which it is defined. All NaN without references.
    SegmentationErrors mean_errors(std::span<const std::int32_t> segments,
                                   std::span<const std::vector<std::int32_t>> references) const;

  private:
    SegmentationErrors compare(std::span<const std::int32_t> segments, const SegmentCuts& cuts,
                               std::span<const std::int32_t> reference) const;

    std::vector<float> areas_;
    CutDiscrepancy cuts_;
};

}  // namespace exemplar
