#include "gpu/runtime/kernel.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/runtime/device.h"
#include "gpu/runtime/errors.h"

namespace exemplar {
namespace {

void check_interface(const Shader& shader, const Reflection& reflection, const KernelInterface& interface) {
    const StructLayout none{.name = "interface without push constants", .bytes = 0, .fields = {}};
    check_layout(shader, "the push constants", interface.push_constants.value_or(none), reflection.push_bytes,
                 reflection.push_fields);
    if (interface.elements.size() > reflection.bindings.size())
        throw ShaderError(fmt::format("shader {}: it has {} buffers, the program describes {}", shader.name,
                                      reflection.bindings.size(), interface.elements.size()));
    for (std::size_t i = 0; i < interface.elements.size(); ++i) {
        const ReflectedBinding& binding = reflection.bindings[i];
        if (binding.type == BindingType::storage)
            check_layout(shader, fmt::format("the elements of buffer '{}'", binding.name), interface.elements[i],
                         binding.stride, binding.fields);
    }
    for (const auto& [id, value] : interface.constants)
        if (std::ranges::find(reflection.constant_ids, id) == reflection.constant_ids.end())
            throw ShaderError(fmt::format("shader {}: it has no specialization constant {}", shader.name, id));
}

// Texels of 4 or 16 bytes: the formats that every device can read.
VkFormat texel_format(const ReflectedBinding& binding, std::size_t bytes) {
    if (bytes == 4) return binding.integers ? VK_FORMAT_R32_UINT : VK_FORMAT_R32_SFLOAT;
    if (bytes == 16) return binding.integers ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32G32B32A32_SFLOAT;
    return VK_FORMAT_UNDEFINED;
}

void set_texel_formats(const Shader& shader, const KernelInterface& interface, Reflection& reflection) {
    for (std::size_t i = 0; i < reflection.bindings.size(); ++i) {
        ReflectedBinding& binding = reflection.bindings[i];
        if (binding.type != BindingType::texels) continue;
        binding.stride = i < interface.elements.size() ? interface.elements[i].bytes : 0;
        binding.format = texel_format(binding, binding.stride);
        if (binding.format == VK_FORMAT_UNDEFINED)
            throw ShaderError(
                fmt::format("shader {}: the texels of '{}' need a described type of 4 or 16 bytes, not {}", shader.name,
                            binding.name, binding.stride));
    }
}

void specialize_local_size(Reflection& reflection, const KernelInterface& interface) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const auto& [id, value] : interface.constants)
            if (reflection.local_size_ids[axis] == id) reflection.local_size[axis] = value;
}

void check_limits(const Shader& shader, const Reflection& reflection, const DeviceInfo& info) {
    const std::uint64_t invocations =
        std::uint64_t{reflection.local_size[0]} * reflection.local_size[1] * reflection.local_size[2];
    if (invocations == 0) throw ShaderError(fmt::format("shader {}: its workgroups are empty", shader.name));
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (reflection.local_size[axis] > info.max_group_size[axis])
            throw DeviceLimitError(
                fmt::format(
                    "shader {}: workgroups of {} invocations along axis {} are over the limit of {} of device '{}'",
                    shader.name, reflection.local_size[axis], axis, info.max_group_size[axis], info.name),
                reflection.local_size[axis], info.max_group_size[axis]);
    if (invocations > info.max_invocations)
        throw DeviceLimitError(
            fmt::format("shader {}: workgroups of {} invocations are over the limit of {} of device '{}'", shader.name,
                        invocations, info.max_invocations, info.name),
            invocations, info.max_invocations);
    const auto buffers = static_cast<std::uint64_t>(
        std::ranges::count(reflection.bindings, BindingType::storage, &ReflectedBinding::type));
    if (buffers > info.max_storage_buffers)
        throw DeviceLimitError(fmt::format("shader {}: {} storage buffers are over the limit of {} of device '{}'",
                                           shader.name, buffers, info.max_storage_buffers, info.name),
                               buffers, info.max_storage_buffers);
    if (reflection.push_bytes > info.max_push_constants)
        throw DeviceLimitError(
            fmt::format("shader {}: {} bytes of push constants are over the limit of {} of device '{}'", shader.name,
                        reflection.push_bytes, info.max_push_constants, info.name),
            reflection.push_bytes, info.max_push_constants);
}

void create_layouts(const Device& device, Kernel::Program& program) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const ReflectedBinding& binding : program.reflection.bindings)
        bindings.push_back({binding.binding, descriptor_type(binding.type), 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    const VkDescriptorSetLayoutCreateInfo set{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                              .pNext = nullptr,
                                              .flags = 0,
                                              .bindingCount = static_cast<std::uint32_t>(bindings.size()),
                                              .pBindings = bindings.data()};
    const auto what = [&] { return fmt::format("make the layout of kernel {}", program.name); };
    check(vkCreateDescriptorSetLayout(device.handle(), &set, nullptr, program.set_layout.put()), what);
    const VkDescriptorSetLayout set_layout = program.set_layout.get();
    const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0,
                                   static_cast<std::uint32_t>(program.reflection.push_bytes)};
    const VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                            .pNext = nullptr,
                                            .flags = 0,
                                            .setLayoutCount = 1,
                                            .pSetLayouts = &set_layout,
                                            .pushConstantRangeCount = push.size ? 1u : 0u,
                                            .pPushConstantRanges = &push};
    check(vkCreatePipelineLayout(device.handle(), &layout, nullptr, program.layout.put()), what);
}

void create_pipeline(Device& device, Kernel::Program& program, const Shader& shader, const KernelInterface& interface) {
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<std::uint32_t> values;
    for (const auto& [id, value] : interface.constants) {
        entries.push_back({id, static_cast<std::uint32_t>(values.size() * sizeof value), sizeof value});
        values.push_back(value);
    }
    const VkSpecializationInfo constants{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                         values.size() * sizeof(std::uint32_t), values.data()};
    const UniqueShaderModule module = make_module(device, shader);
    const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                           .pNext = nullptr,
                                           .flags = 0,
                                           .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                     .pNext = nullptr,
                                                     .flags = 0,
                                                     .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                     .module = module.get(),
                                                     .pName = "main",
                                                     .pSpecializationInfo = &constants},
                                           .layout = program.layout.get(),
                                           .basePipelineHandle = VK_NULL_HANDLE,
                                           .basePipelineIndex = -1};
    check(vkCreateComputePipelines(device.handle(), device.pipeline_cache().handle(), 1, &info, nullptr,
                                   program.pipeline.put()),
          [&] { return fmt::format("compile kernel {}", program.name); });
}

}  // namespace

Kernel::Kernel(Device& device, const Shader& shader, const KernelInterface& interface) {
    const auto program = std::make_shared<Program>(Program{.name = std::string(shader.name),
                                                           .reflection = reflect(shader),
                                                           .set_layout = UniqueSetLayout(device.handle()),
                                                           .layout = UniquePipelineLayout(device.handle()),
                                                           .pipeline = UniquePipeline(device.handle())});
    check_interface(shader, program->reflection, interface);
    set_texel_formats(shader, interface, program->reflection);
    specialize_local_size(program->reflection, interface);
    check_limits(shader, program->reflection, device.info());
    create_layouts(device, *program);
    create_pipeline(device, *program, shader, interface);
    program_ = program;
}

UniqueShaderModule make_module(const Device& device, const Shader& shader) {
    auto info = empty_structure<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    info.codeSize = shader.words.size_bytes();
    info.pCode = shader.words.data();
    UniqueShaderModule module(device.handle());
    check(vkCreateShaderModule(device.handle(), &info, nullptr, module.put()),
          [&] { return fmt::format("load shader {}", shader.name); });
    return module;
}

}  // namespace exemplar
