#include "host/hatching/style/property_model.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/hatching/style/property_factors.h"
#include "host/learn/boosting/boosted_regression.h"
#include "host/learn/decompositions.h"

namespace exemplar {
namespace {

class PropertyLearning {
  public:
    PropertyLearning(const PropertyTraining& training, const std::function<void()>& progress)
        : training_(training), progress_(progress), search_(training), log_target_(training.target.size()) {
        for (std::size_t i = 0; i < log_target_.size(); ++i) log_target_[i] = std::log(training.target[i]);
    }

    LearnedProperty run() {
        LearnedProperty best = constant();
        boost(best);
        select(best);
        return best;
    }

  private:
    static constexpr std::size_t k_patience = 4;
    static constexpr double k_max_exponent = 30;

    void begin() {
        model_ = {};
        values_.clear();
    }

    /// Returns boosting before its first round: all rows that are not held out have the same weight.
    RegressionBoosting equal_weights() const {
        std::vector<double> weights(log_target_.size());
        for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = training_.held_out[i] ? 0 : 1;
        return RegressionBoosting(std::move(weights));
    }

    /// Boosting as in the thesis: every term is fitted to y.
    void boost(LearnedProperty& best) {
        begin();
        search_.set_target(log_target_);
        RegressionBoosting boosting = equal_weights();
        std::size_t idle = 0;
        for (std::size_t round = 0; round < training_.max_terms && idle < k_patience; ++round) {
            check_interrupt();
            if (!add_boosted(boosting)) break;
            PropertyModel averaged = model_;
            normalize_coefficients(averaged.terms, &PropertyModel::Term::exponent);
            const bool better = keep_better(averaged, best), refitted_better = keep_better(refitted(), best);
            idle = better || refitted_better ? 0 : idle + 1;
            progress_();
        }
    }

    /// Forward selection: each term is fitted to the residual of those before it. As boosting fits all terms to y,
    /// it may never reach the second factor of a product.
    void select(LearnedProperty& best) {
        begin();
        const RegressionBoosting unboosted = equal_weights();
        PropertyModel model = constant().model;
        std::size_t idle = 0;
        for (std::size_t round = 0; round < training_.max_terms && idle < k_patience; ++round) {
            check_interrupt();
            std::vector<double> rest(log_target_.size());
            for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = log_target_[i] - log_value(model, i);
            search_.set_target(std::move(rest));
            if (!add_selected(unboosted.weights())) break;
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

    /// Returns log y of a row for a model with the terms of `model_`.
    double log_value(const PropertyModel& model, std::size_t row) const {
        double log_y = std::log(static_cast<double>(model.factor));
        for (std::size_t k = 0; k < model.terms.size(); ++k)
            log_y += static_cast<double>(model.terms[k].exponent) * static_cast<double>(values_[k][row]);
        return log_y;
    }

    /// Adds the term with the smallest squared error; returns false if there is none. Exponents are refitted later,
    /// but a and b should suit about the right one, so several are tried.
    bool add_selected(std::span<const double> weights) {
        constexpr std::array k_exponents{1.0, 0.5, 2.0, -0.5, -1.0};
        const std::vector<FactorCandidate> best = search_.candidates(weights, k_exponents, 1);
        if (best.empty()) return false;
        model_.terms.push_back(best[0].term);
        values_.push_back(search_.log_values(best[0].term));
        return true;
    }

    /// Adds the best weak regressor; returns false if there is none.
    bool add_boosted(RegressionBoosting& boosting) {
        constexpr std::size_t k_finalists = 8;
        RegressionBoosting::Step best;
        std::vector<float> best_values;
        PropertyModel::Term term;
        for (const FactorCandidate& candidate : search_.candidates(boosting.weights(), std::array{1.0}, k_finalists)) {
            std::vector<float> values = search_.log_values(candidate.term);
            const RegressionBoosting::Step step = line_search(boosting, values);
            if (!(step.objective < best.objective)) continue;
            best = step;
            term = candidate.term;
            best_values = std::move(values);
        }
        if (best_values.empty()) return false;
        boosting.add([&](std::size_t i) {
            const double e = log_target_[i] - static_cast<double>(best_values[i]);
            return std::min(best.r * e * e, k_max_exponent);
        });
        term.exponent = static_cast<float>(best.r);
        model_.terms.push_back(term);
        values_.push_back(std::move(best_values));
        return true;
    }

    /// Searches the coefficient of a weak regressor. Its range keeps the exponents of the weights bounded.
    RegressionBoosting::Step line_search(const RegressionBoosting& boosting, std::span<const float> values) const {
        const auto squared_error = [&](std::size_t i) {
            const double e = log_target_[i] - static_cast<double>(values[i]);
            return e * e;
        };
        double largest = 1e-12;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (boosting.weights()[i] > 0) largest = std::max(largest, squared_error(i));
        }
        return boosting.line_search(
            squared_error,
            {.max_error = largest, .max_r = std::min(5000.0, k_max_exponent / largest + 0.1), .bins = 256});
    }

    /// Returns the mean squared error over the held-out rows (over all, if none is held out) of a model with the
    /// terms of `model_`, or with none.
    double error(const PropertyModel& model) const {
        HeldOutError mean;
        for (std::size_t i = 0; i < log_target_.size(); ++i) {
            const double e = log_target_[i] - log_value(model, i);
            mean.add(training_.held_out[i], 1, e * e);
        }
        return mean.mean(0);
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
    FactorSearch search_;
    std::vector<double> log_target_;
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
