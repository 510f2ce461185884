#pragma once

#include <filesystem>
#include <vector>

#include "apps/exemplar/commands.h"
#include "apps/exemplar/lines/lines_camera.h"
#include "apps/exemplar/lines/lines_source.h"
#include "host/lines/drawing_svg.h"
#include "host/lines/outline_check.h"
#include "host/lines/strokes/style.h"

namespace exemplar {

/// Kind of output: a file, or a folder of pictures.
enum class LinesOutput { svg, picture, video, folder };
/// Returns the kind by the extension; a name without one is a folder. Throws UsageError for other extensions.
LinesOutput lines_output_of(const std::filesystem::path& path);

/// Checked arguments of 'exemplar lines', for one function per kind of output.
struct LinesJob {
    CommonOptions common;
    LinesSourceArguments source;
    CameraArguments camera;
    std::vector<LineType> types;  ///< in the order in which they are drawn
    DrawingStyle style;           ///< with the thresholds of the command line
    std::filesystem::path out;
    LinesOutput output = LinesOutput::svg;
    bool compare = false;  ///< pictures show lines of learned curvature beside those of measured
    bool check = false;    ///< whether the outline is compared with that of the surface
    SvgOptions svg;
};

/// Returns the report of a job, without the parts that depend on the kind of output.
nlohmann::json describe_job(const LinesJob& job, const LinesSource& source, const StrokeView& view);

/// Prints and returns how well the lines of all frames show the outline.
nlohmann::json report_outline(const LinesJob& job, const OutlineCheck& check);

/// Draws on the host and writes an SVG file, with frames as an animation.
void write_lines_svg(const LinesJob& job);
/// Draws on the device and writes a picture, a folder of them or a video.
void write_lines_pictures(const LinesJob& job);

}  // namespace exemplar
