#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/stumps.h"

// Boosted stumps of four items per invocation, up to the probabilities (thesis Eq. 2.64 to 2.66). Stumps come grouped by the
// set of classes that share them: a group is summed once and then added to its classes, so that the cost of a stump does not
// depend on the number of classes.
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint k_classes = 1;
layout(push_constant) uniform Push { StumpParameters parameters; };
layout(set = 0, binding = 0, std430) readonly buffer Features { vec4 features[]; };
layout(set = 0, binding = 1, std430) readonly buffer Stumps { GroupedStump stumps[]; };
layout(set = 0, binding = 2, std430) readonly buffer Groups { StumpGroup groups[]; };
layout(set = 0, binding = 3, std430) readonly buffer Constants { float constants[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Probabilities { float probabilities[]; };

const uint k_link_softmax = 0;

vec4 sum_group(StumpGroup group, uint quad) {
    vec4 sum = vec4(0.0);
    for (uint s = group.first; s < group.end; ++s) {
        const GroupedStump stump = stumps[s];
        const vec4 x = features[stump.column * parameters.stride + quad];
        // A comparison with NaN is false.
        sum += mix(vec4(stump.below), vec4(stump.above), greaterThan(x, vec4(stump.threshold)));
    }
    return sum;
}

// Log of the unnormalized probability; the sigmoid's stays finite where sigma itself underflows.
vec4 log_weight(vec4 scaled) {
    if (parameters.link == k_link_softmax) return scaled;
    return min(scaled, 0.0) - log(1.0 + exp(-abs(scaled)));
}

void main() {
    const uint quad = linear_thread();
    if (4 * quad >= parameters.rows) return;

    vec4 h[k_classes];
    for (uint c = 0; c < k_classes; ++c) h[c] = vec4(constants[c]);
    for (uint g = 0; g < parameters.groups; ++g) {
        const StumpGroup group = groups[g];
        const vec4 sum = sum_group(group, quad);
        for (uint c = 0; c < k_classes; ++c) {
            const uint bit = (c < 32 ? group.classes_low >> c : group.classes_high >> (c - 32)) & 1u;
            h[c] += bit != 0 ? sum : vec4(0.0);
        }
    }

    vec4 largest = vec4(-3.4e38);
    for (uint c = 0; c < k_classes; ++c) {
        h[c] = log_weight(parameters.scale * h[c]);
        largest = max(largest, h[c]);
    }
    vec4 total = vec4(0.0);
    for (uint c = 0; c < k_classes; ++c) {
        h[c] = exp(h[c] - largest);
        total += h[c];
    }
    for (uint item = 0; item < min(4u, parameters.rows - 4 * quad); ++item)
        for (uint c = 0; c < k_classes; ++c)
            probabilities[(4 * quad + item) * k_classes + c] = h[c][item] / total[item];
}
