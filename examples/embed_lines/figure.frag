#version 460
layout(location = 0) in float brightness;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(vec3(brightness), 1.0);
}
