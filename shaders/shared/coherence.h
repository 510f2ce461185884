#ifndef EXEMPLAR_SHARED_COHERENCE_H
#define EXEMPLAR_SHARED_COHERENCE_H
#include "shaders/shared/lines.h"

SHARED_BEGIN

// What a segment leaves behind for the frame after: a vec4 with the coordinates of the texture at its ends, the share of it
// that was drawn, and 0.

// The pieces of a chain vote on where its texture lies, in turns of the texture: sums in units of 1 / k_vote_unit pixels.
struct ChainVotes {
    int balance;      // positive: the texture runs along the chain, else against it
    int along_cos;    // of the turns at which it begins if it runs along
    int along_sin;
    int against_cos;  // and if against
    int against_sin;
};
const float k_vote_unit = 16.0f;
const int k_most_vote = 16;  // pixels

// Faces to each side of a line in which the same line is looked for.
const uint k_follow_faces = 8;
// A point goes by the votes within so many pixels along the chain, and within so many points; and to one part in
// k_calling by those of the whole chain.
const int k_follow_reach = 64;
const int k_follow_points = 32;
const int k_calling = 16;

struct FollowParameters {
    vec4 matrix[4];  // columns: world to clip space
    float width;     // of the picture, in pixels
    float height;
    uint keeps;  // 0: every chain begins its texture anew
    uint unused;
};

// How lines differ from those of the frame before: sums in units of 1 / k_flicker_unit.
struct FlickerSums {
    uint drawn;     // pixels of length that are drawn
    uint kept;      // that were drawn before, too
    uint appeared;  // and that were not
    uint slip;      // kept pixels times the pixels by which the texture moved on them
    uint stretch;   // pixels by which textures are longer or shorter than the pieces of lines that they are on
};
const float k_flicker_unit = 4.0f;

#ifdef __cplusplus
EXEMPLAR_LAYOUT(ChainVotes, balance, along_cos, along_sin, against_cos, against_sin)
EXEMPLAR_LAYOUT(FollowParameters, matrix, width, height, keeps, unused)
EXEMPLAR_LAYOUT(FlickerSums, drawn, kept, appeared, slip, stretch)
#endif

SHARED_END
#endif
