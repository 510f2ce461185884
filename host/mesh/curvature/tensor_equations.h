#pragma once

#include <array>
#include <cstddef>

namespace exemplar {

/// Normal equations of the least-squares fit of a symmetric tensor with N distinct components (3: second fundamental
/// form, 4: its derivative) to changes along steps (u, v). With N = 3 a change has the two components of a normal;
/// with N = 4 the three of a form (II11, II12, II22), of which the middle one counts twice, as it occurs twice in
/// the tensor.
template <std::size_t N>
class TensorEquations {
  public:
    using Change = std::array<double, N - 1>;

    void add(double u, double v, const Change& change, double weight = 1) {
        uu_ += weight * u * u;
        uv_ += weight * u * v;
        vv_ += weight * v * v;
        for (std::size_t i = 0; i < N - 1; ++i) {
            right_[i] += weight * multiplicity(i) * u * change[i];
            right_[i + 1] += weight * multiplicity(i) * v * change[i];
        }
    }

    /// Returns whether the steps span the plane well enough for a solution.
    bool solvable() const { return uu_ * vv_ - uv_ * uv_ > 1e-9 * (uu_ + vv_) * (uu_ + vv_); }

    std::array<double, N> solve() const {
        std::array<double, N> diagonal{}, x = right_;
        for (std::size_t i = 0; i < N - 1; ++i) {
            diagonal[i] += multiplicity(i) * uu_;
            diagonal[i + 1] += multiplicity(i) * vv_;
        }
        for (std::size_t i = 1; i < N; ++i) {
            const double off = multiplicity(i - 1) * uv_, factor = off / diagonal[i - 1];
            diagonal[i] -= factor * off;
            x[i] -= factor * x[i - 1];
        }
        x[N - 1] /= diagonal[N - 1];
        for (std::size_t i = N - 1; i-- > 0;) x[i] = (x[i] - multiplicity(i) * uv_ * x[i + 1]) / diagonal[i];
        return x;
    }

    /// Returns the squared difference between the change that tensor `x` predicts for the step and `change`.
    static double squared_residual(const std::array<double, N>& x, double u, double v, const Change& change) {
        double sum = 0;
        for (std::size_t i = 0; i < N - 1; ++i) {
            const double r = u * x[i] + v * x[i + 1] - change[i];
            sum += multiplicity(i) * r * r;
        }
        return sum;
    }

  private:
    static constexpr double multiplicity(std::size_t i) { return N == 4 && i == 1 ? 2 : 1; }

    double uu_ = 0, uv_ = 0, vv_ = 0;
    std::array<double, N> right_{};
};

}  // namespace exemplar
