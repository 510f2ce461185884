#include "host/learn/boosting/subset_search.h"

#include <bit>
#include <limits>

#include "host/learn/boosting/lanes.h"

namespace exemplar {
namespace {

constexpr std::size_t k_step = 8;  // thresholds handled together
using Floats = LaneFloats<k_step>;
using Mask [[gnu::vector_size(k_step * 4)]] = std::int32_t;

constexpr float k_tiny_subset = 1e-30f;  // keeps an empty side's 0 / 0 at 0

/// Sums of one subset for k_step thresholds.
struct StepSums {
    Floats below_s{}, below_w{}, above_s{}, above_w{};

    StepSums plus(const StepSums& other) const {
        return {below_s + other.below_s, below_w + other.below_w, above_s + other.above_s, above_w + other.above_w};
    }
    Floats gain() const {
        return below_s * below_s / (below_w + k_tiny_subset) + above_s * above_s / (above_w + k_tiny_subset);
    }
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

Mask filled(std::size_t value) {
    return Mask{} + static_cast<std::int32_t>(value);
}

/// A subset that grows, for k_step thresholds at a time, each with its own classes.
struct GrowingSubset {
    StepSums sums;
    Floats constant{};  // constant gains of its classes
    Floats gain{};
    Mask last{};  // the class it grew by last

    /// Returns this subset with one more class: the one that gains most among those not taken.
    GrowingSubset grown(const std::vector<StepSums>& of_class, const std::vector<float>& constant_gain,
                        const std::vector<Mask>& taken) const {
        GrowingSubset best = *this;
        best.gain = Floats{} - std::numeric_limits<float>::max();
        for (std::size_t c = 0; c < of_class.size(); ++c) {
            const StepSums with = sums.plus(of_class[c]);
            const Floats with_constant = constant + constant_gain[c];
            const Floats with_gain = with.gain() - with_constant;
            const Mask better = (with_gain > best.gain) & ~taken[c];
            choose(better, with, best.sums);
            best.constant = choose(better, with_constant, best.constant);
            best.gain = choose(better, with_gain, best.gain);
            best.last = better ? filled(c) : best.last;
        }
        return best;
    }
};

/// Whether any of k_step thresholds may gain more than `floor` (with room for rounding).
bool may_gain(const std::vector<StepSums>& of_class, const std::vector<float>& constant_gain, float floor) {
    Floats bound{};
    for (std::size_t c = 0; c < constant_gain.size(); ++c) bound += of_class[c].gain() - constant_gain[c];
    bool any = false;
    for (std::size_t i = 0; i < k_step; ++i) any |= 1.001f * bound[i] + 1e-6f > floor;
    return any;
}

}  // namespace

void SplitSums::resize(std::size_t class_count, std::size_t thresholds) {
    classes = class_count;
    stride = (thresholds + k_step - 1) / k_step * k_step;
    for (std::vector<float>* values : {&below_s, &below_w, &above_s, &above_w}) values->assign(classes * stride, 0.0f);
    constant_gain.assign(classes, 0.0f);
}

SubsetChoice best_subset_exhaustive(const SplitSums& sums, float floor) {
    const std::uint32_t subsets = 1u << sums.classes;
    std::vector<float> constant(subsets, 0.0f);
    for (std::uint32_t s = 1; s < subsets; ++s) {
        constant[s] = constant[s & (s - 1)] + sums.constant_gain[static_cast<std::size_t>(std::countr_zero(s))];
    }
    // The sums of a subset are those of the subset without its lowest class, plus those of that class.
    std::vector<StepSums> of_subset(subsets), of_class(sums.classes);
    SubsetChoice best{floor, 0, 0};
    for (std::size_t threshold = 0; threshold < sums.stride; threshold += k_step) {
        for (std::size_t c = 0; c < sums.classes; ++c) of_class[c] = load_sums(sums, c, threshold);
        if (!may_gain(of_class, sums.constant_gain, best.gain)) continue;
        for (std::size_t c = 0; c < sums.classes; ++c) of_subset[1u << c] = of_class[c];
        Floats best_gain{};
        Mask best_set{};
        for (std::uint32_t s = 1; s < subsets; ++s) {
            if ((s & (s - 1)) != 0) of_subset[s] = of_subset[s & (s - 1)].plus(of_subset[s & -s]);
            const Floats gain = of_subset[s].gain() - constant[s];
            const Mask better = gain > best_gain;
            best_gain = choose(better, gain, best_gain);
            best_set = better ? filled(s) : best_set;
        }
        for (std::size_t i = 0; i < k_step; ++i) {
            if (best_gain[i] <= best.gain) continue;
            best = {best_gain[i], static_cast<std::uint32_t>(threshold + i), static_cast<std::uint64_t>(best_set[i])};
        }
    }
    return best;
}

SubsetChoice best_subset_greedy(const SplitSums& sums, float floor) {
    std::vector<StepSums> of_class(sums.classes);
    std::vector<Mask> taken(sums.classes);
    std::vector<Mask> picked(sums.classes);  // per size: the class taken at each threshold
    SubsetChoice best{floor, 0, 0};
    for (std::size_t threshold = 0; threshold < sums.stride; threshold += k_step) {
        for (std::size_t c = 0; c < sums.classes; ++c) of_class[c] = load_sums(sums, c, threshold), taken[c] = Mask{};
        if (!may_gain(of_class, sums.constant_gain, best.gain)) continue;
        GrowingSubset subset;
        Floats best_gain{};
        Mask best_size{};
        for (std::size_t size = 0; size < sums.classes; ++size) {
            subset = subset.grown(of_class, sums.constant_gain, taken);
            picked[size] = subset.last;
            for (std::size_t c = 0; c < sums.classes; ++c) taken[c] |= subset.last == filled(c);
            const Mask better = subset.gain > best_gain;
            best_gain = choose(better, subset.gain, best_gain);
            best_size = better ? filled(size + 1) : best_size;
        }
        for (std::size_t i = 0; i < k_step; ++i) {
            if (best_gain[i] <= best.gain) continue;
            best = {best_gain[i], static_cast<std::uint32_t>(threshold + i), 0};
            for (std::int32_t size = 0; size < best_size[i]; ++size) best.subset |= std::uint64_t{1} << picked[size][i];
        }
    }
    return best;
}

}  // namespace exemplar
