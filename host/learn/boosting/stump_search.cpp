#include "host/learn/boosting/stump_search.h"

#include <algorithm>
#include <memory>

#include "host/core/parallel.h"
#include "host/learn/boosting/subset_search.h"

namespace exemplar {
namespace {

constexpr std::size_t k_rebuild_interval = 16;

SplitCandidate better_of(const std::vector<SplitCandidate>& of_task) {
    SplitCandidate best;
    for (const SplitCandidate& candidate : of_task) {
        if (candidate.gain > best.gain) best = candidate;
    }
    return best;
}

/// Runs of up to SplitHistograms::k_features features, the work of one task.
std::vector<std::span<const std::uint32_t>> tasks_of(std::span<const std::uint32_t> list) {
    std::vector<std::span<const std::uint32_t>> tasks;
    for (; !list.empty(); list = list.subspan(tasks.back().size())) {
        tasks.push_back(list.first(std::min(SplitHistograms::k_features, list.size())));
    }
    return tasks;
}

}  // namespace

StumpSearch::StumpSearch(const BoostingRows& rows, const QuantizedFeatures& features, SubsetOptions subsets, bool carry)
    : rows_(rows),
      features_(features),
      subsets_(std::move(subsets)),
      incremental_(carry),
      ones_{std::vector<double>(rows.layout.padded(), 1.0), std::vector<double>(rows.layout.padded(), 1.0)} {
    for (std::uint32_t f = 0; f < features.cols(); ++f) {
        if (!features.thresholds[f].empty()) usable_.push_back(f);
    }
}

WeightedRows StumpSearch::all_rows() const {
    return {{}, rows_.weights, rows_.chunks};
}

SplitCandidate StumpSearch::best(std::span<const std::uint32_t> list) const {
    const std::vector<std::span<const std::uint32_t>> tasks = tasks_of(list);
    std::vector<SplitCandidate> of_task(tasks.size());
    parallel_for(tasks.size(), [&](std::size_t t) {
        SplitHistograms histograms(rows_, features_, tasks[t]);
        histograms.add(all_rows(), ones_);
        of_task[t] = best_of(histograms);
    });
    return better_of(of_task);
}

SplitCandidate StumpSearch::best() {
    if (!incremental_) return best(usable_);
    const bool anew = kept_.empty() || rounds_since_rebuild_ >= k_rebuild_interval;
    if (kept_.empty()) {
        for (const std::span<const std::uint32_t> task : tasks_of(usable_)) kept_.emplace_back(rows_, features_, task);
    }
    const std::unique_ptr<RowSelection> changed = anew ? nullptr : std::make_unique<RowSelection>(rows_, last_split_);
    std::vector<SplitCandidate> of_task(kept_.size());
    parallel_for(kept_.size(), [&](std::size_t t) {
        refresh(kept_[t], changed.get());
        of_task[t] = best_of(kept_[t]);
    });
    if (anew) rounds_since_rebuild_ = 0;
    return better_of(of_task);
}

/// Updates histograms from the rows of the smaller side of the last split, or (null) rebuilds them from all rows.
void StumpSearch::refresh(SplitHistograms& histograms, const RowSelection* selection) const {
    if (selection) {
        const LaneFactors& above = last_factors_.above;
        const LaneFactors& below = last_factors_.below;
        const bool is_above = selection->is_above();
        histograms.update_after_split(selection->view(), is_above ? above : below, is_above ? below : above);
    } else {
        histograms.clear();
        histograms.add(all_rows(), ones_);
    }
}

void StumpSearch::weights_changed(const SplitCandidate& split, const WeightFactors& factors) {
    last_split_ = split;
    last_factors_ = factors;
    ++rounds_since_rebuild_;
}

SplitCandidate StumpSearch::best_of(const SplitHistograms& histograms) const {
    SplitCandidate best;
    SplitSums sums;
    for (std::size_t i = 0; i < histograms.features().size(); ++i) {
        histograms.split_sums(i, subsets_.candidates, sums);
        const SubsetChoice choice =
            subsets_.exhaustive ? best_subset_exhaustive(sums, best.gain) : best_subset_greedy(sums, best.gain);
        if (choice.gain <= best.gain) continue;
        best = {choice.gain, histograms.features()[i], choice.threshold, 0};
        for (std::size_t c = 0; c < subsets_.candidates.size(); ++c) {
            if (choice.subset >> c & 1) best.lanes |= std::uint64_t{1} << subsets_.candidates[c];
        }
    }
    return best;
}

}  // namespace exemplar
