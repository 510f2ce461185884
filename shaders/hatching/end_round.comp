#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/hatching.h"

// Ends a round: assigns storage to the strokes that won, removes exhausted lists from the front, appends the lists
// of the new strokes, and sets up the next round (host/hatching/placement/streamlines.cpp). A single workgroup:
// reads and writes some 50 bytes for each trial and each list of the front.
layout(local_size_x = k_end_round_group) in;
layout(push_constant) uniform Push { PlacementParameters parameters; };
layout(set = 0, binding = 0, std430) coherent buffer Lists { SeedQueueRecord lists[]; };
layout(set = 0, binding = 1, std430) coherent buffer Trials { TrialRecord trials[]; };
layout(set = 0, binding = 2, std430) coherent buffer Counts { PlacementCounts counts; };
layout(set = 0, binding = 3, std430) writeonly buffer Strokes { StrokeRecord strokes[]; };
#include "shaders/lib/group_scan.glsl"

// Counts over the front at the end of a round.
struct Round {
    uint won;      // strokes
    uint points;   // points of the won strokes
    uint kept;     // lists that stay in the front
    uint waiting;  // tried lists that are not exhausted
};

shared Round all;

// Counters as the round left them.
uint trial_count, front_count;
bool in_blocks;

// What became of the i-th list of the front or, if holes were tried, of the i-th trial.
struct Outcome {
    bool won;
    bool kept;
    bool waiting;
};

bool is_win(uint state) {
    return (state & (k_open_trial | k_lost_trial)) == k_open_trial;
}

// Lists that were not tried stay; a part leaves the front when it has a stroke.
Outcome outcome(uint i) {
    const bool tried = i < trial_count;
    const uint state = tried ? trials[i].state : 0u;
    const bool won = is_win(state), waiting = (state & k_pending_trial) != 0u;
    bool kept = !in_blocks && i < front_count && (waiting || !tried);
    if (kept && won) kept = (lists[parameters.blocks + i].kind & k_source_mask) != k_part_source;
    return Outcome(won, kept, waiting);
}

Round measured(uint items) {
    Round own = Round(0u, 0u, 0u, 0u);
    for (uint i = gl_LocalInvocationID.x; i < items; i += k_end_round_group) {
        const Outcome result = outcome(i);
        if (result.won) {
            own.won += 1u;
            own.points += trials[i].count;
        }
        own.kept += uint(result.kept);
        own.waiting += uint(result.waiting);
    }
    if (gl_LocalInvocationID.x == 0u) all = Round(0u, 0u, 0u, 0u);
    barrier();
    if (own.won != 0u) atomicAdd(all.won, own.won);
    if (own.points != 0u) atomicAdd(all.points, own.points);
    if (own.kept != 0u) atomicAdd(all.kept, own.kept);
    if (own.waiting != 0u) atomicAdd(all.waiting, own.waiting);
    barrier();
    return all;
}

// Compacts the lists that stay, in their order, and assigns strokes their storage, in the order of the trials.
void compact(uint items) {
    Round before = Round(counts.strokes, counts.points, parameters.blocks, 0u);
    for (uint begin = 0; begin < items; begin += k_end_round_group) {
        const uint i = begin + gl_LocalInvocationID.x;
        const Outcome result = outcome(i);
        const bool won = result.won, kept = result.kept;
        SeedQueueRecord list = SeedQueueRecord(0u, 0u, 0u, 0u);
        if (kept) list = lists[parameters.blocks + i];
        // Where strokes are a pixel apart, the clearance map may miss a stroke at its own seed: it would be placed
        // again forever.
        if (won) ++list.next;
        if (won && in_blocks) ++lists[i].next;
        const uint count = won ? trials[i].count : 0u;
        // Won and kept ones are below 2^16.
        const uvec2 sums = exclusive_sums(uvec2((won ? 1u : 0u) | (kept ? 1u << 16 : 0u), count));
        const uint counted = sums.x, total = group_totals.x, first = before.points + sums.y, points = group_totals.y;
        memoryBarrierBuffer();
        barrier();
        if (kept) lists[before.kept + (counted >> 16)] = list;
        if (won) {
            const uint stroke = before.won + (counted & 0xffffu);
            trials[i].target = first;
            trials[i].claim = stroke;
            strokes[stroke] = StrokeRecord(first, count, trials[i].state >> k_layer_shift, 0u);
        }
        before.won += total & 0xffffu;
        before.kept += total >> 16;
        before.points += points;
        memoryBarrierBuffer();
        barrier();
    }
}

// Appends the lists of the new strokes' sides and ends to the lists that stay.
void extend(uint kept) {
    for (uint i = gl_LocalInvocationID.x; i < trial_count; i += k_end_round_group) {
        const uint state = trials[i].state;
        if (!is_win(state)) continue;
        const uint target = parameters.blocks + kept + 4u * (trials[i].claim - counts.strokes);
        const uint layer = state & ~((1u << k_layer_shift) - 1u);
        for (uint source = k_left_side_source; source <= k_last_end_source; ++source)
            lists[target + source - k_left_side_source] = SeedQueueRecord(layer | source, trials[i].target, trials[i].count, 0u);
    }
}

uint missing_room(Round round) {
    uint full = 0u;
    if (counts.strokes + round.won > parameters.stroke_room) full |= k_full_strokes;
    if (counts.points + round.points > parameters.point_room) full |= k_full_points;
    if (parameters.blocks + round.kept + 4u * round.won > parameters.list_room) full |= k_full_lists;
    return full;
}

void set_groups(uint placing) {
    counts.trial_groups[0] = (counts.trials + k_hatch_group - 1u) / k_hatch_group;
#ifdef EXEMPLAR_CPU
    counts.seed_groups[0] = counts.trial_groups[0];
#else
    counts.seed_groups[0] = counts.trials;
#endif
    counts.candidate_groups[0] = 0u;
    counts.place_groups[0] = placing;
}

// Sets up the next round: the front or, if it is empty, the holes, as long as there are some.
void set_up_next_round(Round round, uint placing) {
    counts.strokes += round.won;
    counts.points += round.points;
    counts.front = round.kept + 4u * round.won;
    const bool done = counts.in_blocks != 0u && round.waiting == 0u;
    counts.in_blocks = counts.front == 0u ? 1u : 0u;
    counts.trials = counts.front != 0u ? min(counts.front, parameters.candidates) : done ? 0u : parameters.blocks;
    set_groups(placing);
    counts.place_groups[1] = counts.candidate_groups[1];
    counts.candidate_groups[1] = 1u;
}

void main() {
    const uint placing = counts.candidate_groups[0];
    trial_count = counts.trials;
    front_count = counts.front;
    in_blocks = counts.in_blocks != 0u;
    if (trial_count == 0u || counts.full != 0u) return;

    const uint items = in_blocks ? trial_count : front_count;
    const Round round = measured(items);
    const uint full = missing_room(round);
    if (full == 0u) {
        compact(items);
        extend(round.kept);
    }
    memoryBarrierBuffer();
    barrier();
    if (gl_LocalInvocationID.x != 0u) return;
    if (full == 0u) {
        set_up_next_round(round, placing);
    } else {
        counts.full = full;
        counts.held_groups = placing;
        set_groups(0u);
        counts.trial_groups[0] = 0u;
        counts.seed_groups[0] = 0u;
    }
}
