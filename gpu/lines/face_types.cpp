#include "gpu/lines/face_types.h"

#include <fmt/format.h>

#include <vector>

#include "gpu/runtime/vulkan/errors.h"

namespace exemplar {

FaceTypes download_face_types(const GpuLineExtraction& lines) {
    shared::LineCounts counts{};
    lines.counts().download(std::span(&counts, 1));
    if (counts.dropped_segments > 0) {
        const std::size_t all = std::size_t{counts.segments} + counts.dropped_segments;
        throw DeviceLimitError(
            fmt::format("{} segments of lines, over the {} that there is room for; take fewer types or higher "
                        "thresholds",
                        all, lines.room()),
            all, lines.room());
    }
    std::vector<shared::LineSegmentRecord> segments(counts.segments);
    lines.segments().download(std::span(segments));
    FaceTypes faces(lines.surface().surface().face_count());
    for (const shared::LineSegmentRecord& segment : segments)
        faces[segment.face] |= bit_of(type_of_family(segment.kind & shared::k_kind_family));
    return faces;
}

}  // namespace exemplar
