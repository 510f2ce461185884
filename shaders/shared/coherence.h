#ifndef EXEMPLAR_SHARED_COHERENCE_H
#define EXEMPLAR_SHARED_COHERENCE_H
#include "shaders/shared/lines.h"

SHARED_BEGIN

// The trace of a segment for the next frame is a vec4: the texture coordinates at its ends, the share of it that was
// drawn, and 0.

// The votes of the pieces of a chain on the phase of its texture, as an angle, in units of 1 / k_vote_unit pixels.
struct ChainVotes {
    int balance;    // positive or zero: the texture runs along the chain, else against it
    int along_cos;  // of the phase at its start if it runs along
    int along_sin;
    int against_cos;  // of the phase at its start if it runs against
    int against_sin;
};
const float k_vote_unit = 16.0f;
const int k_max_vote = 16;  // pixels

// Number of faces searched for the previous line, to each side of a line.
const uint k_follow_faces = 8;
// The phase of a point follows the votes within this many pixels and points along the chain, blended with a share of
// 1 / k_whole_chain_divisor of the votes of the whole chain.
const int k_follow_reach = 64;
const int k_follow_points = 32;
const int k_whole_chain_divisor = 16;

struct FollowParameters {
    vec4 matrix[4];  // columns: world to clip space
    float width;     // of the picture, in pixels
    float height;
    uint keeps;  // 0: the texture of every chain starts at the chain's start
};

// How lines differ from those of the previous frame: sums in units of 1 / k_flicker_unit.
struct FlickerSums {
    uint drawn;     // drawn length in pixels
    uint kept;      // part of it that was drawn before
    uint appeared;  // part of it that was not
    uint slip;      // kept length times the movement of the texture on it, in pixels
    uint stretch;   // difference of the lengths of textures and their pieces of lines, in pixels
};
const float k_flicker_unit = 4.0f;

#ifdef __cplusplus
EXEMPLAR_LAYOUT(ChainVotes, balance, along_cos, along_sin, against_cos, against_sin)
EXEMPLAR_LAYOUT(FollowParameters, matrix, width, height, keeps)
EXEMPLAR_LAYOUT(FlickerSums, drawn, kept, appeared, slip, stretch)
#endif

SHARED_END
#endif
