#include "apps/bench/kernels/compiled_variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "gpu/runtime/kernels/reflection.h"

namespace exemplar {
namespace {

// A specialization constant, and the values that programs use. A constant with the name of a tunable parameter has
// none here: its default is TunableParameter::on_cards, and the parameter's other values are its variants.
struct KernelConstant {
    std::uint32_t id;
    std::string_view name;
    std::vector<std::uint32_t> values;
};

struct KernelConstants {
    std::string_view kernel;
    std::vector<KernelConstant> constants;
};

// Lines of `exemplar lines` by default (contours, suggestive contours, boundaries), and of all types.
const std::vector<std::uint32_t> k_family_sets{0x603, 0x7ff};

// The constants of all kernels, except for the group size.
const std::vector<KernelConstants>& all_constants() {
    static const std::vector<KernelConstants> all{
        {"learn/stumps.comp",
         {{0, "classes", {2, 8, 24}}, {1, "quads", {}}, {2, "storage", {}}, {3, "bits", {}}, {4, "in_parts", {0, 1}}}},
        {"labeling/context_geodesic.comp", {{0, "faces", {}}}},
        {"labeling/context_linear.comp", {{0, "rows", {}}}},
        {"labeling/prediction.comp", {{0, "classes", {2, 8, 24}}}},
        {"imaging/pack.comp", {{0, "masked", {0, 1}}}},
        {"imaging/mask_sums.comp", {{1, "outputs", {}}}},
        {"imaging/weighted_sums.comp", {{0, "orders", {1, 2, 3, 4}}, {1, "outputs", {}}, {2, "along_x", {0, 1}}}},
        {"curvature/curvature.comp", {{0, "smoothed", {0, 1}}}},
        {"curvature/derivative.comp", {{0, "smoothed", {0, 1}}}},
        {"curvature/reproject.comp", {{0, "principal", {0, 1}}, {1, "quads", {}}}},
        {"lines/fields.comp", {{0, "families", k_family_sets}}},
        {"lines/apparent_ridges.comp", {{0, "families", {0x7ff}}}},
        {"lines/count.comp", {{0, "families", k_family_sets}}},
        {"lines/segments.comp", {{0, "families", k_family_sets}}},
        {"lines/scan.comp", {{0, "of_points", {0, 1}}}},
        {"hatching/claim.comp", {{0, "checks_claims", {0, 1}}}}};
    return all;
}

std::span<const KernelConstant> constants_of(std::string_view kernel) {
    const auto found = std::ranges::find(all_constants(), kernel, &KernelConstants::kernel);
    return found == all_constants().end() ? std::span<const KernelConstant>() : found->constants;
}

const TunableParameter* parameter_of(const OperationKind& kind, std::string_view kernel, std::string_view name) {
    const auto found = std::ranges::find_if(kind.parameters, [&](const TunableParameter& parameter) {
        return parameter.kernel == kernel && parameter.name == name;
    });
    return found == kind.parameters.end() ? nullptr : &*found;
}

CompiledVariant with_constant(const CompiledVariant& variant, const KernelConstant& constant, std::uint32_t value,
                              bool is_default) {
    CompiledVariant result = variant;
    if (!result.name.empty()) result.name += ", ";
    const bool is_bit_set = constant.name == "families";
    result.name +=
        is_bit_set ? fmt::format("{} {:#x}", constant.name, value) : fmt::format("{} {}", constant.name, value);
    result.is_default = variant.is_default && is_default;
    result.constants.emplace_back(constant.id, value);
    return result;
}

// Replaces each variant by those that also have a value of the constant.
void combine(std::vector<CompiledVariant>& variants, const KernelConstant& constant,
             const TunableParameter* parameter) {
    std::vector<CompiledVariant> combined;
    const std::size_t values = constant.values.size() + (parameter ? parameter->values.size() : 0);
    combined.reserve(variants.size() * values);
    for (const CompiledVariant& variant : variants) {
        for (const std::uint32_t value : constant.values)
            combined.push_back(with_constant(variant, constant, value, true));
        if (!parameter) continue;
        combined.push_back(with_constant(variant, constant, parameter->on_cards, true));
        for (const std::uint32_t value : parameter->values)
            if (value != parameter->on_cards) combined.push_back(with_constant(variant, constant, value, false));
    }
    variants = std::move(combined);
}

void add_group_sizes(std::vector<CompiledVariant>& variants) {
    const Reflection reflection = reflect(*variants.front().kernel);
    if (reflection.local_size_ids[0] != k_group_size_constant) return;
    const KernelConstant group{k_group_size_constant, k_group_size.name, {}};
    const std::size_t count = variants.size();
    variants.reserve(count * (1 + k_group_sizes.size()));
    for (std::size_t i = 0; i < count; ++i) {
        if (!variants[i].is_default) continue;
        for (const std::uint32_t size : k_group_sizes)
            if (size != reflection.local_size[0]) variants.push_back(with_constant(variants[i], group, size, false));
    }
}

std::vector<CompiledVariant> variants_of(const OperationKind& kind, const Shader& kernel) {
    std::vector<CompiledVariant> variants{{.kernel = &kernel, .name = {}, .is_default = true, .constants = {}}};
    for (const KernelConstant& constant : constants_of(kernel.name))
        combine(variants, constant, parameter_of(kind, kernel.name, constant.name));
    add_group_sizes(variants);
    return variants;
}

}  // namespace

std::vector<CompiledVariant> compiled_variants(const KernelFilter& filter) {
    std::vector<CompiledVariant> all;
    for (const OperationKind& kind : operation_kinds())
        for (const Shader* kernel : kind.kernels) {
            const bool known = std::ranges::any_of(
                all, [&](const CompiledVariant& variant) { return variant.kernel->name == kernel->name; });
            if (known || !filter.wants(kind, kernel->name)) continue;
            std::ranges::move(variants_of(kind, *kernel), std::back_inserter(all));
        }
    return all;
}

}  // namespace exemplar
