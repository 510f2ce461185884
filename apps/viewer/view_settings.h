#pragma once

#include <array>

#include "gpu/window/surface_painter.h"
#include "host/lines/lines.h"
#include "host/lines/strokes.h"
#include "host/mesh/labels.h"

namespace exemplar {

/// Which curvature colors and lines are taken from: measured anew on every frame, or learned; or both side by side.
enum class CurvatureSource { estimated, learned, both };

struct LineSettings {
    std::array<bool, k_line_types.size()> shown{};  ///< in the order of k_line_types
    LineThresholds thresholds;
    StrokeThickness thickness;
    Color ink{20, 20, 24};
};

/// Everything that decides how a surface looks, but for where it is seen from.
struct ViewSettings {
    SurfacePaint paint = SurfacePaint::plain;
    SurfaceLight light = SurfaceLight::smooth;
    Color plain{214, 212, 206};
    Color background{250, 250, 248};
    /// The curvature of the strongest color, times the feature size.
    float curvature_range = 0.25f;
    CurvatureSource source = CurvatureSource::estimated;
    LineSettings lines;

    bool needs_curvature() const { return paints_curvature(paint); }
};

}  // namespace exemplar
