#pragma once

#include <functional>
#include <vector>

#include "host/hatching/registration/region_fit.h"

namespace exemplar {

/// Finds poses from which an object covers a region of a picture, from all sides and in any roll: at most `count` that
/// differ from each other, best first. `size`: longer side of the region, pixels. Any object looks alike from some
/// sides, and from opposite ones its parallel projections are mirror images, so the best is not always the right one.
/// `mesh`: simplified, a few thousand faces suffice; `step` is called 100 times.
std::vector<RegionFit> search_views(const TriangleMesh& mesh, const PoseFrame& frame, const PictureRegion& region,
                                    float size, std::size_t count, const std::function<void()>& step);

/// Does the same around a pose: turned by up to about 17 degrees about each axis.
std::vector<RegionFit> search_near(const TriangleMesh& mesh, const PoseFrame& frame, const ViewPose& start,
                                   const PictureRegion& region, float size, std::size_t count,
                                   const std::function<void()>& step);

}  // namespace exemplar
