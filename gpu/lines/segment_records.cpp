#include "gpu/lines/segment_records.h"

#include "gpu/lines/line_surface.h"

namespace exemplar {
namespace {

LineSegment read_segment(const shared::LineSegmentRecord& record) {
    LineSegment segment;
    segment.face = record.face;
    const std::uint32_t family = family_of(record);
    segment.family = family == shared::k_second_highlights ? 1
                     : family == shared::k_edge_contours   ? k_family_along_edges
                                                           : 0;
    segment.places = {static_cast<SegmentEnd>(record.kind >> shared::k_kind_first_place & shared::k_kind_place),
                      static_cast<SegmentEnd>(record.kind >> shared::k_kind_second_place & shared::k_kind_place)};
    const shared::vec4& e = record.ends;
    segment.ends = {{{1 - e.x - e.y, e.x, e.y}, {1 - e.z - e.w, e.z, e.w}}};
    segment.strength = {record.first_strength, record.second_strength};
    return segment;
}

}  // namespace

ReadSegments segments_of_type(std::span<const shared::LineSegmentRecord> records, LineType type) {
    ReadSegments read;
    for (std::uint32_t i = 0; i < records.size(); ++i) {
        if (type_of_family(family_of(records[i])) != type) continue;
        read.segments.push_back(read_segment(records[i]));
        read.numbers.push_back(i);
    }
    return read;
}

}  // namespace exemplar
