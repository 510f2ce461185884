#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/loops.glsl"
#include "shaders/shared/context.h"

// Turns the stumps' probabilities of a stage into the cascade's prediction, one row per invocation: combines them with
// a linear classifier (LinearExpert), then takes the mean over the stages for the averaged classes (CascadePrediction).
// Per row and class 4 bytes are read and written, and 4 more are read if there is a linear classifier; if any class is
// averaged, 4 more are read and written.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(constant_id = 0) const uint k_classes = 1;
layout(push_constant) uniform Push { PredictionParameters parameters; };
layout(set = 0, binding = 0, std430) readonly buffer Stumps { float stumps[]; };           // rows x classes
layout(set = 0, binding = 1, std430) readonly buffer Linear { float linear[]; };           // the same
layout(set = 0, binding = 2, std430) buffer Means { float means[]; };                      // of the stages so far
layout(set = 0, binding = 3, std430) writeonly buffer Prediction { float prediction[]; };  // the same

bool averaged(uint c) {
    return ((c < 32 ? parameters.averaged_low : parameters.averaged_high) >> (c % 32) & 1u) != 0;
}

// Copies the probabilities of the averaged classes from `source`. The other classes share the rest as before, or equally
// if they had nothing.
void copy_averaged(float source[k_classes], inout float target[k_classes]) {
    float rest = 1.0, others = 0.0;
    uint count = 0;
    card_unroll for (uint c = 0; c < k_classes; ++c) {
        if (averaged(c)) {
            rest -= source[c];
        } else {
            others += target[c];
            ++count;
        }
    }
    rest = max(rest, 0.0);
    card_unroll for (uint c = 0; c < k_classes; ++c) {
        if (averaged(c))
            target[c] = source[c];
        else
            target[c] = (others > k_no_probability ? target[c] / others : 1.0 / float(count)) * rest;
    }
}

// Multiplies the stumps' probabilities by those of the linear classifier, in logarithms.
void combine(uint first, inout float p[k_classes]) {
    float largest = -3.4e38;
    card_unroll for (uint c = 0; c < k_classes; ++c) {
        const float score = clamp(linear[first + c], 0.0, 1.0);
        p[c] = parameters.scale * (log(max(p[c], k_min_combined_probability)) + parameters.ratio * score);
        largest = max(largest, p[c]);
    }
    float total = 0.0;
    card_unroll for (uint c = 0; c < k_classes; ++c) {
        p[c] = exp(p[c] - largest);
        total += p[c];
    }
    card_unroll for (uint c = 0; c < k_classes; ++c) p[c] /= total;
}

void main() {
    const uint row = linear_thread();
    if (row >= parameters.rows) return;
    const uint first = row * k_classes;
    float p[k_classes];
    card_unroll for (uint c = 0; c < k_classes; ++c) p[c] = stumps[first + c];
    const bool averages = (parameters.averaged_low | parameters.averaged_high) != 0;
    if (parameters.combines != 0) {
        float alone[k_classes];
        card_unroll for (uint c = 0; c < k_classes; ++c) alone[c] = p[c];
        combine(first, p);
        if (averages) copy_averaged(alone, p);
    }
    if (averages) {
        float mean[k_classes];
        card_unroll for (uint c = 0; c < k_classes; ++c) {
            mean[c] = parameters.stages > 1.0 ? means[first + c] : 0.0;
            mean[c] += (p[c] - mean[c]) / parameters.stages;
            means[first + c] = mean[c];
        }
        copy_averaged(mean, p);
    }
    card_unroll for (uint c = 0; c < k_classes; ++c) prediction[first + c] = p[c];
}
