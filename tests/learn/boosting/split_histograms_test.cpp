#include "host/learn/boosting/split_histograms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/learn/boosting/boosting_weights.h"
#include "tests/learn/boosting/boosting_data.h"

namespace exemplar {
namespace {

BoostingRows rows_of(const Data& data, std::size_t chunk_rows) {
    std::vector<std::uint32_t> all(data.labels.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    return collect_rows(data.quantized, all, data.labels, data.classes, 1, chunk_rows,
                        [&](std::uint32_t entry, std::size_t lane) {
                            return data.weights[entry] * (1.0f + 0.25f * static_cast<float>(lane));
                        });
}

std::vector<std::uint32_t> counting(std::size_t count) {
    std::vector<std::uint32_t> out(count);
    for (std::uint32_t i = 0; i < count; ++i) out[i] = i;
    return out;
}

LaneFactors ones(const BoostingRows& rows) {
    return {std::vector<double>(rows.layout.padded(), 1.0), std::vector<double>(rows.layout.padded(), 1.0)};
}

void expect_same(const SplitHistograms& found, const SplitHistograms& expected, std::size_t classes, double tolerance) {
    SplitSums a, b;
    for (std::size_t i = 0; i < expected.features().size(); ++i) {
        found.split_sums(i, counting(classes), a);
        expected.split_sums(i, counting(classes), b);
        ASSERT_EQ(a.below_w.size(), b.below_w.size());
        for (std::size_t t = 0; t < a.below_w.size(); ++t) {
            ASSERT_NEAR(a.below_w[t], b.below_w[t], tolerance);
            ASSERT_NEAR(a.below_s[t], b.below_s[t], tolerance);
            ASSERT_NEAR(a.above_w[t], b.above_w[t], tolerance);
            ASSERT_NEAR(a.above_s[t], b.above_s[t], tolerance);
            ASSERT_GE(a.below_w[t] - std::abs(a.below_s[t]), -1e-6f);
        }
    }
}

TEST(SplitHistograms, SumsAreThoseOfTheRows) {
    for (const std::size_t classes : {1u, 2u, 5u, 11u}) {
        const Data data = make_data(700, 6, classes, 1.0, classes);
        const BoostingRows rows = rows_of(data, 64);
        SplitHistograms histograms(rows, data.quantized, counting(6));
        histograms.add({{}, rows.weights, rows.chunks}, ones(rows));
        SplitSums sums;
        for (std::size_t f = 0; f < 6; ++f) {
            histograms.split_sums(f, counting(classes), sums);
            for (std::size_t t = 0; t < data.quantized.thresholds[f].size(); t += 5) {
                for (std::size_t c = 0; c < classes; ++c) {
                    double below_w = 0.0, below_s = 0.0;
                    for (std::size_t i = 0; i < 700; ++i) {
                        if (data.features.column(f)[i] > data.quantized.thresholds[f][t]) continue;
                        const double w = data.weights[i] * (1.0 + 0.25 * static_cast<double>(c));
                        below_w += w;
                        below_s += data.labels[i] == static_cast<std::int32_t>(c) ? w : -w;
                    }
                    EXPECT_NEAR(sums.below_w[c * sums.stride + t], below_w, 1e-5 * below_w);
                    EXPECT_NEAR(sums.below_s[c * sums.stride + t], below_s, 1e-5 * below_w);
                }
            }
        }
    }
}

TEST(SplitHistograms, FollowingAChangeEqualsStartingAnew) {
    for (const std::size_t classes : {1u, 3u, 8u, 19u}) {
        const Data data = make_data(3000, 9, classes, 1.0, 40 + classes);
        BoostingRows rows = rows_of(data, 500);
        WeightUpdate weights(rows);
        SplitHistograms carried(rows, data.quantized, counting(9));
        carried.add({{}, rows.weights, rows.chunks}, ones(rows));
        Random random(classes);
        for (int round = 0; round < 16; ++round) {
            SplitCandidate split;
            split.feature = static_cast<std::uint32_t>(random.index(9));
            split.threshold = static_cast<std::uint32_t>(random.index(data.quantized.thresholds[split.feature].size()));
            split.lanes = random.index(std::uint64_t{1} << classes);  // also none
            weights.apply(rows, split, fit_response(rows, split));
            const RowSelection few(rows, split);
            EXPECT_LE(2 * few.view().row.size(), rows.count);
            const WeightFactors& factors = weights.factors();
            carried.update_after_split(few.view(), few.is_above() ? factors.above : factors.below,
                                       few.is_above() ? factors.below : factors.above);
            SplitHistograms anew(rows, data.quantized, counting(9));
            anew.add({{}, rows.weights, rows.chunks}, ones(rows));
            expect_same(carried, anew, classes, 3e-6);  // of weights with a total near one
        }
    }
}

/// Random sums with |S| <= W on both sides of each threshold.
SplitSums random_sums(std::size_t classes, std::size_t thresholds, Random& random) {
    SplitSums sums;
    sums.resize(classes, thresholds);
    for (std::size_t c = 0; c < classes; ++c) {
        const double all_w = random.uniform(0.1, 2.0), all_s = all_w * random.uniform(-0.9, 0.9);
        sums.constant_gain[c] = static_cast<float>(all_s * all_s / all_w);
        for (std::size_t t = 0; t < thresholds; ++t) {
            const double below_w = all_w * random.uniform(0.05, 0.95);
            const double least = std::max(-below_w, all_s - (all_w - below_w));
            const double most = std::min(below_w, all_s + (all_w - below_w));
            const double below_s = random.uniform(least, most);
            const std::size_t at = c * sums.stride + t;
            sums.below_w[at] = static_cast<float>(below_w), sums.below_s[at] = static_cast<float>(below_s);
            sums.above_w[at] = static_cast<float>(all_w - below_w);
            sums.above_s[at] = static_cast<float>(all_s - below_s);
        }
    }
    return sums;
}

double gain_of(const SplitSums& sums, std::size_t threshold, std::uint64_t subset) {
    double bs = 0.0, bw = 0.0, as = 0.0, aw = 0.0, constant = 0.0;
    for (std::size_t c = 0; c < sums.classes; ++c) {
        if (!(subset >> c & 1)) continue;
        const std::size_t at = c * sums.stride + threshold;
        bs += sums.below_s[at], bw += sums.below_w[at], as += sums.above_s[at], aw += sums.above_w[at];
        constant += sums.constant_gain[c];
    }
    return bs * bs / bw + as * as / aw - constant;
}

TEST(SubsetOptions, FindsTheBestSubsetAboveTheFloor) {
    Random random(60);
    for (int trial = 0; trial < 60; ++trial) {
        const std::size_t classes = 1 + random.index(6), thresholds = 1 + random.index(40);
        const SplitSums sums = random_sums(classes, thresholds, random);
        double best = 0.0;
        for (std::size_t t = 0; t < thresholds; ++t) {
            for (std::uint64_t subset = 1; subset < std::uint64_t{1} << classes; ++subset) {
                best = std::max(best, gain_of(sums, t, subset));
            }
        }
        for (const double share : {0.0, 0.5, 0.999}) {
            const SubsetChoice choice = best_subset_exhaustive(sums, static_cast<float>(share * best));
            EXPECT_NEAR(choice.gain, best, 1e-4 * best) << trial;
            EXPECT_NEAR(gain_of(sums, choice.threshold, choice.subset), best, 1e-4 * best) << trial;
        }
        const SubsetChoice greedy = best_subset_greedy(sums), floored = best_subset_greedy(sums, 0.999f * greedy.gain);
        EXPECT_EQ(floored.subset, greedy.subset);
        EXPECT_EQ(floored.threshold, greedy.threshold);
        EXPECT_LE(greedy.gain, best * (1 + 1e-4));
        EXPECT_EQ(best_subset_exhaustive(sums, static_cast<float>(1.01 * best)).subset, 0u);
        EXPECT_EQ(best_subset_greedy(sums, static_cast<float>(1.01 * best)).subset, 0u);
    }
}

}  // namespace
}  // namespace exemplar
