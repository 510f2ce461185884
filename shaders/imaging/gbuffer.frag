#version 460

layout(location = 0) flat in uint number;
layout(location = 0) out uint face;  // 0: nothing, as the image is cleared

void main() {
    face = number;
}
