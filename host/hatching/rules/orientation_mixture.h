#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/rules/orientation_function.h"
#include "host/hatching/rules/orientation_samples.h"

namespace exemplar {

/// Rule of one segment: the direction of hatches, and of the hatches that cross them (no terms: nothing crosses).
struct OrientationRule {
    std::array<OrientationFunction, k_hatch_layers> function;
    bool crosses() const { return !function[1].terms.empty(); }
    bool operator==(const OrientationRule&) const = default;
};

struct MixtureOptions {
    std::size_t max_clusters = 16;  ///< initial clusters, at most
    std::size_t iterations = 10;    ///< of expectation maximization, between merges
    double held_out = 0.25;         ///< share of each cluster that is held out
    std::uint64_t seed = 1;
};

/// Result of learn_mixture().
struct OrientationMixture {
    std::vector<OrientationRule> rules;  ///< per segment, by decreasing share
    std::vector<std::uint32_t> segment;  ///< per sample: the most probable segment
    std::vector<double> share;           ///< per segment: pi_c
    double error = 0;                    ///< mean over samples of the smaller |u - f|^2 of their segment
};

/// Finds the segments of a drawing and their rules jointly (thesis Sec. 4.4.1, Eqs. 4.10-4.14): a mixture of
/// experts, fitted by expectation maximization from the clusters of grow_clusters(). Beyond the thesis
/// (docs/hatching.md), segments below 4% dissolve, segments that one rule explains on held-out samples merge, and a
/// spatial gate (Sec. 2.2.5: the mean of gamma within two spacings) replaces pi_c in Eq. 4.10, unless fewer segments
/// remain without it. A segment has a second direction if more than 10% of it is cross-hatched; single strokes count
/// for the first direction only (Eq. 4.12). No samples give no rules. Deterministic. Throws Interrupted at Ctrl-C.
OrientationMixture learn_mixture(
    const OrientationSamples& samples, const MixtureOptions& options = {},
    const std::function<void()>& progress = [] {});

}  // namespace exemplar
