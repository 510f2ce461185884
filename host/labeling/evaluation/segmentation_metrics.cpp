#include "host/labeling/evaluation/segmentation_metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

/// The distinct segment numbers in rising order, and for each face the index of its own.
struct Renumbered {
    std::vector<std::int32_t> numbers;
    std::vector<std::uint32_t> of_face;
};

Renumbered renumber(std::span<const std::int32_t> segments) {
    Renumbered result{{segments.begin(), segments.end()}, {}};
    std::sort(result.numbers.begin(), result.numbers.end());
    result.numbers.erase(std::unique(result.numbers.begin(), result.numbers.end()), result.numbers.end());
    result.of_face.reserve(segments.size());
    for (const std::int32_t segment : segments) {
        const auto found = std::lower_bound(result.numbers.begin(), result.numbers.end(), segment);
        result.of_face.push_back(static_cast<std::uint32_t>(found - result.numbers.begin()));
    }
    return result;
}

/// Unordered pairs of `count` items.
double pairs(double count) {
    return 0.5 * count * (count - 1.0);
}

double pairs_within(const std::vector<double>& counts) {
    double sum = 0;
    for (const double count : counts) sum += pairs(count);
    return sum;
}

/// Mean of one measure over all results where it is known.
double mean_measure(const std::vector<SegmentationErrors>& errors, double SegmentationErrors::*measure) {
    double sum = 0, known = 0;
    for (const SegmentationErrors& error : errors)
        if (!std::isnan(error.*measure)) sum += error.*measure, ++known;
    return known > 0 ? sum / known : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

SegmentOverlap segment_overlap(std::span<const std::int32_t> first, std::span<const std::int32_t> second,
                               std::span<const float> areas) {
    if (first.size() != second.size() || (!areas.empty() && areas.size() != first.size()))
        throw UsageError(fmt::format("segmentations of {} and {} faces, with {} areas, cannot be compared",
                                     first.size(), second.size(), areas.size()));
    const bool weighted = std::any_of(areas.begin(), areas.end(), [](float area) { return area > 0; });
    const Renumbered a = renumber(first), b = renumber(second);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> faces;  // by segment of both
    faces.reserve(first.size());
    for (std::uint32_t f = 0; f < first.size(); ++f)
        faces.emplace_back(std::uint64_t{a.of_face[f]} << 32 | b.of_face[f], f);
    std::sort(faces.begin(), faces.end());

    SegmentOverlap overlap;
    overlap.first_count.assign(a.numbers.size(), 0), overlap.first_area.assign(a.numbers.size(), 0);
    overlap.second_count.assign(b.numbers.size(), 0), overlap.second_area.assign(b.numbers.size(), 0);
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const auto [key, face] = faces[i];
        if (i == 0 || key != faces[i - 1].first)
            overlap.cells.push_back({static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key), 0, 0});
        overlap.cells.back().count += 1;
        overlap.cells.back().area += weighted ? static_cast<double>(areas[face]) : 1.0;
    }
    // Sums of cells rather than of faces, so that a segment with a single cell has exactly that cell's area.
    for (const SegmentOverlap::Cell& cell : overlap.cells) {
        overlap.first_count[cell.first] += cell.count, overlap.second_count[cell.second] += cell.count;
        overlap.first_area[cell.first] += cell.area, overlap.second_area[cell.second] += cell.area;
        overlap.count += cell.count, overlap.area += cell.area;
    }
    return overlap;
}

double rand_index_error(const SegmentOverlap& overlap) {
    if (overlap.count < 2) return 0;
    double in_both = 0;
    for (const SegmentOverlap::Cell& cell : overlap.cells) in_both += pairs(cell.count);
    return (pairs_within(overlap.first_count) + pairs_within(overlap.second_count) - 2 * in_both) /
           pairs(overlap.count);
}

HammingDistance hamming_distance(const SegmentOverlap& overlap) {
    std::vector<double> first(overlap.first_area.size()), second(overlap.second_area.size());  // of the best matches
    for (const SegmentOverlap::Cell& cell : overlap.cells) {
        first[cell.first] = std::max(first[cell.first], cell.area);
        second[cell.second] = std::max(second[cell.second], cell.area);
    }
    HammingDistance distance;
    for (std::size_t i = 0; i < first.size(); ++i)
        distance.false_alarm_rate += (overlap.first_area[i] - first[i]) / overlap.area;
    for (std::size_t i = 0; i < second.size(); ++i)
        distance.missing_rate += (overlap.second_area[i] - second[i]) / overlap.area;
    return distance;
}

ConsistencyErrors consistency_errors(const SegmentOverlap& overlap) {
    double forward = 0, backward = 0, local = 0;
    for (const SegmentOverlap::Cell& cell : overlap.cells) {
        if (cell.area <= 0) continue;
        const double first = 1 - cell.area / overlap.first_area[cell.first];
        const double second = 1 - cell.area / overlap.second_area[cell.second];
        const double share = cell.area / overlap.area;
        forward += share * first, backward += share * second, local += share * std::min(first, second);
    }
    return {std::min(forward, backward), local};
}

SegmentationErrors SegmentationMetrics::compare(std::span<const std::int32_t> segments, const SegmentCuts& cuts,
                                                std::span<const std::int32_t> reference) const {
    const double cut_discrepancy = cuts_.between(cuts, cuts_.cuts_of(reference));
    const SegmentOverlap overlap = segment_overlap(segments, reference, areas_);
    const HammingDistance hamming = hamming_distance(overlap);
    const ConsistencyErrors consistency = consistency_errors(overlap);
    return {rand_index_error(overlap), cut_discrepancy,  hamming.missing_rate, hamming.false_alarm_rate, hamming.mean(),
            consistency.global,        consistency.local};
}

SegmentationErrors SegmentationMetrics::compare(std::span<const std::int32_t> segments,
                                                std::span<const std::int32_t> reference) const {
    return compare(segments, cuts_.cuts_of(segments), reference);
}

SegmentationErrors SegmentationMetrics::mean_errors(std::span<const std::int32_t> segments,
                                                    std::span<const std::vector<std::int32_t>> references) const {
    const SegmentCuts cuts = cuts_.cuts_of(segments);
    std::vector<SegmentationErrors> errors(references.size());
    parallel_for(references.size(), [&](std::size_t i) { errors[i] = compare(segments, cuts, references[i]); });
    SegmentationErrors mean;
    for (double SegmentationErrors::*measure :
         {&SegmentationErrors::rand_index, &SegmentationErrors::cut_discrepancy, &SegmentationErrors::missing_rate,
          &SegmentationErrors::false_alarm_rate, &SegmentationErrors::hamming_distance,
          &SegmentationErrors::global_consistency, &SegmentationErrors::local_consistency})
        mean.*measure = mean_measure(errors, measure);
    return mean;
}

}  // namespace exemplar
