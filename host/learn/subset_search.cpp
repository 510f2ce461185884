#include "host/learn/subset_search.h"

#include <bit>

#include "host/learn/lanes.h"

namespace exemplar {
namespace {

constexpr std::size_t k_step = 8;  // thresholds handled together
using Floats = LaneFloats<k_step>;
using Mask [[gnu::vector_size(k_step * 4)]] = std::int32_t;

constexpr float k_tiny = 1e-30f;  // keeps an empty side's 0 / 0 at 0

/// Sums of one subset for k_step thresholds.
struct StepSums {
    Floats below_s{}, below_w{}, above_s{}, above_w{};

    StepSums plus(const StepSums& other) const {
        return {below_s + other.below_s, below_w + other.below_w, above_s + other.above_s, above_w + other.above_w};
    }
    Floats gain() const { return below_s * below_s / (below_w + k_tiny) + above_s * above_s / (above_w + k_tiny); }
};

Floats load(const std::vector<float>& values, std::size_t at) {
    Floats out;
    for (std::size_t i = 0; i < k_step; ++i) out[i] = values[at + i];
    return out;
}

StepSums load_sums(const SplitSums& sums, std::size_t c, std::size_t threshold) {
    const std::size_t at = c * sums.stride + threshold;
    return {load(sums.below_s, at), load(sums.below_w, at), load(sums.above_s, at), load(sums.above_w, at)};
}

Floats choose(Mask mask, Floats yes, Floats no) {
    return mask ? yes : no;
}

void choose(Mask mask, const StepSums& yes, StepSums& no) {
    no.below_s = choose(mask, yes.below_s, no.below_s);
    no.below_w = choose(mask, yes.below_w, no.below_w);
    no.above_s = choose(mask, yes.above_s, no.above_s);
    no.above_w = choose(mask, yes.above_w, no.above_w);
}

}  // namespace

void SplitSums::resize(std::size_t class_count, std::size_t thresholds) {
    classes = class_count;
    stride = (thresholds + k_step - 1) / k_step * k_step;
    for (std::vector<float>* values : {&below_s, &below_w, &above_s, &above_w}) values->assign(classes * stride, 0.0f);
    constant_gain.assign(classes, 0.0f);
}

SubsetChoice best_subset_exhaustive(const SplitSums& sums) {
    const std::uint32_t subsets = 1u << sums.classes;
    std::vector<float> constant(subsets, 0.0f);
    for (std::uint32_t s = 1; s < subsets; ++s) {
        constant[s] = constant[s & (s - 1)] + sums.constant_gain[static_cast<std::size_t>(std::countr_zero(s))];
    }
    // A subset's sums are those of the subset without its lowest class, plus that class.
    std::vector<StepSums> of_subset(subsets);
    SubsetChoice best;
    for (std::size_t threshold = 0; threshold < sums.stride; threshold += k_step) {
        for (std::size_t c = 0; c < sums.classes; ++c) of_subset[1u << c] = load_sums(sums, c, threshold);
        Floats best_gain{};
        Mask best_set{};
        for (std::uint32_t s = 1; s < subsets; ++s) {
            if ((s & (s - 1)) != 0) of_subset[s] = of_subset[s & (s - 1)].plus(of_subset[s & -s]);
            const Floats gain = of_subset[s].gain() - constant[s];
            const Mask better = gain > best_gain;
            best_gain = choose(better, gain, best_gain);
            best_set = better ? Mask{} + static_cast<std::int32_t>(s) : best_set;
        }
        for (std::size_t i = 0; i < k_step; ++i) {
            if (best_gain[i] <= best.gain) continue;
            best = {best_gain[i], static_cast<std::uint32_t>(threshold + i), static_cast<std::uint64_t>(best_set[i])};
        }
    }
    return best;
}

SubsetChoice best_subset_greedy(const SplitSums& sums) {
    std::vector<StepSums> of_class(sums.classes);
    std::vector<Mask> taken(sums.classes);
    std::vector<Mask> picked(sums.classes);  // per step: the class taken at each threshold
    SubsetChoice best;
    for (std::size_t threshold = 0; threshold < sums.stride; threshold += k_step) {
        for (std::size_t c = 0; c < sums.classes; ++c) of_class[c] = load_sums(sums, c, threshold), taken[c] = Mask{};
        StepSums current;
        Floats constant{}, best_gain{};
        Mask best_size{};
        for (std::size_t step = 0; step < sums.classes; ++step) {
            StepSums grown = current;
            Floats grown_gain = Floats{} - 3e38f, grown_constant{};
            Mask pick{};
            for (std::size_t c = 0; c < sums.classes; ++c) {
                const StepSums with = current.plus(of_class[c]);
                const Floats with_constant = constant + sums.constant_gain[c];
                const Floats gain = with.gain() - with_constant;
                const Mask better = (gain > grown_gain) & ~taken[c];
                grown_gain = choose(better, gain, grown_gain);
                grown_constant = choose(better, with_constant, grown_constant);
                pick = better ? Mask{} + static_cast<std::int32_t>(c) : pick;
                choose(better, with, grown);
            }
            for (std::size_t c = 0; c < sums.classes; ++c) taken[c] |= pick == static_cast<std::int32_t>(c);
            picked[step] = pick;
            current = grown;
            constant = grown_constant;
            const Mask better = grown_gain > best_gain;
            best_gain = choose(better, grown_gain, best_gain);
            best_size = better ? Mask{} + static_cast<std::int32_t>(step + 1) : best_size;
        }
        for (std::size_t i = 0; i < k_step; ++i) {
            if (best_gain[i] <= best.gain) continue;
            best = {best_gain[i], static_cast<std::uint32_t>(threshold + i), 0};
            for (std::int32_t step = 0; step < best_size[i]; ++step) best.subset |= std::uint64_t{1} << picked[step][i];
        }
    }
    return best;
}

}  // namespace exemplar
