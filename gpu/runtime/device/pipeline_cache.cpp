#include "gpu/runtime/device/pipeline_cache.h"

#include <xxhash.h>

#include <cstdint>
#include <cstring>
#include <ostream>
#include <string>
#include <system_error>

#include "gpu/runtime/device/device_cache.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"
#include "host/core/files.h"

namespace exemplar {
namespace {

// With a checksum of the body: D18 in docs/portability.md.
struct Header {
    char magic[8] = {'e', 'x', 'e', 'm', 'p', 'i', 'p', '1'};
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0;
};

Header header_of(const std::string& data) {
    Header header;
    header.bytes = data.size();
    header.hash = XXH3_64bits(data.data(), data.size());
    return header;
}

// The cached bytes, or none if the file is missing or damaged.
std::string load(const std::filesystem::path& path) {
    std::error_code error;
    if (path.empty() || !std::filesystem::is_regular_file(path, error)) return {};
    std::string content;
    try {
        content = read_file(path);
    } catch (const Error&) {
        return {};
    }
    if (content.size() < sizeof(Header)) return {};
    Header stored;
    std::memcpy(&stored, content.data(), sizeof stored);
    content.erase(0, sizeof stored);
    const Header expected = header_of(content);
    return std::memcmp(&stored, &expected, sizeof stored) == 0 ? content : std::string();
}

}  // namespace

std::filesystem::path pipeline_cache_path(const DeviceInfo& info) {
    return device_cache_path(info, "pipelines", "bin");
}

PipelineCache::PipelineCache(VkDevice device, const DeviceInfo& info)
    : device_(device), path_(pipeline_cache_path(info)) {
    const std::string data = load(path_);
    loaded_bytes_ = data.size();
    VkPipelineCacheCreateInfo create{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                     .pNext = nullptr,
                                     .flags = 0,
                                     .initialDataSize = data.size(),
                                     .pInitialData = data.data()};
    if (vkCreatePipelineCache(device_, &create, nullptr, &cache_) == VK_SUCCESS) return;
    loaded_bytes_ = create.initialDataSize = 0;
    check(vkCreatePipelineCache(device_, &create, nullptr, &cache_), "create a pipeline cache");
}

PipelineCache::~PipelineCache() {
    try {
        save();
    } catch (const std::exception&) {
        // Without the file the next run compiles again; nothing else is lost.
    }
    vkDestroyPipelineCache(device_, cache_, nullptr);
}

void PipelineCache::save() const {
    std::size_t size = 0;
    if (path_.empty() || vkGetPipelineCacheData(device_, cache_, &size, nullptr) != VK_SUCCESS || size == loaded_bytes_)
        return;
    std::string data(size, '\0');
    if (vkGetPipelineCacheData(device_, cache_, &size, data.data()) != VK_SUCCESS) return;
    data.resize(size);
    const Header header = header_of(data);
    write_file_atomically(path_, [&](std::ostream& out) {
        out.write(reinterpret_cast<const char*>(&header), sizeof header);
        out.write(data.data(), static_cast<std::streamsize>(data.size()));
    });
}

}  // namespace exemplar
