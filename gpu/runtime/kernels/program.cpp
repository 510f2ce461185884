#include "gpu/runtime/kernels/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

// C++ pads a structure to its alignment; shaders end it after its last member.
void pad_push_constants(const ProgramInterface& interface, Reflection& reflection) {
    if (!interface.push_constants) return;
    const std::size_t alignment = interface.push_constants->alignment;
    reflection.push_bytes = (reflection.push_bytes + alignment - 1) / alignment * alignment;
}

void check_declarations(const Shader& shader, const Reflection& reflection, const ProgramInterface& interface) {
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

void set_texel_formats(const Shader& shader, const ProgramInterface& interface, Reflection& reflection) {
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

}  // namespace

std::uint64_t next_program_id() {
    static std::atomic<std::uint64_t> last = 0;
    return ++last;
}

void check_interface(const Shader& shader, const ProgramInterface& interface, Reflection& reflection) {
    pad_push_constants(interface, reflection);
    check_declarations(shader, reflection, interface);
    set_texel_formats(shader, interface, reflection);
}

void create_layouts(const Device& device, Program& program) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const ReflectedBinding& binding : program.reflection.bindings)
        bindings.push_back({binding.binding, descriptor_type(binding.type), 1, program.stages, nullptr});
    const VkDescriptorSetLayoutCreateInfo set{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                              .pNext = nullptr,
                                              .flags = 0,
                                              .bindingCount = static_cast<std::uint32_t>(bindings.size()),
                                              .pBindings = bindings.data()};
    const auto what = [&] { return fmt::format("make the layout of {}", program.name); };
    check(vkCreateDescriptorSetLayout(device.handle(), &set, nullptr, program.set_layout.put()), what);
    const VkDescriptorSetLayout set_layout = program.set_layout.get();
    const VkPushConstantRange push{program.stages, 0, static_cast<std::uint32_t>(program.reflection.push_bytes)};
    const VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                            .pNext = nullptr,
                                            .flags = 0,
                                            .setLayoutCount = 1,
                                            .pSetLayouts = &set_layout,
                                            .pushConstantRangeCount = push.size ? 1u : 0u,
                                            .pPushConstantRanges = &push};
    check(vkCreatePipelineLayout(device.handle(), &layout, nullptr, program.layout.put()), what);
}

Specialization::Specialization(const ProgramInterface& interface) : info_{} {
    for (const auto& [id, value] : interface.constants) {
        entries_.push_back({id, static_cast<std::uint32_t>(values_.size() * sizeof value), sizeof value});
        values_.push_back(value);
    }
    info_ = {static_cast<std::uint32_t>(entries_.size()), entries_.data(), values_.size() * sizeof(std::uint32_t),
             values_.data()};
}

Shader build_for(const Device& device, const Shader& shader) {
    const auto words = device.runs_card_kernels() ? shader.words : shader.cpu_words;
    return {.name = shader.name, .words = words, .cpu_words = words};
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
