#include "host/hatching/orientation_function.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "host/core/parallel.h"

namespace exemplar {
namespace {

/// The weights of squared errors in [0, 4], as a histogram: what a line search sums up again and again.
class ErrorHistogram {
  public:
    void add(float error, double weight) {
        const auto bin = static_cast<std::size_t>(error * (static_cast<float>(k_bins) / 4));
        weight_[std::min(bin, k_bins - 1)] += weight;
    }
    /// sum of w exp(r e) / sqrt(r), and the r in [k_least, k_most] that minimizes it.
    double objective(double r) const {
        double sum = 0;
        for (std::size_t b = 0; b < k_bins; ++b) sum += weight_[b] * std::exp(r * center(b));
        return sum / std::sqrt(r);
    }
    /// The objective is convex in log r: a sum of convex functions; so a golden section search finds its minimum.
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

class Boosting {
  public:
    explicit Boosting(const OrientationTraining& training) : training_(training), weight_(training.target.size()) {
        for (std::size_t i = 0; i < weight_.size(); ++i)
            weight_[i] = training.held_out[i] ? 0.0 : static_cast<double>(training.weight[i]);
        normalize_weights();
    }

    LearnedOrientation run() {
        LearnedOrientation best;
        best.error = std::numeric_limits<double>::infinity();
        std::vector<OrientationFunction::Term> terms;
        if (!(total_ > 0)) return {{}, 4};
        for (std::size_t round = 0; round < training_.most_terms; ++round) {
            const Choice choice = choose(round == 0);
            if (!std::isfinite(choice.objective)) break;
            add_term(terms, choice);
            update_weights(choice);
            if (!keep_better(terms, best)) break;
        }
        return std::isfinite(best.error) ? best : LearnedOrientation{{}, 4};
    }

  private:
    struct Choice {
        double objective = std::numeric_limits<double>::infinity();
        double r = 1;
        std::uint32_t feature = 0;
    };

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

    /// The function of these terms, boosted or refitted, if it is better by enough; false: it is time to stop.
    bool keep_better(const std::vector<OrientationFunction::Term>& terms, LearnedOrientation& best) const {
        constexpr double k_worth = 0.98;
        OrientationFunction boosted{terms};
        float sum = 0;
        for (const auto& term : boosted.terms) sum += term.weight;
        for (auto& term : boosted.terms) term.weight /= sum;
        bool better = false;
        for (const OrientationFunction& function : {boosted, refitted(boosted)}) {
            const double e = error(function);
            // Of functions of the same features the better one, of more features only if they pay.
            const bool same_count = function.terms.size() == best.function.terms.size();
            if (!(e < (same_count ? 1 : k_worth) * best.error)) continue;
            best = {function, e};
            better = true;
        }
        // Rounds that add weight to what is there may lead to a new feature.
        return better || terms.size() <= best.function.terms.size();
    }

    /// Weighted mean of |u - f|^2 over the items that decide.
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

    OrientationFunction refitted(const OrientationFunction& function) const {
        const auto count = static_cast<Eigen::Index>(function.terms.size());
        Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
        Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
        std::vector<DoubledAngle> v(function.terms.size());
        for (std::size_t i = 0; i < weight_.size(); ++i) {
            const auto w = static_cast<double>(training_.weight[i]);
            if (training_.held_out[i] || !(w > 0)) continue;
            for (std::size_t k = 0; k < v.size(); ++k) v[k] = training_.fields.feature(function.terms[k].feature, i);
            const auto product = [](const DoubledAngle& a, const DoubledAngle& b) {
                return static_cast<double>(a[0] * b[0] + a[1] * b[1]);
            };
            for (Eigen::Index a = 0; a < count; ++a) {
                right[a] += w * product(v[static_cast<std::size_t>(a)], training_.target[i]);
                for (Eigen::Index b = 0; b < count; ++b)
                    normal(a, b) += w * product(v[static_cast<std::size_t>(a)], v[static_cast<std::size_t>(b)]);
            }
        }
        normal.diagonal() *= 1 + 1e-4;
        normal.diagonal().array() += 1e-12;
        const Eigen::VectorXd solution = normal.ldlt().solve(right);
        OrientationFunction result = function;
        for (std::size_t k = 0; k < v.size(); ++k)
            result.terms[k].weight = static_cast<float>(solution[static_cast<Eigen::Index>(k)]);
        return result;
    }

    const OrientationTraining& training_;
    std::vector<double> weight_;  // of boosting; zero where held out
    double total_ = 0;
};

}  // namespace

DoubledAngle normalized(const DoubledAngle& v) {
    const float length = std::hypot(v[0], v[1]);
    return length > 1e-6f ? (1 / length) * v : DoubledAngle{};
}

DoubledAngle doubled_angle(float angle) {
    return {std::cos(2 * angle), std::sin(2 * angle)};
}

float angle_of(const DoubledAngle& v) {
    const float angle = 0.5f * std::atan2(v[1], v[0]);
    return angle < 0 ? angle + std::numbers::pi_v<float> : angle;
}

DoubledAngle OrientationFunction::evaluate(const OrientationFields& fields, std::size_t i) const {
    DoubledAngle sum{};
    for (const Term& term : terms) {
        const DoubledAngle v = fields.feature(term.feature, i);
        sum = {sum[0] + term.weight * v[0], sum[1] + term.weight * v[1]};
    }
    return normalized(sum);
}

LearnedOrientation learn_orientation(const OrientationTraining& training) {
    return Boosting(training).run();
}

}  // namespace exemplar
