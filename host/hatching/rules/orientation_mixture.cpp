#include "host/hatching/rules/orientation_mixture.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/statistics.h"
#include "host/hatching/rules/orientation_clusters.h"

namespace exemplar {
namespace {

constexpr double k_min_share = 0.04;
constexpr float k_crossing_distance = 1;  // |u - v|^2 of directions 30 degrees apart; crossing strokes exceed it
constexpr double k_min_variance = 1e-3;   // of |u - f|^2: noise of about a degree
constexpr float k_gate_radius = 2;        // in spacings

/// An expert with its columns of gamma and beta.
struct Expert {
    OrientationRule rule;
    bool cross = false;
    double share = 0;                          // pi_c
    std::array<double, 2> part{1, 0};          // pi_cj
    double variance = 0.1;                     // s_c
    std::vector<float> gamma;                  // per sample
    std::vector<float> beta;                   // per sample: of the first direction
    std::vector<std::array<float, 2>> errors;  // r_icj
    std::vector<float> nearest;                // r_ic of Eq. 4.12
    std::vector<float> error;                  // the same, median filtered
    std::array<FieldProducts, 2> products;     // of each direction, for the search for pairs to merge
};

class Mixture {
  public:
    Mixture(const OrientationSamples& samples, const MixtureOptions& options, const std::function<void()>& progress)
        : samples_(samples),
          options_(options),
          progress_(progress),
          neighbors_(sample_neighbors(samples, 1)),
          gate_neighbors_(sample_neighbors(samples, k_gate_radius)) {
        const OrientationClusters clusters = grow_clusters(samples, options.max_clusters, options.seed);
        held_out_ = held_out_rectangles(samples.x, samples.y, clusters.cluster, options.held_out, options.seed + 1);
        experts_.resize(clusters.count);
        for (std::size_t c = 0; c < clusters.count; ++c) {
            experts_[c].cross = clusters.cross[c] != 0;
            experts_[c].gamma.resize(samples.size());
            experts_[c].beta.assign(samples.size(), 1);
        }
        for (std::size_t i = 0; i < samples.size(); ++i) {
            experts_[clusters.cluster[i]].gamma[i] = 1;
            if (clusters.second[i]) experts_[clusters.cluster[i]].beta[i] = 0;
        }
    }

    OrientationMixture run() {
        // First with the spatial gate: without it, regions whose directions agree at a common border take parts of
        // each other. But with it, a region may keep a rule of its own only because its samples lie together, so a
        // second run without it may do with fewer rules.
        converge_and_merge();
        if (experts_.size() == 1) return result();
        const std::vector<Expert> told_by_place = experts_;
        by_place_ = false;
        converge_and_merge();
        if (experts_.size() == told_by_place.size()) experts_ = told_by_place;
        return result();
    }

  private:
    void converge_and_merge() {
        converge();
        while (merge_best_pair()) converge();
    }

    void converge() {
        double last = -1;
        for (std::size_t iteration = 0; iteration < options_.iterations; ++iteration) {
            check_interrupt();
            for (Expert& expert : experts_) {
                if (iteration > 0) update_kind(expert);
                update_model(expert);
            }
            update_variance();
            const double error = update_labels();
            dissolve_small();
            progress_();
            if (last >= 0 && std::abs(error - last) < 1e-3 * last + 1e-6) break;
            last = error;
        }
    }

    /// Decides again whether a segment is cross-hatched (more than 10%, as for clusters), as its border has moved.
    void update_kind(Expert& expert) const {
        double all = 0, crossed = 0;
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            all += static_cast<double>(expert.gamma[i]);
            crossed += samples_.level[i] == 2 ? static_cast<double>(expert.gamma[i]) : 0;
        }
        const bool cross = crossed > 0.1 * all;
        if (cross == expert.cross) return;
        expert.cross = cross;
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const bool second = cross && samples_.level[i] == 2 && expert.errors[i][0] > k_crossing_distance;
            expert.beta[i] = second ? 0.0f : 1.0f;
        }
    }

    void update_model(Expert& expert) const {
        expert.rule = {};
        for (std::size_t j = 0; j < (expert.cross ? 2U : 1U); ++j) {
            std::vector<float> weight(samples_.size());
            for (std::size_t i = 0; i < weight.size(); ++i)
                weight[i] = expert.gamma[i] * (j == 0 ? expert.beta[i] : 1 - expert.beta[i]);
            expert.rule.function[j] =
                learn_orientation({samples_.fields, samples_.direction, weight, held_out_}).function;
        }
        measure_errors(expert);
    }

    void measure_errors(Expert& expert) const {
        expert.errors.resize(samples_.size());
        expert.nearest.resize(samples_.size());
        parallel_for(
            samples_.size(),
            [&](std::size_t i) {
                for (std::size_t j = 0; j < 2; ++j) {
                    const OrientationFunction& function = expert.rule.function[j];
                    expert.errors[i][j] =
                        function.terms.empty()
                            ? 4.0f
                            : squared_distance(samples_.direction[i], function.evaluate(samples_.fields, i));
                }
                // Single strokes follow the first direction. Otherwise a region with another rule could pass for the
                // second direction of a cross-hatched neighbor.
                expert.nearest[i] =
                    samples_.level[i] == 1 ? expert.errors[i][0] : std::min(expert.errors[i][0], expert.errors[i][1]);
            },
            1024);
        expert.error.resize(samples_.size());
        parallel_ranges(samples_.size(), 256, [&](std::size_t begin, std::size_t end) {
            std::array<std::vector<float>, 2> around;
            for (std::size_t i = begin; i < end; ++i) expert.error[i] = filtered(expert.nearest, i, around);
        });
    }

    /// Returns the median error of the neighbors of a sample's level. Where strokes cross, there is one median per
    /// direction, averaged by count: a common median sees only the more frequent direction and would accept a rule
    /// that ignores the other. `around` is scratch memory.
    float filtered(const std::vector<float>& errors, std::size_t i, std::array<std::vector<float>, 2>& around) const {
        for (auto& side : around) side.clear();
        for (const std::uint32_t near : neighbors_.of(i)) {
            if (samples_.level[near] != samples_.level[i]) continue;
            const bool across = samples_.level[i] == 2 &&
                                squared_distance(samples_.direction[i], samples_.direction[near]) > k_crossing_distance;
            around[across ? 1 : 0].push_back(errors[near]);
        }
        float sum = 0;
        for (auto& side : around) {
            if (side.empty()) continue;
            sum += static_cast<float>(side.size()) * upper_median(side);
        }
        return sum / static_cast<float>(around[0].size() + around[1].size());
    }

    /// Eqs. 4.13, 4.14.
    void update_variance() {
        const auto count = static_cast<double>(samples_.size());
        variance_ = 0;
        for (Expert& expert : experts_) {
            double gamma = 0, first = 0, second = 0, variance = 0;
            for (std::size_t i = 0; i < samples_.size(); ++i) {
                const auto g = static_cast<double>(expert.gamma[i]), b = static_cast<double>(expert.beta[i]);
                gamma += g;
                variance_ += g * static_cast<double>(expert.error[i]) / count;
                first += g * b;
                second += g * (1 - b);
                variance += g * (b * static_cast<double>(expert.errors[i][0]) +
                                 (expert.cross ? (1 - b) * static_cast<double>(expert.errors[i][1]) : 0));
            }
            expert.share = gamma / count;
            if (!(gamma > 0)) continue;
            expert.part = {first / gamma, second / gamma};
            expert.variance = std::max(variance / gamma, k_min_variance);
        }
        variance_ = std::max(variance_, k_min_variance);
    }

    /// Returns the prior that replaces pi_c: the mean gamma of the neighbors, with pi_c as one more neighbor.
    double gate(const std::vector<float>& gamma, double share, std::size_t i) const {
        double sum = share;
        for (const std::uint32_t near : gate_neighbors_.of(i)) sum += static_cast<double>(gamma[near]);
        return sum / static_cast<double>(1 + gate_neighbors_.of(i).size());
    }

    /// Updates gamma and beta (Eqs. 4.10, 4.11); returns the mean error under the new labels.
    double update_labels() {
        std::vector<std::vector<float>> before;
        for (const Expert& e : experts_) before.push_back(e.gamma);
        std::vector<double> mean(samples_.size());
        parallel_for(
            samples_.size(),
            [&](std::size_t i) {
                double sum = 0, least = 4;
                for (const Expert& e : experts_) least = std::min(least, static_cast<double>(e.error[i]));
                for (std::size_t c = 0; c < experts_.size(); ++c) {
                    Expert& e = experts_[c];
                    const double prior = by_place_ ? gate(before[c], e.share, i) : e.share;
                    // Relative to the smallest error, so that the sum cannot vanish.
                    const double above = static_cast<double>(e.error[i]) - least;
                    e.gamma[i] = static_cast<float>(prior * std::exp(-above / (2 * variance_)));
                    sum += static_cast<double>(e.gamma[i]);
                    if (e.cross) e.beta[i] = samples_.level[i] == 1 ? 1.0f : first_part(e, i);
                }
                for (Expert& e : experts_) {
                    e.gamma[i] = static_cast<float>(static_cast<double>(e.gamma[i]) / sum);
                    mean[i] += static_cast<double>(e.gamma[i]) * static_cast<double>(e.error[i]);
                }
            },
            1024);
        return std::accumulate(mean.begin(), mean.end(), 0.0) / static_cast<double>(mean.size());
    }

    static float first_part(const Expert& e, std::size_t i) {
        const double difference = static_cast<double>(e.errors[i][1] - e.errors[i][0]);
        const double odds = e.part[1] / std::max(e.part[0], 1e-6) * std::exp(-difference / (2 * e.variance));
        return static_cast<float>(1 / (1 + odds));
    }

    double share_of(const Expert& expert) const {
        return static_cast<double>(std::accumulate(expert.gamma.begin(), expert.gamma.end(), 0.0)) /
               static_cast<double>(samples_.size());
    }

    void dissolve_small() {
        for (Expert& expert : experts_) expert.share = share_of(expert);
        while (experts_.size() > 1) {
            const auto smallest = std::ranges::min_element(experts_, {}, &Expert::share);
            if (smallest->share >= k_min_share) return;
            experts_.erase(smallest);
            for (std::size_t i = 0; i < samples_.size(); ++i) {
                float sum = 0;
                for (const Expert& e : experts_) sum += e.gamma[i];
                for (Expert& e : experts_)
                    e.gamma[i] = sum > 0 ? e.gamma[i] / sum : 1 / static_cast<float>(experts_.size());
            }
            for (Expert& expert : experts_) expert.share = share_of(expert);
        }
    }

    /// Merges two experts; `swapped`: the first direction of one is the second of the other.
    Expert merged(const Expert& a, const Expert& b, bool swapped) const {
        Expert expert;
        expert.cross = a.cross || b.cross;
        expert.gamma.resize(samples_.size());
        expert.beta.resize(samples_.size());
        const bool turn_a = swapped && !b.cross, turn_b = swapped && b.cross;
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const float sum = a.gamma[i] + b.gamma[i];
            expert.gamma[i] = sum;
            const float of_a = turn_a ? 1 - a.beta[i] : a.beta[i], of_b = turn_b ? 1 - b.beta[i] : b.beta[i];
            const bool single = !(sum > 0) || samples_.level[i] == 1;
            expert.beta[i] = single ? 1.0f : (a.gamma[i] * of_a + b.gamma[i] * of_b) / sum;
        }
        expert.share = a.share + b.share;
        update_model(expert);
        return expert;
    }

    struct Pair {
        std::size_t a, b;
        bool swapped;
        double loss;
    };

    /// Returns all pairs, sorted by the increase of error under a common rule as estimated by least squares with
    /// three fields per direction.
    std::vector<Pair> promising_pairs() {
        parallel_for(experts_.size(), [&](std::size_t c) {
            Expert& e = experts_[c];
            for (std::size_t j = 0; j < 2; ++j) {
                std::vector<float> weight(samples_.size());
                for (std::size_t i = 0; i < weight.size(); ++i)
                    weight[i] = e.gamma[i] * (j == 0 ? e.beta[i] : 1 - e.beta[i]);
                e.products[j] = field_products(samples_.fields, samples_.direction, weight);
            }
        });
        constexpr std::size_t k_fields = 3;
        const auto squares = [&](const FieldProducts& products) {
            return products.total * least_squares_error(products, select_fields(products, k_fields));
        };
        const auto both = [&](const FieldProducts& x, const FieldProducts& y) {
            FieldProducts sum = x;
            return squares(sum += y);
        };
        std::vector<double> alone(experts_.size());
        for (std::size_t c = 0; c < alone.size(); ++c)
            alone[c] = squares(experts_[c].products[0]) + squares(experts_[c].products[1]);
        std::vector<Pair> pairs;
        for (std::size_t a = 0; a < experts_.size(); ++a) {
            for (std::size_t b = a + 1; b < experts_.size(); ++b) {
                for (const bool swapped : {false, true}) {
                    if (swapped && !experts_[a].cross && !experts_[b].cross) continue;
                    pairs.push_back({a, b, swapped, 0});
                }
            }
        }
        parallel_for(pairs.size(), [&](std::size_t k) {
            const Expert &x = experts_[pairs[k].a], &y = experts_[pairs[k].b];
            const double together = both(x.products[0], y.products[pairs[k].swapped ? 1 : 0]) +
                                    both(x.products[1], y.products[pairs[k].swapped ? 0 : 1]);
            const double weight = static_cast<double>(samples_.size()) * (x.share + y.share);
            pairs[k].loss = (together - alone[pairs[k].a] - alone[pairs[k].b]) / std::max(weight, 1e-9);
        });
        std::ranges::stable_sort(pairs, {}, &Pair::loss);
        return pairs;
    }

    /// Returns whether one rule explains the samples of two experts: on the held-out samples (on all, if none is
    /// held out), its error is at most 10% above theirs, plus noise of a degree. Where a third expert fits a sample
    /// better than the one rule, that expert's error counts, as the sample lies across a border.
    bool explains_as_well(const Expert& one, const Expert& a, const Expert& b) const {
        std::array<double, 2> together{}, apart{}, weight{};  // training samples, held-out samples
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const Expert* best = &one;
            for (const Expert& e : experts_) {
                if (&e != &a && &e != &b && e.error[i] < best->error[i]) best = &e;
            }
            const auto capped = [i](const Expert& e) {
                return static_cast<double>(std::min(e.nearest[i], k_crossing_distance));
            };
            const auto of_a = static_cast<double>(a.gamma[i]), of_b = static_cast<double>(b.gamma[i]);
            const std::size_t set = held_out_[i] ? 1 : 0;
            together[set] += (of_a + of_b) * capped(*best);
            apart[set] += of_a * capped(a) + of_b * capped(b);
            weight[set] += of_a + of_b;
        }
        const std::size_t judge = weight[1] > 0 ? 1 : 0;
        return together[judge] <= 1.1 * apart[judge] + k_min_variance * weight[judge];
    }

    /// Merges a pair that one rule explains as well as two; returns false if there is none.
    bool merge_best_pair() {
        constexpr std::size_t k_tried = 6;
        std::vector<Pair> pairs = promising_pairs();
        for (std::size_t k = 0; k < std::min(k_tried, pairs.size()); ++k) {
            check_interrupt();
            const Expert &x = experts_[pairs[k].a], &y = experts_[pairs[k].b];
            Expert expert = merged(x, y, pairs[k].swapped);
            progress_();
            if (!explains_as_well(expert, x, y)) continue;
            experts_[pairs[k].a] = std::move(expert);
            experts_.erase(experts_.begin() + static_cast<std::ptrdiff_t>(pairs[k].b));
            return true;
        }
        return false;
    }

    OrientationMixture result() {
        std::ranges::stable_sort(experts_, std::ranges::greater{}, &Expert::share);
        OrientationMixture out;
        out.segment.resize(samples_.size());
        for (const Expert& expert : experts_) {
            out.rules.push_back(expert.rule);
            out.share.push_back(expert.share);
        }
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            for (std::uint32_t c = 1; c < experts_.size(); ++c) {
                if (experts_[c].gamma[i] > experts_[out.segment[i]].gamma[i]) out.segment[i] = c;
            }
            const auto& e = experts_[out.segment[i]].errors[i];
            out.error += static_cast<double>(std::min(e[0], e[1])) / static_cast<double>(samples_.size());
        }
        return out;
    }

    const OrientationSamples& samples_;
    const MixtureOptions& options_;
    const std::function<void()>& progress_;
    SampleNeighbors neighbors_, gate_neighbors_;
    std::vector<std::uint8_t> held_out_;
    std::vector<Expert> experts_;
    double variance_ = 0.1;  // s
    bool by_place_ = true;
};

}  // namespace

OrientationMixture learn_mixture(const OrientationSamples& samples, const MixtureOptions& options,
                                 const std::function<void()>& progress) {
    if (samples.size() == 0) return {};
    return Mixture(samples, options, progress).run();
}

}  // namespace exemplar
