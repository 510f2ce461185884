#include "host/hatching/style/orientation_function.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "host/core/parallel.h"
#include "host/learn/decompositions.h"

namespace exemplar {
namespace {

/// Histogram of the weights of squared errors in [0, 4], over which a line search sums repeatedly.
class ErrorHistogram {
  public:
    void add(float error, double weight) {
        const auto bin = static_cast<std::size_t>(error * (static_cast<float>(k_bins) / 4));
        weight_[std::min(bin, k_bins - 1)] += weight;
    }
    /// Returns the sum of w exp(r e) / sqrt(r).
    double objective(double r) const {
        double sum = 0;
        for (std::size_t b = 0; b < k_bins; ++b) sum += weight_[b] * std::exp(r * center(b));
        return sum / std::sqrt(r);
    }
    /// Returns the r in [k_least, k_most] that minimizes the objective. The objective is convex in log r, as a sum
    /// of convex functions, so golden-section search finds the minimum.
    double best_r() const {
        constexpr double k_golden = 0.6180339887498949, k_least = 0.05, k_most = 50;
        double low = std::log(k_least), high = std::log(k_most);
        for (int step = 0; step < 24; ++step) {
            const double a = high - k_golden * (high - low), b = low + k_golden * (high - low);
            (objective(std::exp(a)) < objective(std::exp(b)) ? high : low) =
                objective(std::exp(a)) < objective(std::exp(b)) ? b : a;
        }
        return std::exp(0.5 * (low + high));
    }

  private:
    static constexpr std::size_t k_bins = 128;
    static double center(std::size_t b) { return 4 * (static_cast<double>(b) + 0.5) / static_cast<double>(k_bins); }
    std::array<double, k_bins> weight_{};
};

Eigen::Vector2d in_double(const DoubledAngle& v) {
    return {static_cast<double>(v[0]), static_cast<double>(v[1])};
}

Eigen::VectorXd ridge_solution(Eigen::MatrixXd normal, const Eigen::VectorXd& right) {
    normal.diagonal() *= 1 + 1e-4;
    return solve_ldlt(normal, right);
}

class Boosting {
  public:
    explicit Boosting(const OrientationTraining& training) : training_(training), weight_(training.target.size()) {
        for (std::size_t i = 0; i < weight_.size(); ++i)
            weight_[i] = training.held_out[i] ? 0.0 : static_cast<double>(training.weight[i]);
        normalize_weights();
    }

    LearnedOrientation run() {
        if (!(total_ > 0)) return {{}, 4};
        LearnedOrientation best = boost();
        match(best);
        return std::isfinite(best.error) ? best : LearnedOrientation{{}, 4};
    }

  private:
    struct Choice {
        double objective = std::numeric_limits<double>::infinity();
        double r = 1;
        std::uint32_t feature = 0;
    };

    LearnedOrientation boost() {
        LearnedOrientation best;
        best.error = std::numeric_limits<double>::infinity();
        std::vector<OrientationFunction::Term> terms;
        for (std::size_t round = 0; round < training_.max_terms; ++round) {
            const Choice choice = choose(round == 0);
            if (!std::isfinite(choice.objective)) break;
            add_term(terms, choice);
            update_weights(choice);
            OrientationFunction averaged{terms};
            float sum = 0;
            for (const auto& term : averaged.terms) sum += term.weight;
            for (auto& term : averaged.terms) term.weight /= sum;
            // A round that only adds weight to a known feature may still lead to a new one.
            if (!keep_better(averaged, best) && terms.size() > best.function.terms.size()) break;
        }
        return best;
    }

    /// Forward selection by least squares. Averages, as boosting makes them, cannot tell which of two good features
    /// is followed where they differ.
    void match(LearnedOrientation& best) const {
        std::vector<float> weight(training_.weight.begin(), training_.weight.end());
        for (std::size_t i = 0; i < weight.size(); ++i) weight[i] = training_.held_out[i] ? 0 : weight[i];
        const FieldProducts products = field_products(training_.fields, training_.target, weight);
        const std::vector<Eigen::Index> order = select_fields(products, training_.max_terms);
        for (std::size_t count = 1; count <= order.size(); ++count) {
            const std::vector<Eigen::Index> chosen(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
            if (!keep_better(matched(products, chosen), best) && count > best.function.terms.size() + 1) return;
        }
    }

    /// Returns the function of these fields with the best weights: first linear least squares on the vectors, then
    /// Gauss-Newton steps that fit the direction of the sum alone, whatever its length.
    OrientationFunction matched(const FieldProducts& products, const std::vector<Eigen::Index>& chosen) const {
        Eigen::VectorXd weights = ridge_solution(products.normal(chosen, chosen), products.right(chosen));
        if (chosen.size() > 1) {
            for (int step = 0; step < 5; ++step) weights += direction_step(function_of(chosen, weights), weights);
        }
        return function_of(chosen, weights);
    }

    static OrientationFunction function_of(const std::vector<Eigen::Index>& fields, const Eigen::VectorXd& weights) {
        OrientationFunction function;
        for (std::size_t k = 0; k < fields.size(); ++k)
            function.terms.push_back(
                {static_cast<std::uint32_t>(fields[k]), static_cast<float>(weights[static_cast<Eigen::Index>(k)])});
        return function;
    }

    /// Returns the change of weights that turns the function's directions to the targets, to first order. A common
    /// factor of the weights turns nothing and stays. Items with a sum near zero would count too much, so its length
    /// is bounded from below.
    Eigen::VectorXd direction_step(const OrientationFunction& function, const Eigen::VectorXd& weights) const {
        constexpr double k_min_length = 0.1;
        Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(weights.size(), weights.size());
        Eigen::VectorXd right = Eigen::VectorXd::Zero(weights.size()), turn(weights.size());
        Eigen::Matrix2Xd v(2, weights.size());
        for (std::size_t i = 0; i < weight_.size(); ++i) {
            const auto w = static_cast<double>(training_.weight[i]);
            if (training_.held_out[i] || !(w > 0)) continue;
            for (Eigen::Index k = 0; k < weights.size(); ++k)
                v.col(k) = in_double(training_.fields.feature(function.terms[static_cast<std::size_t>(k)].feature, i));
            const Eigen::Vector2d sum = v * weights;
            const double length = sum.norm();
            if (!(length > 0)) continue;
            const Eigen::Vector2d across(-sum.y() / length, sum.x() / length);
            turn = v.transpose() * across / std::max(length, k_min_length);
            right += w * across.dot(in_double(training_.target[i])) * turn;
            normal += w * turn * turn.transpose();
        }
        normal += normal.trace() / std::max(weights.squaredNorm(), 1e-12) * weights * weights.transpose();
        normal.diagonal().array() += 1e-12;
        return ridge_solution(normal, right);
    }

    void normalize_weights() {
        total_ = std::accumulate(weight_.begin(), weight_.end(), 0.0);
        if (total_ > 0) {
            for (double& w : weight_) w /= total_;
        }
    }

    Choice choose(bool first) const {
        std::vector<Choice> choices(k_orientation_features);
        parallel_for(k_orientation_features, [&](std::size_t k) {
            ErrorHistogram histogram;
            bool defined = false;
            for (std::size_t i = 0; i < weight_.size(); ++i) {
                if (!(weight_[i] > 0)) continue;
                const DoubledAngle v = training_.fields.feature(k, i);
                defined = defined || v != DoubledAngle{};
                histogram.add(squared_distance(training_.target[i], v), weight_[i]);
            }
            if (!defined) return;
            const double r = first ? 1 : histogram.best_r();
            choices[k] = {histogram.objective(r), r, static_cast<std::uint32_t>(k)};
        });
        return *std::ranges::min_element(choices, {}, &Choice::objective);
    }

    static void add_term(std::vector<OrientationFunction::Term>& terms, const Choice& choice) {
        for (auto& term : terms) {
            if (term.feature != choice.feature) continue;
            term.weight += static_cast<float>(choice.r);
            return;
        }
        terms.push_back({choice.feature, static_cast<float>(choice.r)});
    }

    void update_weights(const Choice& choice) {
        for (std::size_t i = 0; i < weight_.size(); ++i) {
            if (!(weight_[i] > 0)) continue;
            const DoubledAngle v = training_.fields.feature(choice.feature, i);
            weight_[i] *= std::exp(choice.r * static_cast<double>(squared_distance(training_.target[i], v)));
        }
        normalize_weights();
    }

    /// Replaces the best function by a better one; more features must lower the error by 5%.
    bool keep_better(const OrientationFunction& function, LearnedOrientation& best) const {
        constexpr double k_worth = 0.95;
        const double e = error(function);
        const bool more = function.terms.size() > best.function.terms.size();
        if (!(e < (more ? k_worth : 1) * best.error)) return false;
        best = {function, e};
        return true;
    }

    /// Returns the weighted mean of |u - f|^2 over the held-out items, or over all if none is held out.
    double error(const OrientationFunction& function) const {
        double sums[2][2] = {};
        for (std::size_t i = 0; i < weight_.size(); ++i) {
            const auto w = static_cast<double>(training_.weight[i]);
            if (!(w > 0)) continue;
            const double e =
                static_cast<double>(squared_distance(training_.target[i], function.evaluate(training_.fields, i)));
            sums[training_.held_out[i] ? 1 : 0][0] += w * e;
            sums[training_.held_out[i] ? 1 : 0][1] += w;
        }
        const auto& s = sums[1][1] > 0 ? sums[1] : sums[0];
        return s[1] > 0 ? s[0] / s[1] : 4;
    }

    const OrientationTraining& training_;
    std::vector<double> weight_;  // of boosting; zero where held out
    double total_ = 0;
};

}  // namespace

DoubledAngle OrientationFunction::evaluate(const OrientationFields& fields, std::size_t i) const {
    DoubledAngle sum{};
    for (const Term& term : terms) {
        const DoubledAngle v = fields.feature(term.feature, i);
        sum = {sum[0] + term.weight * v[0], sum[1] + term.weight * v[1]};
    }
    return normalized(sum);
}

FieldProducts& FieldProducts::operator+=(const FieldProducts& other) {
    normal += other.normal;
    right += other.right;
    total += other.total;
    return *this;
}

FieldProducts field_products(const OrientationFields& fields, std::span<const DoubledAngle> target,
                             std::span<const float> weight) {
    constexpr std::size_t k_block = 64;
    FieldProducts products;
    std::vector<std::uint32_t> rows;
    for (std::uint32_t i = 0; i < weight.size(); ++i) {
        if (weight[i] > 0) rows.push_back(i);
    }
    // Blocks of items as columns: one matrix product is many times faster than rank-one updates.
    Eigen::MatrixXd v(k_orientation_fields, 2 * k_block);
    Eigen::VectorXd u(2 * k_block);
    for (std::size_t first = 0; first < rows.size(); first += k_block) {
        v.setZero();
        u.setZero();
        for (std::size_t n = 0; n < std::min(k_block, rows.size() - first); ++n) {
            const std::uint32_t i = rows[first + n];
            const auto w = static_cast<double>(weight[i]);
            const auto column = static_cast<Eigen::Index>(2 * n);
            for (std::size_t k = 0; k < k_orientation_fields; ++k)
                v.block<1, 2>(static_cast<Eigen::Index>(k), column) =
                    std::sqrt(w) * in_double(fields.feature(k, i)).transpose();
            u.segment<2>(column) = std::sqrt(w) * in_double(target[i]);
            products.total += w;
        }
        products.normal.noalias() += v * v.transpose();
        products.right.noalias() += v * u;
    }
    return products;
}

std::vector<Eigen::Index> select_fields(const FieldProducts& products, std::size_t most) {
    std::vector<Eigen::Index> chosen;
    while (chosen.size() < most) {
        double least = std::numeric_limits<double>::infinity();
        Eigen::Index next = -1;
        for (Eigen::Index k = 0; k < products.right.size(); ++k) {
            if (!(products.normal(k, k) > 0) || std::ranges::find(chosen, k) != chosen.end()) continue;
            chosen.push_back(k);
            const double error = least_squares_error(products, chosen);
            chosen.pop_back();
            if (!(error < least)) continue;
            least = error;
            next = k;
        }
        if (next < 0) break;
        chosen.push_back(next);
    }
    return chosen;
}

double least_squares_error(const FieldProducts& products, const std::vector<Eigen::Index>& fields) {
    if (!(products.total > 0)) return 0;
    const Eigen::VectorXd right = products.right(fields);
    const double explained = ridge_solution(products.normal(fields, fields), right).dot(right);
    return 1 - explained / products.total;  // the targets have length 1
}

LearnedOrientation learn_orientation(const OrientationTraining& training) {
    return Boosting(training).run();
}

}  // namespace exemplar
