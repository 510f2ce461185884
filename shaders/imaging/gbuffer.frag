#version 460

layout(location = 0) flat in uint number;
layout(location = 0) out uint face;  // 0 in the cleared image: no face

void main() {
    face = number;
}
