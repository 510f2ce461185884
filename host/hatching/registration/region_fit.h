#pragma once

#include <vector>

#include "host/hatching/registration/view_pose.h"
#include "host/hatching/tracing/ink_mask.h"

namespace exemplar {

/// A region of a picture: narrow bays are closed and holes filled, so that regions of drawings and of objects compare.
struct PictureRegion {
    PixelMask mask;
    FloatImage distance;       ///< signed_distance
    std::vector<Vec2> border;  ///< at most k_region_points

    bool empty() const { return border.empty(); }
};
constexpr std::size_t k_region_points = 240;
/// Closes a mask and measures it; `size`: longer side of what it shows, pixels.
PictureRegion picture_region(const PixelMask& mask, float size);

/// The region that an object covers, as a pose shows it.
struct SeenRegion {
    PictureRegion region;
    std::vector<Vec3d> points;  ///< of the object, per border point; those of closed bays are at the object's center
    std::vector<std::uint8_t> valid;  ///< whether there is one
};
SeenRegion seen_region(const TriangleMesh& mesh, const ViewPose& pose, const PoseFrame& frame, float size);

/// Returns intersection over union of two masks of one size.
double overlap_of(const PixelMask& first, const PixelMask& second);

/// A pose, and how well the object covers the region that it was fitted to.
struct RegionFit {
    ViewPose pose;
    double overlap = 0;  ///< intersection over union
};
/// Fits a pose to a region of a picture of the frame's size by `rounds` steps of least squares, each towards the
/// nearest borders of both, and returns the best pose on the way. `size`: longer side of the region, pixels.
RegionFit fit_to_region(const TriangleMesh& mesh, const PoseFrame& frame, const ViewPose& start,
                        const PictureRegion& region, float size, int rounds);

}  // namespace exemplar
