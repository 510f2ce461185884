#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/paint.h"

layout(push_constant) uniform Push { PaintParameters parameters; };
layout(location = 0) out vec4 drawn;  // sRGB, multiplied by its alpha

void main() {
    const float alpha = parameters.plain.a;
    drawn = vec4(parameters.plain.rgb * alpha, alpha);
}
