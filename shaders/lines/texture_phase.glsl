// Where textures lie on the pieces of chains: phases of points are 1 or -1, the way of the texture along the chain, and its
// coordinate in pixels where the chain would begin, in [0, period).
#ifndef EXEMPLAR_TEXTURE_PHASE_GLSL
#define EXEMPLAR_TEXTURE_PHASE_GLSL

// Coordinates at a point and at the next, both so many pixels along the chain: phases are taken to change by the smaller way
// around.
vec2 texture_ends(vec2 here, vec2 next, float along_here, float along_next, float period) {
    const float turn = (next.y - here.y) / period;
    const float begin = here.y + here.x * along_here;
    return vec2(begin, begin + here.x * (along_next - along_here) + period * (turn - round(turn)));
}

#endif
