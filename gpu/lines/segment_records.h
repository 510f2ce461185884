#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/lines/extraction/lines.h"
#include "shaders/shared/lines.h"

namespace exemplar {

/// Returns the family of a segment (shared::k_contours and so on).
inline std::uint32_t family_of(const shared::LineSegmentRecord& segment) {
    return segment.kind & shared::k_kind_family;
}

/// Segments of one type in the form of extract_lines, and their indices on the device.
struct ReadSegments {
    std::vector<LineSegment> segments;
    std::vector<std::uint32_t> numbers;
};

/// Returns those of GpuLineExtraction::segments() that are of a type.
ReadSegments segments_of_type(std::span<const shared::LineSegmentRecord> records, LineType type);

}  // namespace exemplar
