#include "host/learn/regression/logistic_regression.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstddef>

namespace exemplar {
namespace {

/// The regression as a problem of minimization over lines (slope, offset).
struct LogisticProblem {
    std::span<const double> value, target, weight;

    /// Returns the log odds of the mean target: the best line without a slope.
    double log_odds() const {
        double sum = 0, all = 0;
        for (std::size_t i = 0; i < target.size(); ++i) sum += weight[i] * target[i], all += weight[i];
        return std::log(sum / (all - sum));
    }
    double loss(const Eigen::Vector2d& line) const {
        double sum = 0;
        for (std::size_t i = 0; i < value.size(); ++i) {
            const double x = line[0] * value[i] + line[1];
            sum += weight[i] * (target[i] * -log_logistic(x) + (1 - target[i]) * -log_logistic(-x));
        }
        return sum;
    }
    Eigen::Vector2d newton_step(const Eigen::Vector2d& line) const {
        Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
        Eigen::Matrix2d curvature = Eigen::Matrix2d::Identity() * 1e-9;
        for (std::size_t i = 0; i < value.size(); ++i) {
            const Eigen::Vector2d x(value[i], 1);
            const double p = logistic(line.dot(x));
            gradient += weight[i] * (p - target[i]) * x;
            curvature += weight[i] * p * (1 - p) * x * x.transpose();
        }
        return -curvature.ldlt().solve(gradient);
    }
    /// Newton's method, with steps that are halved until the loss falls.
    Eigen::Vector2d solve() const {
        Eigen::Vector2d line = Eigen::Vector2d::Zero();
        double least = loss(line);
        for (int round = 0; round < 100; ++round) {
            Eigen::Vector2d step = newton_step(line);
            for (int halving = 0; halving < 30 && !(loss(line + step) < least); ++halving) step /= 2;
            if (!(loss(line + step) < least)) break;
            line += step;
            least = loss(line);
        }
        return line;
    }
};

}  // namespace

LogisticCurve fit_rising_logistic(std::span<const double> x, std::span<const double> target,
                                  std::span<const double> weight) {
    const LogisticProblem problem{x, target, weight};
    const Eigen::Vector2d line = problem.solve();
    if (line[0] > 0) return {line[0], line[1]};
    return {0, problem.log_odds()};  // the loss is convex: no slope is then the best that does not fall
}

}  // namespace exemplar
