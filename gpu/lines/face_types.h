#pragma once

#include "gpu/lines/extraction.h"
#include "host/lines/extraction/face_types.h"

namespace exemplar {

/// The types of lines that each face carries, of segments that were recorded and are finished. Downloads all of them:
/// it is for comparing and checking. Throws DeviceLimitError if there was no room for some.
FaceTypes download_face_types(const GpuLineExtraction& lines);

}  // namespace exemplar
