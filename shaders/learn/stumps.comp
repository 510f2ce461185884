#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/loops.glsl"
#include "shaders/lib/tables.glsl"
#include "shaders/shared/stumps.h"

// Computes the probabilities of boosted stumps (thesis Eq. 2.64 to 2.66), for k_quads x 4 items per invocation.
// Stumps are grouped by the set of classes that share them. A group is summed once and then added to its classes, so
// the cost of a stump does not depend on the number of classes. Features are floats, or 16- or 8-bit ranks among the
// classifier's thresholds (k_bits): comparisons give the same result, and a texel holds two or four times as many.
// They are read as texels (D4 in docs/portability.md) or from a storage buffer (k_from_storage).
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(constant_id = 0) const uint k_classes = 1;
layout(constant_id = 1) const uint k_quads = 1;  // a multiple of k_quads_of_texel
layout(constant_id = 2) const bool k_from_storage = false;
layout(constant_id = 3) const uint k_bits = 32;
// If true, several dispatches add a part of the groups each, and keep H in `probabilities` between them.
layout(constant_id = 4) const bool k_in_parts = false;
layout(push_constant) uniform Push { StumpParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer features;  // columns x stride; see k_quads_of_texel
layout(set = 0, binding = 1) uvec4_table(Stumps, stumps);      // GroupedStump; uints: D14 in docs/portability.md
layout(set = 0, binding = 2) uvec4_table(Groups, groups);      // StumpGroup
layout(set = 0, binding = 3) uniform samplerBuffer constants;
layout(set = 0, binding = 4, std430) buffer Probabilities { float probabilities[]; };

#ifdef EXEMPLAR_CPU
// A texel is four words, with one, two or four quads.
layout(set = 0, binding = 5, std430) readonly buffer StoredFeatures { uvec4 stored_features[]; };  // the same as `features`
const uint k_quads_of_texel = 32 / k_bits;
uvec4 fetch_features(uint index) {
    return k_from_storage ? stored_features[index] : texelFetch(features, int(index));
}
uint column_texels() { return parameters.stride; }
#else
// Invocations read one quad each: a texel of four floats, two of two ranks, or one of four ranks.
layout(set = 0, binding = 5, std430) readonly buffer StoredFeatures { uint stored_features[]; };  // the same as `features`
const uint k_quads_of_texel = 1;
uint rank_word(uint index) { return k_from_storage ? stored_features[index] : texelFetch(features, int(index)).x; }
uvec4 fetch_features(uint quad) {
    if (k_bits == 8) return uvec4(rank_word(quad), 0, 0, 0);
    if (k_bits == 16) return uvec4(rank_word(2 * quad), rank_word(2 * quad + 1), 0, 0);
    if (!k_from_storage) return texelFetch(features, int(quad));
    return uvec4(stored_features[4 * quad], stored_features[4 * quad + 1], stored_features[4 * quad + 2],
                 stored_features[4 * quad + 3]);
}
uint column_texels() { return parameters.stride * (32 / k_bits); }
#endif
const uint k_texels = k_quads / k_quads_of_texel;

// Returns which items of a texel's quad are above the threshold of a stump. The threshold of a rank has all lower
// bits set, so that the bits below a rank in its word need not be masked.
bvec4 is_above(uvec4 texel, uint quad, uint threshold) {
    if (k_bits == 32) return greaterThan(uintBitsToFloat(texel), vec4(uintBitsToFloat(threshold)));
    if (k_bits == 16) {
        const uvec2 words = quad == 0 ? texel.xy : texel.zw;
        return greaterThan(ivec4(words.x << 16, words.x, words.y << 16, words.y), ivec4(threshold));
    }
    return greaterThan(ivec4(texel[quad]) << ivec4(24, 16, 8, 0), ivec4(threshold));
}

GroupedStump fetch_stump(uint index) {
    const uvec4 s = table_entry(stumps, index);
    return GroupedStump(s.x, s.y, uintBitsToFloat(s.z), uintBitsToFloat(s.w));
}

StumpGroup fetch_group(uint index) {
    const uvec4 g = table_entry(groups, index);
    return StumpGroup(g.x, g.y, g.z, g.w);
}

// Returns the log of the unnormalized probability. That of the sigmoid stays finite where sigma itself underflows.
vec4 log_weight(vec4 scaled) {
    if (parameters.link == k_link_softmax) return scaled;
    return min(scaled, 0.0) - log(1.0 + exp(-abs(scaled)));
}

// H of the invocation's quads: quads x classes.
vec4 h[k_quads * k_classes];

// Returns the number of valid items in a quad.
uint items_of(uint quad) { return 4 * quad < parameters.rows ? min(4u, parameters.rows - 4 * quad) : 0; }

// Loads H of one quad, as the previous dispatch stored it, into h from `first` on; and stores it for the next
// dispatch.
void load_partial_sums(uint quad, uint first) {
    const uint items = items_of(quad);
    card_unroll for (uint c = 0; c < k_classes; ++c)
        card_unroll for (uint item = 0; item < 4; ++item)
            if (item < items) h[first + c][item] = probabilities[(4 * quad + item) * k_classes + c];
}
void store_partial_sums(uint quad, uint first) {
    const uint items = items_of(quad);
    card_unroll for (uint c = 0; c < k_classes; ++c)
        card_unroll for (uint item = 0; item < 4; ++item)
            if (item < items) probabilities[(4 * quad + item) * k_classes + c] = h[first + c][item];
}

// Turns H of one quad, from h[first] on, into probabilities and stores them, item-major.
void store_quad(uint quad, uint first) {
    vec4 largest = vec4(-3.4e38);
    card_unroll for (uint c = 0; c < k_classes; ++c) {
        h[first + c] = log_weight(parameters.scale * h[first + c]);
        largest = max(largest, h[first + c]);
    }
    vec4 total = vec4(0.0);
    card_unroll for (uint c = 0; c < k_classes; ++c) {
        h[first + c] = exp(h[first + c] - largest);
        total += h[first + c];
    }
    const uint items = items_of(quad);
    card_unroll for (uint c = 0; c < k_classes; ++c) {
        const vec4 probability = h[first + c] / total;
        card_unroll for (uint item = 0; item < 4; ++item)
            if (item < items) probabilities[(4 * quad + item) * k_classes + c] = probability[item];
    }
}

// Returns the number of an invocation's quad `q` in the order of h.
uint quad_of(uint texel, uint q) {
    return (texel + q / k_quads_of_texel * k_stump_neighbors) * k_quads_of_texel + q % k_quads_of_texel;
}

#ifdef EXEMPLAR_CPU
void add_to_classes(StumpGroup group, vec4 sum[k_quads]) {
    [[dont_unroll]] for (uint word = 0; word < 2; ++word)
        for (uint bits = word == 0 ? group.classes_low : group.classes_high; bits != 0; bits &= bits - 1) {
            const uint c = 32 * word + findLSB(bits);
            for (uint q = 0; q < k_quads; ++q) h[q * k_classes + c] += sum[q];
        }
}
#else
// Visits all classes, so that h is not indexed by a variable: its place is registers then, not memory.
void add_to_classes(StumpGroup group, vec4 sum[k_quads]) {
    [[unroll]] for (uint c = 0; c < k_classes; ++c) {
        const uint word = c < 32 ? group.classes_low : group.classes_high;
        if ((word >> (c % 32) & 1) == 0) continue;
        [[unroll]] for (uint q = 0; q < k_quads; ++q) h[q * k_classes + c] += sum[q];
    }
}
#endif

void main() {
    const uint thread = linear_thread();
    if (thread >= parameters.threads) return;

    const uint texel = (thread / k_stump_neighbors) * k_stump_neighbors * k_texels + thread % k_stump_neighbors;
    card_unroll for (uint c = 0; c < k_classes; ++c)
        card_unroll for (uint q = 0; q < k_quads; ++q) h[q * k_classes + c] = vec4(texelFetch(constants, int(c)).x);
    if (k_in_parts && parameters.first_group > 0)
        card_unroll for (uint q = 0; q < k_quads; ++q) load_partial_sums(quad_of(texel, q), q * k_classes);
    const uint stride = column_texels();
    for (uint g = parameters.first_group; g < parameters.end_group; ++g) {
        const StumpGroup group = fetch_group(g);
        vec4 sum[k_quads];
        for (uint q = 0; q < k_quads; ++q) sum[q] = vec4(0.0);
        for (uint s = group.first; s < group.end; ++s) {
            const GroupedStump stump = fetch_stump(s);
            const uint first = stump.column * stride + texel;
            for (uint t = 0; t < k_texels; ++t) {
                const uvec4 fetched = fetch_features(first + t * k_stump_neighbors);
                for (uint q = 0; q < k_quads_of_texel; ++q)
                    sum[t * k_quads_of_texel + q] +=
                        mix(vec4(stump.below), vec4(stump.above), is_above(fetched, q, stump.threshold));
            }
        }
        add_to_classes(group, sum);
    }
    if (k_in_parts && parameters.end_group < parameters.groups)
        card_unroll for (uint q = 0; q < k_quads; ++q) store_partial_sums(quad_of(texel, q), q * k_classes);
    else
        card_unroll for (uint q = 0; q < k_quads; ++q) store_quad(quad_of(texel, q), q * k_classes);
}
