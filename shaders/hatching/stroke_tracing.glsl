// Traces a stroke from its seed (host/hatching/placement/streamline_steps.cpp, stroke_tracing.cpp), one stroke per
// invocation. Its state is in global variables: D9 in docs/portability.md. The including shader declares `ways`, the
// points of all streamlines: each trial has a ring of `room` points that starts with the seed; one side follows it,
// and the other side precedes it.
#ifndef EXEMPLAR_STROKE_TRACING_GLSL
#define EXEMPLAR_STROKE_TRACING_GLSL
#include "shaders/hatching/clearance.glsl"
#include "shaders/hatching/orientations.glsl"

const int k_far_turn = 2 * k_unit;
const int k_itself_bits = 8;
const int k_max_pieces = 32;
const int k_far_from_itself = 1 << 20;
const int k_beside_stroke = 1032;
const int k_beside_gap = 1250;

const uint k_no_end = 0u;
const uint k_length_end = 1u;
const uint k_region_end = 2u;
const uint k_crowd_end = 3u;

// One side of a stroke, from the seed on.
struct Branch {
    ivec2 tip;
    ivec2 heading;
    int sign;   // +1 or -1: direction in which its places count from the seed
    int reach;  // number of points without the seed
    int steps;  // within its length; the rest is look-ahead
    int turn;   // sum of the sines of its turns
    int unchecked_steps;  // steps for which it cannot meet itself
    uint end;
};

// The streamline: the side that is traced or was last, and the other one.
Branch branch, other;
uint way_first;    // first point of its ring
uint way_layer;
uvec4 way_texel;   // that contains the seed
int length_share;  // length of the stroke as a share of its target
ivec2 turns;       // minimum and maximum of Branch::turn so far, on both sides

uint ring_index(int from_seed) {
    return way_first + uint(mix(from_seed, from_seed + int(parameters.room), from_seed < 0));
}
int back_reach() {
    return mix(other.reach, branch.reach, branch.sign < 0);
}
// Returns the last place. Places count steps from the end of one side to that of the other, starting at 0.
int last_place() {
    return branch.reach + other.reach;
}
int target_steps(uvec4 texel, int share) {
    return length_of(texel) * share >> (k_share_bits + k_length_bits);
}
int min_stroke_steps(int crowded_ends) {
    const int by_length = target_steps(way_texel, parameters.min_length_share);
    return max(min(by_length, (1 + crowded_ends) * spacing_of(way_texel) >> k_spacing_bits), k_min_steps);
}
int gap_steps() {
    return (share_of_spacing(spacing_of(way_texel), parameters.test_share) >> k_pixel_bits) + 1;
}

int length_of_way(ivec2 way) {
    return int(floor_sqrt(uint(dot_of(way, way))));
}
// Returns the distance of a point to the segment between two others, in units of 2^k_itself_bits.
int distance_to_line(ivec2 point, ivec2 from, ivec2 to) {
    const ivec2 line = (to - from) >> k_itself_bits, begin = (point - from) >> k_itself_bits;
    const int along = dot_of(begin, line);
    const bool on_line = all(bvec2(along > 0, along < dot_of(line, line)));
    const ivec2 end = mix((point - to) >> k_itself_bits, begin, bvec2(along <= 0));
    const int size = length_of_way(mix(end, line, bvec2(on_line)));
    return mix(size, int(quotient(uint(abs(cross_of(begin, line))), uint(max(size, 1)))), on_line);
}

// Returns whether a point is within the test distance of the stroke itself, except the last two test distances
// before the point. For far pieces a lower bound of the distance is used.
bool meets_itself(ivec2 next, uvec4 texel) {
    const bool far_turned = max(branch.turn - turns.x, turns.y - branch.turn) > k_far_turn;
    const int test = share_of_spacing(spacing_of(texel), parameters.test_share);
    const int begin = -other.reach, last = branch.reach - (2 * test >> k_pixel_bits);
    const int stride = 1 + max(last - begin, 0) / k_max_pieces, end = mix(begin, last, all(bvec2(branch.unchecked_steps == 0, far_turned)));
    int nearest = k_far_from_itself;
    for (int i = begin; i < end; i += stride) {
        const ivec2 from = ways[ring_index(branch.sign * i)], to = ways[ring_index(branch.sign * min(i + stride, end))];
        const ivec2 off = abs(next - from);
        const int afar = (max(off.x, off.y) - stride * k_pixel) >> k_itself_bits;
        nearest = min(nearest, mix(distance_to_line(next, from, to), afar, afar > 2 * test >> k_itself_bits));
    }
    const int beyond = nearest - (test >> k_itself_bits);
    const int unchecked_steps = mix(0, beyond >> (k_pixel_bits - k_itself_bits), far_turned);
    branch.unchecked_steps = mix(unchecked_steps, branch.unchecked_steps - 1, branch.unchecked_steps > 0);
    return beyond < 0;
}

void take_step() {
    const ivec2 middle = moved(branch.tip, branch.heading, k_step / 2);
    const ivec2 heading = direction_at(way_layer, middle, branch.heading);
    const ivec2 next = moved(branch.tip, heading, k_step);
    const uvec4 texel = texel_of(next);
    const bool is_straight = dot_of(heading, branch.heading) >= parameters.min_turn_cosine * k_unit;
    const bool free = all(bvec4(heading != ivec2(0), direction_word(texel, way_layer) != 0u, is_straight,
                                is_free_step(branch.tip, next)));
    branch.turn += int(free) * (cross_of(branch.heading, heading) >> k_unit_bits);
    bool clear = all(bvec2(free, is_clear(way_layer, next, spacing_of(texel), parameters.test_share)));
    if (clear) clear = !meets_itself(next, texel);
    if (clear) {
        turns = ivec2(min(turns.x, branch.turn), max(turns.y, branch.turn));
        branch.tip = next;
        branch.heading = heading;
        branch.reach += 1;
        ways[ring_index(branch.sign * branch.reach)] = next;
    } else {
        branch.end = free ? k_crowd_end : k_region_end;
    }
}

// Ends a leg of the trace and begins the next one, on the other side or the same.
void turn_to_leg(int leg) {
    if (leg <= 3) branch.steps = branch.reach;
    if (leg == 1 || leg == 2 || leg == 4) {
        const Branch swapped = branch;
        branch = other;
        other = swapped;
    }
    if (leg < 2 || branch.end == k_length_end) branch.end = k_no_end;
    branch.unchecked_steps = 0;
}

// Traces in five legs: forward to a share of the length, backward to all of it, forward again if that ended early,
// and then the look-ahead at both ends.
void walk(int first_share) {
    const int ahead = gap_steps() + min_stroke_steps(2);
    int leg = 0;
    while (leg < 5) {
        const int share = leg == 0 ? first_share : 1 << k_share_bits;
        const int target = target_steps(texel_of(branch.tip), length_share) * share >> k_share_bits;
        const bool done = leg < 3 ? last_place() >= target : branch.reach == branch.steps + ahead;
        if (branch.end == k_no_end && done) branch.end = k_length_end;
        if (branch.end == k_no_end) {
            take_step();
        } else {
            ++leg;
            if (leg < 5) turn_to_leg(leg);
        }
    }
}

// Returns 1 if a place of the streamline is beside the gap at the end of another stroke, or outside of the
// streamline.
int is_in_line(int place) {
    const bool known = place == clamp(place, 0, last_place());
    const ivec2 point = ways[ring_index(mix(0, place - back_reach(), known))];
    const int spacing = spacing_of(texel_of(point));
    const uint squared = squared_distance(way_layer, point);
    const uint least = uint(share_of_spacing(spacing, k_beside_stroke) >> parameters.near_shift);
    const uint most = uint(share_of_spacing(spacing, k_beside_gap) >> parameters.near_shift);
    return int(any(bvec2(!known, all(bvec2(squared >= least * least, squared < most * most)))));
}

// Avoids gaps side by side. Tries the part (its begin and end in steps) as it is and with its ends moved by one and
// two gaps either way, where `move` tells how each end moves (both: shifted; one: shortened). Returns the first one
// whose free ends have the fewest gaps beside the gap of another stroke.
ivec2 out_of_line(ivec2 part, ivec2 move) {
    const int gap = gap_steps(), steps = part.y - part.x;
    ivec2 best = part;
    int least = 3;
    for (int i = 0; i < 5; ++i) {
        const int shift = ((i + 1) / 2) * (i % 2 == 0 ? -gap : gap);
        const ivec2 shifted = part + shift * move;
        const int left = shifted.y - shifted.x;
        const bool valid =
            all(bvec4(shifted.x >= 0, shifted.y <= last_place(), left <= steps, 4 * left >= 3 * steps));
        int in_line = mix(3, 0, valid);
        if (move.x != 0) in_line += is_in_line(shifted.x - gap / 2);
        if (move.y != 0) in_line += is_in_line(shifted.y + gap / 2);
        if (in_line < least) best = shifted;
        least = min(least, in_line);
    }
    return best;
}

// Returns the part of the streamline that becomes the stroke. Tracing ends on the backward side, so `other` is the
// forward one.
ivec2 fitted() {
    const int steps = branch.steps + other.steps, all = last_place();
    const bool on_is_free = other.end == k_length_end, back_is_free = branch.end == k_length_end;
    ivec2 part = ivec2(0, all), move = ivec2(back_is_free, on_is_free);
    if (on_is_free && back_is_free) {
        part = branch.reach + ivec2(-branch.steps, other.steps);
    } else if (on_is_free) {
        part = ivec2(0, steps);
        move = ivec2(0, -1);
    } else if (back_is_free) {
        part = ivec2(all - steps, all);
    }
    if (on_is_free || back_is_free) return out_of_line(part, move);
    if (all <= target_steps(way_texel, (1 << k_share_bits) + parameters.jitter)) return part;
    const int half_steps = min(all, max((all - gap_steps()) / 2, min_stroke_steps(2)));
    return other.steps == other.reach ? ivec2(all - half_steps, all) : ivec2(0, half_steps);
}

// Traces the stroke of a layer from a seed into `ways`, from `first` on. Returns whether it is long enough, and
// which part of its streamline it is.
bool trace(uint first, uint layer, ivec2 seed, ivec2 heading, out ivec2 part) {
    way_first = first;
    way_layer = layer;
    way_texel = texel_of(seed);
    turns = ivec2(0);
    branch = Branch(seed, heading, 1, 0, 0, 0, 0, k_no_end);
    other = Branch(seed, -heading, -1, 0, 0, 0, 0, k_no_end);
    ways[first] = seed;
    const uint chance = scatter(uint(seed.x) ^ scatter(uint(seed.y) ^ scatter(parameters.seed + layer)));
    length_share = (1 << k_share_bits) + ((int(chance & 2047u) - 1024) * parameters.jitter >> k_share_bits);
    walk(256 + int(chance >> 11 & 511u));
    part = fitted();
    const int crowded = (branch.end == k_crowd_end ? 1 : 0) + (other.end == k_crowd_end ? 1 : 0);
    return part.y - part.x >= min_stroke_steps(crowded);
}

// Returns 0 if a stroke has three quarters of its target length or more; up to 3.
uint shortness(int steps) {
    return uint(3 - clamp(4 * steps / max(target_steps(way_texel, length_share), 1), 0, 3));
}

#endif
