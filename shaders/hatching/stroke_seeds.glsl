// The places at which strokes are tried (host/hatching/placement/stroke_front.cpp). The including shader declares
// `stroke_points`, the points of all strokes, two words each.
#ifndef EXEMPLAR_STROKE_SEEDS_GLSL
#define EXEMPLAR_STROKE_SEEDS_GLSL
#include "shaders/hatching/clearance.glsl"
#include "shaders/hatching/orientations.glsl"

const int k_side_cosine = 11585;
const uint k_side_stride = 2;
const uint k_part_places = 64;

uint source_of(SeedQueueRecord list) {
    return list.kind & k_source_mask;
}
bool is_side(uint source) {
    return source == k_left_side_source || source == k_right_side_source;
}
uint sides_of(SeedQueueRecord list) {
    return (list.second + k_side_stride - 1u) / k_side_stride;
}
int bits_of(uint count) {
    return findMSB(count - 1u) + 1;
}
uint reversed_bits(uint word, int count) {
    return mix(0u, bitfieldReverse(word) >> (32 - max(count, 1)), count > 0);
}
uint every_second_bit(uint word) {
    word &= 0x55555555u;
    word = (word | word >> 1) & 0x33333333u;
    word = (word | word >> 2) & 0x0f0f0f0fu;
    word = (word | word >> 4) & 0x00ff00ffu;
    return (word | word >> 8) & 0x0000ffffu;
}

// Returns the number of places of a list.
uint seed_count(SeedQueueRecord list) {
    const uint source = source_of(list);
    if (is_side(source)) return 1u << bits_of(sides_of(list));
    if (source == k_block_source) return 1u << (2u * parameters.block_bits);
    return source == k_part_source ? k_part_places : 1u;
}

ivec2 stroke_point(uint i) {
    return ivec2(texelFetch(stroke_points, int(2u * i)).x, texelFetch(stroke_points, int(2u * i + 1u)).x);
}
// Returns the offset by a spacing along a direction.
ivec2 times(ivec2 direction, int spacing) {
    const int shift = k_unit_bits - k_pixel_bits + k_spacing_bits;
    return (direction * spacing + (1 << (shift - 1))) >> shift;
}

// A place and a direction. `parallel`: strokes there must run in about that direction; else it only chooses their
// sign.
struct Place {
    ivec2 point;
    ivec2 heading;
    bool parallel;
    bool valid;
};

Place side_place(SeedQueueRecord list, uint i) {
    const uint sides = sides_of(list), place = reversed_bits(i, bits_of(sides));
    const uint chance = scatter(list.first ^ parameters.seed);
    const uint j = k_side_stride * ((place + chance % sides) % sides);
    const ivec2 point = stroke_point(list.first + j);
    const ivec2 heading = direction_of(stroke_point(list.first + min(j + 1u, list.second - 1u)) -
                                       stroke_point(list.first + (j == 0u ? 0u : j - 1u)));
    const ivec2 off = source_of(list) == k_left_side_source ? ivec2(heading.y, -heading.x) : ivec2(-heading.y, heading.x);
    const int here = spacing_of(texel_of(point));
    const uvec4 there = texel_of(point + times(off, here));
    const bool valid = place < sides && direction_word(there, list.kind >> k_layer_shift) != 0u;
    return Place(point + times(off, (here + spacing_of(there)) / 2), heading, true, valid);
}

Place end_place(SeedQueueRecord list) {
    const bool is_first = source_of(list) == k_first_end_source;
    const uint tip = is_first ? list.first : list.first + list.second - 1u;
    const ivec2 point = stroke_point(tip), heading = direction_of(point - stroke_point(is_first ? tip + 1u : tip - 1u));
    const int spacing = spacing_of(texel_of(point));
    const int gap = (spacing * parameters.test_share >> k_share_bits) + (1 << (k_spacing_bits - 1));
    return Place(point + times(heading, gap), heading, true, true);
}

Place hole_place(SeedQueueRecord list, uint i) {
    const int bits = int(2u * parameters.block_bits);
    const uint chance = scatter(list.first ^ scatter(list.second ^ parameters.seed));
    const uint place = reversed_bits(i, bits) ^ (chance & ((1u << bits) - 1u));
    const ivec2 pixel = ivec2(list.first + every_second_bit(place), list.second + every_second_bit(place >> 1));
    return Place(pixel * k_pixel + k_pixel / 2, ivec2(k_unit, 0), false, true);
}

Place part_place(SeedQueueRecord list, uint i) {
    const ivec2 middle = ivec2(list.first, list.second);
    const uint chance = scatter(list.first ^ scatter(list.second ^ scatter(parameters.seed ^ i)));
    const int size = int(i) * (spacing_of(texel_of(middle)) << (k_pixel_bits - k_spacing_bits));
    const ivec2 off = size / 512 * (ivec2(chance & 511u, chance >> 9 & 511u) - 256);
    return Place(middle + off, ivec2(k_unit, 0), false, true);
}

Place place_of(SeedQueueRecord list, uint i) {
    const uint source = source_of(list);
    Place place = Place(ivec2(0), ivec2(0), false, false);
    if (is_side(source)) place = side_place(list, i);
    if (source == k_first_end_source || source == k_last_end_source) place = end_place(list);
    if (source == k_block_source) place = hole_place(list, i);
    if (source == k_part_source) place = part_place(list, i);
    return place;
}

// Returns whether a stroke may begin at the i-th place of a list, with the place and the direction of strokes there.
bool seed_at(SeedQueueRecord list, uint i, out ivec2 point, out ivec2 way) {
    const uint layer = list.kind >> k_layer_shift;
    const Place place = place_of(list, i);
    const uvec4 texel = texel_of(place.point);
    const int share = source_of(list) == k_block_source ? parameters.hole_share : parameters.test_share;
    point = place.point;
    way = ivec2(0);
    bool clear = place.valid && direction_word(texel, layer) != 0u;
    if (clear) clear = is_clear(layer, place.point, spacing_of(texel), share);
    if (clear) way = direction_at(layer, place.point, place.heading);
    return way != ivec2(0) && (!place.parallel || dot_of(way, place.heading) >= k_side_cosine * k_unit);
}

#endif
