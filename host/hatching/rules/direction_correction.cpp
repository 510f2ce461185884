#include "host/hatching/rules/direction_correction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

// "k_max,3", "LxN", "e_b,3", "grad V.N,4" among the orientation fields; the first frame is none of them.
constexpr std::array<std::size_t, k_direction_frames> k_field_of_frame{0, 2, 12, 11, 22};

constexpr std::size_t k_correction_rounds = 400, k_rounds_between_judgments = 20, k_correction_patience = 120;
constexpr double k_feature_share = 0.1;
constexpr float k_correction_shrinkage = 0.2f;
constexpr double k_correction_worth = 0.9;  // less gain is the jitter of a hand
constexpr float k_prior_count = 5;          // items that a leaf is assumed to have seen with a value of zero

using Parts = std::array<float, k_direction_parts>;

Parts parts_of(const OrientationFields& fields, std::size_t item) {
    Parts parts;
    for (std::size_t p = 0; p < parts.size(); p += 2) {
        const DoubledAngle v = direction_part(fields, p, item);
        parts[p] = v[0];
        parts[p + 1] = v[1];
    }
    return parts;
}

/// The stump with the largest gain, and its gain.
struct StumpChoice {
    float gain = 0;
    std::uint32_t feature = 0, part = 0;
    std::size_t bin = 0;  // items in bins up to this one are below
    float below = 0, above = 0;
};

/// Sums over the items of a bin.
struct BinSums {
    float count = 0;
    Parts slope{};
};

/// Boosts on some of the items, and follows all of them.
class CorrectionBoosting {
  public:
    CorrectionBoosting(const CorrectionTraining& training, std::vector<std::uint32_t> rows)
        : training_(training), rows_(std::move(rows)), random_(training.seed), direction_(training.target.size()) {
        weigh_rules();
        for (std::size_t i = 0; i < direction_.size(); ++i)
            direction_[i] = correction_.rule_weight[static_cast<std::size_t>(training.segment[i])] * training.rules[i];
        frames_.reserve(direction_.size());
        for (std::size_t i = 0; i < direction_.size(); ++i) frames_.push_back(parts_of(training.fields, i));
        slopes_.resize(rows_.size());
    }

    /// Adds the best stump; returns false if none reduces the error.
    bool add_stump() {
        measure_slopes();
        const std::vector<std::uint32_t> features = some_features();
        std::vector<StumpChoice> choices(features.size());
        parallel_for(
            features.size(), [&](std::size_t k) { choices[k] = best_stump(features[k]); }, 4);
        const StumpChoice& best = *std::ranges::max_element(choices, {}, &StumpChoice::gain);
        if (!(best.gain > 0)) return false;
        const DirectionStump stump{best.feature, training_.features.thresholds[best.feature][best.bin], best.part,
                                   k_correction_shrinkage * best.below, k_correction_shrinkage * best.above};
        correction_.stumps.push_back(stump);
        const std::span<const std::uint8_t> bins = training_.features.column(best.feature);
        for (std::size_t i = 0; i < direction_.size(); ++i) {
            const float weight = bins[i] > best.bin ? stump.above : stump.below;
            const DoubledAngle v = direction_part(training_.fields, stump.part, i);
            direction_[i] = {direction_[i][0] + weight * v[0], direction_[i][1] + weight * v[1]};
        }
        return true;
    }

    /// Returns the mean |u - f|^2 over items, f normalized.
    double error(std::span<const std::uint32_t> items) const {
        double sum = 0;
        for (const std::uint32_t i : items)
            sum += static_cast<double>(squared_distance(training_.target[i], normalized(direction_[i])));
        return items.empty() ? 0 : sum / static_cast<double>(items.size());
    }

    const DirectionCorrection& correction() const { return correction_; }

  private:
    /// The weight of a rule is the mean cosine of what it leaves: 1 if it is exact.
    void weigh_rules() {
        std::vector<float> sum(training_.segments), count(training_.segments);
        for (const std::uint32_t i : rows_) {
            const auto s = static_cast<std::size_t>(training_.segment[i]);
            const DoubledAngle &u = training_.target[i], &v = training_.rules[i];
            sum[s] += u[0] * v[0] + u[1] * v[1];
            count[s] += 1;
        }
        for (std::size_t s = 0; s < sum.size(); ++s)
            correction_.rule_weight.push_back(count[s] > 0 ? std::clamp(sum[s] / count[s], 0.0f, 1.0f) : 0.0f);
    }

    /// The slope of the squared error along each part: the residual's components.
    void measure_slopes() {
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const std::uint32_t i = rows_[k];
            const float x = training_.target[i][0] - direction_[i][0], y = training_.target[i][1] - direction_[i][1];
            for (std::size_t p = 0; p < k_direction_parts; p += 2) {
                const float vx = frames_[i][p], vy = frames_[i][p + 1];
                slopes_[k][p] = x * vx + y * vy;
                slopes_[k][p + 1] = y * vx - x * vy;
            }
        }
    }

    std::vector<std::uint32_t> some_features() {
        const std::size_t all = training_.features.cols();
        std::vector<std::uint32_t> features(all);
        std::iota(features.begin(), features.end(), 0U);
        random_.shuffle(features);
        features.resize(std::max<std::size_t>(1, static_cast<std::size_t>(k_feature_share * static_cast<double>(all))));
        return features;
    }

    StumpChoice best_stump(std::uint32_t feature) const {
        const std::size_t bins = training_.features.thresholds[feature].size() + 1;
        if (bins == 1) return {};
        const std::span<const std::uint8_t> column = training_.features.column(feature);
        std::vector<BinSums> sums(bins);
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            BinSums& bin = sums[column[rows_[k]]];
            bin.count += 1;
            for (std::size_t p = 0; p < k_direction_parts; ++p) bin.slope[p] += slopes_[k][p];
        }
        BinSums all;
        for (const BinSums& bin : sums) {
            all.count += bin.count;
            for (std::size_t p = 0; p < k_direction_parts; ++p) all.slope[p] += bin.slope[p];
        }
        StumpChoice best;
        BinSums below;
        for (std::size_t b = 0; b + 1 < bins; ++b) {
            below.count += sums[b].count;
            for (std::size_t p = 0; p < k_direction_parts; ++p) {
                below.slope[p] += sums[b].slope[p];
                const float low = below.slope[p], high = all.slope[p] - low;
                const float low_count = below.count + k_prior_count,
                            high_count = all.count - below.count + k_prior_count;
                const float gain = low * low / low_count + high * high / high_count;
                if (gain > best.gain)
                    best = {gain, feature, static_cast<std::uint32_t>(p), b, low / low_count, high / high_count};
            }
        }
        return best;
    }

    const CorrectionTraining& training_;
    std::vector<std::uint32_t> rows_;
    Random random_;
    std::vector<DoubledAngle> direction_;  // f, not normalized
    std::vector<Parts> frames_;
    std::vector<Parts> slopes_;  // per learned row
    DirectionCorrection correction_;
};

// Items whose weights are summed together, stump by stump: in the processor's vectors.
constexpr std::size_t k_corrected_together = 256;
using BlockWeights = std::array<std::array<float, k_corrected_together>, k_direction_parts>;

/// Returns the weight of each part for items [first, first + count). `columns`: the feature of each stump.
BlockWeights block_weights(std::span<const DirectionStump> stumps, std::span<const std::span<const float>> columns,
                           std::size_t first, std::size_t count) {
    BlockWeights weights{};
    for (std::size_t k = 0; k < stumps.size(); ++k) {
        const DirectionStump& stump = stumps[k];
        const float* x = columns[k].data() + first;
        float* weight = weights[stump.part].data();
        for (std::size_t i = 0; i < count; ++i) weight[i] += x[i] > stump.threshold ? stump.above : stump.below;
    }
    return weights;
}

}  // namespace

DoubledAngle direction_part(const OrientationFields& fields, std::size_t part, std::size_t item) {
    const std::size_t frame = part / 2;
    const DoubledAngle v = frame == 0 ? DoubledAngle{1, 0} : fields.feature(k_field_of_frame[frame], item);
    return part % 2 == 0 ? v : DoubledAngle{-v[1], v[0]};
}

std::vector<DoubledAngle> corrected_directions(const DirectionCorrection& correction,
                                               std::span<const DoubledAngle> rules,
                                               std::span<const std::int32_t> segment, const OrientationFields& fields,
                                               std::span<const std::uint32_t> which, const FeatureMatrix& features) {
    std::vector<std::span<const float>> columns;
    for (const DirectionStump& stump : correction.stumps) {
        const auto column = std::ranges::find(which, stump.feature);
        if (column == which.end()) throw UsageError("a direction depends on a feature that was not measured");
        columns.push_back(features.column(static_cast<std::size_t>(column - which.begin())));
    }
    std::vector<DoubledAngle> directions(rules.size());
    parallel_ranges(rules.size(), k_corrected_together, [&](std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end; first += k_corrected_together) {
            const std::size_t count = std::min(k_corrected_together, end - first);
            const BlockWeights weights = block_weights(correction.stumps, columns, first, count);
            for (std::size_t i = first; i < first + count; ++i) {
                DoubledAngle f = correction.rule_weight[static_cast<std::size_t>(segment[i])] * rules[i];
                for (std::size_t p = 0; p < k_direction_parts; ++p) {
                    const DoubledAngle v = direction_part(fields, p, i);
                    const float weight = weights[p][i - first];
                    f = {f[0] + weight * v[0], f[1] + weight * v[1]};
                }
                directions[i] = normalized(f);
            }
        }
    });
    return directions;
}

void cross_at_right_angles(std::span<const DoubledAngle> hatches, std::span<DoubledAngle> crossing) {
    for (std::size_t i = 0; i < crossing.size(); ++i)
        if (crossing[i] == DoubledAngle{}) crossing[i] = -1.0f * hatches[i];
}

LearnedCorrection learn_correction(const CorrectionTraining& training, const std::function<void()>& progress) {
    std::vector<std::uint32_t> all(training.target.size()), learned, judges;
    std::iota(all.begin(), all.end(), 0U);
    for (const std::uint32_t i : all) (training.held_out[i] ? judges : learned).push_back(i);
    CorrectionBoosting trial(training, learned);
    LearnedCorrection best;
    best.rule_error = best.error = trial.error(judges);
    std::size_t best_rounds = 0;
    for (std::size_t round = 1; round <= k_correction_rounds && round <= best_rounds + k_correction_patience; ++round) {
        check_interrupt();
        if (!trial.add_stump()) break;
        if (round % k_rounds_between_judgments != 0) continue;
        progress();
        const double error = trial.error(judges);
        if (!(error < best.error)) continue;
        best.error = error;
        best_rounds = round;
    }
    if (best.error > k_correction_worth * best.rule_error) best_rounds = 0;
    CorrectionBoosting whole(training, all);
    for (std::size_t round = 0; round < best_rounds && whole.add_stump(); ++round) {
        check_interrupt();
        progress();
    }
    best.correction = whole.correction();
    return best;
}

}  // namespace exemplar
