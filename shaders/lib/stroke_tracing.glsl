// Follows strokes from their seeds (host/hatching/stroke_tracing.cpp). The including shader declares `ways`, the points of
// the ways that are looked at: those of a trial in a ring of `room`, the seed first, one branch after it and the other before.
#ifndef EXEMPLAR_STROKE_TRACING_GLSL
#define EXEMPLAR_STROKE_TRACING_GLSL
#include "shaders/lib/clearance.glsl"
#include "shaders/lib/orientations.glsl"

const int k_far_turn = 2 * k_unit;
const int k_beside = 1050;

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
    uint end;
};

// What is looked at from one seed.
struct Way {
    uint first;  // point of its ring
    uint layer;
    ivec2 seed;
    uvec4 texel;  // that the seed is in
    int length_share;
    Branch on;
    Branch back;
};

uint ring_index(int from_seed) {
    return uint(from_seed < 0 ? from_seed + int(parameters.room) : from_seed);
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

bool is_near(ivec2 point, ivec2 other, int least) {
    const ivec2 way = (other - point) >> parameters.near_shift;
    // What is far along an axis is far, and its square may be too large.
    return max(abs(way.x), abs(way.y)) <= least && dot_of(way, way) < least * least;
}

// Whether a point comes too near to what the stroke has passed, beyond what it just did.
bool meets_itself(uint first, Branch branch, Branch other, ivec2 next, uvec4 texel) {
    const int test = share_of_spacing(spacing_of(texel), parameters.test_share);
    const int least = test >> parameters.near_shift, recent = 2 * test >> k_pixel_bits;
    bool met = false;
    for (int i = 0; i + recent < branch.reach; ++i)
        met = met || is_near(next, ways[first + ring_index(branch.sign * (i + 1))], least);
    for (int i = 0; i < other.reach; ++i)
        met = met || (i + branch.reach > recent && is_near(next, ways[first + ring_index(other.sign * (i + 1))], least));
    return met;
}

void take_step(uint first, uint layer, inout Branch branch, Branch other) {
    const ivec2 way = direction_at(layer, moved(branch.tip, branch.heading, k_step / 2), branch.heading);
    const ivec2 next = moved(branch.tip, way, k_step);
    const uvec4 texel = texel_of(next);
    if (way == ivec2(0) || direction_word(texel, layer) == 0u || !is_free_step(branch.tip, next) ||
        dot_of(way, branch.heading) < parameters.least_turn_cosine * k_unit) {
        branch.end = k_region_end;
        return;
    }
    branch.turn += cross_of(branch.heading, way) >> k_unit_bits;
    bool clear = is_clear(layer, next, spacing_of(texel), parameters.test_share);
    when (clear && abs(branch.turn - other.turn) > k_far_turn)
        clear = !meets_itself(first, branch, other, next, texel);
    if (!clear) {
        branch.end = k_crowd_end;
        return;
    }
    branch.tip = next;
    branch.heading = way;
    branch.reach += 1;
    ways[first + ring_index(branch.sign * branch.reach)] = next;
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
        while (branch.end == k_no_end) {
            const int target = target_steps(texel_of(branch.tip), way.length_share) * share >> k_share_bits;
            if (leg < 3 ? branch.reach + other.reach >= target : branch.reach == most)
                branch.end = k_length_end;
            else
                take_step(way.first, way.layer, branch, other);
        }
        if (leg < 3) branch.steps = branch.reach;
        if (is_back)
            way.back = branch;
        else
            way.on = branch;
    }
}

// 1 if no stroke passes beside a place of the way, or it is not known.
int is_in_line(Way way, int place) {
    if (place < 0 || place > way.on.reach + way.back.reach) return 1;
    const ivec2 point = ways[way.first + ring_index(place - way.back.reach)];
    return is_clear(way.layer, point, spacing_of(texel_of(point)), k_beside) ? 1 : 0;
}

// A part of the way, begin and end in steps, or it moved by up to two gaps either way, or shortened by as much at its free
// end: the first of which the fewest free ends have their gap beside that of another stroke.
ivec2 out_of_line(Way way, ivec2 part, ivec2 move) {
    const int gap = gap_steps(way.texel), steps = part.y - part.x, all = way.on.reach + way.back.reach;
    ivec2 best = part;
    int least = 3;
    for (int i = 0; i < 5; ++i) {
        const int shift = ((i + 1) / 2) * (i % 2 == 0 ? -gap : gap);
        const ivec2 shifted = part + shift * move;
        const int left = shifted.y - shifted.x;
        if (shifted.x < 0 || shifted.y > all || left > steps || 4 * left < 3 * steps) continue;
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
    const int steps = way.on.steps + way.back.steps, all = way.on.reach + way.back.reach;
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
