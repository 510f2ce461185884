#include "gpu/runtime/kernels/reflection.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "gpu/runtime/kernels/spirv_module.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

// Reflects what all binding types have in common.
ReflectedBinding reflect_place(const Shader& shader, const SpirvModule& module,
                               const spvc_reflected_resource& resource) {
    if (spvc_compiler_get_decoration(module.compiler(), resource.id, SpvDecorationDescriptorSet) != 0)
        throw ShaderError(fmt::format("shader {}: '{}' is not in descriptor set 0", shader.name, resource.name));
    if (spvc_type_get_num_array_dimensions(module.type(resource.type_id)) != 0)
        throw ShaderError(fmt::format("shader {}: '{}' is an array of buffers; kernels bind one buffer per binding",
                                      shader.name, resource.name));
    ReflectedBinding binding;
    binding.binding = spvc_compiler_get_decoration(module.compiler(), resource.id, SpvDecorationBinding);
    binding.name = resource.name;
    return binding;
}

[[noreturn]] void refuse_binding(const Shader& shader, const SpirvModule& module,
                                 const spvc_reflected_resource& resource, std::string_view type) {
    throw ShaderError(fmt::format(
        "shader {}: binding {} '{}' is {}; kernels bind storage buffers, and buffers of float or uint texels",
        shader.name, spvc_compiler_get_decoration(module.compiler(), resource.id, SpvDecorationBinding), resource.name,
        type));
}

ReflectedBinding reflect_texels(const Shader& shader, const SpirvModule& module,
                                const spvc_reflected_resource& resource) {
    const spvc_type type = module.type(resource.base_type_id);
    const spvc_basetype values = spvc_type_get_basetype(module.type(spvc_type_get_image_sampled_type(type)));
    if (spvc_type_get_image_dimension(type) != SpvDimBuffer ||
        (values != SPVC_BASETYPE_FP32 && values != SPVC_BASETYPE_UINT32))
        refuse_binding(shader, module, resource, "an image, or has texels of another type");
    ReflectedBinding binding = reflect_place(shader, module, resource);
    binding.type = BindingType::texels;
    binding.integers = values == SPVC_BASETYPE_UINT32;
    binding.writes = false;
    return binding;
}

ReflectedBinding reflect_storage(const Shader& shader, const SpirvModule& module,
                                 const spvc_reflected_resource& resource) {
    ReflectedBinding binding = reflect_place(shader, module, resource);
    const SpvDecoration* decorations = nullptr;
    std::size_t count = 0;
    module.require(spvc_compiler_get_buffer_block_decorations(module.compiler(), resource.id, &decorations, &count));
    const std::span<const SpvDecoration> list(decorations, count);
    binding.writes = std::ranges::find(list, SpvDecorationNonWritable) == list.end();
    binding.reads = std::ranges::find(list, SpvDecorationNonReadable) == list.end();

    const spvc_type block = module.type(resource.base_type_id);
    const unsigned members = spvc_type_get_num_member_types(block);
    if (members == 0) return binding;
    const unsigned last = members - 1;
    const spvc_type_id tail = spvc_type_get_member_type(block, last);
    if (spvc_type_get_num_array_dimensions(module.type(tail)) == 0) return binding;
    unsigned stride = 0;
    module.require(spvc_compiler_type_struct_member_array_stride(module.compiler(), block, last, &stride));
    binding.stride = stride;
    if (spvc_type_get_basetype(module.type(tail)) == SPVC_BASETYPE_STRUCT)
        binding.fields = module.fields(module.element(tail));
    return binding;
}

void reflect_bindings(const Shader& shader, const SpirvModule& module, Reflection& result) {
    constexpr std::array<std::pair<spvc_resource_type, std::string_view>, 5> k_refused{
        {{SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, "a uniform buffer"},
         {SPVC_RESOURCE_TYPE_STORAGE_IMAGE, "a storage image"},
         {SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, "an image without its sampler"},
         {SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS, "a sampler"},
         {SPVC_RESOURCE_TYPE_ACCELERATION_STRUCTURE, "an acceleration structure"}}};
    for (const auto& [type, text] : k_refused)
        for (const spvc_reflected_resource& resource : module.resources(type))
            refuse_binding(shader, module, resource, text);
    for (const spvc_reflected_resource& resource : module.resources(SPVC_RESOURCE_TYPE_STORAGE_BUFFER))
        result.bindings.push_back(reflect_storage(shader, module, resource));
    for (const spvc_reflected_resource& resource : module.resources(SPVC_RESOURCE_TYPE_SAMPLED_IMAGE))
        result.bindings.push_back(reflect_texels(shader, module, resource));
    std::ranges::sort(result.bindings, {}, &ReflectedBinding::binding);
}

void reflect_push_constants(const SpirvModule& module, Reflection& result) {
    for (const spvc_reflected_resource& resource : module.resources(SPVC_RESOURCE_TYPE_PUSH_CONSTANT)) {
        spvc_type block = module.type(resource.base_type_id);
        if (spvc_type_get_num_member_types(block) == 0) continue;
        module.require(spvc_compiler_get_declared_struct_size(module.compiler(), block, &result.push_bytes));
        const spvc_type_id first = spvc_type_get_member_type(block, 0);
        const bool wraps_structure = spvc_type_get_num_member_types(block) == 1 &&
                                     spvc_type_get_basetype(module.type(first)) == SPVC_BASETYPE_STRUCT;
        result.push_fields = module.fields(wraps_structure ? module.type(first) : block);
    }
}

void reflect_constants(const SpirvModule& module, Reflection& result) {
    for (unsigned axis = 0; axis < 3; ++axis)
        result.local_size[axis] =
            spvc_compiler_get_execution_mode_argument_by_index(module.compiler(), SpvExecutionModeLocalSize, axis);
    std::array<spvc_specialization_constant, 3> size{};
    spvc_compiler_get_work_group_size_specialization_constants(module.compiler(), &size[0], &size[1], &size[2]);
    for (unsigned axis = 0; axis < 3; ++axis) {
        if (size[axis].id == 0) continue;
        result.local_size_ids[axis] = size[axis].constant_id;
        result.local_size[axis] =
            spvc_constant_get_scalar_u32(spvc_compiler_get_constant_handle(module.compiler(), size[axis].id), 0, 0);
    }
    const spvc_specialization_constant* constants = nullptr;
    std::size_t count = 0;
    module.require(spvc_compiler_get_specialization_constants(module.compiler(), &constants, &count));
    for (const spvc_specialization_constant& constant : std::span(constants, count))
        result.constant_ids.push_back(constant.constant_id);
}

}  // namespace

VkDescriptorType descriptor_type(BindingType type) {
    return type == BindingType::texels ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

Reflection reflect(const Shader& shader) {
    const SpirvModule module(shader);
    Reflection result;
    reflect_bindings(shader, module, result);
    reflect_push_constants(module, result);
    reflect_constants(module, result);
    return result;
}

void check_layout(const Shader& shader, const std::string& where, const StructLayout& expected, std::size_t bytes,
                  const std::vector<ReflectedField>& fields) {
    const std::string start = fmt::format("shader {}: {} and C++'s {} differ: ", shader.name, where, expected.name);
    if (!expected.fields.empty()) {
        for (std::size_t i = 0; i < std::min(fields.size(), expected.fields.size()); ++i) {
            const FieldLayout& field = expected.fields[i];
            if (fields[i].name != field.name)
                throw ShaderError(
                    fmt::format("{}member {} is '{}' there and '{}' here", start, i, fields[i].name, field.name));
            if (fields[i].offset != field.offset)
                throw ShaderError(fmt::format("{}'{}' is at byte {} there and at byte {} here", start, field.name,
                                              fields[i].offset, field.offset));
            if (fields[i].bytes != field.bytes)
                throw ShaderError(fmt::format("{}'{}' has {} bytes there and {} here", start, field.name,
                                              fields[i].bytes, field.bytes));
        }
        if (fields.size() != expected.fields.size())
            throw ShaderError(
                fmt::format("{}{} members there and {} here", start, fields.size(), expected.fields.size()));
    }
    if (bytes != expected.bytes)
        throw ShaderError(fmt::format("{}{} bytes there and {} here", start, bytes, expected.bytes));
}

}  // namespace exemplar
