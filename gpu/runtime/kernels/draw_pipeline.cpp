#include "gpu/runtime/kernels/draw_pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/device/instance.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

void require_graphics(const Device& device) {
    if (!(queue_families(device.physical()).at(device.queue_family()).queueFlags & VK_QUEUE_GRAPHICS_BIT))
        throw DeviceError(
            fmt::format("device '{}' computes but cannot draw; choose another with --device or "
                        "EXEMPLAR_DEVICE (mesa-vulkan-drivers has one for any CPU)",
                        device.info().name));
}

// Reflects one shader and checks the part of the interface that it declares; either shader may lack some bindings.
Reflection reflect_part(const Shader& shader, const ProgramInterface& interface) {
    Reflection reflection = reflect(shader);
    ProgramInterface part;
    if (reflection.push_bytes > 0) part.push_constants = interface.push_constants;
    for (const ReflectedBinding& binding : reflection.bindings) {
        if (binding.binding >= interface.elements.size()) break;
        part.elements.push_back(interface.elements[binding.binding]);
    }
    for (const auto& constant : interface.constants)
        if (std::ranges::find(reflection.constant_ids, constant.first) != reflection.constant_ids.end())
            part.constants.push_back(constant);
    check_interface(shader, part, reflection);
    return reflection;
}

// Returns the union of the declarations of two shaders.
Reflection merged(Reflection a, const Reflection& b) {
    for (const ReflectedBinding& binding : b.bindings) {
        const auto same = std::ranges::find(a.bindings, binding.binding, &ReflectedBinding::binding);
        if (same == a.bindings.end()) {
            a.bindings.push_back(binding);
        } else {
            same->reads |= binding.reads;
            same->writes |= binding.writes;
        }
    }
    std::ranges::sort(a.bindings, {}, &ReflectedBinding::binding);
    a.push_bytes = std::max(a.push_bytes, b.push_bytes);
    return a;
}

VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage, const UniqueShaderModule& module,
                                           const Specialization& constants) {
    auto info = empty_structure<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    info.stage = stage;
    info.module = module.get();
    info.pName = "main";
    info.pSpecializationInfo = &constants.info();
    return info;
}

VkPipelineColorBlendAttachmentState blending_of(const DrawState& state) {
    VkPipelineColorBlendAttachmentState blend{};
    blend.blendEnable = state.blends;
    blend.srcColorBlendFactor = blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    blend.dstColorBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    blend.colorBlendOp = blend.alphaBlendOp = VK_BLEND_OP_ADD;
    blend.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    return blend;
}

// The pipeline's state apart from shaders.
struct FixedState {
    VkPipelineRenderingCreateInfo formats =
        empty_structure<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    VkPipelineVertexInputStateCreateInfo vertex_input = empty_structure<VkPipelineVertexInputStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
    VkPipelineInputAssemblyStateCreateInfo assembly = empty_structure<VkPipelineInputAssemblyStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
    VkPipelineViewportStateCreateInfo viewport =
        empty_structure<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
    VkPipelineRasterizationStateCreateInfo raster = empty_structure<VkPipelineRasterizationStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
    VkPipelineMultisampleStateCreateInfo samples =
        empty_structure<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
    VkPipelineDepthStencilStateCreateInfo depth = empty_structure<VkPipelineDepthStencilStateCreateInfo>(
        VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
    VkPipelineColorBlendAttachmentState blend;
    VkPipelineColorBlendStateCreateInfo blending =
        empty_structure<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
    std::array<VkDynamicState, 2> dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic =
        empty_structure<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);

    explicit FixedState(const DrawState& state) : blend(blending_of(state)) {
        formats.colorAttachmentCount = state.color == VK_FORMAT_UNDEFINED ? 0 : 1;
        formats.pColorAttachmentFormats = &state.color;
        formats.depthAttachmentFormat = state.depth;
        assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        viewport.viewportCount = viewport.scissorCount = 1;
        raster.polygonMode = VK_POLYGON_MODE_FILL;
        raster.cullMode = VK_CULL_MODE_NONE;
        raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
        raster.lineWidth = 1.0f;
        raster.depthBiasEnable = state.depth_bias != 0 || state.slope_bias != 0;
        raster.depthBiasConstantFactor = state.depth_bias;
        raster.depthBiasSlopeFactor = state.slope_bias;
        samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
        depth.depthTestEnable = state.depth != VK_FORMAT_UNDEFINED;
        depth.depthWriteEnable = depth.depthTestEnable && state.writes_depth;
        depth.depthCompareOp = state.depth_test;
        blending.attachmentCount = formats.colorAttachmentCount;
        blending.pAttachments = &blend;
        dynamic.dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size());
        dynamic.pDynamicStates = dynamic_states.data();
    }
    FixedState(const FixedState&) = delete;  // it points into itself
    FixedState& operator=(const FixedState&) = delete;
};

}  // namespace

DrawPipeline::DrawPipeline(Device& device, const Shader& vertex, const Shader& fragment,
                           const ProgramInterface& interface, const DrawState& state) {
    require_graphics(device);
    const Shader vertex_build = build_for(device, vertex), fragment_build = build_for(device, fragment);
    const auto program = std::make_shared<Program>(
        Program{.name = std::string(vertex.name),
                .stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
                .reflection = merged(reflect_part(vertex_build, interface), reflect_part(fragment_build, interface)),
                .set_layout = UniqueSetLayout(device.handle()),
                .layout = UniquePipelineLayout(device.handle()),
                .pipeline = UniquePipeline(device.handle())});
    create_layouts(device, *program);
    const UniqueShaderModule vertex_module = make_module(device, vertex_build);
    const UniqueShaderModule fragment_module = make_module(device, fragment_build);
    const Specialization constants(interface);
    const std::array stages{stage_info(VK_SHADER_STAGE_VERTEX_BIT, vertex_module, constants),
                            stage_info(VK_SHADER_STAGE_FRAGMENT_BIT, fragment_module, constants)};
    FixedState fixed(state);
    auto info =
        empty_structure<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &fixed.formats);
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &fixed.vertex_input;
    info.pInputAssemblyState = &fixed.assembly;
    info.pViewportState = &fixed.viewport;
    info.pRasterizationState = &fixed.raster;
    info.pMultisampleState = &fixed.samples;
    info.pDepthStencilState = &fixed.depth;
    info.pColorBlendState = &fixed.blending;
    info.pDynamicState = &fixed.dynamic;
    info.layout = program->layout.get();
    info.basePipelineIndex = -1;
    check(vkCreateGraphicsPipelines(device.handle(), device.pipeline_cache().handle(), 1, &info, nullptr,
                                    program->pipeline.put()),
          [&] { return fmt::format("make the pipeline {}", program->name); });
    device.name_pipeline(program->pipeline.get(), program->name);
    program_ = program;
}

}  // namespace exemplar
