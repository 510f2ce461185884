#ifndef EXEMPLAR_SHARED_HATCHING_H
#define EXEMPLAR_SHARED_HATCHING_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// Stroke placement in integers; units as in host/hatching/placement/fixed_point.h and placement_grid.h.
const int k_pixel_bits = 12;
const int k_pixel = 4096;
const int k_unit_bits = 14;
const int k_unit = 16384;
const int k_share_bits = 10;
const int k_spacing_bits = 6;
const int k_length_bits = 2;
const int k_step = 4094;
const int k_min_steps = 2;
const uint k_max_seeds_per_round = 16384;
const uint k_right_barrier = 1u;
const uint k_lower_barrier = 2u;

const uint k_hatch_group = 64;
const uint k_end_round_group = 256;

// exemplar::PlacementRules, the size of the picture, and the capacities of buffers.
struct PlacementParameters {
    uint width;  // of the picture, in pixels
    uint height;
    uint seed;
    int test_share;
    int hole_share;
    int min_length_share;
    int jitter;
    int min_turn_cosine;
    int near_shift;
    uint room;         // maximum number of points of a streamline
    uint candidates;   // maximum number of strokes tried in a round
    uint block_bits;   // blocks have 2^block_bits pixels a side
    uint blocks;       // number of hole lists; they precede those of the front
    uint rounds_left;  // in [0, 4095], one less in every round
    uint stroke_room;
    uint point_room;
    uint list_room;
};

// A queue of places at which strokes are tried, exemplar::SeedQueue.
struct SeedQueueRecord {
    uint kind;    // source, and the layer from bit k_layer_shift on
    uint first;   // index of a stroke's first point, or x
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

// What is tried at a place of the round's list. Point i of its streamline is at (way_begin + i) % room in the ring
// of that place.
struct TrialRecord {
    int seed_x;
    int seed_y;
    int heading_x;
    int heading_y;
    uint state;
    uint claim;
    uint way_begin;
    uint way_count;
    uint begin;  // first point of the stroke, in the streamline
    uint count;
    uint listed;  // not of this trial: listed[i] over all trials are the places with a traced stroke, in any order
    uint target;  // index of the stroke's first point among those of all strokes
};
// Flags of a state, which also has the layer from bit k_layer_shift on.
const uint k_pending_trial = 1u;  // its list is not exhausted
const uint k_seeded_trial = 2u;   // its list has a place where a stroke may begin
const uint k_open_trial = 4u;     // and the stroke from there is long enough
const uint k_lost_trial = 8u;

// Counters that the device maintains by itself, and the arguments of indirect commands.
struct PlacementCounts {
    uint trials;     // in this round; 0: all strokes are placed
    uint in_blocks;  // 1 if the trials are of hole lists
    uint front;      // number of lists of the front
    uint strokes;
    uint points;
    uint full;         // flags of buffers too small for what this round would place: its end is to be repeated
    uint held_groups;  // candidate_groups[0] while `full` is set
    uint seed_groups[3];  // of seed.comp: on cards one for each trial, else one for k_hatch_group trials
    uint trial_groups[3];
    uint candidate_groups[3];  // trials with a traced stroke, and how many workgroups share the pixels of each
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
EXEMPLAR_LAYOUT(PlacementParameters, width, height, seed, test_share, hole_share, min_length_share, jitter,
                min_turn_cosine, near_shift, room, candidates, block_bits, blocks, rounds_left, stroke_room,
                point_room, list_room)
EXEMPLAR_LAYOUT(SeedQueueRecord, kind, first, second, next)
EXEMPLAR_LAYOUT(TrialRecord, seed_x, seed_y, heading_x, heading_y, state, claim, way_begin, way_count, begin, count,
                listed, target)
EXEMPLAR_LAYOUT(PlacementCounts, trials, in_blocks, front, strokes, points, full, held_groups, seed_groups,
                trial_groups, candidate_groups, place_groups)
EXEMPLAR_LAYOUT(StrokeRecord, first, count, layer, unused)
#endif

SHARED_END
#endif
