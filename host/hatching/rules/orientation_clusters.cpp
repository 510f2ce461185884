#include "host/hatching/rules/orientation_clusters.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "host/core/random.h"
#include "host/core/statistics.h"

namespace exemplar {
namespace {

constexpr std::uint32_t k_unassigned = 0xFFFFFFFF;

/// Returns the squared distance of doubled angles whose directions differ by `angle` radians.
float squared_distance_of(float angle) {
    return 2 - 2 * std::cos(2 * angle);
}

/// Returns the median difference between the directions of neighbors, at least 15 degrees, as a squared distance.
float growth_threshold(const OrientationSamples& samples, const SampleNeighbors& neighbors) {
    // A lower threshold splits noise-free curved hatching into slivers.
    constexpr float k_least = 15 * std::numbers::pi_v<float> / 180;
    std::vector<float> medians, differences;
    for (std::size_t i = 0; i < samples.size(); i += 7) {
        differences.clear();
        for (const std::uint32_t near : neighbors.of(i))
            differences.push_back(squared_distance(samples.direction[i], samples.direction[near]));
        medians.push_back(upper_median(differences));
    }
    return std::max(upper_median(medians), squared_distance_of(k_least));
}

/// A cluster that grows: its one or two mean directions.
struct Growing {
    std::uint8_t level = 1;  // of its strokes
    std::array<DoubledAngle, 2> sum{};
    std::array<std::size_t, 2> count{};

    float difference(std::size_t j, const DoubledAngle& direction) const {
        return count[j] ? squared_distance(normalized(sum[j]), direction) : 4.0f;
    }
    void add(std::size_t j, const DoubledAngle& direction) {
        sum[j] = {sum[j][0] + direction[0], sum[j][1] + direction[1]};
        ++count[j];
    }
};

class Growth {
  public:
    Growth(const OrientationSamples& samples, std::uint64_t seed)
        : samples_(samples),
          neighbors_(sample_neighbors(samples, 1.5f)),
          threshold_(growth_threshold(samples, neighbors_)),
          random_(seed),
          cluster_(samples.size(), k_unassigned),
          second_(samples.size()) {}

    OrientationClusters run(std::size_t most) {
        std::vector<std::uint32_t> order(samples_.size());
        std::iota(order.begin(), order.end(), 0U);
        random_.shuffle(order);
        for (const std::uint32_t seed : order) {
            if (cluster_[seed] == k_unassigned) grow(seed);
        }
        return sorted(most);
    }

  private:
    void grow(std::uint32_t seed) {
        const auto number = static_cast<std::uint32_t>(growing_.size());
        // A cluster holds one level: otherwise two regions of single strokes could pass for the two directions of
        // the cross-hatching between them, and no later step would separate them.
        Growing cluster{samples_.level[seed]};
        std::vector<std::uint32_t> open{seed};
        take(seed, number, 0, cluster);
        while (!open.empty()) {
            // A random member, so that the cluster grows to all sides.
            std::swap(open[random_.index(open.size())], open.back());
            const std::uint32_t at = open.back();
            open.pop_back();
            for (const std::uint32_t near : neighbors_.of(at)) {
                if (cluster_[near] != k_unassigned || samples_.level[near] != cluster.level) continue;
                const int j = direction_for(near, cluster);
                if (j < 0) continue;
                take(near, number, static_cast<std::size_t>(j), cluster);
                open.push_back(near);
            }
        }
        growing_.push_back(cluster);
    }

    /// Returns which of the cluster's directions a sample follows; -1: none.
    int direction_for(std::uint32_t i, const Growing& cluster) const {
        const float first = cluster.difference(0, samples_.direction[i]);
        const float second = cluster.difference(1, samples_.direction[i]);
        if (std::min(first, second) < threshold_) return second < first ? 1 : 0;
        // Start of cross-hatching: a second direction, well apart from the first.
        constexpr float k_apart = 30 * std::numbers::pi_v<float> / 180;
        return samples_.level[i] == 2 && cluster.count[1] == 0 && first > squared_distance_of(k_apart) ? 1 : -1;
    }

    void take(std::uint32_t i, std::uint32_t number, std::size_t j, Growing& cluster) {
        cluster_[i] = number;
        second_[i] = static_cast<std::uint8_t>(j);
        cluster.add(j, samples_.direction[i]);
    }

    /// Keeps the largest clusters by decreasing size; samples of the others join them.
    OrientationClusters sorted(std::size_t most) {
        std::vector<std::uint32_t> order(growing_.size());
        std::iota(order.begin(), order.end(), 0U);
        const auto size = [&](std::uint32_t c) { return growing_[c].count[0] + growing_[c].count[1]; };
        std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) { return size(a) > size(b); });
        // Less than 1% of the samples is too little to learn a rule from.
        while (order.size() > 1 && (order.size() > most || 100 * size(order.back()) < samples_.size()))
            order.pop_back();
        std::vector<std::uint32_t> place(growing_.size(), k_unassigned);
        for (std::uint32_t k = 0; k < order.size(); ++k) place[order[k]] = k;
        OrientationClusters out{order.size(), std::vector<std::uint32_t>(samples_.size()), std::move(second_),
                                std::vector<std::uint8_t>(order.size())};
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            out.cluster[i] = place[cluster_[i]];
            if (out.cluster[i] == k_unassigned) join(i, order, out);
        }
        name_directions(out);
        return out;
    }

    void join(std::size_t i, std::span<const std::uint32_t> kept, OrientationClusters& out) const {
        float best = 9;
        for (std::uint32_t k = 0; k < kept.size(); ++k) {
            const Growing& cluster = growing_[kept[k]];
            for (std::size_t j = 0; j < 2; ++j) {
                // The penalty of 4 prefers clusters of the sample's own level.
                const float difference =
                    cluster.difference(j, samples_.direction[i]) + (cluster.level == samples_.level[i] ? 0.0f : 4.0f);
                if (!(difference < best)) continue;
                best = difference;
                out.cluster[i] = k;
                out.second[i] = static_cast<std::uint8_t>(j);
            }
        }
    }

    /// Finds the cross-hatched clusters and which of their directions is dominant.
    void name_directions(OrientationClusters& out) const {
        // Counts of all, cross-hatched, second-direction, and second-direction single-stroke samples.
        std::vector<std::array<std::size_t, 4>> counts(out.count);
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            auto& [all, crossed, seconds, single_seconds] = counts[out.cluster[i]];
            ++all;
            crossed += samples_.level[i] == 2 ? 1 : 0;
            seconds += out.second[i];
            single_seconds += samples_.level[i] == 1 ? out.second[i] : 0;
        }
        for (std::size_t c = 0; c < out.count; ++c)
            out.cross[c] = 10 * counts[c][1] > counts[c][0] && counts[c][2] > 0 ? 1 : 0;
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const std::uint32_t c = out.cluster[i];
            if (!out.cross[c]) out.second[i] = 0;
            const auto& [all, crossed, seconds, single_seconds] = counts[c];
            // Single strokes decide if there are any, else all samples do.
            const bool swap = crossed < all ? 2 * single_seconds > all - crossed : 2 * seconds > all;
            if (out.cross[c] && swap) out.second[i] ^= 1;
        }
    }

    const OrientationSamples& samples_;
    SampleNeighbors neighbors_;
    float threshold_;
    Random random_;
    std::vector<std::uint32_t> cluster_;
    std::vector<std::uint8_t> second_;
    std::vector<Growing> growing_;
};

}  // namespace

OrientationClusters grow_clusters(const OrientationSamples& samples, std::size_t most, std::uint64_t seed) {
    if (samples.size() == 0) return {};
    return Growth(samples, seed).run(most);
}

}  // namespace exemplar
