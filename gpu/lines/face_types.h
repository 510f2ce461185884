#pragma once

#include "gpu/lines/extraction.h"
#include "host/lines/extraction/face_types.h"

namespace exemplar {

/// Returns the types of lines on each face, after the recorded extraction has finished. Downloads all segments, so
/// it is for comparisons and tests. Throws DeviceLimitError if segments were dropped for lack of room.
FaceTypes download_face_types(const GpuLineExtraction& lines);

}  // namespace exemplar
