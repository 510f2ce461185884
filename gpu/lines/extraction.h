#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>

#include "gpu/lines/line_surface.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/kernels/kernel.h"
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

/// Finds the segments of lines on the device, as extract_lines does; they stay there. Segments are ordered by face,
/// then by family, whatever the device's scheduling.
class GpuLineExtraction {
  public:
    /// `surface` must live as long as this. There is room for as many segments as the surface has faces, but at least
    /// `k_least_room` and at most `most_segments`. Throws DeviceLimitError if the device has less room.
    explicit GpuLineExtraction(const GpuLineSurface& surface,
                               std::size_t most_segments = std::numeric_limits<std::size_t>::max());

    /// Lines of all families at once: four dispatches, one more for each of view-dependent curvature and its growth if
    /// there are apparent ridges. Each set of families has kernels of its own, made when it
    /// is first asked for. Throws UsageError if the
    /// surface lacks what they need, or the feature size is not positive.
    /// Ridges and valleys are not cut off where they face away: visibility does that.
    void record(Stream& stream, const GpuCurvedSurface& moment, std::uint32_t families, const GpuLineOptions& options);

    /// shared::LineSegmentRecord each.
    const Buffer& segments() const { return segments_; }
    /// Where the segments of faces begin: of each face those before it in its group of shared::k_count_group, times
    /// 256, and its own; and those before each group.
    const Buffer& face_counts() const { return face_counts_; }
    const Buffer& face_groups() const { return face_groups_; }
    /// What segments(), face_counts() and face_groups() were of the record before; counts() has their number. Faces are
    /// the same, vertices may have moved.
    struct Previous {
        const Buffer &segments, &face_counts, &face_groups;
    };
    Previous previous() const { return {old_segments_, old_face_counts_, old_face_groups_}; }
    /// shared::LineCounts: how many there are, and what later commands need.
    const Buffer& counts() const { return counts_; }
    Buffer& counts() { return counts_; }
    std::size_t room() const { return room_; }
    const GpuLineSurface& surface() const { return surface_; }

    static constexpr std::size_t k_least_room = 4096;

  private:
    struct Kernels {
        Kernel fields, ridges, count, segments;
    };
    const Kernels& prepare(std::uint32_t families);
    Kernels make_kernels(std::uint32_t families) const;
    void record_fields(Stream& stream, const Kernels& kernels, const GpuCurvedSurface& moment, std::uint32_t families,
                       const GpuLineOptions& options);
    const GpuLineSurface& surface_;
    std::size_t room_;
    std::map<std::uint32_t, Kernels> kernels_;  // by the families that they find
    Kernel view_kernel_, scan_kernel_;
    Buffer fields_, directions_, views_;
    Buffer face_counts_, face_groups_, segments_, counts_;
    Buffer old_face_counts_, old_face_groups_, old_segments_;
};

}  // namespace exemplar
