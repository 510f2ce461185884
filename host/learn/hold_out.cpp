#include "host/learn/hold_out.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

constexpr std::size_t k_block = 1024;

/// exp(-z h) for a row whose label is the class, and for one whose label is another.
struct Factors {
    double h, own, other;
    explicit Factors(double response) : h(response), own(std::exp(-response)), other(std::exp(response)) {}
};

}  // namespace

HoldOut::HoldOut(const ValidationSet& set, std::size_t class_count, bool gentle)
    : set_(set),
      rows_(used_rows(set.rows, set.features.rows)),
      classes_(class_count),
      first_(gentle ? 1 : 0),
      h_(rows_.size() * class_count, 0.0),
      weight_(rows_.size() * class_count, 0.0) {
    check_pairs(rows_, set.features.rows, set.labels, set.weights, class_count);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        for (std::size_t c = first_; c < classes_; ++c) {
            total_ += weight_[i * classes_ + c] = initial_weight(i, c);
        }
        label_total_ += initial_weight(i, static_cast<std::size_t>(set_.labels[rows_[i]]));
    }
}

double HoldOut::initial_weight(std::size_t item, std::size_t c) const {
    const bool per_class = set_.weights.size() != set_.features.rows;
    return static_cast<double>(set_.weights[per_class ? rows_[item] * classes_ + c : rows_[item]]);
}

HoldOut::Measure HoldOut::add_to_rows(const Stump& stump, std::span<const float> elsewhere, std::size_t begin,
                                      std::size_t end) {
    const std::span<const float> x = set_.features.column(stump.feature);
    const Factors above(static_cast<double>(stump.above)), below(static_cast<double>(stump.below));
    std::vector<Factors> constant;
    for (const float k : elsewhere) constant.emplace_back(static_cast<double>(k));
    Measure measure;
    for (std::size_t i = begin; i < end; ++i) {
        const auto label = static_cast<std::size_t>(set_.labels[rows_[i]]);
        const Factors& side = x[rows_[i]] > stump.threshold ? above : below;
        for (std::size_t c = first_; c < classes_; ++c) {
            const Factors& factors = stump.classes >> c & 1 ? side : constant[c];
            h_[i * classes_ + c] += factors.h;
            measure.loss += weight_[i * classes_ + c] *= c == label ? factors.own : factors.other;
        }
        const auto row = h_.begin() + static_cast<std::ptrdiff_t>(i * classes_);
        const auto best = std::max_element(row, row + static_cast<std::ptrdiff_t>(classes_)) - row;
        if (static_cast<std::size_t>(best) != label) measure.error += initial_weight(i, label);
    }
    return measure;
}

void HoldOut::add(const Stump& stump, std::span<const float> elsewhere, BoostRound& round) {
    if (stump.feature >= set_.features.cols()) {
        throw UsageError("the validation rows have " + std::to_string(set_.features.cols()) +
                         " features, but a stump needs feature " + std::to_string(stump.feature));
    }
    std::vector<Measure> of_block((rows_.size() + k_block - 1) / k_block);
    parallel_for(of_block.size(), [&](std::size_t b) {
        of_block[b] = add_to_rows(stump, elsewhere, b * k_block, std::min((b + 1) * k_block, rows_.size()));
    });
    Measure all;
    for (const Measure& block : of_block) all.loss += block.loss, all.error += block.error;
    round.validation_loss = all.loss / total_;
    // Weights may be zero for a row's own class; then no error can be told.
    round.validation_error = label_total_ > 0.0 ? all.error / label_total_ : std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::uint32_t> used_rows(std::span<const std::uint32_t> rows, std::size_t row_count) {
    std::vector<std::uint32_t> out(rows.begin(), rows.end());
    if (rows.empty()) {
        out.resize(row_count);
        std::iota(out.begin(), out.end(), 0u);
    }
    for (const std::uint32_t row : out) {
        if (row >= row_count) {
            throw UsageError("row " + std::to_string(row) + " was chosen, but there are " + std::to_string(row_count));
        }
    }
    return out;
}

void check_pairs(std::span<const std::uint32_t> rows, std::size_t row_count, std::span<const std::int32_t> labels,
                 std::span<const float> weights, std::size_t class_count) {
    if (labels.size() != row_count || (weights.size() != row_count && weights.size() != row_count * class_count)) {
        throw UsageError("there are " + std::to_string(labels.size()) + " labels and " +
                         std::to_string(weights.size()) + " weights for " + std::to_string(row_count) + " rows of " +
                         std::to_string(class_count) +
                         " classes; give one label per row and one weight per row, or per row and class");
    }
    const std::size_t per_row = weights.size() == row_count ? 1 : class_count;
    double total = 0.0;
    for (const std::uint32_t row : rows) {
        if (labels[row] < 0 || static_cast<std::size_t>(labels[row]) >= class_count) {
            throw UsageError("row " + std::to_string(row) + " has label " + std::to_string(labels[row]) +
                             ", but labels are 0 to " + std::to_string(class_count - 1) + "; leave such rows out");
        }
        for (const float weight : weights.subspan(row * per_row, per_row)) {
            if (!(weight >= 0.0f) || std::isinf(weight)) {
                throw DataError("row " + std::to_string(row) + " has the weight " + std::to_string(weight) +
                                "; weights must be finite and not negative");
            }
            total += static_cast<double>(weight);
        }
    }
    if (total <= 0.0) throw DataError("all weights are zero; there is nothing to learn from");
}

}  // namespace exemplar
