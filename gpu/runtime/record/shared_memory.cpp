#include "gpu/runtime/record/shared_memory.h"

#include <fmt/format.h>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

constexpr VkExternalMemoryHandleTypeFlagBits k_memory_descriptor = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
constexpr VkExternalSemaphoreHandleTypeFlagBits k_semaphore_descriptor =
    VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT;

void require_extension(const Device& device, const char* name, bool works) {
    if (!works || !device.enables_sharing() || !has_extension(device.physical(), name))
        throw DeviceError(
            fmt::format("device '{}' cannot share this with others: it lacks {}", device.info().name, name));
}

bool shares_memory(const Device& device) {
    auto info =
        empty_structure<VkPhysicalDeviceExternalBufferInfo>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_BUFFER_INFO);
    info.usage = Buffer::k_usage;
    info.handleType = k_memory_descriptor;
    auto properties = empty_structure<VkExternalBufferProperties>(VK_STRUCTURE_TYPE_EXTERNAL_BUFFER_PROPERTIES);
    vkGetPhysicalDeviceExternalBufferProperties(device.physical(), &info, &properties);
    constexpr VkExternalMemoryFeatureFlags k_both =
        VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT | VK_EXTERNAL_MEMORY_FEATURE_IMPORTABLE_BIT;
    return (properties.externalMemoryProperties.externalMemoryFeatures & k_both) == k_both;
}

bool shares_semaphores(const Device& device) {
    auto info = empty_structure<VkPhysicalDeviceExternalSemaphoreInfo>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_SEMAPHORE_INFO);
    info.handleType = k_semaphore_descriptor;
    auto properties = empty_structure<VkExternalSemaphoreProperties>(VK_STRUCTURE_TYPE_EXTERNAL_SEMAPHORE_PROPERTIES);
    vkGetPhysicalDeviceExternalSemaphoreProperties(device.physical(), &info, &properties);
    return properties.externalSemaphoreFeatures & VK_EXTERNAL_SEMAPHORE_FEATURE_EXPORTABLE_BIT;
}

}  // namespace

SharedBuffer::SharedBuffer(Device& device, std::size_t bytes)
    : device_(device), memory_(device.handle()), handle_(device.handle()) {
    create(bytes);
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device_.handle(), handle_.get(), &needs);
    auto shared = empty_structure<VkExportMemoryAllocateInfo>(VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO);
    shared.handleTypes = k_memory_descriptor;
    bind(needs.size, &shared);
}

SharedBuffer::SharedBuffer(Device& device, std::size_t bytes, std::size_t memory_bytes, int descriptor)
    : device_(device), memory_(device.handle()), handle_(device.handle()) {
    create(bytes);
    auto imported = empty_structure<VkImportMemoryFdInfoKHR>(VK_STRUCTURE_TYPE_IMPORT_MEMORY_FD_INFO_KHR);
    imported.handleType = k_memory_descriptor;
    imported.fd = descriptor;
    bind(memory_bytes, &imported);
}

void SharedBuffer::create(std::size_t bytes) {
    require_extension(device_, VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME, shares_memory(device_));
    auto shared =
        empty_structure<VkExternalMemoryBufferCreateInfo>(VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO);
    shared.handleTypes = k_memory_descriptor;
    auto info = empty_structure<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, &shared);
    info.size = padded_buffer_bytes(bytes);
    info.usage = Buffer::k_usage;
    check(vkCreateBuffer(device_.handle(), &info, nullptr, handle_.put()), "make a shared buffer");
    buffer_ = Buffer::borrow(device_, handle_.get(), info.size);
}

void SharedBuffer::bind(std::size_t memory_bytes, const void* next) {
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device_.handle(), handle_.get(), &needs);
    if (needs.size > memory_bytes)
        throw DeviceError(fmt::format("a shared buffer needs {} of memory, which has {}", format_bytes(needs.size),
                                      format_bytes(memory_bytes)));
    memory_bytes_ = memory_bytes;
    const VkMemoryAllocateInfo allocate{
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .pNext = next,
        .allocationSize = memory_bytes,
        .memoryTypeIndex = device_.memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0)};
    check(vkAllocateMemory(device_.handle(), &allocate, nullptr, memory_.put()), "allocate shared memory");
    check(vkBindBufferMemory(device_.handle(), handle_.get(), memory_.get(), 0), "bind shared memory");
}

int SharedBuffer::descriptor() const {
    auto info = empty_structure<VkMemoryGetFdInfoKHR>(VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR);
    info.memory = memory_.get();
    info.handleType = k_memory_descriptor;
    int descriptor = -1;
    check(vkGetMemoryFdKHR(device_.handle(), &info, &descriptor), "share memory");
    return descriptor;
}

SharedSemaphore::SharedSemaphore(Device& device) : device_(device), handle_(device.handle()) {
    require_extension(device, VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME, shares_semaphores(device));
    auto shared = empty_structure<VkExportSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_EXPORT_SEMAPHORE_CREATE_INFO);
    shared.handleTypes = k_semaphore_descriptor;
    const auto info = empty_structure<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &shared);
    check(vkCreateSemaphore(device.handle(), &info, nullptr, handle_.put()), "make a shared semaphore");
}

int SharedSemaphore::descriptor() const {
    auto info = empty_structure<VkSemaphoreGetFdInfoKHR>(VK_STRUCTURE_TYPE_SEMAPHORE_GET_FD_INFO_KHR);
    info.semaphore = handle_.get();
    info.handleType = k_semaphore_descriptor;
    int descriptor = -1;
    check(vkGetSemaphoreFdKHR(device_.handle(), &info, &descriptor), "share a semaphore");
    return descriptor;
}

}  // namespace exemplar
