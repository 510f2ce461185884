#pragma once

#include <fmt/format.h>
#include <spirv_cross_c.h>

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "gpu/runtime/kernels/reflection.h"
#include "host/core/errors.h"

namespace exemplar {

/// SPIRV-Cross's view of one module. Only the sources that reflect include it.
class SpirvModule {
  public:
    explicit SpirvModule(const Shader& shader) : shader_(shader) {
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
        throw ShaderError(fmt::format("shader {}: cannot be read: {}", shader_.name, reason));
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

}  // namespace exemplar
