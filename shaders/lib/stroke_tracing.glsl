// Follows strokes from their seeds (host/hatching/stroke_tracing.cpp). The including shader declares `ways`, the points of
// the ways that are looked at: those of a trial in a ring of `room`, the seed first, one branch after it and the other before.
#ifndef EXEMPLAR_STROKE_TRACING_GLSL
#define EXEMPLAR_STROKE_TRACING_GLSL
#include "shaders/lib/clearance.glsl"
#include "shaders/lib/orientations.glsl"

const int k_far_turn = 2 * k_unit;
const int k_itself_bits = 8;
const int k_most_pieces = 32;
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
    int sign;   // of its places, counted from the seed
    int reach;  // points without the seed
    int steps;  // that it would have by its length
    int turn;   // the sum of the sines of its turns
    int quiet;  // steps in which it cannot come back to itself
    uint end;
};

// What is looked at from one seed.
struct Way {
    uint first;  // point of its ring
    uint layer;
    ivec2 seed;
    uvec4 texel;  // that the seed is in
    int length_share;
    ivec2 turns;  // the least and the most of all steps so far, from the seed on
    int work;     // steps and other pieces of work that it took
    Branch on;
    Branch back;
};

ivec2 point_from_seed(uint first, int i) {
    return ways[first + uint(i < 0 ? i + int(parameters.room) : i)];
}
// Places are counted in steps, from the end of one side to that of the other.
ivec2 point_at(Way way, int place) {
    return point_from_seed(way.first, place - way.back.reach);
}
int last_of(Way way) {
    return way.on.reach + way.back.reach;
}
int target_steps(uvec4 texel, int share) {
    return length_of(texel) * share >> (k_share_bits + k_length_bits);
}
int least_steps(uvec4 texel, int crowded_ends) {
    const int by_length = target_steps(texel, parameters.least_share);
    return max(min(by_length, (1 + crowded_ends) * spacing_of(texel) >> k_spacing_bits), k_least_steps);
}
int gap_steps(uvec4 texel) {
    return (share_of_spacing(spacing_of(texel), parameters.test_share) >> k_pixel_bits) + 1;
}

int length_of_way(ivec2 way) {
    return int(floor_sqrt(uint(dot_of(way, way))));
}
// From a point to the line between two others, in units of 2^k_itself_bits.
int distance_to_line(ivec2 point, ivec2 from, ivec2 to) {
    const ivec2 line = (to - from) >> k_itself_bits, begin = (point - from) >> k_itself_bits;
    const int along = dot_of(begin, line);
    const bool before = along <= 0, beyond = along >= dot_of(line, line);
    if (before || beyond) return length_of_way(before ? begin : (point - to) >> k_itself_bits);
    return abs(cross_of(begin, line)) / length_of_way(line);
}

// How far a point is from the stroke but for the last two test distances before it; or from afar, less than that.
int distance_to_itself(Way way, Branch branch, Branch other, ivec2 next, int test, inout int work) {
    const int begin = -other.reach, end = branch.reach - (2 * test >> k_pixel_bits);
    const int stride = 1 + max(end - begin, 0) / k_most_pieces;
    int nearest = k_far_from_itself;
    for (int i = begin; i < end; i += stride) {
        const ivec2 from = point_from_seed(way.first, branch.sign * i), off = abs(next - from);
        const ivec2 to = point_from_seed(way.first, branch.sign * min(i + stride, end));
        const int afar = (max(off.x, off.y) - stride * k_pixel) >> k_itself_bits;
        const bool is_far = afar > 2 * test >> k_itself_bits;
        nearest = min(nearest, is_far ? afar : distance_to_line(next, from, to));
        ++work;
    }
    return nearest;
}

// Whether a point comes nearer than the test distance to what the stroke has passed, beyond what it just did.
bool meets_itself(inout Way way, inout Branch branch, Branch other, ivec2 next, uvec4 texel) {
    bool met = false;
    const bool far_turned = max(branch.turn - way.turns.x, way.turns.y - branch.turn) > k_far_turn;
    when (branch.quiet == 0 && far_turned) {
        const int test = share_of_spacing(spacing_of(texel), parameters.test_share);
        const int beyond = distance_to_itself(way, branch, other, next, test, way.work) - (test >> k_itself_bits);
        branch.quiet = max(beyond >> (k_pixel_bits - k_itself_bits), 0) + 1;
        met = beyond < 0;
    }
    branch.quiet = max(branch.quiet - 1, 0);
    return met;
}

void take_step(inout Way way, inout Branch branch, Branch other) {
    const ivec2 middle = moved(branch.tip, branch.heading, k_step / 2);
    const ivec2 heading = direction_at(way.layer, middle, branch.heading);
    const ivec2 next = moved(branch.tip, heading, k_step);
    const uvec4 texel = texel_of(next);
    if (heading == ivec2(0) || direction_word(texel, way.layer) == 0u || !is_free_step(branch.tip, next) ||
        dot_of(heading, branch.heading) < parameters.least_turn_cosine * k_unit) {
        branch.end = k_region_end;
        return;
    }
    branch.turn += cross_of(branch.heading, heading) >> k_unit_bits;
    bool clear = is_clear(way.layer, next, spacing_of(texel), parameters.test_share);
    when (clear) clear = !meets_itself(way, branch, other, next, texel);
    if (!clear) {
        branch.end = k_crowd_end;
        return;
    }
    way.turns = ivec2(min(way.turns.x, branch.turn), max(way.turns.y, branch.turn));
    branch.tip = next;
    branch.heading = heading;
    branch.reach += 1;
    const int place = branch.sign * branch.reach;
    ways[way.first + uint(place < 0 ? place + int(parameters.room) : place)] = next;
}

// Walks in five legs: on to a share of the length, back to all of it, and where that ended early on; then ahead of both ends.
void walk(inout Way way, int first_share) {
    const int ahead = gap_steps(way.texel) + least_steps(way.texel, 2);
    for (int leg = 0; leg < 5; ++leg) {
        const bool is_back = leg == 1 || leg == 4;
        Branch branch = way.on, other = way.back;
        if (is_back) {
            branch = way.back;
            other = way.on;
        }
        if (leg >= 2 && branch.end != k_length_end) continue;
        const int share = leg == 0 ? first_share : 1 << k_share_bits, most = branch.steps + ahead;
        branch.end = k_no_end;
        branch.quiet = 0;
        while (branch.end == k_no_end) {
            const int target = target_steps(texel_of(branch.tip), way.length_share) * share >> k_share_bits;
            if (leg < 3 ? branch.reach + other.reach >= target : branch.reach == most)
                branch.end = k_length_end;
            else
                take_step(way, branch, other);
        }
        if (leg < 3) branch.steps = branch.reach;
        if (is_back)
            way.back = branch;
        else
            way.on = branch;
    }
    way.work += last_of(way);
}

// 1 if a place of the way is beside the gap at the end of a stroke, or that is not known.
int is_in_line(Way way, int place) {
    if (place < 0 || place > last_of(way)) return 1;
    const ivec2 point = point_at(way, place);
    const int spacing = spacing_of(texel_of(point));
    return is_clear(way.layer, point, spacing, k_beside_stroke) && !is_clear(way.layer, point, spacing, k_beside_gap) ? 1
                                                                                                                    : 0;
}

// A part of the way, begin and end in steps, or it moved by up to two gaps either way, or shortened by as much at its free
// end: the first of which the fewest free ends have their gap beside that of another stroke.
ivec2 out_of_line(Way way, ivec2 part, ivec2 move) {
    const int gap = gap_steps(way.texel), steps = part.y - part.x;
    ivec2 best = part;
    int least = 3;
    for (int i = 0; i < 5; ++i) {
        const int shift = ((i + 1) / 2) * (i % 2 == 0 ? -gap : gap);
        const ivec2 shifted = part + shift * move;
        const int left = shifted.y - shifted.x;
        if (shifted.x < 0 || shifted.y > last_of(way) || left > steps || 4 * left < 3 * steps) continue;
        int in_line = 0;
        if (move.x != 0) in_line += is_in_line(way, shifted.x - gap / 2);
        if (move.y != 0) in_line += is_in_line(way, shifted.y + gap / 2);
        if (in_line >= least) continue;
        least = in_line;
        best = shifted;
    }
    return best;
}

// The part of the way that becomes the stroke.
ivec2 fitted(Way way) {
    const int steps = way.on.steps + way.back.steps, all = last_of(way);
    const bool on_is_free = way.on.end == k_length_end, back_is_free = way.back.end == k_length_end;
    ivec2 part = ivec2(0, all), move = ivec2(back_is_free, on_is_free);
    if (on_is_free && back_is_free)
        part = ivec2(way.back.reach - way.back.steps, way.back.reach + way.on.steps);
    else if (on_is_free)
        part = ivec2(0, steps), move = ivec2(0, -1);
    else if (back_is_free)
        part = ivec2(all - steps, all);
    if (on_is_free || back_is_free) return out_of_line(way, part, move);
    if (all <= target_steps(way.texel, (1 << k_share_bits) + parameters.jitter)) return part;
    const int half_steps = max((all - gap_steps(way.texel)) / 2, least_steps(way.texel, 2));
    return way.on.steps == way.on.reach ? ivec2(all - half_steps, all) : ivec2(0, half_steps);
}

// Follows the stroke from a seed; whether it is long enough, and which part of its way it is.
bool trace(inout Way way, out ivec2 part) {
    const uint chance = scatter(uint(way.seed.x) ^ scatter(uint(way.seed.y) ^ scatter(parameters.seed + way.layer)));
    way.length_share = (1 << k_share_bits) + ((int(chance & 2047u) - 1024) * parameters.jitter >> k_share_bits);
    ways[way.first] = way.seed;
    walk(way, 256 + int(chance >> 11 & 511u));
    part = fitted(way);
    const int crowded = (way.on.end == k_crowd_end ? 1 : 0) + (way.back.end == k_crowd_end ? 1 : 0);
    return part.y - part.x >= least_steps(way.texel, crowded);
}

// 0 if a stroke has three quarters of its target length or more; up to 3.
uint shortness(Way way, int steps) {
    return uint(3 - clamp(4 * steps / max(target_steps(way.texel, way.length_share), 1), 0, 3));
}

#endif
