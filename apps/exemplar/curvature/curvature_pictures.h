#pragma once

#include <filesystem>

#include "host/curvature/model/evaluation.h"

namespace exemplar {

/// Writes a PNG per line type of compared_lines() into `folder`, named CLIP_FRAME_TYPE.png: the faces that carry a
/// line by measured curvature, by learned curvature, and by zero order, seen from the same eye. Black: a correct
/// line; blue: a missing one; red: one that should not be there.
void write_line_pictures(const std::filesystem::path& folder, const CurvatureModel& model, const Animation& animation,
                         FrameRef frame);

}  // namespace exemplar
