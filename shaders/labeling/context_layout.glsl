// Layout of contextual histograms and of what they are made from.
#ifndef EXEMPLAR_CONTEXT_LAYOUT_GLSL
#define EXEMPLAR_CONTEXT_LAYOUT_GLSL

#include "shaders/shared/context.h"

// Histograms: column (measure * bins + bin) * classes + class, feature-major. Each kernel counts its measures from 0.
uint histogram_column(uint measure, uint bin, uint classes, uint label) {
    return (measure * k_context_bins + bin) * classes + label;
}

uint class_blocks(uint classes) { return (classes + k_context_class_block - 1) / k_context_class_block; }
uint sample_blocks(uint samples) { return (samples + k_context_sample_block - 1) / k_context_sample_block; }

#endif
