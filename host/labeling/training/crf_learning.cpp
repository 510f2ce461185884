#include "host/labeling/training/crf_learning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlopt.hpp>

#include "host/core/interrupt.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

constexpr std::array<double, 5> k_grid{0.01, 0.04, 0.17, 0.7, 3.0};  ///< per weight, logarithmic as the range is wide
constexpr double k_least = 0.002, k_largest = 30;                    ///< bounds of the continuous search
constexpr std::array<double, 3> k_prohibitive{100.0, 10.0, 2.0};     ///< tried for labels that never touch
constexpr std::array<double, 4> k_merge_fractions{0.0, 0.1, 0.2, 0.5};
constexpr double k_pair_cost = 0.002;     ///< of the penalty: a compatibility of 2 for every pair must save 0.1 %
constexpr int k_weight_evaluations = 40;  ///< of the search over kappa, lambda, mu
constexpr int k_pair_evaluations = 12;    ///< per touching pair, of the search over everything

/// Eq. 3.9 per mesh, averaged over the labels present, plus a little of Eq. 3.8 to order equal results.
double labeling_error(const CrfExample& example, std::span<const std::int32_t> labels, std::size_t classes) {
    std::vector<double> area(classes, 0), wrong(classes, 0);
    double total = 0, total_wrong = 0;
    for (std::size_t f = 0; f < labels.size(); ++f) {
        const std::int32_t truth = example.truth[f];
        if (truth < 0) continue;
        const double a = example.features->face_area[f];
        const double miss = labels[f] == truth ? 0 : a;
        area[truth] += a, wrong[truth] += miss, total += a, total_wrong += miss;
    }
    double sum = 0;
    int present = 0;
    for (std::size_t c = 0; c < classes; ++c) {
        if (area[c] <= 0) continue;
        sum += wrong[c] / area[c];
        ++present;
    }
    return present && total > 0 ? sum / present + 1e-3 * total_wrong / total : 0;
}

std::vector<std::int32_t> most_probable(const CrfTerms& terms, std::size_t faces) {
    std::vector<std::int32_t> labels(faces);
    for (std::size_t f = 0; f < faces; ++f) {
        const float* unary = terms.unary.data() + f * terms.classes;
        labels[f] = static_cast<std::int32_t>(std::min_element(unary, unary + terms.classes) - unary);
    }
    return labels;
}

/// Evaluates parameter settings and keeps the best one.
class Search {
  public:
    Search(std::span<const CrfExample> examples, std::size_t classes, const std::vector<bool>& touching,
           const std::function<void()>& progress)
        : examples_(examples), classes_(classes), progress_(progress) {
        best_.compatibility.assign(classes * classes, k_prohibitive[0]);
        best_.merge_fraction = 0;
        for (std::size_t a = 0; a < classes; ++a) {
            best_.compatibility[a * classes + a] = 0;
            for (std::size_t b = 0; b < a; ++b) (touching[a * classes + b] ? pairs_ : apart_).push_back({a, b});
        }
        for (const auto& pair : pairs_) set_pair(best_, pair, 1);
    }

    double error_without_cut() const {
        double sum = 0;
        for (const CrfExample& example : examples_)
            sum += labeling_error(example, most_probable(example.terms, example.truth.size()), classes_);
        return sum / static_cast<double>(examples_.size());
    }

    /// Searches the grid over kappa, lambda, mu; mu more coarsely, as the first two matter most.
    void search_grid() {
        for (const double kappa : k_grid)
            for (const double lambda : k_grid)
                for (std::size_t i = 0; i < k_grid.size(); i += 2) {
                    CrfParameters trial = best_;
                    trial.kappa = kappa, trial.lambda = lambda, trial.mu = k_grid[i];
                    judge(trial);
                }
    }

    void search_prohibitive() {
        for (const double value : k_prohibitive) {
            CrfParameters trial = best_;
            for (const auto& pair : apart_) set_pair(trial, pair, value);
            judge(trial);
        }
    }

    void search_merge_fraction() {
        for (const double fraction : k_merge_fractions) {
            CrfParameters trial = best_;
            trial.merge_fraction = fraction;
            judge(trial);
        }
    }

    /// Subplex on the logarithms of the three weights and, if asked for, of the compatibilities of touching pairs.
    void search_continuous(bool with_pairs, int evaluations) {
        std::vector<double> x{std::log(best_.kappa), std::log(best_.lambda), std::log(best_.mu)};
        const CrfParameters start = best_;
        if (with_pairs)
            for (const auto& [a, b] : pairs_) x.push_back(std::log(best_.compatibility[a * classes_ + b]));
        nlopt::opt optimizer(nlopt::LN_SBPLX, static_cast<unsigned>(x.size()));
        optimizer.set_lower_bounds(std::log(k_least));
        optimizer.set_upper_bounds(std::log(k_largest));
        optimizer.set_initial_step(0.7);
        optimizer.set_maxeval(evaluations);
        optimizer.set_xtol_abs(0.02);
        const nlopt::vfunc objective = [](const std::vector<double>& at, std::vector<double>&, void* data) {
            const auto& [search, base] = *static_cast<std::pair<Search*, const CrfParameters*>*>(data);
            return search->judge(search->at(at, *base));
        };
        std::pair<Search*, const CrfParameters*> context(this, &start);
        optimizer.set_min_objective(objective, &context);
        double value = 0;
        for (double& v : x) v = std::clamp(v, std::log(k_least), std::log(k_largest));
        try {
            optimizer.optimize(x, value);
        } catch (const nlopt::roundoff_limited&) {
            // No smaller step changes the error: the best setting is kept already.
        } catch (const std::exception&) {
            check_interrupt();  // NLopt replaces what the objective throws by an error of its own
            throw;
        }
    }

    const CrfParameters& best() const { return best_; }
    double best_error() const { return best_error_; }
    std::size_t evaluations() const { return evaluations_; }
    std::size_t pair_count() const { return pairs_.size(); }

  private:
    using Pair = std::array<std::size_t, 2>;

    void set_pair(CrfParameters& parameters, const Pair& pair, double value) const {
        parameters.compatibility[pair[0] * classes_ + pair[1]] = value;
        parameters.compatibility[pair[1] * classes_ + pair[0]] = value;
    }

    CrfParameters at(const std::vector<double>& x, CrfParameters parameters) const {
        parameters.kappa = std::exp(x[0]), parameters.lambda = std::exp(x[1]), parameters.mu = std::exp(x[2]);
        for (std::size_t i = 3; i < x.size(); ++i) set_pair(parameters, pairs_[i - 3], std::exp(x[i]));
        return parameters;
    }

    /// Returns the penalty, the mean of log^2 L over the touching pairs: a few meshes cannot tell every pair's
    /// compatibility from noise.
    double spread_of_pairs(const CrfParameters& parameters) const {
        double sum = 0;
        for (const auto& [a, b] : pairs_) sum += std::pow(std::log(parameters.compatibility[a * classes_ + b]), 2);
        return pairs_.empty() ? 0 : sum / static_cast<double>(pairs_.size());
    }

    double judge(const CrfParameters& parameters) {
        check_interrupt();
        std::vector<double> errors(examples_.size());
        parallel_for(examples_.size(), [&](std::size_t i) {
            const CrfExample& example = examples_[i];
            std::vector<std::int32_t> labels = solve_crf(*example.features, example.terms, parameters);
            merge_small_components(*example.features, parameters, example.smallest_component, labels);
            errors[i] = labeling_error(example, labels, classes_);
        });
        double mean = 0;
        for (const double error : errors) mean += error / static_cast<double>(errors.size());
        const double cost = mean + k_pair_cost * spread_of_pairs(parameters);
        if (cost < best_cost_) best_cost_ = cost, best_error_ = mean, best_ = parameters;
        ++evaluations_;
        if (progress_) progress_();
        return cost;
    }

    std::span<const CrfExample> examples_;
    std::size_t classes_;
    const std::function<void()>& progress_;
    std::vector<Pair> pairs_, apart_;
    CrfParameters best_;
    double best_cost_ = std::numeric_limits<double>::infinity(), best_error_ = 0;
    std::size_t evaluations_ = 0;
};

std::size_t touching_pairs(std::size_t classes, const std::vector<bool>& touching) {
    std::size_t count = 0;
    for (std::size_t a = 0; a < classes; ++a)
        for (std::size_t b = 0; b < a; ++b) count += touching[a * classes + b] ? 1 : 0;
    return count;
}

}  // namespace

std::size_t crf_search_evaluations(std::size_t classes, const std::vector<bool>& touching) {
    return k_grid.size() * k_grid.size() * 3 + k_prohibitive.size() + k_merge_fractions.size() + k_weight_evaluations +
           touching_pairs(classes, touching) * k_pair_evaluations;
}

CrfParameters learn_crf(std::span<const CrfExample> examples, std::size_t classes, const std::vector<bool>& touching,
                        const std::function<void()>& progress, CrfSearchReport& report) {
    Search search(examples, classes, touching, progress);
    report.error_without_cut = search.error_without_cut();
    search.search_grid();
    search.search_prohibitive();
    search.search_continuous(false, k_weight_evaluations);
    if (search.pair_count() > 0)
        search.search_continuous(true, static_cast<int>(search.pair_count()) * k_pair_evaluations);
    search.search_merge_fraction();
    report.error = search.best_error();
    report.evaluations = search.evaluations();
    return search.best();
}

}  // namespace exemplar
