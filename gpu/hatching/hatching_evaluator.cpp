#include "gpu/hatching/hatching_evaluator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "embedded/hatching_orientations_comp.h"
#include "embedded/hatching_property_comp.h"
#include "host/core/errors.h"
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

Used used_features(const PropertyModel& model) {
    Used used;
    for (const PropertyModel::Term& term : model.terms)
        used.numbers.push_back(static_cast<Word>(term.feature / k_powers));
    used.sort();
    return used;
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

std::vector<std::uint32_t> GpuHatchingEvaluator::fields_of(std::span<const OrientationFunction> functions) {
    return rules_of(functions).fields.numbers;
}

std::vector<std::uint32_t> GpuHatchingEvaluator::features_of(const PropertyModel& model) {
    return used_features(model).numbers;
}

void GpuHatchingEvaluator::record_orientations(Stream& stream, std::span<const OrientationFunction> functions,
                                               const Buffer& segments, const Buffer& fields, std::size_t rows,
                                               std::size_t stride, const Buffer& directions) {
    const Rules rules = rules_of(functions);
    const std::size_t field_bytes =
        std::max<std::size_t>(rules.fields.numbers.size(), 1) * stride * sizeof(DoubledAngle);
    if (stride < rows || segments.bytes() < rows * sizeof(Word) || fields.bytes() < field_bytes ||
        directions.bytes() < rows * sizeof(DoubledAngle))
        throw UsageError(fmt::format("{} rows of {} fields, {} rows apart, do not fit buffers of {}, {} and {} bytes",
                                     rows, rules.fields.numbers.size(), stride, segments.bytes(), fields.bytes(),
                                     directions.bytes()));
    if (rows == 0) return;
    std::vector<RuleTerm> terms = rules.terms;
    if (terms.empty()) terms.push_back({});  // a buffer cannot be empty; no rule refers to it
    const Buffer begins = uploaded<Word>(device_, stream, rules.begin),
                 term_buffer = uploaded<RuleTerm>(device_, stream, terms);
    stream.dispatch(orientations_, rows,
                    {BufferRange(segments, 0, rows * sizeof(Word)), begins, term_buffer,
                     BufferRange(fields, 0, field_bytes), BufferRange(directions, 0, rows * sizeof(DoubledAngle))},
                    RuleParameters{static_cast<Word>(rows), static_cast<Word>(stride)});
}

void GpuHatchingEvaluator::record_property(Stream& stream, const PropertyModel& model, const Buffer& columns,
                                           std::size_t rows, std::size_t stride, const Buffer& values) {
    const Used used = used_features(model);
    const std::size_t column_bytes = std::max<std::size_t>(used.numbers.size(), 1) * stride * sizeof(float);
    if (stride % 4 != 0 || stride < rows || columns.bytes() < column_bytes || values.bytes() < stride * sizeof(float))
        throw UsageError(fmt::format(
            "{} rows of {} columns, {} rows apart, do not fit buffers of {} and {} bytes; the distance must "
            "be a multiple of 4",
            rows, used.numbers.size(), stride, columns.bytes(), values.bytes()));
    if (rows == 0) return;
    std::vector<PropertyTerm> terms = terms_of(model, used);
    const PropertyParameters parameters{.quads = static_cast<Word>((rows + 3) / 4),
                                        .stride = static_cast<Word>(stride / 4),
                                        .terms = static_cast<Word>(terms.size()),
                                        .log_factor = std::log(model.factor)};
    if (terms.empty()) terms.push_back({});
    const Buffer term_buffer = uploaded<PropertyTerm>(device_, stream, terms);
    stream.dispatch(
        property_, parameters.quads,
        {term_buffer, BufferRange(columns, 0, column_bytes), BufferRange(values, 0, stride * sizeof(float))},
        parameters);
}

std::vector<DoubledAngle> GpuHatchingEvaluator::orientations(std::span<const OrientationFunction> functions,
                                                             std::span<const std::int32_t> segment,
                                                             const OrientationFields& fields) {
    check_orientations(functions, segment, fields);
    std::vector<DoubledAngle> directions(fields.rows);
    const std::vector<std::uint32_t> used = fields_of(functions);
    if (used.empty() || fields.rows == 0) return directions;
    const std::size_t tile = tile_rows(fields.rows, used.size() * sizeof(DoubledAngle));
    reserve(device_, segments_, tile * sizeof(Word));
    reserve(device_, columns_, used.size() * tile * sizeof(DoubledAngle));
    reserve(device_, values_, tile * sizeof(DoubledAngle));
    for (std::size_t first = 0; first < fields.rows; first += tile) {
        const std::size_t rows = std::min(tile, fields.rows - first);
        stream_.upload(segments_, segment.subspan(first, rows));
        for (std::size_t k = 0; k < used.size(); ++k)
            stream_.upload(columns_, fields.field(used[k]).subspan(first, rows), k * tile * sizeof(DoubledAngle));
        record_orientations(stream_, functions, segments_, columns_, rows, tile, values_);
        stream_.fetch(values_, std::span(directions).subspan(first, rows));
    }
    return directions;
}

std::vector<float> GpuHatchingEvaluator::property(const PropertyModel& model, std::span<const std::uint32_t> which,
                                                  const FeatureMatrix& base) {
    const std::vector<std::span<const float>> columns = property_columns(model, which, base);
    std::vector<float> values(base.rows);
    if (base.rows == 0) return values;
    const Used used = used_features(model);
    std::vector<std::span<const float>> of_place(used.numbers.size());
    for (std::size_t k = 0; k < columns.size(); ++k)
        of_place[used.place(static_cast<Word>(model.terms[k].feature / k_powers))] = columns[k];
    const std::size_t count = std::max<std::size_t>(of_place.size(), 1),
                      tile = tile_rows(base.rows, count * sizeof(float));
    reserve(device_, columns_, count * tile * sizeof(float));
    reserve(device_, values_, tile * sizeof(float));
    for (std::size_t first = 0; first < base.rows; first += tile) {
        const std::size_t rows = std::min(tile, base.rows - first);
        for (std::size_t k = 0; k < of_place.size(); ++k)
            stream_.upload_with(
                columns_, rows * sizeof(float), k * tile * sizeof(float),
                [&](std::span<std::byte> memory) { copy_bounded(of_place[k].subspan(first, rows), memory); });
        record_property(stream_, model, columns_, rows, tile, values_);
        stream_.fetch(values_, std::span(values).subspan(first, rows));
    }
    return values;
}

}  // namespace exemplar
