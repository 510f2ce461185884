#include "host/hatching/rules/orientation_function.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/core/parallel.h"
#include "host/learn/boosting/boosted_regression.h"
#include "host/learn/decompositions.h"

namespace exemplar {
namespace {

Eigen::Vector2d in_double(const DoubledAngle& v) {
    return {static_cast<double>(v[0]), static_cast<double>(v[1])};
}

Eigen::VectorXd ridge_solution(Eigen::MatrixXd normal, const Eigen::VectorXd& right) {
    normal.diagonal() *= 1 + 1e-4;
    return solve_ldlt(normal, right);
}

class OrientationLearning {
  public:
    explicit OrientationLearning(const OrientationTraining& training)
        : training_(training), boosting_(boosting_weights(training)) {}

    LearnedOrientation run() {
        if (std::ranges::none_of(boosting_.weights(), [](double w) { return w > 0; })) return {{}, 4};
        LearnedOrientation best = boost();
        match(best);
        return std::isfinite(best.error) ? best : LearnedOrientation{{}, 4};
    }

  private:
    struct Choice {
        RegressionBoosting::Step step;
        std::uint32_t feature = 0;
    };

    static std::vector<double> boosting_weights(const OrientationTraining& training) {
        std::vector<double> weights(training.target.size());
        for (std::size_t i = 0; i < weights.size(); ++i)
            weights[i] = training.held_out[i] ? 0.0 : static_cast<double>(training.weight[i]);
        return weights;
    }

    LearnedOrientation boost() {
        LearnedOrientation best;
        best.error = std::numeric_limits<double>::infinity();
        std::vector<OrientationFunction::Term> terms;
        for (std::size_t round = 0; round < training_.max_terms; ++round) {
            const Choice choice = choose();
            if (!std::isfinite(choice.step.objective)) break;
            add_term(terms, choice);
            boosting_.add([&](std::size_t i) { return choice.step.r * feature_error(choice.feature, i); });
            OrientationFunction averaged{terms};
            normalize_coefficients(averaged.terms, &OrientationFunction::Term::weight);
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
        for (std::size_t i = 0; i < training_.target.size(); ++i) {
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

    /// Returns |u_i - v_i|^2 of a feature, in [0, 4].
    double feature_error(std::size_t feature, std::size_t i) const {
        return static_cast<double>(squared_distance(training_.target[i], training_.fields.feature(feature, i)));
    }

    Choice choose() const {
        constexpr RegressionBoosting::LineSearch k_search{.max_error = 4, .max_r = 50, .bins = 128};
        std::vector<Choice> choices(k_orientation_features);
        parallel_for(k_orientation_features, [&](std::size_t k) {
            if (!is_defined(k)) return;
            choices[k] = {boosting_.line_search([&](std::size_t i) { return feature_error(k, i); }, k_search),
                          static_cast<std::uint32_t>(k)};
        });
        return *std::ranges::min_element(choices, {}, [](const Choice& choice) { return choice.step.objective; });
    }

    /// Returns whether a feature is defined at an item that is learned from.
    bool is_defined(std::size_t feature) const {
        for (std::size_t i = 0; i < training_.target.size(); ++i) {
            if (boosting_.weights()[i] > 0 && training_.fields.feature(feature, i) != DoubledAngle{}) return true;
        }
        return false;
    }

    static void add_term(std::vector<OrientationFunction::Term>& terms, const Choice& choice) {
        for (auto& term : terms) {
            if (term.feature != choice.feature) continue;
            term.weight += static_cast<float>(choice.step.r);
            return;
        }
        terms.push_back({choice.feature, static_cast<float>(choice.step.r)});
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
        HeldOutError error;
        for (std::size_t i = 0; i < training_.target.size(); ++i) {
            const auto w = static_cast<double>(training_.weight[i]);
            if (!(w > 0)) continue;
            error.add(
                training_.held_out[i], w,
                static_cast<double>(squared_distance(training_.target[i], function.evaluate(training_.fields, i))));
        }
        return error.mean(4);
    }

    const OrientationTraining& training_;
    RegressionBoosting boosting_;
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
    return OrientationLearning(training).run();
}

}  // namespace exemplar
