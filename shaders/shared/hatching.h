#ifndef EXEMPLAR_SHARED_HATCHING_H
#define EXEMPLAR_SHARED_HATCHING_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// The placement of strokes in whole numbers; units as host/hatching/placement/fixed_point.h and placement_grid.h have them.
const int k_pixel_bits = 12;
const int k_pixel = 4096;
const int k_unit_bits = 14;
const int k_unit = 16384;
const int k_share_bits = 10;
const int k_spacing_bits = 6;
const int k_length_bits = 2;
const int k_step = 4094;
const int k_least_steps = 2;
const uint k_most_places = 16384;
const uint k_right_barrier = 1u;
const uint k_lower_barrier = 2u;

const uint k_hatch_group = 64;
const uint k_settle_group = 256;

// exemplar::PlacementRules, the picture, and how much there is room for.
struct PlacementParameters {
    uint width;  // of the picture, in pixels
    uint height;
    uint seed;
    int test_share;
    int hole_share;
    int least_share;
    int jitter;
    int least_turn_cosine;
    int near_shift;
    uint room;         // points of a way
    uint candidates;   // that are tried in a round, at most
    uint block_bits;   // of the side of a block in pixels
    uint blocks;       // lists of holes; they come before those of the front
    uint rounds_left;  // in [0, 4095], one less with every round
    uint stroke_room;
    uint point_room;
    uint list_room;
};

// Places to try, exemplar::SeedList.
struct SeedListRecord {
    uint kind;   // source, and the layer from bit k_layer_shift on
    uint first;   // point of a stroke, or x
    uint second;  // number of its points, or y
    uint next;
};
const uint k_part_source = 0;
const uint k_left_side_source = 1;
const uint k_right_side_source = 2;
const uint k_first_end_source = 3;
const uint k_last_end_source = 4;
const uint k_block_source = 5;
const uint k_layer_shift = 8;
const uint k_source_mask = 255u;

// What is tried at a place of the round's list. The points of its way are at (way_begin + i) % room of the place's room.
struct TrialRecord {
    int seed_x;
    int seed_y;
    int heading_x;
    int heading_y;
    uint state;
    uint claim;
    uint way_begin;
    uint way_count;
    uint begin;  // of the stroke, in the way
    uint count;
    uint listed;  // not of this place: the listed[i] of all are the places that have something to try, in any order
    uint target;  // where the stroke's points go
};
// Flags of a state, which has the layer from bit k_layer_shift on.
const uint k_pending_trial = 1u;  // its list is not used up
const uint k_seeded_trial = 2u;   // there is a place where a stroke may begin
const uint k_open_trial = 4u;     // and a stroke
const uint k_lost_trial = 8u;

// Numbers that the device finds by itself: how much there is, and the arguments of indirect commands.
struct PlacementCounts {
    uint trials;     // in this round; 0: all is placed
    uint in_blocks;  // whether they are of holes
    uint front;      // lists of the front
    uint strokes;
    uint points;
    uint full;  // what there is no room for, of all that this round would place: its end is to be done again
    uint held_groups;  // of candidates, then
    uint trial_groups[3];
    uint candidate_groups[3];  // trials that have something to try, and how many workgroups share the pixels of each
    uint place_groups[3];
};

const uint k_full_strokes = 1u;
const uint k_full_points = 2u;
const uint k_full_lists = 4u;

// A placed stroke.
struct StrokeRecord {
    uint first;
    uint count;
    uint layer;
    uint unused;
};

#ifdef __cplusplus
EXEMPLAR_LAYOUT(PlacementParameters, width, height, seed, test_share, hole_share, least_share, jitter, least_turn_cosine,
                near_shift, room, candidates, block_bits, blocks, rounds_left, stroke_room, point_room, list_room)
EXEMPLAR_LAYOUT(SeedListRecord, kind, first, second, next)
EXEMPLAR_LAYOUT(TrialRecord, seed_x, seed_y, heading_x, heading_y, state, claim, way_begin, way_count, begin, count, listed, target)
EXEMPLAR_LAYOUT(PlacementCounts, trials, in_blocks, front, strokes, points, full, held_groups, trial_groups, candidate_groups,
                place_groups)
EXEMPLAR_LAYOUT(StrokeRecord, first, count, layer, unused)
#endif

SHARED_END
#endif
