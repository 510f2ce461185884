#version 460
layout(push_constant) uniform Push { mat4 clip_from_mesh; float shade; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out float brightness;

void main() {
    brightness = 1.0 - shade * (0.5 - 0.5 * normalize(normal).y);
    gl_Position = clip_from_mesh * vec4(position, 1.0);
}
