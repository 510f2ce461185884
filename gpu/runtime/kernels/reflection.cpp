#include "gpu/runtime/kernels/reflection.h"

#include <fmt/format.h>
#include <spirv_cross_c.h>

#include <algorithm>
#include <memory>
#include <span>

#include "host/core/errors.h"

namespace exemplar {
namespace {

// SPIRV-Cross's view of one module.
class Module {
  public:
    explicit Module(const Shader& shader) : shader_(shader) {
        spvc_context context = nullptr;
        require(spvc_context_create(&context));
        context_.reset(context);
        spvc_parsed_ir ir = nullptr;
        require(spvc_context_parse_spirv(context, shader.words.data(), shader.words.size(), &ir));
        require(
            spvc_context_create_compiler(context, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &compiler_));
        require(spvc_compiler_create_shader_resources(compiler_, &resources_));
    }

    spvc_compiler compiler() const { return compiler_; }

    std::span<const spvc_reflected_resource> resources(spvc_resource_type type) const {
        const spvc_reflected_resource* list = nullptr;
        std::size_t count = 0;
        require(spvc_resources_get_resource_list_for_type(resources_, type, &list, &count));
        return {list, count};
    }

    std::vector<ReflectedField> fields(spvc_type type) const {
        std::vector<ReflectedField> fields;
        for (unsigned i = 0; i < spvc_type_get_num_member_types(type); ++i) {
            unsigned offset = 0;
            std::size_t bytes = 0;
            require(spvc_compiler_type_struct_member_offset(compiler_, type, i, &offset));
            require(spvc_compiler_get_declared_struct_member_size(compiler_, type, i, &bytes));
            fields.push_back(
                {spvc_compiler_get_member_name(compiler_, spvc_type_get_base_type_id(type), i), offset, bytes});
        }
        return fields;
    }

    spvc_type type(spvc_type_id id) const { return spvc_compiler_get_type_handle(compiler_, id); }
    // The element type of an array of structures, with its members.
    spvc_type element(spvc_type_id id) const { return type(spvc_type_get_base_type_id(type(id))); }

    void require(spvc_result result) const {
        if (result == SPVC_SUCCESS) return;
        const char* reason = context_ ? spvc_context_get_last_error_string(context_.get()) : "out of memory";
        throw ShaderError(fmt::format("shader {}: cannot be read: {}; rebuild the program", shader_.name, reason));
    }

  private:
    struct Destroy {
        void operator()(spvc_context context) const { spvc_context_destroy(context); }
    };
    const Shader& shader_;
    std::unique_ptr<std::remove_pointer_t<spvc_context>, Destroy> context_;
    spvc_compiler compiler_ = nullptr;
    spvc_resources resources_ = nullptr;
};

// Reflects what all binding types have in common.
ReflectedBinding reflect_place(const Shader& shader, const Module& module, const spvc_reflected_resource& resource) {
    if (spvc_compiler_get_decoration(module.compiler(), resource.id, SpvDecorationDescriptorSet) != 0)
        throw ShaderError(fmt::format("shader {}: '{}' is not in descriptor set 0", shader.name, resource.name));
    if (spvc_type_get_num_array_dimensions(module.type(resource.type_id)) != 0)
        throw ShaderError(fmt::format("shader {}: '{}' is an array of buffers; kernels bind one buffer per binding",
                                      shader.name, resource.name));
    ReflectedBinding binding;
    binding.binding = spvc_compiler_get_decoration(module.compiler(), resource.id, SpvDecorationBinding);
    binding.name = resource.name;
    return binding;
}

ReflectedBinding reflect_texels(const Shader& shader, const Module& module, const spvc_reflected_resource& resource) {
    const spvc_type type = module.type(resource.base_type_id);
    const spvc_basetype values = spvc_type_get_basetype(module.type(spvc_type_get_image_sampled_type(type)));
    if (spvc_type_get_image_dimension(type) != SpvDimBuffer ||
        (values != SPVC_BASETYPE_FP32 && values != SPVC_BASETYPE_UINT32))
        throw ShaderError(
            fmt::format("shader {}: '{}' is neither a storage buffer nor a buffer of float or uint texels", shader.name,
                        resource.name));
    ReflectedBinding binding = reflect_place(shader, module, resource);
    binding.type = BindingType::texels;
    binding.integers = values == SPVC_BASETYPE_UINT32;
    binding.writes = false;
    return binding;
}

ReflectedBinding reflect_storage(const Shader& shader, const Module& module, const spvc_reflected_resource& resource) {
    ReflectedBinding binding = reflect_place(shader, module, resource);
    const SpvDecoration* decorations = nullptr;
    std::size_t count = 0;
    module.require(spvc_compiler_get_buffer_block_decorations(module.compiler(), resource.id, &decorations, &count));
    const std::span<const SpvDecoration> list(decorations, count);
    binding.writes = std::ranges::find(list, SpvDecorationNonWritable) == list.end();
    binding.reads = std::ranges::find(list, SpvDecorationNonReadable) == list.end();

    const spvc_type block = module.type(resource.base_type_id);
    const unsigned last = spvc_type_get_num_member_types(block) - 1;
    const spvc_type_id tail = spvc_type_get_member_type(block, last);
    if (spvc_type_get_num_array_dimensions(module.type(tail)) == 0) return binding;
    unsigned stride = 0;
    module.require(spvc_compiler_type_struct_member_array_stride(module.compiler(), block, last, &stride));
    binding.stride = stride;
    if (spvc_type_get_basetype(module.type(tail)) == SPVC_BASETYPE_STRUCT)
        binding.fields = module.fields(module.element(tail));
    return binding;
}

void reflect_bindings(const Shader& shader, const Module& module, Reflection& result) {
    for (const spvc_resource_type other : {SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, SPVC_RESOURCE_TYPE_STORAGE_IMAGE,
                                           SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS})
        for (const spvc_reflected_resource& resource : module.resources(other))
            throw ShaderError(
                fmt::format("shader {}: '{}' is neither a storage buffer nor a buffer of float or uint texels",
                            shader.name, resource.name));
    for (const spvc_reflected_resource& resource : module.resources(SPVC_RESOURCE_TYPE_STORAGE_BUFFER))
        result.bindings.push_back(reflect_storage(shader, module, resource));
    for (const spvc_reflected_resource& resource : module.resources(SPVC_RESOURCE_TYPE_SAMPLED_IMAGE))
        result.bindings.push_back(reflect_texels(shader, module, resource));
    std::ranges::sort(result.bindings, {}, &ReflectedBinding::binding);
}

void reflect_push_constants(const Module& module, Reflection& result) {
    for (const spvc_reflected_resource& resource : module.resources(SPVC_RESOURCE_TYPE_PUSH_CONSTANT)) {
        spvc_type block = module.type(resource.base_type_id);
        module.require(spvc_compiler_get_declared_struct_size(module.compiler(), block, &result.push_bytes));
        const spvc_type_id first = spvc_type_get_member_type(block, 0);
        const bool wraps_structure = spvc_type_get_num_member_types(block) == 1 &&
                                     spvc_type_get_basetype(module.type(first)) == SPVC_BASETYPE_STRUCT;
        result.push_fields = module.fields(wraps_structure ? module.type(first) : block);
    }
}

void reflect_constants(const Module& module, Reflection& result) {
    for (unsigned axis = 0; axis < 3; ++axis)
        result.local_size[axis] =
            spvc_compiler_get_execution_mode_argument_by_index(module.compiler(), SpvExecutionModeLocalSize, axis);
    std::array<spvc_specialization_constant, 3> size{};
    spvc_compiler_get_work_group_size_specialization_constants(module.compiler(), &size[0], &size[1], &size[2]);
    for (unsigned axis = 0; axis < 3; ++axis) {
        if (size[axis].id == 0) continue;
        result.local_size_ids[axis] = size[axis].constant_id;
        result.local_size[axis] =
            spvc_constant_get_scalar_u32(spvc_compiler_get_constant_handle(module.compiler(), size[axis].id), 0, 0);
    }
    const spvc_specialization_constant* constants = nullptr;
    std::size_t count = 0;
    module.require(spvc_compiler_get_specialization_constants(module.compiler(), &constants, &count));
    for (const spvc_specialization_constant& constant : std::span(constants, count))
        result.constant_ids.push_back(constant.constant_id);
}

}  // namespace

VkDescriptorType descriptor_type(BindingType type) {
    return type == BindingType::texels ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

Reflection reflect(const Shader& shader) {
    const Module module(shader);
    Reflection result;
    reflect_bindings(shader, module, result);
    reflect_push_constants(module, result);
    reflect_constants(module, result);
    return result;
}

void check_layout(const Shader& shader, const std::string& where, const StructLayout& expected, std::size_t bytes,
                  const std::vector<ReflectedField>& fields) {
    const std::string start = fmt::format("shader {}: {} and C++'s {} differ: ", shader.name, where, expected.name);
    if (!expected.fields.empty()) {
        for (std::size_t i = 0; i < std::min(fields.size(), expected.fields.size()); ++i) {
            const FieldLayout& field = expected.fields[i];
            if (fields[i].name != field.name)
                throw ShaderError(
                    fmt::format("{}member {} is '{}' there and '{}' here", start, i, fields[i].name, field.name));
            if (fields[i].offset != field.offset)
                throw ShaderError(fmt::format("{}'{}' is at byte {} there and at byte {} here", start, field.name,
                                              fields[i].offset, field.offset));
            if (fields[i].bytes != field.bytes)
                throw ShaderError(fmt::format("{}'{}' has {} bytes there and {} here", start, field.name,
                                              fields[i].bytes, field.bytes));
        }
        if (fields.size() != expected.fields.size())
            throw ShaderError(
                fmt::format("{}{} members there and {} here", start, fields.size(), expected.fields.size()));
    }
    if (bytes != expected.bytes)
        throw ShaderError(fmt::format("{}{} bytes there and {} here", start, bytes, expected.bytes));
}

}  // namespace exemplar
