#include "host/learn/boosting/jointboost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "tests/learn/boosting/boosting_data.h"

namespace exemplar {
namespace {

/// JointBoost as the thesis writes it, in double precision and without any shortcut.
class PlainJointBoost {
  public:
    explicit PlainJointBoost(const Data& data) : data_(data), w_(data.labels.size() * data.classes) {
        double total = 0.0;
        for (std::size_t i = 0; i < data.labels.size(); ++i) {
            for (std::size_t c = 0; c < data.classes; ++c) {
                total += at(i, c) = data.weights[data.weights.size() == w_.size() ? i * data.classes + c : i];
            }
        }
        for (double& weight : w_) weight /= total;
    }

    /// Eq. 3.6 of a stump as it is.
    double error(const Stump& stump, std::span<const float> elsewhere) const {
        double sum = 0.0;
        for_each([&](std::size_t i, std::size_t c, double z) {
            const double difference = z - response(stump, elsewhere, i, c);
            sum += at(i, c) * difference * difference;
        });
        return sum;
    }

    /// The least Eq. 3.6 over all features, thresholds and subsets, with a, b, k_c in closed form.
    double min_error() const {
        double least = 1e30;
        for (std::uint32_t f = 0; f < data_.features.cols(); ++f) {
            for (const float threshold : data_.quantized.thresholds[f]) {
                for (std::uint64_t subset = 1; subset < std::uint64_t{1} << data_.classes; ++subset) {
                    least = std::min(least, best_error(f, threshold, subset));
                }
            }
        }
        return least;
    }

    double best_error(std::uint32_t feature, float threshold, std::uint64_t subset) const {
        std::vector<double> w(data_.classes + 2, 0.0), s(data_.classes + 2, 0.0);
        double error = 0.0;
        for_each([&](std::size_t i, std::size_t c, double z) {
            const std::size_t side = data_.features.column(feature)[i] > threshold ? 0 : 1;
            const std::size_t group = subset >> c & 1 ? data_.classes + side : c;
            w[group] += at(i, c);
            s[group] += at(i, c) * z;
            error += at(i, c);
        });
        for (std::size_t g = 0; g < w.size(); ++g) error -= w[g] > 0.0 ? s[g] * s[g] / w[g] : 0.0;
        return error;
    }

    /// Eq. 3.7; returns the loss (Eq. 3.5).
    double update(const Stump& stump, std::span<const float> elsewhere) {
        double loss = 0.0;
        for_each([&](std::size_t i, std::size_t c, double z) {
            loss += at(i, c) *= std::exp(-z * response(stump, elsewhere, i, c));
        });
        return loss;
    }

  private:
    template <typename Body>
    void for_each(Body&& body) const {
        for (std::size_t i = 0; i < data_.labels.size(); ++i) {
            for (std::size_t c = 0; c < data_.classes; ++c) {
                body(i, c, static_cast<std::size_t>(data_.labels[i]) == c ? 1.0 : -1.0);
            }
        }
    }
    double response(const Stump& stump, std::span<const float> elsewhere, std::size_t i, std::size_t c) const {
        if (!(stump.classes >> c & 1)) return elsewhere[c];
        return data_.features.column(stump.feature)[i] > stump.threshold ? stump.above : stump.below;
    }
    double& at(std::size_t i, std::size_t c) { return w_[i * data_.classes + c]; }
    double at(std::size_t i, std::size_t c) const { return w_[i * data_.classes + c]; }

    const Data& data_;
    std::vector<double> w_;
};

bool same_bytes(const BoostedStumps& a, const BoostedStumps& b) {
    return a.stumps.size() == b.stumps.size() && a.elsewhere == b.elsewhere &&
           std::memcmp(a.stumps.data(), b.stumps.data(), a.stumps.size() * sizeof(Stump)) == 0;
}

void expect_every_round_optimal(const Data& data, const BoostOptions& options) {
    const BoostResult result = train_jointboost(data.training(), data.classes, options);
    ASSERT_EQ(result.classifier.stumps.size(), options.rounds);
    PlainJointBoost plain(data);
    for (std::size_t m = 0; m < options.rounds; ++m) {
        const Stump& stump = result.classifier.stumps[m];
        const double found = plain.error(stump, constants(result.classifier, m)), least = plain.min_error();
        EXPECT_NEAR(found, least, 1e-5 * least) << "round " << m;
        // a, b and k_c are the closed form of the split that was found.
        EXPECT_NEAR(found, plain.best_error(stump.feature, stump.threshold, stump.classes), 1e-6 * found);
        const double loss = plain.update(stump, constants(result.classifier, m));
        EXPECT_NEAR(result.loss[m], loss, 1e-5 * loss) << "round " << m;
    }
}

TEST(JointBoost, EveryStumpIsTheBestOne) {
    BoostOptions options;
    options.rounds = 40;  // histograms are carried from round to round and made anew several times
    for (const std::size_t classes : {2u, 3u, 4u, 5u}) {
        expect_every_round_optimal(make_data(90, 6, classes, 0.8, classes), options);
    }
}

TEST(JointBoost, EveryStumpIsTheBestOneWithWeightsPerClass) {
    Data data = make_data(80, 5, 3, 0.8, 4);
    Random random(5);
    data.weights.clear();
    for (std::size_t i = 0; i < 80 * 3; ++i) {
        data.weights.push_back(random.uniform() < 0.2 ? 0.0f : static_cast<float>(random.uniform(0.1, 3.0)));
    }
    BoostOptions options;
    options.rounds = 8;
    expect_every_round_optimal(data, options);
}

TEST(JointBoost, ShrinksEveryStep) {
    const Data data = make_data(120, 6, 3, 1.0, 23);
    BoostOptions options;
    options.rounds = 12;
    const BoostResult full = train_jointboost(data.training(), 3, options);
    options.shrinkage = 0.25;
    const BoostResult small = train_jointboost(data.training(), 3, options);
    EXPECT_EQ(small.classifier.stumps[0].feature, full.classifier.stumps[0].feature);
    PlainJointBoost plain(data);
    for (std::size_t m = 0; m < options.rounds; ++m) {
        // The split is the best one for the weights that the shrunk steps left; its response is a quarter of the best.
        const Stump& stump = small.classifier.stumps[m];
        Stump grown = stump;
        grown.above *= 4.0f, grown.below *= 4.0f;
        std::vector<float> elsewhere(constants(small.classifier, m).begin(), constants(small.classifier, m).end());
        for (float& k : elsewhere) k *= 4.0f;
        const double least = plain.min_error();
        EXPECT_NEAR(plain.error(grown, elsewhere), least, 1e-5 * least) << m;
        const double loss = plain.update(stump, constants(small.classifier, m));
        EXPECT_NEAR(small.loss[m], loss, 1e-5 * loss) << m;
        EXPECT_GT(loss, full.loss[m]);
    }
    for (const double bad : {0.0, -0.5, 1.5, std::nan("")}) {
        options.shrinkage = bad;
        EXPECT_THROW(train_jointboost(data.training(), 3, options), UsageError);
    }
}

TEST(JointBoost, ANaNIsNotAboveAnyThreshold) {
    Data data = make_data(300, 4, 3, 1.0, 24);
    Random random(25);
    for (float& value : data.features.values) {
        if (random.uniform() < 0.3) value = std::nanf("");
    }
    data.quantized = quantize(data.features, data.weights, {32});
    BoostOptions options;
    options.rounds = 20;
    expect_every_round_optimal(data, options);  // the plain form compares floats
}

TEST(JointBoost, GreedySubsetsAreNearlyAsGood) {
    const Data data = make_data(400, 8, 6, 0.7, 6);
    BoostOptions options;
    options.rounds = 40;
    const double exhaustive = train_jointboost(data.training(), 6, options).loss.back();
    options.exhaustive_classes = 1;
    const BoostResult greedy = train_jointboost(data.training(), 6, options);
    EXPECT_LT(greedy.loss.back(), 1.1 * exhaustive);
    // The greedy search starts with single classes, so it is never worse than stumps that share nothing.
    PlainJointBoost plain(data);
    for (std::size_t m = 0; m < 5; ++m) {
        double alone = 1e30;
        for (std::uint32_t f = 0; f < data.features.cols(); ++f) {
            for (const float threshold : data.quantized.thresholds[f]) {
                for (std::size_t c = 0; c < 6; ++c) {
                    alone = std::min(alone, plain.best_error(f, threshold, std::uint64_t{1} << c));
                }
            }
        }
        EXPECT_LE(plain.error(greedy.classifier.stumps[m], constants(greedy.classifier, m)), alone * (1 + 1e-6));
        plain.update(greedy.classifier.stumps[m], constants(greedy.classifier, m));
    }
}

TEST(JointBoost, TheLossFallsWithManyClasses) {
    for (const std::size_t classes : {9u, 17u, 64u}) {  // several panels of lanes
        const Data data = make_data(classes * 25, 20, classes, 0.3, classes);
        BoostOptions options;
        options.rounds = 60;
        const BoostResult result = train_jointboost(data.training(), classes, options);
        PlainJointBoost plain(data);
        double before = 1.0;
        for (std::size_t m = 0; m < result.loss.size(); ++m) {
            const double loss = plain.update(result.classifier.stumps[m], constants(result.classifier, m));
            ASSERT_NEAR(result.loss[m], loss, 2e-5 * loss) << classes << " " << m;
            EXPECT_LT(loss, before);
            before = loss;
        }
        EXPECT_GT(training_accuracy(result.classifier, data), 3.0 / static_cast<double>(classes));
    }
}

TEST(JointBoost, LearnsWhatIsSeparable) {
    const Data data = make_data(600, 12, 5, 0.02, 7);
    BoostOptions options;
    options.rounds = 400;  // the loss falls far below what a float can hold
    const BoostResult result = train_jointboost(data.training(), 5, options);
    EXPECT_EQ(training_accuracy(result.classifier, data), 1.0);
    EXPECT_LT(result.loss.back(), 1e-12);
    for (const Stump& stump : result.classifier.stumps) {
        EXPECT_TRUE(std::isfinite(stump.above) && std::isfinite(stump.below));
        EXPECT_LE(std::abs(stump.above), 1.0001f);
        EXPECT_LE(std::abs(stump.below), 1.0001f);
    }
    for (const float k : result.classifier.elsewhere) EXPECT_TRUE(std::isfinite(k));
}

TEST(JointBoost, AnAbsentClassIsNeverSharedAndNeverLikely) {
    Data data = make_data(300, 6, 4, 0.5, 8);
    data.classes = 6;                                                        // labels 4 and 5 do not occur, and
    for (std::int32_t& label : data.labels) label = label == 1 ? 2 : label;  // neither does 1
    BoostOptions options;
    options.rounds = 120;
    const BoostResult result = train_jointboost(data.training(), 6, options);
    for (std::size_t m = 0; m < 120; ++m) {
        for (const std::size_t absent : {1u, 4u, 5u}) {
            EXPECT_EQ(result.classifier.stumps[m].classes >> absent & 1, 0u);
            EXPECT_NEAR(constants(result.classifier, m)[absent], -1.0f, 1e-5f);
        }
    }
    std::vector<float> p(300 * 6);
    CpuStumpScorer().probabilities(result.classifier, data.features, Link::softmax, 1.0f, p);
    for (std::size_t i = 0; i < 300; ++i) EXPECT_LT(p[i * 6 + 4], 1e-6f);
}

TEST(JointBoost, ConstantFeaturesLeaveTheClassShares) {
    Data data = make_data(100, 2, 3, 0.5, 9);
    std::fill(data.features.values.begin(), data.features.values.end(), 1.0f);
    data.weights.assign(100, 1.0f);
    data.quantized = quantize(data.features, {}, {});
    BoostOptions options;
    options.rounds = 60;
    const BoostResult result = train_jointboost(data.training(), 3, options);
    for (const Stump& stump : result.classifier.stumps) EXPECT_EQ(stump.classes, 0u);
    // With nothing but constants, boosting converges to H_c with sigma(2 H_c) = the share of class c.
    const std::vector<float> h = result.classifier.constant();
    for (std::int32_t c = 0; c < 3; ++c) {
        const auto count = std::count(data.labels.begin(), data.labels.end(), c);
        EXPECT_NEAR(1.0 / (1.0 + std::exp(-2.0 * static_cast<double>(h[static_cast<std::size_t>(c)]))),
                    static_cast<double>(count) / 100.0, 1e-4);
    }
}

TEST(JointBoost, ChosenRowsAreAllThatCounts) {
    const Data all = make_data(300, 5, 3, 1.0, 14);
    std::vector<std::uint32_t> rows;
    for (std::uint32_t i = 0; i < 300; ++i)
        if (i % 3 != 0) rows.push_back(i);
    Data few{all.features, all.quantized, {}, {}, 3};
    few.quantized.rows = few.features.rows = rows.size();
    few.quantized.bins.clear();
    few.features.values.clear();
    for (std::size_t f = 0; f < 5; ++f) {
        for (const std::uint32_t row : rows) {
            few.quantized.bins.push_back(all.quantized.column(f)[row]);
            few.features.values.push_back(all.features.column(f)[row]);
        }
    }
    for (const std::uint32_t row : rows) few.labels.push_back(all.labels[row]);
    for (const std::uint32_t row : rows) few.weights.push_back(all.weights[row]);
    BoostOptions options;
    options.rounds = 15;
    const BoostResult chosen = train_jointboost(all.training(rows), 3, options);
    const BoostResult copied = train_jointboost(few.training(), 3, options);
    EXPECT_TRUE(same_bytes(chosen.classifier, copied.classifier));
    EXPECT_EQ(chosen.loss, copied.loss);
}

TEST(JointBoost, TheSameSeedGivesTheSameBytesOnAnyThreads) {
    const Data data = make_data(3000, 37, 5, 1.0, 15);
    BoostOptions options;
    options.rounds = 20;
    for (const double fraction : {1.0, 0.4}) {  // with carried histograms, and sampled
        options.feature_fraction = fraction;
        options.seed = 1;
        const BoostResult many = train_jointboost(data.training(), 5, options);
        {
            const ThreadLimit limit(1);
            EXPECT_TRUE(same_bytes(train_jointboost(data.training(), 5, options).classifier, many.classifier));
        }
        options.seed = 2;
        const BoostResult other = train_jointboost(data.training(), 5, options);
        if (fraction < 1.0) {
            EXPECT_FALSE(same_bytes(other.classifier, many.classifier));
        }
    }
}

TEST(JointBoost, SamplingStillLearns) {
    const Data data = make_data(6000, 20, 4, 0.8, 16);
    BoostOptions options;
    options.rounds = 40;
    const double full = train_jointboost(data.training(), 4, options).loss.back();
    options.feature_fraction = 0.5;
    const BoostResult sampled = train_jointboost(data.training(), 4, options);
    EXPECT_LT(sampled.loss.back(), 1.25 * full);
    EXPECT_GE(sampled.loss.back(), 0.95 * full);
}

TEST(JointBoost, GrowsStumpByStump) {
    const Data data = make_data(100, 4, 3, 1.0, 17);
    BoostOptions options;
    options.rounds = 30;
    options.feature_fraction = 0.5;
    const BoostResult all = train_jointboost(data.training(), 3, options);
    Booster booster(data.training(), 3, options);
    EXPECT_TRUE(booster.classifier().stumps.empty());
    for (std::size_t m = 0; m < 12; ++m) EXPECT_EQ(booster.add_stump(), all.loss[m]);
    EXPECT_TRUE(same_bytes(booster.classifier(), truncate(all.classifier, 12)));
    EXPECT_EQ(truncate(all.classifier, 10000).stumps.size(), 30u);
}

TEST(JointBoost, RefusesWhatItCannotLearnFrom) {
    const Data good = make_data(20, 2, 3, 1.0, 18);
    const auto train = [](const Data& data, const BoostOptions& options = {}) {
        train_jointboost(data.training(), data.classes, options);
    };
    Data bad = good;
    bad.labels[3] = 3;
    EXPECT_THROW(train(bad), UsageError);
    bad.labels[3] = -1;
    EXPECT_THROW(train(bad), UsageError);
    bad = good;
    bad.weights[0] = -1.0f;
    EXPECT_THROW(train(bad), DataError);
    bad.weights[0] = std::nanf("");
    EXPECT_THROW(train(bad), DataError);
    bad.weights.assign(20, 0.0f);
    EXPECT_THROW(train(bad), DataError);
    bad.weights.resize(7);
    EXPECT_THROW(train(bad), UsageError);
    bad = good;
    bad.classes = 1;
    EXPECT_THROW(train(bad), UsageError);
    bad.classes = 65;
    EXPECT_THROW(train(bad), UsageError);
    bad = good;
    bad.quantized = {20, {}, {}};
    EXPECT_THROW(train(bad), UsageError);
    BoostOptions options;
    options.feature_fraction = 0.0;
    EXPECT_THROW(train(good, options), UsageError);
    options = {};
    options.exhaustive_classes = 11;
    EXPECT_THROW(train(good, options), UsageError);
    const std::vector<std::uint32_t> beyond{20};
    EXPECT_THROW(train_jointboost(good.training(beyond), 3, {}), UsageError);
}

}  // namespace
}  // namespace exemplar
