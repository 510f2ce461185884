#include "gpu/runtime/kernels/kernel.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

void specialize_local_size(Reflection& reflection, const ProgramInterface& interface) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const auto& [id, value] : interface.constants)
            if (reflection.local_size_ids[axis] == id) reflection.local_size[axis] = value;
}

// Sets the tuned workgroup size, if there is one, of a kernel that leaves its size to the host and of which
// `interface` does not say it. Otherwise the shader's default stays.
void choose_group_size(const Device& device, const Program& program, ProgramInterface& interface) {
    if (program.reflection.local_size_ids[0] != k_group_size_constant) return;
    for (const auto& [id, value] : interface.constants)
        if (id == k_group_size_constant) return;
    const DeviceInfo& info = device.info();
    const std::uint32_t size = device.tuning().choose(program.name, k_group_size, program.reflection.local_size[0]);
    if (size <= info.max_invocations && size <= info.max_group_size[0])
        interface.constants.emplace_back(k_group_size_constant, size);
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

Program empty_program(const Device& device, const Shader& shader) {
    return {.name = std::string(shader.name),
            .stages = VK_SHADER_STAGE_COMPUTE_BIT,
            .reflection = reflect(shader),
            .set_layout = UniqueSetLayout(device.handle()),
            .layout = UniquePipelineLayout(device.handle()),
            .pipeline = UniquePipeline(device.handle())};
}

void create_pipeline(const Device& device, Program& program, const Shader& shader, const ProgramInterface& interface,
                     VkPipelineCache cache) {
    const Specialization constants(interface);
    const UniqueShaderModule module = make_module(device, shader);
    const VkComputePipelineCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .pNext = nullptr,
        .flags = device.captures_statistics() ? VkPipelineCreateFlags{VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR}
                                              : VkPipelineCreateFlags{},
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .pNext = nullptr,
                  .flags = 0,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module.get(),
                  .pName = "main",
                  .pSpecializationInfo = &constants.info()},
        .layout = program.layout.get(),
        .basePipelineHandle = VK_NULL_HANDLE,
        .basePipelineIndex = -1};
    check(vkCreateComputePipelines(device.handle(), cache, 1, &info, nullptr, program.pipeline.put()),
          [&] { return fmt::format("compile kernel {}", program.name); });
}

}  // namespace

Kernel::Kernel(Device& device, const Shader& shader, const ProgramInterface& interface) {
    const Shader build = build_for(device, shader);
    const auto program = std::make_shared<Program>(empty_program(device, build));
    check_interface(build, interface, program->reflection);
    ProgramInterface sized = interface;
    choose_group_size(device, *program, sized);
    specialize_local_size(program->reflection, sized);
    check_limits(build, program->reflection, device.info());
    create_layouts(device, *program);
    create_pipeline(device, *program, build, sized, device.pipeline_cache().handle());
    device.name_pipeline(program->pipeline.get(), program->name);
    if (device.captures_statistics())
        device.store_statistics(program->name, executable_statistics(device, program->pipeline.get()));
    program_ = program;
}

std::vector<ExecutableStatistic> compile(Device& device, const Shader& shader,
                                         std::span<const std::pair<std::uint32_t, std::uint32_t>> constants) {
    const Shader build = build_for(device, shader);
    Program program = empty_program(device, build);
    const ProgramInterface interface {
        .constants = { constants.begin(), constants.end() }
    };
    create_layouts(device, program);
    create_pipeline(device, program, build, interface, VK_NULL_HANDLE);
    if (!device.captures_statistics()) return {};
    return executable_statistics(device, program.pipeline.get());
}

}  // namespace exemplar
