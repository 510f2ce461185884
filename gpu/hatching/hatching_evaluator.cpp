#include "gpu/hatching/hatching_evaluator.h"

#include <algorithm>
#include <cmath>

#include "embedded/hatching_orientations_comp.h"
#include "embedded/hatching_property_comp.h"
#include "host/core/parallel.h"
#include "host/hatching/features/powers.h"
#include "shaders/shared/hatching_features.h"

namespace exemplar {
namespace {

using shared::PropertyParameters;
using shared::PropertyTerm;
using shared::RuleParameters;
using shared::RuleTerm;
using shared::uvec4;
using shared::vec4;
using Word = std::uint32_t;

// Kernels fetch them as texels.
static_assert(sizeof(RuleTerm) == sizeof(uvec4) && sizeof(PropertyTerm) == 2 * sizeof(uvec4));

/// The numbers in use, in ascending order, and the position of each.
struct Used {
    std::vector<Word> numbers;
    void sort() {
        std::ranges::sort(numbers);
        numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    }
    Word place(Word number) const {
        return static_cast<Word>(std::ranges::lower_bound(numbers, number) - numbers.begin());
    }
};

/// Rules in the layout of the kernel.
struct Rules {
    Used fields;
    std::vector<Word> begin{0};
    std::vector<RuleTerm> terms;
};

Rules rules_of(std::span<const OrientationFunction> functions) {
    const auto field_of = [](const auto& term) { return static_cast<Word>(field_of_feature(term.feature)); };
    Rules rules;
    for (const OrientationFunction& function : functions) {
        for (const auto& term : function.terms) rules.fields.numbers.push_back(field_of(term));
    }
    rules.fields.sort();
    for (const OrientationFunction& function : functions) {
        // A field turned by 90 degrees is the negated field.
        for (const auto& term : function.terms)
            rules.terms.push_back(
                {rules.fields.place(field_of(term)), is_rotated(term.feature) ? -term.weight : term.weight, 0, 0});
        rules.begin.push_back(static_cast<Word>(rules.terms.size()));
    }
    return rules;
}

std::vector<PropertyTerm> terms_of(const PropertyModel& model, const Used& used) {
    std::vector<PropertyTerm> terms;
    for (const PropertyModel::Term& term : model.terms) {
        terms.push_back({.column = used.place(static_cast<Word>(term.feature / k_powers)),
                         .power = static_cast<Word>(term.feature % k_powers),
                         .a = term.a,
                         .b = term.b,
                         .exponent = term.exponent,
                         .low = term.low,
                         .high = term.high,
                         .least = term.least});
    }
    return terms;
}

/// Copies values without NaN and infinity (D15 in docs/portability.md), and bounded so that squares are finite.
void copy_bounded(std::span<const float> values, std::span<std::byte> memory) {
    auto* const out = reinterpret_cast<float*>(memory.data());
    parallel_for(
        values.size(),
        [&](std::size_t i) {
            const float x = std::clamp(values[i], -shared::k_max_value, shared::k_max_value);
            out[i] = std::isnan(x) ? 2 * shared::k_no_value : x;
        },
        65536);
}

}  // namespace

GpuHatchingEvaluator::GpuHatchingEvaluator(Device& device, Profiler* profiler, std::size_t tile_bytes)
    : device_(device),
      tile_bytes_(buffer_limit(device.info(), tile_bytes)),
      stream_(device, profiler),
      orientations_(device, shaders::hatching_orientations_comp,
                    {.push_constants = layout_of<RuleParameters>(),
                     .elements = {layout_of<Word>(), layout_of<Word>(), layout_of<uvec4>(), layout_of<shared::vec2>(),
                                  layout_of<shared::vec2>()}}),
      property_(device, shaders::hatching_property_comp,
                {.push_constants = layout_of<PropertyParameters>(),
                 .elements = {layout_of<uvec4>(), layout_of<vec4>(), layout_of<vec4>()}}) {}

/// Returns the rows of a tile, a multiple of 4. Kernels access `row_bytes` and one texel per row.
std::size_t GpuHatchingEvaluator::tile_rows(std::size_t rows, std::size_t row_bytes) const {
    const std::size_t most = std::min<std::size_t>(tile_bytes_ / row_bytes, device_.info().max_texels);
    return std::max<std::size_t>(std::min(most, rows + 3) / 4 * 4, 4);
}

std::vector<DoubledAngle> GpuHatchingEvaluator::orientations(std::span<const OrientationFunction> functions,
                                                             std::span<const std::int32_t> segment,
                                                             const OrientationFields& fields) {
    check_orientations(functions, segment, fields);
    std::vector<DoubledAngle> directions(fields.rows);
    const Rules rules = rules_of(functions);
    if (rules.terms.empty() || fields.rows == 0) return directions;
    const Buffer begins = uploaded<Word>(device_, stream_, rules.begin),
                 terms = uploaded<RuleTerm>(device_, stream_, rules.terms);
    const std::size_t used = rules.fields.numbers.size(), tile = tile_rows(fields.rows, used * sizeof(DoubledAngle));
    reserve(device_, segments_, tile * sizeof(Word));
    reserve(device_, columns_, used * tile * sizeof(DoubledAngle));
    reserve(device_, values_, tile * sizeof(DoubledAngle));
    for (std::size_t first = 0; first < fields.rows; first += tile) {
        const std::size_t rows = std::min(tile, fields.rows - first);
        stream_.upload(segments_, segment.subspan(first, rows));
        for (std::size_t k = 0; k < used; ++k)
            stream_.upload(columns_, fields.field(rules.fields.numbers[k]).subspan(first, rows),
                           k * tile * sizeof(DoubledAngle));
        const RuleParameters parameters{static_cast<Word>(rows), static_cast<Word>(tile)};
        stream_.dispatch(orientations_, rows,
                         {BufferRange(segments_, 0, tile * sizeof(Word)), begins, terms,
                          BufferRange(columns_, 0, used * tile * sizeof(DoubledAngle)),
                          BufferRange(values_, 0, tile * sizeof(DoubledAngle))},
                         parameters);
        stream_.fetch(values_, std::span(directions).subspan(first, rows));
    }
    return directions;
}

std::vector<float> GpuHatchingEvaluator::property(const PropertyModel& model, std::span<const std::uint32_t> which,
                                                  const FeatureMatrix& base) {
    const std::vector<std::span<const float>> columns = property_columns(model, which, base);
    std::vector<float> values(base.rows);
    if (base.rows == 0) return values;
    Used used;
    for (const auto& term : model.terms) used.numbers.push_back(static_cast<Word>(term.feature / k_powers));
    used.sort();
    std::vector<PropertyTerm> terms = terms_of(model, used);
    std::vector<std::span<const float>> of_place(std::max<std::size_t>(used.numbers.size(), 1));
    for (std::size_t k = 0; k < terms.size(); ++k) of_place[terms[k].column] = columns[k];
    const Buffer term_buffer = uploaded<PropertyTerm>(device_, stream_, terms);
    const std::size_t tile = tile_rows(base.rows, of_place.size() * sizeof(float)), column_bytes = tile * sizeof(float);
    reserve(device_, columns_, of_place.size() * column_bytes);
    reserve(device_, values_, column_bytes);
    for (std::size_t first = 0; first < base.rows; first += tile) {
        const std::size_t rows = std::min(tile, base.rows - first);
        for (std::size_t k = 0; k < used.numbers.size(); ++k)
            stream_.upload_with(columns_, rows * sizeof(float), k * column_bytes, [&](std::span<std::byte> memory) {
                copy_bounded(of_place[k].subspan(first, rows), memory);
            });
        const PropertyParameters parameters{.quads = static_cast<Word>((rows + 3) / 4),
                                            .stride = static_cast<Word>(tile / 4),
                                            .terms = static_cast<Word>(terms.size()),
                                            .log_factor = std::log(model.factor)};
        stream_.dispatch(property_, parameters.quads,
                         {term_buffer, BufferRange(columns_, 0, of_place.size() * column_bytes),
                          BufferRange(values_, 0, column_bytes)},
                         parameters);
        stream_.fetch(values_, std::span(values).subspan(first, rows));
    }
    return values;
}

}  // namespace exemplar
