#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/learn/feature_matrix.h"

namespace exemplar {

/// Returns the base features that familiarity is judged by: shading, shape and place on the object, all smooth.
const std::vector<std::uint32_t>& familiar_features();

/// How much a pixel is like those of the drawing that a style was learned from. What was learned in detail holds for
/// such pixels, and elsewhere only what is simple.
struct Familiarity {
    std::vector<float> offset, scale;  ///< per feature of familiar_features(): z = (x - offset) scale
    std::vector<float> samples;        ///< z of pixels of the drawing, pixel-major
    float reach = 1;                   ///< usual distance of z from the nearest sample in patches that were held out

    bool operator==(const Familiarity&) const = default;
    /// Returns exp(-(d / 2 reach)^2) per row, d its distance from the nearest sample; 1 if there are no samples.
    /// `which`: the base feature of each column. Throws UsageError if a feature is missing.
    std::vector<float> of(std::span<const std::uint32_t> which, const FeatureMatrix& features) const;
};

/// Learns from rows of a drawing; the columns of `features` are all base features. `held_out`: 1 for rows in patches.
Familiarity learn_familiarity(const FeatureMatrix& features, std::span<const std::uint8_t> held_out,
                              std::uint64_t seed);

}  // namespace exemplar
