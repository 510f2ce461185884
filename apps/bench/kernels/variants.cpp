#include "apps/bench/kernels/variants.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/bench/kernels/statistics.h"
#include "gpu/runtime/kernels/reflection.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

// An operation with one value of a parameter; without a value, with the current one.
struct Variant {
    std::optional<std::uint32_t> value;
    Profiler profiler;
    Operation operation;
    std::map<std::string, std::vector<ExecutableStatistic>> statistics;  // by kernel
    std::string name() const { return value ? std::to_string(*value) : "as it is"; }
};

bool has_group_size(const Shader& kernel) {
    return reflect(kernel).local_size_ids[0] == k_group_size_constant;
}

// Values that the device allows.
std::vector<std::uint32_t> possible_values(const TunableParameter& parameter, const DeviceInfo& info) {
    std::vector<std::uint32_t> values(parameter.values.begin(), parameter.values.end());
    if (parameter.name == k_group_size.name)
        std::erase_if(values,
                      [&](std::uint32_t size) { return size > info.max_invocations || size > info.max_group_size[0]; });
    return values;
}

std::unique_ptr<Variant> prepare_variant(Device& device, const OperationKind& kind, std::size_t size,
                                         std::span<const std::string> kernels, std::string_view parameter,
                                         std::optional<std::uint32_t> value) {
    const Tuning kept = device.tuning();
    if (value)
        for (const std::string& kernel : kernels) device.tuning().set(kernel, parameter, *value);
    auto variant = std::make_unique<Variant>();
    variant->value = value;
    variant->operation = kind.prepare(device, variant->profiler, size);
    // Some operations make kernels when they first run.
    variant->operation.run();
    variant->operation.run();
    device.tuning() = kept;
    for (const std::string& kernel : kernels) variant->statistics[kernel] = device.statistics_of(kernel);
    for (const Difference& difference : variant->operation.differences())
        if (!difference.fits())
            throw DeviceError(fmt::format(
                "{} with {} {}: {} differ from the reference by {:.2g}, of which {:.2g} is "
                "allowed; this variant, or the driver, is broken",
                kind.name, parameter, variant->name(), difference.of, difference.largest, difference.tolerance));
    return variant;
}

// Times kernels that have the parameter at each of its values, all in turns.
std::vector<VariantComparison> time_variants(Device& device, const OperationKind& kind, std::size_t size,
                                             std::span<const std::string> kernels, const TunableParameter& parameter,
                                             const TimingOptions& options) {
    std::vector<std::unique_ptr<Variant>> variants;
    variants.push_back(prepare_variant(device, kind, size, kernels, parameter.name, std::nullopt));
    for (const std::uint32_t value : possible_values(parameter, device.info()))
        variants.push_back(prepare_variant(device, kind, size, kernels, parameter.name, value));
    std::vector<Timed> timed;
    timed.reserve(variants.size());
    for (const auto& variant : variants) timed.push_back({variant->name(), &variant->operation, &variant->profiler});
    const std::vector<OperationTimes> times = time_in_turns(timed, options);
    std::vector<VariantComparison> comparisons;
    for (const std::string& kernel : kernels) {
        if (!times[0].kernels.contains(kernel)) continue;
        const auto times_of = [&](std::size_t variant) {
            return parameter.judged == TuningMetric::end_to_end ? times[variant].runs
                                                                : times[variant].kernels.at(kernel);
        };
        VariantComparison& comparison =
            comparisons.emplace_back(VariantComparison{.operation = std::string(kind.name),
                                                       .kernel = kernel,
                                                       .parameter = std::string(parameter.name),
                                                       .judged = parameter.judged,
                                                       .size = size,
                                                       .as_is = times_of(0),
                                                       .milliseconds = {},
                                                       .statistics = {},
                                                       .chosen = std::nullopt});
        for (std::size_t i = 1; i < variants.size(); ++i) {
            comparison.milliseconds[*variants[i]->value] = times_of(i);
            comparison.statistics[*variants[i]->value] = variants[i]->statistics[kernel];
        }
    }
    return comparisons;
}

void choose(VariantComparison& comparison) {
    const auto fastest = std::ranges::min_element(comparison.milliseconds, {},
                                                  [](const auto& variant) { return median(variant.second); });
    if (fastest != comparison.milliseconds.end() && ratio_of(fastest->second, comparison.as_is).is_faster())
        comparison.chosen = fastest->first;
}

// A parameter to compare, and the kernels that have it.
struct Question {
    TunableParameter parameter;
    std::vector<std::string> kernels;
};

std::vector<Question> questions_of(const OperationKind& kind, const KernelFilter& filter,
                                   const std::vector<std::string>& known) {
    const auto is_asked = [&](std::string_view kernel) {
        return filter.wants(kind, kernel) && std::ranges::find(known, kernel) == known.end();
    };
    std::vector<Question> questions;
    Question groups{.parameter = k_group_size, .kernels = {}};
    for (const Shader* kernel : kind.kernels)
        if (is_asked(kernel->name) && has_group_size(*kernel)) groups.kernels.emplace_back(kernel->name);
    if (!groups.kernels.empty()) questions.push_back(groups);
    for (const TunableParameter& parameter : kind.parameters)
        if (is_asked(parameter.kernel)) questions.push_back({parameter, {std::string(parameter.kernel)}});
    return questions;
}

}  // namespace

std::vector<VariantComparison> compare_variants(Device& device, const OperationKind& kind, std::size_t size,
                                                const KernelFilter& filter, const TimingOptions& options,
                                                std::vector<std::string>& known) {
    std::vector<VariantComparison> comparisons;
    for (const Question& question : questions_of(kind, filter, known)) {
        for (VariantComparison& comparison :
             time_variants(device, kind, size, question.kernels, question.parameter, options)) {
            choose(comparison);
            if (comparison.chosen) device.tuning().set(comparison.kernel, comparison.parameter, *comparison.chosen);
            comparisons.push_back(std::move(comparison));
        }
    }
    for (const Shader* kernel : kind.kernels)
        if (filter.wants(kind, kernel->name)) known.emplace_back(kernel->name);
    return comparisons;
}

nlohmann::ordered_json to_json(const VariantComparison& comparison) {
    nlohmann::ordered_json json = {
        {"operation", comparison.operation},
        {"kernel", comparison.kernel},
        {"parameter", comparison.parameter},
        {"times_of", comparison.judged == TuningMetric::end_to_end ? "whole runs" : "the kernel"},
        {"size", comparison.size},
        {"ms_as_it_was", comparison.as_is}};
    json["variants"] = nlohmann::ordered_json::array();
    for (const auto& [value, milliseconds] : comparison.milliseconds) {
        json["variants"].push_back({{"value", value}, {"ms_of_repeats", milliseconds}});
        const auto statistics = comparison.statistics.find(value);
        if (statistics == comparison.statistics.end()) continue;
        for (const ExecutableStatistic& statistic : statistics->second)
            json["variants"].back()["driver_statistics"][statistic.name] = statistic.value;
    }
    json["chosen"] = comparison.chosen ? nlohmann::ordered_json(*comparison.chosen) : nlohmann::ordered_json();
    return json;
}

}  // namespace exemplar
