#include "host/hatching/style/property_model.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/statistics.h"
#include "host/hatching/features/powers.h"
#include "host/learn/decompositions.h"

namespace exemplar {
namespace {

/// Sums of one bin of a feature.
struct BinSums {
    double weight = 0, target = 0, squares = 0;
};

/// A candidate for the next weak regressor log(a x + b).
struct FactorCandidate {
    double error = std::numeric_limits<double>::infinity();  // weighted mean of squares, up to a constant
    PropertyModel::Term term;
};

class PropertyLearning {
  public:
    PropertyLearning(const PropertyTraining& training, const std::function<void()>& progress)
        : training_(training), progress_(progress), log_target_(training.target.size()), weight_(log_target_.size()) {
        for (std::size_t i = 0; i < log_target_.size(); ++i) log_target_[i] = std::log(training.target[i]);
        measure_bins();
    }

    LearnedProperty run() {
        LearnedProperty best = constant();
        boost(best);
        select(best);
        return best;
    }

  private:
    static constexpr std::size_t k_patience = 4;

    void begin() {
        model_ = {};
        values_.clear();
        for (std::size_t i = 0; i < weight_.size(); ++i) weight_[i] = training_.held_out[i] ? 0 : 1;
    }

    /// Sets the target of the next term, and the lower bound of its values: a quarter of the smallest target.
    void aim_at(std::vector<double> aim) {
        aim_ = std::move(aim);
        least_ = static_cast<float>(0.25 * std::exp(*std::ranges::min_element(aim_)));
    }

    /// Boosting as in the thesis: every term is fitted to y.
    void boost(LearnedProperty& best) {
        begin();
        aim_at(log_target_);
        std::size_t idle = 0;
        for (std::size_t round = 0; round < training_.max_terms && idle < k_patience; ++round) {
            check_interrupt();
            normalize_weights();
            if (!add_boosted(round == 0)) break;
            PropertyModel averaged = model_;
            float sum = 0;
            for (const auto& term : averaged.terms) sum += term.exponent;
            for (auto& term : averaged.terms) term.exponent /= sum;
            const bool better = keep_better(averaged, best), refitted_better = keep_better(refitted(), best);
            idle = better || refitted_better ? 0 : idle + 1;
            progress_();
        }
    }

    /// Forward selection: each term is fitted to the residual of those before it. As boosting fits all terms to y,
    /// it may never reach the second factor of a product.
    void select(LearnedProperty& best) {
        begin();
        normalize_weights();
        PropertyModel model = constant().model;
        std::size_t idle = 0;
        for (std::size_t round = 0; round < training_.max_terms && idle < k_patience; ++round) {
            check_interrupt();
            std::vector<double> rest(log_target_.size());
            for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = log_target_[i] - log_value(model, i);
            aim_at(std::move(rest));
            if (!add_selected()) break;
            model = refitted();
            idle = keep_better(model, best) ? 0 : idle + 1;
            progress_();
        }
    }

    LearnedProperty constant() const {
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < log_target_.size(); ++i) {
            if (training_.held_out[i]) continue;
            sum += log_target_[i];
            count += 1;
        }
        LearnedProperty learned;
        learned.model.factor = static_cast<float>(std::exp(count > 0 ? sum / count : 0));
        learned.error = error(learned.model);
        return learned;
    }

    /// Returns whether the inverses of a feature are usable. Inverses of a feature that is often near zero only mark
    /// where it vanishes: they fit one drawing and do not generalize.
    static bool has_inverses(std::span<const float> column) {
        double sum = 0;
        for (const float x : column) sum += static_cast<double>(std::abs(x));
        const auto tiny = static_cast<float>(1e-3 * sum / static_cast<double>(column.size()));
        const auto count = std::ranges::count_if(column, [&](float x) { return !(std::abs(x) > tiny); });
        return 100 * count < static_cast<std::ptrdiff_t>(column.size());
    }

    /// Computes the median of each bin, which represents its values, and which features have usable inverses.
    void measure_bins() {
        const std::size_t features = training_.features.cols();
        middle_.resize(features);
        inverses_.resize(features);
        parallel_for(features, [&](std::size_t f) {
            const std::span<const float> column = training_.features.column(f);
            const std::span<const std::uint8_t> bins = training_.quantized.column(f);
            inverses_[f] = has_inverses(column) ? 1 : 0;
            std::vector<std::vector<float>> members(training_.quantized.thresholds[f].size() + 1);
            for (std::size_t i = 0; i < column.size(); ++i) {
                if (std::isfinite(column[i])) members[bins[i]].push_back(column[i]);
            }
            for (auto& values : members) {
                if (values.empty()) values.push_back(middle_[f].empty() ? 0.0f : middle_[f].back());
                middle_[f].push_back(upper_median(values));
            }
        });
    }

    void normalize_weights() {
        const double total = std::accumulate(weight_.begin(), weight_.end(), 0.0);
        for (double& w : weight_) w /= total;
    }

    /// Fits a and b for one power of a feature to sums per bin: by regression of y, then by Gauss-Newton steps on
    /// log y.
    FactorCandidate fit(std::uint32_t feature, std::span<const BinSums> sums, std::span<const double> exponents) const {
        const std::vector<float>& middle = middle_[feature / k_powers];
        FactorCandidate candidate;
        candidate.term.feature = feature;
        candidate.term.least = least_;
        std::vector<double> x(sums.size());
        double low = std::numeric_limits<double>::infinity(), high = -low, squares = 0;
        for (std::size_t b = 0; b < sums.size(); ++b) {
            x[b] = static_cast<double>(power_of(middle[b], feature % k_powers));
            if (!(sums[b].weight > 0)) continue;
            low = std::min(low, x[b]);
            high = std::max(high, x[b]);
            squares += sums[b].target * sums[b].target / sums[b].weight;
        }
        if (!(high > low)) return candidate;
        candidate.term.low = static_cast<float>(low);
        candidate.term.high = static_cast<float>(high);
        for (const double exponent : exponents) {
            std::vector<BinSums> scaled(sums.begin(), sums.end());
            for (BinSums& bin : scaled) bin.target /= exponent;
            const auto [a, b, left] = fit_line(x, scaled, low, high);
            // The squared error is that of the bin means plus the variation within bins. The latter is the sum of
            // all squares, equal for all features, minus the squares of the bin means.
            const double error = exponent * exponent * left - squares;
            if (!(error < candidate.error)) continue;
            candidate.term.a = static_cast<float>(a);
            candidate.term.b = static_cast<float>(b);
            candidate.term.exponent = static_cast<float>(exponent);
            candidate.error = error;
        }
        return candidate;
    }

    struct Line {
        double a, b, error;
    };

    /// Minimizes the weighted squares of t - log(a x + b). Works on z = (x - low) / (high - low), which keeps the two
    /// unknowns apart whatever the unit of x.
    Line fit_line(std::span<const double> x, std::span<const BinSums> sums, double low, double high) const {
        const double scale = 1 / (high - low), least = static_cast<double>(least_);
        double a = 0, b = 0, best_a = 0, best_b = 1, best = std::numeric_limits<double>::infinity();
        for (int step = 0; step < 7; ++step) {
            // Weighted normal equations of the linearization around the current line (at first of y itself).
            double s = 0, sz = 0, szz = 0, r = 0, rz = 0, error = 0;
            for (std::size_t k = 0; k < sums.size(); ++k) {
                const double w = sums[k].weight;
                if (!(w > 0)) continue;
                const double z = (x[k] - low) * scale, t = sums[k].target / w;
                const double value = step == 0 ? std::exp(t) : std::max(a * z + b, least);
                const double difference = step == 0 ? std::exp(t) / value : t - std::log(value);
                const double g = w / (value * value);
                s += g;
                sz += g * z;
                szz += g * z * z;
                r += w / value * difference;
                rz += w / value * difference * z;
                if (step > 0) error += w * difference * difference;
            }
            if (step > 0 && error < best) {
                best = error;
                best_a = a;
                best_b = b;
            } else if (step > 0) {
                break;
            }
            const double determinant = s * szz - sz * sz;
            if (!(determinant > 1e-12 * s * szz)) break;
            const double da = (s * rz - sz * r) / determinant, db = (szz * r - sz * rz) / determinant;
            a = step == 0 ? da : a + da;
            b = step == 0 ? db : b + db;
        }
        return {best_a * scale, best_b - best_a * scale * low, best};
    }

    /// Returns at most `count` expanded features: of the k_checked that fit best, those with the lowest
    /// cross-validation error over blocks, as many features fit one shape by chance.
    std::vector<FactorCandidate> candidates(std::span<const double> exponents, std::size_t count) const {
        constexpr std::size_t k_checked = 64;
        std::vector<FactorCandidate> all(training_.features.cols() * k_powers);
        parallel_for(training_.features.cols(), [&](std::size_t f) {
            std::vector<BinSums> sums(middle_[f].size());
            const std::span<const std::uint8_t> bins = training_.quantized.column(f);
            for (std::size_t i = 0; i < weight_.size(); ++i) {
                sums[bins[i]].weight += weight_[i];
                sums[bins[i]].target += weight_[i] * aim_[i];
            }
            for (std::size_t p = 0; p < (inverses_[f] ? k_powers : 2); ++p)
                all[f * k_powers + p] = fit(static_cast<std::uint32_t>(f * k_powers + p), sums, exponents);
        });
        std::erase_if(all, [](const FactorCandidate& candidate) { return !std::isfinite(candidate.error); });
        keep_least(all, k_checked);
        parallel_for(all.size(), [&](std::size_t i) { all[i].error = error_of_blocks(all[i].term); });
        keep_least(all, count);
        return all;
    }

    static void keep_least(std::vector<FactorCandidate>& all, std::size_t count) {
        count = std::min(count, all.size());
        std::ranges::partial_sort(all, all.begin() + static_cast<std::ptrdiff_t>(count), {}, &FactorCandidate::error);
        all.resize(count);
    }

    /// Returns the cross-validation error of a term: squared errors of each block under the curve fitted to the
    /// other blocks, with the exponent of the term.
    double error_of_blocks(const PropertyModel::Term& term) const {
        const std::size_t base = term.feature / k_powers, count = middle_[base].size();
        const double exponent = static_cast<double>(term.exponent);
        const std::vector<BinSums> by_block = sums_by_block(base, exponent);
        std::vector<double> x(count);
        for (std::size_t b = 0; b < count; ++b)
            x[b] = static_cast<double>(power_of(middle_[base][b], term.feature % k_powers));
        double total = 0;
        for (std::size_t block = 0; block < k_property_blocks; ++block) {
            std::vector<BinSums> others(count);
            for (std::size_t i = 0; i < by_block.size(); ++i) {
                if (i / count == block) continue;
                others[i % count].weight += by_block[i].weight;
                others[i % count].target += by_block[i].target;
            }
            const auto [a, b, error] =
                fit_line(x, others, static_cast<double>(term.low), static_cast<double>(term.high));
            for (std::size_t k = 0; k < count; ++k) {
                const BinSums& own = by_block[block * count + k];
                const double value = std::log(std::max(a * x[k] + b, static_cast<double>(least_)));
                total += own.squares - 2 * value * own.target + value * value * own.weight;
            }
        }
        return exponent * exponent * total;
    }

    /// Returns sums, per block and bin of a feature, of the target of a term without its exponent.
    std::vector<BinSums> sums_by_block(std::size_t feature, double exponent) const {
        const std::size_t count = middle_[feature].size();
        std::vector<BinSums> sums(k_property_blocks * count);
        const std::span<const std::uint8_t> bins = training_.quantized.column(feature);
        for (std::size_t i = 0; i < weight_.size(); ++i) {
            BinSums& bin = sums[training_.block[i] * count + bins[i]];
            const double target = aim_[i] / exponent;
            bin.weight += weight_[i];
            bin.target += weight_[i] * target;
            bin.squares += weight_[i] * target * target;
        }
        return sums;
    }

    /// log(a x + b) of a row.
    float log_value(PropertyModel::Term term, std::size_t row) const {
        const float x = training_.features.column(term.feature / k_powers)[row];
        term.exponent = 1;
        return PropertyModel::log_value(term, power_of(x, term.feature % k_powers));
    }
    /// Returns log y of a row for a model with the terms of `model_`.
    double log_value(const PropertyModel& model, std::size_t row) const {
        double log_y = std::log(static_cast<double>(model.factor));
        for (std::size_t k = 0; k < model.terms.size(); ++k)
            log_y += static_cast<double>(model.terms[k].exponent) * static_cast<double>(values_[k][row]);
        return log_y;
    }

    /// Adds the term with the smallest squared error; returns false if there is none. Exponents are refitted later,
    /// but a and b should suit about the right one, so several are tried.
    bool add_selected() {
        constexpr std::array k_exponents{1.0, 0.5, 2.0, -0.5, -1.0};
        const std::vector<FactorCandidate> best = candidates(k_exponents, 1);
        if (best.empty()) return false;
        const PropertyModel::Term& term = best[0].term;
        std::vector<float> values(weight_.size());
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = log_value(term, i);
        model_.terms.push_back(term);
        values_.push_back(std::move(values));
        return true;
    }

    /// Adds the best weak regressor; returns false if there is none.
    bool add_boosted(bool first) {
        constexpr std::size_t k_finalists = 8;
        double best = std::numeric_limits<double>::infinity(), best_r = 1;
        std::vector<float> best_values;
        PropertyModel::Term term;
        for (const FactorCandidate& candidate : candidates(std::array{1.0}, k_finalists)) {
            std::vector<float> values(weight_.size());
            for (std::size_t i = 0; i < values.size(); ++i) values[i] = log_value(candidate.term, i);
            const auto [objective, r] = line_search(values, first);
            if (!(objective < best)) continue;
            best = objective;
            best_r = r;
            term = candidate.term;
            best_values = std::move(values);
        }
        if (best_values.empty()) return false;
        for (std::size_t i = 0; i < weight_.size(); ++i) {
            const double e = log_target_[i] - static_cast<double>(best_values[i]);
            weight_[i] *= std::exp(std::min(best_r * e * e, 30.0));
        }
        term.exponent = static_cast<float>(best_r);
        model_.terms.push_back(term);
        values_.push_back(std::move(best_values));
        return true;
    }

    struct Search {
        double objective, r;
    };
    Search line_search(std::span<const float> values, bool first) const {
        // Histogram of the squared errors up to the largest.
        constexpr std::size_t k_bins = 256;
        std::vector<double> squares(values.size());
        double largest = 1e-12;
        for (std::size_t i = 0; i < squares.size(); ++i) {
            const double e = log_target_[i] - static_cast<double>(values[i]);
            squares[i] = e * e;
            if (weight_[i] > 0) largest = std::max(largest, squares[i]);
        }
        std::array<double, k_bins> sums{};
        const double bin = static_cast<double>(k_bins) / largest;
        for (std::size_t i = 0; i < squares.size(); ++i)
            sums[std::min(static_cast<std::size_t>(squares[i] * bin), k_bins - 1)] += weight_[i];
        const auto objective = [&](double r) {
            double sum = 0;
            for (std::size_t b = 0; b < k_bins; ++b) {
                if (sums[b] > 0) sum += sums[b] * std::exp(r * (static_cast<double>(b) + 0.5) / bin);
            }
            return sum / std::sqrt(r);
        };
        if (first) return {objective(1), 1};
        double low = std::log(0.05), high = std::log(std::min(5000.0, 30 / largest + 0.1));
        constexpr double k_golden = 0.6180339887498949;
        for (int step = 0; step < 24; ++step) {
            const double a = high - k_golden * (high - low), b = low + k_golden * (high - low);
            const bool left = objective(std::exp(a)) < objective(std::exp(b));
            (left ? high : low) = left ? b : a;
        }
        const double r = std::exp(0.5 * (low + high));
        return {objective(r), r};
    }

    /// Returns the mean squared error over the held-out rows (over all, if none is held out) of a model with the
    /// terms of `model_`, or with none.
    double error(const PropertyModel& model) const {
        double sums[2][2] = {};
        for (std::size_t i = 0; i < log_target_.size(); ++i) {
            const double e = log_target_[i] - log_value(model, i);
            sums[training_.held_out[i] ? 1 : 0][0] += e * e;
            sums[training_.held_out[i] ? 1 : 0][1] += 1;
        }
        const auto& s = sums[1][1] > 0 ? sums[1] : sums[0];
        return s[0] / std::max(s[1], 1.0);
    }

    /// Replaces the best model if the error falls by 2%, as fewer features generalize better to other shapes. Gains
    /// below 1e-8 (a root mean square error of a ten-thousandth of y) do not count.
    bool keep_better(const PropertyModel& model, LearnedProperty& best) const {
        constexpr double k_worth = 0.98, k_nothing = 1e-8;
        const double e = error(model);
        if (!(e < k_worth * best.error - k_nothing)) return false;
        best = {model, e};
        return true;
    }

    PropertyModel refitted() const {
        const auto count = static_cast<Eigen::Index>(model_.terms.size());
        Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count + 1, count + 1);
        Eigen::VectorXd right = Eigen::VectorXd::Zero(count + 1), row(count + 1);
        for (std::size_t i = 0; i < log_target_.size(); ++i) {
            if (training_.held_out[i]) continue;
            for (Eigen::Index k = 0; k < count; ++k)
                row[k] = static_cast<double>(values_[static_cast<std::size_t>(k)][i]);
            row[count] = 1;
            normal += row * row.transpose();
            right += log_target_[i] * row;
        }
        // The ridge shrinks the exponents of redundant terms to zero; the constant is not penalized.
        const double n = normal(count, count);
        for (Eigen::Index k = 0; k < count; ++k) {
            const double mean = normal(k, count) / n;
            normal(k, k) += 0.003 * (normal(k, k) - n * mean * mean) + 1e-9;
        }
        const Eigen::VectorXd solution = solve_ldlt(normal, right);
        PropertyModel model = model_;
        for (Eigen::Index k = 0; k < count; ++k)
            model.terms[static_cast<std::size_t>(k)].exponent = static_cast<float>(solution[k]);
        model.factor = static_cast<float>(std::exp(solution[count]));
        return model;
    }

    const PropertyTraining& training_;
    const std::function<void()>& progress_;
    std::vector<double> log_target_, weight_;
    std::vector<double> aim_;                 // logarithm of the target of the next term
    float least_ = 0;                         // lower bound of its values
    std::vector<std::vector<float>> middle_;  // per base feature and bin
    std::vector<std::uint8_t> inverses_;      // per base feature: 1 if 1/x and 1/x^2 are used
    PropertyModel model_;                     // exponents of boosted terms are r
    std::vector<std::vector<float>> values_;  // per term and row: log(a x + b)
};

}  // namespace

float PropertyModel::log_value(const Term& term, float x) {
    const float inside = x > term.low ? std::min(x, term.high) : term.low;
    return term.exponent * std::log(std::max(term.a * inside + term.b, term.least));
}

LearnedProperty learn_property(const PropertyTraining& training, const std::function<void()>& progress) {
    const std::size_t rows = training.features.rows;
    if (rows == 0 || training.target.size() != rows || training.held_out.size() != rows ||
        training.block.size() != rows || training.quantized.rows != rows)
        throw UsageError(
            "a property is learned from rows of features, one value each; their numbers differ or are zero");
    for (const std::uint8_t block : training.block) {
        if (block >= k_property_blocks) throw UsageError("a property is learned from rows of four blocks at most");
    }
    for (const float y : training.target) {
        if (!(y > 0) || !std::isfinite(y))
            throw DataError("a property is learned from values that are positive and finite");
    }
    return PropertyLearning(training, progress).run();
}

}  // namespace exemplar
