#include "renderer.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "figure_frag.h"
#include "figure_vert.h"

namespace {

void check(VkResult result, const char* what) {
    if (result != VK_SUCCESS && result != VK_SUBOPTIMAL_KHR)
        throw std::runtime_error(std::string("cannot ") + what + ": VkResult " + std::to_string(result));
}

VKAPI_ATTR VkBool32 VKAPI_CALL report(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                      const VkDebugUtilsMessengerCallbackDataEXT* data, void* count) {
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    ++*static_cast<std::size_t*>(count);
    return VK_FALSE;
}

void barrier(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect, VkImageLayout from, VkImageLayout to) {
    const VkImageMemoryBarrier2 change{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                       nullptr,
                                       VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                       VK_ACCESS_2_MEMORY_WRITE_BIT,
                                       VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                       VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                                       from,
                                       to,
                                       VK_QUEUE_FAMILY_IGNORED,
                                       VK_QUEUE_FAMILY_IGNORED,
                                       image,
                                       {aspect, 0, 1, 0, 1}};
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &change;
    vkCmdPipelineBarrier2(commands, &info);
}

VkSemaphore make_semaphore(VkDevice device, VkSemaphoreType type) {
    const VkSemaphoreTypeCreateInfo kind{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO, nullptr, type, 0};
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &kind, 0};
    VkSemaphore semaphore{};
    check(vkCreateSemaphore(device, &info, nullptr, &semaphore), "make a semaphore");
    return semaphore;
}

}  // namespace

Renderer::Renderer(GLFWwindow* window, VkExtent2D size, bool validate, std::span<const std::uint32_t> indices,
                   std::size_t vertices)
    : size_(size), index_count_(static_cast<std::uint32_t>(indices.size())) {
    make_instance(window != nullptr, validate);
#ifdef HAS_WINDOW
    if (window) check(glfwCreateWindowSurface(instance, window, nullptr, &surface_), "make a surface");
#endif
    make_device(window != nullptr);
    if (window) make_swapchain();
    make_pipeline();
    indices_ = make_buffer(indices.size_bytes(), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    std::memcpy(indices_.mapped, indices.data(), indices.size_bytes());
    make_frames(vertices);
}

void Renderer::make_instance(bool windowed, bool validate) {
    std::vector<const char*> extensions, layers;
#ifdef HAS_WINDOW
    if (windowed) {
        std::uint32_t count = 0;
        const char** names = glfwGetRequiredInstanceExtensions(&count);
        extensions.assign(names, names + count);
    }
#else
    (void)windowed;
#endif
    VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messenger.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = report;
    messenger.pUserData = &messages_;
    if (validate) {
        layers.push_back("VK_LAYER_KHRONOS_validation");
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pNext = validate ? &messenger : nullptr;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = static_cast<std::uint32_t>(layers.size());
    info.ppEnabledLayerNames = layers.data();
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    check(vkCreateInstance(&info, nullptr, &instance), "make an instance");
    if (!validate) return;
    const auto listen = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
    VkDebugUtilsMessengerEXT handle{};
    check(listen(instance, &messenger, nullptr, &handle), "listen to the validation layer");
}

void Renderer::make_device(bool windowed) {
    std::uint32_t count = 1;
    if (vkEnumeratePhysicalDevices(instance, &count, &physical) < 0 || count == 0)
        throw std::runtime_error("there is no Vulkan device");
    std::array<VkQueueFamilyProperties, 16> families{};
    count = families.size();
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    constexpr VkQueueFlags k_wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    while (family < count && (families[family].queueFlags & k_wanted) != k_wanted) ++family;
    if (family == count) throw std::runtime_error("the device does not draw");
    const float priority = 1;
    VkDeviceQueueCreateInfo queues{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queues.queueFamilyIndex = family;
    queues.queueCount = 1;
    queues.pQueuePriorities = &priority;
    // This program needs these features itself; exemplar::require_features would set those that Exemplar needs.
    features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    features12.pNext = &features13;
    features12.timelineSemaphore = VK_TRUE;
    features13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    features13.synchronization2 = features13.dynamicRendering = VK_TRUE;
    const char* swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.pNext = &features12;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queues;
    info.enabledExtensionCount = windowed ? 1 : 0;
    info.ppEnabledExtensionNames = &swapchain;
    check(vkCreateDevice(physical, &info, nullptr, &device), "open the device");
    vkGetDeviceQueue(device, family, 0, &queue);
}

void Renderer::make_swapchain() {
    VkBool32 shows = VK_FALSE;
    vkGetPhysicalDeviceSurfaceSupportKHR(physical, family, surface_, &shows);
    if (!shows) throw std::runtime_error("the device cannot show pictures in this window");
    VkSurfaceCapabilitiesKHR can{};
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physical, surface_, &can), "ask for the window's size");
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface_;
    info.minImageCount = can.minImageCount + 1;
    info.imageFormat = VK_FORMAT_B8G8R8A8_UNORM;
    info.imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    info.imageExtent = size_;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    check(vkCreateSwapchainKHR(device, &info, nullptr, &swapchain_), "make a swapchain");
    std::uint32_t count = 0;
    vkGetSwapchainImagesKHR(device, swapchain_, &count, nullptr);
    images_.resize(count);
    vkGetSwapchainImagesKHR(device, swapchain_, &count, images_.data());
    for (std::uint32_t i = 0; i < count; ++i) drawn_.push_back(make_semaphore(device, VK_SEMAPHORE_TYPE_BINARY));
}

void Renderer::make_pipeline() {
    const VkPushConstantRange push{VK_SHADER_STAGE_VERTEX_BIT, 0, 17 * sizeof(float)};
    VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    check(vkCreatePipelineLayout(device, &layout, nullptr, &layout_), "make a layout");
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
    const auto set_stage = [&](std::size_t i, VkShaderStageFlagBits stage, const std::uint32_t* code,
                               std::size_t bytes) {
        const VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, bytes, code};
        stages[i] = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
        stages[i].stage = stage;
        stages[i].pName = "main";
        check(vkCreateShaderModule(device, &info, nullptr, &stages[i].module), "load a shader");
    };
    set_stage(0, VK_SHADER_STAGE_VERTEX_BIT, figure_vert, sizeof figure_vert);
    set_stage(1, VK_SHADER_STAGE_FRAGMENT_BIT, figure_frag, sizeof figure_frag);
    const VkVertexInputBindingDescription binding{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
    const std::array<VkVertexInputAttributeDescription, 2> attributes{
        {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}, {1, 0, VK_FORMAT_R32G32B32_SFLOAT, sizeof(Vertex) / 2}}};
    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    input.vertexBindingDescriptionCount = 1;
    input.pVertexBindingDescriptions = &binding;
    input.vertexAttributeDescriptionCount = attributes.size();
    input.pVertexAttributeDescriptions = attributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const VkViewport viewport{0, 0, static_cast<float>(size_.width), static_cast<float>(size_.height), 0, 1};
    const VkRect2D scissor{{0, 0}, size_};
    const VkPipelineViewportStateCreateInfo view{
        VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, nullptr, 0, 1, &viewport, 1, &scissor};
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_LESS;
    VkPipelineColorBlendAttachmentState written{};
    written.colorWriteMask = 0xf;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = 1;
    blend.pAttachments = &written;
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &k_color_format;
    rendering.depthAttachmentFormat = k_depth_format;
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
    info.stageCount = stages.size();
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &view;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.layout = layout_;
    check(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_), "make a pipeline");
    for (const auto& stage : stages) vkDestroyShaderModule(device, stage.module, nullptr);
}

void Renderer::make_frames(std::size_t vertices) {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = family;
    check(vkCreateCommandPool(device, &pool, nullptr, &pool_), "make a command pool");
    timeline_ = make_semaphore(device, VK_SEMAPHORE_TYPE_TIMELINE);
    const VkCommandBufferAllocateInfo buffers{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool_,
                                              VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    for (Frame& frame : frames_) {
        check(vkAllocateCommandBuffers(device, &buffers, &frame.commands), "make a command buffer");
        frame.color = make_image(k_color_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                 VK_IMAGE_ASPECT_COLOR_BIT);
        frame.depth =
            make_image(k_depth_format, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT);
        frame.vertices = make_buffer(vertices * sizeof(Vertex), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
        frame.pixels = make_buffer(VkDeviceSize{4} * size_.width * size_.height, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        frame.acquired = make_semaphore(device, VK_SEMAPHORE_TYPE_BINARY);
    }
}

std::uint32_t Renderer::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const {
    VkPhysicalDeviceMemoryProperties types{};
    vkGetPhysicalDeviceMemoryProperties(physical, &types);
    for (std::uint32_t i = 0; i < types.memoryTypeCount; ++i)
        if ((allowed >> i & 1) && (types.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    throw std::runtime_error("the device has no memory of the needed kind");
}

Image Renderer::make_image(VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect) const {
    Image result{};
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {size_.width, size_.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    check(vkCreateImage(device, &info, nullptr, &result.image), "make an image");
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device, result.image, &needs);
    const VkMemoryAllocateInfo memory{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size,
                                      memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)};
    check(vkAllocateMemory(device, &memory, nullptr, &result.memory), "allocate memory");
    check(vkBindImageMemory(device, result.image, result.memory, 0), "bind memory");
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = result.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {aspect, 0, 1, 0, 1};
    check(vkCreateImageView(device, &view, nullptr, &result.view), "make a view");
    return result;
}

HostBuffer Renderer::make_buffer(VkDeviceSize bytes, VkBufferUsageFlags usage) const {
    HostBuffer result{};
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes;
    info.usage = usage;
    check(vkCreateBuffer(device, &info, nullptr, &result.buffer), "make a buffer");
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device, result.buffer, &needs);
    const VkMemoryAllocateInfo memory{
        VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size,
        memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT)};
    check(vkAllocateMemory(device, &memory, nullptr, &result.memory), "allocate memory");
    check(vkBindBufferMemory(device, result.buffer, result.memory, 0), "bind memory");
    void* address = nullptr;
    check(vkMapMemory(device, result.memory, 0, VK_WHOLE_SIZE, 0, &address), "map memory");
    result.mapped = static_cast<std::byte*>(address);
    return result;
}

Frame& Renderer::begin(std::uint64_t number) {
    Frame& frame = frames_[number % frames_.size()];
    wait(frame);
    const VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                        VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
    check(vkBeginCommandBuffer(frame.commands, &info), "record commands");
    return frame;
}

void Renderer::draw_figure(Frame& frame, std::span<const Vertex> vertices, const float* clip_from_mesh,
                           float shade) const {
    std::memcpy(frame.vertices.mapped, vertices.data(), vertices.size_bytes());
    barrier(frame.commands, frame.color.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    barrier(frame.commands, frame.depth.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
            VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO}, depth = color;
    color.imageView = frame.color.view;
    color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.loadOp = depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    color.clearValue.color = {{1, 1, 1, 1}};
    depth.imageView = frame.depth.view;
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.clearValue.depthStencil = {1, 0};
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea.extent = size_;
    rendering.layerCount = rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &color;
    rendering.pDepthAttachment = &depth;
    vkCmdBeginRendering(frame.commands, &rendering);
    vkCmdBindPipeline(frame.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
    const VkDeviceSize offset = 0;
    vkCmdBindVertexBuffers(frame.commands, 0, 1, &frame.vertices.buffer, &offset);
    vkCmdBindIndexBuffer(frame.commands, indices_.buffer, 0, VK_INDEX_TYPE_UINT32);
    vkCmdPushConstants(frame.commands, layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, 16 * sizeof(float), clip_from_mesh);
    vkCmdPushConstants(frame.commands, layout_, VK_SHADER_STAGE_VERTEX_BIT, 16 * sizeof(float), sizeof shade, &shade);
    vkCmdDrawIndexed(frame.commands, index_count_, 1, 0, 0, 0);
    vkCmdEndRendering(frame.commands);
}

void Renderer::end(Frame& frame) {
    barrier(frame.commands, frame.color.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    if (swapchain_) return show(frame);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {size_.width, size_.height, 1};
    vkCmdCopyImageToBuffer(frame.commands, frame.color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, frame.pixels.buffer,
                           1, &copy);
    submit(frame, VK_NULL_HANDLE, VK_NULL_HANDLE);
}

void Renderer::show(Frame& frame) {
    std::uint32_t index = 0;
    check(vkAcquireNextImageKHR(device, swapchain_, UINT64_MAX, frame.acquired, VK_NULL_HANDLE, &index),
          "get an image");
    barrier(frame.commands, images_[index], VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkImageBlit blit{};
    blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    blit.srcOffsets[1] = blit.dstOffsets[1] = {static_cast<int>(size_.width), static_cast<int>(size_.height), 1};
    vkCmdBlitImage(frame.commands, frame.color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, images_[index],
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_NEAREST);
    barrier(frame.commands, images_[index], VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
            VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    submit(frame, frame.acquired, drawn_[index]);
    const VkPresentInfoKHR info{
        VK_STRUCTURE_TYPE_PRESENT_INFO_KHR, nullptr, 1, &drawn_[index], 1, &swapchain_, &index, nullptr};
    check(vkQueuePresentKHR(queue, &info), "show a picture");
}

void Renderer::submit(Frame& frame, VkSemaphore wait, VkSemaphore signal) {
    check(vkEndCommandBuffer(frame.commands), "record commands");
    const VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, nullptr, frame.commands, 0};
    const auto semaphore = [](VkSemaphore handle, std::uint64_t value) {
        return VkSemaphoreSubmitInfo{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO, nullptr, handle, value,
                                     VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,    0};
    };
    frame.finished = ++submitted_;
    const VkSemaphoreSubmitInfo waits = semaphore(wait, 0);
    const std::array signals{semaphore(timeline_, frame.finished), semaphore(signal, 0)};
    const VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                             nullptr,
                             0,
                             wait ? 1u : 0u,
                             &waits,
                             1,
                             &commands,
                             signal ? 2u : 1u,
                             signals.data()};
    check(vkQueueSubmit2(queue, 1, &info, VK_NULL_HANDLE), "submit");
}

void Renderer::wait(const Frame& frame) const {
    VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    info.semaphoreCount = 1;
    info.pSemaphores = &timeline_;
    info.pValues = &frame.finished;
    check(vkWaitSemaphores(device, &info, UINT64_MAX), "wait");
}

Renderer::~Renderer() {
    vkDeviceWaitIdle(device);
    const auto free_buffer = [&](const HostBuffer& buffer) {
        vkDestroyBuffer(device, buffer.buffer, nullptr);
        vkFreeMemory(device, buffer.memory, nullptr);
    };
    for (const Frame& frame : frames_) {
        for (const Image& image : {frame.color, frame.depth}) {
            vkDestroyImageView(device, image.view, nullptr);
            vkDestroyImage(device, image.image, nullptr);
            vkFreeMemory(device, image.memory, nullptr);
        }
        free_buffer(frame.vertices);
        free_buffer(frame.pixels);
        vkDestroySemaphore(device, frame.acquired, nullptr);
    }
    free_buffer(indices_);
    vkDestroyPipeline(device, pipeline_, nullptr);
    vkDestroyPipelineLayout(device, layout_, nullptr);
    vkDestroyCommandPool(device, pool_, nullptr);
    vkDestroySemaphore(device, timeline_, nullptr);
    for (const VkSemaphore semaphore : drawn_) vkDestroySemaphore(device, semaphore, nullptr);
    if (swapchain_) vkDestroySwapchainKHR(device, swapchain_, nullptr);
    vkDestroyDevice(device, nullptr);
    if (surface_) vkDestroySurfaceKHR(instance, surface_, nullptr);
}
