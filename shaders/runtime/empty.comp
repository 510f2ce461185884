#version 460

// Does nothing, to measure what a dispatch costs.
layout(local_size_x = 64) in;

void main() {
}
