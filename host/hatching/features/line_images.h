#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "host/hatching/features/hatching_surface.h"
#include "host/hatching/features/hatching_view.h"
#include "host/imaging/image.h"
#include "host/lines/extraction/lines.h"
#include "host/lines/strokes/visibility.h"

namespace exemplar {

/// The kinds of feature lines that have images (thesis App. B.2): contours together with suggestive contours, ridges,
/// valleys, apparent ridges.
constexpr std::size_t k_line_kinds = 4, k_line_thresholds = 4;

/// Returns the name of a kind, e.g. "contours".
const char* line_kind_name(std::size_t kind);
/// Returns threshold `step` of a kind, dimensionless: from 0.001 (contours, valleys) or 0.01 to 0.1, evenly in the
/// logarithm.
float line_threshold(std::size_t kind, std::size_t step);

/// Draws images of the visible feature lines of a view. Keeps references.
class LineImages {
  public:
    LineImages(const HatchingSurface& surface, const HatchingView& view);
    /// Returns the amount of line in each pixel as one channel: length in pixels times opacity. Safe to call from
    /// many threads.
    FloatImage draw(std::size_t kind, std::size_t step) const;
    /// Returns all lines of a type at a threshold, including hidden ones.
    std::vector<LineSegment> segments(LineType type, float threshold) const;

  private:
    void add(LineType type, float threshold, FloatImage& image) const;
    const HatchingSurface& surface_;
    const HatchingView& view_;
    LineVisibility visibility_;
};

}  // namespace exemplar
