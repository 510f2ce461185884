#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "apps/exemplar/lines/frame_drawer.h"
#include "apps/exemplar/lines/lines_job.h"

namespace exemplar {

/// The types that curvature decides on: lines of others are the same by any.
std::vector<LineType> types_to_compare(std::span<const LineType> types);

/// Draws frames by learned and by measured curvature, and counts the faces in whose lines they differ.
class LinesComparison {
  public:
    /// All must live as long as this; the source has a model.
    LinesComparison(const LinesJob& job, LinesSource& source, FrameDrawer& drawer);

    /// Learned curvature on the left, measured on the right.
    Image draw(std::size_t frame);

    /// A table, means over the frames.
    void print() const;
    nlohmann::json describe() const;

  private:
    LinesSource& source_;
    FrameDrawer& drawer_;
    std::vector<LineType> types_;
    LineDifference in_view_, from_around_;  // as pictures see it, and as `curvature evaluate` does
};

}  // namespace exemplar
