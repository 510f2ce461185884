#pragma once

#include <filesystem>

#include "host/curvature/model/evaluation.h"

namespace exemplar {

/// Writes a PNG per line type compared_lines() into `folder`, named FRAME_TYPE.png: the faces that carry a line by
/// measured curvature, by the learned, and by zero order, from the same eye. Black: a line that is right; blue: one
/// that is missing; red: one that should not be there.
void write_line_pictures(const std::filesystem::path& folder, const CurvatureModel& model, const Animation& animation,
                         FrameRef frame);

}  // namespace exemplar
