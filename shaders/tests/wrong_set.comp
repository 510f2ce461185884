#version 460
// A kernel that Exemplar refuses: its buffer is not in descriptor set 0.
layout(local_size_x = 1) in;
layout(set = 1, binding = 0, std430) buffer Values { float values[]; };

void main() { values[0] = 1.0; }
