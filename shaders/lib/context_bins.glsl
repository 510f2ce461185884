// Where contextual histograms are written: column (measure * 5 + bin) * classes + class, feature-major.
#ifndef EXEMPLAR_CONTEXT_BINS_GLSL
#define EXEMPLAR_CONTEXT_BINS_GLSL

const uint k_bins = 5;

uint histogram_column(uint measure, uint bin, uint classes, uint label) { return (measure * k_bins + bin) * classes + label; }

#endif
