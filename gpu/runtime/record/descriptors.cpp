#include "gpu/runtime/record/descriptors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

constexpr std::uint32_t k_sets_per_pool = 256;
constexpr std::uint32_t k_bindings_per_pool = 8 * k_sets_per_pool;
constexpr std::size_t k_most_sets = 512;   // kept beyond the end of a recording
constexpr std::uint64_t k_min_bytes = 16;  // what every buffer has, empty ones too

// The device's limits for ranges of one descriptor type.
struct RangeLimits {
    std::uint64_t bytes;
    std::uint64_t alignment;
};

RangeLimits limits_of(const ReflectedBinding& binding, const DeviceInfo& info) {
    if (binding.type == BindingType::texels) return {info.max_texels * binding.stride, info.texel_alignment};
    return {info.max_storage_range, info.storage_alignment};
}

void check_binding(const Program& program, const ReflectedBinding& binding, const BufferRange& range,
                   const DeviceInfo& info) {
    const auto start = [&] { return fmt::format("{}: buffer '{}': ", program.name, binding.name); };
    if (!*range.buffer) throw ShaderError(start() + "it has no memory");
    if (range.offset > range.buffer->bytes() || range.bytes > range.buffer->bytes() - range.offset)
        throw ShaderError(fmt::format("{}bytes {} to {} are outside its {} bytes", start(), range.offset,
                                      range.offset + range.bytes, range.buffer->bytes()));
    const RangeLimits limits = limits_of(binding, info);
    if (range.offset % limits.alignment != 0)
        throw DeviceLimitError(fmt::format("{}offset {} is no multiple of {}, as device '{}' needs it", start(),
                                           range.offset, limits.alignment, info.name),
                               range.offset, limits.alignment);
    if (range.bytes > limits.bytes)
        throw DeviceLimitError(fmt::format("{}{} are over the limit of {} per binding of device '{}'; tile the work",
                                           start(), format_bytes(range.bytes), format_bytes(limits.bytes), info.name),
                               range.bytes, limits.bytes);
}

// Converts a range for Vulkan. Empty ranges still need an address. A range that ends its buffer is extended to a
// multiple of 16 bytes, for kernels that read four values at once.
VkDescriptorBufferInfo bound_range(const ReflectedBinding& binding, const BufferRange& range, const DeviceInfo& info) {
    if (range.bytes == 0) return {range.buffer->handle(), 0, k_min_bytes};
    const std::uint64_t end = range.offset + range.bytes;
    const bool last = end == range.buffer->bytes();
    // The end is rounded, not the length: buffers end at a multiple of 16 bytes, but ranges may begin at any.
    const std::uint64_t padded = (end + k_min_bytes - 1) / k_min_bytes * k_min_bytes - range.offset;
    const std::uint64_t bytes = last ? std::min(padded, limits_of(binding, info).bytes) : range.bytes;
    const bool whole_texels = binding.type == BindingType::texels;
    return {range.buffer->handle(), range.offset, whole_texels ? bytes / binding.stride * binding.stride : bytes};
}

}  // namespace

void Descriptors::check_bindings(const Program& program, std::span<const BufferRange> ranges) const {
    const std::vector<ReflectedBinding>& bindings = program.reflection.bindings;
    if (ranges.size() != bindings.size())
        throw ShaderError(fmt::format("{} binds {} buffers, not {}", program.name, bindings.size(), ranges.size()));
    for (std::size_t i = 0; i < ranges.size(); ++i) check_binding(program, bindings[i], ranges[i], device_.info());
}

void Descriptors::bind(VkCommandBuffer commands, const Program& program, std::span<const BufferRange> ranges) {
    if (ranges.empty()) return;
    key_.assign(1, program.id);
    for (const BufferRange& range : ranges)
        key_.insert(key_.end(), {range.buffer->resource()->id, range.offset, range.bytes});
    auto found = sets_.find(key_);
    if (found == sets_.end()) found = sets_.emplace(key_, write(program, ranges)).first;
    const bool computes = program.stages == VK_SHADER_STAGE_COMPUTE_BIT;
    vkCmdBindDescriptorSets(commands, computes ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS,
                            program.layout.get(), 0, 1, &found->second.handle, 0, nullptr);
}

Descriptors::Set Descriptors::write(const Program& program, std::span<const BufferRange> ranges) {
    Set set{.handle = allocate(program.set_layout.get()), .views = {}};
    std::vector<VkDescriptorBufferInfo> infos(ranges.size());
    std::vector<VkBufferView> views(ranges.size());
    std::vector<VkWriteDescriptorSet> writes(ranges.size());
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const ReflectedBinding& binding = program.reflection.bindings[i];
        infos[i] = bound_range(binding, ranges[i], device_.info());
        writes[i] = empty_structure<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        writes[i].dstSet = set.handle;
        writes[i].dstBinding = binding.binding;
        writes[i].descriptorCount = 1;
        writes[i].descriptorType = descriptor_type(binding.type);
        if (binding.type == BindingType::texels) {
            views[i] = set.views.emplace_back(texel_view(binding, infos[i])).get();
            writes[i].pTexelBufferView = &views[i];
        } else {
            writes[i].pBufferInfo = &infos[i];
        }
    }
    vkUpdateDescriptorSets(device_.handle(), static_cast<std::uint32_t>(writes.size()), writes.data(), 0, nullptr);
    device_.host_work().add(HostTask::descriptor_set);
    return set;
}

UniqueBufferView Descriptors::texel_view(const ReflectedBinding& binding, const VkDescriptorBufferInfo& range) {
    auto info = empty_structure<VkBufferViewCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO);
    info.buffer = range.buffer;
    info.format = binding.format;
    info.offset = range.offset;
    info.range = range.range;
    UniqueBufferView view(device_.handle());
    check(vkCreateBufferView(device_.handle(), &info, nullptr, view.put()), "make a view of a buffer");
    device_.host_work().add(HostTask::view);
    return view;
}

void Descriptors::add_pool() {
    const std::array sizes{VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, k_bindings_per_pool},
                           VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, k_bindings_per_pool}};
    auto info = empty_structure<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    info.maxSets = k_sets_per_pool;
    info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    info.pPoolSizes = sizes.data();
    UniqueDescriptorPool pool(device_.handle());
    check(vkCreateDescriptorPool(device_.handle(), &info, nullptr, pool.put()), "make a descriptor pool");
    pools_.push_back(std::move(pool));
}

VkDescriptorSet Descriptors::allocate(VkDescriptorSetLayout layout) {
    VkDescriptorSet set = VK_NULL_HANDLE;
    // A full pool refuses; the next one is fresh and never does.
    for (bool fresh = false; !fresh; ++current_pool_) {
        fresh = current_pool_ == pools_.size();
        if (fresh) add_pool();
        const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .pNext = nullptr,
                                               .descriptorPool = pools_[current_pool_].get(),
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &layout};
        const VkResult result = vkAllocateDescriptorSets(device_.handle(), &info, &set);
        if (result == VK_SUCCESS) return set;
        if (fresh || (result != VK_ERROR_OUT_OF_POOL_MEMORY && result != VK_ERROR_FRAGMENTED_POOL))
            check(result, "allocate a descriptor set");
    }
    return set;
}

void Descriptors::reset() {
    if (sets_.size() < k_most_sets) return;
    for (const UniqueDescriptorPool& pool : pools_) vkResetDescriptorPool(device_.handle(), pool.get(), 0);
    current_pool_ = 0;
    sets_.clear();
}

}  // namespace exemplar
