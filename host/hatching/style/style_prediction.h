#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "host/hatching/features/pixel_features.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/style/hatching_style.h"
#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

/// Evaluates the rules and properties of a style per pixel. The CPU implementation is the reference; gpu/hatching
/// implements it in shaders.
class HatchingEvaluator {
  public:
    virtual ~HatchingEvaluator() = default;
    /// Returns the direction of each row: f of its segment's function, normalized. Throws UsageError unless there is
    /// one segment per row, and the functions and features referred to exist.
    virtual std::vector<DoubledAngle> orientations(std::span<const OrientationFunction> functions,
                                                   std::span<const std::int32_t> segment,
                                                   const OrientationFields& fields) = 0;
    /// Returns a property of each row. `base` holds the base features of the rows, numbered `which`. Throws
    /// UsageError if the property depends on a feature that is not among them.
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

/// Checks the arguments of HatchingEvaluator::orientations(); throws UsageError as described there.
void check_orientations(std::span<const OrientationFunction> functions, std::span<const std::int32_t> segment,
                        const OrientationFields& fields);
/// Returns the column of base features of each term of a property. Throws UsageError if one is missing.
std::vector<std::span<const float>> property_columns(const PropertyModel& model, std::span<const std::uint32_t> which,
                                                     const FeatureMatrix& base);

/// Returns the probabilities of the hatching levels: in detail where pixels are familiar, roughly elsewhere. `features`
/// as for classify().
std::vector<float> level_probabilities(const HatchingStyle& style, std::span<const std::uint32_t> which,
                                       const FeatureMatrix& features, StumpScorer& scorer);

constexpr std::uint8_t k_no_segment = 255;

/// The predicted targets of a view, and the segments that they follow from.
struct HatchingPrediction {
    HatchingFields fields;
    std::vector<std::uint8_t> segment;  ///< per pixel; k_no_segment outside of the object
    std::vector<std::pair<const char*, double>> seconds;
};

/// Predicts the targets of a view in a style (thesis Sec. 4.3.1-4.3.3). The style is to be of the view's size, see
/// HatchingStyle::resize(). Sets the scale of `pixels` to that of the style.
HatchingPrediction predict_hatching(const HatchingStyle& style, PixelFeatures& pixels, StumpScorer& scorer,
                                    HatchingEvaluator& evaluator);

}  // namespace exemplar
