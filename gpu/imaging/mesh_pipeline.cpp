#include "gpu/imaging/mesh_pipeline.h"

#include <fmt/format.h>

#include "embedded/imaging_mesh_frag.h"
#include "embedded/imaging_mesh_vert.h"
#include "gpu/runtime/device.h"
#include "gpu/runtime/errors.h"
#include "gpu/runtime/instance.h"
#include "gpu/runtime/kernel.h"
#include "gpu/runtime/reflection.h"
#include "shaders/shared/render.h"

namespace exemplar {
namespace {

constexpr const char* k_what = "make the pipeline that draws meshes";
constexpr VkShaderStageFlags k_stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

void require_graphics(const Device& device) {
    if (!(queue_families(device.physical()).at(device.queue_family()).queueFlags & VK_QUEUE_GRAPHICS_BIT))
        throw DeviceError(
            fmt::format("device '{}' computes but cannot draw; choose another with --device or "
                        "EXEMPLAR_DEVICE (mesa-vulkan-drivers has one for any CPU)",
                        device.info().name));
}

// Both stages see the same push constants, those of C++.
void check_parameters(const Shader& shader) {
    const Reflection reflection = reflect(shader);
    check_layout(shader, "the push constants", layout_of<shared::RenderParameters>(), reflection.push_bytes,
                 reflection.push_fields);
}

VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage, const UniqueShaderModule& module) {
    auto info = empty_structure<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    info.stage = stage;
    info.module = module.get();
    info.pName = "main";
    return info;
}

// The pipeline's state apart from shaders and formats.
struct FixedState {
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
    VkPipelineColorBlendAttachmentState blend{};
    VkPipelineColorBlendStateCreateInfo blending =
        empty_structure<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
    std::array<VkDynamicState, 2> dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic =
        empty_structure<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);

    FixedState() {
        assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        viewport.viewportCount = viewport.scissorCount = 1;
        raster.polygonMode = VK_POLYGON_MODE_FILL;
        raster.cullMode = VK_CULL_MODE_NONE;  // surfaces of the wild are open, or wound the wrong way
        raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
        raster.lineWidth = 1.0f;
        samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
        depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
        depth.depthCompareOp = VK_COMPARE_OP_LESS;
        blend.colorWriteMask =
            VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
        blending.attachmentCount = 1;
        blending.pAttachments = &blend;
        dynamic.dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size());
        dynamic.pDynamicStates = dynamic_states.data();
    }
    FixedState(const FixedState&) = delete;  // it points into itself
    FixedState& operator=(const FixedState&) = delete;
};

}  // namespace

MeshPipeline::MeshPipeline(Device& device, VkFormat color, VkFormat depth)
    : device_(device),
      set_layout_(device.handle()),
      layout_(device.handle()),
      pipeline_(device.handle()),
      pool_(device.handle()) {
    require_graphics(device);
    create_layout();
    create_set();
    create_pipeline(color, depth);
}

void MeshPipeline::create_layout() {
    std::array<VkDescriptorSetLayoutBinding, k_mesh_buffers> bindings{};
    for (std::uint32_t i = 0; i < bindings.size(); ++i)
        bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_VERTEX_BIT, nullptr};
    auto set = empty_structure<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    set.bindingCount = static_cast<std::uint32_t>(bindings.size());
    set.pBindings = bindings.data();
    check(vkCreateDescriptorSetLayout(device_.handle(), &set, nullptr, set_layout_.put()), k_what);

    const VkDescriptorSetLayout set_layout = set_layout_.get();
    const VkPushConstantRange push{k_stages, 0, sizeof(shared::RenderParameters)};
    static_assert(sizeof(shared::RenderParameters) <= 128, "every device has 128 bytes of push constants");
    auto layout = empty_structure<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &set_layout;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    check(vkCreatePipelineLayout(device_.handle(), &layout, nullptr, layout_.put()), k_what);
}

void MeshPipeline::create_set() {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, k_mesh_buffers};
    auto pool = empty_structure<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool.maxSets = 1;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    check(vkCreateDescriptorPool(device_.handle(), &pool, nullptr, pool_.put()), k_what);
    const VkDescriptorSetLayout set_layout = set_layout_.get();
    const VkDescriptorSetAllocateInfo set{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                          .pNext = nullptr,
                                          .descriptorPool = pool_.get(),
                                          .descriptorSetCount = 1,
                                          .pSetLayouts = &set_layout};
    check(vkAllocateDescriptorSets(device_.handle(), &set, &set_), k_what);
}

void MeshPipeline::create_pipeline(VkFormat color, VkFormat depth) {
    check_parameters(shaders::imaging_mesh_vert);
    check_parameters(shaders::imaging_mesh_frag);
    const UniqueShaderModule vertex = make_module(device_, shaders::imaging_mesh_vert);
    const UniqueShaderModule fragment = make_module(device_, shaders::imaging_mesh_frag);
    const std::array stages{stage_info(VK_SHADER_STAGE_VERTEX_BIT, vertex),
                            stage_info(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
    auto formats = empty_structure<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    formats.colorAttachmentCount = 1;
    formats.pColorAttachmentFormats = &color;
    formats.depthAttachmentFormat = depth;
    const FixedState state;
    auto info =
        empty_structure<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &formats);
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &state.vertex_input;
    info.pInputAssemblyState = &state.assembly;
    info.pViewportState = &state.viewport;
    info.pRasterizationState = &state.raster;
    info.pMultisampleState = &state.samples;
    info.pDepthStencilState = &state.depth;
    info.pColorBlendState = &state.blending;
    info.pDynamicState = &state.dynamic;
    info.layout = layout_.get();
    info.basePipelineIndex = -1;
    check(vkCreateGraphicsPipelines(device_.handle(), device_.pipeline_cache().handle(), 1, &info, nullptr,
                                    pipeline_.put()),
          k_what);
}

void MeshPipeline::bind(const std::array<const Buffer*, k_mesh_buffers>& buffers) {
    std::array<VkDescriptorBufferInfo, k_mesh_buffers> infos{};
    std::array<VkWriteDescriptorSet, k_mesh_buffers> writes{};
    for (std::uint32_t i = 0; i < k_mesh_buffers; ++i) {
        const std::uint64_t bytes = buffers[i]->bytes(), limit = device_.info().max_storage_range;
        if (bytes > limit)
            throw DeviceLimitError(
                fmt::format("a mesh buffer of {} is over the limit of {} per binding of device '{}'; simplify the mesh",
                            format_bytes(bytes), format_bytes(limit), device_.info().name),
                bytes, limit);
        infos[i] = {buffers[i]->handle(), 0, VK_WHOLE_SIZE};
        writes[i] = empty_structure<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        writes[i].dstSet = set_;
        writes[i].dstBinding = i;
        writes[i].descriptorCount = 1;
        writes[i].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        writes[i].pBufferInfo = &infos[i];
    }
    vkUpdateDescriptorSets(device_.handle(), k_mesh_buffers, writes.data(), 0, nullptr);
}

}  // namespace exemplar
