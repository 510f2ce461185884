#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "apps/exemplar/lines/frame_drawer.h"
#include "apps/exemplar/lines/lines_job.h"

namespace exemplar {

/// Returns the types that depend on curvature; lines of others are the same by any curvature.
std::vector<LineType> types_to_compare(std::span<const LineType> types);

/// Draws frames by learned and by measured curvature, and counts the faces in whose lines they differ.
class LinesComparison {
  public:
    /// `source` and `drawer` must outlive this; the source must have a model.
    LinesComparison(const LinesJob& job, LinesSource& source, FrameDrawer& drawer);

    /// Draws a frame by learned curvature on the left and by measured on the right.
    Image draw(std::size_t frame);

    /// Prints a table of means over the frames.
    void print() const;
    nlohmann::json describe() const;

  private:
    LinesSource& source_;
    FrameDrawer& drawer_;
    std::vector<LineType> types_;
    LineDifference in_view_, from_around_;  // in the picture's view, and from six sides as in `curvature evaluate`
};

}  // namespace exemplar
