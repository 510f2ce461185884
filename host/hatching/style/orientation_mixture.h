#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/style/orientation_function.h"
#include "host/hatching/style/orientation_samples.h"

namespace exemplar {

/// The rule of one segment of a drawing: how hatches run, and what crosses them (no terms: nothing does).
struct OrientationRule {
    std::array<OrientationFunction, k_hatch_layers> function;
    bool crosses() const { return !function[1].terms.empty(); }
    bool operator==(const OrientationRule&) const = default;
};

struct MixtureOptions {
    std::size_t most_clusters = 16;  ///< that the search begins with
    std::size_t iterations = 10;     ///< of expectation and maximization, between merges
    double held_out = 0.25;          ///< share of each cluster
    std::uint64_t seed = 1;
};

/// What the mixture of experts found.
struct OrientationMixture {
    std::vector<OrientationRule> rules;  ///< of each segment, by falling share
    std::vector<std::uint32_t> segment;  ///< of each sample: the likeliest
    std::vector<double> share;           ///< pi_c
    double error = 0;                    ///< mean over the samples of min |u - f|^2 in their segment
};

/// Finds which regions of a drawing follow which rule, and the rules, at once (thesis Sec. 4.4.1, Eqs. 4.10-4.14): a
/// mixture of experts by expectation maximization, from grow_clusters(). Beyond the thesis, segments of less than
/// four hundredths are dissolved, and two segments become one where one rule explains both, on what is held out, with
/// no more than a tenth more than the errors of the two and of what a degree of noise makes: clusters begin as regions
/// of about one direction, while a rule may turn with the surface. A segment has a second direction if more than 10% of
/// it is cross-hatched, whatever it began as. Also, where the drawing has single strokes (level 1), only the first
/// direction of a segment counts in Eq. 4.12, and the medians of errors are of samples of the same level and, where
/// strokes cross, of each direction on its own. A gate by place (Sec. 2.2.5) stands for pi_c in Eq. 4.10: the mean of
/// gamma within two spacings; but where fewer segments are left if all goes on without it, those are the result. No
/// samples give no rules. Deterministic. Throws Interrupted at Ctrl-C.
OrientationMixture learn_mixture(
    const OrientationSamples& samples, const MixtureOptions& options = {},
    const std::function<void()>& progress = [] {});

}  // namespace exemplar
