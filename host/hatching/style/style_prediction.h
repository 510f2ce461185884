#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/style/hatching_style.h"
#include "host/hatching/features/pixel_features.h"
#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

/// Evaluates what a style says of pixels: the CPU implementation is the reference; gpu/hatching implements it in
/// shaders.
class HatchingEvaluator {
  public:
    virtual ~HatchingEvaluator() = default;
    /// The direction of each row: f of the rule of its segment, normalized. Throws UsageError if there is not one
    /// segment a row, or a function or field that is named does not exist.
    virtual std::vector<DoubledAngle> orientations(std::span<const OrientationFunction> functions,
                                                   std::span<const std::int32_t> segment,
                                                   const OrientationFields& fields) = 0;
    /// A property of each row, whose base features `which` are `base`. Throws UsageError if one that it depends on is
    /// not among them.
    virtual std::vector<float> property(const PropertyModel& model, std::span<const std::uint32_t> which,
                                        const FeatureMatrix& base) = 0;
};

class CpuHatchingEvaluator final : public HatchingEvaluator {
  public:
    std::vector<DoubledAngle> orientations(std::span<const OrientationFunction> functions,
                                           std::span<const std::int32_t> segment,
                                           const OrientationFields& fields) override;
    std::vector<float> property(const PropertyModel& model, std::span<const std::uint32_t> which,
                                const FeatureMatrix& base) override;
};

/// What every HatchingEvaluator throws before it does anything.
void check_orientations(std::span<const OrientationFunction> functions, std::span<const std::int32_t> segment,
                        const OrientationFields& fields);
/// The base features of the terms of a property; throws UsageError if one is not there.
std::vector<std::span<const float>> property_columns(const PropertyModel& model, std::span<const std::uint32_t> which,
                                                     const FeatureMatrix& base);

constexpr std::uint8_t k_no_segment = 255;

/// How strokes are to look in a view, and why.
struct HatchingPrediction {
    HatchingFields fields;
    std::vector<std::uint8_t> segment;  ///< of each pixel; k_no_segment outside of the object
    std::vector<std::pair<const char*, double>> seconds;
};

/// What a style says of a view (thesis Sec. 4.3.1-4.3.3).
HatchingPrediction predict_hatching(const HatchingStyle& style, PixelFeatures& pixels, StumpScorer& scorer,
                                    HatchingEvaluator& evaluator);

}  // namespace exemplar
