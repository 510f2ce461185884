#include "host/hatching/style/style_prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/stopwatch.h"
#include "host/hatching/features/expanded_features.h"
#include "host/hatching/features/powers.h"
#include "host/hatching/style/pixel_classifier.h"

namespace exemplar {
namespace {

/// Returns the base features that a style needs, without contextual ones.
std::vector<std::uint32_t> needed_features(const HatchingStyle& style) {
    std::vector<std::uint32_t> needed;
    const auto add = [&](std::uint32_t base) {
        if (base < style.scalar_count()) needed.push_back(base);
    };
    const auto add_all = [&](const CalibratedStumps& classifier) {
        for (const std::uint32_t base : used_features(classifier.stumps)) add(base);
    };
    for (const CalibratedStumps& stage : style.segments) add_all(stage);
    add_all(style.boundary);
    add_all(style.levels);
    add_all(style.rough_levels);
    if (!style.familiarity.samples.empty())
        needed.insert(needed.end(), familiar_features().begin(), familiar_features().end());
    for (const DirectionCorrection& correction : style.corrections) {
        for (const DirectionStump& stump : correction.stumps) add(stump.feature);
    }
    for (const PropertyModel& model : style.properties) {
        for (const auto& term : model.terms) add(static_cast<std::uint32_t>(term.feature / k_powers));
    }
    std::ranges::sort(needed);
    needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
    return needed;
}

class Prediction {
  public:
    Prediction(const HatchingStyle& style, PixelFeatures& pixels, StumpScorer& scorer, HatchingEvaluator& evaluator)
        : style_(style), pixels_(pixels), scorer_(scorer), evaluator_(evaluator) {}

    HatchingPrediction run() {
        if (style_.object_size > 0)
            pixels_.set_scale(size_in_view(pixels_.surface(), pixels_.view()) / style_.object_size);
        pixels_.use_parts(style_.parts);
        which_ = needed_features(style_);
        features_ = pixels_.scalars(which_, {}, contextual_feature_count(style_.rules.size()));
        done("features");
        const std::vector<float> segments = segment_probabilities();
        const std::vector<float> levels = level_probabilities(style_, which_, features_, scorer_);
        const std::vector<float> boundary = boundary_probabilities();
        done("classifiers");
        PixelCrf crf(pixels_.pixels(), pixels_.view().width, boundary);
        const std::vector<std::int32_t> segment = crf.solve(segments, style_.rules.size(), style_.segment_crf);
        const std::vector<std::int32_t> level = crf.solve(levels, 3, style_.level_crf);
        done("graph cuts");
        fill_levels(segment, level);
        fill_orientations(segment);
        done("orientations");
        fill_properties();
        done("properties");
        return std::move(out_);
    }

  private:
    void done(const char* step) {
        out_.seconds.emplace_back(step, watch_.wall());
        watch_ = Stopwatch();
        check_interrupt();
    }

    /// Evaluates the cascade of segment classifiers; appends the contextual features of the last stage to
    /// `features_`.
    std::vector<float> segment_probabilities() {
        const std::size_t own = which_.size(), labels = style_.rules.size();
        std::vector<float> probabilities;
        for (std::size_t stage = 0; stage <= style_.segments.size(); ++stage) {
            if (stage > 0) set_context(own, labels, probabilities);
            if (stage < style_.segments.size())
                probabilities = classify(style_.segments[stage], which_, features_, scorer_);
        }
        return probabilities;
    }

    void set_context(std::size_t own, std::size_t labels, std::span<const float> probabilities) {
        which_.resize(own);
        features_.names.resize(own);
        features_.values.resize(own * features_.rows);
        features_.append(
            contextual_features(pixels_.surface(), pixels_.gbuffer(), pixels_.pixels(), probabilities, labels, {}));
        for (std::uint32_t k = 0; k < contextual_feature_count(labels); ++k)
            which_.push_back(static_cast<std::uint32_t>(style_.scalar_count()) + k);
    }

    std::vector<float> boundary_probabilities() {
        const std::vector<float> both = classify(style_.boundary, which_, features_, scorer_);
        std::vector<float> boundary(both.size() / 2);
        for (std::size_t i = 0; i < boundary.size(); ++i) boundary[i] = both[2 * i + 1];
        return boundary;
    }

    void fill_levels(std::span<const std::int32_t> segment, std::span<const std::int32_t> level) {
        const HatchingView& view = pixels_.view();
        out_.fields = HatchingFields(view.width, view.height);
        out_.segment.assign(out_.fields.size(), k_no_segment);
        for (std::size_t i = 0; i < pixels_.size(); ++i) {
            const std::uint32_t pixel = pixels_.pixels().pixel[i];
            const auto c = static_cast<std::size_t>(segment[i]);
            out_.segment[pixel] = static_cast<std::uint8_t>(c);
            out_.fields.level[pixel] = static_cast<std::uint8_t>(level[i]);
        }
    }

    void fill_orientations(std::span<const std::int32_t> segment) {
        const OrientationFields fields = pixels_.orientations({});
        std::vector<DoubledAngle> hatches;
        for (std::size_t layer = 0; layer < k_hatch_layers; ++layer) {
            std::vector<OrientationFunction> functions;
            for (const OrientationRule& rule : style_.rules) functions.push_back(rule.function[layer]);
            std::vector<DoubledAngle> directions = evaluator_.orientations(functions, segment, fields);
            if (layer > 0) cross_at_right_angles(hatches, directions);
            const DirectionCorrection& correction = style_.corrections[layer];
            if (!correction.empty())
                directions = corrected_directions(correction, directions, segment, fields, which_, features_);
            if (layer == 0) hatches = directions;
            for (std::size_t i = 0; i < directions.size(); ++i) {
                const std::uint32_t pixel = pixels_.pixels().pixel[i];
                out_.fields.orientation[layer][pixel] = angle_of(directions[i]);
                // A layer without a direction is not hatched.
                const auto most = static_cast<std::uint8_t>(layer);
                if (directions[i] == DoubledAngle{})
                    out_.fields.level[pixel] = std::min(out_.fields.level[pixel], most);
            }
        }
    }

    void fill_properties() {
        for (std::size_t p = 0; p < k_stroke_properties; ++p) {
            const std::vector<float> values = evaluator_.property(style_.properties[p], which_, features_);
            std::vector<float>& image = property_of(out_.fields, static_cast<StrokeProperty>(p));
            for (std::size_t i = 0; i < values.size(); ++i) image[pixels_.pixels().pixel[i]] = values[i];
        }
        for (float& intensity : out_.fields.intensity) intensity = std::min(intensity, 1.0f);
    }

    const HatchingStyle& style_;
    PixelFeatures& pixels_;
    StumpScorer& scorer_;
    HatchingEvaluator& evaluator_;
    std::vector<std::uint32_t> which_;
    FeatureMatrix features_;
    HatchingPrediction out_;
    Stopwatch watch_;
};

}  // namespace

std::vector<float> level_probabilities(const HatchingStyle& style, std::span<const std::uint32_t> which,
                                       const FeatureMatrix& features, StumpScorer& scorer) {
    std::vector<float> levels = classify(style.levels, which, features, scorer);
    if (style.rough_levels.stumps.stumps.empty()) return levels;
    const std::vector<float> rough = classify(style.rough_levels, which, features, scorer);
    const std::vector<float> familiarity = style.familiarity.of(which, features);
    const std::size_t classes = style.levels.stumps.class_count;
    for (std::size_t k = 0; k < levels.size(); ++k)
        levels[k] = std::lerp(rough[k], levels[k], familiarity[k / classes]);
    return levels;
}

void check_orientations(std::span<const OrientationFunction> functions, std::span<const std::int32_t> segment,
                        const OrientationFields& fields) {
    if (segment.size() != fields.rows)
        throw UsageError(fmt::format("{} segments are not of {} rows", segment.size(), fields.rows));
    for (const std::int32_t s : segment) {
        if (s < 0 || static_cast<std::size_t>(s) >= functions.size())
            throw UsageError(fmt::format("there is no rule of segment {}; there are {}", s, functions.size()));
    }
    for (const OrientationFunction& function : functions) {
        for (const auto& term : function.terms) {
            if (term.feature >= k_orientation_features)
                throw UsageError(fmt::format("there is no orientation feature {}", term.feature));
        }
    }
}

std::vector<std::span<const float>> property_columns(const PropertyModel& model, std::span<const std::uint32_t> which,
                                                     const FeatureMatrix& base) {
    std::vector<std::span<const float>> columns;
    for (const auto& term : model.terms) {
        const auto column = std::ranges::find(which, term.feature / k_powers);
        if (column == which.end()) throw UsageError("a property depends on a feature that was not measured");
        columns.push_back(base.column(static_cast<std::size_t>(column - which.begin())));
    }
    return columns;
}

std::vector<DoubledAngle> CpuHatchingEvaluator::orientations(std::span<const OrientationFunction> functions,
                                                             std::span<const std::int32_t> segment,
                                                             const OrientationFields& fields) {
    check_orientations(functions, segment, fields);
    std::vector<DoubledAngle> directions(fields.rows);
    parallel_for(
        fields.rows,
        [&](std::size_t i) { directions[i] = functions[static_cast<std::size_t>(segment[i])].evaluate(fields, i); },
        4096);
    return directions;
}

std::vector<float> CpuHatchingEvaluator::property(const PropertyModel& model, std::span<const std::uint32_t> which,
                                                  const FeatureMatrix& base) {
    const std::vector<std::span<const float>> columns = property_columns(model, which, base);
    std::vector<float> values(base.rows);
    parallel_for(
        base.rows,
        [&](std::size_t i) {
            float sum = std::log(model.factor);
            for (std::size_t k = 0; k < columns.size(); ++k) {
                const PropertyModel::Term& term = model.terms[k];
                sum += PropertyModel::log_value(term, power_of(columns[k][i], term.feature % k_powers));
            }
            values[i] = std::exp(sum);
        },
        4096);
    return values;
}

HatchingPrediction predict_hatching(const HatchingStyle& style, PixelFeatures& pixels, StumpScorer& scorer,
                                    HatchingEvaluator& evaluator) {
    return Prediction(style, pixels, scorer, evaluator).run();
}

}  // namespace exemplar
