#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>

#include "gpu/lines/line_surface.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "shaders/shared/lines.h"

namespace exemplar {

/// Thresholds of each family, in the units of LineThresholds.
using FamilyThresholds = std::array<float, shared::k_line_families>;
FamilyThresholds family_thresholds(const LineThresholds& thresholds);

struct GpuLineOptions {
    shared::vec4 eye;        ///< homogeneous_eye() of the camera
    float feature_size = 0;  ///< mesh units; positive if there are families of curvature
    FamilyThresholds thresholds{};
};

/// Finds the segments of lines on the device, as extract_lines does, and keeps them there. Segments are ordered by
/// face, then by family, independently of the device's scheduling.
class GpuLineExtraction {
  public:
    /// `surface` must live as long as this. Buffers hold as many segments as the surface has faces, but at least
    /// `k_min_room`, and at most `max_segments` and 2^22. Throws DeviceLimitError if the device has less room.
    explicit GpuLineExtraction(const GpuLineSurface& surface,
                               std::size_t max_segments = std::numeric_limits<std::size_t>::max());

    /// Records the extraction of all lines of `families` (a bit each): up to four dispatches, or six with apparent
    /// ridges. Each set of families has its own kernels, which are made at its first use. Ridges and valleys are not
    /// cut off where they face away; GpuStrokes does that. Throws UsageError if the surface lacks curvature or
    /// derivatives, or the feature size is not positive, and a family needs them.
    void record(Stream& stream, const GpuCurvedSurface& snapshot, std::uint32_t families,
                const GpuLineOptions& options);

    /// A shared::LineSegmentRecord each.
    const Buffer& segments() const { return segments_; }
    /// Segment counts. Per face: 256 times the number of segments of the faces before it in its group (of
    /// shared::k_count_group faces), plus the face's own number of segments. Per group: the number of segments before
    /// it. Their sum is the index of a face's first segment.
    const Buffer& face_counts() const { return face_counts_; }
    const Buffer& face_groups() const { return face_groups_; }
    /// segments(), face_counts() and face_groups() of the previous record; counts() has their number. Faces are the
    /// same, vertices may have moved.
    struct Previous {
        const Buffer &segments, &face_counts, &face_groups;
    };
    Previous previous() const { return {old_segments_, old_face_counts_, old_face_groups_}; }
    /// shared::LineCounts: number of segments, and the arguments of later indirect commands.
    const Buffer& counts() const { return counts_; }
    Buffer& counts() { return counts_; }
    /// Returns how many segments of the last record had no room, once it is done.
    std::size_t dropped() const;
    std::size_t room() const { return room_; }
    const GpuLineSurface& surface() const { return surface_; }

    static constexpr std::size_t k_min_room = 4096;

  private:
    struct Kernels {
        Kernel fields, ridges, count, segments;
    };
    const Kernels& prepare(std::uint32_t families);
    Kernels make_kernels(std::uint32_t families) const;
    void record_fields(Stream& stream, const Kernels& kernels, const GpuCurvedSurface& snapshot, std::uint32_t families,
                       const GpuLineOptions& options);
    const GpuLineSurface& surface_;
    std::size_t room_;
    std::map<std::uint32_t, Kernels> kernels_;  // by their set of families
    Kernel view_kernel_, scan_kernel_;
    Buffer fields_, directions_, views_;
    Buffer face_counts_, face_groups_, face_slots_, segments_, counts_;
    Buffer old_face_counts_, old_face_groups_, old_segments_;
};

}  // namespace exemplar
