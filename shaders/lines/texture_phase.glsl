// Placement of textures on the pieces of chains. The phase of a point is the texture direction along the chain (+1
// or -1) and the coordinate in pixels, extrapolated to the chain's start, in [0, period).
#ifndef EXEMPLAR_TEXTURE_PHASE_GLSL
#define EXEMPLAR_TEXTURE_PHASE_GLSL

// Returns the texture coordinates at a point and at the next, which are along_here and along_next pixels along the
// chain. Phases change by the shorter way around the period.
vec2 texture_ends(vec2 here, vec2 next, float along_here, float along_next, float period) {
    const float turn = (next.y - here.y) / period;
    const float begin = here.y + here.x * along_here;
    return vec2(begin, begin + here.x * (along_next - along_here) + period * (turn - round(turn)));
}

#endif
