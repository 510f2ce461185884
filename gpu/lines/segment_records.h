#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/lines/extraction/lines.h"
#include "shaders/shared/lines.h"

namespace exemplar {

/// The family that a segment is of (shared::k_contours and so on).
inline std::uint32_t family_of(const shared::LineSegmentRecord& segment) {
    return segment.kind & shared::k_kind_family;
}

/// Segments of one type as extract_lines has them, and their places among the device's.
struct ReadSegments {
    std::vector<LineSegment> segments;
    std::vector<std::uint32_t> numbers;
};

/// Those of GpuLineExtraction::segments() that are of a type.
ReadSegments segments_of_type(std::span<const shared::LineSegmentRecord> records, LineType type);

}  // namespace exemplar
