#include "host/hatching/style/property_factors.h"

#include <algorithm>
#include <cmath>

#include "host/core/parallel.h"
#include "host/core/statistics.h"
#include "host/hatching/features/powers.h"

namespace exemplar {
namespace {

/// Returns whether the inverses of a feature are usable. Inverses of a feature that is often near zero only mark
/// where it vanishes: they fit one drawing and do not generalize.
bool has_inverses(std::span<const float> column) {
    double sum = 0;
    for (const float x : column) sum += static_cast<double>(std::abs(x));
    const auto tiny = static_cast<float>(1e-3 * sum / static_cast<double>(column.size()));
    const auto count = std::ranges::count_if(column, [&](float x) { return !(std::abs(x) > tiny); });
    return 100 * count < static_cast<std::ptrdiff_t>(column.size());
}

void keep_least(std::vector<FactorCandidate>& all, std::size_t count) {
    count = std::min(count, all.size());
    std::ranges::partial_sort(all, all.begin() + static_cast<std::ptrdiff_t>(count), {}, &FactorCandidate::error);
    all.resize(count);
}

}  // namespace

/// Sums of one bin of a feature.
struct FactorSearch::BinSums {
    double weight = 0, target = 0, squares = 0;
};

FactorSearch::FactorSearch(const PropertyTraining& training) : training_(training) {
    const std::size_t features = training_.features.cols();
    middle_.resize(features);
    inverses_.resize(features);
    parallel_for(features, [&](std::size_t f) {
        const std::span<const float> column = training_.features.column(f);
        const std::span<const std::uint8_t> bins = training_.quantized.column(f);
        inverses_[f] = has_inverses(column) ? 1 : 0;
        std::vector<std::vector<float>> members(training_.quantized.thresholds[f].size() + 1);
        for (std::size_t i = 0; i < column.size(); ++i) {
            if (std::isfinite(column[i])) members[bins[i]].push_back(column[i]);
        }
        for (auto& values : members) {
            if (values.empty()) values.push_back(middle_[f].empty() ? 0.0f : middle_[f].back());
            middle_[f].push_back(upper_median(values));
        }
    });
}

void FactorSearch::set_target(std::vector<double> log_target) {
    target_ = std::move(log_target);
    least_ = static_cast<float>(0.25 * std::exp(*std::ranges::min_element(target_)));
}

std::vector<FactorCandidate> FactorSearch::candidates(std::span<const double> weights,
                                                      std::span<const double> exponents, std::size_t count) const {
    constexpr std::size_t k_checked = 64;
    std::vector<FactorCandidate> all(training_.features.cols() * k_powers);
    parallel_for(training_.features.cols(), [&](std::size_t f) {
        std::vector<BinSums> sums(middle_[f].size());
        const std::span<const std::uint8_t> bins = training_.quantized.column(f);
        for (std::size_t i = 0; i < weights.size(); ++i) {
            sums[bins[i]].weight += weights[i];
            sums[bins[i]].target += weights[i] * target_[i];
        }
        for (std::size_t p = 0; p < (inverses_[f] ? k_powers : 2); ++p)
            all[f * k_powers + p] = fit(static_cast<std::uint32_t>(f * k_powers + p), sums, exponents);
    });
    std::erase_if(all, [](const FactorCandidate& candidate) { return !std::isfinite(candidate.error); });
    keep_least(all, k_checked);
    parallel_for(all.size(), [&](std::size_t i) { all[i].error = error_of_blocks(all[i].term, weights); });
    keep_least(all, count);
    return all;
}

std::vector<float> FactorSearch::log_values(PropertyModel::Term term) const {
    term.exponent = 1;
    const std::span<const float> column = training_.features.column(term.feature / k_powers);
    std::vector<float> values(column.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = PropertyModel::log_value(term, power_of(column[i], term.feature % k_powers));
    return values;
}

/// Fits a and b for one power of a feature to sums per bin: by regression of y, then by Gauss-Newton steps on
/// log y.
FactorCandidate FactorSearch::fit(std::uint32_t feature, std::span<const BinSums> sums,
                                  std::span<const double> exponents) const {
    const std::vector<float>& middle = middle_[feature / k_powers];
    FactorCandidate candidate;
    candidate.term.feature = feature;
    candidate.term.least = least_;
    std::vector<double> x(sums.size());
    double low = std::numeric_limits<double>::infinity(), high = -low, squares = 0;
    for (std::size_t b = 0; b < sums.size(); ++b) {
        x[b] = static_cast<double>(power_of(middle[b], feature % k_powers));
        if (!(sums[b].weight > 0)) continue;
        low = std::min(low, x[b]);
        high = std::max(high, x[b]);
        squares += sums[b].target * sums[b].target / sums[b].weight;
    }
    if (!(high > low)) return candidate;
    candidate.term.low = static_cast<float>(low);
    candidate.term.high = static_cast<float>(high);
    for (const double exponent : exponents) {
        std::vector<BinSums> scaled(sums.begin(), sums.end());
        for (BinSums& bin : scaled) bin.target /= exponent;
        const auto [a, b, left] = fit_line(x, scaled, low, high);
        // The squared error is that of the bin means plus the variation within bins. The latter is the sum of
        // all squares, equal for all features, minus the squares of the bin means.
        const double error = exponent * exponent * left - squares;
        if (!(error < candidate.error)) continue;
        candidate.term.a = static_cast<float>(a);
        candidate.term.b = static_cast<float>(b);
        candidate.term.exponent = static_cast<float>(exponent);
        candidate.error = error;
    }
    return candidate;
}

/// Minimizes the weighted squares of t - log(a x + b). Works on z = (x - low) / (high - low), which keeps the two
/// unknowns apart whatever the unit of x.
FactorSearch::Line FactorSearch::fit_line(std::span<const double> x, std::span<const BinSums> sums, double low,
                                          double high) const {
    const double scale = 1 / (high - low), least = static_cast<double>(least_);
    double a = 0, b = 0, best_a = 0, best_b = 1, best = std::numeric_limits<double>::infinity();
    for (int step = 0; step < 7; ++step) {
        // Weighted normal equations of the linearization around the current line (at first of y itself).
        double s = 0, sz = 0, szz = 0, r = 0, rz = 0, error = 0;
        for (std::size_t k = 0; k < sums.size(); ++k) {
            const double w = sums[k].weight;
            if (!(w > 0)) continue;
            const double z = (x[k] - low) * scale, t = sums[k].target / w;
            const double value = step == 0 ? std::exp(t) : std::max(a * z + b, least);
            const double difference = step == 0 ? std::exp(t) / value : t - std::log(value);
            const double g = w / (value * value);
            s += g;
            sz += g * z;
            szz += g * z * z;
            r += w / value * difference;
            rz += w / value * difference * z;
            if (step > 0) error += w * difference * difference;
        }
        if (step > 0 && error < best) {
            best = error;
            best_a = a;
            best_b = b;
        } else if (step > 0) {
            break;
        }
        const double determinant = s * szz - sz * sz;
        if (!(determinant > 1e-12 * s * szz)) break;
        const double da = (s * rz - sz * r) / determinant, db = (szz * r - sz * rz) / determinant;
        a = step == 0 ? da : a + da;
        b = step == 0 ? db : b + db;
    }
    return {best_a * scale, best_b - best_a * scale * low, best};
}

/// Returns the cross-validation error of a term: squared errors of each block under the curve fitted to the
/// other blocks, with the exponent of the term.
double FactorSearch::error_of_blocks(const PropertyModel::Term& term, std::span<const double> weights) const {
    const std::size_t base = term.feature / k_powers, count = middle_[base].size();
    const double exponent = static_cast<double>(term.exponent);
    const std::vector<BinSums> by_block = sums_by_block(base, exponent, weights);
    std::vector<double> x(count);
    for (std::size_t b = 0; b < count; ++b)
        x[b] = static_cast<double>(power_of(middle_[base][b], term.feature % k_powers));
    double total = 0;
    for (std::size_t block = 0; block < k_property_blocks; ++block) {
        std::vector<BinSums> others(count);
        for (std::size_t i = 0; i < by_block.size(); ++i) {
            if (i / count == block) continue;
            others[i % count].weight += by_block[i].weight;
            others[i % count].target += by_block[i].target;
        }
        const auto [a, b, error] = fit_line(x, others, static_cast<double>(term.low), static_cast<double>(term.high));
        for (std::size_t k = 0; k < count; ++k) {
            const BinSums& own = by_block[block * count + k];
            const double value = std::log(std::max(a * x[k] + b, static_cast<double>(least_)));
            total += own.squares - 2 * value * own.target + value * value * own.weight;
        }
    }
    return exponent * exponent * total;
}

/// Returns sums, per block and bin of a feature, of the target of a term without its exponent.
std::vector<FactorSearch::BinSums> FactorSearch::sums_by_block(std::size_t feature, double exponent,
                                                               std::span<const double> weights) const {
    const std::size_t count = middle_[feature].size();
    std::vector<BinSums> sums(k_property_blocks * count);
    const std::span<const std::uint8_t> bins = training_.quantized.column(feature);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        BinSums& bin = sums[training_.block[i] * count + bins[i]];
        const double target = target_[i] / exponent;
        bin.weight += weights[i];
        bin.target += weights[i] * target;
        bin.squares += weights[i] * target * target;
    }
    return sums;
}

}  // namespace exemplar
