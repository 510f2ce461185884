// Layout of contextual histograms: column (measure * bins + bin) * classes + class, feature-major. Each kernel
// counts its measures from 0.
#ifndef EXEMPLAR_CONTEXT_BINS_GLSL
#define EXEMPLAR_CONTEXT_BINS_GLSL

#include "shaders/shared/context.h"

uint histogram_column(uint measure, uint bin, uint classes, uint label) {
    return (measure * k_context_bins + bin) * classes + label;
}

#endif
