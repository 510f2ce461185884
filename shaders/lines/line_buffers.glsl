// Bindings of the kernels that find lines in faces.
#ifndef EXEMPLAR_LINE_BUFFERS_GLSL
#define EXEMPLAR_LINE_BUFFERS_GLSL
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/lines.h"

layout(local_size_x = k_count_group) in;
layout(constant_id = 0) const uint k_families = 0;
layout(push_constant) uniform Push { FaceLineParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer positions;
layout(set = 0, binding = 1) uniform usamplerBuffer faces;      // three corners each
layout(set = 0, binding = 2) uniform usamplerBuffer neighbors;  // across three sides each
layout(set = 0, binding = 3) uniform samplerBuffer fields;
layout(set = 0, binding = 4) uniform samplerBuffer directions;
layout(set = 0, binding = 5) uniform usamplerBuffer joined_faces;  // before the surface was cut open

#endif
