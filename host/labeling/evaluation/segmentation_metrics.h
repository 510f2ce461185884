#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "host/labeling/evaluation/cut_discrepancy.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// How two segmentations S1 and S2 of the same faces overlap: their contingency table. Segment numbers are arbitrary.
struct SegmentOverlap {
    struct Cell {
        std::uint32_t first, second;  ///< segments of S1 and S2, renumbered from 0; rising, without empty cells
        double count, area;           ///< of the faces that both hold
    };
    std::vector<Cell> cells;
    std::vector<double> first_count, second_count;  ///< faces per segment
    std::vector<double> first_area, second_area;    ///< area per segment
    double count = 0, area = 0;                     ///< of all faces
};
/// `areas`: one per face; none, or all zero, counts all faces as equal. Throws UsageError for sizes that differ.
SegmentOverlap segment_overlap(std::span<const std::int32_t> first, std::span<const std::int32_t> second,
                               std::span<const float> areas = {});

/// One minus the Rand index (Chen et al. 2009): the share of the pairs of faces that one segmentation puts
/// together and the other does not, in [0, 1]. Faces count equally. Zero for fewer than two faces.
double rand_index_error(const SegmentOverlap& overlap);

/// Hamming distance (Chen et al. 2009) of a segmentation S1 from the ground truth S2. Each segment of the one is
/// matched with the segment of the other that it shares most area with; with ||.|| the area and S the surface,
///
///     D(S1 => S2) = sum over segments i of S2 of || S2_i \ S1_best(i) ||
///     missing rate = D(S1 => S2) / ||S||,   false alarm rate = D(S2 => S1) / ||S||
///
/// both in [0, 1): too many segments raise the missing rate, too few the false alarm rate.
struct HammingDistance {
    double missing_rate = 0, false_alarm_rate = 0;
    double mean() const { return (missing_rate + false_alarm_rate) / 2; }  ///< the Hamming distance
};
HammingDistance hamming_distance(const SegmentOverlap& overlap);

/// Consistency errors (Chen et al. 2009 after Martin et al. 2001), which forgive refinement. With R(S, f) the segment
/// of S that holds face f, a_f its area and ||S|| the area of the surface,
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

/// All measures of Chen et al. 2009 of a segmentation against a reference; 0 for equal ones, NaN if unknown.
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

    /// Throws UsageError unless there is a segment per face.
    SegmentationErrors compare(std::span<const std::int32_t> segments, std::span<const std::int32_t> reference) const;
    /// Mean of each measure over the references, in parallel; of the cut discrepancy over those where it is defined.
    /// All NaN without references.
    SegmentationErrors mean_errors(std::span<const std::int32_t> segments,
                                   std::span<const std::vector<std::int32_t>> references) const;

  private:
    SegmentationErrors compare(std::span<const std::int32_t> segments, const SegmentCuts& cuts,
                               std::span<const std::int32_t> reference) const;

    std::vector<float> areas_;
    CutDiscrepancy cuts_;
};

}  // namespace exemplar
