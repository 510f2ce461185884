#include "host/hatching/style/style_learning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/random.h"
#include "host/core/statistics.h"
#include "host/core/stopwatch.h"
#include "host/hatching/features/expanded_features.h"
#include "host/hatching/features/powers.h"
#include "host/hatching/rules/direction_learning.h"
#include "host/hatching/rules/held_out_patches.h"
#include "host/hatching/style/cut_learning.h"
#include "host/hatching/style/example_folds.h"
#include "host/hatching/style/pixel_classifier.h"
#include "host/hatching/style/segment_learning.h"
#include "host/hatching/style/style_prediction.h"

namespace exemplar {
namespace {

constexpr std::size_t k_min_samples = 200;
constexpr double k_held_out = 0.25;

/// A random subset of rows, in their order.
std::vector<std::uint32_t> sample_rows(std::vector<std::uint32_t> rows, std::size_t most, std::uint64_t seed) {
    if (rows.size() <= most) return rows;
    Random random(seed);
    random.shuffle(rows);
    rows.resize(most);
    std::ranges::sort(rows);
    return rows;
}

/// Levels of held-out rows, and the probabilities of all rows by a classifier that has not learned from those.
struct HeldOutLevels {
    std::vector<std::uint32_t> rows;
    std::vector<std::int32_t> labels;
    std::vector<float> probabilities;
};

class StyleLearning {
  public:
    StyleLearning(std::span<const HatchingExample> views, StumpScorer& scorer, const StyleLearningOptions& options,
                  StyleReport& report, const std::function<void(const char*)>& progress)
        : views_(views),
          features_(views_, scorer),
          folds_(views_, features_, options.seed + 16),
          options_(options),
          report_(report),
          progress_(progress) {}

    HatchingStyle run() {
        const DrawingProperties& first = views_.views().front().drawing;
        style_.width = first.width;
        style_.height = first.height;
        PixelFeatures& first_pixels = views_.views().front().pixels;
        style_.parts = views_.parts();
        style_.object_size = size_in_view(first_pixels.surface(), first_pixels.view());
        learn_pen();
        learn_rules();
        done("orientations");
        learn_segments_of_strokes();
        done("segments");
        learn_boundary();
        done("boundaries");
        learn_levels();
        done("levels");
        learn_cuts();
        done("label cuts");
        learn_directions();
        done("corrections");
        for (std::size_t p = 0; p < k_stroke_properties; ++p) learn_property_of(static_cast<StrokeProperty>(p));
        done("properties");
        return std::move(style_);
    }

  private:
    void done(const char* step) {
        report_.seconds.emplace_back(step, watch_.wall());
        watch_ = Stopwatch();
        check_interrupt();
    }

    /// The value of a row in an image of its drawing.
    template <typename Value>
    Value at(std::uint32_t row, const std::vector<Value> DrawingProperties::*image) const {
        return (views_.drawing_of(row).*image)[views_.pixel_of(row)];
    }
    float property_at(std::uint32_t row, std::size_t property) const {
        return views_.drawing_of(row).property[property][views_.pixel_of(row)];
    }

    /// Rows that pass a test of their drawing and pixel.
    template <typename Test>
    std::vector<std::uint32_t> rows_where(Test&& test) const {
        std::vector<std::uint32_t> rows;
        for (std::uint32_t row = 0; row < views_.size(); ++row) {
            if (test(views_.drawing_of(row), views_.pixel_of(row))) rows.push_back(row);
        }
        return rows;
    }

    /// Returns how many pixels of a drawing correspond to one of the first drawing, as the width of a pen does.
    float pen_unit(const DrawingProperties& drawing) const {
        const int side = std::min(drawing.width, drawing.height), first_side = std::min(style_.width, style_.height);
        return static_cast<float>(side) / static_cast<float>(first_side);
    }

    /// Strokes end, and outlines are as wide, as in the drawings on average.
    void learn_pen() {
        float outlined = 0;
        style_.taper = 0;
        for (const auto& [pixels, drawing] : views_.views()) {
            const float unit = pen_unit(drawing);
            style_.taper += drawing.taper / unit / static_cast<float>(views_.views().size());
            style_.outline_width += drawing.outline_width / unit;
            outlined += drawing.outline_width > 0 ? 1 : 0;
        }
        style_.outline_width /= std::max(outlined, 1.0f);
    }

    std::vector<std::uint8_t> held_out(std::span<const std::uint32_t> rows, std::span<const std::int32_t> labels,
                                       std::uint64_t seed) const {
        std::vector<std::uint16_t> x, y;
        std::vector<std::uint32_t> group;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const auto [at_x, at_y] = views_.place_of(rows[i]);
            x.push_back(at_x);
            y.push_back(at_y);
            const std::size_t label = labels.empty() ? 0 : static_cast<std::size_t>(labels[i]);
            group.push_back(static_cast<std::uint32_t>(label * views_.views().size() + views_.view_of(rows[i])));
        }
        return held_out_rectangles(x, y, group, k_held_out, seed);
    }

    /// Returns the quarter of each row in its view: left or right, upper or lower half, split at the medians of the
    /// view's rows.
    std::vector<std::uint8_t> quarters(std::span<const std::uint32_t> rows) const {
        const auto middle = [](std::vector<std::uint16_t> values) { return upper_median(values); };
        std::vector<std::uint8_t> quarter(rows.size());
        for (std::size_t view = 0; view < views_.views().size(); ++view) {
            const std::vector<std::uint32_t> positions = views_.rows_of_view(rows, view).position;
            if (positions.empty()) continue;
            std::vector<std::uint16_t> x, y;
            for (const std::uint32_t i : positions) {
                x.push_back(views_.place_of(rows[i])[0]);
                y.push_back(views_.place_of(rows[i])[1]);
            }
            const std::uint16_t middle_x = middle(x), middle_y = middle(y);
            for (std::size_t k = 0; k < positions.size(); ++k)
                quarter[positions[k]] =
                    static_cast<std::uint8_t>((x[k] < middle_x ? 0 : 1) + (y[k] < middle_y ? 0 : 2));
        }
        return quarter;
    }

    void learn_rules() {
        const std::vector<std::uint32_t> all = rows_where([](const DrawingProperties& drawing, std::uint32_t p) {
            return drawing.center[p] && !drawing.crossing[p] && drawing.level[p] > 0;
        });
        if (all.size() < k_min_samples)
            throw DataError(
                fmt::format("the drawing has strokes on only {} pixels of the object; is it of this view, and aligned?",
                            all.size()));
        rule_rows_ = sample_rows(all, options_.orientation_samples, options_.seed);
        OrientationSamples samples;
        for (const std::uint32_t row : rule_rows_) {
            const auto [x, y] = views_.place_of(row);
            samples.x.push_back(x);
            samples.y.push_back(y);
            samples.direction.push_back(doubled_angle(at(row, &DrawingProperties::orientation)));
            samples.level.push_back(at(row, &DrawingProperties::level));
            samples.spacing.push_back(property_at(row, static_cast<std::size_t>(StrokeProperty::spacing)));
        }
        samples.fields = views_.orientations(rule_rows_);
        MixtureOptions mixing{.seed = options_.seed};
        if (options_.one_rule) mixing.max_clusters = 1;
        OrientationMixture mixture = learn_mixture(samples, mixing, [&] { progress_("orientation rules"); });
        style_.rules = std::move(mixture.rules);
        style_.share = std::move(mixture.share);
        report_.orientation_error = mixture.error;
        segment_.assign(mixture.segment.begin(), mixture.segment.end());
        report_segments();
    }

    void report_segments() {
        for (const auto& [pixels, drawing] : views_.views())
            report_.segments.emplace_back(drawing.level.size(), k_no_segment);
        for (std::size_t i = 0; i < rule_rows_.size(); ++i)
            report_.segments[views_.view_of(rule_rows_[i])][views_.pixel_of(rule_rows_[i])] =
                static_cast<std::uint8_t>(segment_[i]);
    }

    /// Segment probabilities by classifiers that have not seen a pixel's part of the picture: rough levels and
    /// properties learn from these, since those of another view are as unsure.
    SegmentContext unseen_context() const { return {style_.rules.size(), segments_.unseen}; }
    /// Segment probabilities as the finished style predicts them for these views.
    SegmentContext context() const { return {style_.rules.size(), segments_.probabilities}; }

    void learn_segments_of_strokes() {
        const std::vector<std::uint32_t> chosen =
            sample_rows(numbers_from(0, rule_rows_.size()), options_.samples, options_.seed + 2);
        std::vector<std::uint32_t> rows;
        std::vector<std::int32_t> labels;
        for (const std::uint32_t i : chosen) {
            rows.push_back(rule_rows_[i]);
            labels.push_back(segment_[i]);
        }
        segments_ = learn_segments(features_, folds_,
                                   {rows, labels, held_out(rows, labels, options_.seed + 3), style_.rules.size(),
                                    options_.max_stages, options_.seed},
                                   [&] { progress_("segments"); });
        style_.segments = segments_.cascade;
        report_.segment_errors = segments_.errors;
    }

    void learn_boundary() {
        std::vector<std::uint32_t> on = rows_where(
            [](const DrawingProperties& drawing, std::uint32_t p) { return drawing.known[p] && drawing.boundary[p]; });
        std::vector<std::uint32_t> off = rows_where(
            [](const DrawingProperties& drawing, std::uint32_t p) { return drawing.known[p] && !drawing.boundary[p]; });
        style_.boundary.stumps.class_count = 2;
        boundary_.assign(views_.size(), 0.5f);
        if (on.size() < k_min_samples || off.size() < k_min_samples) return;
        on = sample_rows(std::move(on), options_.samples / 2, options_.seed + 4);
        off = sample_rows(std::move(off), options_.samples / 2, options_.seed + 5);
        std::vector<std::uint32_t> rows = on;
        rows.insert(rows.end(), off.begin(), off.end());
        std::vector<std::int32_t> labels(on.size(), 1);
        labels.resize(rows.size(), 0);
        // Both classes get the same total weight.
        std::vector<float> weights(on.size(), static_cast<float>(off.size()) / static_cast<float>(on.size()));
        weights.resize(rows.size(), 1.0f);
        const std::size_t first = k_pixel_features - k_line_features;
        const FeatureMatrix features = views_.scalars(numbers_from(first, k_pixel_features), rows);
        const std::vector<std::uint8_t> held = held_out(rows, labels, options_.seed + 6);
        const ClassifierTraining training{features, labels, weights, held, 2, true, 300, options_.seed + 7};
        const auto progress = [&] { progress_("boundaries"); };
        LearnedClassifier learned = learn_classifier(training, progress);
        const std::vector<float> both =
            folds_.unseen_probabilities(training, rows, learned.classifier, {}, progress, first);
        for (std::size_t row = 0; row < boundary_.size(); ++row) boundary_[row] = both[2 * row + 1];
        for (Stump& stump : learned.classifier.stumps.stumps)
            stump.feature += static_cast<std::uint32_t>(k_powers * first);
        style_.boundary = learned.classifier;
        report_.boundary_error = learned.error;
    }

    /// Learns the CRF parameters of segments and of levels.
    void learn_cuts() {
        ExampleCuts cuts(views_, features_, boundary_);
        const auto progress = [&] { progress_("label cuts"); };
        segment_cut_.assign(views_.size(), 0);
        if (style_.rules.size() > 1) {
            const std::size_t segments = style_.rules.size();
            style_.segment_crf = cuts.learn({segments_.unseen, segments, rule_rows_, segment_}, progress);
            segment_cut_ = cuts.solve(segments_.probabilities, segments, style_.segment_crf);
        }
        style_.level_crf =
            cuts.learn({judged_levels_.probabilities, 3, judged_levels_.rows, judged_levels_.labels}, progress);
    }

    /// Learns where strokes depart from the rules of the segments that the cut gives their pixels.
    void learn_directions() {
        if (options_.one_rule) return;
        std::vector<std::int32_t> segment;
        for (const std::uint32_t row : rule_rows_) segment.push_back(segment_cut_[row]);
        const auto learned = learn_corrections({views_, rule_rows_, segment, style_.rules, options_.seed + 13},
                                               [&] { progress_("corrections"); });
        for (std::size_t j = 0; j < k_hatch_layers; ++j) {
            style_.corrections[j] = learned[j].correction;
            report_.direction_errors[j] = {learned[j].rule_error, learned[j].error};
        }
    }

    void learn_levels() {
        const std::vector<std::uint32_t> rows = sample_rows(
            rows_where([](const DrawingProperties& drawing, std::uint32_t p) { return drawing.known[p] != 0; }),
            options_.samples, options_.seed + 8);
        std::vector<std::int32_t> labels;
        labels.reserve(rows.size());
        for (const std::uint32_t row : rows) labels.push_back(at(row, &DrawingProperties::level));
        const auto progress = [&] { progress_("hatching levels"); };
        // The detailed classifier decides where all is as in the drawing, with the context that is seen there.
        const FeatureMatrix features = features_.of_rows(rows, context());
        const std::vector<std::uint8_t> patches = held_out_patches(views_, rows, options_.seed + 14);
        const LearnedClassifier detailed =
            learn_classifier({features, labels, {}, patches, 3, false, 4000, options_.seed + 10, true}, progress);
        // Far from the drawing, a classifier decides that was stopped when large held-out rectangles fitted best.
        const FeatureMatrix unseen = features_.of_rows(rows, unseen_context());
        const LearnedClassifier rough = learn_classifier(
            {unseen, labels, {}, held_out(rows, labels, options_.seed + 9), 3, false, 500, options_.seed + 10},
            progress);
        style_.levels = detailed.classifier;
        style_.rough_levels = rough.classifier;
        style_.familiarity = learn_familiarity(features, patches, options_.seed + 15);
        judged_levels_.probabilities = features_.probabilities(detailed.judged, context());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (!patches[i]) continue;
            judged_levels_.rows.push_back(rows[i]);
            judged_levels_.labels.push_back(labels[i]);
        }
        report_.level_error = detailed.error;
    }

    void learn_property_of(StrokeProperty property) {
        const auto p = static_cast<std::size_t>(property);
        std::vector<std::uint32_t> rows = rows_where([&](const DrawingProperties& drawing, std::uint32_t pixel) {
            return drawing.center[pixel] && drawing.level[pixel] > 0 && drawing.property[p][pixel] > 0;
        });
        if (property == StrokeProperty::length) rows = rather_uncrossed(std::move(rows));
        if (rows.size() < k_min_samples)
            throw DataError(fmt::format("the {} of strokes is known at only {} pixels; the drawing has too few",
                                        name_of(property), rows.size()));
        rows = sample_rows(std::move(rows), options_.samples, options_.seed + 11);
        std::vector<float> target;
        target.reserve(rows.size());
        for (const std::uint32_t row : rows) {
            const float unit = property == StrokeProperty::intensity ? 1 : pen_unit(views_.drawing_of(row));
            target.push_back(property_at(row, p) / unit);
        }
        const FeatureMatrix features = features_.of_rows(rows, unseen_context());
        const QuantizedFeatures quantized = quantize(features, {}, {});
        const LearnedProperty learned =
            learn_property({features, quantized, target, held_out(rows, {}, options_.seed + 12), quarters(rows)},
                           [&] { progress_(name_of(property)); });
        style_.properties[p] = learned.model;
        if (property == StrokeProperty::length)
            style_.properties[p].factor *= longest_share(learned.model, features, target, rows);
        report_.property[p] = std::sqrt(learned.error);
    }

    /// Returns the rows of strokes that cross no other, or all rows if these are few (below 5% or k_min_samples).
    /// A stroke across the gap between two collinear strokes makes them look like one.
    std::vector<std::uint32_t> rather_uncrossed(std::vector<std::uint32_t> rows) const {
        std::vector<std::uint32_t> uncrossed;
        for (const std::uint32_t row : rows)
            if (!at(row, &DrawingProperties::crossed)) uncrossed.push_back(row);
        return uncrossed.size() < std::max(k_min_samples, rows.size() / 20) ? rows : uncrossed;
    }

    /// Returns the 85th percentile of intended length over predicted length: many strokes are cut short for lack of
    /// room, so the longer ones tell what was intended. Strokes that fill the width of their hatching tell only that
    /// they were meant to be no shorter, so the percentile is that of Kaplan and Meier's estimate (1958).
    float longest_share(const PropertyModel& model, const FeatureMatrix& features, std::span<const float> target,
                        std::span<const std::uint32_t> rows) const {
        constexpr double k_quantile = 0.85;
        std::vector<std::pair<float, bool>> ratios;  // and whether the stroke ended by itself
        for (std::size_t i = 0; i < target.size(); ++i) {
            const float predicted = model.evaluate(
                [&](std::uint32_t k) { return power_of(features.column(k / k_powers)[i], k % k_powers); });
            ratios.emplace_back(target[i] / predicted, at(rows[i], &DrawingProperties::bounded) == 0);
        }
        std::ranges::sort(ratios);
        double longer = 1;
        for (std::size_t i = 0; i < ratios.size(); ++i) {
            if (ratios[i].second) longer *= 1 - 1 / static_cast<double>(ratios.size() - i);
            if (longer <= 1 - k_quantile) return ratios[i].first;
        }
        return ratios.back().first;
    }

    HatchingExamples views_;
    ExampleFeatures features_;
    ExampleFolds folds_;
    const StyleLearningOptions& options_;
    StyleReport& report_;
    const std::function<void(const char*)>& progress_;
    HatchingStyle style_;
    std::vector<std::uint32_t> rule_rows_;  // rows of the stroke pixels that rules are learned from
    std::vector<std::int32_t> segment_;     // segment of each of these rows
    LearnedSegments segments_;
    std::vector<float> boundary_;  // P(e | x) of all pixels, as of pixels that were not learned from
    HeldOutLevels judged_levels_;
    std::vector<std::int32_t> segment_cut_;  // of all pixels, as a prediction would have them
    Stopwatch watch_;
};

}  // namespace

HatchingStyle learn_hatching_style(std::span<const HatchingExample> views, StumpScorer& scorer,
                                   const StyleLearningOptions& options, StyleReport& report,
                                   const std::function<void(const char*)>& progress) {
    return StyleLearning(views, scorer, options, report, progress).run();
}

}  // namespace exemplar
