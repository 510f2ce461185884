#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "host/hatching/tracing/stroke_paths.h"
#include "host/hatching/tracing/view_outlines.h"
#include "host/imaging/image.h"
#include "host/mesh/mesh.h"

namespace exemplar {

struct MeasuringOptions {
    float min_darkness = 0.1f;                      ///< min darkness of a stroke
    float similar = std::numbers::pi_v<float> / 6;  ///< max angle between strokes of one family, radians
    float max_spacing = 0;                          ///< pixels; 0: 20 median thicknesses, at least 24
    std::size_t max_single_intersections = 4;       ///< regions with more are cross-hatched
    float smoothing = 1;                            ///< standard deviation of the Gaussian, median spacings; 0: none
};

/// Measured properties of a drawing's strokes (thesis Sec. 4.2, App. B.1). All are images of the same size, row by
/// row from the top left, with the conventions of HatchingFields. Values per stroke pixel are 0 elsewhere.
struct StrokeMeasurements {
    int width = 0, height = 0;
    std::vector<std::uint8_t> stroke;        ///< 1: a stroke's pixel inside of the object
    std::vector<std::uint8_t> skeleton;      ///< 1: on the center line of a stroke
    std::vector<std::uint8_t> outline;       ///< 1: on the center line of a drawn outline, which is no stroke
    std::vector<std::int32_t> stroke_id;     ///< per stroke pixel: of the stroke it belongs to, from 0; -1 elsewhere
    std::vector<float> intensity;            ///< per stroke pixel, in (0, 1]
    std::vector<float> thickness;            ///< per stroke pixel, pixels, at least 1
    std::vector<float> orientation;          ///< per stroke pixel, radians in [0, pi)
    std::vector<float> spacing;              ///< per stroke pixel, pixels; 0: no neighbor in reach, so no hatching
    std::vector<float> length;               ///< per stroke pixel, pixels
    std::vector<std::uint8_t> bounded;       ///< 1: on a stroke that ends at both sides where its hatching ends
    std::vector<std::uint8_t> intersection;  ///< 1: stroke pixels where strokes overlap; ignore their orientations
    std::vector<Vec2> intersections;         ///< where strokes cross, in pixel coordinates
    std::vector<std::uint8_t> level;         ///< per pixel of the object: 0, 1 or 2
    std::vector<std::uint8_t> boundary;      ///< 1: on the boundary of a region of one level, or at a stroke's end
    float median_thickness = 0, median_spacing = 0;  ///< over points of center lines; 0: there are none
    float taper = 0;                                 ///< pixels over which strokes end in a point (measure_taper)
    float outline_width = 0;  ///< of drawn outlines, pixels (measure_line_width); 0: none are drawn
    float softness = 0;       ///< standard deviation of the blur of the drawing's edges, pixels

    std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Measures the strokes of a drawing (thesis App. B.1) inside of `mask` (one channel, not zero inside of the
/// object). `darkness`: see drawing_darkness, one channel. A drawing without strokes gives zeros. Unlike the thesis,
/// it traces whole strokes through crossings first (see trace_strokes) and then measures them one by one: pixels at
/// crossings belong to no direction, so following pixels of similar orientation fails there. Other differences are
/// noted where a property is measured. `outlines`, if given, of the view: outlines that were drawn along them are no
/// strokes (see take_outlines). The result does not depend on the number of threads. Throws UsageError if an
/// image has not one channel, or the sizes differ.
StrokeMeasurements measure_strokes(const FloatImage& darkness, const Image& mask, const MeasuringOptions& options = {},
                                   const ViewOutlines* outlines = nullptr);

/// Measures strokes whose center lines, widths and darkness are known, in place of tracing them in a picture. Strokes
/// that are said to be outlines are no hatching; if there are none, those along `outlines` are left out as above.
/// `darkness`: the strokes as render_ink draws them (drawn_strokes).
StrokeMeasurements measure_paths(std::span<const StrokePath> paths, const FloatImage& darkness, const Image& mask,
                                 const MeasuringOptions& options = {}, const ViewOutlines* outlines = nullptr);

/// Leaves out what lies where a mask of the same size is zero: strokes, outlines, crossings, levels. The medians are
/// those over the pixels of center lines that remain.
void restrict_to(const Image& mask, StrokeMeasurements& measurements);

}  // namespace exemplar
