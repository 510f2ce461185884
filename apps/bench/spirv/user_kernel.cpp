#include "apps/bench/spirv/user_kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

constexpr std::uint32_t k_default_texel_bytes = 16;

void require_distinct_bindings(const UserShader& shader, const Reflection& reflection) {
    std::set<std::uint32_t> seen;
    for (const ReflectedBinding& binding : reflection.bindings)
        if (!seen.insert(binding.binding).second)
            throw ShaderError(fmt::format("shader {}: binding {} is declared twice; give each buffer its own number",
                                          shader.name, binding.binding));
}

KernelInterface kernel_interface(const UserInterface& interface, const UserDispatch& dispatch) {
    KernelInterface result;
    const Reflection& reflection = interface.reflection;
    if (reflection.push_bytes > 0)
        result.push_constants =
            StructLayout{.name = "--push", .bytes = (reflection.push_bytes + 3) / 4 * 4, .fields = {}, .alignment = 4};
    result.elements.reserve(reflection.bindings.size());
    for (const ReflectedBinding& binding : reflection.bindings)
        result.elements.push_back({.name = "--bind", .bytes = binding.stride, .fields = {}});
    result.constants = dispatch.constants;
    return result;
}

Threads threads_of(const std::array<std::uint64_t, 3>& threads) {
    return {threads[0], threads[1], threads[2]};
}

std::uint64_t bytes_of_source(const BindingSource& source) {
    switch (source.kind) {
        case BindingSource::Kind::file:
            return 0;
        case BindingSource::Kind::zeros:
            return source.number;
        default:
            return 4 * source.number;
    }
}

void require_size(std::uint32_t binding, std::uint64_t bytes, const DeviceInfo& device) {
    const std::uint64_t limit = std::min(device.max_storage_range, device.max_allocation);
    if (bytes > limit)
        throw DeviceLimitError(fmt::format("binding {}: {} are over the limit of {} of device '{}'; give less with "
                                           "--bind",
                                           binding, format_bytes(bytes), format_bytes(limit), device.name),
                               bytes, limit);
}

}  // namespace

UserInterface::UserInterface(const UserShader& shader, const UserDispatch& dispatch)
    : reflection(reflect(shader.shader())), scalars(reflect_scalars(shader.shader())) {
    require_distinct_bindings(shader, reflection);
    for (ReflectedBinding& binding : reflection.bindings) {
        if (binding.type != BindingType::texels) continue;
        const auto given = dispatch.texel_bytes.find(binding.binding);
        binding.stride = given == dispatch.texel_bytes.end() ? k_default_texel_bytes : given->second;
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const auto& [id, value] : dispatch.constants)
            if (reflection.local_size_ids[axis] == id) reflection.local_size[axis] = value;
}

const BlockScalars* UserInterface::block(std::uint32_t number) const {
    const auto found = std::ranges::find(scalars.blocks, number, &BlockScalars::binding);
    return found == scalars.blocks.end() ? nullptr : &*found;
}

const ReflectedBinding* UserInterface::binding(std::uint32_t number) const {
    const auto found = std::ranges::find(reflection.bindings, number, &ReflectedBinding::binding);
    return found == reflection.bindings.end() ? nullptr : &*found;
}

std::array<std::uint64_t, 3> UserInterface::threads(const UserDispatch& dispatch) const {
    std::array<std::uint64_t, 3> threads = dispatch.size;
    for (std::size_t axis = 0; axis < 3 && dispatch.size_is_groups; ++axis)
        threads[axis] *= reflection.local_size[axis];
    return threads;
}

Contents contents_of_bindings(const std::vector<const UserInterface*>& interfaces,
                              const std::vector<BindingSource>& sources, std::uint64_t threads,
                              const DeviceInfo& device) {
    Contents contents;
    for (const BindingSource& source : sources) {
        const bool known =
            std::ranges::any_of(interfaces, [&](const auto* one) { return one->binding(source.binding) != nullptr; });
        if (!known)
            throw UsageError(fmt::format("--bind {}: the shader has no binding {}", source.binding, source.binding));
        require_size(source.binding, bytes_of_source(source), device);
        if (!contents.emplace(source.binding, contents_of(source)).second)
            throw UsageError(fmt::format("--bind {} is given twice; give it once", source.binding));
        require_size(source.binding, contents.at(source.binding).size(), device);
        for (const UserInterface* interface : interfaces)
            if (const ReflectedBinding* binding = interface->binding(source.binding))
                check_contents(*binding, interface->block(source.binding), source, contents.at(source.binding).size());
    }
    for (const UserInterface* interface : interfaces)
        for (const ReflectedBinding& binding : interface->reflection.bindings) {
            if (contents.contains(binding.binding)) continue;
            const BlockScalars* block = interface->block(binding.binding);
            const std::uint64_t stride = block ? block->stride : binding.stride;
            require_size(binding.binding, threads * stride, device);
            contents.emplace(binding.binding, default_contents(binding, block, threads));
        }
    return contents;
}

UserKernel::UserKernel(Device& device, const UserShader& shader, const UserInterface& interface,
                       const UserDispatch& dispatch, Bytes push, const Contents& contents)
    : kernel_(device, shader.shader(), kernel_interface(interface, dispatch)),
      threads_(threads_of(interface.threads(dispatch))),
      push_(std::move(push)),
      stream_(device, &profiler_) {
    const std::vector<ReflectedBinding>& bindings = interface.reflection.bindings;
    slots_.reserve(bindings.size());
    ranges_.reserve(bindings.size());
    for (const ReflectedBinding& binding : bindings) {
        const Bytes& bytes = contents.at(binding.binding);
        Slot slot{
            .binding = binding.binding, .buffer = Buffer(device, bytes.size()), .original = {}, .contents = &bytes};
        if (dispatch.restores && binding.reads && binding.writes)
            slot.original = Buffer::of(device, std::span<const std::byte>(bytes));
        slots_.push_back(std::move(slot));
        ranges_.emplace_back(slots_.back().buffer);
    }
    restore();
}

void UserKernel::restore() {
    for (Slot& slot : slots_) slot.buffer.upload(std::span<const std::byte>(*slot.contents));
}

void UserKernel::run(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        for (const Slot& slot : slots_)
            if (slot.original) stream_.copy(slot.original, 0, slot.buffer, 0, slot.buffer.bytes());
        stream_.dispatch_bytes(kernel_, threads_, ranges_, push_);
    }
    stream_.finish();
}

Bytes UserKernel::contents(std::uint32_t binding) const {
    const auto slot = std::ranges::find(slots_, binding, &Slot::binding);
    Bytes bytes(slot->buffer.bytes());
    slot->buffer.download(std::span<std::byte>(bytes));
    return bytes;
}

}  // namespace exemplar
