#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/exemplar/commands.h"
#include "apps/exemplar/hatch/hatch_scene.h"
#include "apps/exemplar/lines/lines_job.h"
#include "apps/exemplar/lines/lines_source.h"
#include "host/hatching/view_hatching.h"

namespace exemplar {

/// Arguments of 'exemplar hatch draw'.
struct HatchDrawJob {
    std::filesystem::path style, out, properties;
    LinesOutput output = LinesOutput::svg;
    HatchSceneArguments scene;
    CommonOptions common;
    std::vector<std::string> curves{"contours"};
    std::optional<double> taper;  ///< pixels; none: the style's
    float scale = 1;
    bool outlines = false;
    HatchingOptions hatching;
    // For animations:
    LinesSourceArguments source;
    double turn = 0;  ///< degrees from one frame to the next
    bool fresh = false, remeasure = false;

    /// Returns the pixels over which strokes end in a point.
    float taper_of(const HatchingStyle& drawn) const { return taper ? static_cast<float>(*taper) : drawn.taper; }
    /// Returns the line types of `curves`; throws UsageError for an unknown one.
    std::vector<LineType> curve_types() const;
    bool is_single_picture() const { return output == LinesOutput::svg || output == LinesOutput::picture; }
    /// Returns whether frames are asked for rather than a still of a mesh.
    bool has_frames() const {
        return std::filesystem::is_directory(scene.mesh) || !is_single_picture() || !source.frames.range.empty() ||
               !source.frames.clips.empty() || source.frames.most > 0 || turn != 0;
    }
};

/// Writes a drawing as .svg or .png.
void write_hatched_drawing(const HatchDrawJob& job, const HatchedDrawing& drawing, const DrawingStyle& look);
/// Draws and writes frames of an animation, or of a mesh that turns; strokes stay on the surface.
void write_hatched_frames(const HatchDrawJob& job);

}  // namespace exemplar
