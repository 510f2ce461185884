#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace exemplar {

/// A small seeded generator (SplitMix64, Steele et al. 2014) whose sequence is the same on every platform and
/// compiler, unlike the standard library's distributions.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    /// Returns 64 uniformly distributed bits.
    std::uint64_t next() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        return z ^ (z >> 31);
    }
    /// Returns a uniform number in [0, 1).
    double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
    /// Returns a uniform number in [low, high).
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// Returns a uniform integer in [0, count); count > 0.
    std::size_t index(std::size_t count) { return static_cast<std::size_t>(uniform() * static_cast<double>(count)); }
    /// Returns a normal deviate with mean 0 and variance 1 (Box-Muller).
    double normal() {
        const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
        return radius * std::cos(6.283185307179586 * uniform());
    }
    /// Shuffles in place (Fisher-Yates).
    template <typename T>
    void shuffle(std::vector<T>& values) {
        for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[index(i)]);
    }
    /// Returns a generator for an independent sub-task, so that adding draws to one task does not change another.
    Random fork(std::uint64_t task) const { return Random(Random(state_ ^ (task * 0xd1342543de82ef95ULL + 1)).next()); }

  private:
    std::uint64_t state_;
};

}  // namespace exemplar
